//! A meeting point of three planes: exact by name, and where it is in plain numbers.

use glam::DVec3;
use planecut_kernel::HalfSpace;
use planecut_kernel::sign::{Homogeneous, Sign};

use crate::base::Bounds;
use crate::ids::{BodyId, CornerId, Id};

/// Three products and three sums, each rounded, and more.
const PLANE_VALUE_BOUND: f64 = 8.0 * f64::EPSILON;

/// A plane that many corners are held against.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PlaneFilter {
    normal: DVec3,
    offset: f64,
    /// The sum of the normal's magnitudes.
    reach: f64,
    /// For the rounding of the offset.
    room: f64,
}

impl PlaneFilter {
    pub(crate) fn new(half_space: &HalfSpace) -> Self {
        let (normal, offset) = (half_space.normal(), half_space.offset());
        Self { normal, offset, reach: normal.abs().element_sum(), room: PLANE_VALUE_BOUND * offset.abs() }
    }

    /// The components of the normal, the offset, the sum of the normal's magnitudes, and room for the rounding of the offset.
    pub(crate) fn numbers(&self) -> [f64; 6] {
        [self.normal.x, self.normal.y, self.normal.z, self.offset, self.reach, self.room]
    }

    /// The value of the plane's equation at a corner, and a bound for its error.
    fn value(&self, corner: &Corner) -> (f64, f64) {
        (self.normal.dot(corner.at) - self.offset, self.reach * corner.error + self.room)
    }

    /// Where the plane meets the line through two corners, of which one does not lie beyond it and the other not within; nothing where this would be known much
    /// worse than they are.
    ///
    /// With values `A` and `B` at the corners, `a` and `b` as they are known, the point lies `A / (A − B)` of the way; `a / (a − b)` differs from that by
    /// `(A (b − B) − B (a − A)) / ((A − B) (a − b))`, and `|A| + |B| = |A − B|`, as their signs are not alike.
    pub(crate) fn crossing(&self, from: &Corner, to: &Corner) -> Option<Corner> {
        /// How much worse: where a line and a plane meet at a small angle, that of three planes is known better.
        const MOST: f64 = 4.0;
        const ROUNDED_UP: f64 = 1.0 + 8.0 * f64::EPSILON;
        let ((a, bound_of_a), (b, bound_of_b)) = (self.value(from), self.value(to));
        let (step, error) = (to.at - from.at, from.error.max(to.error));
        let way = ROUNDED_UP * bound_of_a.max(bound_of_b) / (a - b).abs();
        let off = way * (step.abs().max_element() + from.error + to.error);
        if !(off <= MOST * error && off.is_finite()) {
            return None;
        }
        let at = from.at + step * (a / (a - b));
        // the difference, the quotient, the product and the sum are rounded, and so is a dot product with the coordinates
        let rounding = 2.0 * PLANE_VALUE_BOUND * from.at.abs().max(to.at.abs()).max_element();
        Some(Corner { at, error: error + off + rounding, within: Corner::NOWHERE, number: Corner::NEW })
    }

    /// Whether a corner certainly is inside of the plane, and whether it certainly is outside.
    #[inline]
    pub(crate) fn is_surely(&self, corner: &Corner) -> [bool; 2] {
        let (value, bound) = self.value(corner);
        [value < -bound, value > bound]
    }

    /// On which side of the plane a corner certainly is; zero where that is not certain.
    pub(crate) fn side(&self, corner: &Corner) -> Sign {
        let [is_inside, is_outside] = self.is_surely(corner);
        if is_outside {
            Sign::Positive
        } else if is_inside {
            Sign::Negative
        } else {
            Sign::Zero
        }
    }
}

/// A meeting point of three planes that are known where it is used: what it lies beside is told by them where plain numbers leave it open.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Corner {
    /// Where it is, rounded a few times.
    pub(crate) at: DVec3,
    /// How far off each coordinate may be, with room for the rounding of a dot product with the coordinates; infinite where
    /// nothing is known.
    pub(crate) error: f64,
    /// The number of a body that it is known to lie in, or [`NOWHERE`](Self::NOWHERE).
    pub(crate) within: BodyId,
    /// A number that it has in its body, whichever face it is seen in; [`NEW`](Self::NEW) for a corner that cutting made.
    pub(crate) number: CornerId,
}

impl Corner {
    /// No body.
    pub(crate) const NOWHERE: BodyId = BodyId::NONE;
    /// No corner of a body.
    pub(crate) const NEW: CornerId = CornerId::NONE;

    pub(crate) fn new(point: &Homogeneous) -> Self {
        let [x, y, z, w] = point.value;
        let at = DVec3::new(x, y, z) / w;
        let permanent = DVec3::new(point.permanent[0], point.permanent[1], point.permanent[2]);
        // |x/w − X/W| ≤ ε (|X| perm + |x/w| Wperm) / |W|, with room in the factor
        let error = (permanent + at.abs() * point.permanent[3]) * (32.0 * f64::EPSILON) / w.abs();
        let is_known =
            at.is_finite() && error.is_finite() && point.permanent[3] * (16.0 * f64::EPSILON) <= 0.5 * w.abs();
        let error =
            if is_known { error.max_element() + PLANE_VALUE_BOUND * at.abs().max_element() } else { f64::INFINITY };
        Self { at, error, within: Self::NOWHERE, number: Self::NEW }
    }

    /// Whether its coordinates are right to ten digits; the bound for their error is far larger than the error.
    #[inline]
    pub(crate) fn is_well_known(&self) -> bool {
        const WELL: f64 = 1e-10;
        self.error <= WELL * self.at.abs().max_element()
    }
}

impl Bounds {
    /// The box grown so that it surely holds a meeting point.
    #[inline]
    #[must_use]
    pub fn with_point(self, point: &Homogeneous) -> Self {
        self.with_corner(&Corner::new(point))
    }

    /// The box grown so that it surely holds a corner.
    #[inline]
    pub(crate) fn with_corner(self, corner: &Corner) -> Self {
        if corner.error.is_infinite() {
            return Self { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY };
        }
        let margin = DVec3::splat(corner.error);
        Self { min: self.min.min(corner.at - margin), max: self.max.max(corner.at + margin) }
    }
}

#[cfg(test)]
mod tests {
    use planecut_testkit::random::Rng;

    use super::*;
    use crate::plane_table::{PlaneId, PlaneTable};

    /// Planes around a place: any, on a grid, and nearly parallel to one another.
    fn planes(rng: &mut Rng, round: usize) -> (PlaneTable, [PlaneId; 6]) {
        let mut table = PlaneTable::default();
        let middle = [DVec3::ZERO, DVec3::new(3e6, -2e5, 7.5), DVec3::splat(1e-7)][round % 3];
        let size = [1.0, 1e-3, 1e4][round / 3 % 3];
        let first = rng.unit();
        let plane = |_| {
            let normal = match round / 9 % 3 {
                0 => rng.unit(),
                1 => loop {
                    let lattice = DVec3::from_array(rng.lattice(2));
                    if lattice != DVec3::ZERO {
                        break lattice;
                    }
                },
                _ if rng.chance(0.5) => first + 10.0_f64.powi(-(rng.below(10) as i32)) * rng.unit(),
                _ => rng.unit(),
            };
            let offset = normal.dot(middle) + size * rng.whole(-2, 2) / 2.0;
            table.insert_exact(&HalfSpace::new(normal, offset).expect("a plane"))
        };
        let planes = [0; 6].map(plane);
        (table, planes)
    }

    /// Their meeting point: in which order they are right-handed, where it is, correctly rounded, and as a corner.
    fn point(table: &PlaneTable, [a, b, c]: [PlaneId; 3]) -> Option<([PlaneId; 3], DVec3, Corner)> {
        let planes = match table.orient3(a, b, c) {
            Sign::Positive => [a, b, c],
            Sign::Negative => [a, c, b],
            Sign::Zero => return None,
        };
        Some((planes, table.position(planes)?, Corner::new(&table.homogeneous(planes))))
    }

    #[test]
    fn crossings_are_where_they_are_said_to_be() {
        let mut rng = Rng::spread(33);
        let (mut told, mut left_open, mut sides) = (0, 0, 0);
        for round in 0..60_000 {
            let (table, [a, b, start, end, cut, other]) = planes(&mut rng, round);
            let side = |planes: [PlaneId; 3], plane| table.side(planes, &table.homogeneous(planes), plane);
            let (Some(from), Some(to)) = (point(&table, [a, b, start]), point(&table, [a, b, end])) else { continue };
            let is_between = side(from.0, cut) == Sign::Negative && side(to.0, cut) != Sign::Negative;
            let Some(exact) = point(&table, [a, b, cut]).filter(|_| is_between) else { continue };
            let Some(crossing) = PlaneFilter::new(table.half_space(cut)).crossing(&from.2, &to.2) else {
                left_open += 1;
                continue;
            };
            told += 1;
            let context = format!("round {round}: planes {:?}", [a, b, start, end, cut].map(|p| *table.half_space(p)));
            // the exact point is rounded, too
            let off = (crossing.at - exact.1).abs().max_element() - f64::EPSILON * exact.1.abs().max_element();
            assert!(off <= crossing.error, "{context}: off by {off:e}, told {:e}", crossing.error);
            let least = from.2.error.max(to.2.error);
            assert!(crossing.error <= 8.0 * least, "{context}: {:e} of {least:e}", crossing.error);
            let certain = PlaneFilter::new(table.half_space(other)).side(&crossing);
            if certain != Sign::Zero {
                sides += 1;
                assert_eq!(certain, side(exact.0, other), "{context}, side of {:?}", table.half_space(other));
            }
        }
        assert!(told > 5_000 && left_open > 100 && sides > 3_000, "{told} told, {left_open} left open, {sides} sides");
    }
}
