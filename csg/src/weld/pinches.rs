//! Corners of a region that touch the inside of one of its edges: there the edge is cut as well.

use planecut_kernel::sign::Sign;
use planecut_kernel::{DVec2, DVec3};
use wide::f64x4;

use super::cancel::HalfEdge;
use super::nest::Projection;
use super::points::Points;
use super::region_corners::RegionCorners;
use crate::base::{Bounds, Boxes, sort_few, sortable};
use crate::ids::{Id, PointId, PointOnLine, number32};
use crate::plane_table::PlaneTable;

/// Regions of fewer corners are searched edge by edge.
const MANY: usize = 24;

/// More corners that agree with an edge in one coordinate are searched by a tree: in a plane with many separate faces, in rows and columns,
/// there are as many of them as in a row.
const FEW: usize = 32;

/// Finds corners that touch the inside of edges, reusing its buffers.
pub(super) struct PinchFinder<'a> {
    table: &'a PlaneTable,
    points: &'a Points,
    corners: RegionCorners,
    /// Where they are in the plane of the region.
    places: Vec<DVec2>,
    /// The same, of several corners at once.
    lanes: Vec<[f64x4; 2]>,
    /// Sorted from left to right, and upwards.
    along: [Sorted; 2],
    near: Vec<PointId>,
    /// What was found.
    pub(super) found: Vec<PointOnLine>,
    /// How many corners were held against the box of an edge.
    #[cfg(test)]
    looked_at: usize,
}

/// Places sorted by one of their coordinates, then by the other.
#[derive(Debug, Default)]
struct Sorted {
    order: Vec<u32>,
    /// For each place its place in the order.
    rank: Vec<u32>,
}

impl Sorted {
    fn sort(&mut self, places: &[DVec2], key: impl Fn(DVec2) -> [f64; 2]) {
        self.order.clear();
        self.order.extend(0..number32(places.len()));
        for coordinate in [1, 0] {
            sort_few(&mut self.order, &|k: &u32| sortable(key(places[*k as usize])[coordinate]));
        }
        self.rank.clear();
        self.rank.resize(places.len(), 0);
        for (rank, place) in (0..).zip(&self.order) {
            self.rank[*place as usize] = rank;
        }
    }

    /// All places that are in the box around two of them, and others between in the order.
    fn between(&self, a: usize, b: usize, is_inside: impl Fn(u32) -> bool) -> &[u32] {
        let [a, b] = [a, b].map(|place| self.rank[place] as usize);
        let (mut start, mut end) = (a.min(b), a.max(b) + 1);
        // places with the same first coordinate as an end follow one another by the second one
        while start > 0 && is_inside(self.order[start - 1]) {
            start -= 1;
        }
        while end < self.order.len() && is_inside(self.order[end]) {
            end += 1;
        }
        &self.order[start..end]
    }
}

impl<'a> PinchFinder<'a> {
    pub(super) fn new(table: &'a PlaneTable, points: &'a Points) -> Self {
        Self {
            table,
            points,
            corners: RegionCorners::default(),
            places: Vec::new(),
            lanes: Vec::new(),
            along: Default::default(),
            near: Vec::new(),
            found: Vec::new(),
            #[cfg(test)]
            looked_at: 0,
        }
    }

    /// Finds those of one region, whose half-edges are sorted by place.
    pub(super) fn search(&mut self, region: &[HalfEdge], projection: Projection) {
        // what touches itself has at least two triangles
        if region.len() <= 4 {
            return;
        }
        self.corners.set(region);
        self.places.clear();
        let place = |corner: &PointId| projection.of(self.points.positions[corner.index()]);
        self.places.extend(self.corners.points().iter().map(place));
        if self.places.len() < MANY { self.search_all(region) } else { self.search_sorted(region) }
    }

    /// Holds all corners against the box of each edge.
    fn search_all(&mut self, region: &[HalfEdge]) {
        self.lanes.clear();
        self.lanes.extend(self.places.chunks(4).map(|places| {
            let lane = |k: usize| places.get(k).copied().unwrap_or(DVec2::NAN);
            let [a, b, c, d] = [0, 1, 2, 3].map(lane);
            [f64x4::new([a.x, b.x, c.x, d.x]), f64x4::new([a.y, b.y, c.y, d.y])]
        }));
        for piece in region {
            let Some([from, to]) = self.ends(piece) else { continue };
            let (min, max) = (from.min(to), from.max(to));
            let [min_x, min_y, max_x, max_y] = [min.x, min.y, max.x, max.y].map(f64x4::splat);
            let inside = self.lanes.iter().map(|[x, y]| {
                let is_inside = x.simd_ge(min_x) & x.simd_le(max_x) & y.simd_ge(min_y) & y.simd_le(max_y);
                is_inside.to_bitmask().count_ones()
            });
            // both ends are
            if inside.sum::<u32>() > 2 {
                let corners = std::mem::take(&mut self.corners);
                self.touching(piece, corners.points());
                self.corners = corners;
            }
        }
    }

    /// Where a half-edge begins and ends in the plane of the region.
    fn ends(&self, piece: &HalfEdge) -> Option<[DVec2; 2]> {
        Some([self.places[self.corners.place_of(piece.from)?], self.places[self.corners.place_of(piece.to)?]])
    }

    /// Looks between the ends of each edge among the corners in order: an edge along an axis has none there mostly.
    fn search_sorted(&mut self, region: &[HalfEdge]) {
        self.along[0].sort(&self.places, |at| [at.x, at.y]);
        self.along[1].sort(&self.places, |at| [at.y, at.x]);
        let (mut tree, mut found) = (None, Vec::new());
        for piece in region {
            let places = [piece.from, piece.to].map(|point| self.corners.place_of(point));
            let [Some(a), Some(b)] = places else { continue };
            let (from, to) = (self.places[a], self.places[b]);
            let (min, max) = (from.min(to), from.max(to));
            let is_inside = |place: u32| {
                let at = self.places[place as usize];
                at.cmpge(min).all() && at.cmple(max).all()
            };
            let [p, q] = self.along.each_ref().map(|along| along.between(a, b, is_inside));
            let fewest = if p.len() <= q.len() { p } else { q };
            self.near.clear();
            if fewest.len() <= FEW {
                #[cfg(test)]
                {
                    self.looked_at += fewest.len();
                }
                let point = |place: &u32| self.corners.points()[*place as usize];
                self.near.extend(fewest.iter().filter(|place| is_inside(**place)).map(point));
            } else {
                let tree = tree.get_or_insert_with(|| self.tree_of_corners());
                tree.touching(&self.points.extent(piece), &mut found);
                self.near.extend(found.iter().map(|place| self.corners.points()[*place as usize]));
            }
            // both ends are
            if self.near.len() > 2 {
                let near = std::mem::take(&mut self.near);
                self.touching(piece, &near);
                self.near = near;
            }
        }
    }

    /// Where the corners of a region are, for finding those in a box.
    fn tree_of_corners(&self) -> Boxes {
        let at = |corner: &PointId| self.points.positions[corner.index()];
        Boxes::new(self.corners.points().iter().map(at).map(|at| Bounds { min: at, max: at }).collect())
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
                self.found.push(PointOnLine { line: piece.line(), point });
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
        let (regions, points, sorted, _) = half_edges(&built.table, edges, &[0]).expect("closed");
        let mut finder = PinchFinder::new(&built.table, &points);
        for range in sorted.ranges {
            let region = &sorted.pieces[range];
            finder.search(region, Projection::of_plane(&built.table, regions.planes[region[0].region.index()]));
        }
        assert!(finder.found.is_empty());
        finder.looked_at as f64 / sorted.pieces.len() as f64
    }

    #[test]
    fn faces_in_rows_and_columns_of_one_plane_are_not_held_against_whole_rows() {
        let (few, many) = (looked_at(10), looked_at(60));
        assert!(few > 0.0 && many < 1.5 * few.max(8.0), "{few} and {many} corners for each edge");
    }
}
