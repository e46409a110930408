//! A bounding-volume hierarchy over boxes: which of them meet a given box.

use glam::DVec3;

use crate::parallel;

/// An axis-aligned box; closed, so that boxes which touch meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Aabb {
    pub(crate) min: DVec3,
    pub(crate) max: DVec3,
}

impl Aabb {
    /// The box of no points; joining it with another gives the other.
    pub(crate) const EMPTY: Self = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    pub(crate) fn of_points(points: &[DVec3]) -> Self {
        points.iter().fold(Self::EMPTY, |b, &p| Self { min: b.min.min(p), max: b.max.max(p) })
    }

    pub(crate) fn grown(self, by: f64) -> Self {
        Self { min: self.min - by, max: self.max + by }
    }

    pub(crate) fn joined(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Whether they have a point in common.
    pub(crate) fn meets(&self, other: &Self) -> bool {
        self.min.cmple(other.max).all() && other.min.cmple(self.max).all()
    }
}

/// Most items in a leaf.
const LEAF: usize = 4;
/// Below this many items a subtree is built on the current thread.
pub(crate) const PARALLEL_BUILD: usize = 512;

#[derive(Clone, Copy)]
struct Node {
    bounds: Aabb,
    /// The items below are `items[start..start + count]`.
    start: u32,
    count: u32,
}

/// A complete binary tree in preorder: a node's left child follows it, then the left subtree, then the right child.
/// The shape depends on the number of items alone, the same boxes always give the same tree.
pub(crate) struct Bvh {
    nodes: Vec<Node>,
    items: Vec<u32>,
    boxes: Vec<Aabb>,
    levels: u32,
}

/// Levels of inner nodes above the leaves: items are halved until they fit a leaf, everywhere equally often.
pub(crate) fn levels(items: usize) -> u32 {
    items.div_ceil(LEAF).max(1).next_power_of_two().trailing_zeros()
}

/// Number of nodes of a tree with `levels` levels of inner nodes.
pub(crate) fn node_count(levels: u32) -> usize {
    (2 << levels) - 1
}

impl Bvh {
    /// The tree over `boxes`; at most `u32::MAX` of them.
    pub(crate) fn new(boxes: Vec<Aabb>) -> Self {
        let mut items: Vec<u32> = (0..boxes.len() as u32).collect();
        let empty = Node { bounds: Aabb::EMPTY, start: 0, count: 0 };
        let levels = levels(items.len());
        let mut nodes = vec![empty; node_count(levels)];
        build(&mut nodes, &mut items, 0, levels, &boxes);
        Self { nodes, items, boxes, levels }
    }

    /// Calls `visit` once with every pair of different items that has the item at `place` (in tree order) first and whose
    /// boxes meet: over all places, each pair comes once.
    pub(crate) fn visit_pairs_of(&self, place: usize, mut visit: impl FnMut(u32, u32)) {
        let item = self.items[place];
        self.visit_from(place + 1, &self.boxes[item as usize], |other| visit(item, other));
    }

    fn visit_from(&self, first: usize, query: &Aabb, mut visit: impl FnMut(u32)) {
        // A path holds at most one pending sibling per level, and there are at most 32 levels.
        let mut stack = [(0usize, 0u32); 40];
        stack[0] = (0, self.levels);
        let mut top = 1;
        while top > 0 {
            top -= 1;
            let (index, height) = stack[top];
            let node = &self.nodes[index];
            let (start, end) = (node.start as usize, (node.start + node.count) as usize);
            if end <= first || !node.bounds.meets(query) {
                continue;
            }
            if height > 0 {
                stack[top] = (index + 1 + node_count(height - 1), height - 1);
                stack[top + 1] = (index + 1, height - 1);
                top += 2;
                continue;
            }
            let near = self.items[start.max(first)..end].iter();
            near.copied().filter(|&item| self.boxes[item as usize].meets(query)).for_each(&mut visit);
        }
    }
}

/// Builds the subtree of the given height over `items`, which are `start..` of all items, into `nodes` in preorder.
fn build(nodes: &mut [Node], items: &mut [u32], start: u32, height: u32, boxes: &[Aabb]) {
    let count = items.len() as u32;
    if height == 0 {
        let bounds = items.iter().fold(Aabb::EMPTY, |b, &i| b.joined(boxes[i as usize]));
        nodes[0] = Node { bounds, start, count };
        return;
    }
    let centre = |i: u32| boxes[i as usize].min + boxes[i as usize].max;
    let spread = items.iter().fold(Aabb::EMPTY, |b, &i| b.joined(Aabb { min: centre(i), max: centre(i) }));
    let extent = spread.max - spread.min;
    let axis = (0..3).max_by(|&i, &j| extent[i].total_cmp(&extent[j])).unwrap_or(0);
    let middle = items.len() / 2;
    if middle > 0 {
        items.select_nth_unstable_by(middle, |&i, &j| centre(i)[axis].total_cmp(&centre(j)[axis]).then(i.cmp(&j)));
    }
    let (low, high) = items.split_at_mut(middle);
    let (own, below) = nodes.split_at_mut(1);
    let (left, right) = below.split_at_mut(below.len() / 2);
    let high_start = start + middle as u32;
    if low.len() + high.len() >= PARALLEL_BUILD {
        parallel::join(
            || build(left, low, start, height - 1, boxes),
            || build(right, high, high_start, height - 1, boxes),
        );
    } else {
        build(left, low, start, height - 1, boxes);
        build(right, high, high_start, height - 1, boxes);
    }
    own[0] = Node { bounds: left[0].bounds.joined(right[0].bounds), start, count };
}

#[cfg(test)]
mod tests {
    use planecut_testkit::random::Rng;

    use super::*;

    #[test]
    fn finds_what_a_scan_finds() {
        let seed = 0x5eed_0003;
        let mut random = Rng::new(seed);
        for count in [0usize, 1, 3, 4, 5, 9, 17, 100, 1000] {
            let mut point = || DVec3::from_array([0; 3].map(|_| random.whole(0, 63)));
            let boxes: Vec<Aabb> = (0..count)
                .map(|_| {
                    let p = point();
                    Aabb::of_points(&[p, p + point() / 8.0])
                })
                .collect();
            let tree = Bvh::new(boxes.clone());
            let mut pairs = Vec::new();
            for place in 0..count {
                tree.visit_pairs_of(place, |i, j| pairs.push((i.min(j), i.max(j))));
            }
            pairs.sort_unstable();
            let meets = &|i: usize, j: usize| boxes[i].meets(&boxes[j]);
            let scanned: Vec<(u32, u32)> = (0..count)
                .flat_map(|i| (i + 1..count).filter(move |&j| meets(i, j)).map(move |j| (i as u32, j as u32)))
                .collect();
            assert_eq!(pairs, scanned, "seed {seed:#x}, {count} boxes");
        }
    }
}
