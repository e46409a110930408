//! Boundary edges by the numbers of their lines, regions and ends.

use planecut_parallel::prelude::*;

use super::cancel::Run;
use super::lines::Line;
use crate::boundary::BoundaryEdge;
use crate::ids::{DirectedLine, EdgeId, Id, LineId, PointId, RegionId};
use crate::plane_table::{PlaneId, PlaneTable};

/// Least number of edges that a thread looks at in a row.
const CHUNK: usize = 1 << 11;

/// Boundary edges by their numbers. Each number is in a list of its own, as it comes: put together, they would all be there twice meanwhile.
pub(super) struct NumberedEdges {
    lines: Vec<DirectedLine>,
    regions: Vec<RegionId>,
    planes: Vec<PlaneId>,
    ends: Vec<[PointId; 2]>,
}

impl NumberedEdges {
    /// Those whose lines, regions and ends have these numbers.
    pub(super) fn of(
        table: &PlaneTable,
        edges: &[BoundaryEdge],
        lines: &[Line],
        of_edge: &[LineId],
        regions: Vec<RegionId>,
        ends: Vec<[PointId; 2]>,
    ) -> Self {
        let directed = |(edge, line): (&BoundaryEdge, &LineId)| {
            DirectedLine::new(*line, lines[line.index()].is_along(table, edge.face, edge.edge))
        };
        let lines = edges.par_iter().zip(of_edge).with_min_len(CHUNK).map(directed).collect();
        let planes = edges.par_iter().with_min_len(CHUNK).map(|edge| edge.edge).collect();
        Self { lines, regions, planes, ends }
    }

    /// An edge as a run of its line.
    pub(super) fn run(&self, edge: EdgeId) -> Run {
        let edge = edge.index();
        let [from, to] = self.ends[edge];
        let along = self.lines[edge];
        let (line, forward) = (along.line(), along.is_forward());
        Run { line, region: self.regions[edge], edge: self.planes[edge], from, to, forward }
    }
}
