//! Signs that decide: from floating-point numbers where their error cannot matter, exactly otherwise.

use glam::{DVec2, DVec3, Vec3Swizzles};
use planecut_kernel::sign::Sign;

use super::exact;
use super::surface::Surface;
use crate::ids::{PointId, TriangleId};

const U: f64 = f64::EPSILON / 2.0;

/// Bound on the error of a determinant of three differences, in units of its permanent (Shewchuk 1997, stage A).
const ORIENT_BOUND: f64 = 8.0 * U;

#[inline]
pub(super) fn sign(value: f64) -> Sign {
    if value > 0.0 {
        Sign::Positive
    } else if value < 0.0 {
        Sign::Negative
    } else {
        Sign::Zero
    }
}

/// The plane of a triangle in floating-point numbers, with what bounds its error.
#[derive(Debug, Clone, Copy)]
pub(super) struct RoundedPlane {
    triangle: TriangleId,
    at: DVec3,
    normal: DVec3,
    /// Sums of the magnitudes of which the components of `normal` are differences.
    permanent: DVec3,
}

impl RoundedPlane {
    pub(super) fn new(surface: &Surface, triangle: TriangleId) -> Self {
        let [a, b, c] = surface.places(triangle);
        let (p, q) = (b - a, c - a);
        let (left, right) = (p.yzx() * q.zxy(), p.zxy() * q.yzx());
        Self { triangle, at: a, normal: left - right, permanent: left.abs() + right.abs() }
    }

    /// On which side of the plane a vertex lies; positive is the side from which the triangle is counter-clockwise.
    #[inline]
    pub(super) fn side(&self, surface: &Surface, vertex: PointId) -> Sign {
        let along = surface.at(vertex) - self.at;
        let value = self.normal.dot(along);
        let bound = ORIENT_BOUND * self.permanent.dot(along.abs());
        if surface.is_safe && value.abs() > bound {
            return sign(value);
        }
        let [a, b, c] = surface.corners(self.triangle);
        if vertex == a || vertex == b || vertex == c { Sign::Zero } else { orient(surface, [a, b, c, vertex]) }
    }

    /// Whether rounded numbers tell on which side of the plane a vertex lies.
    #[inline]
    pub(super) fn is_sure_of(&self, surface: &Surface, vertex: PointId) -> bool {
        let along = surface.at(vertex) - self.at;
        self.normal.dot(along).abs() > ORIENT_BOUND * self.permanent.dot(along.abs())
    }

    /// On which side of an edge a place lies, positive within: of the plane through the edge along the rounded normal, in which the edge
    /// lies exactly, whatever the rounding. In units of what rounding may do.
    #[inline]
    fn height_over_edge(&self, [a, b]: [DVec3; 2], place: DVec3) -> f64 {
        let (along, across) = (b - a, place - a);
        let (left, right) = (along.yzx() * across.zxy(), along.zxy() * across.yzx());
        let bound = ORIENT_BOUND * self.normal.abs().dot(left.abs() + right.abs());
        self.normal.dot(left - right) / bound
    }

    /// Whether the triangle is sure to lie on the other side of one of its edges than the one corner of another triangle there that it
    /// does not share. `side` is the corner at which the edge begins, `like` the place of each corner among `others`, if it has one.
    pub(super) fn tells_apart(
        &self,
        surface: &Surface,
        side: usize,
        others: [PointId; 3],
        like: [Option<usize>; 3],
    ) -> bool {
        let Some(other) = (0..3).find(|k| !like.contains(&Some(*k))) else { return false };
        let corners = surface.corners(self.triangle);
        let [a, b, c] = [0, 1, 2].map(|k| surface.at(corners[(side + k) % 3]));
        let height = |place: DVec3| self.height_over_edge([a, b], place);
        surface.is_safe && height(c) > 1.0 && height(surface.at(others[other])) < -1.0
    }

    /// Whether another triangle is sure to lie beyond one of the edges, but for a vertex that both may share.
    pub(super) fn has_beyond_an_edge(&self, surface: &Surface, others: [PointId; 3]) -> bool {
        let corners = surface.corners(self.triangle);
        let is_beyond = |side: usize| {
            let [a, b, c] = [0, 1, 2].map(|k| corners[(side + k) % 3]);
            let ends = [surface.at(a), surface.at(b)];
            self.height_over_edge(ends, surface.at(c)) > 1.0
                && others
                    .iter()
                    .all(|other| *other == a || *other == b || self.height_over_edge(ends, surface.at(*other)) < -1.0)
        };
        surface.is_safe && (0..3).any(is_beyond)
    }

    /// Whether the plane is sure to miss a box, given by its middle and half of its extent.
    #[inline]
    pub(super) fn misses(&self, middle: DVec3, half: DVec3) -> bool {
        let along = middle - self.at;
        let slack = 2.0 * ORIENT_BOUND * self.permanent.dot(along.abs() + half);
        self.normal.dot(along).abs() > self.normal.abs().dot(half) + slack
    }
}

/// The sign of `det(b − a, c − a, d − a)`: positive where `d` lies on the side from which `a`, `b`, `c` are counter-clockwise.
pub(super) fn orient(surface: &Surface, corners: [PointId; 4]) -> Sign {
    if !surface.is_safe {
        return exact::orient(surface, corners);
    }
    let [a, b, c, d] = corners.map(|corner| {
        let DVec3 { x, y, z } = surface.at(corner);
        robust::Coord3D { x, y, z }
    });
    sign(-robust::orient3d(a, b, c, d))
}

/// Two coordinates of a place, in the order in which they are counter-clockwise seen along the third one, `axis`.
#[inline]
pub(super) fn projected(place: DVec3, axis: usize) -> DVec2 {
    match axis {
        0 => DVec2::new(place.y, place.z),
        1 => DVec2::new(place.z, place.x),
        _ => DVec2::new(place.x, place.y),
    }
}

/// The turn of three vertices seen along an axis: the sign of that component of the normal of their triangle.
pub(super) fn turn(surface: &Surface, corners: [PointId; 3], axis: usize) -> Sign {
    if !surface.is_safe {
        return exact::turn(surface, corners, axis);
    }
    let [a, b, c] = corners.map(|corner| {
        let p = projected(surface.at(corner), axis);
        robust::Coord { x: p.x, y: p.y }
    });
    sign(robust::orient2d(a, b, c))
}

/// The axis along which a triangle is best seen, and the sign of its normal along it; none for a triangle without an area.
pub(super) fn best_axis(surface: &Surface, triangle: TriangleId) -> Option<(usize, Sign)> {
    let plane = RoundedPlane::new(surface, triangle);
    let axis = plane.normal.abs().max_position();
    if surface.is_safe && plane.normal[axis].abs() > ORIENT_BOUND * plane.permanent[axis] {
        return Some((axis, sign(plane.normal[axis])));
    }
    let corners = surface.corners(triangle);
    [axis, (axis + 1) % 3, (axis + 2) % 3].into_iter().find_map(|axis| {
        let turn = turn(surface, corners, axis);
        (turn != Sign::Zero).then_some((axis, turn))
    })
}

/// The sign of a component of a triangle's normal.
pub(super) fn normal_component(surface: &Surface, triangle: TriangleId, axis: usize) -> Sign {
    let plane = RoundedPlane::new(surface, triangle);
    if surface.is_safe && plane.normal[axis].abs() > ORIENT_BOUND * plane.permanent[axis] {
        return sign(plane.normal[axis]);
    }
    if surface.is_safe {
        turn(surface, surface.corners(triangle), axis)
    } else {
        exact::normal_component(surface, triangle, axis)
    }
}

/// The sign of a component of the cross product of two triangles' normals.
pub(super) fn cross_of_normals(surface: &Surface, one: TriangleId, other: TriangleId, axis: usize) -> Sign {
    let [p, q] = [one, other].map(|triangle| RoundedPlane::new(surface, triangle));
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let value = p.normal[u] * q.normal[v] - p.normal[v] * q.normal[u];
    let bound = 2.0 * ORIENT_BOUND * (p.permanent[u] * q.permanent[v] + p.permanent[v] * q.permanent[u]);
    if surface.is_safe && value.abs() > bound {
        return sign(value);
    }
    exact::cross_of_normals(surface, one, other, axis)
}
