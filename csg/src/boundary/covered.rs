//! The edges of the boundary on a face, where one more body covers a part of it.
//!
//! A body that comes after all others and adds or takes away leaves no boundary on the faces of others inside of it, and all of it outside. So
//! the edges known are cut off where they enter it, and its section ends the boundary where this lies on the outer side of the section's edges: on
//! which parts of them, is told by the known edges that cross them. Edges are crossed at points just outside of the section, so that ends of known edges on the line count
//! as inside, and one that runs along it is not crossed.

use planecut_kernel::DVec3;
use planecut_kernel::sign::Sign;

use super::clip::{Clipper, Cutter};
use super::contact::Facing;
use super::section::{Clip, Cover, Line, Meeting, Piece, Polygon};
use super::signs::Signs;
use super::{BoundaryEdge, EdgeChange, KnownEdge};
use crate::base::Bounds;
use crate::body::{Body, BodyFace};
use crate::ids::{EdgeId, holds};
use crate::plane_table::PlaneId;

/// On faces of more edges not all of them are held against each edge of a section.
const MOST_EDGES: usize = 96;

/// Whether it is told by a body and the edges known on a face alone what it leaves of them: the body has no face on the plane, where it depends on others who
/// owns the boundary, and the edges are not very many.
pub(crate) fn can_cover(body: &Body, face: &BodyFace, known: &[KnownEdge]) -> bool {
    known.len() <= MOST_EDGES && body.face_on(face.plane).is_none()
}

/// Tells what one more body covers, reusing its buffers.
#[derive(Debug, Default)]
pub(super) struct CoverWorker {
    section: Polygon,
    pieces: Vec<Piece>,
    /// The boxes of the known edges, and these as pieces, where it has been asked.
    known: Vec<(Bounds, Option<Piece>)>,
    /// Parts of known edges that run along edges of the section, with boundary on the outer side: the planes of the section's edges, those of the boundary, and the parts.
    outside: Vec<(PlaneId, PlaneId, Piece)>,
    /// Where the line of an edge of the section enters the boundary on the face, at planes that look back, or leaves it.
    crossings: Vec<Meeting>,
}

impl CoverWorker {
    /// How the edges known on a face, sorted, change where another body comes that covers the part of it within, all sides of it; `rounded` are the correctly rounded ends of an edge.
    /// [`can_cover`] says where it may be asked. Nothing where the crossings make no sense.
    pub(super) fn change(
        &mut self,
        clipper: &mut Clipper,
        cutter: Cutter<'_>,
        region: &Polygon,
        known: &[KnownEdge],
        rounded: impl Fn(EdgeId) -> [DVec3; 2],
    ) -> Option<EdgeChange> {
        let Cutter { signs, face, .. } = cutter;
        let table = signs.table;
        let mut change = EdgeChange::default();
        clipper.look_at(region);
        match clipper.clip(cutter, region, &mut self.section) {
            Clip::Nothing => return Some(change),
            Clip::Whole => {
                change.removed.extend((0..).zip(known).map(|(place, _)| place));
                return Some(change);
            }
            Clip::Part => {}
        }
        let bounds = self.section.bounds();
        let near = bounds.with_room();
        self.known.clear();
        self.outside.clear();
        for (place, (edge, number)) in (0..).zip(known) {
            let [a, b] = rounded(*number);
            let bounds = Bounds::around(a, b);
            if !bounds.touches(&near) {
                self.known.push((bounds, None));
                continue;
            }
            let whole = Piece::of_boundary(table, edge);
            self.known.push((bounds, Some(whole)));
            let line = Line { plane: edge.face, edge: edge.edge };
            let covered = match line.cover(signs, &whole, &self.section) {
                Cover::Apart => continue,
                Cover::Across(part) => part,
                Cover::Along(part, other) if line.is_same_side(table, other) => part,
                Cover::Along(part, other) => {
                    // seen from the other side of the face it runs the other way
                    let is_out = edge.face == face.plane;
                    let part = if is_out { part.reversed() } else { part };
                    self.outside.push((other, edge.face, part));
                    continue;
                }
            };
            self.pieces.clear();
            self.pieces.push(whole);
            line.subtract(signs, &mut self.pieces, &covered);
            change.removed.push(place);
            let rest = |rest: &Piece| BoundaryEdge { start: rest.start, end: rest.end, ..*edge };
            change.added.extend(self.pieces.iter().map(rest));
        }
        for i in 0..self.section.edges.len() {
            let edge = self.section.edges[i];
            if holds(&region.edges, edge) {
                continue;
            }
            let whole = Piece::of_edge(&self.section, i);
            let line = Line { plane: face.plane, edge };
            for facing in Facing::BOTH {
                let side = if facing == Facing::Out { face.plane } else { face.plane.flipped() };
                self.find_crossings(signs, line, facing, side, known);
                self.find_pieces(signs, line, &whole)?;
                for (.., known) in self.outside.iter().filter(|(other, of, _)| (*other, *of) == (edge, side)) {
                    line.subtract(signs, &mut self.pieces, known);
                }
                let right = |piece: &Piece| BoundaryEdge::right(face, facing, edge, piece.start, piece.end);
                change.added.extend(self.pieces.iter().map(right));
            }
        }
        change.added.sort_unstable();
        Some(change)
    }

    /// Finds where the line of an edge of the section, on its outer side, enters and leaves the boundary that faces one way.
    fn find_crossings(&mut self, signs: Signs<'_>, line: Line, facing: Facing, side: PlaneId, known: &[KnownEdge]) {
        self.crossings.clear();
        let half_space = signs.table.half_space(line.edge);
        let of_side = known.iter().zip(&mut self.known).filter(|((edge, _), _)| edge.face == side);
        for ((edge, _), (bounds, piece)) in of_side {
            // most lie on one side, and that the ends are rounded is less than the room that this leaves
            let (low, high) = bounds.extent_along(half_space.normal(), half_space.offset());
            if low > 0.0 || high < 0.0 {
                continue;
            }
            let piece = piece.get_or_insert_with(|| Piece::of_boundary(signs.table, edge));
            let of_known = Line { plane: edge.face, edge: edge.edge };
            let starts = piece.start_side(signs, of_known, line.edge) == Sign::Positive;
            let ends = piece.end_side(signs, of_known, line.edge) == Sign::Positive;
            if starts == ends {
                continue;
            }
            // the boundary lies to the left of its edges, seen from where it faces
            let enters = ends == (facing == Facing::Out);
            self.crossings.push(line.meeting(signs.table, edge.edge, enters));
        }
    }

    /// Leaves in `pieces` the parts of an edge of the section along which there is boundary on its outer side; nothing where the crossings make no sense.
    fn find_pieces(&mut self, signs: Signs<'_>, line: Line, whole: &Piece) -> Option<()> {
        let step = |crossing: &Meeting| if crossing.looks_back { 1 } else { -1 };
        // those before the edge tell what is at its beginning
        let mut now = 0;
        self.crossings.retain(|crossing| {
            let is_within = |end: PlaneId| line.side(signs, crossing, end) == Sign::Negative;
            let is_after_start = is_within(whole.start);
            if !is_after_start {
                now += step(crossing);
            }
            is_after_start && is_within(whole.end)
        });
        self.crossings.sort_by(|a, b| line.compare(signs, a, b));
        self.pieces.clear();
        // what is left from here on
        let mut rest = *whole;
        for here in self.crossings.chunk_by(|a, b| line.compare(signs, a, b).is_eq()) {
            let before = now;
            now += here.iter().map(step).sum::<i32>();
            if before.min(now) < 0 || before.max(now) > 1 {
                return None;
            }
            if before != now {
                let Meeting { plane, point, .. } =
                    *here.iter().find(|crossing| crossing.looks_back == (now > before))?;
                if now > before {
                    (rest.start, rest.start_point) = (plane, point);
                } else {
                    self.pieces.push(Piece { end: plane, end_point: point, ..rest });
                }
            }
        }
        if !(0..=1).contains(&now) {
            return None;
        }
        self.pieces.extend((now == 1).then_some(rest));
        Some(())
    }
}
