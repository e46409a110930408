//! From sums over tetrahedra to volume, centroid and inertia, with the errors that the sums may have.

use std::array::from_fn;

use crate::arithmetic::{DoubleDouble, ldexp};
use glam::{DMat3, DVec3};

/// A relative error that moves a result by less than half a unit in its last place.
const CERTAIN: f64 = f64::from_bits((1023 - 55) << 52);
/// The error, in units of the body, that coordinates of the centroid and products of inertia may have near zero; what is zero
/// within it is given as zero, which can double it.
const NEGLIGIBLE: f64 = f64::from_bits((1023 - 76) << 52);
/// Relative error of a chain of a dozen double-double operations.
const STEP_BOUND: f64 = f64::from_bits((1023 - 99) << 52);

/// The pairs of axes of the second moments, in their order.
pub(super) const PAIRS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (1, 2), (2, 0), (0, 1)];

/// Sums over tetrahedra in coordinates `x = reference + 2^unit·y`, `|y| ≤ 1` and the body at least half a unit long on each
/// axis: `six_volume = 6·∫dV`, `first = 24·∫y dV`, `second = 120·∫y·y dV`, each times `2^−exponent`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sums {
    pub(super) six_volume: DoubleDouble,
    pub(super) first: [DoubleDouble; 3],
    pub(super) second: [DoubleDouble; 6],
    /// Bounds of the errors of the three kinds.
    pub(super) errors: [f64; 3],
    pub(super) exponent: i64,
    pub(super) reference: DVec3,
    /// The exponents of the units of the axes.
    pub(super) units: [i64; 3],
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
    pub(super) fn or(self, sums: &Sums) -> Self {
        if !sums.has_certain_volume() {
            return self;
        }
        Self {
            volume: self.volume.or_else(|| Some(sums.volume())),
            centroid: self.centroid.or_else(|| sums.centroid()),
            inertia: self.inertia.or_else(|| sums.inertia()),
        }
    }

    pub(super) fn are_complete(&self) -> bool {
        self.volume.is_some() && self.centroid.is_some() && self.inertia.is_some()
    }
}

/// The value where its error cannot matter; one that must be below `negligible` may count as zero.
fn certain(value: DoubleDouble, error: f64, negligible: f64) -> Option<f64> {
    let size = value.high.abs();
    if error <= CERTAIN * size {
        return Some(value.high);
    }
    (error <= negligible).then_some(if size <= error { 0.0 } else { value.high })
}

fn quotient(numerator: DoubleDouble, denominator: f64) -> DoubleDouble {
    numerator.over(DoubleDouble::sum(denominator, 0.0))
}

/// Times a power of two.
fn shifted(value: DoubleDouble, power: i64) -> DoubleDouble {
    DoubleDouble { high: ldexp(value.high, power), low: ldexp(value.low, power) }
}

impl Sums {
    fn has_certain_volume(&self) -> bool {
        self.six_volume.high > 0.0 && self.errors[0] <= CERTAIN * self.six_volume.high
    }

    fn volume(&self) -> f64 {
        ldexp(quotient(self.six_volume, 6.0).high, self.exponent + self.units.iter().sum::<i64>())
    }

    /// The mean of each coordinate, in units from the reference.
    fn means(&self) -> [DoubleDouble; 3] {
        self.first.map(|first| first.over(self.six_volume.times(4.0)))
    }

    /// A mean is at most one, so an error of the volume moves it by no more than that error's share in the volume.
    fn centroid(&self) -> Option<DVec3> {
        let [volume_error, first_error, _] = self.errors;
        let mean_error = (first_error + 5.0 * volume_error) / (4.0 * self.six_volume.high) + STEP_BOUND;
        let mut centroid = DVec3::ZERO;
        for (axis, mean) in self.means().into_iter().enumerate() {
            let unit = self.units[axis];
            let reference = ldexp(self.reference[axis], -unit);
            if reference.is_infinite() {
                // the body is nothing beside its distance from the origin
                centroid[axis] = self.reference[axis];
                continue;
            }
            let value = mean.plus(DoubleDouble::sum(reference, 0.0));
            let error = 1.01 * mean_error + STEP_BOUND * value.high.abs();
            centroid[axis] = ldexp(certain(value, error, NEGLIGIBLE / 2.0)?, unit);
        }
        Some(centroid)
    }

    /// From the central moments `∫ y·y dV = (second − 5·first·mean) / 120` in units.
    fn inertia(&self) -> Option<DMat3> {
        let means = self.means();
        let central: [DoubleDouble; 6] = from_fn(|at| {
            let (i, j) = PAIRS[at];
            self.second[at].plus(self.first[i].times_sum(means[j]).times(-5.0))
        });
        let error = self.central_error();
        let exponent = self.exponent + self.units.iter().sum::<i64>();
        let mut moments = [0.0; 6];
        for (at, moment) in moments.iter_mut().enumerate() {
            let (i, j) = PAIRS[at];
            let (value, power) = if at < 3 {
                // in lengths, counted in the longer unit of the two
                let [u, v] = [(at + 1) % 3, (at + 2) % 3];
                let longer = 2 * self.units[u].max(self.units[v]);
                let [power_u, power_v] = [2 * self.units[u] - longer, 2 * self.units[v] - longer];
                let sum = shifted(central[u], power_u).plus(shifted(central[v], power_v));
                let error = ldexp(error, power_u) + ldexp(error, power_v);
                (certain(quotient(sum, 120.0), error / 120.0, 0.0)?, longer)
            } else {
                // the body is at least half a unit long
                let negligible = NEGLIGIBLE * self.six_volume.high / 6.0 / 4.0;
                let product = quotient(central[at].negated(), 120.0);
                (certain(product, error / 120.0, negligible)?, self.units[i] + self.units[j])
            };
            *moment = ldexp(value, exponent + power);
        }
        let [xx, yy, zz, yz, zx, xy] = moments;
        Some(DMat3::from_cols_array(&[xx, xy, zx, xy, yy, yz, zx, yz, zz]))
    }

    /// A bound of the error of `second − 5·first·mean`, that is of `second − (5/4)·first·first/six_volume`.
    ///
    /// With `|y| ≤ 1`, `|first| ≤ 4·six_volume` and `|second| ≤ 20·six_volume`. The derivatives by both `first` and by the
    /// volume are at most `5 + 5` and `20`; what they leave is of the second order.
    fn central_error(&self) -> f64 {
        let [volume_error, first_error, second_error] = self.errors;
        let second_order = 2.0 * first_error * first_error / self.six_volume.high;
        let linear = second_error + 10.5 * first_error + 21.0 * volume_error;
        1.01 * (linear + second_order) + STEP_BOUND * 40.0 * self.six_volume.high
    }
}
