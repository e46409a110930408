//! Convex lumps of the solid within a part.
//!
//! **When a lump is done.** Let `C` be a part of space, `F` some of the sheets of the surface inside it, and `K` what `C` has
//! below the planes of all of `F`. If `F` lies in `K`, and no other sheet enters it, then `K` is a part of the solid `S`, and what
//! surrounds it in `C` is not:
//! - The inside of `K` meets no piece, as the pieces of `F` lie on planes that bound it. So it lies all in `S` or all outside; it
//!   lies below a piece, so it is in `S`.
//! - Take a facet of `K` on the plane of a piece of `F`. The surface is closed, so where the pieces on this facet ended within it,
//!   a piece of the same sheet on another plane would begin; that plane would pass through the facet's inside and cut `K`, which
//!   lies below it. So the pieces cover the whole facet.

use planecut_csg::stages::{Bounds, Boxes};
use planecut_kernel::DVec3;

use super::edges::Edges;
use super::part::{Part, Piece, PlaneSide, Points};

/// Takes the lumps that are convex out of a part.
pub(super) fn take_convex(part: &mut Part, edges: &Edges, points: &Points<'_>) -> Vec<Vec<PlaneSide>> {
    if edges.sheets == 1 {
        // a closed surface without a reflex edge is convex (Tietze 1928, Nakajima 1928)
        let is_whole = points.is_closed && part.walls.is_empty();
        let is_done =
            edges.reflex.is_empty() && (is_whole || PieceGroup::new(part.pieces.iter().collect()).is_convex(points));
        if !is_done {
            return Vec::new();
        }
        let pieces = std::mem::take(&mut part.pieces);
        return vec![lump(part, pieces.iter(), points)];
    }
    let mut is_folded = vec![false; edges.sheets];
    for (_, pieces) in &edges.reflex {
        is_folded[edges.sheet_of[pieces[0] as usize] as usize] = true;
    }
    let mut is_taken = vec![false; edges.sheets];
    let mut lumps = Vec::new();
    let groups = groups_of(part, edges);
    let near = Near::new(part, &groups, points);
    let convex: Vec<bool> =
        groups.iter().zip(&is_folded).map(|(group, folded)| !folded && group.is_convex(points)).collect();
    // one that is taken may have stood in the way of others
    let mut before = usize::MAX;
    while lumps.len() != before {
        before = lumps.len();
        for start in 0..edges.sheets {
            if !convex[start] || is_taken[start] {
                continue;
            }
            if let Some(members) = complete(&groups, &near.to(start), &convex, &is_taken, start, points) {
                let pieces = members.iter().flat_map(|sheet| groups[*sheet].pieces.iter().copied());
                lumps.push(lump(part, pieces, points));
                members.into_iter().for_each(|sheet| is_taken[sheet] = true);
            }
        }
    }
    let mut sheet = edges.sheet_of.iter();
    part.pieces.retain(|_| !is_taken[*sheet.next().expect("a sheet for each piece") as usize]);
    lumps
}

/// The pieces of each sheet.
fn groups_of<'a>(part: &'a Part, edges: &Edges) -> Vec<PieceGroup<'a>> {
    let mut pieces: Vec<Vec<&Piece>> = vec![Vec::new(); edges.sheets];
    for (piece, sheet) in part.pieces.iter().zip(&edges.sheet_of) {
        pieces[*sheet as usize].push(piece);
    }
    pieces.into_iter().map(PieceGroup::new).collect()
}

/// Which sheets may enter a lump that is bounded by one of them and others: a surface may have very many sheets, in rows and columns.
enum Near {
    /// Boxes around the sheets: each is a closed surface, so that a lump lies in the box of any convex sheet that bounds it.
    Boxes(Boxes),
    /// Walls bound lumps as well: all sheets.
    All(usize),
}

impl Near {
    /// Room for rounding in a box, as a share of its size.
    const ROOM: f64 = 1e-6;

    fn new(part: &Part, groups: &[PieceGroup<'_>], points: &Points<'_>) -> Self {
        if !points.is_closed || !part.walls.is_empty() {
            return Self::All(groups.len());
        }
        let bounds = |group: &PieceGroup<'_>| {
            let at = group.vertices.iter().map(|v| points.positions[*v as usize]);
            let Bounds { min, max } = at.fold(Bounds::EMPTY, |all, at| all.union(&Bounds { min: at, max: at }));
            let slack = group.vertices.iter().map(|v| points.slack(*v)).fold(0.0, f64::max);
            let room = DVec3::splat(Self::ROOM * (max - min).max_element() + slack);
            Bounds { min: min - room, max: max + room }
        };
        Self::Boxes(Boxes::new(groups.iter().map(bounds).collect()))
    }

    /// The sheets near one of them, ascending.
    fn to(&self, sheet: usize) -> Vec<usize> {
        match self {
            Self::All(count) => (0..*count).collect(),
            Self::Boxes(boxes) => {
                let mut found = Vec::new();
                boxes.touching(boxes.get(sheet as u32), &mut found);
                found.into_iter().map(|sheet| sheet as usize).collect()
            }
        }
    }
}

/// The sheets that bound a convex lump together with one of them, where nothing of other lumps lies in it; `near` are those that may.
fn complete(
    groups: &[PieceGroup<'_>],
    near: &[usize],
    convex: &[bool],
    is_taken: &[bool],
    start: usize,
    points: &Points<'_>,
) -> Option<Vec<usize>> {
    let mut members = vec![start];
    let mut whole = groups[start].clone();
    loop {
        let mut others = near.iter().copied().filter(|other| !is_taken[*other] && !members.contains(other));
        let Some(other) = others.find(|other| whole.is_entered_by(&groups[*other], points)) else {
            let mut taken = near.iter().copied().filter(|other| is_taken[*other]);
            let is_disjoint = !taken.any(|other| whole.is_entered_by(&groups[other], points));
            return is_disjoint.then_some(members);
        };
        if !convex[other] {
            return None;
        }
        whole = whole.joined(&groups[other]);
        if !whole.is_convex(points) {
            return None;
        }
        members.push(other);
    }
}

/// Some pieces of a part.
#[derive(Debug, Clone)]
struct PieceGroup<'a> {
    pieces: Vec<&'a Piece>,
    /// The different planes, one piece for each and each side.
    planes: Vec<&'a Piece>,
    vertices: Vec<u32>,
}

impl<'a> PieceGroup<'a> {
    fn new(pieces: Vec<&'a Piece>) -> Self {
        let mut planes = pieces.clone();
        planes.sort_unstable_by_key(|piece| (piece.plane, piece.is_reversed));
        planes.dedup_by_key(|piece| (piece.plane, piece.is_reversed));
        let mut vertices: Vec<u32> = pieces.iter().flat_map(|piece| piece.corners.iter().copied()).collect();
        vertices.sort_unstable();
        vertices.dedup();
        Self { pieces, planes, vertices }
    }

    fn joined(&self, other: &Self) -> Self {
        Self::new(self.pieces.iter().chain(&other.pieces).copied().collect())
    }

    /// Whether no vertex lies beyond a plane.
    fn is_convex(&self, points: &Points<'_>) -> bool {
        self.planes.iter().all(|plane| !self.vertices.iter().any(|v| points.is_beyond(*v, plane)))
    }

    /// Whether something of another group lies below all planes of this one.
    fn is_entered_by(&self, other: &Self, points: &Points<'_>) -> bool {
        let apart = |plane: &&Piece| other.vertices.iter().all(|v| !points.is_below(*v, plane));
        !self.planes.iter().any(apart) && other.pieces.iter().any(|piece| self.holds_some(piece, points))
    }

    /// Whether more of a piece than its border lies below all planes.
    fn holds_some(&self, piece: &Piece, points: &Points<'_>) -> bool {
        let mut corners: Vec<DVec3> = piece.corners.iter().map(|v| points.positions[*v as usize]).collect();
        let margin = piece.corners.iter().map(|v| points.slack(*v)).fold(0.0, f64::max);
        for plane in &self.planes {
            let flat = points.flat(plane.plane);
            let depth = |p: DVec3| if plane.is_reversed { flat.height(p) } else { -flat.height(p) } - margin;
            corners = clipped(&corners, depth);
            if corners.is_empty() {
                return false;
            }
        }
        true
    }
}

/// What of a convex polygon has a depth above zero.
fn clipped(corners: &[DVec3], depth: impl Fn(DVec3) -> f64) -> Vec<DVec3> {
    let n = corners.len();
    let mut kept = Vec::with_capacity(n + 1);
    for k in 0..n {
        let (p, q) = (corners[k], corners[(k + 1) % n]);
        let (a, b) = (depth(p), depth(q));
        if a > 0.0 {
            kept.push(p);
        }
        if (a > 0.0) != (b > 0.0) {
            kept.push(p + (q - p) * (a / (a - b)));
        }
    }
    kept
}

/// The sides that bound a lump: the part's walls, and the planes of pieces, each with the widest facet on it.
fn lump<'p>(part: &Part, pieces: impl Iterator<Item = &'p Piece>, points: &Points<'_>) -> Vec<PlaneSide> {
    let mut covers: Vec<(u32, bool, u32, f64)> =
        pieces.map(|p| (p.plane, p.is_reversed, p.facet, points.area(p).length())).collect();
    covers.sort_unstable_by_key(|(plane, is_above, facet, _)| (*plane, *is_above, *facet));
    covers.dedup_by(|b, a| {
        let is_same = (a.0, a.1, a.2) == (b.0, b.1, b.2);
        a.3 += if is_same { b.3 } else { 0.0 };
        is_same
    });
    let mut sides = part.walls.clone();
    for on_plane in covers.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        let widest = on_plane.iter().max_by(|a, b| a.3.total_cmp(&b.3));
        sides.extend(widest.map(|(plane, is_above, facet, _)| PlaneSide {
            plane: *plane,
            is_above: *is_above,
            facet: Some(*facet),
        }));
    }
    sides
}
