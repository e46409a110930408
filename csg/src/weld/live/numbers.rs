//! Points, lines and regions of a boundary that changes: numbered as long as an edge names them.

use std::cmp::Ordering;

use planecut_kernel::DVec3;
use planecut_parallel::prelude::*;
use rustc_hash::FxHashMap;

use super::EDGES_FOR_THREADS;
use super::named_lines::NamedLines;
use super::named_points::NamedPoints;
use super::names::place;
use crate::boundary::BoundaryEdge;
use crate::ids::{Id, LineId, NameId, PointId, RegionId, number32};
use crate::model::MaterialId;
use crate::plane_table::{PlaneId, PlaneTable};
use crate::weld::cancel::Run;
use crate::weld::lines::{self, Line};
use crate::weld::nest::RegionPlane;
use crate::weld::points::{self, Points, right_handed};

/// An edge, and the names under which its points and its line are known.
#[derive(Debug, Clone, Copy)]
pub(super) struct NumberedEdge {
    pub(super) run: Run,
    ends: [NameId; 2],
    line: NameId,
}

/// All numbers in use. Those of entries that are free stay until they are used again.
#[derive(Clone, Default)]
pub(super) struct Numbers {
    points: NamedPoints,
    lines: NamedLines,
    region_numbers: FxHashMap<(PlaneId, MaterialId), RegionId>,
    /// The planes, the materials of regions, and by how many edges each is used.
    pub(super) planes: Vec<PlaneId>,
    materials: Vec<MaterialId>,
    region_uses: Vec<u32>,
    free_regions: Vec<RegionId>,
    /// By how many points and lines each plane is known, and those by which none is known any more.
    known_by: Vec<u32>,
    unnamed: Vec<u32>,
    /// The planes of new points and lines of an edge: a buffer.
    gained: Vec<PlaneId>,
    /// Points and lines that have moved since they were marked.
    unmarked: (Vec<PointId>, Vec<LineId>),
}

/// The planes, and what is numbered by them.
#[derive(Clone, Copy)]
pub(super) struct Context<'a> {
    pub(super) table: &'a PlaneTable,
    pub(super) numbers: &'a Numbers,
}

impl<'a> Context<'a> {
    /// The plane of a region.
    pub(super) fn plane(&self, region: RegionId) -> RegionPlane<'a> {
        RegionPlane::new(self.table, self.numbers.points(), self.numbers.planes[region.index()])
    }
}

impl Numbers {
    /// Makes room for the names of many edges: mostly two share a line, and more a point.
    pub(super) fn reserve(&mut self, edges: usize) {
        self.points.names.reserve(edges / 2 + edges / 16);
        self.lines.names.reserve(edges / 2 + edges / 16);
    }

    /// Numbers an edge.
    pub(super) fn take(&mut self, table: &PlaneTable, edge: &BoundaryEdge) -> NumberedEdge {
        let mut gained = std::mem::take(&mut self.gained);
        let ends = self.points.take(table, edge, &mut gained);
        let line = self.lines.take(table, edge, &mut gained);
        self.gain(&gained);
        gained.clear();
        self.gained = gained;
        let region = self.take_region(edge.face, edge.material, 1);
        self.numbered(table, edge, region, ends, line)
    }

    /// Numbers edges: their points on one thread and their lines on another, or where they are many with all threads.
    pub(super) fn take_all(&mut self, table: &PlaneTable, edges: &[BoundaryEdge]) -> Vec<NumberedEdge> {
        let Self { points, lines, .. } = self;
        let (mut by_points, mut by_lines) = (Vec::new(), Vec::new());
        let are_many = edges.len() >= EDGES_FOR_THREADS;
        let (ends, lines) = planecut_parallel::join(
            || match are_many {
                true => points.take_all(table, edges, &mut by_points),
                false => edges.iter().map(|edge| points.take(table, edge, &mut by_points)).collect(),
            },
            || match are_many {
                true => lines.take_all(table, edges, &mut by_lines),
                false => edges.iter().map(|edge| lines.take(table, edge, &mut by_lines)).collect(),
            },
        );
        self.gain(&by_points);
        self.gain(&by_lines);
        let regions = self.take_regions(edges);
        let named = edges.par_iter().with_min_len(1024).zip(regions).zip(ends).zip(lines);
        named.map(|(((edge, region), ends), line)| self.numbered(table, edge, region, ends, line)).collect()
    }

    /// Numbers the regions of many edges, those of one face in a row.
    fn take_regions(&mut self, edges: &[BoundaryEdge]) -> Vec<RegionId> {
        let mut regions = Vec::with_capacity(edges.len());
        for group in edges.chunk_by(|a, b| (a.face, a.material) == (b.face, b.material)) {
            let region = self.take_region(group[0].face, group[0].material, number32(group.len()));
            regions.resize(regions.len() + group.len(), region);
        }
        regions
    }

    /// An edge whose region, ends and line are numbered.
    fn numbered(
        &self,
        table: &PlaneTable,
        edge: &BoundaryEdge,
        region: RegionId,
        ends: [NameId; 2],
        line: NameId,
    ) -> NumberedEdge {
        let number = self.lines.names.thing(line);
        let [from, to] = ends.map(|end| self.points.names.thing(end));
        let along = self.lines.lines[number.index()].directed(number, table, edge.face, edge.edge);
        let run = Run { along, region, edge: edge.edge, from, to };
        NumberedEdge { run, ends, line }
    }

    /// Takes an edge out.
    pub(super) fn release(&mut self, edge: &NumberedEdge) {
        for end in edge.ends {
            if let Some(gone) = self.points.names.release(end) {
                self.points().planes[gone.index()].into_iter().for_each(|plane| self.lose(plane));
            }
        }
        if let Some(gone) = self.lines.names.release(edge.line) {
            self.lines()[gone.index()].planes.into_iter().for_each(|plane| self.lose(plane));
        }
        let (number, region) = (edge.run.region, edge.run.region.index());
        self.region_uses[region] -= 1;
        if self.region_uses[region] == 0 {
            self.region_numbers.remove(&(self.planes[region], self.materials[region]));
            self.free_regions.push(number);
        }
    }

    /// Notes that points or lines are known by planes.
    fn gain(&mut self, planes: &[PlaneId]) {
        for plane in planes {
            let at = plane.index() as usize;
            if at >= self.known_by.len() {
                self.known_by.resize(at + 1, 0);
            }
            self.known_by[at] += 1;
        }
    }

    /// Notes that a point or a line that was known by a plane is no more.
    fn lose(&mut self, plane: PlaneId) {
        let uses = &mut self.known_by[plane.index() as usize];
        *uses -= 1;
        if *uses == 0 {
            self.unnamed.push(plane.index());
        }
    }

    /// Whether a point or a line is known by the plane of an index.
    pub(super) fn names(&self, index: u32) -> bool {
        self.known_by(index) > 0
    }

    /// The indices of planes by which no point and no line is known any more, perhaps.
    pub(super) fn take_unnamed(&mut self) -> Vec<u32> {
        std::mem::take(&mut self.unnamed)
    }

    /// Makes a point known by the planes of one of some names that it has.
    pub(super) fn know_point(
        &mut self,
        table: &PlaneTable,
        point: PointId,
        mut names: impl Iterator<Item = points::Triple>,
    ) {
        let known = self.points().planes[point.index()];
        let Some(first) = names.next() else { return };
        if first == points::key(known) || names.any(|name| name == points::key(known)) {
            return;
        }
        // where it is stays: what is sorted by place is to find it there
        let planes = right_handed(table, points::planes(first));
        self.gain(&planes);
        self.points.points.planes[point.index()] = planes;
        known.into_iter().for_each(|plane| self.lose(plane));
    }

    /// The same for a line.
    pub(super) fn know_line(&mut self, table: &PlaneTable, line: LineId, mut names: impl Iterator<Item = u64>) {
        let known = self.lines()[line.index()].planes;
        let pair = lines::pair_of(known);
        let Some(first) = names.next() else { return };
        if first == pair || names.any(|name| name == pair) {
            return;
        }
        let named = Line::of(table, first);
        self.gain(&named.planes);
        self.lines.lines[line.index()] = named;
        known.into_iter().for_each(|plane| self.lose(plane));
    }

    pub(super) fn points(&self) -> &Points {
        &self.points.points
    }

    pub(super) fn lines(&self) -> &[Line] {
        &self.lines.lines
    }

    /// The order of points in space, whatever their numbers.
    pub(super) fn compare(&self, table: &PlaneTable, p: PointId, q: PointId) -> Ordering {
        self.points.compare(table, p, q)
    }

    /// The region of a plane and a material, where there is one.
    pub(super) fn region(&self, plane: PlaneId, material: MaterialId) -> Option<RegionId> {
        self.region_numbers.get(&(plane, material)).copied()
    }

    pub(super) fn material(&self, region: RegionId) -> MaterialId {
        self.materials[region.index()]
    }

    /// How many points and lines are known by the plane of an index.
    pub(super) fn known_by(&self, index: u32) -> usize {
        self.known_by.get(index as usize).map_or(0, |count| *count as usize)
    }

    /// Points and lines that a plane has moved, by which they are known, and which stay the same otherwise: puts the points where they are now. Lines do not
    /// change as long as the direction of the plane does not. What another plane has moved is [marked](Self::mark_moved).
    pub(super) fn follow_plane(&mut self, table: &PlaneTable, moved: &[PointId], lines: &[LineId]) {
        self.points.follow(table, moved);
        if self.unmarked.0.is_empty() {
            self.unmarked = (moved.to_vec(), lines.to_vec());
        }
    }

    /// Marks again what has moved, before anything is looked up by marks, or another plane moves. Bodies apart from each other may have got edges on one line: lines that are now the same as another are given, each with the
    /// other; their edges are to be [renumbered](Self::renumber), and they are to be [forgotten](Self::forget_line).
    pub(super) fn mark_moved(&mut self, table: &PlaneTable) -> Vec<[LineId; 2]> {
        if self.unmarked.0.is_empty() {
            return Vec::new();
        }
        let (points, lines) = std::mem::take(&mut self.unmarked);
        self.points.mark(&points);
        self.lines.mark(table, &lines)
    }

    /// Puts an edge on another line that is the same as its own.
    pub(super) fn renumber(&mut self, table: &PlaneTable, edge: &mut NumberedEdge, line: LineId) {
        self.lines.names.rename(edge.line, line);
        let face = self.planes[edge.run.region.index()];
        edge.run.along = self.lines()[line.index()].directed(line, table, face, edge.run.edge);
    }

    /// Forgets a line whose edges are all renumbered.
    pub(super) fn forget_line(&mut self, line: LineId) {
        self.lines.names.free(line);
        self.lines()[line.index()].planes.into_iter().for_each(|plane| self.lose(plane));
    }

    /// By how many names a line is known.
    pub(super) fn names_of_line(&self, line: LineId) -> usize {
        self.lines.names.count_of(line)
    }

    /// Numbers a region of which a number of edges come.
    fn take_region(&mut self, plane: PlaneId, material: MaterialId, edges: u32) -> RegionId {
        let number = *self.region_numbers.entry((plane, material)).or_insert_with(|| {
            let number: RegionId = place(&mut self.planes, &mut self.free_regions, plane);
            if number.index() == self.materials.len() {
                self.materials.push(material);
                self.region_uses.push(0);
            }
            self.materials[number.index()] = material;
            number
        });
        self.region_uses[number.index()] += edges;
        number
    }

    pub(super) fn position(&self, point: PointId) -> DVec3 {
        self.points().positions[point.index()]
    }
}
