//! Corners of a region that touch the inside of one of its edges: there the edge is cut as well.

use planecut_kernel::DVec3;
use planecut_kernel::sign::Sign;

use super::cancel::Run;
use super::points::Points;
use crate::plane_table::PlaneTable;

/// The (line, point) pairs at which an end of a run lies inside another run of the same region, by line.
pub(super) fn find(table: &PlaneTable, points: &Points, runs: &[Run], regions: usize) -> Vec<(u32, u32)> {
    let mut by_region: Vec<Vec<u32>> = vec![Vec::new(); regions];
    for (k, run) in runs.iter().enumerate() {
        by_region[run.region as usize].push(k as u32);
    }
    let mut pinches = Vec::new();
    let mut corners: Vec<u32> = Vec::new();
    for members in by_region.iter().filter(|members| members.len() > 4) {
        corners.clear();
        corners.extend(members.iter().flat_map(|k| [runs[*k as usize].from, runs[*k as usize].to]));
        corners.sort_unstable();
        corners.dedup();
        let sorted: [Vec<u32>; 3] = std::array::from_fn(|axis| {
            let mut sorted = corners.clone();
            sorted.sort_unstable_by(|p, q| {
                points.positions[*p as usize][axis].total_cmp(&points.positions[*q as usize][axis])
            });
            sorted
        });
        for &k in members {
            let run = &runs[k as usize];
            touching(table, points, run, &sorted, |point| pinches.push((run.line, point)));
        }
    }
    pinches.sort_unstable();
    pinches.dedup();
    pinches
}

/// Calls `found` for each corner strictly inside a run. Rounding is monotone, so the box of the rounded ends holds the
/// rounded corner; signs decide.
fn touching(table: &PlaneTable, points: &Points, run: &Run, sorted: &[Vec<u32>; 3], mut found: impl FnMut(u32)) {
    let (from, to) = (points.positions[run.from as usize], points.positions[run.to as usize]);
    let (min, max) = (from.min(to), from.max(to));
    let range = |axis: usize| {
        let value = |p: &u32| points.positions[*p as usize][axis];
        let start = sorted[axis].partition_point(|p| value(p) < min[axis]);
        let end = sorted[axis].partition_point(|p| value(p) <= max[axis]);
        &sorted[axis][start..end]
    };
    let ranges: [&[u32]; 3] = std::array::from_fn(range);
    let Some(fewest) = ranges.into_iter().min_by_key(|range| range.len()) else { return };
    let inside = |at: DVec3| at.cmpge(min).all() && at.cmple(max).all();
    for &point in fewest {
        if point != run.from
            && point != run.to
            && inside(points.positions[point as usize])
            && points.side(table, point, run.edge) == Sign::Zero
        {
            found(point);
        }
    }
}
