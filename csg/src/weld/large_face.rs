//! Faces of many corners: their constrained Delaunay triangulations, which change where the boundary does.

use std::collections::hash_map::Entry;

use planecut_kernel::DVec2;
use rustc_hash::{FxHashMap, FxHashSet};

use super::delaunay::{Conflict, Delaunay};
use super::triangulate::{Triangles, side_bits};
use crate::ids::{HalfEdgeId, Id, PointId, SiteId};

/// Number of corners from which faces are triangulated so. Smaller ones are triangulated as a whole by [`Triangulator`](super::triangulate::Triangulator),
/// which takes diagonals that are nearly as good as others for what they are meant to be: those of a rectangle that was turned.
pub(super) const LARGE: usize = 64;

/// A boundary edge of a face: its half-edge, and the points where it begins and ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct FaceEdge {
    pub(super) piece: HalfEdgeId,
    pub(super) from: PointId,
    pub(super) to: PointId,
}

/// A face and its triangulation.
#[derive(Debug, Clone)]
pub(super) struct LargeFace {
    delaunay: Delaunay,
    sites: FxHashMap<PointId, SiteId>,
}

/// A side of a triangle: the half-edge of the boundary that begins at its first corner, and the one that it lies on.
type Side = (HalfEdgeId, Option<HalfEdgeId>);

impl LargeFace {
    /// Triangulates a face of some boundary edges; `at` gives the places of points in the plane.
    ///
    /// # Errors
    /// [`Conflict`]: rounding has moved corners together, or edges across one another.
    pub(super) fn new(edges: &[FaceEdge], at: impl Fn(PointId) -> DVec2) -> Result<Self, Conflict> {
        let (mut min, mut max) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for edge in edges {
            let place = at(edge.from);
            (min, max) = (min.min(place), max.max(place));
        }
        let mut new = Self { delaunay: Delaunay::new(min, max), sites: FxHashMap::default() };
        new.add(edges, at, (min, max))?;
        new.delaunay.find_zones();
        Ok(new)
    }

    /// The same for a face that is large, where there is a triangulation.
    pub(super) fn of_many(edges: &[FaceEdge], at: impl Fn(PointId) -> DVec2) -> Option<Self> {
        if edges.len() < LARGE { None } else { Self::new(edges, at).ok() }
    }

    /// Follows a change of the boundary: edges that are gone, and new ones, the place of each end that is not there yet given by `at`.
    ///
    /// # Errors
    /// [`Conflict`], as for [`LargeFace::new`], or where a new corner lies too far outside: then the face has to be triangulated as a whole.
    pub(super) fn change(
        &mut self,
        gone: &[FaceEdge],
        new: &[FaceEdge],
        at: impl Fn(PointId) -> DVec2,
    ) -> Result<(), Conflict> {
        for edge in gone {
            let [from, to] = self.ends(edge)?;
            self.delaunay.release(from, to)?;
        }
        let stays: FxHashSet<PointId> = new.iter().map(|edge| edge.from).collect();
        for point in gone.iter().map(|edge| edge.from).filter(|point| !stays.contains(point)) {
            if let Some(site) = self.sites.get(&point).copied()
                && !self.delaunay.is_corner(site)
            {
                self.sites.remove(&point);
                self.delaunay.remove(site)?;
            }
        }
        let (mut min, mut max) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for edge in new {
            let place = at(edge.from);
            if !self.delaunay.may_hold(place) {
                return Err(Conflict);
            }
            (min, max) = (min.min(place), max.max(place));
        }
        self.add(new, at, (min, max))?;
        self.delaunay.find_zones();
        Ok(())
    }

    /// Follows corners that have moved while the boundary has stayed the same otherwise.
    ///
    /// # Errors
    /// [`Conflict`]: a triangle has turned over; then the face has to be triangulated as a whole.
    pub(super) fn follow(&mut self, at: impl Fn(PointId) -> DVec2) -> Result<(), Conflict> {
        let places = self.sites.iter().map(|(point, site)| (*site, at(*point)));
        let mut moved: Vec<(SiteId, DVec2)> = places.filter(|(site, at)| self.delaunay.at(*site) != *at).collect();
        // whatever the order of the map
        moved.sort_unstable_by_key(|(site, _)| *site);
        self.delaunay.move_sites(&moved)
    }

    /// Adds edges, whose ends lie in a box: first the corners that are new, along a curve, so that each is near the one before.
    fn add(
        &mut self,
        edges: &[FaceEdge],
        at: impl Fn(PointId) -> DVec2,
        (min, max): (DVec2, DVec2),
    ) -> Result<(), Conflict> {
        let mut new: Vec<(u32, PointId)> = Vec::new();
        let scale = f64::from(SIDE) / (max - min).max_element().max(f64::MIN_POSITIVE);
        for edge in edges {
            if let Entry::Vacant(unknown) = self.sites.entry(edge.from) {
                unknown.insert(SiteId::NONE);
                new.push((hilbert((at(edge.from) - min) * scale), edge.from));
            }
        }
        new.sort_unstable();
        for (_, point) in new {
            let site = self.delaunay.insert(at(point))?;
            self.sites.insert(point, site);
        }
        for edge in edges {
            let [from, to] = self.ends(edge)?;
            self.delaunay.constrain(from, to, edge.piece)?;
        }
        Ok(())
    }

    /// The sites at which an edge begins and ends.
    fn ends(&self, edge: &FaceEdge) -> Result<[SiteId; 2], Conflict> {
        let site = |point| self.sites.get(&point).copied().ok_or(Conflict);
        Ok([site(edge.from)?, site(edge.to)?])
    }

    pub(super) fn triangle_count(&self) -> usize {
        self.delaunay.triangle_count()
    }

    /// A triangle: the half-edges of the boundary that begin at its corners.
    pub(super) fn triangle(&self, place: usize) -> [HalfEdgeId; 3] {
        self.delaunay.triangle(place).map(|side| side.0)
    }

    /// Adds all triangles, in an order that depends on the order of half-edges alone.
    pub(super) fn list(&self, out: &mut Triangles) {
        let triangle = |place| {
            let mut sides = self.delaunay.triangle(place);
            let least = (0..3).min_by_key(|k| sides[*k].0).unwrap_or_default();
            sides.rotate_left(least);
            sides
        };
        let mut all: Vec<[Side; 3]> = (0..self.triangle_count()).map(triangle).collect();
        all.sort_unstable();
        out.corners.extend(all.iter().map(|sides| sides.map(|side| side.0)));
        let is_on_loop = |(corner, along): Side| {
            debug_assert!(along.is_none_or(|along| along == corner), "a side along a half-edge of another corner");
            along.is_some()
        };
        out.on_loops.extend(all.iter().map(|sides| side_bits(sides.map(is_on_loop))));
    }
}

/// Cells a side of the square on which the curve runs.
const SIDE: u32 = 1 << 15;

/// The place along Hilbert's curve of the cell that holds a place in a square of [`SIDE`] cells a side.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "`as` saturates")]
fn hilbert(at: DVec2) -> u32 {
    let last = SIDE - 1;
    let (mut x, mut y) = ((at.x as u32).min(last), (at.y as u32).min(last));
    let (mut number, mut side) = (0, SIDE / 2);
    while side > 0 {
        let (right, above) = (u32::from(x & side > 0), u32::from(y & side > 0));
        number += side * side * ((3 * right) ^ above);
        if above == 0 {
            if right == 1 {
                (x, y) = (last - x, last - y);
            }
            (x, y) = (y, x);
        }
        side /= 2;
    }
    number
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_that_follow_one_another_along_the_curve_are_neighbours() {
        let cell = f64::from(SIDE) / 16.0;
        let place = |k: u32| DVec2::new(f64::from(k % 16), f64::from(k / 16)) * cell + 0.5 * cell;
        let mut cells: Vec<(u32, u32)> = (0..256).map(|k| (hilbert(place(k)), k)).collect();
        cells.sort_unstable();
        for pair in cells.windows(2) {
            assert_eq!((place(pair[0].1) - place(pair[1].1)).abs().element_sum(), cell);
        }
    }
}
