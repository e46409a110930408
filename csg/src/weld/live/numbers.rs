//! Points, lines and regions of a boundary that changes: numbered as long as an edge names them.

use std::cmp::Ordering;

use planecut_kernel::{DVec3, compare_exactly};
use rustc_hash::FxHashMap;

use super::names::{Names, place};
use crate::base::{map_chunks, sortable};
use crate::boundary::BoundaryEdge;
use crate::ids::{Id, LineId, NameId, PointId, RegionId};
use crate::model::MaterialId;
use crate::plane_table::{PlaneId, PlaneTable, curve_number};
use crate::weld::cancel::Run;
use crate::weld::lines::{self, AxisPlanes, Line};
use crate::weld::nest::RegionPlane;
use crate::weld::points::{self, Named, Points};

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
    point_names: Names<points::Triple, [u64; 3], PointId>,
    line_names: Names<u64, lines::Key, LineId>,
    pub(super) points: Points,
    /// For each point its place on the curve by which points are ordered.
    places: Vec<u64>,
    pub(super) lines: Vec<Line>,
    region_numbers: FxHashMap<(PlaneId, MaterialId), RegionId>,
    /// The planes, the materials of regions, and by how many edges each is used.
    pub(super) planes: Vec<PlaneId>,
    materials: Vec<MaterialId>,
    region_uses: Vec<u32>,
    free_regions: Vec<RegionId>,
    /// By how many points and lines each plane is known, and those by which none is known any more.
    known_by: Vec<u32>,
    unnamed: Vec<u32>,
    axes: AxisPlanes,
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
        RegionPlane::new(self.table, &self.numbers.points, self.numbers.planes[region.index()])
    }
}

/// Number of points from which several threads work out where they are.
const POINTS_FOR_THREADS: usize = 256;

/// What equal points share.
fn mark_of(position: DVec3) -> [u64; 3] {
    position.to_array().map(sortable)
}

impl Numbers {
    /// Numbers an edge.
    pub(super) fn take(&mut self, table: &PlaneTable, edge: &BoundaryEdge) -> NumberedEdge {
        self.mark_moved(table);
        let [from, to] = [edge.start, edge.end].map(|end| self.take_point(table, [edge.face, edge.edge, end]));
        let line = self.take_line(table, edge);
        let line_number = self.line_names.thing(line);
        let run = Run {
            line: line_number,
            region: self.take_region(edge.face, edge.material),
            edge: edge.edge,
            from: self.point_names.thing(from),
            to: self.point_names.thing(to),
            forward: self.lines[line_number.index()].is_along(table, edge.face, edge.edge),
        };
        NumberedEdge { run, ends: [from, to], line }
    }

    /// Takes an edge out.
    pub(super) fn release(&mut self, edge: &NumberedEdge) {
        for end in edge.ends {
            if let Some(gone) = self.point_names.release(end) {
                self.points.planes[gone.index()].into_iter().for_each(|plane| self.lose(plane));
            }
        }
        if let Some(gone) = self.line_names.release(edge.line) {
            self.lines[gone.index()].planes.into_iter().for_each(|plane| self.lose(plane));
        }
        let (number, region) = (edge.run.region, edge.run.region.index());
        self.region_uses[region] -= 1;
        if self.region_uses[region] == 0 {
            self.region_numbers.remove(&(self.planes[region], self.materials[region]));
            self.free_regions.push(number);
        }
    }

    /// Notes that a point or a line is known by a plane.
    fn gain(&mut self, plane: PlaneId) {
        let at = plane.index() as usize;
        if at >= self.known_by.len() {
            self.known_by.resize(at + 1, 0);
        }
        self.known_by[at] += 1;
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

    /// The order of points in space, whatever their numbers.
    pub(super) fn compare(&self, table: &PlaneTable, p: PointId, q: PointId) -> Ordering {
        if p == q {
            return Ordering::Equal;
        }
        let by_curve = self.places[p.index()].cmp(&self.places[q.index()]);
        if by_curve.is_ne() {
            return by_curve;
        }
        let coordinates = |point: PointId| self.points.positions[point.index()].to_array().map(sortable);
        let rows = |point: PointId| self.points.planes[point.index()].map(|plane| table.row(plane));
        coordinates(p).cmp(&coordinates(q)).then_with(|| compare_exactly(rows(p), rows(q), &[0, 1, 2]))
    }

    /// The region of a plane and a material, where there is one.
    pub(super) fn region(&self, plane: PlaneId, material: MaterialId) -> Option<RegionId> {
        self.region_numbers.get(&(plane, material)).copied()
    }

    pub(super) fn material(&self, region: RegionId) -> MaterialId {
        self.materials[region.index()]
    }

    fn take_point(&mut self, table: &PlaneTable, triple: [PlaneId; 3]) -> NameId {
        let name = points::key(triple);
        if let Some(known) = self.point_names.find(&name) {
            return known;
        }
        let named = Named::of(table, points::planes(name));
        let mark = mark_of(named.position);
        let is_same = |point: PointId| points::is_at(table, self.points.planes[point.index()], named.planes);
        let (id, is_new) = self.point_names.add(name, mark, is_same);
        if is_new {
            let number = self.point_names.thing(id);
            if number.index() == self.places.len() {
                self.points.push(&named);
                self.places.push(0);
            } else {
                self.points.put(number, &named);
            }
            self.places[number.index()] = curve_number(named.position);
            named.planes.into_iter().for_each(|plane| self.gain(plane));
        }
        id
    }

    fn take_line(&mut self, table: &PlaneTable, edge: &BoundaryEdge) -> NameId {
        let name = lines::pair(edge);
        if let Some(known) = self.line_names.find(&name) {
            return known;
        }
        let line = Line::of(table, name);
        let is_same = |other: LineId| self.axes.is_same(table, &self.lines[other.index()], &line);
        let (id, is_new) = self.line_names.add(name, lines::key(table, &line), is_same);
        if is_new {
            let number = self.line_names.thing(id).index();
            if number == self.lines.len() {
                self.lines.push(line);
            } else {
                self.lines[number] = line;
            }
            line.planes.into_iter().for_each(|plane| self.gain(plane));
        }
        id
    }

    /// How many points and lines are known by the plane of an index.
    pub(super) fn known_by(&self, index: u32) -> usize {
        self.known_by.get(index as usize).map_or(0, |count| *count as usize)
    }

    /// Points and lines that a plane has moved, by which they are known, and which stay the same otherwise: puts the points where they are now. Lines do not
    /// change as long as the direction of the plane does not.
    pub(super) fn follow_plane(&mut self, table: &PlaneTable, moved: &[PointId], lines: &[LineId]) {
        let follow =
            |points: &[PointId]| points.iter().map(|point| self.points.moved(table, *point)).collect::<Vec<_>>();
        let places: Vec<(DVec3, u8)> = if moved.len() < 2 * POINTS_FOR_THREADS {
            follow(moved)
        } else {
            map_chunks(moved, POINTS_FOR_THREADS, follow).0.concat()
        };
        for (point, place) in moved.iter().zip(places) {
            self.points.put_at(*point, place);
            self.places[point.index()] = curve_number(place.0);
        }
        if self.unmarked.0 != moved {
            self.mark_moved(table);
            self.unmarked = (moved.to_vec(), lines.to_vec());
        }
    }

    /// Marks again what has moved, before anything is looked up by marks.
    fn mark_moved(&mut self, table: &PlaneTable) {
        if self.unmarked.0.is_empty() {
            return;
        }
        let (points, lines) = std::mem::take(&mut self.unmarked);
        for point in points {
            self.point_names.set_mark(point, mark_of(self.points.positions[point.index()]));
        }
        for line in lines {
            if self.line_names.is_in_use(line) {
                self.line_names.set_mark(line, lines::key(table, &self.lines[line.index()]));
            }
        }
    }

    fn take_region(&mut self, plane: PlaneId, material: MaterialId) -> RegionId {
        let number = *self.region_numbers.entry((plane, material)).or_insert_with(|| {
            let number: RegionId = place(&mut self.planes, &mut self.free_regions, plane);
            if number.index() == self.materials.len() {
                self.materials.push(material);
                self.region_uses.push(0);
            }
            self.materials[number.index()] = material;
            number
        });
        self.region_uses[number.index()] += 1;
        number
    }

    pub(super) fn position(&self, point: PointId) -> DVec3 {
        self.points.positions[point.index()]
    }
}
