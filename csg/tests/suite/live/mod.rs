//! Live models against freshly built models, edit by edit.
//!
//! - [`edits`]: sequences of edits, what they must come to, shrinking and printing them as Rust.
//! - [`random`]: random sequences, [`large`]: such on brushes of many planes; [`cases`]: edits that once went wrong or easily could.
//! - [`steps`]: several edits as one; [`tree`]: edits of how brushes are combined, and copies; [`preview`]: what an edit would do, and where planes snap to.
//! - [`drags`]: planes that move by little, and faces of many corners.
//! - [`growth`]: what an edit costs as the model grows.
//! - [`meshes`]: models some of whose brushes are closed meshes.
//! - [`bars`]: faces that very many brushes reach; [`rows`]: lines on which many edges lie one after the other.
//! - [`picks`]: which face a ray meets, [`measures`]: volume and area, [`buffers`]: faces for renderers.

mod bars;
mod buffers;
mod cases;
mod common_lines;
mod drags;
mod edits;
mod growth;
mod large;
mod measures;
mod meshes;
mod picks;
mod preview;
mod random;
mod rows;
mod steps;
mod tree;
