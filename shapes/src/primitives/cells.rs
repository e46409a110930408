//! The inside of a surface of planar convex facets, cut into convex cells.
//!
//! What is not convex is cut along planes of facets, so no plane is made that the surface does not have, and where a cut ends on
//! the surface three planes meet and no more. Each point is in one cell, however the planes are rounded later, so there are
//! no gaps between cells. The room [`polyhedron`](crate::polyhedron) does the work.

use planecut_kernel::{DVec3, HalfSpace};

use super::simple::plane as accepted;
use crate::parameter::{MAX_PIECES, ShapeError};
use crate::polyhedron::cells_within;
use crate::polyhedron::exact::{Grid, Plane};

/// One side of the plane of a facet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct PlaneSide {
    pub(super) facet: u32,
    /// Whether it is the side where the facet's solid is not.
    pub(super) is_outer: bool,
}

/// A surface of facets, each the numbers of its corners, counter-clockwise seen from outside.
pub(super) struct Surface<'a> {
    points: &'a [DVec3],
    facets: &'a [Vec<u32>],
    grid: Grid,
    planes: Vec<Plane>,
}

impl<'a> Surface<'a> {
    /// The first three corners of each facet must not lie on a line; the others lie on their plane.
    pub(super) fn new(points: &'a [DVec3], facets: &'a [Vec<u32>]) -> Option<Self> {
        let grid = Grid::of(points);
        let corners = |facet: &Vec<u32>| [0, 1, 2].map(|k| points[facet[k] as usize]);
        let planes = facets.iter().map(|facet| Plane::through(grid, corners(facet))).collect::<Option<_>>()?;
        Some(Self { points, facets, grid, planes })
    }

    /// The half-space of each facet.
    pub(super) fn half_spaces(&self) -> Result<Vec<HalfSpace>, ShapeError> {
        let of = |(facet, plane): (&Vec<u32>, &Plane)| {
            let (normal, offset) = plane.half_space(self.grid, facet.iter().map(|p| self.points[*p as usize]));
            accepted(normal, offset)
        };
        self.facets.iter().zip(&self.planes).map(of).collect()
    }

    /// Convex cells that together are the solid, each as sides of planes of facets. What else bounds the solid, such as the
    /// planes of a slab in which the surface is closed, the caller adds to each cell.
    pub(super) fn cells(&self) -> Result<Vec<Vec<PlaneSide>>, ShapeError> {
        let too_many = || ShapeError::TooLarge { found: MAX_PIECES + 1, limit: MAX_PIECES };
        let cells = cells_within(self.points, self.facets, &self.half_spaces()?).ok_or_else(too_many)?;
        let side = |(facet, is_outer): (u32, bool)| PlaneSide { facet, is_outer };
        Ok(cells.into_iter().map(|cell| cell.into_iter().map(side).collect()).collect())
    }
}
