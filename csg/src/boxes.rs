//! Which of many boxes touch a box.

use std::convert::Infallible;
use std::ops::ControlFlow;

use crate::bounds::Bounds;

/// Leaves hold at most this many boxes.
const LEAF: usize = 4;

#[derive(Debug, Clone, Copy)]
struct Node {
    bounds: Bounds,
    start: u32,
    end: u32,
    /// Index of the second child (the first follows the node); 0 for a leaf.
    second: u32,
}

/// A hierarchy of boxes, split at the median of the longest axis. Infinite boxes are kept beside it.
#[derive(Debug, Clone, Default)]
pub(crate) struct Boxes {
    boxes: Vec<Bounds>,
    order: Vec<u32>,
    nodes: Vec<Node>,
    infinite: Vec<u32>,
}

impl Boxes {
    /// Boxes are numbered in the order given; empty ones touch nothing.
    pub(crate) fn new(boxes: Vec<Bounds>) -> Self {
        let mut tree = Self { boxes, ..Self::default() };
        for (number, bounds) in (0..).zip(&tree.boxes) {
            if bounds.min.is_finite() && bounds.max.is_finite() {
                tree.order.push(number);
            } else if bounds.min.cmple(bounds.max).all() {
                tree.infinite.push(number);
            }
        }
        tree.split_all();
        tree
    }

    /// Splits ranges until they are short; the first half of each directly follows it.
    fn split_all(&mut self) {
        // (start, end, the node whose second child this is)
        let mut waiting = vec![(0, self.order.len(), None)];
        while let Some((start, end, second_of)) = waiting.pop() {
            if start == end {
                continue;
            }
            let node = self.nodes.len();
            if let Some(parent) = second_of {
                let parent: &mut Node = &mut self.nodes[parent];
                parent.second = node as u32;
            }
            let (boxes, range) = (&self.boxes, &mut self.order[start..end]);
            let bounds = range.iter().fold(Bounds::EMPTY, |bounds, k| bounds.union(&boxes[*k as usize]));
            self.nodes.push(Node { bounds, start: start as u32, end: end as u32, second: 0 });
            if end - start > LEAF {
                let axis = (bounds.max - bounds.min).max_position();
                let half = range.len() / 2;
                let key = |k: &u32| boxes[*k as usize].center()[axis];
                range.select_nth_unstable_by(half, |a, b| key(a).total_cmp(&key(b)).then(a.cmp(b)));
                waiting.extend([(start + half, end, Some(node)), (start, start + half, None)]);
            }
        }
    }

    /// All boxes that are not empty, those that are near each other in a row.
    pub(crate) fn in_order(&self) -> impl Iterator<Item = u32> + '_ {
        self.order.iter().chain(&self.infinite).copied()
    }

    pub(crate) fn get(&self, number: u32) -> &Bounds {
        &self.boxes[number as usize]
    }

    /// The boxes that fulfil a condition which holds for a box wherever it holds for one within, ascending.
    pub(crate) fn find(&self, condition: impl Fn(&Bounds) -> bool, found: &mut Vec<u32>) {
        found.clear();
        let _: ControlFlow<Infallible> = self.walk(
            |node| condition(&self.nodes[node].bounds),
            |number| {
                if condition(self.get(number)) {
                    found.push(number);
                }
                ControlFlow::Continue(())
            },
        );
        found.sort_unstable();
    }

    /// Visits the boxes of all nodes that are to be entered, and infinite boxes always, until a visit ends it.
    pub(crate) fn walk<B>(
        &self,
        enter: impl Fn(usize) -> bool,
        mut visit: impl FnMut(u32) -> ControlFlow<B>,
    ) -> ControlFlow<B> {
        self.infinite.iter().try_for_each(|number| visit(*number))?;
        let mut waiting: Vec<u32> = if self.nodes.is_empty() { Vec::new() } else { vec![0] };
        while let Some(number) = waiting.pop() {
            if !enter(number as usize) {
                continue;
            }
            let node = &self.nodes[number as usize];
            if node.second != 0 {
                waiting.extend([number + 1, node.second]);
            } else {
                self.of_node(node).iter().try_for_each(|number| visit(*number))?;
            }
        }
        ControlFlow::Continue(())
    }

    fn of_node(&self, node: &Node) -> &[u32] {
        &self.order[node.start as usize..node.end as usize]
    }

    /// The boxes that touch a box, ascending.
    pub(crate) fn touching(&self, bounds: &Bounds, found: &mut Vec<u32>) {
        self.find(|other| other.touches(bounds), found);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use planecut_kernel::DVec3;

    #[test]
    fn the_same_boxes_are_found_as_by_asking_each() {
        let mut state = 7_u64;
        let mut number = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 40) as f64 / f64::from(1 << 24)
        };
        let mut boxes: Vec<Bounds> = Vec::new();
        for k in 0..300 {
            let min = DVec3::new(number(), number(), number());
            let max = min + 0.1 * DVec3::new(number(), number(), number());
            boxes.push(match k % 50 {
                7 => Bounds { min, max: DVec3::new(f64::INFINITY, max.y, max.z) },
                9 => Bounds::EMPTY,
                _ => Bounds { min, max },
            });
        }
        let tree = Boxes::new(boxes.clone());
        let mut found = Vec::new();
        for wanted in &boxes {
            tree.touching(wanted, &mut found);
            let each =
                (0..300_u32).filter(|k| boxes[*k as usize].touches(wanted) && boxes[*k as usize] != Bounds::EMPTY);
            assert!(found.iter().copied().eq(each), "{wanted:?}");
        }
    }
}
