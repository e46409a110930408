//! Where points lie in a body of many faces, by climbing from face to face.
//!
//! The *gauge* of a convex body about a point `c` inside tells by which factor the body must grow from `c` to reach a point:
//! it is the largest of `nᵢ·(p − c) / (dᵢ − nᵢ·c)`, one number for each plane. These are the values of a linear function at
//! the vertices of the polar dual, whose edges are the pairs of neighbouring faces: along them it climbs to the largest
//! without a local one on the way (the simplex method), and the faces above any level are connected. So a point is placed by
//! looking at a few faces near the last one, however many there are, and the planes that it may lie on or beyond are found
//! as those connected to the largest. Numbers here are rounded, with a bound for the error; what they leave open signs decide.

use crate::ids::number32;
use std::ops::Range;

use planecut_kernel::{DVec3, HalfSpace};

use super::Corner;
use super::shape::Corners;
use crate::ids::{BodyFaceId, Id, holds};

/// Bodies of fewer faces are asked plane by plane.
const MANY: usize = 14;
const U: f64 = f64::EPSILON / 2.0;

/// The faces of a body, as the vertices of its polar dual.
#[derive(Debug, Clone)]
pub(crate) struct PolarDual {
    center: DVec3,
    /// `nᵢ / (dᵢ − nᵢ·c)` for each face.
    duals: Vec<DVec3>,
    /// Where the neighbours of each face begin.
    starts: Vec<u32>,
    neighbours: Vec<BodyFaceId>,
    /// The largest sum of a dual's magnitudes.
    reach: f64,
    /// For each octant around the center the face in its middle.
    seeds: [BodyFaceId; 8],
}

/// Where a point lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Place {
    /// Strictly inside of all planes; this face is the nearest.
    Inside(BodyFaceId),
    /// Strictly outside of the plane of this face.
    Outside(BodyFaceId),
    /// On the surface or close to it; this face is the nearest, or one of them.
    Near(BodyFaceId),
    /// The numbers tell nothing.
    Unknown,
}

impl PolarDual {
    /// That of a body of many faces which is not too thin for its numbers; of each face the half-space, and which of the edges of the
    /// body it has.
    pub(super) fn new<'a, H: ExactSizeIterator<Item = &'a HalfSpace>>(
        half_spaces: impl Fn() -> H,
        edges: impl Iterator<Item = Range<u32>>,
        corners: &Corners,
    ) -> Option<Self> {
        if half_spaces().len() < MANY {
            return None;
        }
        let center = corners.middle();
        let duals: Vec<DVec3> = half_spaces()
            .map(|half_space| half_space.normal() / (half_space.offset() - half_space.normal().dot(center)))
            .collect();
        let is_inside = |(half_space, dual): (&HalfSpace, &DVec3)| {
            let (normal, offset) = (half_space.normal(), half_space.offset());
            let room = 16.0 * U * ((normal * center).abs().element_sum() + offset.abs());
            offset - normal.dot(center) > room && dual.is_finite()
        };
        if !half_spaces().zip(&duals).all(is_inside) {
            return None;
        }
        let mut dual = Self {
            center,
            reach: duals.iter().map(|dual| dual.abs().element_sum()).fold(0.0, f64::max),
            duals,
            starts: vec![0],
            neighbours: Vec::with_capacity(corners.edges.len()),
            seeds: [BodyFaceId::from_index(0); 8],
        };
        let planes = corners.planes.iter().chain(&corners.edges).map(|plane| plane.0 + 1).max().unwrap_or(0);
        let mut face_of: Vec<Option<BodyFaceId>> = vec![None; planes];
        for (plane, face) in corners.planes.iter().zip(BodyFaceId::all(corners.planes.len())) {
            face_of[plane.0] = Some(face);
        }
        for edges in edges {
            let edges = &corners.edges[edges.start as usize..edges.end as usize];
            // where one neighbour is missing, a climb may end below the largest value, and a point beyond pass for one inside
            debug_assert!(
                edges.iter().all(|plane| face_of[plane.0].is_some()),
                "an edge without a face on its other side"
            );
            dual.neighbours.extend(edges.iter().filter_map(|plane| face_of[plane.0]));
            dual.starts.push(number32(dual.neighbours.len()));
        }
        for octant in 0..8_usize {
            let sign = |axis: usize| if octant >> axis & 1 == 1 { -1.0 } else { 1.0 };
            let before = dual.seeds[octant.saturating_sub(1)];
            dual.seeds[octant] = dual.climb(DVec3::new(sign(0), sign(1), sign(2)), before, 0.0).0;
        }
        Some(dual)
    }

    /// A face from which the climb to a point is short.
    pub(crate) fn seed(&self, point: &Corner) -> BodyFaceId {
        let from_center = point.at - self.center;
        self.seeds[from_center.is_negative_bitmask() as usize]
    }

    /// Where a point lies, climbing from a face.
    pub(crate) fn place(&self, point: &Corner, from: BodyFaceId) -> Place {
        let (at, room) = self.relative(point);
        let (face, value) = self.climb(at, from, room);
        let room = room * value.max(1.0);
        if room >= 0.25 || value.is_nan() {
            Place::Unknown
        } else if value > 1.0 + room {
            Place::Outside(face)
        } else if value < 1.0 - room {
            Place::Inside(face)
        } else {
            Place::Near(face)
        }
    }

    /// Whether a point surely lies strictly outside of the plane of a face.
    pub(crate) fn is_beyond(&self, point: &Corner, face: BodyFaceId) -> bool {
        let (at, room) = self.relative(point);
        let value = self.value(face, at);
        value > 1.0 + room * value.max(1.0)
    }

    /// The faces on or beyond whose planes a point may lie, `face` being the one where its value is largest.
    pub(crate) fn near(&self, point: &Corner, face: BodyFaceId, found: &mut Vec<BodyFaceId>) {
        let (at, room) = self.relative(point);
        let level = 1.0 - 4.0 * room;
        self.above(at, face, level, found);
    }

    /// A point seen from the center, and a bound for the error of its values, relative to the larger of 1 and the value.
    ///
    /// With `g` the dual, rounded, of `p − c`: `p` is off by its own error, the difference by a rounding of both. A dual is off by
    /// at most `U (10 |g| |c| + 8)` of itself, as `|d| ≤ (d − n·c) + |n| |c|`.
    fn relative(&self, point: &Corner) -> (DVec3, f64) {
        let size = point.at.abs().max_element() + self.center.abs().max_element();
        let room = self.reach * (point.error + 24.0 * U * size) + 32.0 * U;
        (point.at - self.center, 2.0 * room)
    }

    fn value(&self, face: BodyFaceId, at: DVec3) -> f64 {
        self.duals[face.index()].dot(at)
    }

    fn neighbours(&self, face: BodyFaceId) -> &[BodyFaceId] {
        &self.neighbours[self.starts[face.index()] as usize..self.starts[face.index() + 1] as usize]
    }

    /// The face with the largest value, and this.
    fn climb(&self, at: DVec3, from: BodyFaceId, room: f64) -> (BodyFaceId, f64) {
        let (mut best, mut value) = (from, self.value(from, at));
        loop {
            let (start, mut second) = (best, f64::NEG_INFINITY);
            for &next in self.neighbours(start) {
                let other = self.value(next, at);
                if other > value {
                    second = value;
                    (best, value) = (next, other);
                } else {
                    second = second.max(other);
                }
            }
            if best != start {
                continue;
            }
            // a neighbour that is as good within the error may lead on
            let level = value - 2.0 * room * value.abs().max(1.0);
            if second < level {
                return (best, value);
            }
            let mut level_faces = Vec::new();
            self.above(at, best, level, &mut level_faces);
            for face in level_faces {
                let other = self.value(face, at);
                if other > value {
                    (best, value) = (face, other);
                }
            }
            if best == start {
                return (best, value);
            }
        }
    }

    /// The faces with values above a level that are connected to one.
    fn above(&self, at: DVec3, face: BodyFaceId, level: f64, found: &mut Vec<BodyFaceId>) {
        found.clear();
        found.push(face);
        let mut next = 0;
        while next < found.len() {
            for &other in self.neighbours(found[next]) {
                if self.value(other, at) >= level && !holds(found, other) {
                    found.push(other);
                }
            }
            next += 1;
        }
    }
}
