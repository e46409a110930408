//! Corners of a region that touch the inside of one of its edges: there the edge is cut as well.

use planecut_kernel::DVec3;
use planecut_kernel::sign::{Counts, Sign};

use super::cancel::HalfEdge;
use super::points::Points;
use super::regions_of;
use crate::base::{Bounds, Boxes, map_chunks};
use crate::ids::{Id, PointId, PointOnLine};
use crate::plane_table::PlaneTable;

/// Regions of fewer corners are searched edge by edge.
const MANY: usize = 24;

/// More corners that agree with an edge in one coordinate are searched by a tree: in a plane with many separate faces, in rows and columns,
/// there are as many of them as in a row.
const FEW: usize = 32;

/// Where a corner of a region lies inside one of its edges, by line; half-edges are sorted by
/// region.
pub(super) fn find(table: &PlaneTable, points: &Points, pieces: &[HalfEdge]) -> (Vec<PointOnLine>, Counts) {
    let (parts, counts) = map_chunks(&regions_of(pieces), 16, |chunk| {
        let mut finder = PinchFinder::new(table, points);
        for range in chunk {
            finder.search(&pieces[range.clone()]);
        }
        finder.found
    });
    let mut pinches = parts.concat();
    pinches.sort_unstable();
    pinches.dedup();
    (pinches, counts)
}

/// Finds corners that touch the inside of edges, reusing its buffers.
pub(super) struct PinchFinder<'a> {
    table: &'a PlaneTable,
    points: &'a Points,
    corners: Vec<PointId>,
    /// Where they are.
    places: Vec<DVec3>,
    /// Corners by each of their coordinates.
    sorted: [Vec<PointId>; 3],
    /// What was found.
    pub(super) found: Vec<PointOnLine>,
    /// How many corners were held against the box of an edge.
    #[cfg(test)]
    looked_at: usize,
}

impl<'a> PinchFinder<'a> {
    pub(super) fn new(table: &'a PlaneTable, points: &'a Points) -> Self {
        Self {
            table,
            points,
            corners: Vec::new(),
            places: Vec::new(),
            sorted: Default::default(),
            found: Vec::new(),
            #[cfg(test)]
            looked_at: 0,
        }
    }

    /// Finds those of one region.
    pub(super) fn search(&mut self, region: &[HalfEdge]) {
        // what touches itself has at least two triangles
        if region.len() <= 4 {
            return;
        }
        // each corner begins an edge
        self.corners.clear();
        self.corners.extend(region.iter().map(|piece| piece.from));
        self.corners.dedup();
        if self.corners.len() < MANY {
            self.places.clear();
            self.places.extend(self.corners.iter().map(|corner| self.points.positions[corner.index()]));
            for piece in region {
                let Bounds { min, max } = self.points.extent(piece);
                let is_inside = |at: &DVec3| at.cmpge(min).all() & at.cmple(max).all();
                // both ends are
                if self.places.iter().filter(|at| is_inside(at)).count() > 2 {
                    let corners = std::mem::take(&mut self.corners);
                    self.touching(piece, &corners);
                    self.corners = corners;
                }
            }
            return;
        }
        let mut sorted = std::mem::take(&mut self.sorted);
        let (mut tree, mut found, mut near) = (None, Vec::new(), Vec::new());
        for (axis, sorted) in sorted.iter_mut().enumerate() {
            let coordinate = |p: PointId| self.points.positions[p.index()][axis];
            sorted.clear();
            sorted.extend_from_slice(&self.corners);
            sorted.sort_unstable_by(|p, q| coordinate(*p).total_cmp(&coordinate(*q)));
        }
        for piece in region {
            let Bounds { min, max } = self.points.extent(piece);
            let range = |axis: usize| {
                let value = |p: &PointId| self.points.positions[p.index()][axis];
                let start = sorted[axis].partition_point(|p| value(p) < min[axis]);
                let length = sorted[axis][start..].partition_point(|p| value(p) <= max[axis]);
                &sorted[axis][start..start + length]
            };
            let fewest = (0..3).map(range).min_by_key(|range| range.len()).expect("a point has three planes");
            if fewest.len() <= FEW {
                self.touching(piece, fewest);
                continue;
            }
            let tree = tree.get_or_insert_with(|| self.tree_of_corners());
            tree.touching(&Bounds { min, max }, &mut found);
            near.clear();
            near.extend(found.iter().map(|place| self.corners[*place as usize]));
            self.touching(piece, &near);
        }
        self.sorted = sorted;
    }

    /// Where the corners of a region are, for finding those in a box.
    fn tree_of_corners(&self) -> Boxes {
        let at = |corner: &PointId| self.points.positions[corner.index()];
        Boxes::new(self.corners.iter().map(at).map(|at| Bounds { min: at, max: at }).collect())
    }

    /// Notes those of some corners that lie strictly inside an edge. Signs decide.
    pub(super) fn touching(&mut self, piece: &HalfEdge, corners: &[PointId]) {
        #[cfg(test)]
        {
            self.looked_at += corners.len();
        }
        let Bounds { min, max } = self.points.extent(piece);
        let is_inside = |at: DVec3| at.cmpge(min).all() && at.cmple(max).all();
        for &point in corners {
            if is_inside(self.points.positions[point.index()])
                && point != piece.from
                && point != piece.to
                && self.points.side(self.table, point, piece.edge) == Sign::Zero
            {
                self.found.push(PointOnLine { line: piece.line, point });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::build_bodies;
    use crate::boundary::boundary_of_union;
    use crate::model::{Brush, MaterialId};
    use crate::weld::half_edges;

    /// How many corners are held against edges in a plane of `n × n` separate boxes, for each of its edges.
    fn looked_at(n: u32) -> f64 {
        let brush = |k: u32| {
            let at = DVec3::new(f64::from(k % n), f64::from(k / n), 0.0) * 2.0;
            Brush::cuboid(at, at + 1.0, MaterialId(0))
        };
        let brushes: Vec<Brush> = (0..n * n).map(brush).collect();
        let built = build_bodies(&brushes);
        let bodies: Vec<_> = built.bodies.into_iter().filter_map(|body| body.bounded()).collect();
        let (edges, _) = boundary_of_union(&built.table, &bodies, &[0]);
        let (_, points, pieces, _) = half_edges(&built.table, &edges, &[0]).expect("closed");
        let mut finder = PinchFinder::new(&built.table, &points);
        regions_of(&pieces).into_iter().for_each(|range| finder.search(&pieces[range]));
        assert!(finder.found.is_empty());
        finder.looked_at as f64 / pieces.len() as f64
    }

    #[test]
    fn faces_in_rows_and_columns_of_one_plane_are_not_held_against_whole_rows() {
        let (few, many) = (looked_at(10), looked_at(60));
        assert!(few > 0.0 && many < 1.5 * few.max(8.0), "{few} and {many} corners for each edge");
    }
}
