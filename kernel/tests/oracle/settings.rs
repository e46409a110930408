//! What the environment may change: the amount of work and the seed.

/// Operations per category: `PLANECUT_OPS`, or else `default`.
pub(crate) fn operations(default: usize) -> usize {
    number("PLANECUT_OPS").map_or(default, |n| n as usize)
}

/// The first seed: `PLANECUT_SEED`, or else a constant.
pub(crate) fn first_seed() -> u64 {
    number("PLANECUT_SEED").unwrap_or(0x0050_1A4E)
}

fn number(variable: &str) -> Option<u64> {
    let text = std::env::var(variable).ok()?;
    Some(text.parse().unwrap_or_else(|_| panic!("{variable} must be a number, found {text:?}")))
}
