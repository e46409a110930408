//! A convex polygon on a plane, bounded by the lines of other planes.

use std::cmp::Ordering;

use planecut_kernel::sign::Sign;

use super::BoundaryEdge;
use super::signs::Signs;
use crate::base::Bounds;
use crate::body::{Corner, PlaneFilter};
use crate::plane_table::{PlaneId, PlaneTable};

/// A convex polygon on `plane`: edge `i` lies on the line of `edges[i]`, whose normal points away from the polygon;
/// corner `i` lies between the edges `i` and `i + 1`, where `plane`, `edges[i]`, `edges[i + 1]` are right-handed.
#[derive(Debug, Clone, Default)]
pub(super) struct Polygon {
    pub(super) edges: Vec<PlaneId>,
    pub(super) corners: Vec<Corner>,
}

/// What clipping left of a polygon.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Clip {
    /// All of it.
    Whole,
    /// A part.
    Part,
    /// Nothing with an area.
    Nothing,
}

impl Polygon {
    pub(super) fn copy_from(&mut self, other: &Self) {
        self.set(&other.edges, other.corners.iter());
    }

    pub(super) fn set<'a>(&mut self, edges: &[PlaneId], corners: impl Iterator<Item = &'a Corner>) {
        self.edges.clear();
        self.edges.extend_from_slice(edges);
        self.corners.clear();
        self.corners.extend(corners.copied());
    }

    /// The three planes of corner `i`.
    pub(super) fn corner(&self, plane: PlaneId, i: usize) -> [PlaneId; 3] {
        [plane, self.edges[i], self.edges[after(i, self.edges.len())]]
    }

    /// Keeps what lies inside `cut`.
    pub(super) fn clip(&mut self, signs: Signs<'_>, plane: PlaneId, cut: PlaneId, spare: &mut Self) -> Clip {
        let clip = self.inside_of(signs, plane, cut, spare);
        if clip == Clip::Part {
            std::mem::swap(self, spare);
        }
        clip
    }

    /// What lies inside `cut`; `out` is that part where it is [`Clip::Part`], else of no meaning. The sign at each corner is the true three-way one.
    pub(super) fn inside_of(&self, signs: Signs<'_>, plane: PlaneId, cut: PlaneId, out: &mut Self) -> Clip {
        let n = self.edges.len();
        // Which corners are strictly inside; polygons of more than 64 corners take the slow way.
        let mut inside = Inside::new(n);
        let (mut some_inside, mut some_outside, mut some_open) = (false, false, false);
        let filter = PlaneFilter::new(signs.table.half_space(cut));
        // without a branch, which would mostly be guessed wrong
        for (i, corner) in self.corners.iter().enumerate() {
            let [is_inside, is_outside] = filter.is_surely(corner);
            inside.set(i, is_inside);
            some_inside |= is_inside;
            some_outside |= is_outside;
            some_open |= !(is_inside | is_outside);
        }
        if some_open {
            for (i, corner) in self.corners.iter().enumerate() {
                let side = signs.settled(filter.side(corner), || self.corner(plane, i), cut);
                inside.set(i, side == Sign::Negative);
                some_inside |= side == Sign::Negative;
                some_outside |= side == Sign::Positive;
            }
        }
        if !some_outside {
            return Clip::Whole;
        }
        if !some_inside {
            return Clip::Nothing;
        }
        // The last corner strictly inside before the cut begins; edge `i` runs from corner `i − 1` to corner `i`.
        let (first, last) = inside.run(n);
        let (leaving, entering) = (self.edges[after(last, n)], self.edges[first]);
        let ends = |inside: usize, other: usize| [&self.corners[inside], &self.corners[other]];
        let cut_off = crossing(signs.table, &filter, ends(last, after(last, n)), [plane, leaving, cut]);
        let cut_in = crossing(signs.table, &filter, ends(first, before(first, n)), [plane, cut, entering]);
        // Kept are the edges that touch a corner strictly inside: from edge `first` to edge `last + 1`.
        out.edges.clear();
        out.corners.clear();
        let runs = if first <= last { [first..last + 1, 0..0] } else { [first..n, 0..last + 1] };
        for run in runs {
            out.edges.extend_from_slice(&self.edges[run.clone()]);
            out.corners.extend_from_slice(&self.corners[run]);
        }
        out.edges.extend([leaving, cut]);
        out.corners.extend([cut_off, cut_in]);
        Clip::Part
    }

    /// Names an edge that lies on the line of another plane by that plane, where there is one; no corner lies outside of it.
    pub(super) fn name_edge_by(&mut self, signs: Signs<'_>, plane: PlaneId, other: PlaneId) {
        let n = self.corners.len();
        let filter = PlaneFilter::new(signs.table.half_space(other));
        let mut on = Inside::new(n);
        let mut count = 0;
        for (i, corner) in self.corners.iter().enumerate() {
            if filter.side(corner) != Sign::Negative && signs.side(corner, self.corner(plane, i), other) == Sign::Zero {
                on.set(i, true);
                count += 1;
            }
        }
        if count >= 2 {
            // two corners on a line are the ends of an edge
            let (_, last) = on.run(n);
            self.edges[last] = other;
        }
    }

    pub(super) fn bounds(&self) -> Bounds {
        self.corners.iter().fold(Bounds::EMPTY, |bounds, corner| bounds.with_corner(corner))
    }

    /// A box around edge `i`.
    pub(super) fn edge_bounds(&self, i: usize) -> Bounds {
        Bounds::EMPTY.with_corner(&self.corners[before(i, self.corners.len())]).with_corner(&self.corners[i])
    }
}

/// A set of corners.
enum Inside {
    Few(u64),
    Many(Vec<bool>),
}

impl Inside {
    fn new(n: usize) -> Self {
        if n <= 64 { Self::Few(0) } else { Self::Many(vec![false; n]) }
    }

    /// Adds corner `i` where it is inside.
    fn set(&mut self, i: usize, is_inside: bool) {
        match self {
            Self::Few(bits) => *bits |= u64::from(is_inside) << i,
            Self::Many(flags) => flags[i] |= is_inside,
        }
    }

    /// The first and the last of some corners that follow one another around a polygon of `n`, and after which there is one that is not of
    /// the set; some are, and some are not.
    fn run(&self, n: usize) -> (usize, usize) {
        match self {
            Self::Few(bits) => {
                let next = bits >> 1 | (bits & 1) << (n - 1);
                let last = (bits & !next).trailing_zeros();
                // in two steps: all bits at once are too many to shift by
                let later = bits >> last >> 1;
                let first = if later == 0 { bits.trailing_zeros() } else { last + 1 + later.trailing_zeros() };
                (first as usize, last as usize)
            }
            Self::Many(flags) => {
                let last = (0..n).find(|i| flags[*i] && !flags[after(*i, n)]);
                let last = last.expect("some corners are strictly inside and some are not");
                let first = (1..=n).map(|k| (last + k) % n).find(|i| flags[*i]).expect("the last corner inside is one");
                (first, last)
            }
        }
    }
}

/// The number after another around a polygon of `n`.
fn after(i: usize, n: usize) -> usize {
    if i + 1 == n { 0 } else { i + 1 }
}

/// The number before another around a polygon of `n`.
fn before(i: usize, n: usize) -> usize {
    if i == 0 { n - 1 } else { i - 1 }
}

/// A piece of the line of `plane` and `edge`, directed along `n_plane × n_edge`, between two planes that end it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Piece {
    pub(super) start: PlaneId,
    pub(super) end: PlaneId,
    pub(super) start_point: Corner,
    pub(super) end_point: Corner,
}

impl Piece {
    /// The piece of edge `i` of a polygon.
    pub(super) fn of_edge(Polygon { edges, corners }: &Polygon, i: usize) -> Self {
        let (before, after) = (before(i, edges.len()), after(i, edges.len()));
        Self { start: edges[before], end: edges[after], start_point: corners[before], end_point: corners[i] }
    }

    /// All of a boundary edge, whose ends may be named by either side of a plane.
    pub(super) fn of_boundary(table: &PlaneTable, &BoundaryEdge { face, edge, start, end, .. }: &BoundaryEdge) -> Self {
        let line = Line { plane: face, edge };
        let start = if line.looks_ahead(table, start) { start.flipped() } else { start };
        let end = if line.looks_ahead(table, end) { end } else { end.flipped() };
        let [start_point, end_point] = [line.start(start), line.end(end)].map(|planes| meet(table, planes));
        Self { start, end, start_point, end_point }
    }

    pub(super) fn start_side(&self, signs: Signs<'_>, line: Line, plane: PlaneId) -> Sign {
        signs.side(&self.start_point, line.start(self.start), plane)
    }

    pub(super) fn end_side(&self, signs: Signs<'_>, line: Line, plane: PlaneId) -> Sign {
        signs.side(&self.end_point, line.end(self.end), plane)
    }

    /// The same seen along the line the other way.
    pub(super) fn reversed(self) -> Self {
        Self { start: self.end, end: self.start, start_point: self.end_point, end_point: self.start_point }
    }

    pub(super) fn bounds(&self) -> Bounds {
        Bounds::EMPTY.with_corner(&self.start_point).with_corner(&self.end_point)
    }
}

/// The directed line of `n_plane × n_edge`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    pub(super) plane: PlaneId,
    pub(super) edge: PlaneId,
}

/// Where a plane meets a line.
#[derive(Debug, Clone, Copy)]
pub(super) struct Meeting {
    pub(super) plane: PlaneId,
    /// Whether the normal of the plane looks back along the line, as that of the plane at which a piece starts.
    pub(super) looks_back: bool,
    pub(super) point: Corner,
}

/// How a convex polygon covers a piece of a line.
#[derive(Debug, Clone, Copy)]
pub(super) enum Cover {
    /// Nowhere along it.
    Apart,
    /// This part of the piece, with the interior of the polygon on both sides.
    Across(Piece),
    /// This part of the piece lies on the edge line of the polygon that `edge` bounds.
    Along(Piece, PlaneId),
}

impl Cover {
    /// Whether all of a piece lies in the polygon.
    pub(super) fn is_whole(&self, piece: &Piece) -> bool {
        matches!(self, Self::Across(part) if (part.start, part.end) == (piece.start, piece.end))
    }
}

impl Line {
    /// The right-handed planes of a point at which a piece starts.
    pub(super) fn start(self, start: PlaneId) -> [PlaneId; 3] {
        [self.plane, start, self.edge]
    }

    /// The right-handed planes of a point at which a piece ends.
    pub(super) fn end(self, end: PlaneId) -> [PlaneId; 3] {
        [self.plane, self.edge, end]
    }

    /// The planes of the point where one meets the line.
    fn planes_at(self, plane: PlaneId, looks_back: bool) -> [PlaneId; 3] {
        if looks_back { self.start(plane) } else { self.end(plane) }
    }

    /// Where a plane meets the line, of which it is known how it looks.
    pub(super) fn meeting(self, table: &PlaneTable, plane: PlaneId, looks_back: bool) -> Meeting {
        Meeting { plane, looks_back, point: meet(table, self.planes_at(plane, looks_back)) }
    }

    /// On which side of a plane a point of the line lies.
    pub(super) fn side(self, signs: Signs<'_>, at: &Meeting, plane: PlaneId) -> Sign {
        signs.side(&at.point, self.planes_at(at.plane, at.looks_back), plane)
    }

    /// The exact order of two points along the line.
    pub(super) fn compare(self, signs: Signs<'_>, a: &Meeting, b: &Meeting) -> Ordering {
        if a.plane.index() == b.plane.index() {
            return Ordering::Equal;
        }
        match (self.side(signs, a, b.plane), b.looks_back) {
            (Sign::Zero, _) => Ordering::Equal,
            (Sign::Positive, false) | (Sign::Negative, true) => Ordering::Greater,
            (Sign::Negative, false) | (Sign::Positive, true) => Ordering::Less,
        }
    }

    /// Whether the normal of a plane that the line meets looks along it.
    pub(super) fn looks_ahead(self, table: &PlaneTable, plane: PlaneId) -> bool {
        table.orient3(self.plane, self.edge, plane) == Sign::Positive
    }

    /// The part of a piece that lies in a convex polygon on the same plane.
    pub(super) fn cover(self, signs: Signs<'_>, piece: &Piece, polygon: &Polygon) -> Cover {
        let mut part = *piece;
        let mut along = None;
        for &edge in &polygon.edges {
            // most edges are far away, and plain numbers tell on which side
            let filter = PlaneFilter::new(signs.table.half_space(edge));
            let (start, end) = (filter.side(&part.start_point), filter.side(&part.end_point));
            if start == Sign::Negative && end == Sign::Negative {
                continue;
            }
            let crossing = |planes| crossing(signs.table, &filter, [&part.start_point, &part.end_point], planes);
            let start = signs.settled(start, || self.start(part.start), edge);
            let end = signs.settled(end, || self.end(part.end), edge);
            match (start == Sign::Positive, end == Sign::Positive) {
                (false, false) => {
                    if start == Sign::Zero && end == Sign::Zero {
                        along = Some(edge);
                    }
                }
                (true, true) => return Cover::Apart,
                (true, false) => {
                    if end == Sign::Zero {
                        return Cover::Apart;
                    }
                    part.start = edge;
                    part.start_point = crossing(self.start(edge));
                }
                (false, true) => {
                    if start == Sign::Zero {
                        return Cover::Apart;
                    }
                    part.end = edge;
                    part.end_point = crossing(self.end(edge));
                }
            }
        }
        match along {
            Some(edge) => Cover::Along(part, edge),
            None => Cover::Across(part),
        }
    }

    /// Takes `cover` out of `pieces`; both lie on this line.
    pub(super) fn subtract(self, signs: Signs<'_>, pieces: &mut Vec<Piece>, cover: &Piece) {
        let mut k = 0;
        while k < pieces.len() {
            let piece = pieces[k];
            if (piece.start, piece.end) == (cover.start, cover.end) {
                pieces.swap_remove(k);
                continue;
            }
            // outward normals: the start plane of the cover looks back along the line, its end plane looks ahead
            let ends_before = piece.end_side(signs, self, cover.start) != Sign::Negative;
            let starts_after = piece.start_side(signs, self, cover.end) != Sign::Negative;
            if ends_before || starts_after {
                k += 1;
                continue;
            }
            let head = piece.start_side(signs, self, cover.start) == Sign::Positive;
            let tail = piece.end_side(signs, self, cover.end) == Sign::Positive;
            let before = || Piece { end: cover.start.flipped(), end_point: cover.start_point, ..piece };
            let after = || Piece { start: cover.end.flipped(), start_point: cover.end_point, ..piece };
            match (head, tail) {
                (true, true) => {
                    pieces[k] = before();
                    pieces.push(after());
                    k += 1;
                }
                (true, false) => {
                    pieces[k] = before();
                    k += 1;
                }
                (false, true) => {
                    pieces[k] = after();
                    k += 1;
                }
                (false, false) => {
                    pieces.swap_remove(k);
                }
            }
        }
    }

    /// Whether two polygons on `plane` lie on the same side of the line, which `edge` of this and `other` both bound.
    ///
    /// Both normals are perpendicular to the line, so the directions agree where the lines `n_plane × n_edge` do.
    pub(super) fn is_same_side(self, table: &PlaneTable, other: PlaneId) -> bool {
        if other.index() == self.edge.index() {
            return other == self.edge;
        }
        let along = |axis: usize| {
            (table.cross_component(self.plane, self.edge, axis), table.cross_component(self.plane, other, axis))
        };
        (0..3).map(along).find(|(a, _)| *a != Sign::Zero).is_none_or(|(a, b)| a == b)
    }
}

/// Where a plane crosses an edge, of which both ends are given, in the meeting point of three planes.
fn crossing(table: &PlaneTable, filter: &PlaneFilter, [from, to]: [&Corner; 2], planes: [PlaneId; 3]) -> Corner {
    filter.crossing(from, to).unwrap_or_else(|| meet(table, planes))
}

/// Where three planes meet.
fn meet(table: &PlaneTable, planes: [PlaneId; 3]) -> Corner {
    Corner::new(&table.homogeneous(planes))
}

#[cfg(test)]
mod tests {
    use planecut_testkit::random::Rng;

    use super::*;

    /// Few corners are told by bits, of which runs that go on at the front, and all 64 at once, are the hard ones.
    #[test]
    fn runs_of_few_corners_are_those_of_many() {
        let mut rng = Rng::new(7);
        let mut around_the_end = 0;
        for n in (2..=64_usize).chain([63, 64].repeat(200)) {
            let start = rng.below(n);
            let length = 1 + rng.below(n - 1);
            let (mut few, mut many) = (Inside::new(n), Inside::Many(vec![false; n]));
            for i in (start..start + length).map(|i| i % n) {
                few.set(i, true);
                many.set(i, true);
            }
            assert!(matches!(few, Inside::Few(_)));
            assert_eq!(few.run(n), (start, (start + length - 1) % n), "{length} of {n} from {start}");
            assert_eq!(few.run(n), many.run(n), "{length} of {n} from {start}");
            around_the_end += usize::from(start + length > n);
        }
        assert!(around_the_end > 50, "{around_the_end} runs go on at the front");
    }
}
