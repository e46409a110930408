//! Points spread over the space that coarsening may fill: how many of them a body covers says how much it adds.
//!
//! Probes rank candidates, nothing more: what is reported was measured exactly.

use planecut_csg::stages::{Bounds, curve_number};
use planecut_kernel::{DVec3, HalfSpace};
use planecut_parallel::prelude::*;

use super::hull::Hull;
use super::part::{Part, bounds_of, boxes_of};

/// Probes in a word of a set.
const WORD: usize = 64;
/// Probes of a word that are held against planes at once: as many as registers hold.
const LANES: usize = 16;
/// Words in a block that is passed over as a whole.
const BLOCK: usize = 16;
/// Maximum number of points that are drawn for each probe that is wanted.
const DRAWN: usize = 24;
/// The root of `x⁴ = x + 1`: its powers give the additive sequence that fills three dimensions most evenly (Roberts 2018).
const ROOT: f64 = 1.220_744_084_605_759_5;

/// Points outside of all parts and within their hull, those that are near each other in a row.
#[derive(Debug, Clone, Default)]
pub(super) struct Probes {
    /// Coordinates from the origin below, a word of one axis after another: single precision does for ranking.
    coordinates: Vec<[[f32; WORD]; 3]>,
    origin: DVec3,
    words: Vec<Bounds>,
    blocks: Vec<Bounds>,
    /// The volume that a probe stands for.
    pub(super) unit: f64,
}

/// Points that fill the unit cube evenly, however many are taken.
pub(super) fn spread(number: usize) -> DVec3 {
    let step = DVec3::new(1.0 / ROOT, 1.0 / (ROOT * ROOT), 1.0 / (ROOT * ROOT * ROOT));
    (step * number as f64 + 0.5).fract()
}

/// Some of the probes: the words that are not empty, in order.
pub(super) type Coverage = Vec<(u32, u64)>;

impl Probes {
    /// About `wanted` probes around parts.
    pub(super) fn around(parts: &[Part], wanted: usize) -> Self {
        let points: Vec<DVec3> = parts.iter().flat_map(Part::all_points).collect();
        let hull = Hull::of(&points);
        let size = hull.bounds.max - hull.bounds.min;
        let boxes = boxes_of(parts);
        let solids: Vec<Vec<(DVec3, f64)>> = parts.par_iter().map(|part| unit_planes(&part.half_spaces)).collect();
        let drawn = DRAWN * wanted;
        let at = |k: usize| hull.bounds.min + spread(k) * size;
        let is_free = |point: &DVec3, near: &mut Vec<u32>| {
            if !is_inside(&hull.planes, *point) {
                return false;
            }
            boxes.touching(&Bounds { min: *point, max: *point }, near);
            !near.iter().any(|part| is_inside(&solids[*part as usize], *point))
        };
        // by rounds, so that the outcome does not depend on the number of threads
        let (mut free, mut count) = (Vec::new(), 0);
        while free.len() < wanted && count < drawn {
            let round = wanted.min(drawn - count);
            let found = (count..count + round).into_par_iter().map_init(Vec::new, |near, k| {
                let point = at(k);
                is_free(&point, near).then_some(point)
            });
            let found: Vec<Option<DVec3>> = found.collect();
            let lacking = wanted - free.len();
            let mut taken = 0;
            for point in found {
                if taken == lacking {
                    break;
                }
                count += 1;
                taken += usize::from(point.is_some());
                free.extend(point);
            }
        }
        let unit = size.element_product() / count.max(1) as f64;
        // from one to two, so that all steps of the curve are of one length
        free.sort_by_cached_key(|point| curve_number(DVec3::ONE + (*point - hull.bounds.min) / size.max_element()));
        Self::of_points(free, unit)
    }

    fn of_points(mut points: Vec<DVec3>, unit: f64) -> Self {
        points.truncate(points.len() / WORD * WORD);
        let origin = bounds_of(&points).center();
        let words: Vec<Bounds> = points.chunks(WORD).map(bounds_of).collect();
        let blocks =
            words.chunks(BLOCK).map(|words| words.iter().fold(Bounds::EMPTY, |all, one| all.union(one))).collect();
        let axis = |word: &[DVec3], axis: usize| std::array::from_fn(|k| (word[k] - origin)[axis] as f32);
        let coordinates = points.chunks(WORD).map(|word| std::array::from_fn(|k| axis(word, k))).collect();
        Self { coordinates, origin, words, blocks, unit }
    }

    /// How many words a set of all probes has.
    pub(super) fn words(&self) -> usize {
        self.words.len()
    }

    /// The probes within a convex body, given by unit normals and offsets, and its box.
    pub(super) fn within(&self, planes: &[(DVec3, f64)], bounds: &Bounds) -> Coverage {
        let sides: Vec<Side> = planes.iter().map(|plane| Side::new(plane, self.origin)).collect();
        let all: Vec<u32> = (0..sides.len() as u32).collect();
        let (mut covered, mut of_block, mut of_word) = (Coverage::new(), Vec::new(), Vec::new());
        for (block, block_bounds) in self.blocks.iter().enumerate() {
            if !block_bounds.touches(bounds) || !crossing(&sides, &all, block_bounds, &mut of_block) {
                continue;
            }
            let first = block * BLOCK;
            let last = (first + BLOCK).min(self.words.len());
            for word in first..last {
                let of_box = &self.words[word];
                if !of_box.touches(bounds) || !crossing(&sides, &of_block, of_box, &mut of_word) {
                    continue;
                }
                let bits = self.bits_within(word, &sides, &of_word);
                if bits != 0 {
                    covered.push((word as u32, bits));
                }
            }
        }
        covered
    }

    /// The probes of a word within some sides.
    fn bits_within(&self, word: usize, sides: &[Side], numbers: &[u32]) -> u64 {
        let [x, y, z] = self.coordinates[word].each_ref().map(|axis| axis.as_chunks::<LANES>().0);
        let mut bits = 0;
        for (lanes, ((x, y), z)) in x.iter().zip(y).zip(z).enumerate() {
            let mut farthest = [f32::NEG_INFINITY; LANES];
            for number in numbers {
                let [a, b, c, offset] = sides[*number as usize].single;
                for k in 0..LANES {
                    let distance = a * x[k] + b * y[k] + c * z[k] - offset;
                    // one instruction, where `max` also asks for NaN
                    farthest[k] = if distance > farthest[k] { distance } else { farthest[k] };
                }
            }
            let of_lanes = (0..LANES).fold(0_u64, |bits, k| bits | u64::from(farthest[k] <= 0.0) << k);
            bits |= of_lanes << (lanes * LANES);
        }
        bits
    }

    /// The volume that probes stand for.
    pub(super) fn volume(&self, count: u32) -> f64 {
        f64::from(count) * self.unit
    }
}

/// Adds probes to a set.
pub(super) fn add(set: &mut [u64], coverage: &Coverage) {
    coverage.iter().for_each(|(word, bits)| set[*word as usize] |= bits);
}

/// How many probes a set lacks.
pub(super) fn count_fresh(set: &[u64], coverage: &Coverage) -> u32 {
    coverage.iter().map(|(word, bits)| (bits & !set[*word as usize]).count_ones()).sum()
}

/// The probes that are in any of some sets, and those that are in more than one.
pub(super) fn once_and_twice<'a>(words: usize, sets: impl Iterator<Item = &'a Coverage>) -> (Vec<u64>, Vec<u64>) {
    let (mut once, mut twice) = (vec![0_u64; words], vec![0_u64; words]);
    for (word, bits) in sets.flatten() {
        let word = *word as usize;
        twice[word] |= once[word] & bits;
        once[word] |= bits;
    }
    (once, twice)
}

/// A plane of a convex body.
struct Side {
    normal: DVec3,
    /// The normal's coordinates without their signs.
    spread: DVec3,
    offset: f64,
    /// Normal, and offset from the probes' origin.
    single: [f32; 4],
}

impl Side {
    fn new((normal, offset): &(DVec3, f64), origin: DVec3) -> Self {
        let single = [normal.x, normal.y, normal.z, offset - normal.dot(origin)].map(|v| v as f32);
        Self { normal: *normal, spread: normal.abs(), offset: *offset, single }
    }
}

/// Those of some sides that cross a box; false where one of them has all of the box outside.
fn crossing(sides: &[Side], numbers: &[u32], bounds: &Bounds, found: &mut Vec<u32>) -> bool {
    found.clear();
    let (center, half) = (bounds.center(), 0.5 * (bounds.max - bounds.min));
    for number in numbers {
        let side = &sides[*number as usize];
        let (distance, reach) = (side.normal.dot(center) - side.offset, side.spread.dot(half));
        if distance > reach {
            return false;
        }
        if distance > -reach {
            found.push(*number);
        }
    }
    true
}

fn is_inside(planes: &[(DVec3, f64)], point: DVec3) -> bool {
    planes.iter().all(|(normal, offset)| normal.dot(point) <= *offset)
}

/// Unit normals and offsets of half-spaces.
pub(super) fn unit_planes(half_spaces: &[HalfSpace]) -> Vec<(DVec3, f64)> {
    let unit = |half_space: &HalfSpace| {
        let scale = half_space.normal().abs().max_element();
        let length = scale * (half_space.normal() / scale).length();
        (half_space.normal() / length, half_space.offset() / length)
    };
    half_spaces.iter().map(unit).collect()
}
