//! The boundary on the faces that an edit touches.

use std::ops::Range;
use std::sync::{Mutex, PoisonError};

use smallvec::SmallVec;

use super::LiveModel;
use super::reach::Reach;
use super::tree::Member;
use crate::base::{Bounds, map_chunks};
use crate::body::{Body, kinds};
use crate::boundary::{BoundaryEdge, EdgeChange, FaceWorker, KnownEdge, Scene, can_cover};
use crate::expression::{Expression, common_polarities};
use crate::ids::{BodyId, Id, LeafId, OperandFace, OperandId};
use crate::weld::LiveWeld;

/// Number of faces from which several threads work on them: waking them takes as long as a few faces.
const FACES_FOR_THREADS: usize = 64;

/// Number of bodies near a change up to which they are looked at one by one.
const FEW_NEAR: usize = 64;

/// Number of faces of a body that a thread works out in a row then.
const FACES_OF_GROUP: usize = 20;

/// What was found on some faces.
#[derive(Default)]
pub(super) struct Found {
    pub(super) changes: Vec<(OperandFace, EdgeChange)>,
    /// The faces on which edges near the change did not fit to those known elsewhere.
    unfit: Vec<OperandFace>,
}

/// What finds the boundary on faces, kept for the next edit.
#[derive(Default)]
pub(super) struct EmitBuffers {
    worker: FaceWorker,
    edges: Vec<BoundaryEdge>,
    near_here: Vec<BodyId>,
}

/// A part of space outside of which nothing changes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Vicinity {
    /// It lies well within this box.
    bounds: Bounds,
    /// A larger box: what reaches into it is near.
    around: Bounds,
}

impl Vicinity {
    /// That of what lies in a box; nothing where the box is not finite.
    pub(super) fn of(bounds: &Bounds) -> Option<Self> {
        let is_finite = bounds.min.is_finite() && bounds.max.is_finite();
        is_finite.then(|| Self { bounds: bounds.with_room(), around: bounds.with_room().with_room() })
    }
}

/// The bodies around a change, in their order, with their boxes: those that may share an area with a box. Where they are too many to be looked at one by one, or there is no telling
/// where the change is, that box is empty.
pub(super) struct Surroundings {
    around: Bounds,
    bodies: Vec<(Member, Bounds)>,
}

impl Surroundings {
    /// The bodies that may share an area with a box, where that lies within what is known.
    pub(super) fn near(&self, bounds: &Bounds) -> Option<impl Iterator<Item = Member>> {
        let here = self.bodies.iter().filter(|(_, other)| other.may_share_area(bounds)).map(|(member, _)| *member);
        self.around.holds(bounds).then_some(here)
    }
}

/// What is known of a change on the faces of brushes that do not change themselves.
#[derive(Debug, Clone, Copy)]
enum Known {
    /// Nothing.
    Nothing,
    /// Where it is.
    Vicinity(Vicinity),
    /// Where it is, and that it is a body that comes and leaves nothing of them within.
    Covered(Vicinity, OperandId),
}

/// How the boundary on the faces of a body is found.
#[derive(Debug, Clone, Copy)]
enum Way {
    /// From what is near the faces.
    Whole,
    /// In a box, from what is near both.
    Within(Bounds),
    /// From the edges known, by a body that covers them.
    Covered(OperandId),
}

impl LiveModel {
    /// Works out how the boundary changes on some faces, sorted, as quickly as what is known of the change allows: where it is, and what is around. `changed` are the brushes, sorted, that change
    /// themselves.
    pub(super) fn find_boundary(
        &mut self,
        faces: &[OperandFace],
        changed: &[OperandId],
        (vicinity, surroundings): (Option<Vicinity>, Surroundings),
        reach: Reach,
    ) -> Vec<Found> {
        let nearby = vicinity.map(Known::Vicinity);
        let covered = match (reach, changed, vicinity) {
            (Reach::Appended, [only], Some(near)) if self.operand(*only).body.is_some() => {
                Some(Known::Covered(near, *only))
            }
            _ => None,
        };
        let mut found: Vec<Found> = Vec::new();
        let mut left = faces.to_vec();
        for known in covered.into_iter().chain(nearby).chain([Known::Nothing]) {
            if !left.is_empty() {
                let mut more = self.boundary_changes(&left, changed, known, &surroundings);
                left = more.iter_mut().flat_map(|found| found.unfit.drain(..)).collect();
                found.append(&mut more);
            }
        }
        self.buffers.surroundings = surroundings.bodies;
        found
    }

    /// The bodies that reach into a vicinity, or a little further, where these are few.
    pub(super) fn surroundings(&mut self, vicinity: Option<Vicinity>) -> Surroundings {
        let mut bodies = std::mem::take(&mut self.buffers.surroundings);
        bodies.clear();
        let Some(Vicinity { around, .. }) = vicinity else { return Surroundings { around: Bounds::EMPTY, bodies } };
        let mut near = self.places.near(&around);
        let few = near.by_ref().take(FEW_NEAR);
        bodies.extend(few.map(|(operand, bounds)| (self.member(operand), bounds)));
        bodies.sort_unstable_by_key(|(member, _)| *member);
        let around = if near.next().is_none() { around } else { Bounds::EMPTY };
        Surroundings { around, bodies }
    }

    fn member(&self, operand: OperandId) -> Member {
        Member { at: self.position(operand), operand }
    }

    /// Works out how the boundary changes on some faces, sorted; `changed` are the brushes, sorted, too, that change themselves. The bodies around the change are looked
    /// at one by one where they are few: a search for each body among them takes longer.
    fn boundary_changes(
        &mut self,
        faces: &[OperandFace],
        changed: &[OperandId],
        of_others: Known,
        surroundings: &Surroundings,
    ) -> Vec<Found> {
        let mut place = std::mem::take(&mut self.buffers.place);
        let emit_buffers = self.buffers.emit.get_mut().unwrap_or_else(PoisonError::into_inner);
        let mut emit_buffers = emit_buffers.take().unwrap_or_default();
        // what is near the faces of each body, and all of these
        let [mut near, mut members] = std::mem::take(&mut self.buffers.near);
        near.clear();
        let mut groups: SmallVec<[FaceBatch; 16]> = SmallVec::new();
        // of one body, and of those that a new body may cover or those that it may not
        let is_covered = |entry: &OperandFace| {
            let Known::Covered(_, by) = of_others else { return false };
            let (body, face) = (self.body_at(entry.operand), entry.face.index());
            by != entry.operand
                && can_cover(self.body_at(by), &body.faces[face], &self.operand(entry.operand).edges[face])
        };
        let faces: SmallVec<[(OperandFace, bool); 32]> =
            faces.iter().map(|entry| (*entry, is_covered(entry))).collect();
        for group in faces.chunk_by(|a, b| (a.0.operand, a.1) == (b.0.operand, b.1)) {
            let (OperandFace { operand: number, .. }, is_covered) = group[0];
            let body = self.body_at(number);
            let boxes = group.iter().map(|(entry, _)| &body.faces[entry.face.index()].bounds);
            let mut bounds = boxes.fold(Bounds::EMPTY, |all, bounds| all.union(bounds));
            let way = match of_others {
                _ if changed.binary_search(&number).is_ok() => Way::Whole,
                Known::Covered(_, by) if is_covered => Way::Covered(by),
                Known::Covered(near, _) | Known::Vicinity(near) if !near.bounds.holds(&bounds) => {
                    bounds = bounds.intersection(&near.around);
                    Way::Within(near.bounds)
                }
                Known::Covered(..) | Known::Vicinity(_) | Known::Nothing => Way::Whole,
            };
            let (start, first) = (near.len(), groups.last().map_or(0, |group| group.faces.end));
            match (way, surroundings.near(&bounds)) {
                (Way::Covered(by), _) => near.extend([number, by].map(|operand| self.member(operand))),
                (Way::Whole | Way::Within(_), Some(here)) => near.extend(here),
                (Way::Whole | Way::Within(_), None) => {
                    near.extend(self.places.near(&bounds).map(|(operand, _)| self.member(operand)));
                }
            }
            // a face may be so small that its box has no area
            if !near[start..].iter().any(|member| member.operand == number) {
                near.push(self.member(number));
            }
            near[start..].sort_unstable();
            groups.push(FaceBatch { number, near: start..near.len(), faces: first..first + group.len(), way });
        }
        // each once, and mostly in order
        place.resize(self.operands.len(), BodyId::NONE);
        let mut is_first = |member: &Member| {
            let place = &mut place[member.operand.index()];
            std::mem::replace(place, BodyId::from_index(0)) == BodyId::NONE
        };
        members.clear();
        members.extend(near.iter().filter(|member| is_first(member)));
        members.iter().for_each(|member| place[member.operand.index()] = BodyId::NONE);
        members.sort_unstable();
        let role = |member: &Member| self.operand(member.operand).state.role;
        let member = |leaf: LeafId| self.operand(members[leaf.index()].operand);
        let faces_of = |leaf: LeafId| self.body_at(members[leaf.index()].operand).planes_and_materials();
        let all_kinds = kinds(members.len(), faces_of, |leaf| member(leaf).mark);
        // equal bodies are near the same faces, so all are among these; what the tree is near does not tell for all of them what they do
        let polarity = |leaf: LeafId| self.tree.polarity(members[leaf.index()].at, role(&members[leaf.index()]));
        let all_polarities = common_polarities(&all_kinds, polarity);
        let nodes = self.tree.near(&mut members, role);
        let first = all_kinds.len() - members.len();
        let (kinds, polarities) = (&all_kinds[first..], &all_polarities[first..]);
        let body = |leaf: LeafId| self.body_at(members[leaf.index()].operand);
        let expression = Expression::new(&nodes);
        let repeated = expression.repeated_leaves(kinds);
        let leaves: SmallVec<[LeafId; 32]> =
            LeafId::all(members.len()).filter(|leaf| !repeated[leaf.index()]).collect();
        for (k, leaf) in BodyId::all(leaves.len()).zip(&leaves) {
            place[members[leaf.index()].operand.index()] = k;
        }
        let bodies: Vec<&Body> = leaves.iter().map(|leaf| body(*leaf)).collect();
        let table = &self.planes.table;
        let scene =
            Scene::of_some(table, bodies, &leaves, (&expression, polarities), &self.bodies_on_plane, &self.rank);
        let emit = |groups: &[FaceBatch], EmitBuffers { worker, edges, near_here }: &mut EmitBuffers| {
            let mut found = Found::default();
            for FaceBatch { number, near: range, faces: of_group, way } in groups {
                let own = place[number.index()];
                near_here.clear();
                let places = near[range.clone()].iter().map(|member| place[member.operand.index()]);
                near_here.extend(places.filter(|place| *place != BodyId::NONE));
                if own != BodyId::NONE {
                    worker.begin(&scene, own, near_here.iter().copied());
                }
                for (entry, _) in &faces[of_group.clone()] {
                    let known = &self.operand(*number).edges[entry.face.index()];
                    let ends = |edge| self.welded.ends(edge);
                    edges.clear();
                    if own != BodyId::NONE && !matches!(way, Way::Covered(_)) {
                        worker.emit(&scene, entry.face, edges);
                        edges.sort_unstable();
                    }
                    let change = match way {
                        Way::Whole => Some(EdgeChange::between(known, edges)),
                        Way::Within(bounds) => EdgeChange::within(bounds, table, known, ends, edges),
                        Way::Covered(by) => match place[by.index()] {
                            by if [own, by].contains(&BodyId::NONE) => None,
                            by => worker.cover_known(&scene, by, entry.face, known, ends),
                        },
                    };
                    match change {
                        Some(change) if change.is_empty() => {}
                        Some(change) => found.changes.push((*entry, change)),
                        None => found.unfit.push(*entry),
                    }
                }
            }
            found
        };
        let parts = if faces.len() < FACES_FOR_THREADS {
            vec![emit(&groups, &mut emit_buffers)]
        } else {
            let groups: Vec<FaceBatch> = groups.into_iter().flat_map(FaceBatch::split).collect();
            map_chunks(&groups, 1, |groups| emit(groups, &mut EmitBuffers::default())).0
        };
        for member in &members {
            place[member.operand.index()] = BodyId::NONE;
        }
        (self.buffers.place, self.buffers.near) = (place, [near, members]);
        self.buffers.emit = Mutex::new(Some(emit_buffers));
        parts
    }

    /// Hands the weld what has changed on faces.
    pub(super) fn exchange(&mut self, found: &[Found]) {
        let changes = || found.iter().flat_map(|found| &found.changes);
        for (OperandFace { operand, face }, change) in changes() {
            let operand = self.operands[operand.index()].as_mut().expect("the brush is there");
            take_out(&mut self.welded, &mut operand.edges[face.index()], &change.removed);
        }
        let count = changes().map(|(_, change)| change.added.len()).sum();
        self.welded.reserve(count);
        let mut added = Vec::with_capacity(count);
        added.extend(changes().flat_map(|(_, change)| &change.added));
        let mut numbers = self.welded.insert(&self.planes.table, &added).into_iter();
        drop(added);
        for (OperandFace { operand, face }, change) in changes().filter(|(_, change)| !change.added.is_empty()) {
            let operand = self.operands[operand.index()].as_mut().expect("the brush is there");
            let known = &mut operand.edges[face.index()];
            let is_new = known.is_empty();
            known.reserve(change.added.len());
            known.extend(change.added.iter().copied().zip(&mut numbers));
            if !is_new {
                // two sorted runs are merged
                known.sort_by_key(|known| known.0);
            }
        }
    }
}

/// Faces of one body that are worked out in a row: a range among the faces, and one among the bodies near.
struct FaceBatch {
    number: OperandId,
    near: Range<usize>,
    faces: Range<usize>,
    way: Way,
}

impl FaceBatch {
    /// Groups of a few faces each.
    fn split(self) -> impl Iterator<Item = Self> {
        let Self { number, near, faces, way } = self;
        let end = faces.end;
        faces.step_by(FACES_OF_GROUP).map(move |start| Self {
            number,
            near: near.clone(),
            faces: start..end.min(start + FACES_OF_GROUP),
            way,
        })
    }
}

/// Takes some edges known on a face out of them and out of the weld, by their places, ascending.
fn take_out(welded: &mut LiveWeld, known: &mut Vec<KnownEdge>, removed: &[u32]) {
    for place in removed {
        welded.remove(known[*place as usize].1);
    }
    if !removed.is_empty() {
        let mut gone = removed.iter().peekable();
        let mut place = 0;
        known.retain(|_| {
            let is_gone = gone.next_if_eq(&&place).is_some();
            place += 1;
            !is_gone
        });
    }
}
