//! On which sides of the planes of other bodies the corners of a body lie: each corner is seen from several faces, and four are told at once.

use std::ops::Range;

use planecut_kernel::HalfSpace;
use planecut_kernel::sign::Sign;
use wide::f64x4;

use super::section::Polygon;
use super::signs::Signs;
use crate::body::{Corner, PlaneFilter};
use crate::ids::{CornerId, Id};
use crate::plane_table::PlaneId;

/// Of bodies with more corners nothing is told here.
const MOST: usize = 1024;

/// Maximum number of planes all of which are looked at; of more, no more than it takes.
const FEW_PLANES: usize = 16;

/// Corners that are told at once.
const LANES: usize = 4;
/// Corners of a word.
const BITS: usize = u64::BITS as usize;

/// The corners of one body, and on which sides of some planes they are.
#[derive(Debug, Default)]
pub(super) struct CornerSides {
    /// Coordinates and errors of [`LANES`] corners each; the last of them are there several times.
    corners: Vec<[f64x4; 4]>,
    count: usize,
    /// How many words there are for each plane.
    words: usize,
    sides: Vec<Sides>,
    /// Corners that are looked for.
    left: Vec<u64>,
    /// The corners of the polygon that is looked at, as far as they are corners of the body.
    polygon: Vec<u64>,
    /// The places of those of its corners that cutting made.
    cut: Vec<usize>,
}

/// The sides of a word of corners; what is in none of the three is not known.
#[derive(Debug, Clone, Copy, Default)]
struct Sides {
    inside: u64,
    on: u64,
    outside: u64,
}

/// Whether some corners of a polygon lie strictly inside of a plane, and some strictly outside.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Spread {
    pub(super) inside: bool,
    pub(super) outside: bool,
}

impl CornerSides {
    /// Begins with the corners of another body.
    pub(super) fn begin(&mut self, corners: &[Corner]) {
        self.corners.clear();
        self.sides.clear();
        // of more corners it would be much to look at all for every plane
        let corners = if corners.len() <= MOST { corners } else { &[] };
        self.count = corners.len();
        self.words = corners.len().div_ceil(BITS);
        self.corners.extend(corners.chunks(LANES).map(|some| {
            let lanes = |of: fn(&Corner) -> f64| f64x4::new([0, 1, 2, 3].map(|k| of(&some[k.min(some.len() - 1)])));
            [lanes(|c| c.at.x), lanes(|c| c.at.y), lanes(|c| c.at.z), lanes(|c| c.error)]
        }));
    }

    /// Adds a plane as far as plain numbers tell; whether all corners are strictly outside of it.
    pub(super) fn add_plane(&mut self, half_space: &HalfSpace) -> bool {
        let filter = WideFilter::new(half_space);
        let mut are_all_outside = true;
        for (word, corners) in self.corners.chunks(BITS / LANES).enumerate() {
            let mut sides = Sides::default();
            for (place, corners) in corners.iter().enumerate() {
                let (value, bound) = filter.values(corners);
                sides.outside |= u64::from(value.simd_gt(bound).to_bitmask()) << (LANES * place);
                sides.inside |= u64::from(value.simd_lt(-bound).to_bitmask()) << (LANES * place);
            }
            let all = all_bits(self.count - word * BITS);
            sides.outside &= all;
            sides.inside &= all;
            are_all_outside &= sides.outside == all;
            self.sides.push(sides);
        }
        are_all_outside
    }

    /// Whether a corner is known to lie strictly inside of all planes from one on.
    pub(super) fn is_one_inside(&self, first: usize) -> bool {
        let sides = &self.sides[first * self.words..];
        (0..self.words).any(|word| sides.chunks(self.words).fold(u64::MAX, |all, plane| all & plane[word].inside) != 0)
    }

    /// How many planes were added.
    pub(super) fn planes(&self) -> usize {
        self.sides.len() / self.words.max(1)
    }

    /// Forgets the planes from one on.
    pub(super) fn forget_from(&mut self, plane: usize) {
        self.sides.truncate(plane * self.words);
    }

    /// Begins to look for corners that are beyond none of the planes that are added from now on.
    pub(super) fn begin_search(&mut self) {
        self.left.clear();
        self.left.extend((0..self.words).map(|word| all_bits(self.count - word * BITS)));
    }

    /// Drops those beyond the plane that was added last from the corners looked for.
    pub(super) fn drop_outside(&mut self) {
        let last = &self.sides[self.sides.len() - self.words..];
        self.left.iter_mut().zip(last).for_each(|(left, sides)| *left &= !sides.outside);
    }

    /// Drops a corner from those looked for.
    pub(super) fn drop_corner(&mut self, corner: CornerId) {
        self.left[corner.index() / BITS] &= !(1 << (corner.index() % BITS));
    }

    /// The first of the corners looked for, or the last.
    pub(super) fn left(&self, is_first: bool) -> Option<CornerId> {
        let mut some = self.left.iter().enumerate().filter(|(_, bits)| **bits != 0);
        let (word, bits) = if is_first { some.next()? } else { some.next_back()? };
        let bit = if is_first { bits.trailing_zeros() } else { bits.ilog2() };
        Some(CornerId::from_index(word * BITS + bit as usize))
    }

    /// Takes a polygon on a face of the body to be looked at.
    pub(super) fn look_at(&mut self, polygon: &Polygon) {
        self.polygon.clear();
        self.polygon.resize(self.words, 0);
        self.cut.clear();
        for (place, corner) in polygon.corners.iter().enumerate() {
            if corner.number.index() >= self.count {
                self.cut.push(place);
            } else {
                let number = corner.number.index();
                self.polygon[number / BITS] |= 1 << (number % BITS);
            }
        }
    }

    /// Whether there are no corners to be told of.
    pub(super) fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Whether the polygon is known to lie strictly inside of some planes.
    pub(super) fn are_known_inside(&self, mut planes: Range<usize>) -> bool {
        if let Some((bits, sides)) = self.few_sides(&planes) {
            return self.cut.is_empty() & (sides.iter().fold(0, |others, sides| others | bits & !sides.inside) == 0);
        }
        let holds = |(bits, sides): (&u64, &Sides)| bits & !sides.inside == 0;
        self.cut.is_empty() && planes.all(|plane| self.polygon.iter().zip(self.of_plane(plane)).all(holds))
    }

    /// Whether the polygon is known to lie strictly outside of one of some planes.
    pub(super) fn is_known_outside_of_one(&self, mut planes: Range<usize>) -> bool {
        if let Some((bits, sides)) = self.few_sides(&planes) {
            let is_outside = |is_one: bool, sides: &Sides| is_one | (bits & !sides.outside == 0);
            return self.cut.is_empty() & sides.iter().fold(false, is_outside);
        }
        planes.any(|plane| self.is_known_outside(plane))
    }

    /// The corners of the polygon in one word, and the sides of few planes: to be looked at without a branch for each.
    fn few_sides(&self, planes: &Range<usize>) -> Option<(u64, &[Sides])> {
        let is_little = self.words == 1 && planes.len() <= FEW_PLANES;
        is_little.then(|| (self.polygon[0], &self.sides[planes.clone()]))
    }

    /// Whether the polygon is known to lie strictly outside of a plane.
    fn is_known_outside(&self, plane: usize) -> bool {
        let is_outside = |(bits, sides): (&u64, &Sides)| bits & !sides.outside == 0;
        self.cut.is_empty() && self.polygon.iter().zip(self.of_plane(plane)).all(is_outside)
    }

    /// Whether some corner of the polygon is known to lie strictly outside of a plane.
    pub(super) fn is_one_known_outside(&self, plane: usize) -> bool {
        self.polygon.iter().zip(self.of_plane(plane)).any(|(bits, sides)| bits & sides.outside != 0)
    }

    fn of_plane(&self, plane: usize) -> &[Sides] {
        &self.sides[plane * self.words..(plane + 1) * self.words]
    }

    /// How the corners of the polygon, which lies on a plane of a table, are spread about another; `number` is that of the plane among those added. Exact; whether there are more
    /// of either side is not looked for.
    pub(super) fn spread(
        &mut self,
        signs: Signs<'_>,
        (polygon, plane): (&Polygon, PlaneId),
        (number, cut): (usize, PlaneId),
    ) -> Spread {
        let mut spread = Spread::default();
        let sides = &mut self.sides[number * self.words..(number + 1) * self.words];
        for (word, (bits, sides)) in self.polygon.iter().zip(sides).enumerate() {
            let mut unknown = bits & !(sides.inside | sides.on | sides.outside);
            while unknown != 0 {
                let bit = unknown & unknown.wrapping_neg();
                let corner = CornerId::from_index(word * BITS + bit.trailing_zeros() as usize);
                let place = polygon.corners.iter().position(|other| other.number == corner);
                let place = place.expect("a corner of the polygon");
                match signs.side(&polygon.corners[place], polygon.corner(plane, place), cut) {
                    Sign::Negative => sides.inside |= bit,
                    Sign::Zero => sides.on |= bit,
                    Sign::Positive => sides.outside |= bit,
                }
                unknown &= !bit;
            }
            spread.inside |= bits & sides.inside != 0;
            spread.outside |= bits & sides.outside != 0;
        }
        for place in &self.cut {
            if spread.inside && spread.outside {
                break;
            }
            match signs.side(&polygon.corners[*place], polygon.corner(plane, *place), cut) {
                Sign::Negative => spread.inside = true,
                Sign::Zero => {}
                Sign::Positive => spread.outside = true,
            }
        }
        spread
    }
}

/// The bits of the first of some corners that are in one word.
fn all_bits(corners: usize) -> u64 {
    if corners >= BITS { u64::MAX } else { (1 << corners) - 1 }
}

/// The numbers of a [`PlaneFilter`], each four times.
struct WideFilter {
    normal: [f64x4; 3],
    offset: f64x4,
    reach: f64x4,
    room: f64x4,
}

impl WideFilter {
    fn new(half_space: &HalfSpace) -> Self {
        let [a, b, c, offset, reach, room] = PlaneFilter::new(half_space).numbers();
        Self {
            normal: [f64x4::splat(a), f64x4::splat(b), f64x4::splat(c)],
            offset: f64x4::splat(offset),
            reach: f64x4::splat(reach),
            room: f64x4::splat(room),
        }
    }

    /// Values of the plane's equation at four corners, and bounds for their errors.
    #[inline]
    fn values(&self, [x, y, z, error]: &[f64x4; 4]) -> (f64x4, f64x4) {
        let [a, b, c] = self.normal;
        (a * *x + b * *y + c * *z - self.offset, self.reach * *error + self.room)
    }
}

#[cfg(test)]
mod tests {
    use planecut_kernel::DVec3;

    use super::*;
    use crate::body::{Body, build_bodies};
    use crate::model::{Brush, MaterialId};
    use crate::plane_table::PlaneTable;

    /// A prism of many sides, so that its corners take several words; on a grid, so that corners often lie on planes.
    fn prism(sides: u32, middle: DVec3) -> Brush {
        let side = |k: u32| {
            let (y, x) = (std::f64::consts::TAU * f64::from(k) / f64::from(sides)).sin_cos();
            let normal = DVec3::new((64.0 * x).round(), (64.0 * y).round(), 0.0);
            HalfSpace::new(normal, 64.0 + normal.dot(middle)).expect("a plane")
        };
        let caps = [1.0, -1.0].map(|z| HalfSpace::new(DVec3::Z * z, 1.0 + z * middle.z).expect("a plane"));
        Brush::from_half_spaces((0..sides).map(side).chain(caps), MaterialId(0))
    }

    /// The side of each corner as the planes of the corner tell it.
    fn exact_sides(table: &PlaneTable, body: &Body, cut: PlaneId) -> Vec<Sign> {
        let mut sides = vec![Sign::Zero; body.corner_count()];
        for face in &body.faces {
            let mut polygon = Polygon::default();
            polygon.set(body.edges(face), body.corners(face));
            for (place, corner) in polygon.corners.iter().enumerate() {
                let planes = polygon.corner(face.plane, place);
                sides[corner.number.index()] = table.side(planes, &table.homogeneous(planes), cut);
            }
        }
        sides
    }

    #[test]
    fn sides_are_those_of_the_planes_of_each_corner() {
        let mut told = [0; 3];
        for (sides, step) in [(4, 1.0), (6, 0.5), (40, 0.25), (96, 1.0 / 3.0)] {
            let brushes: Vec<Brush> = (0..6).map(|k| prism(sides, DVec3::splat(step * f64::from(k)))).collect();
            let built = build_bodies(&brushes);
            let bodies: Vec<Body> = built.bodies.into_iter().filter_map(|body| body.bounded()).collect();
            assert_eq!(bodies.len(), 6);
            let mut corners = CornerSides::default();
            for (body, other) in bodies.iter().flat_map(|body| bodies.iter().map(move |other| (body, other))) {
                corners.begin(body.all_corners());
                let mut exact = Vec::new();
                for (number, face) in other.faces.iter().enumerate() {
                    let are_outside = corners.add_plane(built.table.half_space(face.plane));
                    exact.push(exact_sides(&built.table, body, face.plane));
                    assert!(!are_outside || exact[number].iter().all(|side| *side == Sign::Positive));
                }
                let is_inside = |k: usize| exact.iter().all(|sides| sides[k] == Sign::Negative);
                assert!(!corners.is_one_inside(0) || (0..body.corner_count()).any(is_inside));
                for face in &body.faces {
                    let mut polygon = Polygon::default();
                    polygon.set(body.edges(face), body.corners(face));
                    corners.look_at(&polygon);
                    for (number, cut) in other.faces.iter().enumerate() {
                        let is =
                            |side| polygon.corners.iter().any(|corner| exact[number][corner.number.index()] == side);
                        if corners.is_known_outside(number) {
                            assert!(!is(Sign::Negative) && !is(Sign::Zero));
                        }
                        let spread =
                            corners.spread(Signs::of(&built.table), (&polygon, face.plane), (number, cut.plane));
                        assert_eq!((spread.inside, spread.outside), (is(Sign::Negative), is(Sign::Positive)));
                        told[0] += usize::from(is(Sign::Zero));
                        told[1] += usize::from(spread.inside && spread.outside);
                        told[2] += usize::from(corners.is_known_outside(number));
                    }
                }
            }
        }
        assert!(told.iter().all(|count| *count > 100), "on planes, across, beyond: {told:?}");
    }
}
