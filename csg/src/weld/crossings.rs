//! What crosses where a solid alternates around a line or a point (an exclusive or of three half-spaces): faces that lie on
//! both sides of a line are slit along it, edges that go on beyond a point are cut there.

use planecut_kernel::sign::Sign;
use planecut_parallel::prelude::*;
use rustc_hash::FxHashMap;

use super::WeldError;
use super::cancel::{Crossed, HalfEdge, LineWorker, Run, Surviving};
use super::lines::Line;
use super::points::Points;
use super::stops::sort_along;
use crate::ids::{DirectedLine, EdgeId, Id, LineId, PointId, PointOfRegion};
use crate::plane_table::{PlaneId, PlaneTable};

/// Most parts of the points that runs pass.
const MOST_PARTS: usize = 4;

/// Number of points that runs pass from which two threads look for one where they cross.
const PASSED_OF_PART: usize = 256;

/// A point inside a run of a region, at which edges that make it up end, and the line of the run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Passed {
    pub(super) at: PointOfRegion,
    pub(super) line: LineId,
}

/// A point at which the runs of a region on a line are cut; ordered by line, then by region.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Cut {
    line: LineId,
    at: PointOfRegion,
}

/// Whether runs of one region cross in a point that several of them pass.
pub(super) fn any(passed: &[&[Passed]]) -> bool {
    let count: usize = passed.iter().map(|some| some.len()).sum();
    // each part looks at all of them
    let parts = planecut_parallel::current_num_threads().clamp(1, MOST_PARTS).min(1 + count / PASSED_OF_PART);
    let crosses = |part: usize| {
        let own = passed.iter().copied().flatten().filter(|passed| passed.at.point.index() % parts == part);
        let mut at_point: FxHashMap<PointOfRegion, LineId> = FxHashMap::default();
        at_point.reserve(count / parts);
        own.into_iter().any(|passed| *at_point.entry(passed.at).or_insert(passed.line) != passed.line)
    };
    (0..parts).into_par_iter().with_max_len(1).any(crosses)
}

/// The elementary pieces of all lines, where something crosses.
pub(super) fn pieces(
    table: &PlaneTable,
    points: &mut Points,
    lines: &[Line],
    planes: &[PlaneId],
    edges: &[Run],
    (starts, by_line): &(Vec<u32>, Vec<EdgeId>),
) -> Result<Vec<HalfEdge>, WeldError> {
    let mut surviving = Surviving::default();
    let mut worker = LineWorker::new(table, points, lines, planes);
    for ends in starts.windows(2) {
        let members = &by_line[ends[0] as usize..ends[1] as usize];
        let mut group: Vec<Run> = members.iter().map(|k| edges[k.index()]).collect();
        worker.cancel(&mut group, &mut surviving)?;
    }
    let Surviving { runs, slits, passed } = surviving;
    let runs = cut_runs(table, points, lines, passed, runs);
    let known = points.planes.len();
    let mut runs = add_slits(table, points, planes, slits, runs);
    if points.planes.len() > known {
        // the order of the numbers is that of the places
        let number = points.renumber(table);
        for run in &mut runs {
            (run.from, run.to) = (number[run.from.index()], number[run.to.index()]);
        }
    }
    let mut worker = LineWorker::new(table, points, lines, planes);
    let mut pieces = Vec::new();
    for group in runs.chunk_by(|a, b| a.line() == b.line()) {
        worker.cut(group, &[], &mut pieces, Crossed::No)?;
    }
    Ok(pieces)
}

/// Cuts runs of one region where they cross: at the points that several of them pass.
///
/// Each edge was cut there by what else goes through the point; since the region lies on the same side of the run before and
/// after, nothing else tells of it.
fn cut_runs(table: &PlaneTable, points: &Points, lines: &[Line], mut passed: Vec<Passed>, runs: Vec<Run>) -> Vec<Run> {
    passed.sort_unstable();
    let at_one_point = passed.chunk_by(|a, b| a.at == b.at);
    let crossing = at_one_point.filter(|passing| passing.first().map(|p| p.line) != passing.last().map(|p| p.line));
    let mut cuts: Vec<Cut> = crossing.flatten().map(|Passed { at, line }| Cut { line: *line, at: *at }).collect();
    if cuts.is_empty() {
        return runs;
    }
    cuts.sort_unstable();
    let mut out = Vec::with_capacity(runs.len() + cuts.len());
    let mut stops = Vec::new();
    for run in runs {
        let start = cuts.partition_point(|cut| (cut.line, cut.at.region) < (run.line(), run.region));
        let own = cuts[start..].iter().take_while(|cut| (cut.line, cut.at.region) == (run.line(), run.region));
        let line = &lines[run.line().index()];
        let (low, high) = if run.is_forward() { (run.from, run.to) } else { (run.to, run.from) };
        stops.clear();
        stops.extend([low, high]);
        stops.extend(own.map(|cut| cut.at.point).filter(|point| {
            line.compare(table, points, low, *point).is_lt() && line.compare(table, points, *point, high).is_lt()
        }));
        sort_along(table, points, line, &mut stops);
        out.extend(stops.windows(2).map(|ends| {
            let (from, to) = if run.is_forward() { (ends[0], ends[1]) } else { (ends[1], ends[0]) };
            Run { from, to, ..run }
        }));
    }
    out
}

/// Cuts slits of one region where they cross, and adds both directions of each to the runs, which stay ordered by line.
fn add_slits(
    table: &PlaneTable,
    points: &mut Points,
    planes: &[PlaneId],
    mut slits: Vec<Run>,
    mut runs: Vec<Run>,
) -> Vec<Run> {
    if slits.is_empty() {
        return runs;
    }
    slits.sort_unstable_by_key(|slit| (slit.region, slit.line()));
    for region in slits.chunk_by_mut(|a, b| a.region == b.region) {
        let mut pieces = region.to_vec();
        let plane = planes[region[0].region.index()];
        for cut in region.iter() {
            let mut k = 0;
            while k < pieces.len() {
                if let Some(point) = crossing(table, points, plane, &pieces[k], cut) {
                    let rest = Run { from: point, ..pieces[k] };
                    pieces[k].to = point;
                    pieces.push(rest);
                }
                k += 1;
            }
        }
        runs.extend(pieces.iter().flat_map(|slit| {
            let back = Run {
                from: slit.to,
                to: slit.from,
                edge: slit.edge.flipped(),
                along: DirectedLine::new(slit.line(), false),
                ..*slit
            };
            [*slit, back]
        }));
    }
    runs.sort_by_key(Run::line);
    runs
}

/// The point inside both of two pieces in which their lines cross.
fn crossing(table: &PlaneTable, points: &mut Points, plane: PlaneId, a: &Run, b: &Run) -> Option<PointId> {
    let lies_across = |piece: &Run, edge: PlaneId| {
        let [from, to] = [piece.from, piece.to].map(|point| points.side(table, point, edge));
        from != Sign::Zero && to == from.flip()
    };
    let cross = a.line() != b.line() && lies_across(a, b.edge) && lies_across(b, a.edge);
    cross.then(|| points.add(table, [plane, a.edge, b.edge]))
}
