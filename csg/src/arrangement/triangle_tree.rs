//! A hierarchy of boxes around triangles, in the order of a curve through space (Morton 1966).

use glam::DVec3;
use planecut_parallel::prelude::*;

use crate::base::Bounds;
use crate::ids::number32;
use crate::plane_table::spread;

/// Leaves hold at most this many triangles.
pub(super) const LEAF: usize = 4;

/// Bits of each coordinate of a place on the curve.
const BITS: u32 = 10;

/// Triangles that one thread looks at in a row.
const CHUNK: usize = 1 << 13;

/// A node: its level, 0 for leaves, and its place there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct TreeNode {
    pub(super) level: u32,
    pub(super) index: u32,
}

/// A hierarchy of boxes around triangles. Each node above the leaves has two children, the last one of a level perhaps one.
#[derive(Debug, Clone, Default)]
pub(super) struct TriangleTree {
    /// The triangles of leaves, leaf by leaf.
    order: Vec<u32>,
    /// The boxes of each level, leaves first.
    levels: Vec<Vec<Bounds>>,
}

/// The box around a triangle.
#[inline]
pub(super) fn bounds_of([a, b, c]: [DVec3; 3]) -> Bounds {
    Bounds { min: a.min(b).min(c), max: a.max(b).max(c) }
}

impl TriangleTree {
    /// A hierarchy around the triangles of a list, with a box around each. No triangle: no node.
    pub(super) fn new(triangles: &[u32], bounds_of: impl Fn(u32) -> Bounds + Sync) -> Self {
        if triangles.is_empty() {
            return Self::default();
        }
        let all = |chunk: &[u32]| chunk.iter().fold(Bounds::EMPTY, |all, t| all.union(&bounds_of(*t)));
        let of_chunks: Vec<Bounds> = triangles.par_chunks(CHUNK).map(all).collect();
        let bounds = of_chunks.iter().fold(Bounds::EMPTY, |all, one| all.union(one));
        let scale = f64::from(1 << BITS) * 0.999_999 / (bounds.max - bounds.min).max(DVec3::splat(f64::MIN_POSITIVE));
        let number = |triangle: &u32| {
            let bounds_here = bounds_of(*triangle);
            let middle = 0.5 * bounds_here.min + 0.5 * bounds_here.max;
            let [x, y, z] = ((middle - bounds.min) * scale).to_array().map(|v| spread(cell(v)));
            // the place on the curve, and the triangle in the other half of the number
            (x | y << 1 | z << 2) << 32 | u64::from(*triangle)
        };
        let mut sorted: Vec<u64> = triangles.par_iter().with_min_len(CHUNK).map(number).collect();
        sorted.par_sort_unstable();
        let order: Vec<u32> = sorted.par_iter().with_min_len(CHUNK).map(|number| low_half(*number)).collect();
        let mut levels: Vec<Vec<Bounds>> = vec![order.par_chunks(LEAF).with_min_len(CHUNK / LEAF).map(all).collect()];
        while let Some(last) = levels.last().filter(|last| last.len() > 1) {
            let union = |pair: &[Bounds]| pair.iter().fold(Bounds::EMPTY, |all, bounds| all.union(bounds));
            levels.push(last.chunks(2).map(union).collect());
        }
        Self { order, levels }
    }

    /// The triangles, those that are near each other in a row.
    pub(super) fn order(&self) -> &[u32] {
        &self.order
    }

    /// The node around all triangles.
    pub(super) fn root(&self) -> Option<TreeNode> {
        self.levels.len().checked_sub(1).map(|level| TreeNode { level: number32(level), index: 0 })
    }

    /// The box of a node.
    #[inline]
    pub(super) fn bounds(&self, node: TreeNode) -> &Bounds {
        &self.levels[node.level as usize][node.index as usize]
    }

    /// The box around all triangles.
    pub(super) fn all_bounds(&self) -> Bounds {
        self.root().map_or(Bounds::EMPTY, |root| *self.bounds(root))
    }

    /// The children of a node that is no leaf.
    #[inline]
    pub(super) fn children(&self, node: TreeNode) -> (TreeNode, Option<TreeNode>) {
        let level = node.level - 1;
        let first = TreeNode { level, index: 2 * node.index };
        let second = TreeNode { level, index: 2 * node.index + 1 };
        let is_there = (second.index as usize) < self.levels[level as usize].len();
        (first, is_there.then_some(second))
    }

    /// The triangles of a leaf.
    #[inline]
    pub(super) fn triangles(&self, leaf: TreeNode) -> &[u32] {
        let start = leaf.index as usize * LEAF;
        &self.order[start..(start + LEAF).min(self.order.len())]
    }

    /// Calls for every triangle of a leaf whose box, and those of all nodes above it, pass a test.
    pub(super) fn for_each(&self, passes: impl Fn(&Bounds) -> bool, mut visit: impl FnMut(u32)) {
        let mut waiting: Vec<TreeNode> = self.root().into_iter().collect();
        while let Some(node) = waiting.pop() {
            if !passes(self.bounds(node)) {
                continue;
            }
            if node.level == 0 {
                self.triangles(node).iter().for_each(|triangle| visit(*triangle));
                continue;
            }
            let (first, second) = self.children(node);
            waiting.push(first);
            waiting.extend(second);
        }
    }
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "below 2¹⁰; casts saturate")]
fn cell(v: f64) -> u64 {
    v as u64
}

#[expect(clippy::cast_possible_truncation, reason = "the rest is meant to go")]
fn low_half(number: u64) -> u32 {
    number as u32
}
