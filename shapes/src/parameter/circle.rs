//! Directions on a circle that are symmetric to the last bit.

use planecut_csg::sine_and_cosine;
use planecut_kernel::DVec2;

/// The direction at `part / whole` of a turn from the x axis, counter-clockwise.
///
/// The angle is folded into one octant in whole numbers before anything is rounded, so that directions which mirror each
/// other in an axis or a diagonal do so exactly.
pub(crate) fn direction(part: u64, whole: u64) -> DVec2 {
    let part = part % whole;
    let (quadrant, rest) = (4 * part / whole, 4 * part % whole);
    // `rest / whole` of a right angle
    let first = if 2 * rest <= whole { first_octant(rest, whole) } else { swap(first_octant(whole - rest, whole)) };
    match quadrant {
        0 => first,
        1 => DVec2::new(0.0 - first.y, first.x),
        2 => DVec2::new(0.0 - first.x, 0.0 - first.y),
        _ => DVec2::new(first.y, 0.0 - first.x),
    }
}

/// The direction at `part / whole ≤ ½` of a right angle.
fn first_octant(part: u64, whole: u64) -> DVec2 {
    let (sine, cosine) = sine_and_cosine(90.0 * part as f64 / whole as f64);
    DVec2::new(cosine, sine)
}

fn swap(v: DVec2) -> DVec2 {
    DVec2::new(v.y, v.x)
}

/// The direction halfway between corner `k` of a regular polygon of `n` corners and the next.
pub(crate) fn middle(k: u32, n: u32) -> DVec2 {
    direction(2 * u64::from(k) + 1, 2 * u64::from(n))
}

/// The cosine of half a segment of a circle of `n` segments.
pub(crate) fn apothem(n: u32) -> f64 {
    direction(1, 2 * u64::from(n)).x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_mirror_each_other_exactly() {
        for whole in 1..200 {
            for part in 0..whole {
                let at = direction(part, whole);
                let angle = std::f64::consts::TAU * part as f64 / whole as f64;
                // the angle itself is rounded three times
                let rounding = 2.0 * f64::EPSILON * angle.max(1.0);
                assert!((at - DVec2::new(angle.cos(), angle.sin())).length() < rounding, "{part}/{whole}");
                let mirrored = direction(whole - part, whole);
                assert_eq!((mirrored.x, mirrored.y), (at.x, 0.0 - at.y), "{part}/{whole}");
                let opposite = direction(2 * part + whole, 2 * whole);
                assert_eq!((opposite.x, opposite.y), (0.0 - at.x, 0.0 - at.y), "{part}/{whole}");
                let quarter = direction(4 * part + whole, 4 * whole);
                assert_eq!((quarter.x, quarter.y), (0.0 - at.y, at.x), "{part}/{whole}");
            }
        }
    }
}
