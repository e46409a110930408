//! Faces of the boundary: cells of one plane and one material that meet are one polygon again.
//!
//! Cuts that the combination does not need divide triangles into cells that are kept alike. What is left of such a cut are points within
//! straight edges; these go, too, unless another face ends there.

use planecut_kernel::sign::Sign;
use planecut_parallel::prelude::*;

use super::facets::FacetKind;
use super::fill::area;
use super::kept::{Kept, KeptFacets};
use super::predicates::{RoundedPlane, best_axis, normal_component};
use super::surface::sorted;
use super::{Arranged, Arrangement};
use crate::base::DisjointSets;
use crate::ids::{Id, PointId, number32};

/// Cells, or pairs of edges, that one thread looks at in a row.
const CHUNK: usize = 1 << 8;

/// A face of the boundary.
#[derive(Debug, Clone)]
pub(super) struct Face {
    /// One of the facets that it is made of.
    pub(super) kept: Kept,
    /// Its loops, as seen from outside the solid; the first one goes around it. None for a whole triangle.
    pub(super) loops: Vec<Vec<PointId>>,
    /// Whether all of it lies in one plane, not just but for rounding.
    pub(super) is_plane: bool,
}

/// Which facets that meet are one face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Merging {
    /// Those in one plane, and neighbours of one mesh that are but for the rounding of its coordinates.
    WithinRounding,
    /// Those in one plane.
    Exact,
}

/// How two facets of one face lie to one another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Joint {
    InOnePlane,
    WithinRounding,
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
    pub(super) fn faces(&self, kept: &KeptFacets, merging: Merging) -> Vec<Face> {
        let crossed = self.crossed(&kept.values);
        let kept = &kept.flat;
        let is_cell = |kept: &&Kept| matches!(self.facets.kind(kept.facet), FacetKind::Cell(_));
        let cells: Vec<Kept> = kept.iter().filter(is_cell).copied().collect();
        let whole = kept.iter().filter(|kept| !is_cell(kept));
        let mut faces: Vec<Face> = whole.map(|kept| Face { kept: *kept, loops: Vec::new(), is_plane: true }).collect();
        let mut edges: Vec<CellEdge> = Vec::new();
        let loops: Vec<Vec<Vec<PointId>>> =
            cells.par_iter().with_min_len(CHUNK).map(|kept| self.loops(kept, &crossed)).collect();
        for (cell, loops) in (0..).zip(loops) {
            for points in loops {
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
        let (twins, rounded) = self.inner_twins(&cells, &faces, &edges, merging);
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
        let mut is_plane = vec![true; count];
        for cell in rounded {
            is_plane[region[cell as usize] as usize] = false;
        }
        let polygons = first_of.into_iter().zip(loops).zip(is_plane);
        let first = faces.len();
        faces.extend(polygons.filter_map(|((kept, loops), is_plane)| {
            kept.map(|kept| Face { kept, loops: self.outer_first(loops), is_plane })
        }));
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

    /// For each half-edge of a cell the one that runs back along it, where both cells are parts of one face; and the cells that lie in one plane
    /// with another one but for rounding.
    fn inner_twins(
        &self,
        cells: &[Kept],
        whole: &[Face],
        edges: &[CellEdge],
        merging: Merging,
    ) -> (Vec<Option<u32>>, Vec<u32>) {
        let of_cells = (0..).zip(edges).map(|(k, edge)| (sorted(edge.from, edge.to), k));
        // of whole triangles, too: where more than two facets meet, they are told apart by the wedges between them
        let of_triangles = whole.iter().flat_map(|face| {
            let corners = self.arrangement.surface.corners[face.kept.facet.index()];
            (0..3).map(move |k| (sorted(corners[k], corners[(k + 1) % 3]), u32::MAX))
        });
        let mut uses: Vec<([PointId; 2], u32)> = of_cells.chain(of_triangles).collect();
        uses.par_sort_unstable();
        let pair = |uses: &[([PointId; 2], u32)]| match *uses {
            [(_, one), (_, other)] if other != u32::MAX => Some([one, other]),
            _ => None,
        };
        let pairs: Vec<[u32; 2]> = uses.chunk_by(|a, b| a.0 == b.0).filter_map(pair).collect();
        let cells_of = |pair: [u32; 2]| pair.map(|edge| edges[edge as usize].cell);
        let joint = |pair: &[u32; 2]| {
            let [p, q] = cells_of(*pair).map(|cell| &cells[cell as usize]);
            let is_opposite = edges[pair[0] as usize].from == edges[pair[1] as usize].to;
            if is_opposite { self.joint(p, q, merging) } else { None }
        };
        let joints: Vec<Option<Joint>> = pairs.par_iter().with_min_len(CHUNK).map(joint).collect();
        let mut twins = vec![None; edges.len()];
        let mut rounded = Vec::new();
        for (pair @ [one, other], joint) in pairs.into_iter().zip(joints) {
            let Some(joint) = joint else { continue };
            if joint == Joint::WithinRounding {
                rounded.push(cells_of(pair)[0]);
            }
            twins[one as usize] = Some(other);
            twins[other as usize] = Some(one);
        }
        (twins, rounded)
    }

    /// How facets lie to one another, where they are of one material, face the same way and are one face.
    fn joint(&self, one: &Kept, other: &Kept, merging: Merging) -> Option<Joint> {
        if one.material != other.material {
            return None;
        }
        let Arrangement { surface, planes, cells, .. } = &self.arrangement;
        let [first, second] = [one, other].map(|kept| self.facets.triangle(cells, kept.facet));
        let [p, q] = [first, second].map(|triangle| surface.triangle(triangle));
        let is_in_plane = || {
            let plane = RoundedPlane::new(surface.input, &p);
            q.corners.iter().all(|corner| plane.side(surface.input, corner) == Sign::Zero)
        };
        let joint = if planes[first.index()] == planes[second.index()] {
            Joint::InOnePlane
        } else if surface.operands[first.index()] == surface.operands[second.index()] {
            let is_flat = merging == Merging::WithinRounding && surface.input.are_nearly_coplanar([&p, &q]);
            is_flat.then_some(Joint::WithinRounding)?
        } else {
            is_in_plane().then_some(Joint::InOnePlane)?
        };
        let (axis, sign) = best_axis(surface.input, &p)?;
        let is_alike = normal_component(surface.input, &q, axis) == sign;
        (is_alike == (one.is_flipped == other.is_flipped)).then_some(joint)
    }
}
