//! Lines, areas and text on top of a picture.

pub(crate) mod labels;
pub(crate) mod overlay;
#[cfg(feature = "text")]
pub(crate) mod text;
#[cfg(not(feature = "text"))]
#[path = "no_text.rs"]
pub(crate) mod text;
