//! Boundary edges by the numbers of their lines, regions and ends.

use planecut_parallel::prelude::*;

use super::cancel::Run;
use super::lines::Line;
use crate::base::takes_much_memory;
use crate::boundary::BoundaryEdge;
use crate::ids::{Id, LineId, PointId, RegionId};
use crate::plane_table::PlaneTable;

/// Least number of edges that a thread looks at in a row.
const CHUNK: usize = 1 << 11;

/// Each boundary edge as a run of its line; lines, regions and ends of all are given by their numbers.
pub(super) fn runs(
    table: &PlaneTable,
    edges: Vec<BoundaryEdge>,
    lines: &[Line],
    of_edge: &[LineId],
    regions: &[RegionId],
    ends: &[[PointId; 2]],
) -> Vec<Run> {
    let run = |number: usize, edge: &BoundaryEdge| {
        let (line, [from, to]) = (of_edge[number], ends[number]);
        let along = lines[line.index()].directed(line, table, edge.face, edge.edge);
        Run { along, region: regions[number], edge: edge.edge, from, to }
    };
    if takes_much_memory::<BoundaryEdge>(edges.len()) {
        // collected in place of the edges, which are as large: a list as long as all edges less
        return edges.into_iter().enumerate().map(|(number, edge)| run(number, &edge)).collect();
    }
    edges.par_iter().enumerate().with_min_len(CHUNK).map(|(number, edge)| run(number, edge)).collect()
}
