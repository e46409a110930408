//! The parts of floating-point numbers.

/// `⌊log₂|v|⌋` of a normal number.
pub(crate) fn exponent(v: f64) -> i32 {
    ((v.to_bits() >> 52) & 0x7ff) as i32 - 1023
}

/// The exponent of the lowest set bit of a non-zero normal number.
pub(crate) fn lowest_bit(v: f64) -> i32 {
    decompose_odd(v).1
}

/// `v = mantissa · 2^exponent` for a finite number.
#[must_use]
pub fn decompose(v: f64) -> (i64, i32) {
    let bits = v.to_bits();
    let field = ((bits >> 52) & 0x7ff) as i32;
    let fraction = (bits & ((1 << 52) - 1)) as i64;
    let (mantissa, exponent) = if field == 0 { (fraction, -1074) } else { (fraction | (1 << 52), field - 1075) };
    (if v.is_sign_negative() { -mantissa } else { mantissa }, exponent)
}

/// `v = mantissa · 2^exponent` for a finite number, with an odd mantissa; zero is `0 · 2^-1074`.
#[must_use]
pub fn decompose_odd(v: f64) -> (i64, i32) {
    let (mantissa, exponent) = decompose(v);
    let zeros = mantissa.trailing_zeros() % i64::BITS;
    (mantissa >> zeros, exponent + zeros as i32)
}

/// `v · 2^power`, rounded where it is below the normal range.
pub(crate) fn ldexp(mut v: f64, mut power: i64) -> f64 {
    const STEP: i64 = 1000;
    let factor = |p: i64| f64::from_bits(((1023 + p) as u64) << 52);
    while power > STEP && v.is_finite() {
        v *= factor(STEP);
        power -= STEP;
    }
    while power < -STEP && v != 0.0 {
        v *= factor(-STEP);
        power += STEP;
    }
    v * factor(power.clamp(-STEP, STEP))
}
