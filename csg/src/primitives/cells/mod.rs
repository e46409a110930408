//! The inside of a closed surface of planar convex facets, cut into convex cells.
//!
//! A cell that is not convex is cut along the plane of one of its own facets, so no plane is made that the surface does not
//! have, and where a cut ends on the surface three planes meet and no more. All cuts of a cell go through the whole cell:
//! each point is in one cell, however the planes are rounded later, so there are no gaps between cells.
//!
//! **When a cell is done.** Let `C` be a cell, `F` the pieces of the surface inside it, and `K` the part of `C` below the planes
//! of all of `F`. If `F` lies in `K`, then `K` is what the solid `S` has of `C`:
//! - The inside of `K` meets no piece, as pieces lie on planes that bound it. So it lies all in `S` or all outside; it lies below
//!   a piece, so it is in `S`.
//! - Take a facet of `K` on the plane of a piece. The surface is closed, so where the pieces on this facet ended within it,
//!   a piece on another plane would begin; that plane would pass through the facet's inside and cut `K`, which lies below
//!   it. So the pieces cover the whole facet, and what is in `C` beyond it is outside of `S`.
//!
//! Cuts are chosen and sides are decided with exact signs on the planes through the given corners.

mod fragment;

use std::cmp::Ordering;
use std::rc::Rc;

use planecut_kernel::{DVec3, HalfSpace};

use super::ShapeError;
use super::flat::plane as accepted;
use crate::polyhedron::exact::{Grid, Plane, Point};
use fragment::{Fragment, Split};

/// One side of the plane of a facet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Side {
    pub(super) facet: u32,
    /// Whether it is the side where the facet's solid is not.
    pub(super) is_outer: bool,
}

/// How many planes are tried for a cut before the best is taken.
const CANDIDATES: usize = 48;
/// A cut through a piece is worth this much of balance.
const COST_OF_CUT: usize = 16;

/// A surface of facets, each the numbers of its corners, counter-clockwise seen from outside.
pub(super) struct Surface<'a> {
    points: &'a [DVec3],
    facets: &'a [Vec<u32>],
    grid: Grid,
    planes: Vec<Rc<Plane>>,
}

impl<'a> Surface<'a> {
    /// The first three corners of each facet must not lie on a line; the others lie on their plane.
    pub(super) fn new(points: &'a [DVec3], facets: &'a [Vec<u32>]) -> Option<Self> {
        let grid = Grid::of(points);
        let corners = |facet: &Vec<u32>| [0, 1, 2].map(|k| points[facet[k] as usize]);
        let planes =
            facets.iter().map(|facet| Plane::through(grid, corners(facet)).map(Rc::new)).collect::<Option<_>>()?;
        Some(Self { points, facets, grid, planes })
    }

    /// The half-space of each facet.
    pub(super) fn half_spaces(&self) -> Result<Vec<HalfSpace>, ShapeError> {
        let of = |(facet, plane): (&Vec<u32>, &Rc<Plane>)| {
            let (normal, offset) = plane.half_space(self.grid, facet.iter().map(|p| self.points[*p as usize]));
            accepted(normal, offset)
        };
        self.facets.iter().zip(&self.planes).map(of).collect()
    }

    /// Convex cells that together are the solid, each as sides of planes of facets. What else bounds the solid, such as the
    /// planes of a slab in which the surface is closed, the caller adds to each cell.
    pub(super) fn cells(&self) -> Vec<Vec<Side>> {
        let corners: Vec<Rc<Point>> = self.points.iter().map(|p| Rc::new(Point::new(self.grid, *p))).collect();
        let fragments = self.facets.iter().zip(&self.planes).enumerate().map(|(facet, (polygon, plane))| {
            let polygon: Vec<Rc<Point>> = polygon.iter().map(|p| Rc::clone(&corners[*p as usize])).collect();
            Fragment::new(facet as u32, plane, &polygon)
        });
        let mut waiting: Vec<(Vec<Side>, Vec<Fragment>)> = vec![(Vec::new(), fragments.collect())];
        let mut done = Vec::new();
        while let Some((mut sides, fragments)) = waiting.pop() {
            let Some(facet) = self.best_cut(&fragments) else {
                let mut facets: Vec<u32> = fragments.iter().map(|fragment| fragment.facet).collect();
                facets.sort_unstable();
                facets.dedup();
                sides.extend(facets.into_iter().map(|facet| Side { facet, is_outer: false }));
                done.push(sides);
                continue;
            };
            let (inner, outer) = self.cut(&fragments, facet);
            // a piece lies on the cut: it tells that there is nothing above it, and all is solid below, as far as no other goes
            if !outer.is_empty() {
                let mut sides = sides.clone();
                sides.push(Side { facet, is_outer: true });
                waiting.push((sides, outer));
            }
            sides.push(Side { facet, is_outer: false });
            if inner.is_empty() { done.push(sides) } else { waiting.push((sides, inner)) }
        }
        done
    }

    /// The pieces below and above the plane of a facet; those on it are done with.
    fn cut(&self, fragments: &[Fragment], facet: u32) -> (Vec<Fragment>, Vec<Fragment>) {
        let plane = &self.planes[facet as usize];
        let (mut inner, mut outer) = (Vec::new(), Vec::new());
        // A facet of four corners lies on its plane only up to rounding; its pieces are on it nevertheless.
        for fragment in fragments.iter().filter(|fragment| fragment.facet != facet) {
            match fragment.split(self.grid, plane, &self.planes[fragment.facet as usize]) {
                Split::Inside => inner.push(fragment.clone()),
                Split::Outside => outer.push(fragment.clone()),
                Split::On => {}
                Split::Both(below, above) => {
                    inner.push(below);
                    outer.push(above);
                }
            }
        }
        (inner, outer)
    }

    /// The facet whose plane cuts few pieces and parts the others evenly; `None` where all pieces lie below the planes of all.
    fn best_cut(&self, fragments: &[Fragment]) -> Option<u32> {
        let mut facets: Vec<u32> = fragments.iter().map(|fragment| fragment.facet).collect();
        facets.sort_unstable();
        facets.dedup();
        let step = facets.len().div_ceil(CANDIDATES);
        let cost = |facet: u32| self.cost(fragments, facet).map(|cost| (cost, facet));
        let best = facets.iter().step_by(step.max(1)).filter_map(|facet| cost(*facet)).min();
        best.or_else(|| facets.iter().find_map(|facet| cost(*facet))).map(|(_, facet)| facet)
    }

    /// What a cut costs; `None` where no piece lies beyond the plane.
    fn cost(&self, fragments: &[Fragment], facet: u32) -> Option<usize> {
        let plane = &self.planes[facet as usize];
        let (mut inside, mut outside, mut both) = (0usize, 0usize, 0);
        for fragment in fragments.iter().filter(|fragment| fragment.facet != facet) {
            match fragment.extent(plane) {
                (Ordering::Less, Ordering::Greater) => both += 1,
                (_, Ordering::Greater) => outside += 1,
                (Ordering::Less, _) => inside += 1,
                _ => {}
            }
        }
        (outside + both > 0).then_some(both * COST_OF_CUT + inside.abs_diff(outside))
    }
}
