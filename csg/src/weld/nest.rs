//! Which hole belongs to which outer loop.

use crate::ids::number32;
use std::cmp::Ordering;

use planecut_kernel::sign::Sign;
use planecut_kernel::{DVec2, DVec3};

use super::WeldError;
use super::cancel::HalfEdge;
use super::points::Points;
use crate::ids::{HalfEdgeId, Id, PointId, RegionId};
use crate::plane_table::{PlaneId, PlaneTable};

/// Connected parts of regions, each an outer loop and its holes.
#[derive(Debug, Default)]
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

    pub(crate) fn of(self, p: DVec3) -> DVec2 {
        DVec2::new(p[self.u], p[self.v])
    }
}

/// A loop on its way to a face.
#[derive(Debug, Clone, Copy)]
struct Loop {
    /// Its half-edges among those of its region's loops.
    start: usize,
    end: usize,
    area: f64,
    min: DVec2,
    max: DVec2,
}

/// Groups loops into faces, reusing its buffers.
pub(super) struct Nester<'a> {
    table: &'a PlaneTable,
    points: &'a Points,
    /// The half-edges of the region, and the number of the first.
    region: &'a [HalfEdge],
    base: usize,
    plane: PlaneId,
    at: Projection,
    seen: Vec<bool>,
    /// Half-edges of the region, loop by loop.
    pieces: Vec<HalfEdgeId>,
    loops: Vec<Loop>,
}

impl<'a> Nester<'a> {
    pub(super) fn new(table: &'a PlaneTable, points: &'a Points) -> Self {
        Self {
            table,
            points,
            region: &[],
            base: 0,
            plane: PlaneId::of_index(0),
            at: Projection { u: 0, v: 1 },
            seen: Vec::new(),
            pieces: Vec::new(),
            loops: Vec::new(),
        }
    }

    /// Adds the faces of one region, given by its half-edges, numbered from `base`, and what follows each.
    pub(super) fn add_faces(
        &mut self,
        plane: PlaneId,
        region: &'a [HalfEdge],
        base: usize,
        following: &[HalfEdgeId],
        faces: &mut Faces,
    ) -> Result<(), WeldError> {
        (self.plane, self.region, self.base) = (plane, region, base);
        self.at = Projection::new(self.table.half_space(plane).normal());
        self.seen.clear();
        self.seen.resize(region.len(), false);
        self.pieces.clear();
        self.loops.clear();
        for start in 0..region.len() {
            if !self.seen[start] {
                self.walk(start, following);
            }
        }
        self.group(region[0].region, faces)
    }

    fn position(&self, point: PointId) -> DVec2 {
        self.at.of(self.points.positions[point.index()])
    }

    fn piece(&self, number: HalfEdgeId) -> &HalfEdge {
        &self.region[number.index() - self.base]
    }

    fn pieces_of(&self, candidate: &Loop) -> &[HalfEdgeId] {
        &self.pieces[candidate.start..candidate.end]
    }

    fn walk(&mut self, from: usize, following: &[HalfEdgeId]) {
        let start = self.pieces.len();
        let origin = self.position(self.region[from].from);
        let (mut area, mut min, mut max) = (0.0, origin, origin);
        let (mut piece, mut p) = (from, origin);
        while !self.seen[piece] {
            self.seen[piece] = true;
            self.pieces.push(HalfEdgeId::from_index(self.base + piece));
            piece = following[piece].index() - self.base;
            let q = self.position(self.region[piece].from);
            area += 0.5 * (p - origin).perp_dot(q - origin);
            min = min.min(p);
            max = max.max(p);
            p = q;
        }
        self.loops.push(Loop { start, end: self.pieces.len(), area, min, max });
    }

    /// Whether a loop runs counter-clockwise: exactly, by its turn at an extreme corner, where the area is not clear.
    fn is_outer(&self, candidate: &Loop) -> bool {
        let extent = candidate.max - candidate.min;
        // Every corner may be off by a rounding error, which moves area along the whole loop.
        let reach = candidate.min.abs().max(candidate.max.abs()).max_element();
        let noise = f64::EPSILON * reach * extent.element_sum() * (candidate.end - candidate.start) as f64;
        if candidate.area.abs() > noise.max(1e-6 * extent.x * extent.y) {
            return candidate.area > 0.0;
        }
        let pieces = self.pieces_of(candidate);
        let n = pieces.len();
        let turn = |k: usize| {
            let (before, after) = (self.piece(pieces[(k + n - 1) % n]), self.piece(pieces[k]));
            self.table.orient3(self.plane, before.edge, after.edge)
        };
        let point = |k: usize| self.piece(pieces[k]).from;
        let bends = (0..n).filter(|k| turn(*k) != Sign::Zero);
        let extreme = bends.min_by(|a, b| self.compare_height(point(*a), point(*b)));
        extreme.is_some_and(|k| turn(k) == Sign::Positive)
    }

    /// Gives each hole to the smallest outer loop around it.
    fn group(&self, region: RegionId, faces: &mut Faces) -> Result<(), WeldError> {
        if let [only] = self.loops[..]
            && self.is_outer(&only)
        {
            faces.push_loop(self.pieces_of(&only));
            faces.faces.push((region, number32(faces.loops.len())));
            return Ok(());
        }
        let (outers, holes): (Vec<Loop>, Vec<Loop>) = self.loops.iter().partition(|candidate| self.is_outer(candidate));
        let mut owned: Vec<(usize, usize)> = Vec::with_capacity(holes.len());
        for (k, hole) in holes.iter().enumerate() {
            owned.push((self.owner(&outers, hole).ok_or_else(|| WeldError::hole(region))?, k));
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

    fn owner(&self, outers: &[Loop], hole: &Loop) -> Option<usize> {
        let around = outers.iter().enumerate().filter(|(_, outer)| {
            outer.min.cmple(hole.min).all() && outer.max.cmpge(hole.max).all() && self.contains(outer, hole)
        });
        around.min_by(|a, b| a.1.area.total_cmp(&b.1.area)).map(|(k, _)| k)
    }

    /// Whether a hole lies inside an outer loop: by the parity of crossings to the right of one of its corners that is not
    /// a corner of the outer loop.
    fn contains(&self, outer: &Loop, hole: &Loop) -> bool {
        let is_shared = |point: PointId| self.pieces_of(outer).iter().any(|piece| self.piece(*piece).from == point);
        let corner = self.pieces_of(hole).iter().map(|piece| self.piece(*piece).from).find(|point| !is_shared(*point));
        let Some(corner) = corner else { return self.contains_middle(outer, hole) };
        let mut inside = false;
        for piece in self.pieces_of(outer) {
            let piece = self.piece(*piece);
            let above = |point: PointId| self.compare_height(point, corner) == Ordering::Greater;
            let (from, to) = (above(piece.from), above(piece.to));
            if from != to {
                // inside is left of the edge: an upward edge is crossed where the corner lies to its left
                let left = self.points.side(self.table, corner, piece.edge) == Sign::Negative;
                inside ^= left == to;
            }
        }
        inside
    }

    /// The exact order of two points by height, then from left to right: by rounded heights, points would seem to lie on edges
    /// that they only come near.
    fn compare_height(&self, p: PointId, q: PointId) -> Ordering {
        self.points.compare(self.table, p, q, &[self.at.v, self.at.u])
    }

    /// Every corner is shared: take the middle of an edge, in rounded coordinates.
    fn contains_middle(&self, outer: &Loop, hole: &Loop) -> bool {
        let piece = self.piece(self.pieces_of(hole)[0]);
        let at = 0.5 * (self.position(piece.from) + self.position(piece.to));
        let mut inside = false;
        for piece in self.pieces_of(outer) {
            let piece = self.piece(*piece);
            let (a, b) = (self.position(piece.from), self.position(piece.to));
            if (a.y > at.y) != (b.y > at.y) {
                inside ^= at.x < a.x + (at.y - a.y) / (b.y - a.y) * (b.x - a.x);
            }
        }
        inside
    }
}
