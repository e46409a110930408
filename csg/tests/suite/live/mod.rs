//! Live models against freshly built models, edit by edit.
//!
//! - [`edits`]: sequences of edits, what they must come to, shrinking and printing them as Rust.
//! - [`random`]: random sequences, [`large`]: such on brushes of many planes; [`cases`]: edits that once went wrong or easily could.
//! - [`steps`]: several edits as one; [`tree`]: edits of how brushes are combined, and copies; [`preview`]: what an edit would do, and where planes snap to.
//! - [`meshes`]: models some of whose brushes are closed meshes.

mod cases;
mod edits;
mod large;
mod meshes;
mod preview;
mod random;
mod steps;
mod tree;
