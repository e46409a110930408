//! How far a change of brushes reaches: the faces on which the boundary may be another.

use smallvec::SmallVec;

use super::LiveModel;
use super::bodies::{Difference, MANY, Placed};
use super::boundary::{Surroundings, Vicinity};
use super::history::New;
use super::operand::Operand;
use super::tree::Extent;
use crate::base::Bounds;
use crate::body::{Body, BodyFace};
use crate::boundary::misses;
use crate::ids::{BodyFaceId, Id, OperandFace, OperandId};

/// How far a change of brushes reaches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Reach {
    /// To what they or their old bodies touch.
    Near,
    /// To the boundary near them: they are the last ones, and new.
    Appended,
    /// To everything, as what lies outside of an intersecting brush is taken away.
    Everywhere,
}

impl Reach {
    /// How far a change reaches, as the tree tells.
    pub(super) fn of(extent: &Extent) -> Self {
        if extent.is_everywhere {
            Self::Everywhere
        } else if extent.is_appended {
            Self::Appended
        } else {
            Self::Near
        }
    }
}

impl LiveModel {
    /// The brushes, ascending, among some that change, whose roles and places stay, and those of the operations above them, and whose bodies, still the old ones, have no equal.
    /// `before` are those that were edited, as they were.
    pub(super) fn local(&self, changed: &[OperandId], before: &[New], extent: &Extent) -> Vec<OperandId> {
        let is_local = |number: &OperandId| {
            let operand = self.operand(*number);
            let edited = before.iter().find(|(id, _)| *id == operand.id);
            let keeps_spot =
                edited.is_none_or(|(_, old)| old.as_ref().is_some_and(|old| old.spot() == operand.state.spot()));
            keeps_spot && !extent.brushes.contains(&operand.id) && self.has_no_equal(operand)
        };
        let few = if changed.len() < MANY { changed } else { &[] };
        few.iter().copied().filter(is_local).collect()
    }

    /// Whether no other body has the same planes and materials.
    pub(super) fn has_no_equal(&self, operand: &Operand) -> bool {
        operand.body.is_none() || self.marks.is_single(operand.mark)
    }

    /// The faces, sorted, on which the boundary may differ: those of the bodies that have changed, and those of others that
    /// reach into them or into what they were; and, where that is known, where on the latter it may, with what is around.
    ///
    /// Where a body alone is another, of brushes that do what they did, only the parts in which it differs matter: `local` are
    /// the brushes for which that may be so. It is not where one of several equal bodies changes, or one becomes equal to
    /// others: whether they add or take counts for the materials of all of them.
    pub(super) fn faces_to_redo(
        &mut self,
        changed: &[OperandId],
        old: &[Placed],
        reach: Reach,
        local: &[OperandId],
    ) -> (Vec<OperandFace>, (Option<Vicinity>, Surroundings)) {
        let mut faces = std::mem::take(&mut self.buffers.faces);
        faces.clear();
        if reach == Reach::Everywhere || (changed.len() >= self.by_id.len() && local.is_empty()) {
            faces.extend(OperandId::all(self.operands.len()).flat_map(|operand| self.faces_of(operand)));
            return (faces, (None, self.surroundings(None)));
        }
        let old: SmallVec<[(&Placed, Option<&Difference>); 4]> = old
            .iter()
            .map(|placed| {
                let is_all = || local.contains(&placed.number) && self.has_no_equal(self.operand(placed.number));
                (placed, placed.difference.as_ref().filter(|_| is_all()))
            })
            .collect();
        let bounds = |(placed, difference): &(&Placed, Option<&Difference>)| match difference {
            Some(difference) => difference.bounds,
            None => self.bodies_of(placed).fold(Bounds::EMPTY, |all, body| all.union(&body.bounds)),
        };
        let within = old.iter().map(bounds).fold(Bounds::EMPTY, |all, bounds| all.union(&bounds));
        let vicinity = Vicinity::of(&within);
        let surroundings = self.surroundings(vicinity);
        for (placed, difference) in old {
            let number = placed.number;
            match difference {
                Some(difference) if difference.bounds == Bounds::EMPTY => {}
                Some(Difference { bounds, faces: own }) => {
                    for body in self.bodies_of(placed) {
                        self.touch(body, number, (bounds, &surroundings), false, &mut faces);
                    }
                    faces.extend(own.iter().map(|face| OperandFace { operand: number, face: *face }));
                }
                None => {
                    // the body that is there now, and the one before
                    for (body, is_now) in self.bodies_of(placed).zip([self.operand(number).body.is_some(), false]) {
                        let is_last = is_now && reach == Reach::Appended;
                        self.touch(body, number, (&body.bounds, &surroundings), is_last, &mut faces);
                    }
                    faces.extend(self.faces_of(number));
                }
            }
        }
        faces.sort_unstable();
        faces.dedup();
        (faces, (vicinity, surroundings))
    }

    /// All faces of the body of a brush.
    fn faces_of(&self, operand: OperandId) -> impl Iterator<Item = OperandFace> + use<> {
        let body = self.operands[operand.index()].as_ref().and_then(|operand| operand.body.as_ref());
        let count = body.map_or(0, |body| body.faces.len());
        BodyFaceId::all(count).map(move |face| OperandFace { operand, face })
    }

    /// The body of a brush as it is, and as it was, where there are any.
    fn bodies_of<'a>(&'a self, placed: &'a Placed) -> impl Iterator<Item = &'a Body> {
        self.operand(placed.number).body.iter().chain(&placed.body)
    }

    /// Notes the faces of other bodies that may reach into a part of a body, in a box. A body that comes last and does not
    /// intersect can only take away from the boundary on them, but where it has a face on their plane.
    fn touch(
        &self,
        by: &Body,
        own: OperandId,
        (within, surroundings): (&Bounds, &Surroundings),
        is_last: bool,
        faces: &mut Vec<OperandFace>,
    ) {
        let table = &self.planes.table;
        let mut note = |other: OperandId| {
            if other == own {
                return;
            }
            let (body, edges) = (self.body_at(other), &self.operand(other).edges);
            let reaches = |(number, face): &(BodyFaceId, &BodyFace)| {
                let half_space = table.half_space(face.plane);
                let may_matter = || !is_last || !edges[number.index()].is_empty() || by.face_on(face.plane).is_some();
                face.bounds.may_share_area(within)
                    && may_matter()
                    && !misses(within, half_space.normal(), half_space.offset())
                    && !by.is_surely_apart_from(table, body.corners(face))
            };
            let reaching = BodyFaceId::all(body.faces.len()).zip(&body.faces).filter(reaches);
            faces.extend(reaching.map(|(face, _)| OperandFace { operand: other, face }));
        };
        match surroundings.near(within) {
            Some(here) => here.for_each(|member| note(member.operand)),
            None => self.places.near(within).for_each(|(other, _)| note(other)),
        }
    }
}
