//! How far a change of brushes reaches: the faces on which the boundary may be another.

use super::LiveModel;
use super::bodies::{MANY, Placed};
use super::boundary::Vicinity;
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
    /// reach into them or into what they were; and, where that is known, where on the latter it may.
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
    ) -> (Vec<OperandFace>, Option<Vicinity>) {
        let mut faces = std::mem::take(&mut self.buffers.faces);
        faces.clear();
        let mut within = Bounds::EMPTY;
        let mut is_local = true;
        let body_of = |number: OperandId| self.operands[number.index()].as_ref()?.body.as_ref();
        let all_of = |operand: OperandId| {
            let count = body_of(operand).map_or(0, |body| body.faces.len());
            BodyFaceId::all(count).map(move |face| OperandFace { operand, face })
        };
        if reach == Reach::Everywhere || (changed.len() >= self.by_id.len() && local.is_empty()) {
            faces.extend(OperandId::all(self.operands.len()).flat_map(all_of));
            is_local = false;
        } else {
            for placed in old {
                let number = placed.number;
                let difference = placed.difference.as_ref();
                let difference =
                    difference.filter(|_| local.contains(&number) && self.has_no_equal(self.operand(number)));
                let bodies = [body_of(number), placed.body.as_ref()];
                match difference {
                    Some(difference) if difference.bounds == Bounds::EMPTY => {}
                    Some(difference) => {
                        within = within.union(&difference.bounds);
                        let others = bodies.into_iter().flatten();
                        others.for_each(|body| self.touch(body, number, &difference.bounds, false, &mut faces));
                        faces.extend(difference.faces.iter().map(|face| OperandFace { operand: number, face: *face }));
                    }
                    None => {
                        within = bodies.iter().flatten().fold(within, |all, body| all.union(&body.bounds));
                        for (body, is_last) in bodies.into_iter().zip([reach == Reach::Appended, false]) {
                            body.into_iter()
                                .for_each(|body| self.touch(body, number, &body.bounds, is_last, &mut faces));
                        }
                        faces.extend(all_of(number));
                    }
                }
            }
        }
        faces.sort_unstable();
        faces.dedup();
        (faces, if is_local { Vicinity::of(&within) } else { None })
    }

    /// Notes the faces of other bodies that may reach into a part of a body, in a box. A body that comes last and does not
    /// intersect can only take away from the boundary on them, but where it has a face on their plane.
    fn touch(&self, by: &Body, own: OperandId, within: &Bounds, is_last: bool, faces: &mut Vec<OperandFace>) {
        let table = &self.planes.table;
        for (other, _) in self.places.near(within).filter(|(other, _)| *other != own) {
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
        }
    }
}
