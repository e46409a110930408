//! A convex part of space with the pieces of the surface in it.

use std::cmp::Ordering;

use planecut_kernel::DVec3;
use rustc_hash::FxHashMap;

use super::edges::Edges;
use super::planes::{FloatPlane, Planes};
use super::polygon::area_vector;
use super::surface::Surface;

/// A side of a plane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct PlaneSide {
    pub(super) plane: u32,
    /// Whether it is the side above.
    pub(super) is_above: bool,
    /// A facet that lies on the plane there and has the solid on this side.
    pub(super) facet: Option<u32>,
}

/// A convex piece of a facet.
#[derive(Debug, Clone)]
pub(super) struct Piece {
    pub(super) plane: u32,
    /// Whether the solid lies above the plane.
    pub(super) is_reversed: bool,
    pub(super) facet: u32,
    pub(super) corners: Vec<u32>,
}

impl Piece {
    pub(super) fn edges(&self) -> impl Iterator<Item = (u32, u32)> + '_ {
        let next = self.corners.iter().cycle().skip(1);
        self.corners.iter().copied().zip(next.copied())
    }
}

/// What lies on one side of each of some planes: a convex part of space, and the pieces of the surface there.
#[derive(Debug, Clone)]
pub(super) struct Part {
    pub(super) walls: Vec<PlaneSide>,
    pub(super) pieces: Vec<Piece>,
}

/// The points of a surface and those that cuts make, and on which sides of planes they lie.
pub(super) struct Points<'a> {
    pub(super) positions: Vec<DVec3>,
    slack: Vec<f64>,
    float_planes: &'a [FloatPlane],
    /// Whether the surface ends nowhere.
    pub(super) is_closed: bool,
    /// Where an edge crosses a plane: neighbours find the same point.
    crossings: FxHashMap<(u32, u32, u32), u32>,
}

impl<'a> Points<'a> {
    pub(super) fn new(positions: Vec<DVec3>, slack: Vec<f64>, float_planes: &'a [FloatPlane], is_closed: bool) -> Self {
        Self { positions, slack, float_planes, is_closed, crossings: FxHashMap::default() }
    }

    pub(super) fn flat(&self, plane: u32) -> &FloatPlane {
        &self.float_planes[plane as usize]
    }

    /// On which side of a plane a point lies: greater is above. What is as near as points are exact is on it.
    pub(super) fn side(&self, point: u32, plane: u32) -> Ordering {
        let height = self.flat(plane).height(self.positions[point as usize]);
        if height.abs() <= self.slack[point as usize] { Ordering::Equal } else { height.total_cmp(&0.0) }
    }

    /// Whether a point that is not on a plane is so near that it might have been.
    pub(super) fn is_doubtful(&self, point: u32, plane: u32) -> bool {
        let height = self.flat(plane).height(self.positions[point as usize]).abs();
        let slack = self.slack[point as usize];
        height > slack && height <= 16.0 * slack
    }

    /// Whether a point lies beyond the plane of a piece, where its solid is not.
    pub(super) fn is_beyond(&self, point: u32, piece: &Piece) -> bool {
        self.side(point, piece.plane) == if piece.is_reversed { Ordering::Less } else { Ordering::Greater }
    }

    /// Whether a point lies below the plane of a piece, where its solid is.
    pub(super) fn is_below(&self, point: u32, piece: &Piece) -> bool {
        self.side(point, piece.plane) == if piece.is_reversed { Ordering::Greater } else { Ordering::Less }
    }

    /// How far a point may lie from planes that it is meant to be on.
    pub(super) fn slack(&self, point: u32) -> f64 {
        self.slack[point as usize]
    }

    /// Where an edge crosses a plane that its ends are on different sides of.
    fn crossing(&mut self, a: u32, b: u32, plane: u32) -> u32 {
        let (a, b) = (a.min(b), a.max(b));
        let next = self.positions.len() as u32;
        let known = *self.crossings.entry((a, b, plane)).or_insert(next);
        if known == next {
            let (p, q) = (self.positions[a as usize], self.positions[b as usize]);
            let flat = self.flat(plane);
            let (h, k) = (flat.height(p), flat.height(q));
            self.positions.push(p + (q - p) * (h / (h - k)));
            self.slack.push(self.slack[a as usize].max(self.slack[b as usize]));
        }
        known
    }

    /// Twice the area of a piece, along the normal of the facet.
    pub(super) fn area(&self, piece: &Piece) -> DVec3 {
        let corners: Vec<DVec3> = piece.corners.iter().map(|v| self.positions[*v as usize]).collect();
        area_vector(&corners)
    }

    /// Whether a piece is wider than points are exact.
    fn is_wide(&self, piece: &Piece) -> bool {
        let first = self.positions[piece.corners[0] as usize];
        let extent = |v: &u32| self.positions[*v as usize].distance(first);
        let extent = piece.corners.iter().map(extent).fold(0.0, f64::max);
        let slack = piece.corners.iter().map(|v| self.slack(*v)).fold(0.0, f64::max);
        self.area(piece).length() > 2.0 * slack * extent
    }

    /// What a plane leaves of a piece on one side of it.
    fn beside(&mut self, piece: &Piece, plane: u32, wanted: Ordering) -> Option<Piece> {
        let sides: Vec<Ordering> = piece.corners.iter().map(|v| self.side(*v, plane)).collect();
        if !sides.contains(&wanted) {
            return None;
        }
        if !sides.contains(&wanted.reverse()) {
            return Some(piece.clone());
        }
        let n = sides.len();
        let mut corners = Vec::with_capacity(n + 1);
        for k in 0..n {
            if sides[k] != wanted.reverse() {
                corners.push(piece.corners[k]);
            }
            let next = (k + 1) % n;
            if sides[k] != Ordering::Equal && sides[next] == sides[k].reverse() {
                corners.push(self.crossing(piece.corners[k], piece.corners[next], plane));
            }
        }
        Some(Piece { corners, ..*piece })
    }
}

impl Part {
    /// All of space and the whole surface.
    pub(super) fn whole(surface: &Surface, planes: &Planes) -> Self {
        let piece = |(t, corners): (usize, &[u32; 3])| Piece {
            plane: planes.of_triangle[t],
            is_reversed: planes.is_reversed[t],
            facet: surface.facet_of[t],
            corners: corners.to_vec(),
        };
        Self { walls: Vec::new(), pieces: surface.triangles.iter().enumerate().map(piece).collect() }
    }

    /// Drops sheets of slivers: what they enclose is noise. Tells whether there were any.
    pub(super) fn drop_slivers(&mut self, edges: &Edges, points: &Points<'_>) -> bool {
        let mut is_wide = vec![false; edges.sheets];
        for (piece, sheet) in self.pieces.iter().zip(&edges.sheet_of) {
            let known = &mut is_wide[*sheet as usize];
            *known = *known || points.is_wide(piece);
        }
        let mut sheets = edges.sheet_of.iter();
        self.pieces.retain(|_| sheets.next().is_some_and(|sheet| is_wide[*sheet as usize]));
        is_wide.contains(&false)
    }

    /// What lies below a plane of one of the pieces, and what lies above; each is `None` where there is no solid.
    pub(super) fn cut(self, points: &mut Points<'_>, plane: u32) -> [Option<Self>; 2] {
        let [below, on, above] = divided(self.pieces, points, plane);
        let covers = Covers::of(points, &on, plane);
        let part = |mut pieces: Vec<Piece>, is_above: bool| {
            if !pieces.iter().any(|piece| points.is_wide(piece)) {
                pieces.clear();
            }
            let wall = PlaneSide { plane, is_above, facet: covers.widest(is_above) };
            let has_solid = !pieces.is_empty() || covers.is_solid(is_above);
            has_solid.then(|| Self { walls: self.walls.iter().copied().chain([wall]).collect(), pieces })
        };
        [part(below, false), part(above, true)]
    }

    /// What lies below a plane of one of the pieces, and what lies above, whether or not there is solid. Pieces on the plane go, and those that are no
    /// wider than points are exact.
    pub(super) fn halves(self, points: &mut Points<'_>, plane: u32) -> [Self; 2] {
        let [below, on, above] = divided(self.pieces, points, plane);
        let covers = Covers::of(points, &on, plane);
        let part = |mut pieces: Vec<Piece>, is_above: bool| {
            pieces.retain(|piece| points.is_wide(piece));
            let wall = PlaneSide { plane, is_above, facet: covers.widest(is_above) };
            Self { walls: self.walls.iter().copied().chain([wall]).collect(), pieces }
        };
        [part(below, false), part(above, true)]
    }
}

/// The pieces below a plane, on it and above.
fn divided(pieces: Vec<Piece>, points: &mut Points<'_>, plane: u32) -> [Vec<Piece>; 3] {
    let (mut below, mut on, mut above) = (Vec::new(), Vec::new(), Vec::new());
    for piece in pieces {
        if piece.plane == plane {
            on.push(piece);
            continue;
        }
        let (low, high) =
            (points.beside(&piece, plane, Ordering::Less), points.beside(&piece, plane, Ordering::Greater));
        if low.is_none() && high.is_none() {
            on.push(piece);
            continue;
        }
        below.extend(low);
        above.extend(high);
    }
    [below, on, above]
}

/// The facets on a plane that cuts a part, with the area of each whose solid lies below and above.
struct Covers {
    below: Vec<(u32, f64)>,
    above: Vec<(u32, f64)>,
}

impl Covers {
    fn of(points: &Points<'_>, pieces: &[Piece], plane: u32) -> Self {
        let normal = points.flat(plane).normal();
        let mut covers = Self { below: Vec::new(), above: Vec::new() };
        for piece in pieces {
            let area = points.area(piece).dot(normal);
            let side = if area > 0.0 { &mut covers.below } else { &mut covers.above };
            match side.iter_mut().find(|(facet, _)| *facet == piece.facet) {
                Some((_, sum)) => *sum += area.abs(),
                None => side.push((piece.facet, area.abs())),
            }
        }
        covers
    }

    fn side(&self, is_above: bool) -> &[(u32, f64)] {
        if is_above { &self.above } else { &self.below }
    }

    /// Whether a side on which nothing else is has the solid.
    fn is_solid(&self, is_above: bool) -> bool {
        let area = |is_above: bool| self.side(is_above).iter().map(|(_, area)| area).sum::<f64>();
        area(is_above) > area(!is_above)
    }

    fn widest(&self, is_above: bool) -> Option<u32> {
        self.side(is_above).iter().max_by(|a, b| a.1.total_cmp(&b.1)).map(|(facet, _)| *facet)
    }
}
