//! What the environment may change: the amount of work and the seed.

/// Operations per category: `PLANECUT_OPS`, or else `default`.
#[must_use]
pub fn operations(default: usize) -> usize {
    number("PLANECUT_OPS").map_or(default, |n| n as usize)
}

/// Least number of scripts per category: `PLANECUT_CASES`, or else `default`.
#[must_use]
pub fn cases(default: usize) -> usize {
    number("PLANECUT_CASES").map_or(default, |n| n as usize)
}

/// The first seed: `PLANECUT_SEED`, or else a constant.
#[must_use]
pub fn first_seed() -> u64 {
    number("PLANECUT_SEED").unwrap_or(0x0050_1A4E)
}

fn number(variable: &str) -> Option<u64> {
    let text = std::env::var(variable).ok()?;
    Some(text.parse().unwrap_or_else(|_| panic!("{variable} must be a number, found {text:?}")))
}
