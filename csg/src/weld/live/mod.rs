//! The weld of a boundary that changes: an edit costs what it touches.
//!
//! What the weld finds depends on little: what survives on a line on the edges of that line, the loops and faces of a region
//! on the pieces of that region, its triangles on the face. So all of it is kept, and after edges went and came, their lines
//! are cancelled and cut again ([`cutting`]), the regions whose pieces changed are chained and nested again, and the
//! faces that are new are triangulated ([`faces`]). Points, lines and regions are numbered as long as an edge names them
//! ([`numbers`]); nothing depends on these numbers but the numbers of others.

mod cutting;
mod faces;
mod grid;
mod loops;
mod moved;
mod named_lines;
mod named_points;
mod names;
mod numbers;
mod on_line;
mod pieces;
mod regions;
mod triangulation;
mod vertices;
mod welded_face;

use planecut_kernel::DVec3;
use rustc_hash::FxHashMap;
use smallvec::SmallVec;

use super::WeldError;
use super::cancel::Run;
use crate::boundary::BoundaryEdge;
use crate::ids::{EdgeId, FaceId, Id, LineId, PointId, PointOfRegion};
use crate::model::MaterialId;
use crate::plane_table::{PlaneId, PlaneTable};
use cutting::{CutBuffers, Cutter};
use faces::Faces;
use moved::Moving;
use names::place;
use numbers::{Context, NumberedEdge, Numbers};
use on_line::OnLine;
use pieces::Pieces;
use regions::Regions;
use vertices::Vertices;
pub(crate) use welded_face::WeldedFace;

/// Number of lines or regions from which all threads look at them, where they are a good part of all: one in [`SHARE`] or more.
const MANY: usize = 512;
const SHARE: usize = 4;

/// Number of edges from which all threads number them, and from which two do.
const EDGES_FOR_THREADS: usize = 2048;
const EDGES_FOR_TWO: usize = 128;

/// A boundary, welded.
#[derive(Clone, Default)]
pub(crate) struct LiveWeld {
    numbers: Numbers,
    edges: Vec<Edge>,
    free_edges: Vec<EdgeId>,
    /// Taken out, but for their numbers.
    removed: Vec<EdgeId>,
    /// Lines that are the same as others, which have their edges now.
    merged: Vec<LineId>,
    state: State,
    cut_buffers: CutBuffers,
    moving: Option<Moving>,
}

#[derive(Debug, Clone, Copy)]
struct Edge {
    numbered: NumberedEdge,
    /// Taken out since the last update.
    is_gone: bool,
}

/// What is worked out from the edges.
#[derive(Clone, Default)]
struct State {
    lines: Vec<OnLine>,
    dirty_lines: Vec<LineId>,
    pieces: Pieces,
    regions: Regions,
    faces: Faces,
    vertices: Vertices,
    crossings: Crossings,
}

/// Where edges cross in points: there they are cut. What the weld makes of faces that cross in lines is not worked out here.
#[derive(Clone, Default)]
struct Crossings {
    /// For each region and point the lines that pass it.
    passing: FxHashMap<PointOfRegion, SmallVec<[LineId; 2]>>,
    /// How many lines there are in which faces cross.
    lines: usize,
}

impl LiveWeld {
    /// Makes room for boundary edges that are to be added, where they are many.
    pub(crate) fn reserve(&mut self, count: usize) {
        if count < EDGES_FOR_THREADS {
            return;
        }
        self.edges.reserve(count.saturating_sub(self.free_edges.len()));
        self.numbers.reserve(count);
        self.state.reserve(count);
    }

    /// Adds boundary edges; gives their numbers.
    pub(crate) fn insert(&mut self, table: &PlaneTable, edges: &[BoundaryEdge]) -> Vec<EdgeId> {
        self.moving = None;
        self.merge_lines(table);
        if edges.len() >= EDGES_FOR_TWO {
            let numbered = self.numbers.take_all(table, edges);
            return numbered.into_iter().map(|edge| self.put(edge)).collect();
        }
        let mut numbers = Vec::with_capacity(edges.len());
        for edge in edges {
            let numbered = self.numbers.take(table, edge);
            numbers.push(self.put(numbered));
        }
        numbers
    }

    fn put(&mut self, numbered: NumberedEdge) -> EdgeId {
        let Run { from, to, .. } = numbered.run;
        let line = numbered.run.line();
        let number = place(&mut self.edges, &mut self.free_edges, Edge { numbered, is_gone: false });
        self.state.make_room(line);
        self.state.lines[line.index()].add(number, [from, to]);
        self.state.mark_line(line);
        number
    }

    /// Takes a boundary edge out.
    pub(crate) fn remove(&mut self, number: EdgeId) {
        self.moving = None;
        let edge = &mut self.edges[number.index()];
        edge.is_gone = true;
        let run = &edge.numbered.run;
        self.state.mark_change(run.line(), [run.from, run.to]);
        self.removed.push(number);
    }

    /// Welds what has changed; the numbers of the faces that are gone and of those that are new are in [`LiveWeld::changes`].
    ///
    /// # Errors
    /// Where the boundary does not close: a bug in this crate.
    pub(crate) fn update(&mut self, table: &PlaneTable) -> Result<(), WeldError> {
        let (numbers, state) = (&self.numbers, &mut self.state);
        state.faces.begin_changes();
        let context = Context { table, numbers };
        let mut cutter = Cutter::new(context, &self.edges, std::mem::take(&mut self.cut_buffers));
        state.cut_dirty_lines(&mut cutter, true)?;
        if state.find_pinches(&context) {
            state.cut_dirty_lines(&mut cutter, false)?;
        }
        self.cut_buffers = cutter.into_buffers();
        let State { pieces, regions, faces, vertices, .. } = state;
        faces.update(&context, regions, pieces)?;
        vertices.update(pieces);
        pieces.free.append(&mut pieces.gone);
        for number in self.removed.drain(..) {
            self.numbers.release(&self.edges[number.index()].numbered);
            self.free_edges.push(number);
        }
        self.merged.drain(..).for_each(|line| self.numbers.forget_line(line));
        Ok(())
    }

    /// Where an edge begins and ends, correctly rounded.
    pub(crate) fn ends(&self, number: EdgeId) -> [DVec3; 2] {
        let run = &self.edges[number.index()].numbered.run;
        [run.from, run.to].map(|point| self.numbers.position(point))
    }

    /// Whether a point or a line is known by the plane of an index: then it must stay that plane.
    pub(crate) fn names(&self, index: u32) -> bool {
        self.numbers.names(index)
    }

    /// The indices of planes by which no point and no line is known any more, perhaps.
    pub(crate) fn take_unnamed(&mut self) -> Vec<u32> {
        self.numbers.take_unnamed()
    }

    /// A face, where there is one of this number.
    pub(crate) fn face(&self, id: FaceId) -> Option<WeldedFace<'_>> {
        WeldedFace::new(&self.numbers, &self.state, id)
    }

    /// All faces.
    pub(crate) fn faces(&self) -> impl Iterator<Item = (FaceId, WeldedFace<'_>)> {
        self.state.faces.ids().filter_map(|id| Some((id, self.face(id)?)))
    }

    /// The faces on a plane, directed out of the solid, of one material.
    pub(crate) fn faces_on(
        &self,
        plane: PlaneId,
        material: MaterialId,
    ) -> impl Iterator<Item = (FaceId, WeldedFace<'_>)> {
        let faces = self.numbers.region(plane, material).map_or(&[][..], |region| self.state.regions.faces(region));
        faces.iter().filter_map(|id| Some((*id, self.face(*id)?)))
    }

    /// How many triangles there are.
    pub(crate) fn triangle_count(&self) -> usize {
        self.state.faces.triangle_count()
    }

    /// The faces that the last update took away, and those that it made.
    pub(crate) fn changes(&self) -> (&[FaceId], &[FaceId]) {
        self.state.faces.changes()
    }

    /// Whether faces cross in a line. Then the faces here are not those of the weld.
    pub(crate) fn has_crossings(&self) -> bool {
        self.state.crossings.lines > 0
    }
}

impl State {
    /// Makes room for what many edges come to: mostly there are two on a line.
    fn reserve(&mut self, edges: usize) {
        self.lines.reserve(edges / 2 + edges / 16);
        self.pieces.reserve(edges);
    }

    fn make_room(&mut self, line: LineId) {
        if line.index() >= self.lines.len() {
            self.lines.resize_with(line.index() + 1, OnLine::default);
        }
    }

    fn mark_line(&mut self, line: LineId) {
        let on_line = &mut self.lines[line.index()];
        if !on_line.is_dirty {
            on_line.is_dirty = true;
            self.dirty_lines.push(line);
        }
    }

    /// Notes that something has changed on a line between two points.
    fn mark_change(&mut self, line: LineId, ends: [PointId; 2]) {
        self.lines[line.index()].note_change(ends);
        self.mark_line(line);
    }
}
