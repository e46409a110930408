//! Which of many boxes touch a box.

use super::{Bounds, push_if, sort_few};
use crate::ids::number32;

/// Leaves hold at most this many boxes.
const LEAF: usize = 4;

/// Number of boxes from which two threads split them further.
const MANY: usize = 256;

/// The most nodes that wait while a tree is walked: one for each time that as many boxes as there are numbers can be halved, and the last one's sibling.
const WAITING: usize = 33;

#[derive(Debug, Clone, Copy)]
struct BoxNode {
    bounds: Bounds,
    start: u32,
    end: u32,
    /// Index of the second child (the first follows the node); 0 for a leaf.
    second: u32,
}

/// How many nodes there are for some boxes.
fn nodes_of(boxes: usize) -> usize {
    nodes_of_both(boxes)[0]
}

/// The same for a number of boxes and for one more: both are made of what there is for half of it, and for one more than that.
fn nodes_of_both(boxes: usize) -> [usize; 2] {
    let of_halves = if boxes < LEAF { [0; 2] } else { nodes_of_both(boxes / 2) };
    let of_half = |half: usize| of_halves[half - boxes / 2];
    [boxes, boxes + 1].map(|boxes| {
        if boxes <= LEAF { usize::from(boxes > 0) } else { 1 + of_half(boxes / 2) + of_half(boxes - boxes / 2) }
    })
}

/// Splits boxes until they are few; the node of the first half directly follows that of both. `start` and `number` are the places of the first box and node
/// among all.
fn split(boxes: &[Bounds], order: &mut [u32], nodes: &mut [BoxNode], [start, number]: [u32; 2]) {
    let Some((node, others)) = nodes.split_first_mut() else { return };
    let bounds = order.iter().fold(Bounds::EMPTY, |bounds, k| bounds.union(&boxes[*k as usize]));
    *node = BoxNode { bounds, start, end: start + number32(order.len()), second: 0 };
    if order.len() <= LEAF {
        return;
    }
    let axis = (bounds.max - bounds.min).max_position();
    let half = order.len() / 2;
    let key = |k: &u32| boxes[*k as usize].center()[axis];
    order.select_nth_unstable_by(half, |a, b| key(a).total_cmp(&key(b)).then(a.cmp(b)));
    let many = order.len() >= MANY;
    let (first, second) = order.split_at_mut(half);
    let (of_first, of_second) = others.split_at_mut(nodes_of(half));
    node.second = number + 1 + number32(of_first.len());
    let places = [[start, number + 1], [start + number32(half), node.second]];
    let mut split_first = || split(boxes, first, of_first, places[0]);
    let mut split_second = || split(boxes, second, of_second, places[1]);
    if many {
        planecut_parallel::join(split_first, split_second);
    } else {
        split_first();
        split_second();
    }
}

/// A hierarchy of boxes, split at the median of the longest axis. Infinite boxes are kept beside it.
#[derive(Debug, Clone, Default)]
pub struct Boxes {
    boxes: Vec<Bounds>,
    order: Vec<u32>,
    nodes: Vec<BoxNode>,
    infinite: Vec<u32>,
}

impl Boxes {
    /// Boxes are numbered in the order given; empty ones touch nothing.
    #[must_use]
    pub fn new(boxes: Vec<Bounds>) -> Self {
        let mut tree = Self { boxes, ..Self::default() };
        for (number, bounds) in (0..).zip(&tree.boxes) {
            if bounds.min.is_finite() && bounds.max.is_finite() {
                tree.order.push(number);
            } else if bounds.min.cmple(bounds.max).all() {
                tree.infinite.push(number);
            }
        }
        tree.nodes = vec![BoxNode { bounds: Bounds::EMPTY, start: 0, end: 0, second: 0 }; nodes_of(tree.order.len())];
        split(&tree.boxes, &mut tree.order, &mut tree.nodes, [0, 0]);
        tree
    }

    /// All boxes that are not empty, those that are near each other in a row.
    pub fn in_order(&self) -> impl Iterator<Item = u32> + '_ {
        self.order.iter().chain(&self.infinite).copied()
    }

    /// The box of a number.
    #[inline]
    #[must_use]
    pub fn get(&self, number: u32) -> &Bounds {
        &self.boxes[number as usize]
    }

    /// The boxes that touch a box, ascending.
    pub fn touching(&self, bounds: &Bounds, found: &mut Vec<u32>) {
        self.find(|other| other.touches(bounds), found);
    }

    /// The boxes that fulfil a condition which holds for a box wherever it holds for one within, ascending.
    pub fn find(&self, condition: impl Fn(&Bounds) -> bool, found: &mut Vec<u32>) {
        let fulfils = |number: &u32| condition(self.get(*number));
        found.clear();
        found.extend(self.infinite.iter().copied().filter(fulfils));
        // not a list: most searches are short, and would take longer to find memory for it
        let mut waiting = [0; WAITING];
        let mut count = usize::from(!self.nodes.is_empty());
        while count > 0 {
            count -= 1;
            let number = waiting[count];
            let node = &self.nodes[number as usize];
            if !condition(&node.bounds) {
                continue;
            }
            if node.second != 0 {
                waiting[count..count + 2].copy_from_slice(&[number + 1, node.second]);
                count += 2;
            } else {
                for number in &self.order[node.start as usize..node.end as usize] {
                    push_if(found, *number, fulfils(number));
                }
            }
        }
        sort_few(found, &|number: &u32| u64::from(*number));
    }

    /// The box with the smallest value, and that value; of equal ones the first. `least` is a lower bound of the values of all boxes within a box, nothing
    /// where there are none; `value` is the value of a box.
    pub fn nearest(
        &self,
        least: impl Fn(&Bounds) -> Option<f64>,
        mut value: impl FnMut(u32) -> Option<f64>,
    ) -> Option<(u32, f64)> {
        let mut best: Option<(u32, f64)> = None;
        let is_worse = |least: f64, best: Option<(u32, f64)>| best.is_some_and(|(_, value)| least > value);
        let mut look = |numbers: &[u32], best: &mut Option<(u32, f64)>| {
            for &number in numbers {
                if least(self.get(number)).is_none_or(|least| is_worse(least, *best)) {
                    continue;
                }
                if let Some(new) = value(number)
                    && best.is_none_or(|(other, old)| new < old || (new == old && number < other))
                {
                    *best = Some((number, new));
                }
            }
        };
        look(&self.infinite, &mut best);
        let bound = |number: u32| Some((least(&self.nodes.get(number as usize)?.bounds)?, number));
        let mut waiting: Vec<(f64, u32)> = bound(0).into_iter().collect();
        while let Some((least, number)) = waiting.pop() {
            if is_worse(least, best) {
                continue;
            }
            let node = &self.nodes[number as usize];
            if node.second == 0 {
                look(&self.order[node.start as usize..node.end as usize], &mut best);
                continue;
            }
            let first = waiting.len();
            waiting.extend([number + 1, node.second].into_iter().filter_map(bound));
            // the nearer one next
            waiting[first..].sort_unstable_by(|a, b| b.0.total_cmp(&a.0));
        }
        best
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
