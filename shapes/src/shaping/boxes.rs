//! Boxes of which those that meet another, and the farthest in a direction, are found without looking at all.

use planecut_kernel::DVec3;

/// Least and greatest coordinates.
pub(super) type Bounds = [DVec3; 2];

/// Most boxes of a group that is not divided.
const GROUP: usize = 8;

/// A balanced tree of boxes.
pub(super) struct BoxTree {
    /// The boxes with their numbers, those of each group beside each other.
    items: Vec<(u32, Bounds)>,
    /// For each group the box around it: the root first, the halves of group `k` at `2k + 1` and `2k + 2`.
    groups: Vec<Bounds>,
}

impl BoxTree {
    /// A tree of boxes, which are numbered from 0.
    pub(super) fn new(boxes: impl Iterator<Item = Bounds>) -> Self {
        let mut items: Vec<(u32, Bounds)> = (0..).zip(boxes).collect();
        let mut groups = Vec::new();
        // what is still to be divided: the number of the group, and its boxes
        let mut open = vec![(0, 0..items.len())];
        while let Some((group, range)) = open.pop() {
            let bounds = around(&items[range.clone()]);
            if groups.len() <= group {
                groups.resize(group + 1, [DVec3::ZERO; 2]);
            }
            groups[group] = bounds;
            if range.len() > GROUP {
                let axis = (bounds[1] - bounds[0]).max_position();
                let middle = |(_, [min, max]): &(u32, Bounds)| min[axis] + max[axis];
                let half = range.len() / 2;
                items[range.clone()].select_nth_unstable_by(half, |a, b| middle(a).total_cmp(&middle(b)));
                open.extend(halves(group, &range));
            }
        }
        Self { items, groups }
    }

    /// The greatest `normal · x`: what all corners of boxes would give, to the last bit.
    pub(super) fn reach(&self, normal: DVec3) -> f64 {
        // each product and sum is rounded monotonically, so nothing within a box gives more than this corner of it
        let farthest = |[min, max]: Bounds| normal.dot(DVec3::select(normal.cmpgt(DVec3::ZERO), max, min));
        let mut greatest = f64::NEG_INFINITY;
        self.walk(|bounds, items| {
            if items.is_empty() {
                return farthest(bounds) > greatest;
            }
            greatest = items.iter().map(|(_, own)| farthest(*own)).fold(greatest, f64::max);
            false
        });
        greatest
    }

    /// The numbers of the boxes that share a point with one, in their order.
    pub(super) fn meeting(&self, [min, max]: Bounds) -> Vec<u32> {
        let meets = |own: &Bounds| own[0].cmple(max).all() && min.cmple(own[1]).all();
        let mut found = Vec::new();
        self.walk(|bounds, items| {
            found.extend(items.iter().filter(|(_, own)| meets(own)).map(|(number, _)| *number));
            meets(&bounds)
        });
        found.sort_unstable();
        found
    }

    /// Shows groups to `visit`, the boxes themselves of those that are not divided; of others, goes on where it is true.
    fn walk(&self, mut visit: impl FnMut(Bounds, &[(u32, Bounds)]) -> bool) {
        let mut open = vec![(0, 0..self.items.len())];
        while let Some((group, range)) = open.pop() {
            let is_divided = range.len() > GROUP;
            let items = if is_divided { &[] } else { &self.items[range.clone()] };
            if visit(self.groups[group], items) && is_divided {
                open.extend(halves(group, &range));
            }
        }
    }
}

/// The two halves of a group.
fn halves(group: usize, range: &std::ops::Range<usize>) -> [(usize, std::ops::Range<usize>); 2] {
    let middle = range.start + range.len() / 2;
    [(2 * group + 1, range.start..middle), (2 * group + 2, middle..range.end)]
}

/// The box around boxes.
fn around(items: &[(u32, Bounds)]) -> Bounds {
    let nowhere = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    items.iter().fold(nowhere, |[min, max], (_, own)| [min.min(own[0]), max.max(own[1])])
}

#[cfg(test)]
mod tests {
    use planecut_testkit::random::Rng;

    use super::*;

    fn random_box(rng: &mut Rng) -> Bounds {
        let low = rng.unit() * rng.float(0.5, 2.0);
        [low, low + DVec3::new(rng.float(0.0, 0.4), rng.float(0.0, 0.4), rng.float(0.0, 0.4))]
    }

    #[test]
    fn the_farthest_point_and_the_boxes_that_meet_are_those_of_a_look_at_all() {
        for seed in 0..200 {
            let mut rng = Rng::new(seed);
            let boxes: Vec<Bounds> = (0..rng.below(200)).map(|_| random_box(&mut rng)).collect();
            let tree = BoxTree::new(boxes.iter().copied());
            for _ in 0..20 {
                let (normal, [min, max]) = (rng.unit(), random_box(&mut rng));
                let corners = boxes
                    .iter()
                    .flat_map(|own| (0..8).map(|k| DVec3::new(own[k & 1].x, own[k >> 1 & 1].y, own[k >> 2].z)));
                let farthest = corners.map(|p| normal.dot(p)).fold(f64::NEG_INFINITY, f64::max);
                assert_eq!(tree.reach(normal), farthest, "seed {seed}");
                let apart = |own: &Bounds| (0..3).any(|axis| own[0][axis] > max[axis] || own[1][axis] < min[axis]);
                let meeting: Vec<u32> = (0..boxes.len() as u32).filter(|k| !apart(&boxes[*k as usize])).collect();
                assert_eq!(tree.meeting([min, max]), meeting, "seed {seed}");
            }
        }
    }
}
