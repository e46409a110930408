//! Few convex pieces for what a surface bounds, from the top down: without the exact cells of it, of which there may be millions.
//!
//! Space is cut in two by planes across the axes, again and again ([`cut`]), always where the hull of what a box holds exceeds it most
//! ([`divide`], [`region`], [`polygons`]). What is inside is told by winding numbers ([`inside`]), of closed surfaces exactly ([`winding`]), of others by solid angles
//! ([`solid_angles`]). The piece of a box is the hull of what it holds ([`body`]); neighbouring groups of pieces are cut apart again by planes in any direction
//! ([`recut`], [`dividing_plane`], [`chunk`]); cells of several pieces are drawn in where they overlap ([`draw_in`], [`fragment`]).
//!
//! **Why the pieces hold the solid.** The boxes cover all space. What a closed solid has in common with a box is a polyhedron; each corner of it is
//! a corner of one of the clipped triangles or a corner of the box inside of the solid, so the hull of these holds all of it. That a surface may cross
//! itself does not matter: then there are more corners. In numbers: coordinates are moved to the middle and scaled by a power of two, so that their magnitude is at most 1,
//! which rounds each by at most half a unit in the last place of the largest coordinate. A clipped polygon is off the exact one by at most `2⁻⁵¹` more than the one before; 64 of these are
//! `2⁻⁴⁵`, half of [`CLIP_MARGIN`], by which the boxes overlap. Each plane of a piece is moved outward by [`GROWTH`] of the size and a few units in the
//! last place, more than all of that.

mod body;
mod chunk;
mod cut;
mod divide;
mod dividing_plane;
mod draw_in;
mod exchange;
mod extremes;
mod fragment;
mod inside;
mod polygons;
mod recut;
mod region;
mod solid_angles;
mod winding;

use planecut_csg::MaterialId;
use planecut_kernel::DVec3;
use planecut_parallel::prelude::*;

use super::CoarsenError;
use super::hull::Hull;
use super::part::{Part, most, sort_and_dedup};
use super::probes::spread;
use super::reachable::Reachable;
use crate::tolerances::{FILLED_FOR_BALLS, GROWTH, SHELL_THICKNESS};
pub(super) use body::{Growth, Points};
use divide::{Wanted, divided};
use inside::{Filled, Shell, Solid};
use polygons::Polygons;
use region::{Region, normal};
use solid_angles::SolidAngles;
pub use winding::Winding;

/// The same relative to the largest coordinate.
const ROUNDING: f64 = 4.0 * f64::EPSILON;
/// Points by which a volume is estimated.
const ESTIMATED: usize = 1 << 15;

/// What a surface bounds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bounded {
    /// All points that a closed surface goes around more than zero times.
    Solid,
    /// All points that a surface, which need not be closed, goes around more than half, by generalized winding numbers; and the triangles themselves.
    Filled,
    /// Nothing: the triangles themselves, each this thick.
    Shell {
        /// Thickness in the units of the positions.
        thickness: f64,
    },
}

/// Triangles, and what they bound.
#[derive(Debug, Clone, Copy)]
pub struct Surface<'a> {
    /// Vertices.
    pub positions: &'a [DVec3],
    /// Three numbers of vertices each, counter-clockwise seen from outside.
    pub triangles: &'a [[u32; 3]],
    /// The material of each triangle.
    pub materials: &'a [MaterialId],
    /// What they bound.
    pub bounded: Bounded,
}

impl Bounded {
    /// The thickness of a shell where none is asked for: [`SHELL_THICKNESS`] of the diagonal of the triangles' box.
    #[must_use]
    pub fn default_thickness(positions: &[DVec3], triangles: &[[u32; 3]]) -> f64 {
        let (low, high) = bounds(triangles.iter().flatten().map(|corner| positions[*corner as usize]));
        if triangles.is_empty() { 0.0 } else { SHELL_THICKNESS * (0.5 * high - 0.5 * low).length() * 2.0 }
    }
}

impl Surface<'_> {
    /// The volume of what is bounded: the signed volume of a closed surface, which must not cross itself; for a surface that is filled an estimate, good to about a hundredth; for a
    /// shell its area times its thickness.
    #[must_use]
    pub fn volume(&self) -> f64 {
        let corners = |triangle: &[u32; 3]| triangle.map(|corner| self.positions[corner as usize]);
        match self.bounded {
            Bounded::Solid => {
                let first = self.positions.first().copied().unwrap_or_default();
                let of_one = |triangle| {
                    let [a, b, c] = corners(triangle).map(|p| p - first);
                    a.dot(b.cross(c)) / 6.0
                };
                self.triangles.iter().map(of_one).sum()
            }
            Bounded::Filled => {
                let angles = SolidAngles::new(self.positions, self.triangles);
                let (low, high) = bounds(self.positions.iter().copied());
                let size = high - low;
                let is_inside = |k: &usize| angles.around(low + size * spread(*k)) > 0.5;
                let inside = (0..ESTIMATED).into_par_iter().with_min_len(1 << 8).filter(is_inside).count();
                size.element_product() * inside as f64 / ESTIMATED as f64
            }
            Bounded::Shell { thickness } => {
                let area: f64 = self.triangles.iter().map(|triangle| normal(&corners(triangle)).length() / 2.0).sum();
                area * thickness
            }
        }
    }
}

impl Surface<'_> {
    /// What a ball that comes from outside can reach.
    ///
    /// # Errors
    /// [`CoarsenError::Radius`].
    pub(super) fn reachable(&self, radius: f64) -> Result<Reachable, CoarsenError> {
        let corners = |triangle: &[u32; 3]| triangle.map(|corner| self.positions[corner as usize]);
        let triangles: Vec<[DVec3; 3]> = self.triangles.iter().map(corners).collect();
        match self.bounded {
            Bounded::Solid => Reachable::new(&triangles, 0.0, radius, None),
            // a cube around each point
            Bounded::Shell { thickness } => Reachable::new(&triangles, 0.5 * thickness * 3.0_f64.sqrt(), radius, None),
            Bounded::Filled => {
                let angles = SolidAngles::new(self.positions, self.triangles);
                let is_filled = |point: DVec3| angles.around(point) > FILLED_FOR_BALLS;
                Reachable::new(&triangles, 0.0, radius, Some(&is_filled))
            }
        }
    }
}

/// What convex pieces of a surface were made of.
#[derive(Debug)]
pub(super) struct Pieces {
    /// For each piece points whose hull, grown, it is.
    pub(super) points: Vec<Points>,
    pub(super) growth: Growth,
    frame: Frame,
    /// The boxes of pieces of a closed solid.
    regions: Vec<Region>,
}

/// About as many convex pieces as are wanted, whose union holds what a surface bounds and exceeds it little. Where space is to stay clear, as many more as
/// it takes to keep out of it.
pub(super) fn pieces(
    surface: &Surface<'_>,
    wanted: usize,
    reachable: Option<&Reachable>,
) -> Result<(Vec<Part>, Pieces), CoarsenError> {
    if surface.triangles.is_empty() {
        return Err(CoarsenError::Empty);
    }
    let used = surface.triangles.iter().flatten().map(|corner| surface.positions[*corner as usize]);
    let (low, high) = bounds(used.clone());
    if low == high {
        return Err(CoarsenError::Empty);
    }
    let frame = Frame::around(used).ok_or(CoarsenError::OutOfRange)?;
    let positions: Vec<DVec3> = surface.positions.iter().map(|p| frame.inward(*p)).collect();
    let polygons = Polygons::of_triangles(&positions, surface.triangles);
    let growth = Growth {
        thickness: match surface.bounded {
            Bounded::Solid | Bounded::Filled => 0.0,
            Bounded::Shell { thickness } => 0.5 * thickness,
        },
        rounding: frame.growth(),
    };
    let is_blocked = |region: &Region| {
        let points =
            || Points { vertices: Vec::new(), cuts: region.points().iter().map(|p| frame.outward(*p)).collect() };
        reachable.is_some_and(|reachable| !reachable.allows_hull(&Hull::of(&points().thick(growth.thickness))))
    };
    let wanted = Wanted { pieces: wanted, is_blocked: &is_blocked };
    let regions = match surface.bounded {
        Bounded::Solid => divided(polygons, &Solid(Winding::new(&positions, surface.triangles)), &wanted),
        Bounded::Filled => divided(polygons, &Filled(SolidAngles::new(&positions, surface.triangles)), &wanted),
        Bounded::Shell { thickness } => divided(polygons, &Shell { thickness: thickness * frame.scale }, &wanted),
    };
    let pieces: Vec<Option<(Part, Points)>> = regions
        .par_iter()
        .with_max_len(1)
        .map(|region| piece(region, surface, &frame, &growth))
        .collect::<Result<_, _>>()?;
    let (mut parts, mut points, mut kept) = (Vec::new(), Vec::new(), Vec::new());
    for (piece, region) in pieces.into_iter().zip(regions) {
        let Some((part, of_part)) = piece else { continue };
        parts.push(part);
        points.push(of_part);
        if matches!(surface.bounded, Bounded::Solid) {
            kept.push(region);
        }
    }
    Ok((parts, Pieces { points, growth, frame, regions: kept }))
}

/// Where positions are small numbers.
#[derive(Debug, Clone, Copy)]
struct Frame {
    middle: DVec3,
    /// A power of two.
    scale: f64,
    /// The largest coordinate.
    reach: f64,
}

impl Frame {
    /// `None` for positions out of range, and for those that are all one.
    fn around(positions: impl Iterator<Item = DVec3>) -> Option<Self> {
        let (low, high) = bounds(positions);
        let reach = low.abs().max(high.abs()).max_element();
        let half = (0.5 * high - 0.5 * low).max_element();
        let is_in_range = half > f64::MIN_POSITIVE / f64::EPSILON && reach < planecut_kernel::MAX_COORDINATE;
        // half of the largest exponent does, both ways
        let exponent = half.to_bits() >> 52;
        is_in_range.then(|| Self {
            middle: 0.5 * low + 0.5 * high,
            scale: f64::from_bits((2045 - exponent) << 52),
            reach,
        })
    }

    fn inward(&self, p: DVec3) -> DVec3 {
        (p - self.middle) * self.scale
    }

    fn outward(&self, p: DVec3) -> DVec3 {
        p / self.scale + self.middle
    }

    /// By how much a piece must be larger than its points.
    fn growth(&self) -> f64 {
        GROWTH / self.scale + ROUNDING * self.reach
    }
}

/// The piece of a box.
fn piece(
    region: &Region,
    surface: &Surface<'_>,
    frame: &Frame,
    growth: &Growth,
) -> Result<Option<(Part, Points)>, CoarsenError> {
    let outward = |points: &mut dyn Iterator<Item = DVec3>| -> Vec<DVec3> {
        let mut points: Vec<DVec3> = points.map(|p| frame.outward(p)).collect();
        sort_and_dedup(&mut points);
        points
    };
    let points = Points { vertices: outward(&mut region.vertices()), cuts: outward(&mut region.cut_points()) };
    let points = points.without_inner();
    let areas = region.polygons.iter().map(|(corners, triangle)| {
        (surface.materials.get(triangle as usize).copied().unwrap_or(MaterialId(0)), normal(corners).length())
    });
    Ok(points.body(growth, most(areas))?.map(|part| (part, points)))
}

/// The box around points.
fn bounds(points: impl Iterator<Item = DVec3>) -> (DVec3, DVec3) {
    points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ring of quadrilaterals around an axis, each two triangles.
    fn torus(sides: u32) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let at = |k: u32| std::f64::consts::TAU * f64::from(k) / f64::from(sides);
        let point = |k: u32| {
            let (around, along) = (at(k / sides), at(k % sides));
            let radius = 3.0 + along.cos();
            DVec3::new(radius * around.cos(), radius * around.sin(), along.sin())
        };
        let number = |i: u32, j: u32| i % sides * sides + j % sides;
        let two = |k: u32| {
            let (i, j) = (k / sides, k % sides);
            let [a, b, c, d] = [number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)];
            [[a, b, c], [a, c, d]]
        };
        ((0..sides * sides).map(point).collect(), (0..sides * sides).flat_map(two).collect())
    }

    #[test]
    fn volumes_of_boxes_add_up() {
        let (positions, triangles) = torus(9);
        let surface = Surface { positions: &positions, triangles: &triangles, materials: &[], bounded: Bounded::Solid };
        let frame = Frame::around(positions.iter().copied()).expect("in range");
        let inward: Vec<DVec3> = positions.iter().map(|p| frame.inward(*p)).collect();
        let inside = Solid(Winding::new(&inward, &triangles));
        for wanted in [1, 2, 7, 100] {
            let regions = divided(
                Polygons::of_triangles(&inward, &triangles),
                &inside,
                &Wanted { pieces: wanted, is_blocked: &|_| false },
            );
            let volume: f64 = regions.iter().map(Region::volume).sum();
            let expected = surface.volume() * frame.scale.powi(3);
            assert!((volume - expected).abs() < 1e-11, "{wanted}: {volume} {expected}");
            assert!(regions.len() <= wanted);
        }
    }

    #[test]
    fn both_kinds_of_winding_numbers_agree() {
        let (positions, triangles) = torus(12);
        let (exact, about) = (Winding::new(&positions, &triangles), SolidAngles::new(&positions, &triangles));
        let mut inside = 0;
        for k in 0..2000 {
            let point = DVec3::new(-4.5, -4.5, -1.5) + spread(k) * DVec3::new(9.0, 9.0, 3.0);
            let (exact, about) = (exact.around(point), about.around(point));
            assert!((about - f64::from(exact)).abs() < 0.2, "{point}: {exact} {about}");
            inside += exact;
        }
        assert!(inside > 100);
    }
}
