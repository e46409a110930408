//! The point that a mesh's single-precision positions are relative to.

use glam::DVec3;

/// Spacing of the candidate points relative to the half extent of the mesh: the origin is within 1/16 of the centre.
const GRID_FRACTION: f64 = 1.0 / 8.0;

/// Bits of an `f32` mantissa, the leading one included.
const MANTISSA_BITS: i32 = 24;

/// A point near the centre of the box around `positions` that every `f32` reader sees exactly.
///
/// Each coordinate is a multiple of a power of two and holds in single precision. So for coordinates on a binary grid
/// (integers, halves, …) both `position − origin` and the reader's `position + translation` are exact, as long as the
/// extent is within 2²⁴ grid steps. Zero for an empty list.
pub(super) fn choose_origin(positions: &[DVec3]) -> DVec3 {
    let Some(&first) = positions.first() else { return DVec3::ZERO };
    let (min, max) = positions.iter().fold((first, first), |(min, max), &p| (min.min(p), max.max(p)));
    // Halved before adding, so that no finite box overflows.
    let (center, half) = (min * 0.5 + max * 0.5, max * 0.5 - min * 0.5);
    let grid = power_of_two_at_most(half.max_element() * GRID_FRACTION);
    center.map(|value| round_to_grid(value, grid))
}

/// `value` rounded to a multiple of `grid`, or of the finest coarser power of two whose multiples near `value` hold in
/// single precision.
fn round_to_grid(value: f64, grid: f64) -> f64 {
    let single_step = power_of_two_at_most(value.abs()) * 2_f64.powi(1 - MANTISSA_BITS);
    let step = grid.max(single_step);
    let rounded = (value / step).round() * step;
    if (rounded as f32).is_normal() && f64::from(rounded as f32) == rounded { rounded } else { 0.0 }
}

/// The largest power of two that is not above `value`; zero for zero and for subnormal numbers.
fn power_of_two_at_most(value: f64) -> f64 {
    const EXPONENT: u64 = 0x7ff << 52;
    f64::from_bits(value.to_bits() & EXPONENT)
}

#[cfg(test)]
mod tests {
    use planecut_testkit::random::Rng;

    use super::*;

    /// Random boxes of integer coordinates at all distances: shifted positions and their way back are exact.
    #[test]
    fn integer_grids_survive_the_shift() {
        let mut rng = Rng::new(7);
        let mut random = |below: i64| rng.integer(0, below - 1);
        for round in 0..20_000 {
            let extent = 1 + random(1 << (1 + round % 22));
            let offset = random(1 << 31) - (1 << 30);
            let positions: Vec<_> =
                (0..4).map(|_| DVec3::from([(); 3].map(|()| (offset + random(extent + 1)) as f64))).collect();
            let origin = choose_origin(&positions);
            assert_eq!(origin.as_vec3().as_dvec3(), origin);
            for position in positions {
                let single = (position - origin).as_vec3();
                assert_eq!(single.as_dvec3() + origin, position, "seed 7, round {round}");
            }
        }
    }

    #[test]
    fn extremes_give_a_finite_origin() {
        for value in [0.0, 5e-324, 1e-310, 1e-45, 1e-38, 1.0, 1e38, 1e300, f64::MAX] {
            for positions in [vec![DVec3::splat(value)], vec![DVec3::splat(-value), DVec3::new(value, 0.0, 1.0)]] {
                let origin = choose_origin(&positions);
                assert!(origin.as_vec3().is_finite(), "{value}: {origin}");
            }
        }
    }
}
