//! Where the vertices of a small polytope are, for many planes one after the other that cut nothing.
//!
//! With a few vertices it takes less to look at all of them, several at once and without a branch, than to go from one to the
//! next: each step waits for the one before, and its direction cannot be foreseen. The vertex that is found to be farthest is
//! nearly always where a climb ends, but places are rounded; a climb from there decides. A bound on all that is rounded tells
//! whether it lies inside the plane, and with it all others.
//!
//! # The bound
//! Places are relative to an origin near the vertices, and at most `extent` away from it along each axis. With `u = 2⁻²⁴`, that of
//! single precision:
//! - The quotient `X / W` of a vertex is off by what [`Corner::place_errors`](crate::sign::Corner::place_errors) tell, which may be
//!   `u/4` of the extent, and by `2⁻⁵⁰` of the distance between the two origins, which may be `2²²` times the extent: `u/16` of
//!   it. The rest is the rounding to single precision: together less than `1.4·u·extent`.
//! - A height, the sum of three products with a rounded normal, passes four roundings a term: less than `4.2·u` of
//!   `|n|·extent`, where `|n|` is the sum of the magnitudes of the normal.
//! - The offset, from the origin of the places, is computed in double precision: off by less than `2⁻⁵⁰` of `|d|` and of `|n|` times
//!   the distance of the origins.
//!
//! [`HEIGHT_BOUND`] is more than the sum of the first two, 5.6·u, for each of the three numbers of the normal: there is room for
//! the few roundings in which the bound is used. [`OFFSET_BOUND`] covers the third and the rounding of the offset to single
//! precision. Underflow is off by `2⁻¹⁴⁹`: less than all this, with an extent of at least [`LEAST_EXTENT`].

use super::NONE;
use super::vertex::VertexRecord;
use crate::sign::Row;
use wide::f32x4;

/// The most vertices that are looked at.
const MOST: usize = 64;
/// The bits of a number that tell which of the vertices it is.
const NUMBER_BITS: u32 = MOST as u32 - 1;
const LANES: usize = 4;

/// A bound for the error of a height, in units of the largest magnitude in the normal times the extent.
const HEIGHT_BOUND: f64 = 24.0 / (1u64 << 24) as f64;
/// `2⁻²²`: a bound for the error of the offset, in units of the magnitudes of what it is computed from.
const OFFSET_BOUND: f64 = 4.0 / (1u64 << 24) as f64;
/// `2⁻¹⁵`: what the number of a vertex in the place of the last bits makes of a height, and more.
const NUMBER_BOUND: f32 = 1.0 / (1 << 15) as f32;
/// How far off a place may be before it is rounded to single precision, in units of the extent.
const PLACE_BOUND: f64 = 0.25 / (1u64 << 24) as f64;
/// How many times the extent the origin of the places may lie from that of the coordinates.
const FARTHEST_ORIGIN: f64 = (1u64 << 22) as f64;
/// Extents between these have products that neither overflow nor vanish in single precision.
const LEAST_EXTENT: f64 = 1e-18;
const LARGEST_EXTENT: f64 = 1e18;

/// The number of a vertex that is not there: with the zeros that stand for its place, the lowest height.
const NOBODY: u32 = 0xff7f_ffc0;

/// Some vertices side by side.
#[derive(Debug, Clone, Copy)]
#[repr(align(16))]
struct Block {
    /// The coordinates, one axis after the other.
    places: [[f32; LANES]; 3],
    /// The numbers of the vertices, as the bits of floating-point numbers.
    numbers: [f32; LANES],
}

impl Block {
    /// Without vertices.
    const EMPTY: Self = Self { places: [[0.0; LANES]; 3], numbers: [f32::from_bits(NOBODY); LANES] };
}

/// What the places tell of a plane.
#[derive(Debug, Clone, Copy)]
pub(in crate::polytope) struct Farthest {
    /// The vertex that seems to be farthest in the direction of the normal.
    pub(in crate::polytope) vertex: u32,
    /// Whether all others are less far for certain.
    pub(in crate::polytope) is_certain: bool,
    /// Whether all vertices lie inside the plane for certain.
    pub(in crate::polytope) is_inside: bool,
}

/// The places of all finite vertices, where they are few.
#[derive(Debug, Default)]
pub(super) struct Places {
    blocks: Vec<Block>,
    /// The slots of the vertices; none where nothing is known.
    slots: Vec<u32>,
    origin: [f64; 3],
    /// A bound for the error of a height, in units of the magnitude of the normal. Infinite where nothing is certain: where a vertex
    /// is ideal, or where they are so near to each other or so badly determined that there is none.
    bound: f32,
}

impl Places {
    /// Forgets all, because vertices came, went or moved.
    #[inline(always)]
    pub(super) fn forget(&mut self) {
        self.slots.clear();
    }

    /// Whether the places are known.
    #[inline(always)]
    pub(super) fn are_known(&self) -> bool {
        !self.slots.is_empty()
    }

    /// Finds the places of all vertices; of none where there are too many, or none is finite.
    #[inline(never)]
    pub(super) fn find(&mut self, records: &[VertexRecord]) {
        self.blocks.clear();
        self.slots.clear();
        if records.len() > MOST {
            return;
        }
        let mut known_origin = None;
        let (mut extent, mut errors, mut is_bounded) = (0.0, [0.0; 2], true);
        for (slot, record) in (0u32..).zip(records) {
            if record.planes[0] == NONE {
                continue;
            }
            if record.point.is_ideal() {
                is_bounded = false;
                continue;
            }
            let place = record.point.place();
            // what is small beside its distance from the origin of the coordinates has room in single precision, too
            let origin = *known_origin.get_or_insert(place);
            let number = self.slots.len();
            let lane = number % LANES;
            if lane == 0 {
                self.blocks.push(Block::EMPTY);
            }
            let block = self.blocks.last_mut().expect("there is one for each four slots");
            for axis in 0..3 {
                let from_origin: f64 = place[axis] - origin[axis];
                block.places[axis][lane] = from_origin as f32;
                extent = larger(from_origin.abs(), extent);
            }
            block.numbers[lane] = f32::from_bits(number as u32);
            let more = record.point.place_errors();
            errors = [larger(more[0], errors[0]), larger(more[1], errors[1])];
            self.slots.push(slot);
        }
        self.origin = known_origin.unwrap_or_default();
        // the true places are a little off
        extent *= 1.01;
        let distance = self.origin.into_iter().fold(0.0, |most, v: f64| larger(v.abs(), most)) + extent;
        let is_valid = is_bounded
            && (LEAST_EXTENT..LARGEST_EXTENT).contains(&extent)
            && distance < FARTHEST_ORIGIN * extent
            && errors[0] + distance * errors[1] < PLACE_BOUND * extent;
        self.bound = if is_valid { (HEIGHT_BOUND * extent) as f32 } else { f32::INFINITY };
    }

    /// The vertex that seems to be farthest in the direction of a plane, and what is known of it; `None` where the places are not
    /// known.
    #[inline(always)]
    pub(super) fn farthest(&self, plane: &Row) -> Option<Farthest> {
        let direction = plane.coefficients();
        let [x, y, z] = [0, 1, 2].map(|axis| f32x4::splat(direction[axis] as f32));
        let but_number = f32x4::splat(f32::from_bits(!NUMBER_BITS));
        let mut best = f32x4::splat(f32::MIN);
        let mut second = best;
        for Block { places, numbers } in &self.blocks {
            let [xs, ys, zs] = places.map(f32x4::new);
            let height = x * xs + y * ys + z * zs;
            // the number of the vertex travels in place of the last bits
            let height = height & but_number | f32x4::new(*numbers);
            second = second.fast_max(best.fast_min(height));
            best = best.fast_max(height);
        }
        let both = |[a, p]: [f32; 2], [b, q]: [f32; 2]| {
            let lower = if a > b { b } else { a };
            [larger(a, b), larger(lower, larger(p, q))]
        };
        let (best, second) = (best.to_array(), second.to_array());
        let of_lane = |k: usize| [best[k], second[k]];
        let [best, second] = both(both(of_lane(0), of_lane(1)), both(of_lane(2), of_lane(3)));
        let vertex = *self.slots.get((best.to_bits() & NUMBER_BITS) as usize)?;
        let [nx, ny, nz, d] = *direction;
        let [x, y, z] = self.origin;
        let offset = d - (nx * x + ny * y + nz * z);
        let inside = (offset - OFFSET_BOUND * (d.abs() + offset.abs())) as f32;
        let error = self.bound * plane.magnitude_f32();
        let is_inside = best + NUMBER_BOUND * best.abs() + error < inside;
        let is_certain = best - NUMBER_BOUND * (best.abs() + second.abs()) - 3.0 * error > second;
        Some(Farthest { vertex, is_certain, is_inside })
    }
}

#[inline(always)]
fn larger<T: PartialOrd>(a: T, b: T) -> T {
    if a > b { a } else { b }
}

#[cfg(test)]
mod tests {
    use crate::half_space::HalfSpace;
    use crate::polytope::IncrementalPolytope;
    use crate::sign::Row;
    use glam::DVec3;
    use planecut_oracle::random::Rng;

    /// A ball of some planes around `center`.
    fn ball(rng: &mut Rng, center: DVec3, radius: f64) -> IncrementalPolytope {
        let mut polytope = IncrementalPolytope::new();
        let walls = [1.0, -1.0].into_iter().flat_map(|side| DVec3::AXES.map(|axis| side * axis));
        let others: Vec<DVec3> = (0..rng.below(14)).map(|_| rng.unit()).collect();
        for normal in walls.chain(others) {
            polytope.add_plane(HalfSpace::new(normal, normal.dot(center) + radius).unwrap());
        }
        polytope
    }

    /// Planes that nearly touch polytopes of all sizes and places: what is called certain is true.
    #[test]
    fn what_is_certain_is_true() {
        let mut rng = Rng::new(31);
        let (mut inside, mut certain) = (0, 0);
        for round in 0..400 {
            let radius = 10f64.powf(rng.float(-6.0, 6.0));
            let shift = if round % 2 == 0 { 1.0 } else { 10f64.powf(rng.float(0.0, 7.0)) };
            let center = shift * radius * rng.unit();
            let mut polytope = ball(&mut rng, center, radius);
            polytope.vertices.find_places();
            for _ in 0..50 {
                let normal = rng.unit() * rng.float(1.0, 1.9);
                let direction = Row::new(&HalfSpace::new(normal, 0.0).unwrap());
                let top = polytope.climb(&direction, polytope.start(&direction));
                let height = normal.dot(DVec3::from_array(polytope.vertices.point(top).place()));
                let above = radius * 10f64.powf(rng.float(-9.0, 0.0)) * rng.pick(&[1.0, -1.0]);
                let slot = polytope.add_plane(HalfSpace::new(normal, height + above).unwrap()).plane();
                let plane = polytope.live(slot).unwrap();
                let was_cut = polytope.planes.has_face(plane);
                polytope.remove_plane(slot);
                polytope.vertices.find_places();
                let row = Row::new(&HalfSpace::new(normal, height + above).unwrap());
                let farthest = polytope.vertices.seemingly_farthest(&row).expect("there are few vertices");
                inside += usize::from(farthest.is_inside);
                assert!(!(farthest.is_inside && was_cut), "{row:?}");
                if farthest.is_certain {
                    certain += 1;
                    let top = polytope.climb(&direction, polytope.start(&direction));
                    assert_eq!(farthest.vertex, top, "{row:?}");
                }
            }
        }
        assert!(inside > 3_000 && certain > 15_000, "{inside} {certain}");
    }
}
