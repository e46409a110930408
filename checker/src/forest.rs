//! Pairs of triangles that may touch: a tree of oriented boxes for the triangles at each hub and one for all others.

use std::sync::atomic::{AtomicUsize, Ordering};

use glam::DVec3;

use crate::bvh::{Aabb, Bvh, PARALLEL_BUILD, levels, node_count};
use crate::hubs::{Groups, arc};
use crate::obb::Obb;
use crate::parallel;

/// Pairs of subtrees to begin with, so that all threads have work.
const TASKS: usize = 1024;

/// A node in a tree: which tree, which node there, levels below it.
#[derive(Clone, Copy)]
struct Place {
    tree: u32,
    node: u32,
    height: u32,
}

#[derive(Clone)]
struct Node {
    bounds: Obb,
    start: u32,
    count: u32,
}

/// A complete binary tree in preorder over the triangles of a group.
struct Tree {
    nodes: Vec<Node>,
    items: Vec<u32>,
    height: u32,
}

/// The triangles of a mesh by where they are.
pub(crate) struct Forest<'a> {
    corners: &'a (dyn Fn(u32) -> [DVec3; 3] + Sync),
    boxes: &'a [Aabb],
    trees: Vec<Tree>,
    hubs: Vec<(DVec3, Vec<u32>)>,
    limit: f64,
}

impl<'a> Forest<'a> {
    /// The forest over groups of triangles, whose boxes are grown by half the limit.
    pub(crate) fn new(
        groups: Groups,
        corners: &'a (dyn Fn(u32) -> [DVec3; 3] + Sync),
        boxes: &'a [Aabb],
        limit: f64,
    ) -> Self {
        let Groups { groups, places } = groups;
        let hubs = places.into_iter().zip(groups.iter().skip(1).cloned()).collect();
        let trees = groups.into_iter().map(|items| Tree::new(items, corners, limit)).collect();
        Self { corners, boxes, trees, hubs, limit }
    }

    /// Calls `visit` with pairs of different triangles, among them all that have a contact, each pair once. Returns how many pairs of
    /// triangles and of boxes were looked at.
    pub(crate) fn visit_pairs(&self, visit: impl Fn(u32, u32) + Sync) -> usize {
        let looks = AtomicUsize::new(0);
        let is_near = |t: u32, u: u32| self.boxes[t as usize].meets(&self.boxes[u as usize]);
        let leaf_pair = |t: u32, u: u32| {
            if is_near(t, u) {
                visit(t, u);
            }
        };
        let tasks = self.tasks(&looks);
        parallel::for_each(tasks.len(), |k| {
            let mut open = vec![tasks[k]];
            let mut count = 0;
            while let Some(pair) = open.pop() {
                count += 1;
                if !self.divide(pair, &mut open) {
                    count += self.leaves(pair, &leaf_pair);
                }
            }
            looks.fetch_add(count, Ordering::Relaxed);
        });
        for (hub, items) in &self.hubs {
            looks.fetch_add(self.around(*hub, items, &leaf_pair), Ordering::Relaxed);
        }
        looks.into_inner()
    }

    /// Pairs of nodes that together hold all pairs of triangles of different groups, or of the group of those at no hub.
    fn tasks(&self, looks: &AtomicUsize) -> Vec<(Place, Place)> {
        let root = |tree: u32| Place { tree, node: 0, height: self.trees[tree as usize].height };
        let whole = |tree: &Tree| tree.items.iter().fold(Aabb::EMPTY, |b, &t| b.joined(self.boxes[t as usize]));
        let roots = Bvh::new(self.trees.iter().map(whole).collect());
        let mut open = vec![(root(0), root(0))];
        for place in 0..self.trees.len() {
            roots.visit_pairs_of(place, |t, u| open.push((root(t.min(u)), root(t.max(u)))));
        }
        let mut next = 0;
        let mut done = Vec::new();
        while next < open.len() && open.len() - next + done.len() < TASKS {
            let pair = open[next];
            next += 1;
            looks.fetch_add(1, Ordering::Relaxed);
            if !self.divide(pair, &mut open) {
                done.push(pair);
            }
        }
        done.extend_from_slice(&open[next..]);
        done
    }

    fn node(&self, place: Place) -> &Node {
        &self.trees[place.tree as usize].nodes[place.node as usize]
    }

    /// Replaces a pair by those below it whose boxes meet; false where both are leaves.
    fn divide(&self, (a, b): (Place, Place), open: &mut Vec<(Place, Place)>) -> bool {
        let is_same = a.tree == b.tree && a.node == b.node;
        if a.height == 0 && b.height == 0 {
            return false;
        }
        if is_same {
            let [left, right] = children(a);
            open.extend([(left, left), (right, right)]);
            self.push_if_near((left, right), open);
        } else if b.height == 0 || a.height > 0 && self.node(a).bounds.reach() >= self.node(b).bounds.reach() {
            children(a).into_iter().for_each(|child| self.push_if_near((child, b), open));
        } else {
            children(b).into_iter().for_each(|child| self.push_if_near((a, child), open));
        }
        true
    }

    fn push_if_near(&self, (a, b): (Place, Place), open: &mut Vec<(Place, Place)>) {
        if self.node(a).bounds.meets(&self.node(b).bounds) {
            open.push((a, b));
        }
    }

    fn items(&self, place: Place) -> &[u32] {
        let Node { start, count, .. } = self.node(place);
        &self.trees[place.tree as usize].items[*start as usize..(*start + *count) as usize]
    }

    /// Visits the pairs of two leaves, and counts them.
    fn leaves(&self, (a, b): (Place, Place), visit: &impl Fn(u32, u32)) -> usize {
        let is_same = a.tree == b.tree && a.node == b.node;
        let (of_a, of_b) = (self.items(a), self.items(b));
        let mut count = 0;
        for (k, &t) in of_a.iter().enumerate() {
            for &u in if is_same { &of_b[k + 1..] } else { of_b } {
                count += 1;
                visit(t, u);
            }
        }
        count
    }

    /// Visits the pairs of triangles at a hub whose arcs may meet, and counts them.
    fn around(&self, hub: DVec3, items: &[u32], visit: &(impl Fn(u32, u32) + Sync)) -> usize {
        let arcs = Bvh::new(parallel::map(items.len(), |k| arc((self.corners)(items[k]), hub, self.limit)));
        let looks = AtomicUsize::new(0);
        parallel::for_each(items.len(), |place| {
            arcs.visit_pairs_of(place, |k, l| {
                looks.fetch_add(1, Ordering::Relaxed);
                visit(items[k as usize], items[l as usize]);
            });
        });
        looks.into_inner()
    }
}

fn children(Place { tree, node, height }: Place) -> [Place; 2] {
    let height = height - 1;
    [node + 1, node + 1 + node_count(height) as u32].map(|node| Place { tree, node, height })
}

impl Tree {
    fn new(mut items: Vec<u32>, corners: &(dyn Fn(u32) -> [DVec3; 3] + Sync), limit: f64) -> Self {
        let height = levels(items.len());
        let empty = Node { bounds: Obb::of_points(&[], 0.0), start: 0, count: 0 };
        let mut nodes = vec![empty; node_count(height)];
        build(&mut nodes, &mut items, 0, height, &|item| corners(item), limit);
        Self { nodes, items, height }
    }
}

/// Builds the subtree of the given height over `items`, which are `start..` of all items of the tree, into `nodes` in preorder.
fn build(
    nodes: &mut [Node],
    items: &mut [u32],
    start: u32,
    height: u32,
    corners: &(dyn Fn(u32) -> [DVec3; 3] + Sync),
    limit: f64,
) {
    let points: Vec<DVec3> = items.iter().flat_map(|&item| corners(item)).collect();
    let bounds = Obb::of_points(&points, limit);
    let (own, below) = nodes.split_at_mut(1);
    own[0] = Node { bounds, start, count: items.len() as u32 };
    if height == 0 {
        return;
    }
    let middle = items.len() / 2;
    if middle > 0 {
        split(items, middle, &bounds, corners);
    }
    let (low, high) = items.split_at_mut(middle);
    let (left, right) = below.split_at_mut(below.len() / 2);
    let high_start = start + middle as u32;
    if low.len() + high.len() >= PARALLEL_BUILD {
        parallel::join(
            || build(left, low, start, height - 1, corners, limit),
            || build(right, high, high_start, height - 1, corners, limit),
        );
    } else {
        build(left, low, start, height - 1, corners, limit);
        build(right, high, high_start, height - 1, corners, limit);
    }
}

/// Puts those with the lesser centroids first, along the axis of the box on which centroids are spread most.
fn split(items: &mut [u32], middle: usize, bounds: &Obb, corners: &(dyn Fn(u32) -> [DVec3; 3] + Sync)) {
    let centroid = |item: u32| corners(item).into_iter().sum::<DVec3>();
    let spread = |axis: DVec3| {
        let along = items.iter().map(|&item| axis.dot(centroid(item)));
        let (low, high) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), h| (low.min(h), high.max(h)));
        high - low
    };
    let spreads = bounds.axes().map(|axis| (spread(axis), axis));
    let (_, axis) = spreads.into_iter().max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or_default();
    let key = |item: u32| axis.dot(centroid(item));
    items.select_nth_unstable_by(middle, |&i, &j| key(i).total_cmp(&key(j)).then(i.cmp(&j)));
}
