//! Lines that are cancelled and cut again where something has changed on them.

use planecut_parallel::prelude::*;

use super::numbers::Context;
use super::on_line::{Along, EdgeAlong, OnLine, Parts};
use super::{Edge, MANY, SHARE, State};
use crate::ids::{EdgeId, HalfEdgeId, Id, LineId, PointId, PointOfRegion, PointOnLine, RegionId};
use crate::weld::WeldError;
use crate::weld::cancel::{Crossed, HalfEdge, LineBuffers, LineWorker, Run, Surviving};

/// Number of lines that a thread looks at in a row, where it looks at many.
const LINES_OF_CHUNK: usize = 1024;

/// What it takes to cancel and cut lines.
pub(super) struct Cutter<'a> {
    context: Context<'a>,
    edges: &'a [Edge],
    worker: LineWorker<'a>,
    buffers: CutBuffers,
}

/// What is cancelled and cut on a line, kept for the next one.
#[derive(Clone, Default)]
pub(super) struct CutBuffers {
    /// Those of the worker, between two updates.
    line: LineBuffers,
    ordered: Vec<EdgeAlong>,
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
    pub(super) fn new(context: Context<'a>, edges: &'a [Edge], mut buffers: CutBuffers) -> Self {
        let Context { table, numbers } = context;
        let mut worker = LineWorker::new(table, numbers.points(), numbers.lines(), &numbers.planes);
        worker.buffers = std::mem::take(&mut buffers.line);
        Self { context, edges, worker, buffers }
    }

    /// The buffers, for the next one.
    pub(super) fn into_buffers(self) -> CutBuffers {
        CutBuffers { line: self.worker.buffers, ..self.buffers }
    }

    /// Leaves in `members` the edges of the parts of a line in which something has changed, and in `old_pieces` their pieces; gives the parts.
    fn take_changed(&mut self, line: &mut OnLine, number: LineId, half_edges: &[HalfEdge]) -> Parts {
        let along = Along { context: self.context, line: number };
        let CutBuffers { ordered, members, old_pieces, .. } = &mut self.buffers;
        line.take_changed(&along, self.edges, half_edges, ordered, (members, old_pieces))
    }

    /// Leaves in `surviving` what is left of the edges of a line, `members` of it.
    fn cancel(&mut self) -> Result<(), WeldError> {
        self.buffers.group.clear();
        self.buffers.group.extend(self.buffers.members.iter().map(|edge| self.edges[edge.index()].numbered.run));
        self.buffers.surviving.runs.clear();
        self.buffers.surviving.slits.clear();
        self.buffers.surviving.passed.clear();
        self.worker.cancel(&mut self.buffers.group, &mut self.buffers.surviving)
    }

    /// Leaves in `cut` the paired pieces of that, cut at `further` points as well.
    fn cut(&mut self) -> Result<(), WeldError> {
        self.buffers.cut.clear();
        let crossed = if self.buffers.surviving.slits.is_empty() { Crossed::No } else { Crossed::Unslit };
        self.worker.cut(&self.buffers.surviving.runs, &self.buffers.further, &mut self.buffers.cut, crossed)
    }
}

impl State {
    /// Cuts all lines again on which something has changed, and those with pinches that may be none any more, where these are
    /// to be dropped.
    pub(super) fn cut_dirty_lines(&mut self, cutter: &mut Cutter<'_>, drops_pinches: bool) -> Result<(), WeldError> {
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
            let (mut cutter, mut done) = (Cutter::new(context, edges, CutBuffers::default()), Vec::new());
            let numbers = LineId::from_index(chunk * LINES_OF_CHUNK);
            for (k, line) in lines.iter_mut().enumerate().filter(|(_, line)| line.is_dirty) {
                let number = numbers.plus(k);
                cutter.take_changed(line, number, half_edges);
                cutter.cancel()?;
                if line.is_crossed()
                    || !cutter.buffers.surviving.passed.is_empty()
                    || !cutter.buffers.surviving.slits.is_empty()
                {
                    line.put_back(&mut cutter.buffers.old_pieces);
                    continue;
                }
                cutter.buffers.further.clear();
                cutter.cut()?;
                line.is_dirty = false;
                done.push((number, cutter.buffers.cut.clone(), std::mem::take(&mut cutter.buffers.old_pieces)));
            }
            Ok::<_, WeldError>(done)
        };
        let parts: Vec<_> = self.lines.par_chunks_mut(LINES_OF_CHUNK).enumerate().map(work).collect();
        for part in parts {
            for (number, cut, old) in part? {
                (cutter.buffers.cut, cutter.buffers.old_pieces) = (cut, old);
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
        let Cutter { context, buffers: CutBuffers { cut, old_pieces, old, numbers, .. }, .. } = cutter;
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
        let has_slits = !cutter.buffers.surviving.slits.is_empty();
        crossings.lines += usize::from(has_slits);
        crossings.lines -= usize::from(std::mem::replace(&mut line.has_slits, has_slits));
        let passed = &mut cutter.buffers.passed;
        passed.clear();
        passed.extend(cutter.buffers.surviving.passed.iter().map(|passed| passed.at));
        if !parts.are_all() {
            passed.extend(line.passed().iter().filter(|at| !parts.hold_inside(along, at.point)));
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
        cutter.buffers.further.clear();
        cutter.buffers.further.extend(line.cuts().iter().map(|cut| cut.point));
        let is_crossed = |at: &&PointOfRegion| crossings.passing.get(at).is_some_and(|passing| passing.len() > 1);
        cutter.buffers.further.extend(line.passed().iter().filter(is_crossed).map(|at| at.point));
        cutter.buffers.further.retain(|point| parts.hold(along, *point));
        others.into_iter().for_each(|(other, point)| self.mark_change(other, [point, point]));
    }

    /// Finds the new pinches of regions that have changed and marks their lines; whether there are any.
    pub(super) fn find_pinches(&mut self, context: &Context<'_>) -> bool {
        let found = self.regions.find_pinches(context, &self.pieces);
        let any = !found.is_empty();
        for (region, PointOnLine { line, point }) in found {
            self.lines[line.index()].rare_mut().cuts.push(PointOfRegion { region, point });
            self.mark_change(line, [point, point]);
        }
        any
    }
}
