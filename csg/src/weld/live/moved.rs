//! A plane that moves so little that nothing but places changes: the same edges, loops and faces, with their corners elsewhere.

use super::numbers::Context;
use super::pieces::Pieces;
use super::{Edge, LiveWeld};
use crate::boundary::BoundaryEdge;
use crate::ids::{EdgeId, FaceId, HalfEdgeId, Id, LineId, LoopId, PointId, RegionId};
use crate::plane_table::{PlaneId, PlaneTable};
use crate::weld::lines;
use crate::weld::points::{self, Triple};

/// All that moves with a plane; true until an edge comes or goes.
#[derive(Clone)]
pub(super) struct Moving {
    /// The index of the plane.
    plane: u32,
    points: Vec<PointId>,
    lines: Vec<LineId>,
    /// Half-edges that begin or end in one of the points, by region.
    pieces: Vec<(RegionId, HalfEdgeId)>,
    loops: Vec<LoopId>,
    faces: Vec<FaceId>,
}

impl LiveWeld {
    /// Whether it is known what moves with the plane of an index.
    pub(crate) fn knows_what_moves(&self, plane: u32) -> bool {
        self.moving.as_ref().is_some_and(|moving| moving.plane == plane)
    }

    /// Finds what moves with the plane of an index, of which some edges, each with its number, name all points and lines; false where
    /// a point or a line is known by the plane under one name and not under another: there more planes meet, and it does not stay one. It is also false where the plane that moved before has made
    /// lines the same as others: these are to be cut again.
    ///
    /// A point may be known by planes that no longer meet in it once this one has moved, as no edge has them any more: it is known by those of an edge then.
    pub(crate) fn find_what_moves<'a>(
        &mut self,
        table: &PlaneTable,
        plane: u32,
        edges: impl Iterator<Item = &'a (BoundaryEdge, EdgeId)>,
    ) -> bool {
        self.moving = None;
        if self.merge_lines(table) {
            return false;
        }
        let is_plane = |id: PlaneId| id.index() == plane;
        let mut along: Vec<LineId> = Vec::new();
        // each with a name that it has
        let mut names_of_points: Vec<(PointId, Triple)> = Vec::new();
        let mut names_of_lines: Vec<(LineId, u64)> = Vec::new();
        for (edge, number) in edges {
            let run = self.edges[number.index()].numbered.run;
            let is_line = is_plane(edge.face) || is_plane(edge.edge);
            let known = &self.numbers;
            if is_line != known.lines()[run.line().index()].planes.into_iter().any(is_plane) {
                return false;
            }
            let mut is_moved = is_line;
            for (end, point) in [(edge.start, run.from), (edge.end, run.to)] {
                let is_point = is_line || is_plane(end);
                if is_point != known.points().planes[point.index()].into_iter().any(is_plane) {
                    return false;
                }
                if is_point {
                    names_of_points.push((point, points::key([edge.face, edge.edge, end])));
                    is_moved = true;
                }
            }
            if is_line {
                names_of_lines.push((run.line(), lines::pair(edge)));
            }
            if is_moved {
                along.push(run.line());
            }
        }
        along.sort_unstable();
        along.dedup();
        names_of_points.sort_unstable();
        names_of_lines.sort_unstable();
        names_of_lines.dedup();
        let points: Vec<PointId> = names_of_points.chunk_by(|a, b| a.0 == b.0).map(|names| names[0].0).collect();
        let lines: Vec<LineId> = names_of_lines.chunk_by(|a, b| a.0 == b.0).map(|names| names[0].0).collect();
        if points.len() + lines.len() != self.numbers.known_by(plane) {
            return false;
        }
        // a line goes on to where other planes may meet in it
        let mut by_line = names_of_lines.chunk_by(|a, b| a.0 == b.0);
        if by_line.any(|names| names.len() != self.numbers.names_of_line(names[0].0)) {
            return false;
        }
        for names in names_of_points.chunk_by(|a, b| a.0 == b.0) {
            self.numbers.know_point(table, names[0].0, names.iter().map(|name| name.1));
        }
        for names in names_of_lines.chunk_by(|a, b| a.0 == b.0) {
            self.numbers.know_line(table, names[0].0, names.iter().map(|name| name.1));
        }
        let Pieces { half_edges, loop_of, .. } = &self.state.pieces;
        let is_moved = |point: PointId| points.binary_search(&point).is_ok();
        let on_lines = along.iter().flat_map(|line| &self.state.lines[line.index()].pieces);
        let pieces = on_lines.copied().filter_map(|number| {
            let piece = &half_edges[number.index()];
            (is_moved(piece.from) || is_moved(piece.to)).then_some((piece.region, number))
        });
        let mut pieces: Vec<(RegionId, HalfEdgeId)> = pieces.collect();
        pieces.sort_unstable();
        let mut loops: Vec<LoopId> = pieces.iter().map(|(_, piece)| loop_of[piece.index()]).collect();
        loops.sort_unstable();
        loops.dedup();
        let faces = self.state.faces.of_loops(&loops);
        self.moving = Some(Moving { plane, points, lines, pieces, loops, faces });
        true
    }

    /// Puts the edges of lines that a plane has moved to where others are on these; whether there are any.
    pub(super) fn merge_lines(&mut self, table: &PlaneTable) -> bool {
        let merged = self.numbers.mark_moved(table);
        for &[line, other] in &merged {
            for number in self.state.lines[line.index()].take_edges() {
                let Edge { numbered, is_gone } = &mut self.edges[number.index()];
                self.numbers.renumber(table, numbered, other);
                if !*is_gone {
                    self.state.lines[other.index()].add(number, [numbered.run.from, numbered.run.to]);
                }
            }
            self.state.mark_line(line);
            self.state.mark_line(other);
            self.merged.push(line);
        }
        !merged.is_empty()
    }

    /// Follows the plane that was asked for last, which has moved along its normal.
    pub(crate) fn follow_plane(&mut self, table: &PlaneTable) {
        let Some(moving) = self.moving.take() else { return };
        let (numbers, state) = (&mut self.numbers, &mut self.state);
        let by_region = || moving.pieces.chunk_by(|a, b| a.0 == b.0);
        for pieces in by_region() {
            state.regions.lift(&Context { table, numbers }, &state.pieces, pieces);
        }
        numbers.follow_plane(table, &moving.points, &moving.lines);
        let context = Context { table, numbers };
        for pieces in by_region() {
            state.regions.put_down(&context, &state.pieces, pieces);
        }
        state.faces.begin_changes();
        state.faces.follow(&context, &state.pieces, &moving.loops, &moving.faces);
        self.moving = Some(moving);
    }
}
