//! Which of several coplanar faces emits the boundary.
//!
//! The rule, its truth table and its proof are in `docs/weld.md`, "Coplanar faces: who owns the boundary". Each of its
//! questions is a function here: [`boundary_here`], [`Ownership::emitting_leaf`], [`material_of`], and the order of turns
//! ([`Turn`]).

use super::contact::{Contact, Facing};
use super::face::Reaching;
use crate::body::BodyFace;
use crate::expression::{Expression, Polarity, Restriction};
use crate::ids::{BodyId, Id, KeptLeafId};
use crate::model::MaterialId;

/// A side of a directed edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum EdgeSide {
    Left,
    Right,
}

impl EdgeSide {
    pub(super) const BOTH: [Self; 2] = [Self::Left, Self::Right];

    /// The channel of the tree just inside of the face.
    pub(super) fn inside(self) -> usize {
        2 * self as usize
    }

    /// The channel of the tree just outside of the face.
    pub(super) fn outside(self) -> usize {
        2 * self as usize + 1
    }
}

/// The faces on a plane that change together, as far as it can be seen.
///
/// Bodies that take from the solid come before those that add to it, so that a tool that merely touches a body from outside
/// does not give it its material. Then the name of the material decides, so that the outcome does not depend on the order of
/// the bodies. Equal bodies are in one round, so it does not depend on how often the tree names a body either.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Round {
    /// That of all bodies which equal the one of the face.
    pub(super) polarity: Polarity,
    /// The place of the face's material by name.
    pub(super) material_rank: u32,
}

/// When a body's face on a plane has its turn among all faces on that plane: a total order, as numbers of bodies differ
/// and no body has two faces on one plane. All of a round are of one material, so which of them emits changes nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Turn {
    pub(super) round: Round,
    pub(super) body: BodyId,
}

/// Whether there is boundary on a side of an edge on a face, and which way it faces: where the tree differs between just inside and
/// just outside of the face.
fn boundary_here(restriction: &Restriction, side: EdgeSide) -> Option<Facing> {
    Facing::between(restriction.root(side.inside()), restriction.root(side.outside()))
}

/// The material of the boundary that a face emits: its own, also where it is the face of a tool.
pub(super) fn material_of(emitting: &BodyFace) -> MaterialId {
    emitting.material
}

/// What is known of either side of an edge on a face: the values of the leaves, kept in the channels of a restriction, and the faces
/// on the plane.
#[derive(Debug, Clone)]
pub(super) struct Ownership {
    own: KeptLeafId,
    /// For each side the bodies with a face on the plane that covers it, this one among them, by turn.
    coplanar: [Vec<Reaching>; 2],
}

impl Default for Ownership {
    fn default() -> Self {
        Self { own: KeptLeafId::NONE, coplanar: Default::default() }
    }
}

impl Ownership {
    /// Nothing but a body itself is known to lie on either side of an edge on its face.
    pub(super) fn begin(&mut self, expression: &Expression, restriction: &mut Restriction, own: &Reaching) {
        self.own = own.leaf;
        self.coplanar.iter_mut().for_each(Vec::clear);
        self.cover_both(expression, restriction, own);
    }

    /// The boundary that the face itself emits on a side: there is one, and no other face owns it.
    pub(super) fn emitted(
        &self,
        expression: &Expression,
        restriction: &mut Restriction,
        side: EdgeSide,
    ) -> Option<Facing> {
        let facing = boundary_here(restriction, side)?;
        (self.emitting_leaf(expression, restriction, side, facing) == self.own).then_some(facing)
    }

    /// The leaf whose face emits the boundary on a side.
    ///
    /// The coplanar bodies take their turns from the empty side to the solid one. In the first round after which the tree is solid the one
    /// emits at whose turn it became so for the last time.
    fn emitting_leaf(
        &self,
        expression: &Expression,
        restriction: &mut Restriction,
        side: EdgeSide,
        facing: Facing,
    ) -> KeptLeafId {
        let coplanar = &self.coplanar[side as usize];
        if let [only] = coplanar.as_slice() {
            return only.leaf;
        }
        // the channel of the empty side is where turns are taken, and undone afterwards
        let empty = facing.empty_of([side.inside(), side.outside()]);
        let mut taken = 0;
        let mut is_solid = false;
        let mut emitting = None;
        for round in coplanar.chunk_by(|a, b| a.turn.round == b.turn.round) {
            for body in round {
                taken += 1;
                restriction.set(expression, body.leaf, empty, facing.solid_of(body.contact.sides()));
                let was_solid = std::mem::replace(&mut is_solid, restriction.root(empty));
                if is_solid && !was_solid {
                    emitting = Some(body.leaf);
                }
            }
            if is_solid {
                break;
            }
        }
        for body in &coplanar[..taken] {
            restriction.set(expression, body.leaf, empty, facing.empty_of(body.contact.sides()));
        }
        emitting.filter(|_| is_solid).expect("after all turns every leaf is as on the solid side")
    }

    /// Takes a body as covering both sides.
    pub(super) fn cover_both(&mut self, expression: &Expression, restriction: &mut Restriction, body: &Reaching) {
        for side in EdgeSide::BOTH {
            self.set_cover(expression, restriction, body, side, true);
        }
    }

    /// Takes a body as covering one side, or not.
    pub(super) fn set_cover(
        &mut self,
        expression: &Expression,
        restriction: &mut Restriction,
        body: &Reaching,
        side: EdgeSide,
        covers: bool,
    ) {
        let [inside, outside] = body.contact.sides();
        restriction.set(expression, body.leaf, side.inside(), inside && covers);
        restriction.set(expression, body.leaf, side.outside(), outside && covers);
        if body.contact == Contact::Across {
            return;
        }
        let coplanar = &mut self.coplanar[side as usize];
        let place = coplanar.partition_point(|other| other.turn < body.turn);
        if covers {
            coplanar.insert(place, *body);
        } else {
            coplanar.remove(place);
        }
    }
}
