//! From sums over tetrahedra to volume, centroid and inertia, with the errors that the sums may have.

use std::array::from_fn;

use dashu_int::{IBig, UBig, ops::BitTest};
use glam::{DMat3, DVec3};

use crate::meet::{ldexp, round_quotient};
use crate::sign::big_integers;

/// A relative error that moves a result by less than half a unit in its last place.
const CERTAIN_BITS: usize = 55;
/// What is zero within an error that is this much smaller than the body counts as zero.
const ZERO_BITS: usize = 200;

/// The pairs of axes of the second moments, in their order.
pub(super) const PAIRS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (1, 2), (2, 0), (0, 1)];

/// Sums over tetrahedra in coordinates `x = reference + unit·y`: `six_volume = 6·∫dV`, `first = 24·∫y dV`,
/// `second = 120·∫y·y dV`, each an integer times `2^−fraction` with a bound of its error in the same unit.
#[derive(Debug, Clone)]
pub(super) struct Sums {
    pub(super) six_volume: IBig,
    pub(super) first: [IBig; 3],
    /// Left out where nobody asks.
    pub(super) second: Option<[IBig; 6]>,
    /// Errors of the three kinds.
    pub(super) errors: [IBig; 3],
    pub(super) fraction: usize,
    pub(super) reference: DVec3,
    /// The length of one unit of each axis: `mantissa·2^exponent`, positive.
    pub(super) unit: [(IBig, i64); 3],
}

/// The figures of a solid, as far as they are certain.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Figures {
    pub(super) volume: Option<f64>,
    pub(super) centroid: Option<DVec3>,
    pub(super) inertia: Option<DMat3>,
}

impl Figures {
    /// Fills in what is not there yet.
    pub(super) fn or(self, sums: impl FnOnce() -> Option<Sums>) -> Self {
        if self.volume.is_some() && self.centroid.is_some() && self.inertia.is_some() {
            return self;
        }
        let Some(sums) = sums() else { return self };
        let Some(six) = sums.certain_volume() else { return self };
        Self {
            volume: self.volume.or_else(|| Some(sums.volume(&six))),
            centroid: self.centroid.or_else(|| sums.centroid(&six)),
            inertia: self.inertia.or_else(|| sums.inertia(&six)),
        }
    }
}

fn magnitude(v: &IBig) -> IBig {
    let magnitude: UBig = v.clone().into_parts().1;
    IBig::from(magnitude)
}

/// The value where its error cannot matter.
fn certified(value: IBig, error: &IBig, size: &IBig) -> Option<IBig> {
    if error.is_zero() || (error << CERTAIN_BITS) <= magnitude(&value) {
        return Some(value);
    }
    (magnitude(&value) <= *error && (error << ZERO_BITS) <= *size).then_some(IBig::ZERO)
}

/// `numerator / denominator · 2^exponent`, rounded once.
fn scaled_quotient(numerator: IBig, denominator: &IBig, exponent: i64) -> f64 {
    // both brought to about the same length, so that the quotient is in range
    let surplus = numerator.bit_len() as i64 - denominator.bit_len() as i64;
    if surplus >= 0 {
        ldexp(round_quotient(numerator, &(denominator << surplus as usize)), exponent + surplus)
    } else {
        ldexp(round_quotient(numerator << (-surplus) as usize, denominator), exponent + surplus)
    }
}

impl Sums {
    /// Six times the volume in units, where it is certain.
    fn certain_volume(&self) -> Option<IBig> {
        certified(self.six_volume.clone(), &self.errors[0], &IBig::ZERO).filter(|six| *six > IBig::ZERO)
    }

    /// The volume of a unit cell: mantissa, and exponent with the fraction of the sums.
    fn cell(&self) -> (IBig, i64) {
        let [(x, ex), (y, ey), (z, ez)] = &self.unit;
        (x * y * z, ex + ey + ez - self.fraction as i64)
    }

    fn volume(&self, six: &IBig) -> f64 {
        let (cell, exponent) = self.cell();
        scaled_quotient(six * cell, &IBig::from(6), exponent)
    }

    fn centroid(&self, six: &IBig) -> Option<DVec3> {
        let [volume_error, first_error, _] = &self.errors;
        let four = six * IBig::from(4);
        let mut centroid = DVec3::ZERO;
        for axis in 0..3 {
            let (mantissa, exponent) = &self.unit[axis];
            // reference + mantissa·2^exponent·first / four, counted in 2^exponent
            let [reference, one] = big_integers([ldexp(self.reference[axis], -exponent), 1.0]);
            let whole = &reference * &four + mantissa * &self.first[axis] * &one;
            let error = magnitude(&reference) * IBig::from(4) * volume_error + mantissa * first_error * &one;
            let size = (magnitude(&reference) + mantissa * &one) * &four;
            centroid[axis] = scaled_quotient(certified(whole, &error, &size)?, &(&four * one), *exponent);
        }
        Some(centroid)
    }

    fn inertia(&self, six: &IBig) -> Option<DMat3> {
        let [volume_error, first_error, second_error] = &self.errors;
        let second_moments = self.second.as_ref()?;
        let four = six * IBig::from(4);
        // the central moment ∫ y·y dV is (4·second·six − 5·first·first) / (480·six)
        let central: [IBig; 6] = from_fn(|at| {
            let (i, j) = PAIRS[at];
            &second_moments[at] * &four - IBig::from(5) * &self.first[i] * &self.first[j]
        });
        let error: [IBig; 6] = from_fn(|at| {
            let (i, j) = PAIRS[at];
            let second = (magnitude(&second_moments[at]) + second_error) * volume_error + six * second_error;
            let first = (magnitude(&self.first[i]) + magnitude(&self.first[j]) + first_error) * first_error;
            IBig::from(4) * second + IBig::from(5) * first
        });
        // in lengths: times the units of both axes, counted in the smallest power of two
        let lowest = self.unit.iter().map(|(_, exponent)| *exponent).min().unwrap_or(0);
        let scaled = |values: &[IBig; 6], at: usize| {
            let (i, j) = PAIRS[at];
            let shift = (self.unit[i].1 + self.unit[j].1 - 2 * lowest) as usize;
            (&values[at] * &self.unit[i].0 * &self.unit[j].0) << shift
        };
        let divisor = six * IBig::from(480);
        let (cell, exponent) = self.cell();
        let figure = |value: IBig, error: &IBig, size: &IBig| {
            let value = certified(value, error, size)?;
            Some(scaled_quotient(value * &cell, &divisor, exponent + 2 * lowest))
        };
        let diagonal: [IBig; 3] = from_fn(|at| scaled(&central, at));
        let size = &diagonal[0] + &diagonal[1] + &diagonal[2];
        let mut moments = [0.0; 6];
        for (at, moment) in moments.iter_mut().enumerate() {
            *moment = if at < 3 {
                let (u, v) = ((at + 1) % 3, (at + 2) % 3);
                figure(&diagonal[u] + &diagonal[v], &(scaled(&error, u) + scaled(&error, v)), &IBig::ZERO)?
            } else {
                figure(-scaled(&central, at), &scaled(&error, at), &size)?
            };
        }
        let [xx, yy, zz, yz, zx, xy] = moments;
        Some(DMat3::from_cols_array(&[xx, xy, zx, xy, yy, yz, zx, yz, zz]))
    }
}
