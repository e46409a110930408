//! A meeting point in plain numbers, refined once: what it lacks in each plane's equation is known to twice their precision.
//!
//! With `x₀` a meeting point in plain numbers and `rᵢ = dᵢ − nᵢ·x₀`, the meeting point is exactly `x₀ + A⁻¹ r`, where the normals are the rows
//! of `A`. The second term is about a rounding of the first, so that it is enough to have it to half of its digits (iterative refinement: Wilkinson 1963).

use crate::arithmetic::{DoubleDouble, exact_product};
use crate::sign::{Homogeneous, Row};

/// Half of the distance from 1 to the next number.
const U: f64 = f64::EPSILON / 2.0;

/// Up to which quotient of the determinant's permanent and the determinant it is well known.
const WELL: f64 = 1e6;

/// Outside of this range low words could underflow.
const RANGE: std::ops::RangeInclusive<f64> = 1e-200..=1e200;

/// The meeting point of three planes, each coordinate rounded correctly; `None` where some coordinate cannot be rounded with certainty. `point` is the
/// same in plain numbers.
pub(super) fn refined(planes: [&Row; 3], point: &Homogeneous) -> Option<[f64; 3]> {
    let [x, y, z, w] = point.value;
    let start = [x / w, y / w, z / w];
    let condition = point.permanent[3] / w.abs();
    // a comparison with what is no number fails
    let is_well_known = condition <= WELL && point.permanent.iter().all(|p| *p == 0.0 || RANGE.contains(p));
    if !is_well_known {
        return None;
    }
    let rows = planes.map(Row::coefficients);
    // each with what it may be off by, divided by U
    let mut residuals = [(0.0, 0.0); 3];
    for (residual, row) in residuals.iter_mut().zip(rows) {
        *residual = residual_of(row, &start)?;
    }
    let mut rounded = [0.0; 3];
    for (axis, rounded) in rounded.iter_mut().enumerate() {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let (mut sum, mut off) = (0.0, 0.0);
        for (k, (residual, error)) in residuals.into_iter().enumerate() {
            let (p, q) = (rows[(k + 1) % 3], rows[(k + 2) % 3]);
            let (left, right) = (p[u] * q[v], p[v] * q[u]);
            sum += residual * (left - right);
            // seven roundings of each term, and those of the determinant that all are divided by
            off += (left.abs() + right.abs()) * ((16.0 + 16.0 * condition) * residual.abs() + error);
        }
        let off = 2.0 * U * off / w.abs();
        *rounded = DoubleDouble::sum(start[axis], sum / w).rounded_with(off)?;
    }
    Some(rounded)
}

/// What a point lacks in the equation of a plane, and what that may be off by, divided by [`U`].
///
/// Products are exact, sums of two leave their roundings behind (Ogita, Rump, Oishi, "Accurate sum and dot product", 2005): only sums of these are rounded,
/// seven of at most `U` of all magnitudes each, and their last sum.
fn residual_of([a, b, c, d]: &[f64; 4], [x, y, z]: &[f64; 3]) -> Option<(f64, f64)> {
    let products = [(*a, *x), (*b, *y), (*c, *z)].map(|(n, at)| exact_product(n, at));
    let (mut sum, mut rest) = (*d, 0.0);
    let mut magnitude = d.abs();
    for (high, low) in products {
        let next = DoubleDouble::sum(sum, -high);
        sum = next.high;
        rest += next.low - low;
        magnitude += high.abs();
    }
    let is_in_range = magnitude == 0.0 || RANGE.contains(&magnitude);
    is_in_range.then(|| (sum + rest, 64.0 * U * magnitude + 2.0 * (sum + rest).abs()))
}

#[cfg(test)]
mod tests {
    use super::super::{meet, meet_exact};
    use super::*;
    use crate::HalfSpace;
    use glam::DVec3;

    /// How many of some random meeting points are refined; all that are must be those of big integers, bit for bit.
    fn compare(spread: f64, distance: f64) -> usize {
        let mut state = 0x9E37_79B9_7F4A_7C15_u64;
        let mut random = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        let mut refined_count = 0;
        for step in 0..2000 {
            let base = DVec3::new(random(), random(), random());
            let mut row = || {
                let normal = base + spread * DVec3::new(random(), random(), random());
                Row::new(&HalfSpace::new(normal, distance * random()).expect("a plane"))
            };
            let planes = [row(), row(), row()];
            let [a, b, c] = planes.each_ref();
            let exact = meet_exact(a, b, c);
            assert_eq!(meet(a, b, c), exact, "step {step}: {planes:?}");
            if let Some(rounded) = refined([a, b, c], &Homogeneous::meet(a, b, c)) {
                refined_count += 1;
                assert_eq!(Some(DVec3::from_array(rounded)), exact, "step {step}: {planes:?}");
            }
        }
        refined_count
    }

    #[test]
    fn refined_points_are_those_of_big_integers() {
        // well conditioned, with nearly parallel planes, far away, near the origin
        let counts = [(1.0, 1.0), (1e-2, 1.0), (1e-3, 1e6), (1.0, 1e-30)].map(|(spread, at)| compare(spread, at));
        assert!(counts.iter().all(|count| *count > 100), "{counts:?}");
    }

    #[test]
    fn ties_are_left_to_others() {
        let row = |x: f64, y: f64, z: f64, d: f64| Row::new(&HalfSpace::new(DVec3::new(x, y, z), d).expect("a plane"));
        // x = 1 + 2⁻⁵³ lies between two numbers
        let planes = [row(1.0, -f64::EPSILON / 2.0, 0.0, 1.0), row(0.0, 1.0, 0.1, 1.0), row(0.0, 0.0, 1.0, 0.0)];
        let [a, b, c] = planes.each_ref();
        assert_eq!(refined([a, b, c], &Homogeneous::meet(a, b, c)), None);
        assert_eq!(meet(a, b, c), Some(DVec3::new(1.0, 1.0, 0.0)));
    }
}
