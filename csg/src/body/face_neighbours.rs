//! The neighbours of each face of a body in single precision, four at a time: which of them a point may be far beyond.
//!
//! A climb from face to face looks at all neighbours of each face on its way, for a few numbers that hardly ever decide anything closely. In
//! single precision these take two thirds of the memory, and four are multiplied at once; what is so close that the rounding might matter is left to plain numbers.

use std::ops::Range;

use planecut_kernel::DVec3;
use rustc_hash::FxHashMap;
use wide::f32x4;

use crate::base::Bounds;
use crate::ids::{BodyFaceId, Id, number32};

/// Half of the distance between 1 and the next number in single precision.
const U: f64 = (f32::EPSILON / 2.0) as f64;

/// Number of neighbours whose values are made at once.
const LANES: usize = 4;

/// The last bits of a value, in place of which there may be the number of its lane.
const LANE_BITS: u32 = 0b11;

/// Number of fours in a short run.
const RUN: usize = 4;

/// Faces of fewer fours of neighbours have no runs.
const LEAST_RUNS: usize = 3 * RUN;

/// Values farther away are not made in single precision, which would overflow.
const FAR: f64 = 1e30;

/// For the vertices of a polar dual those at the other ends of their edges.
#[derive(Debug, Clone)]
pub(super) struct FaceNeighbours {
    /// Where the fours of each face begin, and where the last ones end.
    starts: Vec<u32>,
    fours: Vec<Four>,
    /// For each face of many neighbours boxes around the duals of these, by its place.
    runs: FxHashMap<BodyFaceId, Runs>,
    /// The largest sum of a dual's magnitudes.
    pub(super) reach: f64,
}

/// Four neighbours of a face; where there are fewer, the last one comes again.
#[derive(Debug, Clone, Copy)]
struct Four {
    /// By coordinate the duals, divided by the reach.
    duals: [f32x4; 3],
    faces: [BodyFaceId; LANES],
}

/// A point as neighbours see it.
pub(super) struct SeenPoint {
    /// From where the duals are seen.
    pub(super) at: DVec3,
    /// Each coordinate times the reach, in all lanes.
    single: [f32x4; 3],
    /// By how much a value may be off in single precision; infinite where such values tell nothing.
    pub(super) slack: f64,
}

impl Four {
    fn of(faces: &[BodyFaceId], duals: &[DVec3], reach: f64) -> Self {
        let faces = std::array::from_fn(|lane| faces[lane.min(faces.len() - 1)]);
        let coordinate = |axis: usize| faces.map(|face: BodyFaceId| single(duals[face.index()][axis] / reach));
        Self { duals: [0, 1, 2].map(|axis| f32x4::from(coordinate(axis))), faces }
    }

    #[inline]
    fn values(&self, [x, y, z]: [f32x4; 3]) -> f32x4 {
        let [a, b, c] = self.duals;
        a * x + b * y + c * z
    }

    /// The largest value, whose last bits are those of the lane that has it: no branch tells which it is.
    #[inline]
    fn largest(&self, point: [f32x4; 3]) -> f32 {
        let numbers = f32x4::from([0, 1, 2, 3].map(f32::from_bits));
        let other_bits = f32x4::splat(f32::from_bits(!LANE_BITS));
        let [a, b, c, d] = (self.values(point) & other_bits | numbers).to_array();
        larger(larger(a, b), larger(c, d))
    }
}

#[expect(clippy::cast_possible_truncation, reason = "rounding is what it is for, and there is room for it")]
fn single(value: f64) -> f32 {
    value as f32
}

fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

impl FaceNeighbours {
    /// Those of some faces, whose duals and the largest sum of whose magnitudes are given.
    pub(super) fn of<N: Iterator<Item = BodyFaceId>>(
        duals: &[DVec3],
        reach: f64,
        neighbours: impl Iterator<Item = N>,
    ) -> Self {
        let mut all = Self { starts: vec![0], fours: Vec::new(), runs: FxHashMap::default(), reach };
        let mut faces: Vec<BodyFaceId> = Vec::new();
        for (face, neighbours) in BodyFaceId::all(duals.len()).zip(neighbours) {
            faces.clear();
            faces.extend(neighbours);
            all.fours.extend(faces.chunks(LANES).map(|some| Four::of(some, duals, reach)));
            all.starts.push(number32(all.fours.len()));
            if faces.len().div_ceil(LANES) >= LEAST_RUNS {
                all.runs.insert(face, Runs::of(&faces, duals));
            }
        }
        all.fours.shrink_to_fit();
        all
    }

    /// A point as neighbours see it, given from where the duals are seen.
    pub(super) fn seen(&self, at: DVec3) -> SeenPoint {
        let scaled = at * self.reach;
        // no number where one of them is none
        let size = scaled.abs().element_sum();
        // Of the sum of the products' magnitudes, which is at most the size: a rounding of both factors, of the product, and of two sums, and the number of a lane.
        // What is too small for single precision is off by less than the least that is not.
        let slack = if size < FAR { 16.0 * U * size.max(f64::from(f32::MIN_POSITIVE)) } else { f64::INFINITY };
        SeenPoint { at, single: scaled.to_array().map(|coordinate| f32x4::splat(single(coordinate))), slack }
    }

    /// Calls `visit` with the neighbours of a face whose values may reach a level, and some others.
    #[inline]
    pub(super) fn for_each_reaching(
        &self,
        face: BodyFaceId,
        point: &SeenPoint,
        level: f64,
        mut visit: impl FnMut(BodyFaceId),
    ) {
        // below by more than the rounding of the level as well
        let bound = single(level - point.slack - 2.0 * U * level.abs());
        let tells_nothing = point.slack.is_infinite();
        self.for_each_four(face, point, level, |four| {
            let reaching = four.values(point.single).simd_ge(f32x4::splat(bound)).to_bitmask();
            let mut lanes = if tells_nothing { (1 << LANES) - 1 } else { reaching };
            while lanes != 0 {
                visit(four.faces[lanes.trailing_zeros() as usize]);
                lanes &= lanes - 1;
            }
        });
    }

    /// A face none of whose neighbours has a larger value, but for the rounding; and a number that no value of these exceeds by more than the slack.
    /// `value` is that of the face at the beginning.
    pub(super) fn climb(&self, point: &SeenPoint, from: BodyFaceId, value: f64) -> (BodyFaceId, f64) {
        let (mut best, mut value) = (from, single(value));
        if point.slack.is_infinite() {
            return (from, f64::INFINITY);
        }
        loop {
            let (mut largest, mut of) = (f32::NEG_INFINITY, &self.fours[0]);
            self.for_each_four(best, point, f64::from(value) - point.slack, |four| {
                let other = four.largest(point.single);
                (largest, of) = if other > largest { (other, four) } else { (largest, of) };
            });
            // values are larger in each step, of which there are no more than neighbours
            if largest > value {
                (best, value) = (of.faces[(largest.to_bits() & LANE_BITS) as usize], largest);
                continue;
            }
            // in runs, not all neighbours are looked at
            let around = if self.runs_of(best).is_none() { f64::from(largest) } else { f64::INFINITY };
            return (best, around);
        }
    }

    fn fours_of(&self, face: BodyFaceId) -> &[Four] {
        &self.fours[self.starts[face.index()] as usize..self.starts[face.index() + 1] as usize]
    }

    /// The runs of a face of many neighbours.
    fn runs_of(&self, face: BodyFaceId) -> Option<&Runs> {
        // most have few, and are not looked up
        if self.fours_of(face).len() < LEAST_RUNS { None } else { self.runs.get(&face) }
    }

    #[inline]
    fn for_each_four<'a>(&'a self, face: BodyFaceId, point: &SeenPoint, level: f64, visit: impl FnMut(&'a Four)) {
        let all = self.fours_of(face);
        match self.runs_of(face) {
            None => all.iter().for_each(visit),
            Some(runs) => {
                let some = runs.reaching(point.at, level);
                some.flat_map(|range| &all[range.start..range.end.min(all.len())]).for_each(visit);
            }
        }
    }
}

/// Boxes around the duals of the neighbours of one face, a run of them after another: a cap has as many neighbours as a body has sides, of which
/// few are near a point. Neighbours follow one another around the face, so that boxes are small.
#[derive(Debug, Clone, Default)]
struct Runs {
    /// Of [`RUN`] fours each.
    short: Vec<Bounds>,
    /// Of [`SHORT_RUNS`] short ones each.
    long: Vec<Bounds>,
}

/// Number of short runs in a long one.
const SHORT_RUNS: usize = 16;

impl Runs {
    fn of(neighbours: &[BodyFaceId], duals: &[DVec3]) -> Self {
        let bounds = |run: &[BodyFaceId]| {
            let at = run.iter().map(|face| duals[face.index()]);
            at.fold(Bounds::EMPTY, |bounds, at| bounds.union(&Bounds { min: at, max: at }))
        };
        let short: Vec<Bounds> = neighbours.chunks(LANES * RUN).map(bounds).collect();
        let around = |run: &[Bounds]| run.iter().fold(Bounds::EMPTY, |all, bounds| all.union(bounds));
        let long = short.chunks(SHORT_RUNS).map(around).collect();
        Self { short, long }
    }

    /// The ranges of fours in which values may reach a level.
    fn reaching(&self, at: DVec3, level: f64) -> impl Iterator<Item = Range<usize>> {
        // of a value that is rounded otherwise than the bound nothing depends: levels leave room for the error of both
        let reaches = move |bounds: &&Bounds| (bounds.min * at).max(bounds.max * at).element_sum() >= level;
        let long = self.long.iter().enumerate().filter(move |(_, bounds)| reaches(bounds));
        let short = long.flat_map(|(k, _)| (SHORT_RUNS * k..).zip(&self.short[SHORT_RUNS * k..]).take(SHORT_RUNS));
        short.filter(move |(_, bounds)| reaches(bounds)).map(|(k, _)| RUN * k..RUN * (k + 1))
    }
}

#[cfg(test)]
mod tests {
    use planecut_testkit::random::Rng;

    use super::*;

    /// The faces around one of some duals, beside which there is another one in their middle.
    fn around_one(mut duals: Vec<DVec3>) -> (FaceNeighbours, Vec<DVec3>) {
        let sides = duals.len();
        duals.push(duals.iter().sum::<DVec3>() / sides as f64);
        let reach = duals.iter().map(|dual| dual.abs().element_sum()).fold(0.0, f64::max);
        let last = BodyFaceId::from_index(sides);
        let neighbours = (0..=sides).map(|face| if face == sides { 0..sides } else { sides..sides + 1 });
        let all = FaceNeighbours::of(&duals, reach, neighbours.map(|faces| faces.map(BodyFaceId::from_index)));
        assert_eq!(all.starts[last.index() + 1] as usize, all.fours.len());
        (all, duals)
    }

    fn visited(all: &FaceNeighbours, face: BodyFaceId, point: &SeenPoint, level: f64) -> Vec<BodyFaceId> {
        let mut visited = Vec::new();
        all.for_each_reaching(face, point, level, |next| visited.push(next));
        visited
    }

    #[test]
    fn no_neighbour_that_reaches_a_level_is_left_out() {
        let mut rng = Rng::spread(32);
        let (mut reaching, mut left_out) = (0, 0);
        for round in 0..2_000 {
            // bodies of any size, and points as near and as far
            let mut power = |range: i32| 10.0_f64.powi(rng.below(2 * range as usize + 1) as i32 - range);
            let (size, distance) = if round % 2 == 0 { (1.0, 1.0) } else { (power(80), power(80)) };
            let mut vector = || rng.point(-1.0, 1.0);
            let (all, duals) = around_one((0..3 + round % 90).map(|_| vector() * size).collect());
            let middle = BodyFaceId::from_index(duals.len() - 1);
            let at = vector() * (distance / size);
            let point = all.seen(at);
            let mut values: Vec<f64> = duals.iter().map(|dual| dual.dot(at)).collect();
            values.pop();
            for level in [values[0], 0.0, 1.0, values[values.len() / 2] * (1.0 - 1e-15)] {
                let found = visited(&all, middle, &point, level);
                for (face, value) in BodyFaceId::all(values.len()).zip(&values) {
                    if *value >= level {
                        reaching += 1;
                        assert!(found.contains(&face), "round {round}: {duals:?} at {at:?}, level {level:?}: {face:?}");
                    } else if !found.contains(&face) {
                        left_out += 1;
                    }
                }
            }
            let (top, around) = all.climb(&point, middle, duals[middle.index()].dot(at));
            let of_neighbours = if top == middle { values.as_slice() } else { &[duals[middle.index()].dot(at)] };
            assert!(
                of_neighbours.iter().all(|value| *value <= around + point.slack),
                "round {round}: {duals:?} at {at:?}"
            );
            let largest = values.iter().copied().fold(duals[middle.index()].dot(at), f64::max);
            assert!(
                point.slack.is_infinite() || duals[top.index()].dot(at) >= largest - 4.0 * point.slack,
                "round {round}: {duals:?} at {at:?}: {top:?}"
            );
        }
        assert!(reaching > 10_000 && left_out > 10_000, "{reaching} reach the level, {left_out} are left out");
    }

    #[test]
    fn where_numbers_tell_nothing_all_neighbours_are_visited() {
        let (all, duals) = around_one(DVec3::AXES.to_vec());
        let middle = BodyFaceId::from_index(3);
        for at in [DVec3::splat(f64::NAN), DVec3::new(f64::NAN, 0.5, 2.0), DVec3::X * f64::INFINITY, DVec3::Y * 1e200] {
            let found = visited(&all, middle, &all.seen(at), 1.0);
            assert!((0..3).all(|face| found.contains(&BodyFaceId::from_index(face))), "{at:?}: {found:?}");
            assert_eq!(all.climb(&all.seen(at), middle, duals[3].dot(at)), (middle, f64::INFINITY));
        }
    }

    #[test]
    fn of_the_sides_around_a_cap_few_are_looked_at_and_none_is_missed() {
        let sides = 1000_u32;
        let side = |k: u32| {
            let (y, x) = (std::f64::consts::TAU * f64::from(k) / f64::from(sides)).sin_cos();
            DVec3::new(x, y, 0.0)
        };
        let (all, duals) = around_one((0..sides).map(side).collect());
        let cap = BodyFaceId::from_index(sides as usize);
        let mut looked_at = 0;
        for k in 0..200 {
            let (y, x) = (0.37 * f64::from(k)).sin_cos();
            let at = DVec3::new(x, y, 1.0) * (0.9 + 0.001 * f64::from(k));
            let level = 1.0 - 1e-9;
            let point = all.seen(at);
            all.for_each_four(cap, &point, level, |_| looked_at += LANES);
            let found = visited(&all, cap, &point, level);
            let reaches = |face: &BodyFaceId| duals[face.index()].dot(at) >= level;
            let each: Vec<BodyFaceId> = BodyFaceId::all(sides as usize).filter(reaches).collect();
            assert!(found.into_iter().filter(reaches).eq(each), "point {at}");
        }
        assert!(looked_at > 0 && looked_at < 200 * 100, "{looked_at} neighbours for 200 points");
    }
}
