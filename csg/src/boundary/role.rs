//! What another body does to a face, as far as the two bodies alone tell, whatever the others are.
//!
//! Most bodies either leave nothing of a face where they are (another operand of a union), or leave nothing where they are not
//! (the block, for a face of the tool): the face is cut to those before the tree is evaluated anywhere. Each function states
//! one lemma of `docs/weld.md`, "Coplanar faces: who owns the boundary".

use super::contact::{Contact, Facing};
use super::face::Reaching;
use crate::expression::{Expression, Polarity, Restriction};

/// What a body does to a face of another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    /// Nothing: the face emits the same with and without it.
    None,
    /// Outside of it the face emits nothing.
    Required,
    /// Inside of it, or on its face, the face emits nothing.
    Covers,
    /// It depends on others.
    Open,
}

/// The body of a face and another that reaches its plane.
pub(super) struct Pair<'a> {
    expression: &'a Expression,
    restriction: &'a Restriction,
    own: &'a Reaching,
    /// Whether the own leaf adds or takes, whatever leaves that equal it do.
    polarity: Polarity,
    other: &'a Reaching,
    /// How many bodies besides the own one have a face on the plane.
    coplanar: usize,
    /// The value of the tree just inside and just outside of the face, where the own body alone decides it.
    by_own: [Option<bool>; 2],
    /// The same where the other body alone decides it.
    by_other: [Option<bool>; 2],
}

impl<'a> Pair<'a> {
    pub(super) fn new(
        expression: &'a Expression,
        restriction: &'a Restriction,
        (own, polarity): (&'a Reaching, Polarity),
        other: &'a Reaching,
        coplanar: usize,
    ) -> Self {
        let by = |body: &Reaching| body.contact.sides().map(|value| restriction.decides(body.leaf, value));
        Self { expression, restriction, own, polarity, other, coplanar, by_own: by(own), by_other: by(other) }
    }

    pub(super) fn role(&self) -> Role {
        if Facing::BOTH.into_iter().all(|facing| self.never_emits_within(facing)) || self.is_no_boundary_within() {
            Role::Covers
        } else if self.is_silenced_outside() || Facing::BOTH.into_iter().all(|facing| self.never_emits_outside(facing))
        {
            Role::Required
        } else if self.own_decides_both_sides() || Facing::BOTH.into_iter().all(|facing| self.is_irrelevant(facing)) {
            Role::None
        } else {
            Role::Open
        }
    }

    /// Within the other body the own face emits no boundary that faces this way.
    fn never_emits_within(&self, facing: Facing) -> bool {
        self.is_against_polarity(facing)
            || self.is_impossible(facing, self.by_other)
            || self.is_decided_at_another_turn(facing)
            || self.is_silenced_at_own_turn(facing)
    }

    /// Outside of the other body, where that is 0 on both sides, the own face emits no boundary that faces this way.
    fn never_emits_outside(&self, facing: Facing) -> bool {
        self.is_against_polarity(facing)
            || self.is_impossible(facing, [self.restriction.decides(self.other.leaf, false); 2])
    }

    /// Outside of the other body the own turn changes nothing, as a node above both has one value.
    fn is_silenced_outside(&self) -> bool {
        self.forces(self.other, false, self.own).is_some()
    }

    /// Whether the face emits the same, in a boundary that faces this way, with and without the other body.
    fn is_irrelevant(&self, facing: Facing) -> bool {
        self.is_against_polarity(facing) || self.is_impossible(facing, [None; 2]) || self.is_idle_at_own_turn(facing)
    }

    /// The own turn makes the tree solid: where the body adds, it does so as it comes, so the boundary faces as the face does; where
    /// it takes, as it goes, so the boundary faces the other way.
    fn is_against_polarity(&self, facing: Facing) -> bool {
        match self.polarity {
            Polarity::Adds => facing == Facing::In,
            Polarity::Takes => facing == Facing::Out,
            Polarity::Both => false,
        }
    }

    /// One of the two bodies alone makes the side empty that should be solid, or the other one solid; `by_other` is what the other
    /// body decides on both sides.
    fn is_impossible(&self, facing: Facing, by_other: [Option<bool>; 2]) -> bool {
        let decided = [self.by_own[0].or(by_other[0]), self.by_own[1].or(by_other[1])];
        facing.solid_of(decided) == Some(false) || facing.empty_of(decided) == Some(true)
    }

    /// The other face alone makes the tree solid at an earlier turn, or keeps it empty until a later one.
    fn is_decided_at_another_turn(&self, facing: Facing) -> bool {
        let is_solid_before = self.other_is_before() && facing.solid_of(self.by_other) == Some(true);
        let is_empty_after = !self.other_is_before() && facing.empty_of(self.by_other) == Some(false);
        self.other_is_coplanar() && (is_solid_before || is_empty_after)
    }

    /// The own turn changes nothing, as the other body then forces the value of a node above both.
    fn is_silenced_at_own_turn(&self, facing: Facing) -> bool {
        let sides = self.other.contact.sides();
        let at_own_turn = if self.other_is_before() { facing.solid_of(sides) } else { facing.empty_of(sides) };
        self.forces(self.other, at_own_turn, self.own).is_some()
    }

    /// The tree is the same just inside and just outside of the face: these two are the only bodies that change there, and a
    /// node above both has one value on both sides. (With a third face on the plane, the node may have another value between
    /// turns, and that decides who emits.)
    fn is_no_boundary_within(&self) -> bool {
        let (own, other) = (self.own.contact.sides(), self.other.contact.sides());
        let node_above =
            |k: usize| self.forces(self.own, own[k], self.other).or(self.forces(self.other, other[k], self.own));
        self.coplanar == 1
            && self.other_is_coplanar()
            && node_above(0).is_some_and(|inside| node_above(1) == Some(inside))
    }

    /// The other body has a face on the plane, lies on a side that the own body alone decides, and is still or already
    /// absent at the own turn.
    fn is_idle_at_own_turn(&self, facing: Facing) -> bool {
        let sides = self.other.contact.sides();
        let comes_later = facing.solid_of(self.by_own).is_some() && facing.solid_of(sides) && !self.other_is_before();
        let is_gone = facing.empty_of(self.by_own).is_some() && facing.empty_of(sides) && self.other_is_before();
        self.other_is_coplanar() && (comes_later || is_gone)
    }

    fn own_decides_both_sides(&self) -> bool {
        self.by_own.iter().all(Option::is_some)
    }

    fn other_is_coplanar(&self) -> bool {
        self.other.contact != Contact::Across
    }

    fn other_is_before(&self) -> bool {
        self.other.turn < self.own.turn
    }

    /// The value that `by` forces upon the lowest node above both, with a value of its own; `upon` then changes nothing.
    fn forces(&self, by: &Reaching, value: bool, upon: &Reaching) -> Option<bool> {
        self.restriction.forces(self.expression, by.leaf, value, upon.leaf)
    }
}
