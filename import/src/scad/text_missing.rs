//! `text` in a build without the feature of that name: no fonts, and an error where a tree has letters.

use planecut_shapes::Outline;

use super::problem::Problem;
use super::syntax::Node;

/// The fonts of the system: none are read.
#[derive(Default)]
pub(super) struct Fonts {}

/// What a node draws: nothing that this build knows.
pub(super) fn text(_: &Node<'_>, _: &mut Fonts) -> Result<(Outline, Vec<String>), Problem> {
    Err(Problem::new("a text, and a program built without the feature `text`", "one that is built with it"))
}
