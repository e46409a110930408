//! Where points lie in a body of many faces, by climbing from face to face.
//!
//! The *gauge* of a convex body about a point `c` inside tells by which factor the body must grow from `c` to reach a point:
//! it is the largest of `nᵢ·(p − c) / (dᵢ − nᵢ·c)`, one number for each plane. These are the values of a linear function at
//! the vertices of the polar dual, whose edges are the pairs of neighbouring faces: along them it climbs to the largest
//! without a local one on the way (the simplex method), and the faces above any level are connected. So a point is placed by
//! looking at a few faces near the one in its direction, however many there are, and the planes that it may lie on or beyond are found
//! as those connected to the largest. Numbers here are rounded, with a bound for the error; what they leave open signs decide.

use std::ops::Range;

use planecut_kernel::{DVec3, HalfSpace};

use smallvec::SmallVec;

use super::Corner;
use super::directions::Directions;
use super::face_neighbours::{FaceNeighbours, SeenPoint};
use super::shape::Corners;
use crate::base::Bounds;
use crate::ids::{BodyFaceId, Id, holds};

/// Bodies of fewer faces are asked plane by plane.
const MANY: usize = 14;
const U: f64 = f64::EPSILON / 2.0;

/// From this error of a value of 1 on, values tell nothing.
const USELESS: f64 = 0.25;

/// Some faces of a body, mostly few.
pub(crate) type SomeFaces = SmallVec<[BodyFaceId; 16]>;

/// The faces of a body, as the vertices of its polar dual.
#[derive(Debug, Clone)]
pub(crate) struct PolarDual {
    center: DVec3,
    /// `nᵢ / (dᵢ − nᵢ·c)` for each face.
    duals: Vec<DVec3>,
    neighbours: FaceNeighbours,
    /// Faces from which climbs are short.
    directions: Directions,
}

/// A bound for the error of the values of a point, relative to the larger of 1 and the value: for the reach of a dual, the error of the point, and the sum of the
/// largest coordinates of the point and the center.
///
/// With `g` the dual, rounded, of `p − c`: `p` is off by its own error, the difference by a rounding of both. A dual is off by
/// at most `U (10 |g| |c| + 8)` of itself, as `|d| ≤ (d − n·c) + |n| |c|`.
fn room(reach: f64, error: f64, size: f64) -> f64 {
    2.0 * (reach * (error + 24.0 * U * size) + 32.0 * U)
}

/// Where a point lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Place {
    /// Strictly inside of all planes but one that it is known to lie on.
    Inside,
    /// Strictly outside of the plane of this face.
    Outside(BodyFaceId),
    /// On the surface or close to it; this face is the nearest, or one of them.
    Near(BodyFaceId),
    /// The numbers tell nothing.
    Unknown,
}

impl Place {
    /// What the largest value of a point tells, with the error of a value of 1: the face that has it, and the one that is nearest where the point is on the surface.
    fn of(value: f64, room: f64, [farthest, nearest]: [BodyFaceId; 2]) -> Self {
        let room = room * value.max(1.0);
        if room >= USELESS || value.is_nan() {
            Self::Unknown
        } else if value > 1.0 + room {
            Self::Outside(farthest)
        } else if value < 1.0 - room {
            Self::Inside
        } else {
            Self::Near(nearest)
        }
    }
}

impl PolarDual {
    /// That of a body of many faces which is not too thin for its numbers; of each face the half-space, and which of the edges of the
    /// body it has; of the body its corners and its box.
    pub(super) fn new<'a, H: ExactSizeIterator<Item = &'a HalfSpace>>(
        half_spaces: impl Fn() -> H,
        edges: impl Iterator<Item = Range<u32>>,
        corners: &Corners,
        bounds: &Bounds,
    ) -> Option<Self> {
        if half_spaces().len() < MANY {
            return None;
        }
        let (center, structure) = (corners.middle(), &*corners.structure);
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
        let reach = duals.iter().map(|dual| dual.abs().element_sum()).fold(0.0, f64::max);
        if room(reach, 0.0, center.abs().max_element()) >= USELESS {
            // that of a body that ends far away, where an outer box cuts it, is in the far distance
            return None;
        }
        let planes = structure.planes.iter().chain(&structure.edges).map(|plane| plane.0 + 1).max().unwrap_or(0);
        let mut face_of: Vec<Option<BodyFaceId>> = vec![None; planes];
        for (plane, face) in structure.planes.iter().zip(BodyFaceId::all(structure.planes.len())) {
            face_of[plane.0] = Some(face);
        }
        let neighbours = edges.map(|edges| {
            let edges = &structure.edges[edges.start as usize..edges.end as usize];
            // where one neighbour is missing, a climb may end below the largest value, and a point beyond pass for one inside
            debug_assert!(
                edges.iter().all(|plane| face_of[plane.0].is_some()),
                "an edge without a face on its other side"
            );
            edges.iter().filter_map(|plane| face_of[plane.0])
        });
        let neighbours = FaceNeighbours::of(&duals, reach, neighbours);
        let find = |direction: DVec3, last: BodyFaceId| {
            neighbours.climb(&neighbours.seen(direction), last, duals[last.index()].dot(direction)).0
        };
        let directions = Directions::new(duals.len(), bounds.max - bounds.min, find);
        Some(Self { center, duals, neighbours, directions })
    }

    /// A face in a direction from the center, or one near it.
    pub(super) fn face_toward(&self, direction: DVec3) -> BodyFaceId {
        self.directions.face(direction)
    }

    /// Where a point lies.
    pub(crate) fn place(&self, point: &Corner) -> Place {
        let (at, room) = self.relative(point);
        if room >= USELESS {
            return Place::Unknown;
        }
        let (face, value) = self.climb(at, self.face_toward(at), room);
        Place::of(value, room, [face, face])
    }

    /// Where a point lies that is on the plane of a face: within the face unless beyond a neighbour, and so within the body. It may also be on the plane of another
    /// face, beyond which it is not then.
    pub(crate) fn place_on(&self, point: &Corner, (face, other_face): (BodyFaceId, Option<BodyFaceId>)) -> Place {
        let (at, room) = self.relative(point);
        let (mut farthest, mut value) = (face, f64::NEG_INFINITY);
        self.for_each_neighbour(face, &self.neighbours.seen(at), 1.0 - 2.0 * room, |next, other| {
            if other > value && Some(next) != other_face {
                (farthest, value) = (next, other);
            }
        });
        Place::of(value, room, [farthest, face])
    }

    /// The faces on or beyond whose planes a point may lie, `face` being the one where its value is largest.
    pub(crate) fn near(&self, point: &Corner, face: BodyFaceId, found: &mut SomeFaces) {
        let (at, room) = self.relative(point);
        let level = 1.0 - 4.0 * room;
        found.clear();
        found.push(face);
        self.spread(&self.neighbours.seen(at), level, found);
    }

    /// A point seen from the center, and a [bound](room) for the error of its values.
    fn relative(&self, point: &Corner) -> (DVec3, f64) {
        let size = point.at.abs().max_element() + self.center.abs().max_element();
        (point.at - self.center, room(self.neighbours.reach, point.error, size))
    }

    fn value(&self, face: BodyFaceId, at: DVec3) -> f64 {
        self.duals[face.index()].dot(at)
    }

    /// Calls `visit` with the neighbours of a face and their values; some with values below a level are left out.
    #[inline]
    fn for_each_neighbour(
        &self,
        face: BodyFaceId,
        point: &SeenPoint,
        level: f64,
        mut visit: impl FnMut(BodyFaceId, f64),
    ) {
        self.neighbours.for_each_reaching(face, point, level, |next| visit(next, self.value(next, point.at)));
    }

    /// The face with the largest value, and this; where a point is surely outside, one from which no neighbour leads on may do.
    fn climb(&self, at: DVec3, from: BodyFaceId, room: f64) -> (BodyFaceId, f64) {
        let point = &self.neighbours.seen(at);
        let (mut best, around) = self.neighbours.climb(point, from, self.value(from, at));
        let mut value = self.value(best, at);
        let level_below = |value: f64| value - 2.0 * room * value.abs().max(1.0);
        // mostly no neighbour comes near
        if around + point.slack < level_below(value) {
            return (best, value);
        }
        loop {
            let start = best;
            let level = level_below(value);
            let mut is_alone = true;
            self.for_each_neighbour(start, point, level, |next, other| {
                if other > value {
                    (best, value) = (next, other);
                } else if other >= level {
                    is_alone = false;
                }
            });
            if best != start {
                continue;
            }
            if is_alone || value > 1.0 + room * value {
                return (best, value);
            }
            // a neighbour that is as good within the error may lead on
            let mut level_faces = SomeFaces::new();
            level_faces.push(start);
            self.spread(point, level, &mut level_faces);
            for &face in &level_faces {
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

    /// Adds the faces with values above a level that are connected to those found.
    fn spread(&self, point: &SeenPoint, level: f64, found: &mut SomeFaces) {
        let mut next = 0;
        while next < found.len() {
            self.for_each_neighbour(found[next], point, level, |other, value| {
                if value >= level && !holds(found, other) {
                    found.push(other);
                }
            });
            next += 1;
        }
    }
}
