//! The boundary on the faces that an edit touches.

use std::ops::Range;

use super::LiveModel;
use super::tree::Member;
use crate::base::{Bounds, map_chunks};
use crate::body::{Body, kinds};
use crate::boundary::{BoundaryEdge, FaceWorker, Scene};
use crate::expression::Expression;
use crate::ids::{BodyId, EdgeId, Id, LeafId, OperandFace, OperandId};
use crate::plane_table::PlaneTable;
use crate::weld::LiveWeld;

/// Number of faces from which several threads work on them: waking them takes as long as a few faces.
const FACES_FOR_THREADS: usize = 64;

/// Number of faces of a body that a thread works out in a row then.
const FACES_OF_GROUP: usize = 20;

/// What was found on some faces: the edges, and where those of each face end.
type Found = (Vec<BoundaryEdge>, Vec<usize>);

impl LiveModel {
    /// Works out the boundary on some faces, sorted.
    pub(super) fn boundary_edges(&mut self, faces: &[OperandFace]) -> Vec<Found> {
        let mut place = std::mem::take(&mut self.buffers.place);
        // what is near the faces of each body
        let mut near: Vec<Member> = Vec::new();
        let mut groups: Vec<FaceBatch> = Vec::new();
        for of_body in faces.chunk_by(|a, b| a.operand == b.operand) {
            let number = of_body[0].operand;
            let body = self.body_at(number);
            let boxes = of_body.iter().map(|entry| &body.faces[entry.face.index()].bounds);
            let bounds = boxes.fold(Bounds::EMPTY, |all, bounds| all.union(bounds));
            let (start, first) = (near.len(), groups.last().map_or(0, |group| group.faces.end));
            near.extend(self.places.near(&bounds).map(|operand| Member { at: self.position(operand), operand }));
            near[start..].sort_unstable();
            groups.push(FaceBatch { number, near: start..near.len(), faces: first..first + of_body.len() });
        }
        let mut members = near.clone();
        members.sort_unstable();
        members.dedup();
        let nodes = self.tree.near(&mut members, |member| self.operand(member.operand).state.role);
        let member = |leaf: LeafId| self.operand(members[leaf.index()].operand);
        let body = |leaf: LeafId| self.body_at(members[leaf.index()].operand);
        let expression = Expression::new(&nodes);
        let kinds = kinds(members.len(), |leaf| body(leaf).planes_and_materials(), |leaf| member(leaf).mark);
        let repeated = expression.repeated_leaves(&kinds);
        let leaves: Vec<LeafId> = LeafId::all(members.len()).filter(|leaf| !repeated[leaf.index()]).collect();
        place.resize(self.operands.len(), BodyId::NONE);
        for (k, leaf) in BodyId::all(leaves.len()).zip(&leaves) {
            place[members[leaf.index()].operand.index()] = k;
        }
        let bodies: Vec<&Body> = leaves.iter().map(|leaf| body(*leaf)).collect();
        let table = &self.planes.table;
        let scene = Scene::of_some(table, bodies, &leaves, &expression, &self.bodies_on_plane, &self.rank);
        let emit = |groups: &[FaceBatch]| {
            let mut worker = FaceWorker::new(&scene);
            let (mut found, mut ends, mut near_here) = (Vec::new(), Vec::new(), Vec::new());
            for FaceBatch { number, near: range, faces: of_group } in groups {
                let own = place[number.index()];
                near_here.clear();
                let places = near[range.clone()].iter().map(|member| place[member.operand.index()]);
                near_here.extend(places.filter(|place| *place != BodyId::NONE));
                if own != BodyId::NONE {
                    worker.begin(own, near_here.len());
                }
                for OperandFace { face, .. } in &faces[of_group.clone()] {
                    if own != BodyId::NONE {
                        let start = found.len();
                        worker.emit(own, *face, &near_here, &mut found);
                        found[start..].sort_unstable();
                    }
                    ends.push(found.len());
                }
            }
            (found, ends)
        };
        let parts = if faces.len() < FACES_FOR_THREADS {
            vec![emit(&groups)]
        } else {
            let groups: Vec<FaceBatch> = groups.into_iter().flat_map(FaceBatch::split).collect();
            map_chunks(&groups, 1, emit).0
        };
        for member in &members {
            place[member.operand.index()] = BodyId::NONE;
        }
        self.buffers.place = place;
        parts
    }

    /// Hands the weld what has changed on faces that were worked out again.
    pub(super) fn exchange(&mut self, faces: &[OperandFace], found: Vec<Found>) {
        let mut of_part = faces.iter();
        for (found, ends) in found {
            let mut start = 0;
            for (end, OperandFace { operand, face }) in ends.into_iter().zip(&mut of_part) {
                let operand = self.operands[operand.index()].as_mut().expect("the brush is there");
                let known = &mut operand.edges[face.index()];
                exchange(&mut self.welded, &self.planes.table, known, &found[start..end]);
                start = end;
            }
        }
    }
}

/// Faces of one body that are worked out in a row: a range among the faces, and one among the bodies near.
struct FaceBatch {
    number: OperandId,
    near: Range<usize>,
    faces: Range<usize>,
}

impl FaceBatch {
    /// Groups of a few faces each.
    fn split(self) -> impl Iterator<Item = Self> {
        let Self { number, near, faces } = self;
        let end = faces.end;
        faces.step_by(FACES_OF_GROUP).map(move |start| Self {
            number,
            near: near.clone(),
            faces: start..end.min(start + FACES_OF_GROUP),
        })
    }
}

/// Puts the edges that were found on a face in the place of those known, both sorted; what stays the same is not touched.
fn exchange(
    welded: &mut LiveWeld,
    table: &PlaneTable,
    known: &mut Vec<(BoundaryEdge, EdgeId)>,
    found: &[BoundaryEdge],
) {
    if known.iter().map(|edge| &edge.0).eq(found.iter()) {
        return;
    }
    let mut before = std::mem::take(known).into_iter().peekable();
    for edge in found {
        while let Some((_, gone)) = before.next_if(|other| other.0 < *edge) {
            welded.remove(gone);
        }
        known.push(before.next_if(|other| other.0 == *edge).unwrap_or_else(|| (*edge, welded.insert(table, edge))));
    }
    before.for_each(|(_, gone)| welded.remove(gone));
}
