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

use rustc_hash::FxHashMap;
use smallvec::SmallVec;

use super::Corner;
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
    /// Where the neighbours of each face begin.
    starts: Vec<u32>,
    neighbours: Vec<Neighbour>,
    /// For each face of many neighbours boxes around the duals of these, by its place.
    runs: FxHashMap<BodyFaceId, Runs>,
    /// The largest sum of a dual's magnitudes.
    reach: f64,
    /// For each octant around the center the face in its middle.
    seeds: [BodyFaceId; 8],
}

/// A face beside another, with its dual: those of one face are read in a row, over and over.
#[derive(Debug, Clone, Copy)]
struct Neighbour {
    dual: DVec3,
    face: BodyFaceId,
}

/// A bound for the error of the values of a point, relative to the larger of 1 and the value: for the reach of a dual, the error of the point, and the sum of the
/// largest coordinates of the point and the center.
///
/// With `g` the dual, rounded, of `p − c`: `p` is off by its own error, the difference by a rounding of both. A dual is off by
/// at most `U (10 |g| |c| + 8)` of itself, as `|d| ≤ (d − n·c) + |n| |c|`.
fn room(reach: f64, error: f64, size: f64) -> f64 {
    2.0 * (reach * (error + 24.0 * U * size) + 32.0 * U)
}

/// Boxes around the duals of the neighbours of one face, a run of them after another: a cap has as many neighbours as a body has sides, of which
/// few are near a point. Neighbours follow one another around the face, so that boxes are small.
#[derive(Debug, Clone, Default)]
struct Runs {
    /// Of [`RUN`] neighbours each.
    short: Vec<Bounds>,
    /// Of as many short ones each.
    long: Vec<Bounds>,
}

/// Number of neighbours in a short run.
const RUN: usize = 16;

/// Faces of fewer neighbours have no runs.
const LEAST_RUNS: usize = 3 * RUN;

impl Runs {
    fn of(neighbours: &[Neighbour]) -> Self {
        let bounds = |run: &[Neighbour]| {
            let at = run.iter().map(|next| next.dual);
            at.fold(Bounds::EMPTY, |bounds, at| bounds.union(&Bounds { min: at, max: at }))
        };
        let short: Vec<Bounds> = neighbours.chunks(RUN).map(bounds).collect();
        let around = |run: &[Bounds]| run.iter().fold(Bounds::EMPTY, |all, bounds| all.union(bounds));
        let long = short.chunks(RUN).map(around).collect();
        Self { short, long }
    }

    /// The ranges of neighbours whose values may reach a level.
    fn reaching(&self, at: DVec3, level: f64) -> impl Iterator<Item = Range<usize>> {
        // of a value that is rounded otherwise than the bound nothing depends: levels leave room for the error of both
        let reaches = move |bounds: &&Bounds| (bounds.min * at).max(bounds.max * at).element_sum() >= level;
        let long = self.long.iter().enumerate().filter(move |(_, bounds)| reaches(bounds));
        let short = long.flat_map(|(k, _)| (RUN * k..).zip(&self.short[RUN * k..]).take(RUN));
        short.filter(move |(_, bounds)| reaches(bounds)).map(|(k, _)| RUN * k..RUN * (k + 1))
    }
}

/// Where a point lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Place {
    /// Strictly inside of all planes but one that it is known to lie on; this face is the nearest.
    Inside(BodyFaceId),
    /// Strictly outside of the plane of this face.
    Outside(BodyFaceId),
    /// On the surface or close to it; this face is the nearest, or one of them.
    Near(BodyFaceId),
    /// The numbers tell nothing.
    Unknown,
}

impl Place {
    /// What the largest value of a point tells, with the error of a value of 1: the face that has it, and the one that is nearest where the point is inside.
    fn of(value: f64, room: f64, [farthest, nearest]: [BodyFaceId; 2]) -> Self {
        let room = room * value.max(1.0);
        if room >= USELESS || value.is_nan() {
            Self::Unknown
        } else if value > 1.0 + room {
            Self::Outside(farthest)
        } else if value < 1.0 - room {
            Self::Inside(nearest)
        } else {
            Self::Near(nearest)
        }
    }
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
        let mut dual = Self {
            center,
            reach,
            duals,
            runs: FxHashMap::default(),
            starts: vec![0],
            neighbours: Vec::with_capacity(structure.edges.len()),
            seeds: [BodyFaceId::from_index(0); 8],
        };
        let planes = structure.planes.iter().chain(&structure.edges).map(|plane| plane.0 + 1).max().unwrap_or(0);
        let mut face_of: Vec<Option<BodyFaceId>> = vec![None; planes];
        for (plane, face) in structure.planes.iter().zip(BodyFaceId::all(structure.planes.len())) {
            face_of[plane.0] = Some(face);
        }
        for edges in edges {
            let edges = &structure.edges[edges.start as usize..edges.end as usize];
            // where one neighbour is missing, a climb may end below the largest value, and a point beyond pass for one inside
            debug_assert!(
                edges.iter().all(|plane| face_of[plane.0].is_some()),
                "an edge without a face on its other side"
            );
            let faces = edges.iter().filter_map(|plane| face_of[plane.0]);
            dual.neighbours.extend(faces.map(|face| Neighbour { dual: dual.duals[face.index()], face }));
            dual.starts.push(number32(dual.neighbours.len()));
        }
        let large = BodyFaceId::all(dual.duals.len()).filter(|face| dual.neighbours(*face).len() >= LEAST_RUNS);
        dual.runs = large.map(|face| (face, Runs::of(dual.neighbours(face)))).collect();
        for octant in 0..8_usize {
            let sign = |axis: usize| if octant >> axis & 1 == 1 { -1.0 } else { 1.0 };
            let before = dual.seeds[octant.saturating_sub(1)];
            dual.seeds[octant] = dual.climb(DVec3::new(sign(0), sign(1), sign(2)), before, 0.0).0;
        }
        Some(dual)
    }

    /// A face from which the climb to a point is short.
    pub(crate) fn seed(&self, point: &Corner) -> BodyFaceId {
        self.face_toward(point.at - self.center)
    }

    /// The face in the middle of the octant of a direction.
    pub(super) fn face_toward(&self, direction: DVec3) -> BodyFaceId {
        self.seeds[direction.is_negative_bitmask() as usize]
    }

    /// Where a point lies, climbing from a face.
    pub(crate) fn place(&self, point: &Corner, from: BodyFaceId) -> Place {
        let (at, room) = self.relative(point);
        if room >= USELESS {
            return Place::Unknown;
        }
        let (face, value) = self.climb(at, from, room);
        Place::of(value, room, [face, face])
    }

    /// Where a point lies that is on the plane of a face: within the face unless beyond a neighbour, and so within the body.
    pub(crate) fn place_on(&self, point: &Corner, face: BodyFaceId) -> Place {
        let (at, room) = self.relative(point);
        let (mut farthest, mut value) = (face, f64::NEG_INFINITY);
        self.for_each_neighbour(face, at, 1.0 - 2.0 * room, |next, other| {
            if other > value {
                (farthest, value) = (next, other);
            }
        });
        Place::of(value, room, [farthest, face])
    }

    /// Whether a point surely lies strictly outside of the plane of a face.
    pub(crate) fn is_beyond(&self, point: &Corner, face: BodyFaceId) -> bool {
        let (at, room) = self.relative(point);
        let value = self.value(face, at);
        value > 1.0 + room * value.max(1.0)
    }

    /// The faces on or beyond whose planes a point may lie, `face` being the one where its value is largest.
    pub(crate) fn near(&self, point: &Corner, face: BodyFaceId, found: &mut SomeFaces) {
        let (at, room) = self.relative(point);
        let level = 1.0 - 4.0 * room;
        found.clear();
        found.push(face);
        self.spread(at, level, found);
    }

    /// A point seen from the center, and a [bound](room) for the error of its values.
    fn relative(&self, point: &Corner) -> (DVec3, f64) {
        let size = point.at.abs().max_element() + self.center.abs().max_element();
        (point.at - self.center, room(self.reach, point.error, size))
    }

    fn value(&self, face: BodyFaceId, at: DVec3) -> f64 {
        self.duals[face.index()].dot(at)
    }

    fn neighbours(&self, face: BodyFaceId) -> &[Neighbour] {
        &self.neighbours[self.starts[face.index()] as usize..self.starts[face.index() + 1] as usize]
    }

    /// Calls `visit` with the neighbours of a face and their values; some with values below a level are left out.
    #[inline]
    fn for_each_neighbour(&self, face: BodyFaceId, at: DVec3, level: f64, mut visit: impl FnMut(BodyFaceId, f64)) {
        let all = self.neighbours(face);
        let mut visit_all = |some: &[Neighbour]| some.iter().for_each(|next| visit(next.face, next.dual.dot(at)));
        match if all.len() < LEAST_RUNS { None } else { self.runs.get(&face) } {
            None => visit_all(all),
            Some(runs) => {
                runs.reaching(at, level).for_each(|range| visit_all(&all[range.start..range.end.min(all.len())]));
            }
        }
    }

    /// The face with the largest value, and this; where a point is surely outside, one from which no neighbour leads on may do.
    fn climb(&self, at: DVec3, from: BodyFaceId, room: f64) -> (BodyFaceId, f64) {
        let (mut best, mut value) = (from, self.value(from, at));
        loop {
            let start = best;
            let level = value - 2.0 * room * value.abs().max(1.0);
            let mut is_alone = true;
            self.for_each_neighbour(start, at, level, |next, other| {
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
            self.spread(at, level, &mut level_faces);
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
    fn spread(&self, at: DVec3, level: f64, found: &mut SomeFaces) {
        let mut next = 0;
        while next < found.len() {
            self.for_each_neighbour(found[next], at, level, |other, value| {
                if value >= level && !holds(found, other) {
                    found.push(other);
                }
            });
            next += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::build_bodies;
    use crate::model::{Brush, MaterialId};

    #[test]
    fn of_the_sides_around_a_cap_few_are_looked_at_and_none_is_missed() {
        let sides = 1000_u32;
        let side = |k: u32| {
            let (y, x) = (std::f64::consts::TAU * f64::from(k) / f64::from(sides)).sin_cos();
            HalfSpace::new(DVec3::new(x, y, 0.0), 1.0).expect("a plane")
        };
        let caps = [1.0, -1.0].map(|z| HalfSpace::new(DVec3::Z * z, 1.0).expect("a plane"));
        let prism = Brush::from_half_spaces((0..sides).map(side).chain(caps), MaterialId(0));
        let built = build_bodies(std::slice::from_ref(&prism));
        let body = built.bodies.into_iter().next().and_then(|body| body.bounded()).expect("a prism");
        let dual = body.polar_dual(&built.table).expect("a dual");
        let cap = BodyFaceId::all(body.faces.len()).find(|face| dual.neighbours(*face).len() == 1000).expect("a cap");
        let mut visited = 0;
        for k in 0..200 {
            let (y, x) = (0.37 * f64::from(k)).sin_cos();
            let at = DVec3::new(x, y, 1.0) * (0.9 + 0.001 * f64::from(k));
            let level = 1.0 - 1e-9;
            let mut found = Vec::new();
            dual.for_each_neighbour(cap, at, level, |face, value| {
                visited += 1;
                if value >= level {
                    found.push(face);
                }
            });
            let each = dual.neighbours(cap).iter().map(|next| next.face);
            let each = each.filter(|face| dual.duals[face.index()].dot(at) >= level);
            assert!(each.eq(found), "point {at}");
        }
        assert!(visited > 0 && visited < 200 * 100, "{visited} neighbours for 200 points");
    }
}
