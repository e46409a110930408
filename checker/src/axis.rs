//! Directions orthogonal to two edges, right to the last digits also where the edges are almost parallel.
//!
//! The sides of a needle, a triangle a hundred million times longer than wide, are parallel but for the last digits of their
//! coordinates. In plain floating point their cross product is rounding noise, which may point along the needle instead of across. Here
//! differences are taken without error and products in twice the precision (Dekker 1971).

use glam::DVec3;

/// A number as an unevaluated sum of two.
#[derive(Clone, Copy)]
struct Twice {
    high: f64,
    low: f64,
}

impl Twice {
    /// `a - b` without error (Knuth).
    fn difference(a: f64, b: f64) -> Self {
        let high = a - b;
        let back = high - a;
        Self { high, low: (a - (high - back)) - (b + back) }
    }

    fn times(self, other: Self) -> Self {
        let high = self.high * other.high;
        let low = self.high.mul_add(other.high, -high) + (self.high * other.low + self.low * other.high);
        Self { high, low }
    }

    fn minus(self, other: Self) -> f64 {
        let Self { high, low } = Self::difference(self.high, other.high);
        high + (low + (self.low - other.low))
    }
}

/// The cross product of the edges from `p` to `q` and from `r` to `s`, in error by about `2^-104` of the product of their lengths.
pub(crate) fn across((p, q): (DVec3, DVec3), (r, s): (DVec3, DVec3)) -> DVec3 {
    let difference = |k: usize| (Twice::difference(q[k], p[k]), Twice::difference(s[k], r[k]));
    let [(ax, bx), (ay, by), (az, bz)] = [difference(0), difference(1), difference(2)];
    let minor = |a: Twice, b: Twice, c: Twice, d: Twice| a.times(d).minus(b.times(c));
    DVec3::new(minor(ay, az, by, bz), minor(az, ax, bz, bx), minor(ax, ay, bx, by))
}

#[cfg(test)]
mod tests {
    use dashu_ratio::RBig;
    use planecut_testkit::random::Rng;

    use super::*;

    fn exactly((p, q): (DVec3, DVec3), (r, s): (DVec3, DVec3)) -> [RBig; 3] {
        let exact = |v: f64| RBig::try_from(v).expect("coordinates are finite");
        let difference = |a: DVec3, b: DVec3| [0, 1, 2].map(|k| exact(b[k]) - exact(a[k]));
        let (u, v) = (difference(p, q), difference(r, s));
        let minor = |i: usize, j: usize| &u[i] * &v[j] - &u[j] * &v[i];
        [minor(1, 2), minor(2, 0), minor(0, 1)]
    }

    #[test]
    fn the_direction_across_a_needle_agrees_with_rationals() {
        let seed = 0x5eed_0004;
        let mut random = Rng::new(seed);
        let mut plain_is_wrong = 0;
        for case in 0..2_000 {
            // Three points of a line but for rounding, and a fourth, now near the line, now not.
            let (from, along) = (random.point(-1.0, 1.0), random.unit());
            let [p, q, r] = [0.0, 1.0, random.float(0.1, 0.9)].map(|s| from + along * s);
            let s = r + along + random.unit() * random.float(0.0, 1.0).powi(40);
            let found = across((p, q), (r, s));
            let close = exactly((p, q), (r, s))
                .iter()
                .zip(found.to_array())
                .all(|(exact, found)| (exact.to_f64().value() - found).abs() <= 1e-29);
            assert!(close, "seed {seed:#x} case {case}: {found}");
            plain_is_wrong += usize::from((q - p).cross(s - r).distance(found) > 0.1 * found.length());
        }
        assert!(plain_is_wrong > 100, "plain products would do: {plain_is_wrong}");
    }
}
