//! Where a box is best cut in two.

use planecut_kernel::DVec3;

use super::bounds;
use super::extremes::Extremes;
use super::inside::Inside;
use super::polygons::{Polygons, crossing};
use super::region::{Region, normal};
use crate::tolerances::{FACE_ACROSS, FACE_OFFSET, SAME_HEIGHT};

/// Places along each axis at which a cut is tried whatever is there.
const EVEN: usize = 7;
/// Faces across each axis beside which a cut is tried, those of the largest area.
const FACES: usize = 6;
/// Polygons that are looked at, at most: every second one of twice as many.
const LOOKED_AT: usize = 600;
/// A cut that saves less than this share of the volume is no better than one in the middle.
const LEAST_SAVED: f64 = 0.01;

/// A plane across an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct AxisCut {
    pub(super) axis: usize,
    pub(super) at: f64,
}

/// The cut in the middle of the longest side of what a box holds; none where that is too short.
pub(super) fn middle_cut(region: &Region) -> Option<AxisCut> {
    let (low, high) = bounds(region.points().into_iter());
    middle_of(low, high)
}

fn middle_of(low: DVec3, high: DVec3) -> Option<AxisCut> {
    let size = high - low;
    let axis = size.max_position();
    let is_long = size[axis] > 8.0 * FACE_OFFSET;
    is_long.then(|| AxisCut { axis, at: (low[axis] + high[axis]) / 2.0 })
}

/// The cut after which the hulls of both parts have the least volume, as far as the farthest points in some directions tell; in the middle of
/// the longest side where none is better.
pub(super) fn best_cut(region: &Region, inside: &impl Inside) -> Option<AxisCut> {
    let (low, high) = bounds(region.points().into_iter());
    let middle = middle_of(low, high)?;
    let size = high - low;
    let looked_at = sample(&region.polygons);
    let whole = Extremes::of(looked_at.corners().iter().copied().chain(region.inner_corners())).volume();
    let mut best = (whole * (1.0 - LEAST_SAVED), middle);
    for axis in 0..3 {
        if size[axis] <= 8.0 * FACE_OFFSET {
            continue;
        }
        let even = (1..=EVEN).map(|k| low[axis] + size[axis] * k as f64 / (EVEN + 1) as f64);
        for at in even.chain(beside_faces(&region.polygons, axis, inside.is_thin())) {
            if at - low[axis] < 2.0 * FACE_OFFSET || high[axis] - at < 2.0 * FACE_OFFSET {
                continue;
            }
            let cut = AxisCut { axis, at };
            let volume = volume_after(region, &looked_at, cut, inside, best.0);
            if volume < best.0 {
                best = (volume, cut);
            }
        }
    }
    Some(best.1)
}

/// The volume of the hulls of both parts, about; any number that is not less than the limit where it is not.
fn volume_after(region: &Region, polygons: &Polygons, cut: AxisCut, inside: &impl Inside, limit: f64) -> f64 {
    let AxisCut { axis, at } = cut;
    let mut sides = [Extremes::default(), Extremes::default()];
    for (corners, _) in polygons.iter() {
        let mut before = corners[corners.len() - 1];
        for &corner in corners {
            sides[usize::from(corner[axis] > at)].add(corner);
            if (before[axis] > at) != (corner[axis] > at) {
                let point = crossing(before, corner, axis, at);
                sides.iter_mut().for_each(|side| side.add(point));
            }
            before = corner;
        }
    }
    region.inner_corners().for_each(|corner| sides[usize::from(corner[axis] > at)].add(corner));
    for k in 0..4 {
        let mut corner = DVec3::ZERO;
        corner[axis] = at;
        for (bit, other) in [(axis + 1) % 3, (axis + 2) % 3].into_iter().enumerate() {
            corner[other] = if k >> bit & 1 == 1 { region.high[other] } else { region.low[other] };
        }
        if inside.holds(corner) {
            sides.iter_mut().for_each(|side| side.add(corner));
        }
    }
    let below = sides[0].volume();
    if below >= limit { below } else { below + sides[1].volume() }
}

/// Places just beside large faces across an axis, on the side where these have nothing: so a part ends with its face. Thin ones have nothing on both sides.
fn beside_faces(polygons: &Polygons, axis: usize, is_thin: bool) -> Vec<f64> {
    // height and area, by the side on which they have nothing
    let mut faces: [Vec<(f64, f64)>; 2] = [Vec::new(), Vec::new()];
    for (corners, _) in polygons.iter() {
        let normal = normal(corners);
        if normal[axis].abs() >= FACE_ACROSS * normal.length() && normal[axis] != 0.0 {
            let highest = corners.iter().map(|p| p[axis] * normal[axis].signum()).fold(f64::NEG_INFINITY, f64::max);
            faces[usize::from(normal[axis] < 0.0)].push((highest, normal[axis].abs()));
        }
    }
    let mut joined: Vec<(f64, f64)> = Vec::new();
    for (mut faces, sign) in faces.into_iter().zip([1.0, -1.0]) {
        faces.sort_by(|a, b| a.0.total_cmp(&b.0));
        // what rounding has moved a little is one face, cut beside its farthest part
        for near in faces.chunk_by(|a, b| b.0 - a.0 <= SAME_HEIGHT) {
            let farthest = near.last().map_or(0.0, |(height, _)| *height);
            let nearest = near.first().map_or(0.0, |(height, _)| *height);
            let area: f64 = near.iter().map(|(_, area)| area).sum();
            joined.push((sign * (farthest + FACE_OFFSET), area));
            if is_thin {
                joined.push((sign * (nearest - FACE_OFFSET), area));
            }
        }
    }
    joined.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.total_cmp(&b.0)));
    joined.into_iter().take(if is_thin { 2 * FACES } else { FACES }).map(|(at, _)| at).collect()
}

fn sample(polygons: &Polygons) -> Polygons {
    polygons.every(polygons.len().div_ceil(LOOKED_AT))
}
