//! The order of facets around an edge.

use std::cmp::Ordering;

use planecut_kernel::sign::Sign;

use super::Arrangement;
use super::facets::{Facets, Side};
use super::predicates::{best_axis, cross_of_normals, normal_component};
use crate::ids::{Id, TriangleId};

/// Facets around an edge, counter-clockwise as seen against the direction from its smaller end to its larger one.
pub(super) struct Around<'a> {
    arrangement: &'a Arrangement,
    /// An axis to which the edge is not perpendicular, and its direction along it.
    axis: usize,
    direction: Sign,
}

/// A half-plane that begins at the edge: that of a triangle, and whether its normal, with the edge, points counter-clockwise.
type HalfPlane = (TriangleId, bool);

impl<'a> Around<'a> {
    pub(super) fn new(arrangement: &'a Arrangement, side: &Side) -> Self {
        let Arrangement { surface, points, .. } = arrangement;
        let [a, b] = side.ends;
        let (axis, order) = points.axis_between(surface, a, b);
        let direction = match order {
            Ordering::Less => Sign::Positive,
            Ordering::Equal => Sign::Zero,
            Ordering::Greater => Sign::Negative,
        };
        Self { arrangement, axis, direction }
    }

    fn half_plane(&self, facets: &Facets, side: &Side) -> HalfPlane {
        (facets.triangle(&self.arrangement.cells, side.facet), side.is_forward)
    }

    /// Whether the second half-plane is less than half a turn ahead of the first, positive, or behind it, negative; zero where both are in
    /// one plane.
    fn ahead(&self, one: HalfPlane, other: HalfPlane) -> Sign {
        let Arrangement { surface, planes, .. } = self.arrangement;
        if planes[one.0.index()] == planes[other.0.index()] {
            return Sign::Zero;
        }
        let sign = cross_of_normals(surface, one.0, other.0, self.axis).times(self.direction);
        if one.1 == other.1 { sign } else { sign.flip() }
    }

    /// Whether two half-planes in one plane are the same.
    fn are_one(&self, one: HalfPlane, other: HalfPlane) -> bool {
        let surface = &self.arrangement.surface;
        let Some((axis, sign)) = best_axis(surface, one.0) else { return false };
        (normal_component(surface, other.0, axis) == sign) == (one.1 == other.1)
    }

    /// Which part of a turn it is from one half-plane to another: none, less than half, half, more.
    fn quarter(&self, one: HalfPlane, other: HalfPlane) -> u8 {
        match self.ahead(one, other) {
            Sign::Positive => 1,
            Sign::Zero if self.are_one(one, other) => 0,
            Sign::Zero => 2,
            Sign::Negative => 3,
        }
    }

    /// Sorts the sides at the edge counter-clockwise, from the first one on.
    pub(super) fn sort(&self, facets: &Facets, sides: &mut [Side]) {
        let Some((first, rest)) = sides.split_first_mut() else { return };
        let first = self.half_plane(facets, first);
        if rest.len() < 2 {
            return;
        }
        let quarter = |side: &Side| self.quarter(first, self.half_plane(facets, side));
        rest.sort_by(|a, b| {
            quarter(a).cmp(&quarter(b)).then_with(|| {
                match self.ahead(self.half_plane(facets, a), self.half_plane(facets, b)) {
                    Sign::Positive => Ordering::Less,
                    Sign::Zero => a.facet.cmp(&b.facet),
                    Sign::Negative => Ordering::Greater,
                }
            })
        });
    }

    /// The place, among sorted sides, of the first one after the direction `(ε, ε², ε³)` from the edge.
    pub(super) fn after_direction(&self, facets: &Facets, sides: &[Side]) -> usize {
        let surface = &self.arrangement.surface;
        let is_ahead = |half_plane: HalfPlane| {
            let sign =
                (0..3).map(|axis| normal_component(surface, half_plane.0, axis)).find(|sign| *sign != Sign::Zero);
            (sign == Some(Sign::Positive)) == half_plane.1
        };
        let is_in_gap = |k: usize| {
            let [one, other] = [k, (k + 1) % sides.len()].map(|k| self.half_plane(facets, &sides[k]));
            match self.quarter(one, other) {
                0 => false,
                1 => is_ahead(one) && !is_ahead(other),
                2 => is_ahead(one),
                _ => is_ahead(one) || !is_ahead(other),
            }
        };
        // without a gap all are in one half-plane
        (0..sides.len()).find(|k| is_in_gap(*k)).map_or(0, |k| (k + 1) % sides.len())
    }
}
