//! The order of half-planes around an edge.

use std::cmp::Ordering;

use planecut_kernel::sign::Sign;

use super::Arrangement;
use super::facets::{Facets, Side};
use super::input::Input;
use super::predicates::{Triangle, best_axis, cross_of_normals, normal_component};
use crate::ids::{Id, TriangleId};

/// What lies around an edge is sorted counter-clockwise as seen against the direction from its first end to its second one.
#[derive(Clone, Copy)]
pub(super) struct Around<'a> {
    input: &'a Input<'a>,
    /// An axis to which the edge is not perpendicular, and its direction along it.
    axis: usize,
    direction: Sign,
}

/// A half-plane that begins at the edge: that of a triangle.
#[derive(Debug, Clone, Copy)]
pub(super) struct HalfPlane {
    pub(super) triangle: Triangle,
    /// The first triangle of its plane, where that is known.
    pub(super) plane: Option<TriangleId>,
    /// Whether the triangle runs along the edge from its first end to its second one, so that its normal, with the edge, points counter-clockwise.
    pub(super) is_forward: bool,
}

impl<'a> Around<'a> {
    /// Around an edge whose ends are in some order along an axis.
    pub(super) fn new(input: &'a Input<'a>, axis: usize, order: Ordering) -> Self {
        let direction = match order {
            Ordering::Less => Sign::Positive,
            Ordering::Equal => Sign::Zero,
            Ordering::Greater => Sign::Negative,
        };
        Self { input, axis, direction }
    }

    /// Around the edge at which a facet is.
    pub(super) fn of_side(arrangement: &'a Arrangement<'a>, side: &Side) -> Self {
        let Arrangement { surface, points, .. } = arrangement;
        let (axis, order) = points.axis_between(surface, side.ends[0], side.ends[1]);
        Self::new(surface.input, axis, order)
    }

    /// Whether the second half-plane is less than half a turn ahead of the first, positive, or behind it, negative; zero where both are in
    /// one plane.
    fn ahead(&self, one: &HalfPlane, other: &HalfPlane) -> Sign {
        if one.plane.is_some() && one.plane == other.plane {
            return Sign::Zero;
        }
        let sign = cross_of_normals(self.input, &one.triangle, &other.triangle, self.axis).times(self.direction);
        if one.is_forward == other.is_forward { sign } else { sign.flip() }
    }

    /// Whether two half-planes in one plane are the same.
    fn are_one(&self, one: &HalfPlane, other: &HalfPlane) -> bool {
        let Some((axis, sign)) = best_axis(self.input, &one.triangle) else { return false };
        (normal_component(self.input, &other.triangle, axis) == sign) == (one.is_forward == other.is_forward)
    }

    /// Which part of a turn it is from one half-plane to another: none, less than half, half, more.
    fn quarter(&self, one: &HalfPlane, other: &HalfPlane) -> u8 {
        match self.ahead(one, other) {
            Sign::Positive => 1,
            Sign::Zero if self.are_one(one, other) => 0,
            Sign::Zero => 2,
            Sign::Negative => 3,
        }
    }

    /// Sorts what has half-planes counter-clockwise, from the first one on; in one half-plane as it is ordered.
    pub(super) fn sort<T: Copy + Ord>(&self, members: &mut [(HalfPlane, T)]) {
        let Some(((first, _), rest)) = members.split_first_mut() else { return };
        if rest.len() < 2 {
            return;
        }
        rest.sort_by(|(a, one), (b, other)| {
            self.quarter(first, a).cmp(&self.quarter(first, b)).then_with(|| match self.ahead(a, b) {
                Sign::Positive => Ordering::Less,
                Sign::Zero => one.cmp(other),
                Sign::Negative => Ordering::Greater,
            })
        });
    }

    /// The place, among sorted members, of the first one after the direction `(ε, ε², ε³)` from the edge.
    pub(super) fn after_direction<T>(&self, members: &[(HalfPlane, T)]) -> usize {
        let is_ahead = |half_plane: &HalfPlane| {
            let component = |axis: usize| normal_component(self.input, &half_plane.triangle, axis);
            let sign = (0..3).map(component).find(|sign| *sign != Sign::Zero);
            (sign == Some(Sign::Positive)) == half_plane.is_forward
        };
        let is_in_gap = |k: usize| {
            let [one, other] = [k, (k + 1) % members.len()].map(|k| &members[k].0);
            match self.quarter(one, other) {
                0 => false,
                1 => is_ahead(one) && !is_ahead(other),
                2 => is_ahead(one),
                _ => is_ahead(one) || !is_ahead(other),
            }
        };
        // without a gap all are in one half-plane
        (0..members.len()).find(|k| is_in_gap(*k)).map_or(0, |k| (k + 1) % members.len())
    }
}

/// Facets at an edge, none of them a patch, with their half-planes.
pub(super) fn half_planes(arrangement: &Arrangement<'_>, facets: &Facets, sides: &[Side]) -> Vec<(HalfPlane, Side)> {
    let Arrangement { surface, planes, cells, .. } = arrangement;
    let half_plane = |side: &Side| {
        let triangle = facets.triangle(cells, side.facet);
        let plane = Some(planes[triangle.index()]);
        (HalfPlane { triangle: surface.triangle(triangle), plane, is_forward: side.is_forward }, *side)
    };
    sides.iter().map(half_plane).collect()
}
