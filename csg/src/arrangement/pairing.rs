//! Which triangles of the boundary are neighbours, and which of their corners are one vertex.

use planecut_parallel::prelude::*;
use rustc_hash::FxHashMap;

use super::Arranged;
use super::around::{Around, half_planes};
use super::facets::{FacetKind, Side};
use super::fill::FilledFaces;
use super::merge::Face;
use super::surface::sorted;
use crate::closed_mesh::connectivity::{HalfEdges, NO_TWIN, next};
use crate::ids::{FacetId, Id, InputVertexId, PointId, number32};

/// The twin of a half-edge beside a triangle that passes through.
pub(super) const SEAM: u32 = NO_TWIN - 1;

impl Arranged<'_> {
    /// For each half-edge of the boundary the one that bounds the same wedge of the solid.
    pub(super) fn twins(&self, values: &[bool], faces: &[Face], filled: &FilledFaces, face_of: &[u32]) -> Vec<u32> {
        let triangles = &filled.triangles;
        let mut twins = HalfEdges::new(self.arrangement.points.len(), triangles).twins();
        let ends = |half_edge: u32| {
            let corners = triangles[half_edge as usize / 3];
            let from = corners[half_edge as usize % 3];
            let to = corners[(half_edge as usize + 1) % 3];
            [from, to].map(|point| PointId::from_index(point as usize))
        };
        self.mark_seams(&mut twins, faces, face_of);
        let lone = (0..number32(twins.len())).filter(|half_edge| twins[*half_edge as usize] == NO_TWIN);
        let mut lone: Vec<([PointId; 2], u32)> = lone.map(|h| (sorted(ends(h)[0], ends(h)[1]), h)).collect();
        lone.par_sort_unstable();
        let face = |half_edge: u32| face_of[half_edge as usize / 3];
        let mut sides: Vec<(Side, u32)> = Vec::new();
        for group in lone.chunk_by(|a, b| a.0 == b.0) {
            let along = group[0].0;
            // diagonals of one face belong together
            let (inner, outer): (Vec<u32>, Vec<u32>) =
                group.iter().map(|(_, half_edge)| *half_edge).partition(|half_edge| filled.is_diagonal(*half_edge));
            for half_edge in &inner {
                let is_back =
                    |other: &&u32| face(**other) == face(*half_edge) && ends(**other)[0] != ends(*half_edge)[0];
                if let Some(back) = inner.iter().find(is_back) {
                    twins[*half_edge as usize] = *back;
                }
            }
            sides.clear();
            sides.extend(outer.iter().map(|half_edge| {
                let kept = &faces[face(*half_edge) as usize].kept;
                let is_forward = (ends(*half_edge)[0] == along[0]) != kept.is_flipped;
                (Side { ends: along, facet: kept.facet, is_forward }, *half_edge)
            }));
            // where several pass they cross, and have been cut
            let passing = if sides.is_empty() { Vec::new() } else { self.slit_at(values, along) };
            self.pair_around(values, &sides, if passing.len() == 1 { &passing } else { &[] }, &mut twins);
        }
        twins
    }

    /// Pairs the half-edges at an edge that bound one wedge of the solid. Through wedges between a face that passes through the edge and
    /// others, pairs go on at its other side.
    fn pair_around(&self, values: &[bool], sides: &[(Side, u32)], passing: &[FacetId], twins: &mut [u32]) {
        let Some((first, _)) = sides.first() else { return };
        let half_edges: FxHashMap<Side, u32> = sides.iter().copied().collect();
        let both = |facet: &FacetId| [true, false].map(|is_forward| Side { facet: *facet, is_forward, ..*first });
        let order: Vec<Side> = sides.iter().map(|(side, _)| *side).chain(passing.iter().flat_map(both)).collect();
        let mut members = half_planes(&self.arrangement, &self.facets, &order);
        Around::of_side(&self.arrangement, first).sort(&mut members);
        let count = members.len();
        let place: FxHashMap<Side, usize> = members.iter().enumerate().map(|(k, (_, side))| (*side, k)).collect();
        // the side across the wedge of solid that one bounds
        let across = |side: &Side| {
            let after = if side.is_forward { &self.sheets.above } else { &self.sheets.below };
            let is_solid = values[after[side.facet.index()].index()];
            members[(place[side] + if is_solid { 1 } else { count - 1 }) % count].1
        };
        for (side, half_edge) in sides {
            let mut other = across(side);
            for _ in passing {
                if !half_edges.contains_key(&other) {
                    other = across(&Side { is_forward: !other.is_forward, ..other });
                }
            }
            if let Some(found) = half_edges.get(&other) {
                twins[*half_edge as usize] = *found;
            }
        }
    }

    /// Marks the half-edges beside patches.
    fn mark_seams(&self, twins: &mut [u32], faces: &[Face], face_of: &[u32]) {
        let surface = &self.arrangement.surface;
        let mut place = vec![NO_TWIN; surface.len()];
        for (triangle, face) in (0..).zip(face_of) {
            let face = &faces[*face as usize];
            if let FacetKind::Triangle(of) = self.facets.kind(face.kept.facet) {
                place[of.index()] = triangle;
            }
        }
        for (half_edge, _) in &surface.seams {
            let triangle = place[*half_edge as usize / 3];
            if triangle != NO_TWIN {
                let face = &faces[face_of[triangle as usize] as usize];
                let side = *half_edge % 3;
                // the second and third corner of one that is turned over have changed places
                let side = if face.kept.is_flipped { 2 - side } else { side };
                twins[(3 * triangle + side) as usize] = SEAM;
            }
        }
    }
}

/// Vertices of triangles.
pub(super) struct Fans {
    /// Those of each triangle.
    pub(super) vertices: Vec<[u32; 3]>,
    /// The point of each vertex.
    pub(super) points: Vec<PointId>,
    /// The smallest vertex of the input that whole triangles at it have.
    pub(super) inputs: Vec<Option<InputVertexId>>,
}

/// The vertices of triangles, joined around each fan of triangles alone; where triangles that pass through share a vertex of the input,
/// all corners there are one. `inputs` are the vertices of the input of whole triangles.
pub(super) fn fans(
    triangles: &[[u32; 3]],
    twins: &[u32],
    inputs: &[Option<[InputVertexId; 3]>],
    is_shared: impl Fn(InputVertexId) -> bool,
) -> Fans {
    let mut vertices = vec![[u32::MAX; 3]; triangles.len()];
    let mut fans = Fans { vertices: Vec::new(), points: Vec::new(), inputs: Vec::new() };
    let mut known: FxHashMap<InputVertexId, u32> = FxHashMap::default();
    let corner = |half_edge: u32| (half_edge as usize / 3, half_edge as usize % 3);
    for start in 0..number32(twins.len()) {
        let (t, k) = corner(start);
        if vertices[t][k] != u32::MAX {
            continue;
        }
        let fresh = number32(fans.points.len());
        let input = |t: usize, k: usize| inputs[t].map(|corners| corners[k]);
        let shared = input(t, k).filter(|vertex| is_shared(*vertex));
        let number = shared.map_or(fresh, |vertex| *known.entry(vertex).or_insert(fresh));
        let mut smallest = input(t, k);
        let mut half_edge = start;
        loop {
            let (t, k) = corner(half_edge);
            if vertices[t][k] != u32::MAX {
                break;
            }
            vertices[t][k] = number;
            smallest = smallest.into_iter().chain(input(t, k)).min();
            match twins[half_edge as usize] {
                NO_TWIN | SEAM => break,
                twin => half_edge = next(twin),
            }
        }
        if number == fresh {
            fans.points.push(PointId::from_index(triangles[t][k] as usize));
            fans.inputs.push(smallest);
        }
    }
    fans.vertices = vertices;
    fans
}
