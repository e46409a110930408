//! The general case of a face: along each edge the tree is evaluated to the left and to the right.
//!
//! Where bodies neither cover the face nor are required by themselves, it depends on several of them at once whether a place
//! is boundary. So each edge of the region and of every section is cut at the edges of the other sections; between two cuts
//! all bodies are known on both sides, and where the two sides differ, the edge is one of the boundary.

use super::contact::Facing;
use super::face::Section;
use super::ownership::{EdgeSide, Ownership};
use super::section::{Cover, Line, Meeting, Piece, Polygon};
use super::signs::Signs;
use super::{BoundaryEdge, Scene};
use crate::body::BodyFace;
use crate::expression::{Expression, Restriction};
use crate::ids::{Id, SectionId, holds};
use crate::plane_table::PlaneId;

/// Where along a line a section begins or ends to cover one or both sides.
#[derive(Debug, Clone, Copy)]
struct Event {
    section: SectionId,
    sides: [bool; 2],
    /// Where an edge of the section is met: it begins where the plane looks back along the line.
    at: Meeting,
}

/// Buffers of the sweep along edges.
#[derive(Debug, Default)]
pub(super) struct Sweep {
    pieces: Vec<Piece>,
    /// The planes that end the whole edge.
    ends: Option<[PlaneId; 2]>,
    /// The sections that may cover parts of the pieces, and how each covers the whole edge, where that is known.
    beside: Vec<(SectionId, Option<Cover>)>,
    events: Vec<Event>,
    /// The sections that cover sides of the piece, until each is let go.
    covering: Vec<(SectionId, [bool; 2])>,
    /// The section that covered all of an edge last: it mostly covers the next one, too.
    last: Option<SectionId>,
}

/// What stays the same during the sweep over one face.
pub(super) struct Context<'a> {
    pub(super) scene: &'a Scene<'a>,
    pub(super) signs: Signs<'a>,
    pub(super) face: &'a BodyFace,
    pub(super) sections: &'a [Section],
    /// As many sections at the front cover the face whatever the others do.
    pub(super) covering: usize,
}

impl Sweep {
    /// Emits all boundary edges on a face; where nothing is covered, `restriction` and `ownership` hold what is known of it.
    pub(super) fn emit(
        &mut self,
        context: &Context<'_>,
        region: &Polygon,
        restriction: &mut Restriction,
        ownership: &mut Ownership,
        out: &mut Vec<BoundaryEdge>,
    ) {
        self.last = None;
        for i in 0..region.edges.len() {
            self.pieces.clear();
            self.pieces.push(Piece::of_edge(region, i));
            self.drop_silent(context, region.edges[i], None);
            self.sweep_pieces(context, region.edges[i], None, restriction, ownership, out);
        }
        for (k, section) in context.sections.iter().enumerate() {
            let polygon = &section.polygon;
            for (i, &edge) in polygon.edges.iter().enumerate().filter(|(_, edge)| !holds(&region.edges, **edge)) {
                self.pieces.clear();
                self.pieces.push(Piece::of_edge(polygon, i));
                let k = SectionId::from_index(k);
                self.drop_silent(context, edge, Some(k));
                self.sweep_pieces(context, edge, Some(k), restriction, ownership, out);
            }
        }
    }

    /// Takes out of the pieces of an edge of section `own`, or of the region, what is covered on both sides, and what lies on edges of
    /// earlier sections: these emit it. Finds the sections that matter to the rest.
    fn drop_silent(&mut self, context: &Context<'_>, edge: PlaneId, own: Option<SectionId>) {
        let line = Line { plane: context.face.plane, edge };
        let whole = self.pieces[0];
        let bounds = whole.bounds();
        self.ends = Some([whole.start, whole.end]);
        self.beside.clear();
        let cover = |k: SectionId| line.cover(context.signs, &whole, &context.sections[k.index()].polygon);
        let is_near = |k: SectionId| own != Some(k) && context.sections[k.index()].bounds.touches(&bounds);
        let mut last = self.last.filter(|last| is_near(*last)).map(|last| (last, cover(last)));
        if last.as_ref().is_some_and(|(_, cover)| cover.is_whole(&whole)) {
            self.pieces.clear();
            return;
        }
        for k in SectionId::all(context.sections.len()) {
            let covers = k.index() < context.covering;
            let is_earlier = own.is_some_and(|own| k < own);
            if self.pieces.is_empty() {
                break;
            }
            if !is_near(k) {
                continue;
            }
            if !covers && !is_earlier {
                self.beside.push((k, None));
                continue;
            }
            let (_, cover) = last.take_if(|(last, _)| *last == k).unwrap_or_else(|| (k, cover(k)));
            if covers && cover.is_whole(&whole) {
                self.last = Some(k);
            }
            match cover {
                Cover::Along(part, _) if is_earlier => line.subtract(context.signs, &mut self.pieces, &part),
                Cover::Across(part) if covers => line.subtract(context.signs, &mut self.pieces, &part),
                Cover::Apart => {}
                Cover::Along(..) | Cover::Across(_) => self.beside.push((k, Some(cover))),
            }
        }
    }

    /// Sweeps along the pieces, which lie on an edge of section `own`, or of the region where there is none.
    fn sweep_pieces(
        &mut self,
        context: &Context<'_>,
        edge: PlaneId,
        own: Option<SectionId>,
        restriction: &mut Restriction,
        ownership: &mut Ownership,
        out: &mut Vec<BoundaryEdge>,
    ) {
        let line = Line { plane: context.face.plane, edge };
        for k in 0..self.pieces.len() {
            let piece = self.pieces[k];
            self.covering.clear();
            self.covering.extend(own.map(|own| (own, [true, false])));
            self.find_events(context, line, &piece);
            self.events.sort_by(|a, b| line.compare(context.signs, &a.at, &b.at));
            let expression = context.scene.expression;
            let mut walk =
                Walk { context, restriction, ownership, edge, outer: own.is_none(), start: piece.start, now: None };
            for (section, sides) in &self.covering {
                walk.change(expression, *section, *sides, true);
            }
            walk.now = walk.labels();
            let mut at = 0;
            while at < self.events.len() {
                let (place, first) = (self.events[at], at);
                while let Some(event) =
                    self.events.get(at).filter(|e| line.compare(context.signs, &e.at, &place.at).is_eq())
                {
                    walk.change(expression, event.section, event.sides, event.at.looks_back);
                    self.note(*event);
                    at += 1;
                }
                walk.pass(place.at.plane, at - first > 1, out);
            }
            walk.end(piece.end, out);
            for (section, sides) in &self.covering {
                walk.change(expression, *section, *sides, false);
            }
        }
    }

    /// Keeps the list of what covers.
    fn note(&mut self, event: Event) {
        if event.at.looks_back {
            self.covering.push((event.section, event.sides));
        } else if let Some(k) = self.covering.iter().position(|(section, _)| *section == event.section) {
            self.covering.swap_remove(k);
        }
    }

    /// Finds what covers the beginning of a piece, and where that changes.
    fn find_events(&mut self, context: &Context<'_>, line: Line, piece: &Piece) {
        let bounds = piece.bounds();
        let is_whole = self.ends == Some([piece.start, piece.end]);
        self.events.clear();
        for &(section, known) in &self.beside {
            let other = &context.sections[section.index()];
            if !other.bounds.touches(&bounds) {
                continue;
            }
            let known = known.filter(|_| is_whole);
            let (part, sides) = match known.unwrap_or_else(|| line.cover(context.signs, piece, &other.polygon)) {
                Cover::Apart => continue,
                Cover::Across(part) => (part, [true, true]),
                Cover::Along(part, edge) if line.is_same_side(context.scene.table, edge) => (part, [true, false]),
                Cover::Along(part, _) => (part, [false, true]),
            };
            if part.start == piece.start {
                self.covering.push((section, sides));
            } else {
                let at = Meeting { plane: part.start, looks_back: true, point: part.start_point };
                self.events.push(Event { section, sides, at });
            }
            if part.end != piece.end {
                let at = Meeting { plane: part.end, looks_back: false, point: part.end_point };
                self.events.push(Event { section, sides, at });
            }
        }
    }
}

/// The state on the way along one piece.
struct Walk<'a, 'b> {
    context: &'a Context<'b>,
    restriction: &'a mut Restriction,
    ownership: &'a mut Ownership,
    edge: PlaneId,
    /// Whether there is nothing of the face on the right.
    outer: bool,
    /// Where the present labels began.
    start: PlaneId,
    now: Option<[Option<Facing>; 2]>,
}

impl Walk<'_, '_> {
    fn change(&mut self, expression: &Expression, section: SectionId, sides: [bool; 2], covers: bool) {
        let of = &self.context.sections[section.index()].of;
        for side in EdgeSide::BOTH.into_iter().filter(|side| sides[*side as usize]) {
            self.ownership.set_cover(expression, self.restriction, of, side, covers);
        }
    }

    /// What the face is on both sides; nothing where it is no boundary at all. Where both sides are the same, the two edges
    /// that are emitted cancel: they tell the weld where faces may cross.
    fn labels(&mut self) -> Option<[Option<Facing>; 2]> {
        let expression = self.context.scene.expression;
        let left = self.ownership.emitted(expression, self.restriction, EdgeSide::Left);
        let right =
            if self.outer { None } else { self.ownership.emitted(expression, self.restriction, EdgeSide::Right) };
        (left.is_some() || right.is_some()).then_some([left, right])
    }

    /// Goes on at a point that lies on `plane`. Where several things change at once and nothing comes of it, edges may cross:
    /// the edge ends there nevertheless, and the weld finds out.
    fn pass(&mut self, plane: PlaneId, several: bool, out: &mut Vec<BoundaryEdge>) {
        let next = self.labels();
        if next != self.now || several {
            self.end(plane, out);
            self.start = plane;
            self.now = next;
        }
    }

    /// Emits what ends at a point that lies on `plane`.
    fn end(&mut self, plane: PlaneId, out: &mut Vec<BoundaryEdge>) {
        let Some([left, right]) = self.now else { return };
        let face = self.context.face;
        out.extend(left.map(|facing| BoundaryEdge::left(face, facing, self.edge, self.start, plane)));
        out.extend(right.map(|facing| BoundaryEdge::right(face, facing, self.edge, self.start, plane)));
    }
}
