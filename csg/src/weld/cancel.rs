//! What is left of the boundary edges on each line once opposite ones have cancelled.
//!
//! Per line and region (oriented plane and material) the directed edges are summed over the elementary intervals between
//! end points: coplanar pieces merge, however they were cut. The maximal runs that survive are then cut at the ends of
//! all runs on the line, so that faces meet without T-junctions.

use std::ops::Range;

use planecut_kernel::sign::Counts;

use super::WeldError;
use super::around::{self, AroundLine};
use super::crossings::Passed;
use super::large_face::FaceEdge;
use super::lines::Line;
use super::points::Points;
use super::slits::SlitFinder;
use super::stops::Stops;
use crate::base::{Workers, concat_made, map_ranges, split_by, starts_of, with_room};
use crate::ids::{DirectedLine, EdgeId, HalfEdgeId, Id, LineId, PointId, PointOfRegion, RegionId};
use crate::plane_table::{PlaneId, PlaneTable};

/// Number of lines whose edges are gathered together.
const LINES_AT_A_TIME: usize = 256;

/// A directed piece of a line along which one region ends on one side: a boundary edge, or after cancelling a maximal run.
#[derive(Debug, Clone, Copy)]
pub(super) struct Run {
    /// The line in the direction in which it runs.
    pub(super) along: DirectedLine,
    /// The region: an oriented plane and a material.
    pub(super) region: RegionId,
    /// The plane of the edge, outward from the region.
    pub(super) edge: PlaneId,
    pub(super) from: PointId,
    pub(super) to: PointId,
}

impl Run {
    /// Its line.
    #[inline]
    pub(super) fn line(&self) -> LineId {
        self.along.line()
    }

    /// Whether it points along its line.
    #[inline]
    pub(super) fn is_forward(&self) -> bool {
        self.along.is_forward()
    }
}

/// What cancelling leaves.
#[derive(Debug, Clone, Default)]
pub(super) struct Surviving {
    /// The runs that survive, ordered by line.
    pub(super) runs: Vec<Run>,
    /// Where faces that cross must be slit, forward only.
    pub(super) slits: Vec<Run>,
    /// Where edges end inside runs.
    pub(super) passed: Vec<Passed>,
}

/// The elementary pieces of lines.
#[derive(Debug, Default)]
pub(super) struct Pieces {
    /// Paired half-edges, ordered by line.
    pub(super) pieces: Vec<HalfEdge>,
    /// Whether lines with slits are left out.
    pub(super) is_slit: bool,
    pub(super) passed: Vec<Passed>,
}

/// Whether faces cross in a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Crossed {
    /// They do not, or they are slit there.
    No,
    /// They do, and what is made of the line is not used for a mesh.
    Unslit,
}

/// What is asked along lines, and buffers for it.
pub(super) struct LineWorker<'a> {
    table: &'a PlaneTable,
    points: &'a Points,
    lines: &'a [Line],
    /// The planes of the regions.
    planes: &'a [PlaneId],
    pub(super) buffers: LineBuffers,
}

/// What is asked along a line, kept for the next one.
#[derive(Clone, Default)]
pub(super) struct LineBuffers {
    sweep: Sweep,
    slits: SlitFinder,
    stops: Stops,
    at_interval: Vec<(u32, HalfEdgeId)>,
    around: Vec<HalfEdgeId>,
}

/// Cancels the edges on each line and cuts and pairs what is left, in parts; `edges` are listed by line in `by_line`. Lines with slits are left
/// out: where there are any, [`crossings`](super::crossings) begins again.
pub(super) fn pieces(
    table: &PlaneTable,
    points: &Points,
    lines: &[Line],
    planes: &[PlaneId],
    edges: &[Run],
    (starts, by_line): &(Vec<u32>, Vec<EdgeId>),
) -> Result<(Vec<Pieces>, Counts), WeldError> {
    // where the edges of lines that follow one another are in the list
    let of_lines = |lines: Range<usize>| starts[lines.start] as usize..starts[lines.end] as usize;
    let workers = Workers::new(|| (LineWorker::new(table, points, lines, planes), Vec::new()));
    let work = |numbers: Range<usize>, (worker, runs): &mut (LineWorker<'_>, Vec<Run>)| -> Result<Pieces, WeldError> {
        let mut surviving = Surviving::default();
        let mut pieces = with_room(of_lines(numbers.clone()).len(), by_line.len());
        for first in numbers.clone().step_by(LINES_AT_A_TIME) {
            let some = first..numbers.end.min(first + LINES_AT_A_TIME);
            // edges lie anywhere in memory: in a loop of their own several are on their way at once
            runs.clear();
            runs.extend(by_line[of_lines(some.clone())].iter().map(|k| edges[k.index()]));
            for group in split_by(runs, some.map(|line| of_lines(line..line + 1).len())) {
                if worker.pair_alone(group, &mut pieces) {
                    continue;
                }
                surviving.runs.clear();
                let slits = surviving.slits.len();
                worker.cancel(group, &mut surviving)?;
                if surviving.slits.len() == slits {
                    worker.cut(&surviving.runs, &[], &mut pieces, Crossed::No)?;
                }
            }
        }
        Ok(Pieces { pieces, is_slit: !surviving.slits.is_empty(), passed: surviving.passed })
    };
    let (parts, counts) = map_ranges(lines.len(), 256, |numbers| workers.with(|worker| work(numbers, worker)));
    Ok((parts.into_iter().collect::<Result<_, _>>()?, counts))
}

/// The half-edges of some parts.
pub(super) fn joined(parts: Vec<Pieces>) -> Vec<HalfEdge> {
    let first = starts_of(parts.iter().map(|part| part.pieces.len()));
    let pieces = parts.into_iter().map(|part| part.pieces).collect();
    concat_made(pieces, |part, piece: &HalfEdge| HalfEdge { twin: piece.twin.plus(first[part]), ..*piece })
}

impl<'a> LineWorker<'a> {
    pub(super) fn new(table: &'a PlaneTable, points: &'a Points, lines: &'a [Line], planes: &'a [PlaneId]) -> Self {
        Self { table, points, lines, planes, buffers: LineBuffers::default() }
    }

    /// Pairs the edges of one line where they are no more than two, of different regions and with the same ends; tells whether that was so.
    fn pair_alone(&self, edges: &[Run], out: &mut Vec<HalfEdge>) -> bool {
        let [a, b] = edges else { return false };
        if a.region == b.region || (a.from, a.to) != (b.to, b.from) {
            return false;
        }
        let [a, b] = if a.region < b.region { [a, b] } else { [b, a] };
        let first = HalfEdgeId::from_index(out.len());
        out.extend([HalfEdge::of(a, first.plus(1)), HalfEdge::of(b, first)]);
        true
    }

    /// Adds what survives of the edges of one line.
    pub(super) fn cancel(&mut self, edges: &mut [Run], out: &mut Surviving) -> Result<(), WeldError> {
        let Some(first) = edges.first() else { return Ok(()) };
        let line = &self.lines[first.line().index()];
        let known = out.runs.len();
        edges.sort_unstable_by_key(|edge| edge.region);
        self.buffers.sweep.cancelled.clear();
        for group in edges.chunk_by(|a, b| a.region == b.region) {
            if let [edge] = group {
                out.runs.push(*edge);
            } else {
                self.buffers.sweep.run_group(self.table, self.points, line, group, out)?;
            }
        }
        let Self { table, points, planes, .. } = *self;
        let line = AroundLine { table, line, planes };
        self.buffers.slits.find(&line, points, &self.buffers.sweep.cancelled, &out.runs[known..], &mut out.slits);
        Ok(())
    }

    /// Cuts the runs of one line at the ends of all of them and at some further points of the line, and pairs opposite pieces.
    ///
    /// Where more than two pieces share an interval, faces are sorted around the line and those two are paired that bound
    /// one wedge of solid.
    pub(super) fn cut(
        &mut self,
        runs: &[Run],
        further: &[PointId],
        out: &mut Vec<HalfEdge>,
        crossed: Crossed,
    ) -> Result<(), WeldError> {
        let Some(first) = runs.first() else { return Ok(()) };
        if let [a, b] = runs
            && (a.from, a.to) == (b.to, b.from)
            && further.is_empty()
        {
            let first = HalfEdgeId::from_index(out.len());
            out.extend([HalfEdge::of(a, first.plus(1)), HalfEdge::of(b, first)]);
            return Ok(());
        }
        let line = &self.lines[first.line().index()];
        let ends = runs.iter().flat_map(|run| [run.from, run.to]).chain(further.iter().copied());
        self.buffers.stops.set(self.table, self.points, line, ends);
        self.buffers.at_interval.clear();
        for (run, ends) in runs.iter().zip(self.buffers.stops.places()) {
            cut_run(run, *ends, self.buffers.stops.points(), out, &mut self.buffers.at_interval);
        }
        self.buffers.at_interval.sort_unstable();
        for interval in self.buffers.at_interval.chunk_by(|a, b| a.0 == b.0) {
            self.buffers.around.clear();
            self.buffers.around.extend(interval.iter().map(|(_, k)| *k));
            match crossed {
                Crossed::No => {
                    AroundLine { table: self.table, line, planes: self.planes }.pair(&mut self.buffers.around, out)?;
                }
                Crossed::Unslit => around::pair_anyhow(&mut self.buffers.around, out)?,
            }
        }
        Ok(())
    }
}

/// Buffers of the sweep along one line.
#[derive(Clone, Default)]
struct Sweep {
    stops: Stops,
    /// For each stop what changes there: the sum of directed edges, and how many there are.
    change: Vec<(i32, i32)>,
    /// Where edges of a region cancelled, so that it lies on both sides of the line; all forward.
    cancelled: Vec<Run>,
}

impl Sweep {
    fn run_group(
        &mut self,
        table: &PlaneTable,
        points: &Points,
        line: &Line,
        group: &[Run],
        out: &mut Surviving,
    ) -> Result<(), WeldError> {
        self.stops.set(table, points, line, group.iter().flat_map(|edge| [edge.from, edge.to]));
        let stops = self.stops.points();
        self.change.clear();
        self.change.resize(stops.len(), (0, 0));
        for (edge, ends) in group.iter().zip(self.stops.places()) {
            let step = if edge.is_forward() { 1 } else { -1 };
            for (place, sign) in std::iter::zip(*ends, [1, -1]) {
                let change = &mut self.change[place as usize];
                *change = (change.0 + sign, change.1 + sign * step);
            }
        }
        // the sum so far, and whether there is any edge
        let mut now = (0, false);
        let (mut count, mut began) = (0, 0);
        for (at, stop) in stops.iter().enumerate() {
            let before = now;
            count += self.change[at].1;
            now = (now.0 + self.change[at].0, count > 0);
            if now.0.abs() > 1 {
                return Err(WeldError::overlap(group[0].region));
            }
            if now == before {
                if now.0 != 0 {
                    let at = PointOfRegion { region: group[0].region, point: *stop };
                    out.passed.push(Passed { at, line: group[0].line() });
                }
                continue;
            }
            let (low, high) = (stops[began], *stop);
            let run = |forward: bool| {
                let (from, to) = if forward { (low, high) } else { (high, low) };
                let alike = group.iter().find(|edge| edge.is_forward() == forward);
                Run { from, to, ..*alike.expect("a sum of edges holds one of its direction") }
            };
            match before {
                (0, true) => self.cancelled.push(run(true)),
                (0, false) => {}
                (sum, _) => out.runs.push(run(sum > 0)),
            }
            began = at;
        }
        Ok(())
    }
}

/// An elementary piece of a run, and later its neighbours.
#[derive(Debug, Clone, Copy)]
pub(super) struct HalfEdge {
    pub(super) region: RegionId,
    /// The line in the direction in which it runs.
    pub(super) along: DirectedLine,
    pub(super) edge: PlaneId,
    pub(super) from: PointId,
    pub(super) to: PointId,
    /// The half-edge that bounds the same wedge of solid, [`Id::NONE`] until it is known.
    pub(super) twin: HalfEdgeId,
}

impl HalfEdge {
    fn of(run: &Run, twin: HalfEdgeId) -> Self {
        let Run { along, region, edge, from, to } = *run;
        Self { region, along, edge, from, to, twin }
    }

    /// Its line.
    #[inline]
    pub(super) fn line(&self) -> LineId {
        self.along.line()
    }

    /// Whether it points along its line.
    #[inline]
    pub(super) fn is_forward(&self) -> bool {
        self.along.is_forward()
    }

    /// What it is as the boundary of its face; `piece` is its own number.
    pub(super) fn edge_of_face(&self, piece: HalfEdgeId) -> FaceEdge {
        FaceEdge { piece, from: self.from, to: self.to }
    }
}

/// Cuts one run at the stops within it; notes the interval of each piece.
fn cut_run(
    run: &Run,
    [a, b]: [u32; 2],
    stops: &[PointId],
    out: &mut Vec<HalfEdge>,
    at_interval: &mut Vec<(u32, HalfEdgeId)>,
) {
    for interval in a.min(b)..a.max(b) {
        let (low, high) = (stops[interval as usize], stops[interval as usize + 1]);
        let (from, to) = if run.is_forward() { (low, high) } else { (high, low) };
        at_interval.push((interval, HalfEdgeId::from_index(out.len())));
        out.push(HalfEdge { from, to, ..HalfEdge::of(run, HalfEdgeId::NONE) });
    }
}
