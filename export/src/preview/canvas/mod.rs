//! Lines, areas and text on top of a picture.

pub(super) mod overlay;
pub(super) mod text;
