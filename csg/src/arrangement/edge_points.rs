//! The points inside of edges, at which the triangles there are cut.

use planecut_parallel::prelude::*;
use rustc_hash::FxHashMap;

use super::points::{PointKey, Points};
use super::surface::{Surface, sorted};
use crate::closed_mesh::connectivity::NO_TWIN;
use crate::ids::{Id, PointId, TriangleId, number32};

/// Points or edges that one thread looks at in a row.
const CHUNK: usize = 1 << 9;

/// A point inside an edge.
#[derive(Debug, Clone, Copy)]
pub(super) struct PointOnEdge {
    /// A half-edge along it.
    pub(super) side: u32,
    pub(super) key: PointKey,
}

/// The points inside of edges, in order.
#[derive(Debug, Default)]
pub(super) struct EdgePoints {
    /// For each edge that has any the range of its points, from its smaller end on.
    ranges: FxHashMap<[PointId; 2], [u32; 2]>,
    points: Vec<PointId>,
}

impl EdgePoints {
    /// The points at which edges are cut; and the triangles at these edges.
    pub(super) fn new(surface: &Surface<'_>, points: &Points, cuts: &[PointOnEdge]) -> (Self, Vec<TriangleId>) {
        let edge = |side: u32| surface.edge(TriangleId::from_index(side as usize / 3), side as usize % 3);
        let mut all: Vec<([PointId; 2], PointId)> =
            cuts.par_iter().with_min_len(CHUNK).map(|cut| (edge(cut.side), points.of_key(&cut.key))).collect();
        all.par_sort_unstable();
        all.dedup();
        let groups: Vec<&[([PointId; 2], PointId)]> = all.chunk_by(|a, b| a.0 == b.0).collect();
        let sorted = |group: &&[([PointId; 2], PointId)]| {
            let ends = group[0].0;
            let mut within: Vec<PointId> =
                group.iter().map(|(_, point)| *point).filter(|point| !ends.contains(point)).collect();
            points.sort_along(surface, ends[0], ends[1], &mut within);
            (ends, within)
        };
        let along: Vec<([PointId; 2], Vec<PointId>)> = groups.par_iter().with_min_len(CHUNK).map(sorted).collect();
        let mut found = Self::default();
        found.ranges.reserve(along.len());
        for (ends, within) in along {
            let start = number32(found.points.len());
            found.points.extend(&within);
            found.ranges.insert(ends, [start, number32(found.points.len())]);
        }
        let mut triangles = Vec::new();
        let mut has_lone_edges = false;
        for cut in cuts {
            triangles.push(TriangleId::from_index(cut.side as usize / 3));
            match surface.twins[cut.side as usize] {
                NO_TWIN => has_lone_edges = true,
                twin => triangles.push(TriangleId::from_index(twin as usize / 3)),
            }
        }
        if has_lone_edges {
            let lone = (0..).zip(&surface.twins).filter(|(_, twin)| **twin == NO_TWIN).map(|(side, _)| side);
            let cut = lone.filter(|side: &u32| found.ranges.contains_key(&edge(*side)));
            triangles.extend(cut.map(|side| TriangleId::from_index(side as usize / 3)));
        }
        triangles.par_sort_unstable();
        triangles.dedup();
        (found, triangles)
    }

    /// The points of an edge from one end on, that one included, the other not.
    pub(super) fn from(&self, from: PointId, to: PointId) -> impl Iterator<Item = PointId> + '_ {
        let [start, end] = self.ranges.get(&sorted(from, to)).copied().unwrap_or([0, 0]);
        let within = &self.points[start as usize..end as usize];
        let is_reversed = from > to;
        let inner = (0..within.len()).map(move |k| within[if is_reversed { within.len() - 1 - k } else { k }]);
        std::iter::once(from).chain(inner)
    }
}
