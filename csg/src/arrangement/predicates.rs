//! Signs that decide: from floating-point numbers where their error cannot matter, exactly otherwise.

use glam::{DVec2, DVec3, Vec3Swizzles};
use planecut_kernel::sign::Sign;

use super::exact;
use super::flat::are_plainly_coplanar;
use super::input::Input;
use crate::ids::{InputTriangleId, InputVertexId};

const U: f64 = f64::EPSILON / 2.0;

/// Bound on the error of a determinant of three differences, in units of its permanent (Shewchuk 1997, stage A).
const ORIENT_BOUND: f64 = 8.0 * U;

/// How far corners of bodies, which are rounded, may be from where they are, with room for three products and sums of that.
const BLUR: f64 = 8.0 * U;

/// Bound on what rounding does to a height over an edge, with much room.
const EDGE_BOUND: f64 = 256.0 * U;

/// A vertex of an operand, and where it is, correctly rounded.
#[derive(Debug, Clone, Copy)]
pub(super) struct Corner {
    pub(super) vertex: InputVertexId,
    pub(super) at: DVec3,
}

/// A triangle of an operand, counter-clockwise seen from outside.
#[derive(Debug, Clone, Copy)]
pub(super) struct Triangle {
    pub(super) number: InputTriangleId,
    pub(super) corners: [Corner; 3],
}

impl Triangle {
    pub(super) fn places(&self) -> [DVec3; 3] {
        self.corners.map(|corner| corner.at)
    }
}

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
    triangle: Triangle,
    at: DVec3,
    normal: DVec3,
    /// Sums of the magnitudes of which the components of `normal` are differences.
    permanent: DVec3,
}

impl RoundedPlane {
    #[inline]
    pub(super) fn new(input: &Input<'_>, triangle: &Triangle) -> Self {
        let [a, b, c] = triangle.places();
        if input.has_bodies
            && let Some(half_space) = input.half_space(triangle.number)
        {
            let normal = half_space.normal();
            return Self { triangle: *triangle, at: a, normal, permanent: normal.abs() };
        }
        let (p, q) = (b - a, c - a);
        let (left, right) = (p.yzx() * q.zxy(), p.zxy() * q.yzx());
        Self { triangle: *triangle, at: a, normal: left - right, permanent: left.abs() + right.abs() }
    }

    /// The height of a place over the plane, and what rounding may do to it.
    #[inline]
    fn height(&self, input: &Input<'_>, place: DVec3) -> (f64, f64) {
        let along = place - self.at;
        let mut bound = ORIENT_BOUND * self.permanent.dot(along.abs());
        if input.has_bodies {
            bound += BLUR * self.permanent.dot(place.abs() + self.at.abs());
        }
        (self.normal.dot(along), bound)
    }

    /// On which side of the plane a vertex lies; positive is the side from which the triangle is counter-clockwise.
    #[inline]
    pub(super) fn side(&self, input: &Input<'_>, corner: &Corner) -> Sign {
        let (value, bound) = self.height(input, corner.at);
        if input.is_safe && value.abs() > bound {
            return sign(value);
        }
        self.exact_side(input, corner)
    }

    #[cold]
    fn exact_side(&self, input: &Input<'_>, corner: &Corner) -> Sign {
        let [a, b, c] = self.triangle.corners;
        if [a, b, c].iter().any(|own| own.vertex == corner.vertex) {
            return Sign::Zero;
        }
        if input.half_space(self.triangle.number).is_some() {
            return exact::side(input, self.triangle.number, corner.vertex);
        }
        // corners of bodies are not where they are said to be
        if !input.has_bodies && are_plainly_coplanar([a.at, b.at, c.at, corner.at]) {
            return Sign::Zero;
        }
        orient(input, [a, b, c, *corner])
    }

    /// Whether rounded numbers tell on which side of the plane a vertex lies.
    #[inline]
    pub(super) fn is_sure_of(&self, input: &Input<'_>, corner: &Corner) -> bool {
        let (value, bound) = self.height(input, corner.at);
        value.abs() > bound
    }

    /// On which side of an edge a place lies, positive within: of the plane through the edge along the rounded normal, in which the edge
    /// lies exactly, whatever the rounding. In units of what rounding may do.
    #[inline]
    fn height_over_edge(&self, input: &Input<'_>, [a, b]: [DVec3; 2], place: DVec3) -> f64 {
        let (along, across) = (b - a, place - a);
        let (left, right) = (along.yzx() * across.zxy(), along.zxy() * across.yzx());
        let mut bound = ORIENT_BOUND * self.normal.abs().dot(left.abs() + right.abs());
        if input.has_bodies {
            let size = a.abs().max(b.abs()).max(place.abs()).max_element();
            let longest = along.abs().max_element() + across.abs().max_element();
            bound += BLUR * 4.0 * self.normal.abs().element_sum() * size * longest;
        }
        self.normal.dot(left - right) / bound
    }

    /// Whether the triangle is sure to lie on the other side of one of its edges, which begins at corner `side`, than another place.
    pub(super) fn tells_apart(&self, input: &Input<'_>, side: usize, other: DVec3) -> bool {
        let places = self.triangle.places();
        let [a, b, c] = [0, 1, 2].map(|k| places[(side + k) % 3]);
        let height = |place: DVec3| self.height_over_edge(input, [a, b], place);
        input.is_safe && height(c) > 1.0 && height(other) < -1.0
    }

    /// Whether the triangle is sure to lie on the other side of one of its edges than both ends of an edge near its plane.
    pub(super) fn tells_edge_apart(&self, input: &Input<'_>, ends: [DVec3; 2]) -> bool {
        let places = self.triangle.places();
        let is_beyond = |side: usize| {
            let ends_of_side = [places[side], places[(side + 1) % 3]];
            let height = |place: DVec3| self.height_over_edge(input, ends_of_side, place);
            height(ends[0]) < -1.0 && height(ends[1]) < -1.0 && height(places[(side + 2) % 3]) > 1.0
        };
        input.is_safe && (0..3).any(is_beyond)
    }

    /// Whether another triangle is sure to lie beyond one of the edges, but for a vertex that both may share.
    pub(super) fn has_beyond_an_edge(&self, input: &Input<'_>, others: &[Corner; 3]) -> bool {
        let corners = &self.triangle.corners;
        let is_beyond = |side: usize| {
            let [a, b, c] = [0, 1, 2].map(|k| corners[(side + k) % 3]);
            let ends = [a.at, b.at];
            let is_own = |other: &Corner| other.vertex == a.vertex || other.vertex == b.vertex;
            self.height_over_edge(input, ends, c.at) > 1.0
                && others.iter().all(|other| is_own(other) || self.height_over_edge(input, ends, other.at) < -1.0)
        };
        input.is_safe && (0..3).any(is_beyond)
    }

    /// Whether the plane is sure to miss a box, given by its middle and half of its extent.
    #[inline]
    pub(super) fn misses(&self, middle: DVec3, half: DVec3) -> bool {
        let along = middle - self.at;
        let mut slack = 2.0 * ORIENT_BOUND * self.permanent.dot(along.abs() + half);
        slack += BLUR * self.permanent.dot(middle.abs() + half + self.at.abs());
        self.normal.dot(along).abs() > self.normal.abs().dot(half) + slack
    }

    /// Whether places are sure to lie on one side of the plane.
    #[inline]
    pub(super) fn has_on_one_side(&self, input: &Input<'_>, places: &[DVec3; 3]) -> bool {
        let [a, b, c] = places;
        let ((a, of_a), (b, of_b), (c, of_c)) =
            (self.height(input, *a), self.height(input, *b), self.height(input, *c));
        (a > of_a) & (b > of_b) & (c > of_c) || (a < -of_a) & (b < -of_b) & (c < -of_c)
    }

    /// Planes through the edges along the normal, their normals pointing away from the triangle; and magnitudes that bound what rounding
    /// does to these.
    pub(super) fn edge_planes(&self, input: &Input<'_>) -> [EdgePlane; 3] {
        let places = self.triangle.places();
        if input.half_space(self.triangle.number).is_some() {
            // short edges between rounded corners may run anywhere
            return places.map(|at| EdgePlane { at, normal: DVec3::ZERO, permanent: DVec3::ZERO });
        }
        [0, 1, 2].map(|k| {
            let (from, to) = (places[k], places[(k + 1) % 3]);
            let along = to - from;
            let normal = along.cross(self.normal);
            let (u, n) = (along.abs(), self.permanent);
            EdgePlane { at: from, normal, permanent: u.yzx() * n.zxy() + u.zxy() * n.yzx() }
        })
    }

    /// The component of the normal along an axis where rounding does not matter.
    #[inline]
    fn component(&self, input: &Input<'_>, axis: usize) -> Option<Sign> {
        if input.is_safe && self.normal[axis].abs() > ORIENT_BOUND * self.permanent[axis] {
            return Some(sign(self.normal[axis]));
        }
        // those of bodies are what was given
        input.half_space(self.triangle.number).map(|half_space| sign(half_space.normal()[axis]))
    }
}

/// A plane through an edge of a triangle, perpendicular to it but for rounding.
#[derive(Debug, Clone, Copy)]
pub(super) struct EdgePlane {
    at: DVec3,
    normal: DVec3,
    permanent: DVec3,
}

impl EdgePlane {
    /// Whether a box, given by its middle and half of its extent, is sure to lie beyond the edge.
    #[inline]
    pub(super) fn misses(&self, middle: DVec3, half: DVec3) -> bool {
        let along = middle - self.at;
        // the other corners are up to as far inside as rounding of the normal makes of their distance, which the permanent bounds
        let slack = EDGE_BOUND * self.permanent.dot(middle.abs() + half + self.at.abs());
        self.normal.dot(along) > self.normal.abs().dot(half) + slack
    }

    /// Whether places, whose coordinates have at most these magnitudes, are sure to lie beyond the edge.
    #[inline]
    pub(super) fn has_beyond(&self, places: &[DVec3; 3], size: DVec3) -> bool {
        let slack = EDGE_BOUND * self.permanent.dot(size + self.at.abs());
        let height = |place: DVec3| self.normal.dot(place - self.at);
        (height(places[0]) > slack) & (height(places[1]) > slack) & (height(places[2]) > slack)
    }
}

/// The sign of `det(b − a, c − a, d − a)`: positive where `d` lies on the side from which `a`, `b`, `c` are counter-clockwise.
pub(super) fn orient(input: &Input<'_>, corners: [Corner; 4]) -> Sign {
    if !input.is_safe {
        return exact::orient(input, corners);
    }
    if input.has_bodies && !corners.iter().all(|corner| input.is_where_it_is_said(corner.vertex)) {
        let [a, b, c, d] = corners.map(|corner| corner.at);
        let (b, c, d) = (b - a, c - a, d - a);
        let longest = b.abs().max(c.abs()).max(d.abs()).max_element();
        let size = corners.iter().map(|corner| corner.at.abs().max_element()).fold(0.0, f64::max);
        let value = b.dot(c.cross(d));
        let bound = 64.0 * U * longest * longest * (longest + size);
        return if value.abs() > bound { sign(value) } else { exact::orient(input, corners) };
    }
    let [a, b, c, d] = corners.map(|corner| {
        let DVec3 { x, y, z } = corner.at;
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
pub(super) fn turn(input: &Input<'_>, corners: [Corner; 3], axis: usize) -> Sign {
    if !input.is_safe {
        return exact::turn(input, corners, axis);
    }
    let [p, q, r] = corners.map(|corner| projected(corner.at, axis));
    if input.has_bodies && !corners.iter().all(|corner| input.is_where_it_is_said(corner.vertex)) {
        let (value, bound) = crate::weld::triangulate::rounded_turn(p, q, r);
        return if value.abs() > bound { sign(value) } else { exact::turn(input, corners, axis) };
    }
    let [a, b, c] = [p, q, r].map(|p| robust::Coord { x: p.x, y: p.y });
    sign(robust::orient2d(a, b, c))
}

/// The axis along which a triangle is best seen, and the sign of its normal along it; none for a triangle without an area.
pub(super) fn best_axis(input: &Input<'_>, triangle: &Triangle) -> Option<(usize, Sign)> {
    let plane = RoundedPlane::new(input, triangle);
    let axis = plane.normal.abs().max_position();
    if let Some(sign) = plane.component(input, axis) {
        return Some((axis, sign));
    }
    [axis, (axis + 1) % 3, (axis + 2) % 3].into_iter().find_map(|axis| {
        let turn = turn(input, triangle.corners, axis);
        (turn != Sign::Zero).then_some((axis, turn))
    })
}

/// The sign of a component of a triangle's normal.
pub(super) fn normal_component(input: &Input<'_>, triangle: &Triangle, axis: usize) -> Sign {
    let plane = RoundedPlane::new(input, triangle);
    plane.component(input, axis).unwrap_or_else(|| turn(input, triangle.corners, axis))
}

/// The sign of a component of the cross product of two triangles' normals.
pub(super) fn cross_of_normals(input: &Input<'_>, one: &Triangle, other: &Triangle, axis: usize) -> Sign {
    let [p, q] = [one, other].map(|triangle| RoundedPlane::new(input, triangle));
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let value = p.normal[u] * q.normal[v] - p.normal[v] * q.normal[u];
    let bound = 2.0 * ORIENT_BOUND * (p.permanent[u] * q.permanent[v] + p.permanent[v] * q.permanent[u]);
    if input.is_safe && value.abs() > bound {
        return sign(value);
    }
    exact::cross_of_normals(input, one.number, other.number, axis)
}
