//! The boundary on the faces that an edit touches.

use std::ops::Range;

use super::LiveModel;
use super::order::{restricted, sequence};
use crate::base::{Bounds, map_chunks};
use crate::body::{Body, kinds};
use crate::boundary::{BoundaryEdge, FaceWorker, Scene};
use crate::expression::Expression;
use crate::ids::EdgeId;
use crate::plane_table::PlaneTable;
use crate::weld::LiveWeld;

/// Number of faces from which several threads work on them: waking them takes as long as a few faces.
const FACES_FOR_THREADS: usize = 64;

/// Number of faces of a body that a thread works out in a row then.
const FACES_OF_GROUP: usize = 20;

/// No place.
const NOWHERE: u32 = u32::MAX;

/// What was found on some faces: the edges, and where those of each face end.
type Found = (Vec<BoundaryEdge>, Vec<usize>);

impl LiveModel {
    /// Works out the boundary on some faces, sorted.
    pub(super) fn boundary_edges(&mut self, faces: &[(u32, u32)]) -> Vec<Found> {
        let mut place = std::mem::take(&mut self.buffers.place);
        let id = |number: u32| self.operand(number).id;
        // what is near the faces of each body
        let mut near: Vec<(u64, u32)> = Vec::new();
        let mut groups: Vec<FaceBatch> = Vec::new();
        for of_body in faces.chunk_by(|a, b| a.0 == b.0) {
            let number = of_body[0].0;
            let body = self.body_at(number);
            let boxes = of_body.iter().map(|(_, face)| &body.faces[*face as usize].bounds);
            let bounds = boxes.fold(Bounds::EMPTY, |all, bounds| all.union(bounds));
            let (start, first) = (near.len(), groups.last().map_or(0, |group| group.faces.end));
            near.extend(self.places.near(&bounds).map(|number| (id(number), number)));
            near[start..].sort_unstable();
            groups.push(FaceBatch { number, near: start..near.len(), faces: first..first + of_body.len() });
        }
        let mut members = near.clone();
        members.sort_unstable();
        members.dedup();
        // nothing is left of what lies before an intersecting brush that does not come near
        let far = self.intersecting.iter().rev().find(|entry| members.binary_search(entry).is_err());
        if let Some((id, _)) = far {
            members.retain(|member| member.0 > *id);
        }
        let member = |leaf: u32| self.operand(members[leaf as usize].1);
        let body = |leaf: u32| self.body_at(members[leaf as usize].1);
        let is_member = |leaf: u32| members.binary_search_by_key(&u64::from(leaf), |member| member.0).is_ok();
        let base = self.base.as_ref().filter(|_| far.is_none()).map(|base| restricted(&base.nodes, is_member));
        let in_base = self.base.as_ref().map_or(0, |base| u64::from(base.leaves));
        let in_sequence = members.partition_point(|member| member.0 < in_base) as u32..members.len() as u32;
        let roles = in_sequence.map(|leaf| member(leaf).state.role);
        let expression = Expression::new(&sequence(base.unwrap_or_default(), roles));
        let kinds = kinds(members.len(), |leaf| &body(leaf).faces, |leaf| member(leaf).mark);
        let repeated = expression.repeated_leaves(&kinds);
        let leaves: Vec<u32> = (0..members.len() as u32).filter(|leaf| !repeated[*leaf as usize]).collect();
        place.resize(self.operands.len(), NOWHERE);
        for (k, leaf) in (0..).zip(&leaves) {
            place[members[*leaf as usize].1 as usize] = k;
        }
        let bodies: Vec<&Body> = leaves.iter().map(|leaf| body(*leaf)).collect();
        let table = &self.planes.table;
        let scene = Scene::of_some(table, bodies, &leaves, &expression, &self.bodies_on_plane, &self.rank);
        let emit = |groups: &[FaceBatch]| {
            let mut worker = FaceWorker::new(&scene);
            let (mut found, mut ends, mut near_here) = (Vec::new(), Vec::new(), Vec::new());
            for FaceBatch { number, near: range, faces: of_group } in groups {
                let own = place[*number as usize];
                near_here.clear();
                let places = near[range.clone()].iter().map(|(_, number)| place[*number as usize]);
                near_here.extend(places.filter(|place| *place != NOWHERE));
                if own != NOWHERE {
                    worker.begin(own as usize, near_here.len());
                }
                for (_, face) in &faces[of_group.clone()] {
                    if own != NOWHERE {
                        let start = found.len();
                        worker.emit(own as usize, *face as usize, &near_here, &mut found);
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
        for (_, number) in &members {
            place[*number as usize] = NOWHERE;
        }
        self.buffers.place = place;
        parts
    }

    /// Hands the weld what has changed on faces that were worked out again.
    pub(super) fn exchange(&mut self, faces: &[(u32, u32)], found: Vec<Found>) {
        let mut of_part = faces.iter();
        for (found, ends) in found {
            let mut start = 0;
            for (end, (number, face)) in ends.into_iter().zip(&mut of_part) {
                let operand = self.operands[*number as usize].as_mut().expect("the brush is there");
                let known = &mut operand.edges[*face as usize];
                exchange(&mut self.welded, &self.planes.table, known, &found[start..end]);
                start = end;
            }
        }
    }
}

/// Faces of one body that are worked out in a row: a range among the faces, and one among the bodies near.
struct FaceBatch {
    number: u32,
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
