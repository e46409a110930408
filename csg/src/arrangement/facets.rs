//! Facets: the triangles that nothing cuts, the cells of the others, and the patches that nothing touches; and which of them meet at an edge.

use planecut_parallel::prelude::*;
use rustc_hash::FxHashMap;

use super::Arrangement;
use super::subdivide::Cells;
use super::surface::sorted;
use crate::ids::{FacetId, Id, InputTriangleId, PatchId, PointId, TriangleId, number32};

/// Facets that one thread looks at in a row.
const CHUNK: usize = 1 << 13;

/// What a facet is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum FacetKind {
    /// A triangle of the surface.
    Triangle(TriangleId),
    /// A cell of a triangle, by its number.
    Cell(usize),
    /// A part of an operand that nothing touches.
    Patch(PatchId),
}

/// A facet at an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) struct Side {
    /// The ends of the edge, in ascending order.
    pub(super) ends: [PointId; 2],
    pub(super) facet: FacetId,
    /// Whether the facet, as its triangle is seen, runs along the edge from the smaller end to the larger one.
    pub(super) is_forward: bool,
}

/// Another triangle's cell at the very place of a facet.
#[derive(Debug, Clone, Copy)]
pub(super) struct Double {
    pub(super) facet: FacetId,
    /// Whether both face the same way.
    pub(super) is_same: bool,
}

/// Facets. The first ones are the triangles, by their numbers; cells follow, then patches.
#[derive(Debug)]
pub(super) struct Facets {
    triangles: usize,
    cells: usize,
    /// Triangles that were cut into cells, or have no area, and facets that are doubles of others.
    is_gone: Vec<bool>,
    doubles: FxHashMap<FacetId, Vec<Double>>,
    /// The facets at edges, by edge; of edges within patches there are none.
    pub(super) sides: Vec<Side>,
    /// Where the sides of each edge end.
    pub(super) edge_ends: Vec<u32>,
}

impl Facets {
    pub(super) fn new(arrangement: &Arrangement<'_>, is_split: Vec<bool>, is_doubled: &[bool]) -> Self {
        let (triangles, cells) = (arrangement.surface.len(), arrangement.cells.len());
        let count = triangles + cells + arrangement.patches.all.len();
        let mut facets = Self {
            triangles,
            cells,
            is_gone: is_split,
            doubles: FxHashMap::default(),
            sides: Vec::new(),
            edge_ends: Vec::new(),
        };
        facets.is_gone.resize(count, false);
        facets.join_doubles(arrangement, is_doubled);
        facets.find_sides(arrangement);
        facets
    }

    /// The number of facets, those that are gone included.
    pub(super) fn len(&self) -> usize {
        self.is_gone.len()
    }

    /// Whether a facet is none any more.
    #[inline]
    pub(super) fn is_gone(&self, facet: FacetId) -> bool {
        self.is_gone[facet.index()]
    }

    /// What a facet is.
    #[inline]
    pub(super) fn kind(&self, facet: FacetId) -> FacetKind {
        let k = facet.index();
        if k < self.triangles {
            FacetKind::Triangle(TriangleId::from_index(k))
        } else if k < self.triangles + self.cells {
            FacetKind::Cell(k - self.triangles)
        } else {
            FacetKind::Patch(PatchId::from_index(k - self.triangles - self.cells))
        }
    }

    /// A cell as a facet.
    fn of_cell(&self, cell: usize) -> FacetId {
        FacetId::from_index(self.triangles + cell)
    }

    /// A patch as a facet.
    pub(super) fn of_patch(&self, patch: PatchId) -> FacetId {
        FacetId::from_index(self.triangles + self.cells + patch.index())
    }

    /// The triangles and cells.
    pub(super) fn flat_ones(&self) -> impl Iterator<Item = FacetId> + '_ {
        FacetId::all(self.triangles + self.cells).filter(|facet| !self.is_gone(*facet))
    }

    /// The triangle that a facet is a part of, which is no patch.
    #[inline]
    pub(super) fn triangle(&self, cells: &Cells, facet: FacetId) -> TriangleId {
        match self.kind(facet) {
            FacetKind::Triangle(triangle) => triangle,
            FacetKind::Cell(cell) => cells.triangles[cell],
            FacetKind::Patch(_) => unreachable!("a patch is part of no triangle"),
        }
    }

    /// Facets at the very place of one.
    pub(super) fn doubles(&self, facet: FacetId) -> &[Double] {
        self.doubles.get(&facet).map_or(&[], Vec::as_slice)
    }

    /// The sides at an edge.
    pub(super) fn sides_at(&self, edge: u32) -> &[Side] {
        let edge = edge as usize;
        let start = if edge == 0 { 0 } else { self.edge_ends[edge - 1] as usize };
        &self.sides[start..self.edge_ends[edge] as usize]
    }

    /// The sides at the edge between two points, if it is listed.
    pub(super) fn edge_between(&self, ends: [PointId; 2]) -> Option<&[Side]> {
        let start = self.sides.partition_point(|side| side.ends < ends);
        let count = self.sides[start..].iter().take_while(|side| side.ends == ends).count();
        (count > 0).then(|| &self.sides[start..start + count])
    }

    fn join_doubles(&mut self, arrangement: &Arrangement<'_>, is_doubled: &[bool]) {
        let mut first: FxHashMap<Vec<PointId>, (FacetId, bool)> = FxHashMap::default();
        for facet in FacetId::all(self.triangles + self.cells) {
            let triangle = self.triangle(&arrangement.cells, facet);
            if self.is_gone(facet) || !is_doubled[triangle.index()] {
                continue;
            }
            let (key, is_reversed) = match self.kind(facet) {
                FacetKind::Cell(cell) => {
                    canonical(arrangement.cells.loops(cell).next().expect("a cell has a boundary"))
                }
                _ => canonical(&arrangement.surface.corners(triangle)),
            };
            let (like, is_like_reversed) = *first.entry(key).or_insert((facet, is_reversed));
            if like != facet {
                self.is_gone[facet.index()] = true;
                let is_same = is_reversed == is_like_reversed;
                self.doubles.entry(like).or_default().push(Double { facet, is_same });
            }
        }
    }

    fn find_sides(&mut self, arrangement: &Arrangement<'_>) {
        let Arrangement { surface, cells, patches, .. } = arrangement;
        let of_triangle = |triangle: usize| {
            let corners = surface.corners[triangle];
            let count = if self.is_gone[triangle] { 0 } else { 3 };
            (0..count).map(move |k| side(FacetId::from_index(triangle), corners[k], corners[(k + 1) % 3]))
        };
        let mut sides: Vec<Side> =
            (0..self.triangles).into_par_iter().with_min_len(CHUNK).flat_map_iter(of_triangle).collect();
        for cell in 0..cells.len() {
            let facet = self.of_cell(cell);
            if !self.is_gone(facet) {
                for points in cells.loops(cell) {
                    sides.extend((0..points.len()).map(|k| side(facet, points[k], points[(k + 1) % points.len()])));
                }
            }
        }
        for &(half_edge, twin) in &surface.seams {
            let (operand, triangle) = surface.input.of_triangle(InputTriangleId::from_index(twin as usize / 3));
            let patch = patches.of(operand, triangle).expect("what is not touched belongs to a patch");
            let corners = surface.corners[half_edge as usize / 3];
            let [from, to] = [half_edge as usize % 3, (half_edge as usize + 1) % 3].map(|k| corners[k]);
            sides.push(side(self.of_patch(patch), to, from));
        }
        sides.par_sort_unstable();
        let mut end = 0;
        for group in sides.chunk_by(|a, b| a.ends == b.ends) {
            end += group.len();
            self.edge_ends.push(number32(end));
        }
        self.sides = sides;
    }
}

fn side(facet: FacetId, from: PointId, to: PointId) -> Side {
    Side { ends: sorted(from, to), facet, is_forward: from < to }
}

/// A loop from its smallest point on, in the direction in which it is smaller; and whether that is not the direction given.
fn canonical(points: &[PointId]) -> (Vec<PointId>, bool) {
    let least = points.iter().min().expect("a loop has points");
    let count = points.len();
    let starts = (0..count).filter(|k| points[*k] == *least);
    let forward = |start: usize| (0..count).map(|k| points[(start + k) % count]).collect::<Vec<_>>();
    let back = |start: usize| (0..count).map(|k| points[(start + count - k) % count]).collect::<Vec<_>>();
    starts.flat_map(|start| [(forward(start), false), (back(start), true)]).min().expect("a loop has points")
}
