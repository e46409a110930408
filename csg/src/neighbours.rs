//! Which bodies come near a body: a bounding volume hierarchy over their boxes.

use crate::body::Body;
use crate::bounds::Bounds;

/// Leaves hold at most this many bodies.
const LEAF: usize = 4;

/// A node: its box, and either two children or a range of bodies.
#[derive(Debug, Clone, Copy)]
struct Node {
    bounds: Bounds,
    /// Where the node's bodies begin in the order.
    start: u32,
    end: u32,
    /// Index of the second child (the first follows the node); 0 for a leaf.
    second: u32,
}

/// A hierarchy of boxes, split at the median of the longest axis.
#[derive(Debug, Clone)]
pub(crate) struct Neighbours {
    nodes: Vec<Node>,
    order: Vec<u32>,
    boxes: Vec<Bounds>,
}

impl Neighbours {
    pub(crate) fn new(bodies: &[Body]) -> Self {
        let boxes: Vec<Bounds> = bodies.iter().map(|body| body.bounds).collect();
        let order = (0..bodies.len() as u32).collect();
        let mut tree = Self { nodes: Vec::new(), order, boxes };
        if !bodies.is_empty() {
            tree.split(0, bodies.len());
        }
        tree
    }

    fn split(&mut self, start: usize, end: usize) -> usize {
        let boxes = &self.boxes;
        let bounds = self.order[start..end].iter().fold(Bounds::EMPTY, |b, k| b.union(&boxes[*k as usize]));
        let node = self.nodes.len();
        self.nodes.push(Node { bounds, start: start as u32, end: end as u32, second: 0 });
        if end - start <= LEAF {
            return node;
        }
        let extent = bounds.max - bounds.min;
        let axis = extent.max_position();
        let middle = (start + end) / 2;
        let key = |k: &u32| boxes[*k as usize].center()[axis];
        self.order[start..end].select_nth_unstable_by(middle - start, |a, b| key(a).total_cmp(&key(b)).then(a.cmp(b)));
        self.split(start, middle);
        let second = self.split(middle, end);
        self.nodes[node].second = second as u32;
        node
    }

    /// The bodies other than `body` whose boxes touch `bounds`, by number.
    pub(crate) fn of(&self, body: usize, bounds: &Bounds, near: &mut Vec<u32>) {
        near.clear();
        let mut stack = vec![0_u32];
        while let Some(node) = stack.pop() {
            let Some(entry) = self.nodes.get(node as usize) else { continue };
            if !entry.bounds.touches(bounds) {
                continue;
            }
            if entry.second != 0 {
                stack.extend([node + 1, entry.second]);
                continue;
            }
            let range = &self.order[entry.start as usize..entry.end as usize];
            near.extend(range.iter().filter(|k| **k as usize != body && self.boxes[**k as usize].touches(bounds)));
        }
        near.sort_unstable();
    }
}
