//! Where climbs start: a table from directions to vertices.
//!
//! The directions are divided into the octants, with many planes into the cells of a cube map. Each part remembers where the
//! last climb in one of its directions ended, by a vertex and one of its planes: where the vertex is gone, which happens
//! much more often, another one of the same face serves. The table grows with the planes, so a climb takes a few steps at
//! any number of them ("jump and walk").

use super::IncrementalPolytope;
use super::store::NONE;
use crate::sign::Row;

/// Largest number of planes for which the eight octants suffice.
const PLANES_FOR_OCTANTS: u32 = 192;

/// Cells along the edge of a face of the first cube map.
const FIRST_RESOLUTION: u32 = 4;

/// A cube map grows when there are more planes than this for each cell.
const PLANES_PER_CELL: u32 = 8;

/// Where a climb ended; the slots may be free by now, or hold others.
#[derive(Debug, Clone, Copy)]
struct Start {
    plane: u32,
    vertex: u32,
}

impl Start {
    const UNKNOWN: Self = Self { plane: NONE, vertex: NONE };
}

/// A table from directions to where climbs ended.
#[derive(Debug)]
pub(super) struct Starts {
    cells: Vec<Start>,
    /// Cells along the edge of a face of the cube map, a power of two; zero for the octants.
    resolution: u32,
    /// A vertex near the last change, which is there, and the normal of the plane that came or went.
    latest: u32,
    latest_normal: [f64; 4],
}

impl Default for Starts {
    fn default() -> Self {
        Self { cells: vec![Start::UNKNOWN; 8], resolution: 0, latest: 0, latest_normal: [1.0; 4] }
    }
}

impl Clone for Starts {
    fn clone(&self) -> Self {
        Self { cells: self.cells.clone(), ..*self }
    }

    fn clone_from(&mut self, source: &Self) {
        self.cells.clone_from(&source.cells);
        self.resolution = source.resolution;
        self.latest = source.latest;
        self.latest_normal = source.latest_normal;
    }
}

impl Starts {
    /// Forgets everything but that `latest` is there.
    pub(super) fn reset(&mut self, latest: u32) {
        self.cells.clear();
        self.cells.resize(8, Start::UNKNOWN);
        self.resolution = 0;
        self.latest = latest;
    }

    /// The plane with this row came or went near a vertex.
    #[inline]
    pub(super) fn set_latest(&mut self, vertex: u32, row: &Row) {
        self.latest = vertex;
        if self.resolution > 0 {
            self.latest_normal = *row.coefficients();
        }
    }

    /// The cell of a direction.
    #[inline(always)]
    fn cell(&self, coefficients: &[f64; 4]) -> usize {
        if self.resolution == 0 { octant(coefficients) } else { self.cell_of_cube_map(coefficients) }
    }

    #[inline(never)]
    fn cell_of_cube_map(&self, [x, y, z, _]: &[f64; 4]) -> usize {
        let (mut face, mut largest, mut u, mut v) = (0, x, y, z);
        (face, largest, u, v) = if y.abs() > largest.abs() { (2, y, z, x) } else { (face, largest, u, v) };
        (face, largest, u, v) = if z.abs() > largest.abs() { (4, z, x, y) } else { (face, largest, u, v) };
        face += usize::from(*largest < 0.0);
        let half = 0.5 * f64::from(self.resolution);
        let scale = half / largest.abs();
        // the conversion rounds down; the upper end belongs to the last cell
        let place = |t: f64| ((half + t * scale) as u32).min(self.resolution - 1) as usize;
        (face * self.resolution as usize + place(*u)) * self.resolution as usize + place(*v)
    }

    /// Makes the cells smaller; those of a cube map begin with what the cell they come from knew.
    fn refine(&mut self) {
        let old = self.resolution as usize;
        let new = if old == 0 { FIRST_RESOLUTION as usize } else { 2 * old };
        let known = std::mem::take(&mut self.cells);
        let parent = |cell: usize| {
            let (face, u, v) = (cell / (new * new), cell / new % new, cell % new);
            (face * old + u / 2) * old + v / 2
        };
        let begin = |cell: usize| if old == 0 { Start::UNKNOWN } else { known[parent(cell)] };
        self.cells = (0..6 * new * new).map(begin).collect();
        self.resolution = new as u32;
    }

    /// How many planes the table is fine enough for.
    #[inline]
    fn capacity(&self) -> u32 {
        if self.resolution == 0 { PLANES_FOR_OCTANTS } else { PLANES_PER_CELL * self.cells.len() as u32 }
    }
}

impl IncrementalPolytope {
    /// Lets the table grow with the number of planes.
    #[inline]
    pub(super) fn grow_starts(&mut self) {
        if self.planes.slot_count() > self.starts.capacity() {
            self.refine_starts();
        }
    }

    #[cold]
    #[inline(never)]
    fn refine_starts(&mut self) {
        self.starts.refine();
        for plane in self.planes.faces() {
            let cell = self.starts.cell(self.planes.row(plane).coefficients());
            self.starts.cells[cell] = Start { plane, vertex: self.planes.face_vertex(plane) };
        }
    }

    /// A vertex from which a climb in direction `normal` is short.
    #[inline(always)]
    pub(super) fn start(&self, normal: &Row) -> u32 {
        if self.starts.resolution == 0 {
            let Start { plane, vertex } = self.starts.cells[octant(normal.coefficients())];
            return if self.vertices.is_on(vertex, plane) { vertex } else { self.starts.latest };
        }
        self.start_of_cube_map(normal)
    }

    #[inline(never)]
    fn start_of_cube_map(&self, normal: &Row) -> u32 {
        let starts = &self.starts;
        let cell = starts.cell_of_cube_map(normal.coefficients());
        // what was touched last is still in the caches
        if starts.cell_of_cube_map(&starts.latest_normal) == cell {
            return starts.latest;
        }
        let beside = [0, 1, starts.resolution as usize].map(|step| cell ^ step);
        beside.into_iter().find_map(|cell| self.known_start(cell, normal)).unwrap_or(starts.latest)
    }

    /// Remembers that a climb in direction `normal` ended at a vertex, which is one of `plane`.
    #[inline]
    pub(super) fn note_start(&mut self, normal: &Row, plane: u32, vertex: u32) {
        let cell = self.starts.cell(normal.coefficients());
        self.starts.cells[cell] = Start { plane, vertex };
        self.starts.set_latest(vertex, normal);
    }

    /// What the table says of a cell.
    #[inline]
    fn known_start(&self, cell: usize, normal: &Row) -> Option<u32> {
        let Start { plane, vertex } = self.starts.cells[cell];
        if self.vertices.is_on(vertex, plane) {
            return Some(vertex);
        }
        let has_face = plane < self.planes.slot_count() && self.planes.has_face(plane);
        // a plane that took the slot of another may be far away
        (has_face && is_near(self.row(plane), normal)).then(|| self.planes.face_vertex(plane))
    }
}

/// Whether two normals are less than 30° apart.
fn is_near(a: &Row, b: &Row) -> bool {
    let dot = |a: &Row, b: &Row| (0..3).map(|k| a.coefficients()[k] * b.coefficients()[k]).sum::<f64>();
    let product = dot(a, b);
    product > 0.0 && product * product > 0.75 * dot(a, a) * dot(b, b)
}

#[inline(always)]
fn octant([x, y, z, _]: &[f64; 4]) -> usize {
    let sign = |v: &f64| (v.to_bits() >> 63) as usize;
    sign(x) << 2 | sign(y) << 1 | sign(z)
}
