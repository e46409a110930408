//! Steps on voxels, against the same by brute force.

use std::collections::BTreeSet;

use planecut_csg::stages::Bounds;
use planecut_kernel::DVec3;

use super::distance::near;
use super::flood::flooded;
use super::grid::{Grid, Voxels};
use super::octree::{Body, Octree};
use super::voxelize::touched;
use crate::coarsen::hull::sides_of;
use crate::coarsen::probes::spread;

/// Sizes on both sides of those of words.
const SIZES: [[usize; 3]; 4] = [[1, 1, 1], [64, 3, 4], [65, 7, 5], [130, 9, 11]];

fn places(size: [usize; 3]) -> impl Iterator<Item = [usize; 3]> {
    (0..size[2]).flat_map(move |z| (0..size[1]).flat_map(move |y| (0..size[0]).map(move |x| [x, y, z])))
}

/// About one voxel of a number.
fn scattered(size: [usize; 3], one_of: u64) -> Voxels {
    let mut voxels = Voxels::none(size);
    let mut state = 0x9e37_79b9_7f4a_7c15_u64 ^ one_of;
    for place in places(size) {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        if (state >> 33).is_multiple_of(one_of) {
            voxels.add(place);
        }
    }
    voxels
}

fn members(voxels: &Voxels) -> BTreeSet<[usize; 3]> {
    places(voxels.size).filter(|place| voxels.has(*place)).collect()
}

#[test]
fn what_is_near_is_so_by_each_pair() {
    for size in SIZES {
        for (one_of, most) in [(40, 1), (200, 9), (900, 30)] {
            let voxels = scattered(size, one_of);
            let all = members(&voxels);
            let square = |a: [usize; 3], b: [usize; 3]| (0..3).map(|k| a[k].abs_diff(b[k]).pow(2)).sum::<usize>();
            let expected: BTreeSet<[usize; 3]> =
                places(size).filter(|a| all.iter().any(|b| square(*a, *b) <= most as usize)).collect();
            assert_eq!(members(&near(&voxels, most)), expected, "{size:?} 1/{one_of} {most}");
        }
    }
}

#[test]
fn what_is_reached_is_so_step_by_step() {
    for size in SIZES {
        for one_of in [2, 3, 5] {
            let mut free = scattered(size, one_of);
            free.add([0; 3]);
            if one_of == 5 {
                free = free.complement();
                free.add([0; 3]);
            }
            let (all, mut expected, mut waiting) = (members(&free), BTreeSet::from([[0; 3]]), vec![[0_usize; 3]]);
            while let Some(place) = waiting.pop() {
                let steps = (0..27).map(|k: usize| [k % 3, k / 3 % 3, k / 9]);
                for step in steps {
                    let next: [usize; 3] = std::array::from_fn(|k| (place[k] + step[k]).wrapping_sub(1));
                    if all.contains(&next) && expected.insert(next) {
                        waiting.push(next);
                    }
                }
            }
            assert_eq!(members(&flooded(&free)), expected, "{size:?} 1/{one_of}");
        }
    }
}

#[test]
fn voxels_that_a_triangle_touches_hold_points_of_it() {
    let grid = Grid::around(&Bounds { min: DVec3::ZERO, max: DVec3::ONE }, 1.0 / 9.0, 1);
    let point = |k: usize| spread(3 * k + 1);
    for k in 0..60 {
        let triangle = if k == 0 { [point(0); 3] } else { [point(k), point(2 * k), point(5 * k)] };
        let found = members(&touched(&grid, &[triangle]));
        // points of the triangle are in voxels that were found
        for n in 0..4000 {
            let at = spread(n);
            let (a, b) = if at.x + at.y > 1.0 { (1.0 - at.x, 1.0 - at.y) } else { (at.x, at.y) };
            let p = triangle[0] + (triangle[1] - triangle[0]) * a + (triangle[2] - triangle[0]) * b;
            let place = ((p - grid.origin) / grid.step).to_array().map(|v| v as usize);
            assert!(found.contains(&place), "{k}: {p} in {place:?}");
        }
        // none is farther from the triangle than its diagonal
        for place in &found {
            let bounds = grid.bounds(*place, place.map(|k| k + 1));
            assert!(distance(bounds.center(), &triangle) <= 0.867 * grid.step, "{k}: {place:?}");
        }
    }
}

/// How far a point is from a triangle: the least distance to its plane, where it is above it, and to its edges.
fn distance(p: DVec3, [a, b, c]: &[DVec3; 3]) -> f64 {
    let to_edge = |from: DVec3, to: DVec3| {
        let (along, way) = (p - from, to - from);
        let t = (along.dot(way) / way.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        (along - way * t).length()
    };
    let edges = to_edge(*a, *b).min(to_edge(*b, *c)).min(to_edge(*c, *a));
    let normal = (*b - *a).cross(*c - *a);
    let is_above =
        [(*a, *b), (*b, *c), (*c, *a)].iter().all(|(from, to)| normal.dot((*to - *from).cross(p - *from)) >= 0.0);
    if is_above && normal.length() > 0.0 { edges.min((p - *a).dot(normal.normalize()).abs()) } else { edges }
}

#[test]
fn a_box_meets_voxels_where_it_has_one_in_it() {
    let size = [37, 20, 11];
    let grid = Grid { origin: DVec3::new(-1.0, 2.0, 0.5), step: 0.25, size };
    for one_of in [3, 60, 2000] {
        let voxels = if one_of == 3 { scattered(size, one_of).complement() } else { scattered(size, one_of) };
        let all = members(&voxels);
        let octree = Octree::new(grid.clone(), voxels);
        for k in 0..300 {
            let from = spread(2 * k).to_array();
            let from: [usize; 3] = std::array::from_fn(|axis| (from[axis] * size[axis] as f64) as usize);
            let to: [usize; 3] = std::array::from_fn(|axis| (from[axis] + 1 + (k + axis) % 5).min(size[axis]));
            let bounds = grid.bounds(from, to);
            let planes: Vec<(DVec3, f64)> = sides_of(&bounds).collect();
            let body = Body { planes: &planes, bounds: &bounds };
            let expected = all.iter().any(|place| (0..3).all(|axis| (from[axis]..to[axis]).contains(&place[axis])));
            let shares = |block: &Bounds| block.min.cmplt(bounds.max).all() && bounds.min.cmplt(block.max).all();
            assert_eq!(octree.meets(&body, &mut |block| shares(block)), expected, "{from:?} {to:?}");
        }
    }
}
