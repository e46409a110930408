//! Points and planes in big integers: homogeneous coordinates, exact.
//!
//! All coordinates of the input are integers in one unit, so points that were constructed from them have rational coordinates with a
//! common denominator.

use std::cmp::Ordering;

use dashu_int::IBig;
use glam::DVec3;
use planecut_kernel::sign::Sign;
use planecut_kernel::{HalfSpace, decompose, round_quotient};

use super::input::Input;
use super::points::PointKey;
use super::predicates::Corner;
use super::surface::Surface;
use crate::ids::{Id, InputTriangleId, InputVertexId, PointId, TriangleId};

/// A vector of big integers.
pub(super) type Vector = [IBig; 3];

/// A point: coordinates times its weight, in units of the input, and the weight, above zero.
#[derive(Debug, Clone)]
pub(super) struct ExactPoint {
    scaled: Vector,
    weight: IBig,
}

/// A plane: all points `x`, in units of the input, with `normal · x = offset`.
#[derive(Debug, Clone)]
struct ExactPlane {
    normal: Vector,
    offset: IBig,
}

/// A place in a unit of which all coordinates are multiples, given by its exponent.
pub(super) fn integers(place: DVec3, lowest: i32) -> Vector {
    place.to_array().map(|v| {
        if v == 0.0 {
            return IBig::ZERO;
        }
        let (mantissa, exponent) = decompose(v);
        IBig::from(mantissa) << usize::try_from(exponent - lowest).expect("the unit is the smallest one")
    })
}

pub(super) fn minus(a: &Vector, b: &Vector) -> Vector {
    [&a[0] - &b[0], &a[1] - &b[1], &a[2] - &b[2]]
}

fn times(a: &Vector, factor: &IBig) -> Vector {
    [&a[0] * factor, &a[1] * factor, &a[2] * factor]
}

pub(super) fn cross(a: &Vector, b: &Vector) -> Vector {
    let minor = |u: usize, v: usize| &a[u] * &b[v] - &a[v] * &b[u];
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

pub(super) fn dot(a: &Vector, b: &Vector) -> IBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

fn sign_of(value: &IBig) -> Sign {
    match value.cmp(&IBig::ZERO) {
        Ordering::Less => Sign::Negative,
        Ordering::Equal => Sign::Zero,
        Ordering::Greater => Sign::Positive,
    }
}

impl ExactPlane {
    /// The plane of a half-space, its normal pointing out of that.
    fn of_half_space(half_space: &HalfSpace, lowest: i32) -> Self {
        let [x, y, z] = half_space.normal().to_array();
        // in units of the input the offset has another exponent
        let parts = [(x, 0), (y, 0), (z, 0), (half_space.offset(), lowest)]
            .map(|(v, unit)| if v == 0.0 { None } else { Some(decompose(v)).map(|(m, e)| (m, e - unit)) });
        let least = parts.iter().flatten().map(|(_, exponent)| *exponent).min().unwrap_or(0);
        let [x, y, z, offset] = parts.map(|part| match part {
            None => IBig::ZERO,
            Some((m, e)) => IBig::from(m) << usize::try_from(e - least).expect("the least exponent is no larger"),
        });
        Self { normal: [x, y, z], offset }
    }

    /// The plane of a triangle, its normal on the side from which it is counter-clockwise.
    fn of_triangle(input: &Input<'_>, triangle: InputTriangleId) -> Self {
        if let Some(half_space) = input.half_space(triangle) {
            return Self::of_half_space(half_space, input.lowest());
        }
        let (operand, number) = input.of_triangle(triangle);
        let [a, b, c] = input.triangle(operand, number).places().map(|place| integers(place, input.lowest()));
        let normal = cross(&minus(&b, &a), &minus(&c, &a));
        let offset = dot(&normal, &a);
        Self { normal, offset }
    }

    /// How far a point lies above the plane, times its weight.
    fn height(&self, point: &ExactPoint) -> IBig {
        dot(&self.normal, &point.scaled) - &self.offset * &point.weight
    }
}

impl ExactPoint {
    /// A vertex of an operand.
    fn of_vertex(input: &Input<'_>, vertex: InputVertexId) -> Self {
        match input.meeting_at(vertex) {
            None => Self { scaled: integers(input.at(vertex), input.lowest()), weight: IBig::ONE },
            Some(planes) => Self::meet(&planes.map(|plane| ExactPlane::of_half_space(plane, input.lowest()))),
        }
    }

    /// The point where three planes meet.
    fn meet(planes: &[ExactPlane; 3]) -> Self {
        let crosses = [(1, 2), (2, 0), (0, 1)].map(|(j, k)| cross(&planes[j].normal, &planes[k].normal));
        let scaled = [0, 1, 2].map(|axis| {
            &planes[0].offset * &crosses[0][axis]
                + &planes[1].offset * &crosses[1][axis]
                + &planes[2].offset * &crosses[2][axis]
        });
        Self::positive(scaled, dot(&planes[0].normal, &crosses[0]))
    }

    /// A point from what defines it.
    pub(super) fn new(surface: &Surface<'_>, key: &PointKey) -> Self {
        let at = |point: PointId| Self::of_vertex(surface.input, surface.origins[point.index()]);
        let plane = |triangle: TriangleId| ExactPlane::of_triangle(surface.input, surface.number(triangle));
        match *key {
            PointKey::Vertex(point) => at(point),
            PointKey::EdgePlane { edge, triangle } => {
                let plane = plane(triangle);
                let [p, q] = edge.map(at);
                let heights = [&p, &q].map(|end| plane.height(end));
                Self::between(&p, &q, &heights)
            }
            PointKey::EdgeEdge([one, other]) => {
                let ([p, q], [r, s]) = (one.map(at), other.map(at));
                // a plane through the other edge along an axis, which the first one crosses
                let heights = |axis: usize| {
                    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                    [&p, &q].map(|point| turn_value([&r, &s, point], u, v))
                };
                let crossing = (0..3).map(heights).find(|[p, q]| sign_of(p) != sign_of(q));
                Self::between(&p, &q, &crossing.expect("edges that cross are not parallel"))
            }
            PointKey::ThreePlanes(triangles) => Self::meet(&triangles.map(plane)),
        }
    }

    /// The point between two others at which heights, times their weights, come to zero.
    fn between(p: &Self, q: &Self, [from_p, from_q]: &[IBig; 2]) -> Self {
        let (ahead, back) = (times(&q.scaled, from_p), times(&p.scaled, from_q));
        Self::positive(minus(&ahead, &back), from_p * &q.weight - from_q * &p.weight)
    }

    fn positive(scaled: Vector, weight: IBig) -> Self {
        if weight < IBig::ZERO { Self { scaled: scaled.map(|v| -v), weight: -weight } } else { Self { scaled, weight } }
    }

    /// The coordinates, correctly rounded.
    pub(super) fn rounded(&self, input: &Input<'_>) -> DVec3 {
        let lowest = input.lowest();
        let coordinate = |v: &IBig| {
            let shift = usize::try_from(lowest.unsigned_abs()).expect("an exponent is small");
            let (numerator, denominator) =
                if lowest < 0 { (v.clone(), &self.weight << shift) } else { (v << shift, self.weight.clone()) };
            round_quotient(numerator, &denominator) + 0.0
        };
        let [x, y, z] = &self.scaled;
        DVec3::new(coordinate(x), coordinate(y), coordinate(z))
    }

    /// The order of two points along an axis.
    pub(super) fn compare(&self, other: &Self, axis: usize) -> Ordering {
        (&self.scaled[axis] * &other.weight).cmp(&(&other.scaled[axis] * &self.weight))
    }

    /// Whether two points are at the same place.
    pub(super) fn is_at(&self, other: &Self) -> bool {
        (0..3).all(|axis| self.compare(other, axis).is_eq())
    }
}

/// The determinant of three points of a plane by two of their coordinates, times their weights.
fn turn_value([a, b, c]: [&ExactPoint; 3], u: usize, v: usize) -> IBig {
    let minor = |p: &ExactPoint, q: &ExactPoint| &p.scaled[u] * &q.scaled[v] - &p.scaled[v] * &q.scaled[u];
    &a.weight * minor(b, c) + &b.weight * minor(c, a) + &c.weight * minor(a, b)
}

/// The turn of three points, seen along an axis.
pub(super) fn turn_of_points(points: [&ExactPoint; 3], axis: usize) -> Sign {
    sign_of(&turn_value(points, (axis + 1) % 3, (axis + 2) % 3))
}

/// Whether two vertices with the same rounded place are one.
pub(super) fn are_one(input: &Input<'_>, one: InputVertexId, other: InputVertexId) -> bool {
    let are_there = || [one, other].iter().all(|vertex| input.is_where_it_is_said(*vertex));
    !input.has_bodies || are_there() || ExactPoint::of_vertex(input, one).is_at(&ExactPoint::of_vertex(input, other))
}

/// The sign of the difference of one vertex and another along an axis.
pub(super) fn compare_vertices(input: &Input<'_>, one: InputVertexId, other: InputVertexId, axis: usize) -> Sign {
    match ExactPoint::of_vertex(input, one).compare(&ExactPoint::of_vertex(input, other), axis) {
        Ordering::Less => Sign::Negative,
        Ordering::Equal => Sign::Zero,
        Ordering::Greater => Sign::Positive,
    }
}

/// On which side of the plane of a triangle a vertex lies.
pub(super) fn side(input: &Input<'_>, triangle: InputTriangleId, vertex: InputVertexId) -> Sign {
    sign_of(&ExactPlane::of_triangle(input, triangle).height(&ExactPoint::of_vertex(input, vertex)))
}

/// `det(b − a, c − a, d − a)` of four vertices.
pub(super) fn orient(input: &Input<'_>, corners: [Corner; 4]) -> Sign {
    let [a, b, c, d] = corners.map(|corner| ExactPoint::of_vertex(input, corner.vertex));
    // differences times both weights, which are above zero
    let from_a = |p: &ExactPoint| minus(&times(&p.scaled, &a.weight), &times(&a.scaled, &p.weight));
    sign_of(&dot(&from_a(&b), &cross(&from_a(&c), &from_a(&d))))
}

/// The turn of three vertices, seen along an axis.
pub(super) fn turn(input: &Input<'_>, corners: [Corner; 3], axis: usize) -> Sign {
    let [a, b, c] = corners.map(|corner| ExactPoint::of_vertex(input, corner.vertex));
    turn_of_points([&a, &b, &c], axis)
}

/// A component of the cross product of two triangles' normals.
pub(super) fn cross_of_normals(input: &Input<'_>, one: InputTriangleId, other: InputTriangleId, axis: usize) -> Sign {
    let [p, q] = [one, other].map(|triangle| ExactPlane::of_triangle(input, triangle).normal);
    sign_of(&cross(&p, &q)[axis])
}
