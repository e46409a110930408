//! Trees of what is made loop by loop.

use super::ShapeError;
use super::parameter::pieces;
use crate::brush::Brush;
use crate::tree::Tree;

/// The bodies over the shapes of an outline.
///
/// What a hole leaves out is subtracted: a plate with a round hole is two brushes, where a union of convex cells needs one for
/// each side of the hole.
#[derive(Default)]
pub(super) struct Region {
    whole: Vec<Brush>,
    pierced: Vec<Tree>,
    count: u64,
}

impl Region {
    /// Adds a shape: the cells over its outer loop, and those over each of its holes.
    pub(super) fn add(&mut self, loops: impl IntoIterator<Item = Vec<Brush>>) -> Result<(), ShapeError> {
        let mut loops = loops.into_iter();
        let outer = loops.next().unwrap_or_default();
        let holes: Vec<Brush> = loops.flatten().collect();
        self.count += (outer.len() + holes.len()) as u64;
        if holes.is_empty() {
            self.whole.extend(outer);
        } else {
            let operands = std::iter::once(union(outer)).chain(holes.into_iter().map(Tree::from));
            self.pierced.push(Tree::difference(operands));
        }
        pieces(self.count)
    }

    /// How many brushes there are.
    pub(super) fn count(&self) -> u64 {
        self.count
    }

    pub(super) fn into_tree(mut self) -> Tree {
        if self.pierced.is_empty() {
            return Tree::union_of(self.whole);
        }
        if self.pierced.len() == 1 && self.whole.is_empty() {
            return self.pierced.pop().unwrap_or_default();
        }
        Tree::union([Tree::union_of(self.whole)].into_iter().chain(self.pierced))
    }
}

fn union(mut brushes: Vec<Brush>) -> Tree {
    match brushes.pop() {
        Some(brush) if brushes.is_empty() => brush.into(),
        last => Tree::union_of(brushes.into_iter().chain(last).collect()),
    }
}
