//! The weld of a boundary that changes: an edit costs what it touches.
//!
//! What the weld finds depends on little: what survives on a line on the edges of that line, the loops and faces of a region
//! on the pieces of that region, its triangles on the face. So all of it is kept, and after edges went and came, their lines
//! are cancelled and cut again, the regions whose pieces changed are chained and nested again, and the
//! faces that are new are triangulated ([`faces`]). Points, lines and regions are numbered as long as an edge names them
//! ([`numbers`]); nothing depends on these numbers but the numbers of others.

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
use planecut_parallel::prelude::*;
use rustc_hash::FxHashMap;

use super::WeldError;
use super::cancel::{Crossed, HalfEdge, LineWorker, Run, Surviving};
use crate::boundary::BoundaryEdge;
use crate::ids::{EdgeId, FaceId, HalfEdgeId, Id, LineId, PointId, PointOfRegion, PointOnLine, RegionId};
use crate::model::MaterialId;
use crate::plane_table::{PlaneId, PlaneTable};
use faces::Faces;
use moved::Moving;
use names::place;
use numbers::{Context, NumberedEdge, Numbers};
use on_line::{Along, OnLine, Parts};
use pieces::Pieces;
use regions::Regions;
use vertices::Vertices;
pub(crate) use welded_face::WeldedFace;

/// Number of lines or regions from which all threads look at them, where they are a good part of all: one in [`SHARE`] or more.
const MANY: usize = 512;
const SHARE: usize = 4;

/// Number of lines that a thread looks at in a row then.
const LINES_OF_CHUNK: usize = 1024;

/// Number of edges from which all threads number them.
const EDGES_FOR_THREADS: usize = 2048;

/// A boundary, welded.
#[derive(Clone, Default)]
pub(crate) struct LiveWeld {
    numbers: Numbers,
    edges: Vec<Edge>,
    free_edges: Vec<EdgeId>,
    /// Taken out, but for their numbers.
    removed: Vec<EdgeId>,
    state: State,
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
    passing: FxHashMap<PointOfRegion, Vec<LineId>>,
    /// How many lines there are in which faces cross.
    lines: usize,
}

impl LiveWeld {
    /// Adds boundary edges; gives their numbers.
    pub(crate) fn insert(&mut self, table: &PlaneTable, edges: &[BoundaryEdge]) -> Vec<EdgeId> {
        self.moving = None;
        if edges.len() >= EDGES_FOR_THREADS {
            let numbered = self.numbers.take_all(table, edges);
            self.edges.reserve(numbered.len().saturating_sub(self.free_edges.len()));
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
        let Run { line, from, to, .. } = numbered.run;
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
        self.state.mark_change(run.line, [run.from, run.to]);
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
        let mut cutter = Cutter::new(context, &self.edges);
        state.cut_dirty_lines(&mut cutter, true)?;
        if state.find_pinches(&context) {
            state.cut_dirty_lines(&mut cutter, false)?;
        }
        let State { pieces, regions, faces, vertices, .. } = state;
        faces.update(&context, regions, pieces)?;
        vertices.update(pieces);
        pieces.free.append(&mut pieces.gone);
        for number in self.removed.drain(..) {
            self.numbers.release(&self.edges[number.index()].numbered);
            self.free_edges.push(number);
        }
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

/// What it takes to cancel and cut lines, and buffers.
struct Cutter<'a> {
    context: Context<'a>,
    edges: &'a [Edge],
    worker: LineWorker<'a>,
    members: Vec<EdgeId>,
    group: Vec<Run>,
    surviving: Surviving,
    further: Vec<PointId>,
    cut: Vec<HalfEdge>,
    old_pieces: Vec<HalfEdgeId>,
    old: Vec<((RegionId, PointId, PointId), HalfEdgeId)>,
    numbers: Vec<HalfEdgeId>,
    passed: Vec<PointOfRegion>,
}

impl<'a> Cutter<'a> {
    fn new(context: Context<'a>, edges: &'a [Edge]) -> Self {
        let Context { table, numbers } = context;
        Self {
            context,
            edges,
            worker: LineWorker::new(table, numbers.points(), numbers.lines(), &numbers.planes),
            members: Vec::new(),
            group: Vec::new(),
            surviving: Surviving::default(),
            further: Vec::new(),
            cut: Vec::new(),
            old_pieces: Vec::new(),
            old: Vec::new(),
            numbers: Vec::new(),
            passed: Vec::new(),
        }
    }

    /// Leaves in `members` the edges of the parts of a line in which something has changed, and in `old_pieces` their pieces; gives the parts.
    fn take_changed(&mut self, line: &mut OnLine, number: LineId, half_edges: &[HalfEdge]) -> Parts {
        let along = Along { context: self.context, line: number };
        let run = |number: HalfEdgeId| {
            let piece = &half_edges[number.index()];
            ([piece.from, piece.to], piece.forward)
        };
        line.take_changed(&along, self.edges, run, &mut self.members, &mut self.old_pieces)
    }

    /// Leaves in `surviving` what is left of the edges of a line, `members` of it.
    fn cancel(&mut self) -> Result<(), WeldError> {
        self.group.clear();
        self.group.extend(self.members.iter().map(|edge| self.edges[edge.index()].numbered.run));
        self.surviving.runs.clear();
        self.surviving.slits.clear();
        self.surviving.passed.clear();
        self.worker.cancel(&mut self.group, &mut self.surviving)
    }

    /// Leaves in `cut` the paired pieces of that, cut at `further` points as well.
    fn cut(&mut self) -> Result<(), WeldError> {
        self.cut.clear();
        let crossed = if self.surviving.slits.is_empty() { Crossed::No } else { Crossed::Unslit };
        self.worker.cut(&self.surviving.runs, &self.further, &mut self.cut, crossed)
    }
}

impl State {
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

    /// Cuts all lines again on which something has changed, and those with pinches that may be none any more, where these are
    /// to be dropped.
    fn cut_dirty_lines(&mut self, cutter: &mut Cutter<'_>, drops_pinches: bool) -> Result<(), WeldError> {
        if self.dirty_lines.len() >= MANY && self.dirty_lines.len() * SHARE >= self.lines.len() {
            self.cut_many(cutter)?;
        }
        loop {
            while let Some(line) = self.dirty_lines.pop() {
                self.lines[line.index()].is_dirty = false;
                self.cut_line(cutter, line)?;
            }
            if !drops_pinches {
                return Ok(());
            }
            for (region, PointOnLine { line, point }) in self.regions.take_doubtful_pinches(&self.pieces.half_edges) {
                self.lines[line.index()].rare_mut().cuts.retain(|cut| *cut != PointOfRegion { region, point });
                self.mark_change(line, [point, point]);
            }
            if self.dirty_lines.is_empty() {
                return Ok(());
            }
        }
    }

    /// Cuts those of many lines that nothing crosses; what they come to is worked out by all threads.
    fn cut_many(&mut self, cutter: &mut Cutter<'_>) -> Result<(), WeldError> {
        let (context, edges, half_edges) = (cutter.context, cutter.edges, &self.pieces.half_edges);
        let work = |(chunk, lines): (usize, &mut [OnLine])| {
            let (mut cutter, mut done) = (Cutter::new(context, edges), Vec::new());
            let numbers = LineId::from_index(chunk * LINES_OF_CHUNK);
            for (k, line) in lines.iter_mut().enumerate().filter(|(_, line)| line.is_dirty) {
                let number = numbers.plus(k);
                cutter.take_changed(line, number, half_edges);
                cutter.cancel()?;
                if line.is_crossed() || !cutter.surviving.passed.is_empty() || !cutter.surviving.slits.is_empty() {
                    line.put_back(&mut cutter.old_pieces);
                    continue;
                }
                cutter.further.clear();
                cutter.cut()?;
                line.is_dirty = false;
                done.push((number, cutter.cut.clone(), std::mem::take(&mut cutter.old_pieces)));
            }
            Ok::<_, WeldError>(done)
        };
        let parts: Vec<_> = self.lines.par_chunks_mut(LINES_OF_CHUNK).enumerate().map(work).collect();
        for part in parts {
            for (number, cut, old) in part? {
                (cutter.cut, cutter.old_pieces) = (cut, old);
                self.exchange_pieces(cutter, number);
            }
        }
        let lines = &self.lines;
        self.dirty_lines.retain(|line| lines[line.index()].is_dirty);
        Ok(())
    }

    fn cut_line(&mut self, cutter: &mut Cutter<'_>, number: LineId) -> Result<(), WeldError> {
        let parts = cutter.take_changed(&mut self.lines[number.index()], number, &self.pieces.half_edges);
        cutter.cancel()?;
        self.note_crossings(number, &parts, cutter);
        cutter.cut()?;
        self.exchange_pieces(cutter, number);
        Ok(())
    }

    /// Puts the pieces to which a part of a line was cut in the place of the old ones; those that stay the same keep their numbers.
    fn exchange_pieces(&mut self, cutter: &mut Cutter<'_>, number: LineId) {
        let Self { lines, pieces, regions, .. } = self;
        let line = &mut lines[number.index()];
        let Cutter { context, cut, old_pieces, old, numbers, .. } = cutter;
        let key = |piece: &HalfEdge| (piece.region, piece.from, piece.to);
        old.clear();
        old.extend(old_pieces.iter().map(|number| (key(&pieces.half_edges[number.index()]), *number)));
        old.sort_unstable();
        numbers.clear();
        for piece in cut.iter() {
            let known = old.binary_search_by_key(&key(piece), |entry| entry.0);
            numbers.push(match known {
                Ok(at) => std::mem::replace(&mut old[at].1, HalfEdgeId::NONE),
                Err(_) => {
                    let number = pieces.add(*piece);
                    regions.add_piece(context, &mut pieces.places, piece, number);
                    number
                }
            });
        }
        for (_, gone) in old.iter().filter(|(_, number)| *number != HalfEdgeId::NONE) {
            let piece = &pieces.half_edges[gone.index()];
            regions.remove_piece(context, &mut pieces.places, piece, *gone);
            pieces.remove(*gone);
        }
        for (piece, number) in cut.iter().zip(numbers.iter()) {
            let known = &mut pieces.half_edges[number.index()];
            let twin = numbers[piece.twin.index()];
            if known.twin != twin {
                pieces.turned.push(*number);
            }
            *known = HalfEdge { twin, ..*piece };
        }
        line.pieces.extend_from_slice(numbers);
    }

    /// Notes what crosses on a line that is cut again, and where it is to be cut; marks the lines for which that makes a
    /// difference.
    fn note_crossings(&mut self, number: LineId, parts: &Parts, cutter: &mut Cutter<'_>) {
        let along = &Along { context: cutter.context, line: number };
        let line = &mut self.lines[number.index()];
        let crossings = &mut self.crossings;
        let has_slits = !cutter.surviving.slits.is_empty();
        crossings.lines += usize::from(has_slits);
        crossings.lines -= usize::from(std::mem::replace(&mut line.has_slits, has_slits));
        let passed = &mut cutter.passed;
        passed.clear();
        passed.extend(cutter.surviving.passed.iter().map(|passed| passed.at));
        if !parts.are_all() {
            passed.extend(line.passed().iter().filter(|at| !parts.hold(along, at.point)));
        }
        passed.sort_unstable();
        passed.dedup();
        if !passed.is_empty() || !line.passed().is_empty() {
            std::mem::swap(&mut line.rare_mut().passed, passed);
        }
        let mut others: Vec<(LineId, PointId)> = Vec::new();
        for gone in passed.iter().filter(|at| line.passed().binary_search(at).is_err()) {
            let Some(passing) = crossings.passing.get_mut(gone) else { continue };
            passing.retain(|other| *other != number);
            match passing[..] {
                [] => drop(crossings.passing.remove(gone)),
                [alone] => others.push((alone, gone.point)),
                _ => {}
            }
        }
        for new in line.passed().iter().filter(|at| passed.binary_search(at).is_err()) {
            let passing = crossings.passing.entry(*new).or_default();
            passing.push(number);
            if let [other, _] = passing[..] {
                others.push((other, new.point));
            }
        }
        cutter.further.clear();
        cutter.further.extend(line.cuts().iter().map(|cut| cut.point));
        let is_crossed = |at: &&PointOfRegion| crossings.passing.get(at).is_some_and(|passing| passing.len() > 1);
        cutter.further.extend(line.passed().iter().filter(is_crossed).map(|at| at.point));
        cutter.further.retain(|point| parts.hold(along, *point));
        others.into_iter().for_each(|(other, point)| self.mark_change(other, [point, point]));
    }

    /// Finds the new pinches of regions that have changed and marks their lines; whether there are any.
    fn find_pinches(&mut self, context: &Context<'_>) -> bool {
        let found = self.regions.find_pinches(context, &self.pieces);
        let any = !found.is_empty();
        for (region, PointOnLine { line, point }) in found {
            self.lines[line.index()].rare_mut().cuts.push(PointOfRegion { region, point });
            self.mark_change(line, [point, point]);
        }
        any
    }
}
