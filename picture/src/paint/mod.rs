//! Samples, light and lines become pixels.

pub(crate) mod compose;
pub(crate) mod display;
pub(crate) mod hatch;
pub(crate) mod veil;
