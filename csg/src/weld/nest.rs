//! Which hole belongs to which outer loop.

use std::cmp::Ordering;

use planecut_kernel::sign::Sign;
use planecut_kernel::{DVec2, DVec3};

use super::WeldError;
use super::cancel::HalfEdge;
use super::points::Points;
use crate::base::with_room;
use crate::ids::{HalfEdgeId, Id, PointId, RegionId, number32};
use crate::plane_table::{PlaneId, PlaneTable};

/// Connected parts of regions, each an outer loop and its holes.
#[derive(Debug)]
pub(super) struct Faces {
    /// Half-edges, loop by loop.
    pieces: Vec<HalfEdgeId>,
    /// Where each loop ends among them.
    loops: Vec<u32>,
    /// The region of each face, and where its loops end.
    faces: Vec<(RegionId, u32)>,
}

/// One of them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Face<'a> {
    pub(super) region: RegionId,
    faces: &'a Faces,
    loops: (usize, usize),
}

impl Faces {
    /// With room for the half-edges of some regions; `of_all` is the number of half-edges of all regions.
    pub(super) fn with_room(half_edges: usize, of_all: usize, regions: usize) -> Self {
        Self {
            pieces: with_room(half_edges, of_all),
            loops: Vec::with_capacity(regions),
            faces: Vec::with_capacity(regions),
        }
    }

    /// How many there are.
    pub(super) fn len(&self) -> usize {
        self.faces.len()
    }

    /// How many triangles fill them: two less than there are half-edges for the outer loop of each, two more for each hole.
    pub(super) fn triangle_count(&self) -> usize {
        (self.pieces.len() + 2 * self.loops.len()).saturating_sub(4 * self.faces.len())
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = Face<'_>> {
        let starts = std::iter::once(0).chain(self.faces.iter().map(|(_, end)| *end as usize));
        self.faces.iter().zip(starts).map(|((region, end), start)| Face {
            region: *region,
            faces: self,
            loops: (start, *end as usize),
        })
    }

    fn push_loop(&mut self, pieces: &[HalfEdgeId]) {
        self.pieces.extend_from_slice(pieces);
        self.loops.push(number32(self.pieces.len()));
    }
}

impl<'a> Face<'a> {
    /// The outer loop first.
    pub(super) fn loops(self) -> impl Iterator<Item = &'a [HalfEdgeId]> {
        let Faces { pieces, loops, .. } = self.faces;
        (self.loops.0..self.loops.1).map(|k| {
            let start = if k == 0 { 0 } else { loops[k - 1] as usize };
            &pieces[start..loops[k] as usize]
        })
    }
}

/// Drops the coordinate along which a normal is largest, so that counter-clockwise seen from outside stays so.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Projection {
    pub(crate) u: usize,
    pub(crate) v: usize,
}

impl Projection {
    pub(crate) fn new(normal: DVec3) -> Self {
        let axis = normal.abs().max_position();
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        if normal[axis] > 0.0 { Self { u, v } } else { Self { u: v, v: u } }
    }

    /// That along the normal of a plane.
    pub(super) fn of_plane(table: &PlaneTable, plane: PlaneId) -> Self {
        Self::new(table.half_space(plane).normal())
    }

    pub(crate) fn of(self, p: DVec3) -> DVec2 {
        // by its address, which needs no branch
        let p = p.to_array();
        DVec2::new(p[self.u], p[self.v])
    }
}

/// A loop of half-edges, by their numbers in a list that begins at one.
#[derive(Debug, Clone, Copy)]
pub(super) struct LoopOf<'a> {
    pub(super) pieces: &'a [HalfEdgeId],
    pub(super) half_edges: &'a [HalfEdge],
    pub(super) base: usize,
}

impl<'a> LoopOf<'a> {
    fn half_edge(self, place: usize) -> &'a HalfEdge {
        &self.half_edges[self.pieces[place].index() - self.base]
    }

    fn half_edges(self) -> impl Iterator<Item = &'a HalfEdge> {
        self.pieces.iter().map(move |piece| &self.half_edges[piece.index() - self.base])
    }
}

/// Signed area and box of a loop, rounded.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extent {
    pub(super) area: f64,
    min: DVec2,
    max: DVec2,
}

impl Extent {
    /// Whether the box of another loop lies within this one.
    pub(super) fn holds(&self, other: &Self) -> bool {
        self.min.cmple(other.min).all() && self.max.cmpge(other.max).all()
    }

    /// Whether a place lies within the box, or outside of it by no more than a margin.
    pub(super) fn is_near(&self, place: DVec2, margin: f64) -> bool {
        self.min.cmple(place + margin).all() && self.max.cmpge(place - margin).all()
    }
}

/// The plane of a region, seen from outside.
#[derive(Clone, Copy)]
pub(super) struct RegionPlane<'a> {
    table: &'a PlaneTable,
    points: &'a Points,
    pub(super) plane: PlaneId,
    at: Projection,
}

impl<'a> RegionPlane<'a> {
    pub(super) fn new(table: &'a PlaneTable, points: &'a Points, plane: PlaneId) -> Self {
        Self { table, points, plane, at: Projection::of_plane(table, plane) }
    }

    /// Where a point is, rounded.
    pub(super) fn position(&self, point: PointId) -> DVec2 {
        self.at.of(self.points.positions[point.index()])
    }

    pub(super) fn extent(&self, of: LoopOf<'_>) -> Extent {
        let origin = self.position(of.half_edge(0).from);
        let (mut area, mut min, mut max) = (0.0, origin, origin);
        let mut p = origin;
        for place in 1..=of.pieces.len() {
            let q = if place == of.pieces.len() { origin } else { self.position(of.half_edge(place).from) };
            area += 0.5 * (p - origin).perp_dot(q - origin);
            min = min.min(p);
            max = max.max(p);
            p = q;
        }
        Extent { area, min, max }
    }

    /// Whether a loop runs counter-clockwise: exactly, by its turn at an extreme corner, where the area is not clear.
    pub(super) fn is_outer(&self, of: LoopOf<'_>, extent: &Extent) -> bool {
        let n = of.pieces.len();
        let size = extent.max - extent.min;
        // Every corner may be off by a rounding error, which moves area along the whole loop.
        let reach = extent.min.abs().max(extent.max.abs()).max_element();
        let noise = f64::EPSILON * reach * size.element_sum() * n as f64;
        if extent.area.abs() > noise.max(1e-6 * size.x * size.y) {
            return extent.area > 0.0;
        }
        let turn = |k: usize| self.table.orient3(self.plane, of.half_edge((k + n - 1) % n).edge, of.half_edge(k).edge);
        let bends = (0..n).filter(|k| turn(*k) != Sign::Zero);
        let extreme = bends.min_by(|a, b| self.compare_height(of.half_edge(*a).from, of.half_edge(*b).from));
        extreme.is_some_and(|k| turn(k) == Sign::Positive)
    }

    /// Whether a hole lies inside an outer loop: by the parity of crossings to the right of one of its corners that is not
    /// a corner of the outer loop.
    pub(super) fn contains(&self, outer: LoopOf<'_>, hole: LoopOf<'_>) -> bool {
        let told = hole.half_edges().find_map(|piece| self.is_around(outer, piece.from));
        told.unwrap_or_else(|| self.contains_middle(outer, hole))
    }

    /// Whether a point lies inside a loop; nothing where it is one of its corners.
    fn is_around(&self, outer: LoopOf<'_>, corner: PointId) -> Option<bool> {
        let at = self.position(corner).y;
        // rounded correctly: where heights differ, the points are in that order
        let is_above = |point: PointId| match self.position(point).y.partial_cmp(&at) {
            Some(Ordering::Equal) | None => self.compare_height(point, corner) == Ordering::Greater,
            Some(order) => order == Ordering::Greater,
        };
        let mut inside = false;
        let last = outer.half_edges().last()?;
        let mut from = is_above(last.from);
        let mut before = last;
        for piece in outer.half_edges() {
            if piece.from == corner {
                return None;
            }
            // each edge ends where the next one begins
            let to = is_above(piece.from);
            if from != to {
                // inside is left of the edge: an upward edge is crossed where the corner lies to its left
                let left = self.points.side(self.table, corner, before.edge) == Sign::Negative;
                inside ^= left == to;
            }
            (from, before) = (to, piece);
        }
        Some(inside)
    }

    /// The exact order of two points by height, then from left to right: by rounded heights, points would seem to lie on edges
    /// that they only come near.
    fn compare_height(&self, p: PointId, q: PointId) -> Ordering {
        self.points.compare(self.table, p, q, &[self.at.v, self.at.u])
    }

    /// Every corner is shared: take the middle of an edge, in rounded coordinates.
    fn contains_middle(&self, outer: LoopOf<'_>, hole: LoopOf<'_>) -> bool {
        let piece = hole.half_edge(0);
        let at = 0.5 * (self.position(piece.from) + self.position(piece.to));
        let mut inside = false;
        for piece in outer.half_edges() {
            let (a, b) = (self.position(piece.from), self.position(piece.to));
            if (a.y > at.y) != (b.y > at.y) {
                inside ^= at.x < a.x + (at.y - a.y) / (b.y - a.y) * (b.x - a.x);
            }
        }
        inside
    }
}

/// A loop on its way to a face.
#[derive(Debug, Clone, Copy)]
struct Loop {
    /// Its half-edges among those of its region's loops.
    start: usize,
    end: usize,
    extent: Extent,
}

/// Groups loops into faces, reusing its buffers.
#[derive(Default)]
pub(super) struct Nester<'a> {
    /// The half-edges of the region, and the number of the first.
    region: &'a [HalfEdge],
    base: usize,
    seen: Vec<bool>,
    /// Half-edges of the region, loop by loop.
    pieces: Vec<HalfEdgeId>,
    loops: Vec<Loop>,
}

impl<'a> Nester<'a> {
    /// Adds the faces of one region, given by its half-edges, numbered from `base`, and what follows each.
    pub(super) fn add_faces(
        &mut self,
        plane: &RegionPlane<'_>,
        region: &'a [HalfEdge],
        base: usize,
        following: &[HalfEdgeId],
        faces: &mut Faces,
    ) -> Result<(), WeldError> {
        (self.region, self.base) = (region, base);
        self.seen.clear();
        self.seen.resize(region.len(), false);
        self.pieces.clear();
        self.loops.clear();
        for start in 0..region.len() {
            if !self.seen[start] {
                self.walk(plane, start, following);
            }
        }
        self.group(plane, region[0].region, faces)
    }

    fn pieces_of(&self, candidate: &Loop) -> &[HalfEdgeId] {
        &self.pieces[candidate.start..candidate.end]
    }

    fn loop_of(&self, candidate: &Loop) -> LoopOf<'_> {
        LoopOf { pieces: self.pieces_of(candidate), half_edges: self.region, base: self.base }
    }

    fn walk(&mut self, plane: &RegionPlane<'_>, from: usize, following: &[HalfEdgeId]) {
        let start = self.pieces.len();
        let mut piece = from;
        while !self.seen[piece] {
            self.seen[piece] = true;
            self.pieces.push(HalfEdgeId::from_index(self.base + piece));
            piece = following[piece].index() - self.base;
        }
        let pieces = &self.pieces[start..];
        let extent = plane.extent(LoopOf { pieces, half_edges: self.region, base: self.base });
        self.loops.push(Loop { start, end: self.pieces.len(), extent });
    }

    /// Gives each hole to the smallest outer loop around it.
    fn group(&self, plane: &RegionPlane<'_>, region: RegionId, faces: &mut Faces) -> Result<(), WeldError> {
        let is_outer = |candidate: &Loop| plane.is_outer(self.loop_of(candidate), &candidate.extent);
        if self.loops.iter().all(is_outer) {
            for outer in &self.loops {
                faces.push_loop(self.pieces_of(outer));
                faces.faces.push((region, number32(faces.loops.len())));
            }
            return Ok(());
        }
        let (outers, holes): (Vec<Loop>, Vec<Loop>) = self.loops.iter().partition(|candidate| is_outer(candidate));
        let mut owned: Vec<(usize, usize)> = Vec::with_capacity(holes.len());
        for (k, hole) in holes.iter().enumerate() {
            owned.push((self.owner(plane, &outers, hole).ok_or_else(|| WeldError::hole(region))?, k));
        }
        owned.sort_unstable();
        let mut owned = owned.into_iter().peekable();
        for (number, outer) in outers.iter().enumerate() {
            faces.push_loop(self.pieces_of(outer));
            while let Some((_, hole)) = owned.next_if(|(owner, _)| *owner == number) {
                faces.push_loop(self.pieces_of(&holes[hole]));
            }
            faces.faces.push((region, number32(faces.loops.len())));
        }
        Ok(())
    }

    fn owner(&self, plane: &RegionPlane<'_>, outers: &[Loop], hole: &Loop) -> Option<usize> {
        let around = outers.iter().enumerate().filter(|(_, outer)| {
            outer.extent.holds(&hole.extent) && plane.contains(self.loop_of(outer), self.loop_of(hole))
        });
        around.min_by(|a, b| a.1.extent.area.total_cmp(&b.1.extent.area)).map(|(k, _)| k)
    }
}
