//! Arithmetic of about 106 bits: unevaluated sums of two numbers.

/// An unevaluated sum of two numbers, `|low| ≤ ½ ulp(high)` (Dekker 1971).
#[derive(Debug, Clone, Copy, Default)]
pub struct DoubleDouble {
    /// The sum, rounded.
    pub high: f64,
    /// What rounding left.
    pub low: f64,
}

impl DoubleDouble {
    /// The exact sum of two numbers.
    #[must_use]
    pub fn sum(a: f64, b: f64) -> Self {
        let high = a + b;
        let t = high - a;
        Self { high, low: (a - (high - t)) + (b - t) }
    }

    fn quick_sum(a: f64, b: f64) -> Self {
        let high = a + b;
        Self { high, low: b - (high - a) }
    }

    /// The exact product of two numbers.
    #[must_use]
    pub fn product(a: f64, b: f64) -> Self {
        let (high, low) = exact_product(a, b);
        Self { high, low }
    }

    /// The negated value.
    #[must_use]
    pub fn negated(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }

    /// The sum.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        let (s, t) = (Self::sum(self.high, other.high), Self::sum(self.low, other.low));
        let v = Self::quick_sum(s.high, s.low + t.high);
        Self::quick_sum(v.high, v.low + t.low)
    }

    /// The sum with less work, for where an error relative to the summands will do, which may cancel: with `u = 2⁻⁵³`, it is off by at most `7u²` of the sum of their magnitudes
    /// (algorithm 5 of Joldes, Muller, Popescu, "Tight and rigorous error bounds for basic building blocks of double-word arithmetic", 2017, which
    /// is off by `2u²` and less of the magnitudes before its last step; that loses at most `u` of a number of `4u` of them where they cancel).
    #[inline]
    #[must_use]
    pub fn plus_loosely(self, other: Self) -> Self {
        let s = Self::sum(self.high, other.high);
        Self::quick_sum(s.high, s.low + (self.low + other.low))
    }

    /// The product with a number.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        let p = Self::product(self.high, factor);
        Self::quick_sum(p.high, p.low + self.low * factor)
    }

    /// The product of two such sums.
    #[must_use]
    pub fn times_sum(self, other: Self) -> Self {
        let p = Self::product(self.high, other.high);
        Self::quick_sum(p.high, p.low + (self.high * other.low + self.low * other.high))
    }

    /// The quotient.
    #[must_use]
    pub fn over(self, divisor: Self) -> Self {
        let q1 = self.high / divisor.high;
        let r = self.plus(divisor.times(q1).negated());
        let q2 = r.high / divisor.high;
        let r = r.plus(divisor.times(q2).negated());
        let q3 = r.high / divisor.high;
        let q = Self::quick_sum(q1, q2);
        Self::quick_sum(q.high, q.low + q3)
    }

    /// The value rounded to one number, where an error of `±error` cannot change that.
    #[must_use]
    pub fn rounded_with(self, error: f64) -> Option<f64> {
        let up = self.high + (self.low + error);
        let down = self.high + (self.low - error);
        (up == down).then_some(up + 0.0)
    }
}

/// The product of two numbers as an exact unevaluated sum (Dekker 1971).
pub(crate) fn exact_product(a: f64, b: f64) -> (f64, f64) {
    let split = |v: f64| {
        let t = 134_217_729.0 * v; // 2²⁷ + 1
        let high = t - (t - v);
        (high, v - high)
    };
    let high = a * b;
    let ((a1, a0), (b1, b0)) = (split(a), split(b));
    (high, ((a1 * b1 - high) + a1 * b0 + a0 * b1) + a0 * b0)
}
