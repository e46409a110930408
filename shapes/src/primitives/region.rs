//! Trees of what is made loop by loop.

use planecut_csg::{Brush, Tree, TreeNode};

use crate::parameter::{ShapeError, pieces};

/// The bodies over the shapes of an outline.
///
/// What a hole leaves out is subtracted: a plate with a round hole is two brushes, where a union of convex cells needs one for
/// each side of the hole.
#[derive(Default)]
pub(super) struct Region {
    /// Convex parts without holes.
    convex: Vec<Brush>,
    others: Vec<Tree>,
    count: u64,
}

impl Region {
    /// Adds a shape: the parts over its outer loop, and those over each of its holes.
    pub(super) fn add(&mut self, loops: impl IntoIterator<Item = Vec<Tree>>) -> Result<(), ShapeError> {
        let mut loops = loops.into_iter();
        let outer = loops.next().unwrap_or_default();
        let holes: Vec<Tree> = loops.flatten().collect();
        self.count += outer.iter().chain(&holes).map(|tree| tree.brushes().len() as u64).sum::<u64>();
        if holes.is_empty() {
            let is_brush = |part: &Tree| part.nodes() == [TreeNode::Leaf];
            let (convex, others): (Vec<Tree>, Vec<Tree>) = outer.into_iter().partition(is_brush);
            self.convex.extend(convex.into_iter().flat_map(Tree::into_brushes));
            self.others.extend(others);
        } else {
            self.others.push(Tree::difference(std::iter::once(union(outer)).chain(holes)));
        }
        pieces(self.count)
    }

    /// How many brushes there are.
    pub(super) fn count(&self) -> u64 {
        self.count
    }

    pub(super) fn into_tree(mut self) -> Tree {
        if self.convex.is_empty() && self.others.len() == 1 {
            return self.others.pop().unwrap_or_default();
        }
        Tree::union([Tree::union_of(self.convex)].into_iter().chain(self.others))
    }
}

/// The union, or the only one.
fn union(mut parts: Vec<Tree>) -> Tree {
    if parts.len() == 1 { parts.pop().unwrap_or_default() } else { Tree::union(parts) }
}
