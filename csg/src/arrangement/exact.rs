//! Points in big integers: homogeneous coordinates, exact.
//!
//! All coordinates of the input are integers in one unit, so points that were constructed from them have rational coordinates with a
//! common denominator.

use std::cmp::Ordering;

use dashu_int::IBig;
use glam::DVec3;
use planecut_kernel::sign::Sign;
use planecut_kernel::{decompose, round_quotient};

use super::points::PointKey;
use super::surface::Surface;
use crate::ids::{PointId, TriangleId};

/// A vector of big integers.
type Vector = [IBig; 3];

/// A point: coordinates times its weight, in units of the input, and the weight, above zero.
#[derive(Debug, Clone)]
pub(super) struct ExactPoint {
    scaled: Vector,
    weight: IBig,
}

/// The place of a vertex in units of the input.
pub(super) fn vertex(surface: &Surface, vertex: PointId) -> Vector {
    integers(surface.at(vertex), surface.lowest())
}

fn integers(place: DVec3, lowest: i32) -> Vector {
    place.to_array().map(|v| {
        if v == 0.0 {
            return IBig::ZERO;
        }
        let (mantissa, exponent) = decompose(v);
        IBig::from(mantissa) << usize::try_from(exponent - lowest).expect("the unit is the smallest one")
    })
}

fn minus(a: &Vector, b: &Vector) -> Vector {
    [&a[0] - &b[0], &a[1] - &b[1], &a[2] - &b[2]]
}

fn cross(a: &Vector, b: &Vector) -> Vector {
    let minor = |u: usize, v: usize| &a[u] * &b[v] - &a[v] * &b[u];
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

fn dot(a: &Vector, b: &Vector) -> IBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

fn sign_of(value: &IBig) -> Sign {
    match value.cmp(&IBig::ZERO) {
        Ordering::Less => Sign::Negative,
        Ordering::Equal => Sign::Zero,
        Ordering::Greater => Sign::Positive,
    }
}

/// A normal of a triangle, as long as twice its area.
fn normal(surface: &Surface, triangle: TriangleId) -> Vector {
    let [a, b, c] = surface.corners(triangle).map(|corner| vertex(surface, corner));
    cross(&minus(&b, &a), &minus(&c, &a))
}

/// `det(b − a, c − a, d − a)` of four vertices.
pub(super) fn orient(surface: &Surface, [a, b, c, d]: [PointId; 4]) -> Sign {
    let [a, b, c, d] = [a, b, c, d].map(|corner| vertex(surface, corner));
    sign_of(&dot(&minus(&b, &a), &cross(&minus(&c, &a), &minus(&d, &a))))
}

/// The turn of three vertices, seen along an axis.
pub(super) fn turn(surface: &Surface, [a, b, c]: [PointId; 3], axis: usize) -> Sign {
    let [a, b, c] = [a, b, c].map(|corner| vertex(surface, corner));
    sign_of(&cross(&minus(&b, &a), &minus(&c, &a))[axis])
}

/// A component of the cross product of two triangles' normals.
pub(super) fn cross_of_normals(surface: &Surface, one: TriangleId, other: TriangleId, axis: usize) -> Sign {
    sign_of(&cross(&normal(surface, one), &normal(surface, other))[axis])
}

/// A component of a triangle's normal.
pub(super) fn normal_component(surface: &Surface, triangle: TriangleId, axis: usize) -> Sign {
    sign_of(&normal(surface, triangle)[axis])
}

impl ExactPoint {
    /// A point from what defines it.
    pub(super) fn new(surface: &Surface, key: &PointKey) -> Self {
        let at = |corner: PointId| vertex(surface, corner);
        match *key {
            PointKey::Vertex(corner) => Self { scaled: at(corner), weight: IBig::ONE },
            PointKey::EdgePlane { edge, triangle } => {
                let [p, q] = edge.map(at);
                let (normal, a) = (normal(surface, triangle), at(surface.corners(triangle)[0]));
                let [from_p, from_q] = [&p, &q].map(|end| dot(&normal, &minus(end, &a)));
                Self::between(&p, &q, &from_p, &from_p - from_q)
            }
            PointKey::EdgeEdge([one, other]) => {
                let ([p, q], [r, s]) = (one.map(at), other.map(at));
                let (along, across) = (minus(&q, &p), minus(&s, &r));
                let weights = cross(&along, &across);
                let axis = (0..3).find(|k| weights[*k] != IBig::ZERO).expect("crossing edges are not parallel");
                let share = &cross(&minus(&r, &p), &across)[axis];
                Self::between(&p, &q, share, weights[axis].clone())
            }
            PointKey::ThreePlanes(triangles) => {
                let normals = triangles.map(|triangle| normal(surface, triangle));
                let offset = |k: usize| dot(&normals[k], &at(surface.corners(triangles[k])[0]));
                let crosses = [(1, 2), (2, 0), (0, 1)].map(|(j, k)| cross(&normals[j], &normals[k]));
                let offsets = [0, 1, 2].map(offset);
                let scaled = [0, 1, 2].map(|axis| {
                    &offsets[0] * &crosses[0][axis] + &offsets[1] * &crosses[1][axis] + &offsets[2] * &crosses[2][axis]
                });
                Self::positive(scaled, dot(&normals[0], &crosses[0]))
            }
        }
    }

    /// The point a share of the way from `p` to `q`.
    fn between(p: &Vector, q: &Vector, share: &IBig, whole: IBig) -> Self {
        let rest = &whole - share;
        let scaled = [0, 1, 2].map(|k| &p[k] * &rest + &q[k] * share);
        Self::positive(scaled, whole)
    }

    fn positive(scaled: Vector, weight: IBig) -> Self {
        if weight < IBig::ZERO { Self { scaled: scaled.map(|v| -v), weight: -weight } } else { Self { scaled, weight } }
    }

    /// The coordinates, correctly rounded.
    pub(super) fn rounded(&self, surface: &Surface) -> DVec3 {
        let lowest = surface.lowest();
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

/// The turn of three points, seen along an axis.
pub(super) fn turn_of_points([a, b, c]: [&ExactPoint; 3], axis: usize) -> Sign {
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let minor = |p: &ExactPoint, q: &ExactPoint| &p.scaled[u] * &q.scaled[v] - &p.scaled[v] * &q.scaled[u];
    sign_of(&(&a.weight * minor(b, c) + &b.weight * minor(c, a) + &c.weight * minor(a, b)))
}
