//! What boxes and planes in any direction leave of a closed solid.
//!
//! A chunk is what the solid has in common with a convex polyhedron: a box, cut by some planes. It is known by its edges: the sides of the polygons of the surface in it, and where edges of the
//! polyhedron are inside of the solid. The hull of their ends holds all of it.
//!
//! **Why halves hold all of a chunk.** Coordinates are at most 1. A height above a plane is off by less than `2⁻⁴⁹` there. What is below keeps
//! all points up to a margin above the plane and where edges reach that height; what is above keeps as much below the plane. Where an edge has an end on either side of
//! that height, the point found on it is off the edge by less than `2⁻⁵⁰`, and, whatever the slope, off the height by rounding alone: so the half holds
//! all of the edge below the plane itself, but for `2⁻⁵⁰`. A new edge of the polyhedron lies where the plane crosses one of its faces; between the first and the last point
//! at which edges in that face cross the plane lies all that is inside. After [`MOST_CUTS`] cuts all that is off by no more than `2⁻⁴⁶`, and by `2⁻⁴⁵` before them. The margin,
//! [`RECUT_MARGIN`](crate::tolerances::RECUT_MARGIN), is larger, so that what a chunk holds by rounding alone is not lost between the halves, and cells grow by
//! [`GROWTH`](crate::tolerances::GROWTH), which is more than both.

use std::sync::{Arc, OnceLock};

use planecut_kernel::DVec3;
use rustc_hash::FxHashMap;

use super::super::part::sort_and_dedup;
use super::Frame;
use super::body::Points;
use super::fragment::{Plane, crossing};
use super::region::{Region, hull_volume};

/// Cuts that led to one chunk, at most.
const MOST_CUTS: u32 = 16;
/// The number of the first face of a polyhedron that is not one of its box.
const FIRST_CUT: u32 = 6;

/// A polygon of the surface, or two points of an edge of the polyhedron. For each side from one corner to the next the faces of the polyhedron on which it lies, as bits.
#[derive(Debug, Clone)]
struct Ring {
    corners: Vec<DVec3>,
    faces: Vec<u32>,
}

/// The hull of what a polyhedron holds.
#[derive(Debug)]
pub(super) struct Chunk {
    /// The number of the piece that it is of.
    pub(super) piece: u32,
    /// What it was cut from.
    parent: Option<Arc<Chunk>>,
    cuts: u32,
    rings: Vec<Ring>,
    /// The corners of its hull, and about its middle.
    pub(super) corners: Vec<DVec3>,
    pub(super) middle: DVec3,
    /// How far the corners are from that, at most.
    pub(super) radius: f64,
    pub(super) volume: f64,
    /// The same corners where they are.
    pub(super) points: Points,
    skeleton: OnceLock<Skeleton>,
}

/// All corners and edges, each once.
#[derive(Debug)]
pub(super) struct Skeleton {
    pub(super) corners: Vec<DVec3>,
    edges: Vec<[u32; 2]>,
}

/// On which side of a plane a chunk lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Place {
    Below,
    Above,
    Across,
}

impl Ring {
    fn sides(&self) -> impl Iterator<Item = (DVec3, DVec3, u32)> {
        let next = self.corners.iter().cycle().skip(1);
        self.corners.iter().zip(next).zip(&self.faces).map(|((a, b), faces)| (*a, *b, *faces))
    }

    /// What lies below a plane, which is a face of the polyhedron then.
    fn below(&self, plane: Plane, face: u32) -> Self {
        let height = |p: DVec3| plane.0.dot(p) - plane.1;
        let (mut corners, mut faces) = (Vec::new(), Vec::new());
        for (a, b, of_side) in self.sides() {
            let is_below = height(a) <= 0.0;
            if is_below {
                corners.push(a);
                faces.push(of_side);
            }
            if is_below != (height(b) <= 0.0) {
                corners.push(crossing(a, b, height));
                faces.push(if is_below { face } else { of_side });
            }
        }
        Self { corners, faces }
    }
}

impl Chunk {
    pub(super) fn of_region(piece: u32, region: &Region, points: &Points, frame: &Frame) -> Self {
        let on_sides = |p: DVec3| {
            let bits = |k: usize| {
                (u32::from(p[k] == region.low[k]) << (2 * k)) | (u32::from(p[k] == region.high[k]) << (2 * k + 1))
            };
            bits(0) | bits(1) | bits(2)
        };
        let mut rings: Vec<Ring> = Vec::new();
        // all that is known of the edges of the box
        let mut on_edges: Vec<(DVec3, u32)> = region.inner_corners().map(|p| (p, on_sides(p))).collect();
        for (corners, _) in region.polygons.iter() {
            let of_corners: Vec<u32> = corners.iter().map(|p| on_sides(*p)).collect();
            on_edges.extend(
                corners.iter().copied().zip(of_corners.iter().copied()).filter(|(_, sides)| sides.count_ones() > 1),
            );
            let next = of_corners.iter().cycle().skip(1);
            let faces = of_corners.iter().zip(next).map(|(a, b)| a & b).collect();
            rings.push(Ring { corners: corners.to_vec(), faces });
        }
        for axis in 0..3 {
            for k in 0..4_u32 {
                let (second, third) = ((axis + 1) % 3, (axis + 2) % 3);
                let edge = 1 << (2 * second as u32 + (k & 1)) | 1 << (2 * third as u32 + (k >> 1));
                rings.extend(rod(on_edges.iter().filter(|(_, sides)| sides & edge == edge).map(|(p, _)| *p), edge));
            }
        }
        Self::new(piece, None, rings, points.clone(), frame)
    }

    fn new(piece: u32, parent: Option<Arc<Self>>, rings: Vec<Ring>, points: Points, frame: &Frame) -> Self {
        let cuts = parent.as_ref().map_or(0, |parent| parent.cuts + 1);
        let corners: Vec<DVec3> = points.all().map(|p| frame.inward(*p)).collect();
        let middle = corners.iter().sum::<DVec3>() / corners.len().max(1) as f64;
        let radius = corners.iter().map(|p| p.distance_squared(middle)).fold(0.0, f64::max).sqrt();
        let volume = hull_volume(&corners);
        Self { piece, parent, cuts, rings, corners, middle, radius, volume, points, skeleton: OnceLock::new() }
    }

    /// On which side of a plane it lies where it reaches beyond it by no more than the margin; what was cut too often lies where its middle does.
    pub(super) fn place(&self, (normal, offset): Plane, margin: f64) -> Place {
        let (low, high) = self.corners.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| {
            let height = normal.dot(*p) - offset;
            (low.min(height), high.max(height))
        });
        if high <= margin {
            Place::Below
        } else if low >= -margin {
            Place::Above
        } else if self.cuts < MOST_CUTS {
            Place::Across
        } else if normal.dot(self.middle) <= offset {
            Place::Below
        } else {
            Place::Above
        }
    }

    pub(super) fn skeleton(&self) -> &Skeleton {
        self.skeleton.get_or_init(|| {
            let mut numbers: FxHashMap<[u64; 3], u32> = FxHashMap::default();
            let mut skeleton = Skeleton { corners: Vec::new(), edges: Vec::new() };
            for (a, b, _) in self.rings.iter().flat_map(Ring::sides) {
                let [a, b] = [a, b].map(|p| {
                    let next = skeleton.corners.len() as u32;
                    let number = *numbers.entry(p.to_array().map(f64::to_bits)).or_insert(next);
                    if number == next {
                        skeleton.corners.push(p);
                    }
                    number
                });
                if a != b {
                    skeleton.edges.push([a.min(b), a.max(b)]);
                }
            }
            skeleton.edges.sort_unstable();
            skeleton.edges.dedup();
            skeleton
        })
    }

    /// What lies below a plane that it crosses, and what above; both reach beyond it by a margin.
    pub(super) fn split(self: &Arc<Self>, (normal, offset): Plane, margin: f64, frame: &Frame) -> [Arc<Self>; 2] {
        [1.0, -1.0].map(|way| Arc::new(self.below((way * normal, way * offset + margin), frame)))
    }

    fn below(self: &Arc<Self>, plane: Plane, frame: &Frame) -> Self {
        let face = 1 << (FIRST_CUT + self.cuts);
        let mut rings: Vec<Ring> = self.rings.iter().map(|ring| ring.below(plane, face)).collect();
        rings.retain(|ring| !ring.corners.is_empty());
        // where the plane crosses each face
        let height = |p: DVec3| plane.0.dot(p) - plane.1;
        let across = |(a, b, _): &(DVec3, DVec3, u32)| (height(*a) <= 0.0) != (height(*b) <= 0.0);
        let rim: Vec<(DVec3, u32)> = self
            .rings
            .iter()
            .flat_map(Ring::sides)
            .filter(|side| side.2 != 0 && across(side))
            .map(|(a, b, faces)| (crossing(a, b, height), faces))
            .collect();
        for other in (0..FIRST_CUT + self.cuts).map(|k| 1 << k) {
            rings.extend(rod(rim.iter().filter(|(_, faces)| faces & other != 0).map(|(p, _)| *p), other | face));
        }
        let mut points = Points::default();
        for ring in &rings {
            let before = ring.faces.iter().cycle().skip(ring.faces.len() - 1);
            for ((p, after), before) in ring.corners.iter().zip(&ring.faces).zip(before) {
                let is_inside = *after == 0 && *before == 0;
                let kind = if is_inside { &mut points.vertices } else { &mut points.cuts };
                kind.push(frame.outward(*p));
            }
        }
        for kind in [&mut points.vertices, &mut points.cuts] {
            sort_and_dedup(kind);
        }
        Self::new(self.piece, Some(Arc::clone(self)), rings, points.without_inner(), frame)
    }
}

impl Skeleton {
    /// Where its edges cross a plane.
    pub(super) fn rim(&self, (normal, offset): Plane) -> impl Iterator<Item = DVec3> {
        let height = move |p: DVec3| normal.dot(p) - offset;
        let ends = self.edges.iter().map(|ends| ends.map(|corner| self.corners[corner as usize]));
        ends.filter(move |[a, b]| (height(*a) > 0.0) != (height(*b) > 0.0)).map(move |[a, b]| crossing(a, b, height))
    }
}

/// From the first to the last of points on a line.
fn rod(points: impl Iterator<Item = DVec3> + Clone, faces: u32) -> Option<Ring> {
    let first = points.clone().next()?;
    let (low, high) = points.clone().fold((first, first), |(low, high), p| (low.min(p), high.max(p)));
    let extent = high - low;
    let axis = (0..3).max_by(|a, b| extent[*a].total_cmp(&extent[*b]))?;
    let least = points.clone().min_by(|a, b| a[axis].total_cmp(&b[axis]))?;
    let most = points.max_by(|a, b| a[axis].total_cmp(&b[axis]))?;
    Some(Ring { corners: vec![least, most], faces: vec![faces; 2] })
}

/// Chunks with halves of one put together again.
pub(super) fn rejoined(mut chunks: Vec<Arc<Chunk>>) -> Vec<Arc<Chunk>> {
    loop {
        let count = chunks.len();
        let mut joined: Vec<Arc<Chunk>> = Vec::with_capacity(count);
        for chunk in chunks {
            let parent = |other: &Arc<Chunk>| other.parent.as_ref().map(Arc::as_ptr);
            let other = joined.iter().position(|other| parent(other).is_some() && parent(other) == parent(&chunk));
            match (other, &chunk.parent) {
                (Some(other), Some(parent)) => joined[other] = Arc::clone(parent),
                _ => joined.push(chunk),
            }
        }
        if joined.len() == count {
            return joined;
        }
        chunks = joined;
    }
}

#[cfg(test)]
mod tests {
    use planecut_csg::MaterialId;

    use super::super::{Bounded, Surface, pieces, spread};
    use super::*;
    use crate::tolerances::RECUT_MARGIN;

    /// Two pyramids on one base, some of the corners moved: convex, and across no axis.
    fn gem() -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let base = (0..7).map(|k| {
            let angle = std::f64::consts::TAU * f64::from(k) / 7.0 + 0.1;
            DVec3::new(2.0 * angle.cos(), 1.5 * angle.sin(), 0.0)
        });
        let tips = [DVec3::new(0.3, 0.2, 1.1), DVec3::new(-0.1, 0.4, -0.9)];
        let sides = (0..7).flat_map(|k| [[k, (k + 1) % 7, 7], [(k + 1) % 7, k, 8]]);
        (base.chain(tips).collect(), sides.collect())
    }

    #[test]
    fn volumes_of_halves_add_up() {
        let (positions, triangles) = gem();
        let surface = Surface {
            positions: &positions,
            triangles: &triangles,
            materials: &[MaterialId(0)],
            bounded: Bounded::Solid,
        };
        let (_, pieces) = pieces(&surface, 9, None).expect("a surface");
        let whole = surface.volume() * pieces.frame.scale.powi(3);
        let chunk = |(k, region): (usize, &Region)| {
            Arc::new(Chunk::of_region(k as u32, region, &pieces.points[k], &pieces.frame))
        };
        let uncut: Vec<Arc<Chunk>> = pieces.regions.iter().enumerate().map(chunk).collect();
        let mut chunks = uncut.clone();
        for cut in 0..MOST_CUTS as usize + 4 {
            let sum: f64 = chunks.iter().map(|chunk| chunk.volume).sum();
            assert!((sum - whole).abs() <= 1e-9 * whole, "{cut}: {sum} of {whole}");
            let normal = (spread(cut) - 0.5).normalize();
            let plane = (normal, 0.3 * (spread(cut + 100).x - 0.5));
            let halves = |chunk: &Arc<Chunk>| match chunk.place(plane, RECUT_MARGIN) {
                Place::Across => chunk.split(plane, RECUT_MARGIN, &pieces.frame).to_vec(),
                _ => vec![Arc::clone(chunk)],
            };
            chunks = chunks.iter().flat_map(halves).collect();
        }
        assert!(chunks.len() > 100, "{}", chunks.len());
        let joined = rejoined(chunks);
        assert_eq!(joined.len(), uncut.len());
        assert!(joined.iter().all(|chunk| uncut.iter().any(|other| Arc::ptr_eq(chunk, other))));
    }
}
