//! Corners moved outward.

use planecut_kernel::DVec3;

use super::corners::{Corners, LEAST};
use super::merge::Clusters;
use crate::tolerances::SHARP_CORNER;

/// Steps to the direction that is nearest to all normals at a corner.
const STEPS: u32 = 64;
/// A corner moves up to this many times the separation of vertices, however sharp it is, before it becomes several.
const SHORT: f64 = 4.0;

/// What becomes of corners that are too sharp to be moved outward by a little.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shape {
    /// Each becomes several.
    Rounded,
    /// They are moved far.
    Sharp,
    /// The cell becomes the box around it.
    Box,
}

impl Shape {
    pub(super) fn with_fewer_vertices(self) -> Self {
        match self {
            Self::Rounded => Self::Sharp,
            Self::Sharp | Self::Box => Self::Box,
        }
    }
}

/// Places whose hull reaches beyond each group of corners by `growth` in all directions in which the group is the farthest.
pub(super) fn grown(corners: &Corners, clusters: &Clusters, growth: f64, separation: f64, shape: Shape) -> Vec<DVec3> {
    let places = clusters.places(corners);
    if shape == Shape::Box {
        let all = corners.holding.iter();
        let low = all.clone().fold(DVec3::INFINITY, |low, point| low.min(*point));
        let high = all.fold(DVec3::NEG_INFINITY, |high, point| high.max(*point));
        return cube(low - growth, high + growth).collect();
    }
    if growth == 0.0 {
        return places.into_iter().map(usable).collect();
    }
    let mut grown = Vec::with_capacity(places.len());
    for (place, faces) in places.into_iter().zip(clusters.faces(corners)) {
        let normals: Vec<DVec3> = faces.iter().map(|face| corners.normals[*face]).collect();
        let (direction, least) = middle(&normals);
        let is_sharp = least < SHARP_CORNER && growth > SHORT * separation * least;
        if is_sharp && shape == Shape::Rounded {
            let growth = growth.max(separation);
            grown.extend(cube(place - growth, place + growth));
        } else {
            grown.push(place + direction * (growth / least.max(f64::EPSILON)));
        }
    }
    grown.into_iter().map(usable).collect()
}

/// The place without coordinates that are too near to zero for hulls.
fn usable(place: DVec3) -> DVec3 {
    place.map(|value| if value.abs() < LEAST { 0.0 } else { value })
}

/// The corners of a box.
fn cube(low: DVec3, high: DVec3) -> impl Iterator<Item = DVec3> {
    let ends = [low, high];
    (0..8_usize).map(move |k| DVec3::new(ends[k & 1].x, ends[k >> 1 & 1].y, ends[k >> 2].z))
}

/// A direction of unit length whose least product with some unit vectors is about the largest, and that product.
///
/// It is that of the centre of the smallest ball around them, to which a step at a time toward the farthest one leads (Bădoiu, Clarkson 2003).
fn middle(normals: &[DVec3]) -> (DVec3, f64) {
    let least = |direction: DVec3| normals.iter().map(|normal| normal.dot(direction)).fold(f64::INFINITY, f64::min);
    let mut center = normals.iter().copied().sum::<DVec3>() / normals.len().max(1) as f64;
    let mut best = (center.normalize_or(DVec3::Z), least(center.normalize_or(DVec3::Z)));
    for step in 1..=STEPS {
        let Some(farthest) = normals.iter().max_by(|a, b| a.distance(center).total_cmp(&b.distance(center))) else {
            break;
        };
        center += (*farthest - center) / f64::from(step + 1);
        let direction = center.normalize_or(DVec3::Z);
        if least(direction) > best.1 {
            best = (direction, least(direction));
        }
    }
    // where three faces meet there is one direction of equal products, and steps come near to it too slowly if the corner is sharp
    if let [a, b, c] = normals {
        let across = a.cross(*b) + b.cross(*c) + c.cross(*a);
        let direction = (across * a.dot(b.cross(*c)).signum()).normalize_or(DVec3::Z);
        if least(direction) > best.1 {
            best = (direction, least(direction));
        }
    }
    best
}
