//! Samples, light and lines become pixels.

pub(super) mod compose;
pub(super) mod display;
pub(super) mod hatch;
pub(super) mod veil;
