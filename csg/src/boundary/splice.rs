//! The edges of the boundary on a face, where only a part of them was found again.
//!
//! A change of bodies within a box leaves the boundary on a face as it is everywhere else. So it is enough to find it among the
//! bodies that reach the box, or a little further: what comes out is right there, and wrong elsewhere, where other
//! bodies are left out. Along each line on which edges of the boundary lie that touch the box, the ends within the box are then taken from
//! what was found, and the others from what was known. Around the box, as far as no body is left out, both are right, so that one may
//! go over into the other.

use std::cmp::Ordering;

use planecut_kernel::DVec3;
use planecut_kernel::sign::Sign;
use smallvec::SmallVec;

use super::BoundaryEdge;
use super::section::{Line, Piece};
use super::signs::Signs;
use crate::base::Bounds;
use crate::ids::EdgeId;
use crate::plane_table::{PlaneId, PlaneTable};

/// What becomes of the edges known on a face.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct EdgeChange {
    /// The places of those that are no more, ascending.
    pub(crate) removed: SmallVec<[u32; 8]>,
    /// Those that are new, sorted.
    pub(crate) added: Vec<BoundaryEdge>,
}

/// An edge known on a face, and its number in the weld.
pub(crate) type KnownEdge = (BoundaryEdge, EdgeId);

impl EdgeChange {
    /// What it takes to get from the known edges to those that were found, both sorted.
    pub(crate) fn between(known: &[KnownEdge], found: &[BoundaryEdge]) -> Self {
        let mut change = Self::default();
        change.note(&mut (0..).zip(known.iter().map(|known| &known.0)), found);
        change
    }

    /// The same where what was found is right within a box and a little around it, and what is known outside of it and as much around its border; `ends` are the correctly rounded
    /// ends of known edges. Nothing where the two do not fit together at the border: then this is not so.
    pub(crate) fn within(
        bounds: &Bounds,
        table: &PlaneTable,
        known: &[KnownEdge],
        ends: impl Fn(EdgeId) -> [DVec3; 2],
        found: &[BoundaryEdge],
    ) -> Option<Self> {
        let touches = |[a, b]: [DVec3; 2]| Bounds::around(a, b).touches(bounds);
        let old = (0..).zip(known).map(|(place, (edge, number))| (place, edge, ends(*number)));
        let old: Vec<(u32, &BoundaryEdge, [DVec3; 2])> = old.filter(|(_, _, ends)| touches(*ends)).collect();
        let may_touch = |edge: &BoundaryEdge| Piece::of_boundary(table, edge).bounds().touches(bounds);
        let position = |edge: &BoundaryEdge, end| table.position([edge.face, edge.edge, end]).expect("a corner");
        let mut new: Vec<(&BoundaryEdge, [DVec3; 2])> = Vec::with_capacity(old.len());
        // where the ends of most of them are is known
        let mut alike = old.iter().peekable();
        for edge in found {
            while alike.next_if(|(_, other, _)| *other < edge).is_some() {}
            if let Some((_, _, ends)) = alike.next_if(|(_, other, _)| *other == edge) {
                new.push((edge, *ends));
            } else if may_touch(edge) {
                let ends = [edge.start, edge.end].map(|end| position(edge, end));
                if touches(ends) {
                    new.push((edge, ends));
                }
            }
        }
        let mut change = Self::default();
        let (mut old, mut new) = (old.as_slice(), new.as_slice());
        let mut splicer = Splicer { bounds, table, events: Vec::new(), spliced: Vec::new() };
        while let Some(line) =
            old.first().map(|old| old.1).into_iter().chain(new.first().map(|new| new.0)).map(line_of).min()
        {
            let (old_here, old_rest) = old.split_at(old.partition_point(|old| line_of(old.1) <= line));
            let (new_here, new_rest) = new.split_at(new.partition_point(|new| line_of(new.0) <= line));
            (old, new) = (old_rest, new_rest);
            if old_here.iter().map(|old| old.1).eq(new_here.iter().map(|new| new.0)) {
                continue;
            }
            splicer.begin();
            old_here.iter().for_each(|(_, edge, ends)| splicer.add(edge, *ends, Source::Known));
            new_here.iter().for_each(|(edge, ends)| splicer.add(edge, *ends, Source::Found));
            let edge = old_here.first().map(|old| old.1).or(new_here.first().map(|new| new.0))?;
            splicer.splice(edge)?;
            change.note(&mut old_here.iter().map(|(place, edge, _)| (*place, *edge)), &splicer.spliced);
        }
        Some(change)
    }

    /// Notes of some known edges, with their places, and those in their place, both sorted, which go and come.
    fn note<'a>(&mut self, known: &mut impl Iterator<Item = (u32, &'a BoundaryEdge)>, found: &[BoundaryEdge]) {
        let mut found = found.iter().peekable();
        for (place, edge) in known {
            while let Some(new) = found.next_if(|other| *other < edge) {
                self.added.push(*new);
            }
            if found.next_if_eq(&edge).is_none() {
                self.removed.push(place);
            }
        }
        self.added.extend(found);
    }

    /// Whether nothing changes.
    pub(crate) fn is_empty(&self) -> bool {
        self.removed.is_empty() && self.added.is_empty()
    }
}

/// Edges on one line of one face are of one direction, with the face on one side.
fn line_of(edge: &BoundaryEdge) -> (PlaneId, PlaneId) {
    (edge.face, edge.edge)
}

/// Which edges one belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Source {
    Known,
    Found,
}

/// An end of an edge.
#[derive(Debug, Clone, Copy)]
struct Event {
    source: Source,
    begins: bool,
    plane: PlaneId,
    at: DVec3,
}

/// Puts the edges on a line together.
struct Splicer<'a> {
    bounds: &'a Bounds,
    table: &'a PlaneTable,
    events: Vec<Event>,
    spliced: Vec<BoundaryEdge>,
}

impl Splicer<'_> {
    fn begin(&mut self) {
        self.events.clear();
        self.spliced.clear();
    }

    fn add(&mut self, edge: &BoundaryEdge, [start, end]: [DVec3; 2], source: Source) {
        self.events.push(Event { source, begins: true, plane: edge.start, at: start });
        self.events.push(Event { source, begins: false, plane: edge.end, at: end });
    }

    /// Leaves the edges on the line of one in `spliced`, sorted; nothing where known and found ones do not fit together.
    fn splice(&mut self, edge: &BoundaryEdge) -> Option<()> {
        let (table, bounds) = (self.table, self.bounds);
        let order = Order::new(table, edge);
        self.events.sort_by(|a, b| order.compare(a, b));
        // how many known and found edges cover the place, and where the edge began that is put together
        let (mut known, mut found) = (0, 0);
        let mut start: Option<PlaneId> = None;
        for here in self.events.chunk_by(|a, b| order.compare(a, b).is_eq()) {
            let before = [known, found];
            for event in here {
                let count = if event.source == Source::Known { &mut known } else { &mut found };
                *count += if event.begins { 1 } else { -1 };
            }
            if known.max(found) > 1 {
                return None;
            }
            let at = here[0].at;
            let is_inside = bounds.holds(&Bounds::around(at, at));
            let source = if is_inside { Source::Found } else { Source::Known };
            let place = usize::from(is_inside);
            let of_source = |begins: bool| here.iter().find(|event| event.source == source && event.begins == begins);
            if !here.iter().any(|event| event.source == source) {
                continue;
            }
            if start.is_some() != (before[place] == 1) {
                return None;
            }
            if let Some(start) = start.take() {
                self.spliced.push(BoundaryEdge { start, end: of_source(false)?.plane, ..*edge });
            }
            if [known, found][place] == 1 {
                start = Some(of_source(true)?.plane);
            }
        }
        self.spliced.sort_unstable();
        start.is_none().then_some(())
    }
}

/// The order along a line.
struct Order<'a> {
    table: &'a PlaneTable,
    line: Line,
    /// The signs of the components of its direction.
    direction: [Sign; 3],
}

impl<'a> Order<'a> {
    fn new(table: &'a PlaneTable, edge: &BoundaryEdge) -> Self {
        let direction = std::array::from_fn(|axis| table.cross_component(edge.face, edge.edge, axis));
        Self { table, line: Line { plane: edge.face, edge: edge.edge }, direction }
    }

    /// The exact order of two ends. Coordinates are correctly rounded: where they differ, the ends are in that order.
    fn compare(&self, a: &Event, b: &Event) -> Ordering {
        if a.plane.index() == b.plane.index() {
            return Ordering::Equal;
        }
        for axis in 0..3 {
            if a.at[axis] != b.at[axis] && self.direction[axis] != Sign::Zero {
                let is_forward = self.direction[axis] == Sign::Positive;
                return if (a.at[axis] < b.at[axis]) == is_forward { Ordering::Less } else { Ordering::Greater };
            }
        }
        let [a, b] = [a.plane, b.plane].map(|plane| {
            let looks_back = !self.line.looks_ahead(self.table, plane);
            self.line.meeting(self.table, plane, looks_back)
        });
        self.line.compare(Signs::of(self.table), &a, &b)
    }
}
