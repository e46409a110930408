//! Cells around pieces of a surface, drawn in to what they alone hold.
//!
//! As [`shrink`](super::super::shrink) does it for exact parts, but in floating point: what of a piece lies in another cell by more than rounding need not be
//! held. What is left is known up to rounding, and a cell is larger than it by more than that.

use planecut_csg::stages::{Bounds, Boxes};
use planecut_kernel::DVec3;
use planecut_parallel::prelude::*;

use super::super::CoarsenError;
use super::super::part::Part;
use super::super::probes::Probes;
use super::super::shrink::added_alone;
use super::Pieces;
use super::body::Points;
use super::fragment::{Fragment, Plane};
use crate::tolerances::WORTH_SHRINKING;

impl Pieces {
    /// Draws cells in, those that add most first; those that hold nothing alone are dropped. Where materials stay apart, what a cell of another material
    /// holds counts for nothing. `parts` are the pieces, `boxes` theirs.
    pub(in super::super) fn draw_in(
        &self,
        cells: &mut Vec<Part>,
        parts: &[Part],
        boxes: &Boxes,
        probes: &Probes,
        by_material: bool,
    ) -> Result<(), CoarsenError> {
        let adds = added_alone(cells, probes);
        let mut order: Vec<usize> = (0..cells.len()).collect();
        order.sort_by(|a, b| adds[*b].cmp(&adds[*a]).then(a.cmp(b)));
        let mut planes: Vec<Option<Vec<Plane>>> = cells.iter().map(|cell| Some(self.inner_planes(cell))).collect();
        let mut near = Vec::new();
        for place in order {
            let own = &cells[place];
            let is_like = |other: &Part| !by_material || other.material == own.material;
            let others: Vec<(&Part, &[Plane])> = cells
                .iter()
                .zip(&planes)
                .enumerate()
                .filter(|(other, (cell, _))| *other != place && is_like(cell) && cell.bounds.touches(&own.bounds))
                .filter_map(|(_, (cell, planes))| Some((cell, planes.as_deref()?)))
                .collect();
            if others.is_empty() {
                continue;
            }
            boxes.touching(&own.bounds, &mut near);
            near.retain(|piece| !by_material || parts[*piece as usize].material == own.material);
            let left: Vec<Vec<DVec3>> = near
                .par_iter()
                .with_max_len(4)
                .map(|piece| self.left_of(*piece as usize, &parts[*piece as usize].bounds, &others))
                .collect();
            let points = Points { vertices: Vec::new(), cuts: left.into_iter().flatten().collect() };
            if points.cuts.is_empty() {
                planes[place] = None;
                continue;
            }
            // thickness is in the points already
            let growth = super::Growth { thickness: 0.0, ..self.growth };
            let Some(smaller) = points.without_inner().body(&growth, own.material)? else { continue };
            if smaller.volume() < own.volume() * WORTH_SHRINKING {
                planes[place] = Some(self.inner_planes(&smaller));
                cells[place] = smaller;
            }
        }
        let mut is_kept = planes.iter().map(Option::is_some);
        cells.retain(|_| is_kept.next().unwrap_or(true));
        Ok(())
    }

    /// The planes of a cell, moved inward by more than the rounding of points.
    fn inner_planes(&self, cell: &Part) -> Vec<Plane> {
        let margin = 0.5 * self.growth.rounding;
        cell.half_spaces
            .iter()
            .map(|plane| (plane.normal(), plane.offset() - margin * plane.normal().length()))
            .collect()
    }

    /// The corners of what no cell holds of a piece.
    fn left_of(&self, piece: usize, bounds: &Bounds, cells: &[(&Part, &[Plane])]) -> Vec<DVec3> {
        let near: Vec<&[Plane]> =
            cells.iter().filter(|(cell, _)| cell.bounds.touches(bounds)).map(|(_, planes)| *planes).collect();
        let points = self.points[piece].thick(self.growth.thickness);
        let holds =
            |planes: &&&[Plane]| points.iter().all(|p| planes.iter().all(|(normal, offset)| normal.dot(*p) <= *offset));
        if near.iter().any(|planes| holds(&planes)) {
            return Vec::new();
        }
        match Fragment::hull_of(&points) {
            Some(whole) => whole.outside_all(&near).iter().flat_map(Fragment::corners).copied().collect(),
            None => points,
        }
    }
}
