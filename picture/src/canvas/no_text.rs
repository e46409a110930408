//! What stands for letters where the feature `text` is off: no text has a width, and none is drawn.

use tiny_skia::Path;

/// Width of a text: none.
pub(crate) fn text_width(_: &str, _: f32) -> f32 {
    0.0
}

/// What has room of a text: nothing.
pub(crate) fn shortened(_: &str, _: f32, _: f32) -> String {
    String::new()
}

/// A font; there is none.
pub(crate) enum Face {}

impl Face {
    /// Always `None`.
    pub(crate) fn new() -> Option<Self> {
        None
    }

    /// Never called.
    pub(crate) fn cap_height(&self) -> f32 {
        match *self {}
    }

    /// Never called.
    pub(crate) fn width(&self, _: &str) -> f32 {
        match *self {}
    }

    /// Never called.
    pub(crate) fn path(&self, _: &str, _: f32, _: bool, _: impl Fn(f32, f32) -> bool) -> Option<Path> {
        match *self {}
    }
}
