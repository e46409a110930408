//! Which hole belongs to which outer loop.

use std::cmp::Ordering;

use planecut_kernel::sign::Sign;
use planecut_kernel::{DVec2, DVec3, compare_exactly};

use super::WeldError;
use super::cancel::HalfEdge;
use super::points::Points;
use crate::plane_table::{PlaneId, PlaneTable};

/// One connected region: an outer loop and its holes, each a list of half-edges.
#[derive(Debug, Clone, Default)]
pub(super) struct FaceLoops {
    pub(super) region: u32,
    /// The outer loop first.
    pub(super) loops: Vec<Vec<u32>>,
}

/// Drops the coordinate along which a normal is largest, so that counter-clockwise seen from outside stays so.
#[derive(Debug, Clone, Copy)]
pub(super) struct Projection {
    pub(super) u: usize,
    pub(super) v: usize,
}

impl Projection {
    pub(super) fn new(normal: DVec3) -> Self {
        let axis = normal.abs().max_position();
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        if normal[axis] > 0.0 { Self { u, v } } else { Self { u: v, v: u } }
    }

    pub(super) fn of(self, p: DVec3) -> DVec2 {
        DVec2::new(p[self.u], p[self.v])
    }
}

/// A loop on its way to a face.
struct Loop {
    pieces: Vec<u32>,
    area: f64,
    min: DVec2,
    max: DVec2,
}

/// Groups the loops of all regions into faces.
pub(super) fn faces(
    table: &PlaneTable,
    planes: &[PlaneId],
    points: &Points,
    pieces: &[HalfEdge],
    following: &[u32],
) -> Result<Vec<FaceLoops>, WeldError> {
    let mut faces = Vec::new();
    let mut seen = vec![false; pieces.len()];
    let mut base = 0;
    for members in pieces.chunk_by(|a, b| a.region == b.region) {
        let region = members[0].region;
        let plane = planes[region as usize];
        let nester = Nester { table, plane, points, pieces, at: Projection::new(table.half_space(plane).normal()) };
        let mut loops = Vec::new();
        for start in base..base + members.len() {
            if !seen[start] {
                loops.push(nester.walk(start as u32, following, &mut seen));
            }
        }
        nester.group(region, loops, &mut faces)?;
        base += members.len();
    }
    Ok(faces)
}

struct Nester<'a> {
    table: &'a PlaneTable,
    plane: PlaneId,
    points: &'a Points,
    pieces: &'a [HalfEdge],
    at: Projection,
}

impl Nester<'_> {
    fn position(&self, point: u32) -> DVec2 {
        self.at.of(self.points.positions[point as usize])
    }

    fn walk(&self, start: u32, following: &[u32], seen: &mut [bool]) -> Loop {
        let mut pieces = Vec::new();
        let mut piece = start;
        while !seen[piece as usize] {
            seen[piece as usize] = true;
            pieces.push(piece);
            piece = following[piece as usize];
        }
        let corner = |piece: &u32| self.position(self.pieces[*piece as usize].from);
        let origin = corner(&pieces[0]);
        let (mut area, mut min, mut max) = (0.0, origin, origin);
        for (k, piece) in pieces.iter().enumerate() {
            let (p, q) = (corner(piece), corner(&pieces[(k + 1) % pieces.len()]));
            area += 0.5 * (p - origin).perp_dot(q - origin);
            min = min.min(p);
            max = max.max(p);
        }
        Loop { pieces, area, min, max }
    }

    /// Whether a loop runs counter-clockwise: exactly, by its turn at an extreme corner, where the area is not clear.
    fn is_outer(&self, candidate: &Loop) -> bool {
        let extent = candidate.max - candidate.min;
        // Every corner may be off by a rounding error, which moves area along the whole loop.
        let reach = candidate.min.abs().max(candidate.max.abs()).max_element();
        let noise = f64::EPSILON * reach * extent.element_sum() * candidate.pieces.len() as f64;
        if candidate.area.abs() > noise.max(1e-6 * extent.x * extent.y) {
            return candidate.area > 0.0;
        }
        let n = candidate.pieces.len();
        let turn = |k: usize| {
            let (before, after) = (candidate.pieces[(k + n - 1) % n], candidate.pieces[k]);
            let (e, f) = (self.pieces[before as usize].edge, self.pieces[after as usize].edge);
            self.table.orient3(self.plane, e, f)
        };
        let point = |k: usize| self.pieces[candidate.pieces[k] as usize].from;
        let bends = (0..n).filter(|k| turn(*k) != Sign::Zero);
        let extreme = bends.min_by(|a, b| self.compare_height(point(*a), point(*b)));
        extreme.is_some_and(|k| turn(k) == Sign::Positive)
    }

    /// Gives each hole to the smallest outer loop around it.
    fn group(&self, region: u32, loops: Vec<Loop>, faces: &mut Vec<FaceLoops>) -> Result<(), WeldError> {
        let (outers, holes): (Vec<Loop>, Vec<Loop>) = loops.into_iter().partition(|candidate| self.is_outer(candidate));
        let base = faces.len();
        faces.extend(outers.iter().map(|outer| FaceLoops { region, loops: vec![outer.pieces.clone()] }));
        for hole in holes {
            let around = outers.iter().enumerate().filter(|(_, outer)| {
                outer.min.cmple(hole.min).all() && outer.max.cmpge(hole.max).all() && self.contains(outer, &hole)
            });
            let owner = around.min_by(|a, b| a.1.area.total_cmp(&b.1.area)).map(|(k, _)| k);
            faces[base + owner.ok_or(WeldError::Hole { region })?].loops.push(hole.pieces);
        }
        Ok(())
    }

    /// Whether a hole lies inside an outer loop: by the parity of crossings to the right of one of its corners that is not
    /// a corner of the outer loop.
    fn contains(&self, outer: &Loop, hole: &Loop) -> bool {
        let is_shared = |point: u32| outer.pieces.iter().any(|piece| self.pieces[*piece as usize].from == point);
        let corner = hole.pieces.iter().map(|piece| self.pieces[*piece as usize].from).find(|point| !is_shared(*point));
        let Some(corner) = corner else { return self.contains_middle(outer, hole) };
        let mut inside = false;
        for piece in &outer.pieces {
            let piece = &self.pieces[*piece as usize];
            let above = |point: u32| self.compare_height(point, corner) == Ordering::Greater;
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
    fn compare_height(&self, p: u32, q: u32) -> Ordering {
        let (at_p, at_q) = (self.position(p), self.position(q));
        let by_rounded = at_p.y.total_cmp(&at_q.y);
        if p == q || by_rounded.is_ne() {
            return by_rounded;
        }
        if [p, q].iter().all(|point| self.points.exact[*point as usize]) {
            return at_p.x.total_cmp(&at_q.x);
        }
        let rows = |point: u32| self.points.planes[point as usize].map(|plane| self.table.row(plane));
        compare_exactly(rows(p), rows(q), &[self.at.v, self.at.u])
    }

    /// Every corner is shared: take the middle of an edge, in rounded coordinates.
    fn contains_middle(&self, outer: &Loop, hole: &Loop) -> bool {
        let piece = &self.pieces[hole.pieces[0] as usize];
        let at = 0.5 * (self.position(piece.from) + self.position(piece.to));
        let mut inside = false;
        for piece in &outer.pieces {
            let piece = &self.pieces[*piece as usize];
            let (a, b) = (self.position(piece.from), self.position(piece.to));
            if (a.y > at.y) != (b.y > at.y) {
                inside ^= at.x < a.x + (at.y - a.y) / (b.y - a.y) * (b.x - a.x);
            }
        }
        inside
    }
}
