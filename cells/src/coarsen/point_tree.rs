//! Which of many points lie outside of planes, without asking each plane for each point.

use planecut_csg::stages::Bounds;
use planecut_kernel::{DVec3, HalfSpace};

use super::part::{bounds_of, holds};

/// Points in a leaf.
const LEAF: usize = 16;
/// Room for the rounding of a box's farthest corner along a normal, relative to the terms: leaves are asked exactly.
const BOX_BOUND: f64 = 16.0 * f64::EPSILON;

/// Points in boxes of boxes, each halved across its longest side.
pub(super) struct PointTree {
    points: Vec<DVec3>,
    /// The box of each run of points, its halves in the places `2·k + 1` and `2·k + 2`.
    boxes: Vec<Bounds>,
}

impl PointTree {
    pub(super) fn new(mut points: Vec<DVec3>) -> Self {
        let mut boxes = vec![Bounds::EMPTY; 2 * points.len().div_ceil(LEAF).next_power_of_two() - 1];
        divide(&mut points, &mut boxes, 0);
        Self { points, boxes }
    }

    /// The points that some of the half-spaces do not hold, exactly; each once.
    pub(super) fn outside(&self, half_spaces: &[HalfSpace]) -> Vec<DVec3> {
        let mut is_outside = vec![false; self.points.len()];
        let mut waiting = Vec::new();
        for half_space in half_spaces {
            waiting.push((0, 0, self.points.len()));
            while let Some((place, from, to)) = waiting.pop() {
                if from == to || is_surely_within(half_space, &self.boxes[place]) {
                    continue;
                }
                if 2 * place + 1 < self.boxes.len() {
                    let middle = from + (to - from) / 2;
                    waiting.extend([(2 * place + 1, from, middle), (2 * place + 2, middle, to)]);
                    continue;
                }
                for (is_outside, point) in is_outside[from..to].iter_mut().zip(&self.points[from..to]) {
                    *is_outside = *is_outside || !holds(half_space, *point);
                }
            }
        }
        self.points.iter().zip(is_outside).filter(|(_, is_outside)| *is_outside).map(|(point, _)| *point).collect()
    }
}

fn divide(points: &mut [DVec3], boxes: &mut [Bounds], place: usize) {
    if place >= boxes.len() {
        return;
    }
    boxes[place] = bounds_of(points);
    if points.is_empty() {
        return;
    }
    let size = (boxes[place].max - boxes[place].min).to_array();
    let axis = (0..3).max_by(|a, b| size[*a].total_cmp(&size[*b])).unwrap_or(0);
    let middle = points.len() / 2;
    points.select_nth_unstable_by(middle, |a, b| a[axis].total_cmp(&b[axis]));
    let (low, high) = points.split_at_mut(middle);
    divide(low, boxes, 2 * place + 1);
    divide(high, boxes, 2 * place + 2);
}

fn is_surely_within(half_space: &HalfSpace, bounds: &Bounds) -> bool {
    let (normal, offset) = (half_space.normal(), half_space.offset());
    let farthest = normal.max(DVec3::ZERO).dot(bounds.max) + normal.min(DVec3::ZERO).dot(bounds.min);
    let reach = bounds.min.abs().max(bounds.max.abs());
    farthest - offset < -BOX_BOUND * (normal.abs().dot(reach) + offset.abs())
}

#[cfg(test)]
mod tests {
    use super::super::probes::spread;
    use super::*;

    #[test]
    fn the_points_outside_are_those_that_are_asked_one_by_one() {
        for count in [0, 1, 15, 16, 17, 500] {
            // some on a lattice, so that many lie just on a plane
            let rounded = |k: usize| if k.is_multiple_of(2) { spread(k) } else { (spread(k) * 4.0).round() / 4.0 };
            let points: Vec<DVec3> = (0..count).map(rounded).collect();
            let plane = |k: usize| {
                let normal = spread(3 * k + 1) * 2.0 - 1.0;
                HalfSpace::new(if k.is_multiple_of(3) { normal.round() } else { normal }, 0.5)
            };
            let planes: Vec<HalfSpace> = (0..6).filter_map(|k| plane(k).ok()).collect();
            let mut found = PointTree::new(points.clone()).outside(&planes);
            let mut expected: Vec<DVec3> =
                points.into_iter().filter(|point| planes.iter().any(|plane| !holds(plane, *point))).collect();
            let order = |a: &DVec3, b: &DVec3| a.to_array().partial_cmp(&b.to_array()).expect("numbers");
            found.sort_by(order);
            expected.sort_by(order);
            assert_eq!(found, expected, "{count}");
        }
    }
}
