//! Faces of the boundary: cells of one plane and one material that meet are one polygon again.
//!
//! Cuts that the combination does not need divide triangles into cells that are kept alike. What is left of such a cut are points within
//! straight edges; these go, too, unless another face ends there.

use planecut_kernel::sign::Sign;
use rustc_hash::FxHashMap;

use super::facets::FacetKind;
use super::fill::area;
use super::kept::{Kept, KeptFacets};
use super::predicates::{RoundedPlane, best_axis, normal_component};
use super::surface::sorted;
use super::{Arranged, Arrangement};
use crate::base::DisjointSets;
use crate::ids::{Id, PointId, TriangleId, number32};

/// A face of the boundary.
#[derive(Debug, Clone)]
pub(super) struct Face {
    /// One of the facets that it is made of.
    pub(super) kept: Kept,
    /// Its loops, as seen from outside the solid; the first one goes around it. None for a whole triangle.
    pub(super) loops: Vec<Vec<PointId>>,
}

/// A half-edge of a kept cell.
#[derive(Debug, Clone, Copy)]
struct CellEdge {
    from: PointId,
    to: PointId,
    /// The place of its cell among those kept.
    cell: u32,
    /// The one that follows around the cell.
    next: u32,
}

impl Arranged<'_> {
    /// The faces of the boundary: whole triangles first, in their order, then those that cells make up.
    pub(super) fn faces(&self, kept: &KeptFacets) -> Vec<Face> {
        let crossed = self.crossed(&kept.values);
        let kept = &kept.flat;
        let is_cell = |kept: &&Kept| matches!(self.facets.kind(kept.facet), FacetKind::Cell(_));
        let cells: Vec<Kept> = kept.iter().filter(is_cell).copied().collect();
        let whole = kept.iter().filter(|kept| !is_cell(kept));
        let mut faces: Vec<Face> = whole.map(|kept| Face { kept: *kept, loops: Vec::new() }).collect();
        let mut edges: Vec<CellEdge> = Vec::new();
        for (cell, kept) in (0..).zip(&cells) {
            for points in self.loops(kept, &crossed) {
                let first = number32(edges.len());
                let count = number32(points.len());
                edges.extend((0..points.len()).map(|k| CellEdge {
                    from: points[k],
                    to: points[(k + 1) % points.len()],
                    cell,
                    next: first + (number32(k) + 1) % count,
                }));
            }
        }
        let twins = self.inner_twins(&cells, &faces, &edges);
        let mut sets = DisjointSets::new(cells.len());
        for (edge, twin) in edges.iter().zip(&twins) {
            if let Some(twin) = twin {
                sets.join(edge.cell, edges[*twin as usize].cell);
            }
        }
        let (region, count) = sets.numbered();
        let mut loops: Vec<Vec<Vec<PointId>>> = vec![Vec::new(); count];
        let mut is_done: Vec<bool> = twins.iter().map(Option::is_some).collect();
        for start in 0..edges.len() {
            let mut points = Vec::new();
            let mut edge = start;
            while !std::mem::replace(&mut is_done[edge], true) {
                points.push(edges[edge].from);
                let mut next = edges[edge].next as usize;
                while let Some(twin) = twins[next] {
                    next = edges[twin as usize].next as usize;
                }
                edge = next;
            }
            if !points.is_empty() {
                loops[region[edges[start].cell as usize] as usize].push(points);
            }
        }
        let mut first_of: Vec<Option<Kept>> = vec![None; count];
        for (cell, kept) in cells.iter().enumerate() {
            first_of[region[cell] as usize].get_or_insert(*kept);
        }
        let polygons = first_of.into_iter().zip(loops);
        let first = faces.len();
        faces.extend(
            polygons.filter_map(|(kept, loops)| kept.map(|kept| Face { kept, loops: self.outer_first(loops) })),
        );
        self.straighten(&mut faces, first);
        faces
    }

    /// The loop around the others first.
    fn outer_first(&self, mut loops: Vec<Vec<PointId>>) -> Vec<Vec<PointId>> {
        let at = |point: PointId| self.arrangement.points.at(&self.arrangement.surface, point);
        if loops.len() > 1 {
            let outer = (0..loops.len()).max_by(|a, b| area(&loops[*a], at).total_cmp(&area(&loops[*b], at)));
            loops.swap(0, outer.unwrap_or(0));
        }
        loops
    }

    /// For each half-edge of a cell the one that runs back along it, where both cells are parts of one face.
    fn inner_twins(&self, cells: &[Kept], whole: &[Face], edges: &[CellEdge]) -> Vec<Option<u32>> {
        let mut uses: FxHashMap<[PointId; 2], Vec<u32>> = FxHashMap::default();
        for (k, edge) in (0..).zip(edges) {
            uses.entry(sorted(edge.from, edge.to)).or_default().push(k);
        }
        // of whole triangles, too: where more than two facets meet, they are told apart by the wedges between them
        for face in whole {
            let corners = self.arrangement.surface.corners[face.kept.facet.index()];
            for k in 0..3 {
                if let Some(uses) = uses.get_mut(&sorted(corners[k], corners[(k + 1) % 3])) {
                    uses.push(u32::MAX);
                }
            }
        }
        let mut twins = vec![None; edges.len()];
        for pair in uses.values() {
            if let [one, other] = pair[..]
                && other != u32::MAX
                && edges[one as usize].from == edges[other as usize].to
                && self.are_one_face(
                    &cells[edges[one as usize].cell as usize],
                    &cells[edges[other as usize].cell as usize],
                )
            {
                twins[one as usize] = Some(other);
                twins[other as usize] = Some(one);
            }
        }
        twins
    }

    /// Whether facets lie in one plane, face the same way, and are of one material.
    fn are_one_face(&self, one: &Kept, other: &Kept) -> bool {
        let [p, q] = [one, other].map(|kept| self.facets.triangle(&self.arrangement.cells, kept.facet));
        one.material == other.material && (p == q || self.are_coplanar(p, q)) && {
            let (input, [p, q]) =
                (self.arrangement.surface.input, [p, q].map(|k| self.arrangement.surface.triangle(k)));
            best_axis(input, &p).is_some_and(|(axis, sign)| {
                (normal_component(input, &q, axis) == sign) == (one.is_flipped == other.is_flipped)
            })
        }
    }

    /// Whether triangles lie in one plane; those of one operand also where they did before it was moved and rounded.
    fn are_coplanar(&self, one: TriangleId, other: TriangleId) -> bool {
        let Arrangement { surface, planes, .. } = &self.arrangement;
        if planes[one.index()] == planes[other.index()] {
            return true;
        }
        let (p, q) = (surface.triangle(one), surface.triangle(other));
        if surface.operands[one.index()] == surface.operands[other.index()] {
            return surface.input.were_coplanar(p.number, q.number);
        }
        let plane = RoundedPlane::new(surface.input, &p);
        q.corners.iter().all(|corner| plane.side(surface.input, corner) == Sign::Zero)
    }

    /// Takes points out of polygons at which two faces alone meet, along a straight edge.
    fn straighten(&self, faces: &mut [Face], first: usize) {
        let surface = &self.arrangement.surface;
        // of two polygons, once each: there it may go
        let mut uses = vec![0_u32; self.arrangement.points.len()];
        for point in faces[first..].iter().flat_map(|face| &face.loops).flatten() {
            uses[point.index()] += 1;
        }
        // corners of triangles stay
        for face in &faces[..first] {
            for corner in surface.corners[face.kept.facet.index()] {
                if uses[corner.index()] > 0 {
                    uses[corner.index()] += 2;
                }
            }
        }
        let mut straight: FxHashMap<PointId, u32> = FxHashMap::default();
        for face in &faces[first..] {
            let triangle = self.facets.triangle(&self.arrangement.cells, face.kept.facet);
            let Some((axis, _)) = best_axis(surface.input, &surface.triangle(triangle)) else { continue };
            for points in &face.loops {
                let count = points.len();
                for k in 0..count {
                    let [before, point, after] = [count - 1, 0, 1].map(|step| points[(k + step) % count]);
                    if uses[point.index()] == 2
                        // where a slit ends the turn is a whole one
                        && before != after
                        && self.arrangement.points.turn(surface, [before, point, after], axis) == Sign::Zero
                    {
                        *straight.entry(point).or_insert(0) += 1;
                    }
                }
            }
        }
        for face in &mut faces[first..] {
            for points in &mut face.loops {
                points.retain(|point| straight.get(point) != Some(&2));
            }
        }
    }
}
