//! Which triangles of the boundary are neighbours, and which of their corners are one vertex.

use planecut_parallel::prelude::*;
use rustc_hash::FxHashMap;

use super::Arranged;
use super::around::{Around, half_planes};
use super::facets::{FacetKind, Side};
use super::merge::Face;
use super::surface::sorted;
use crate::closed_mesh::connectivity::{HalfEdges, NO_TWIN, next};
use crate::ids::{Id, InputVertexId, PointId, number32};

/// The twin of a half-edge beside a triangle that passes through.
pub(super) const SEAM: u32 = NO_TWIN - 1;

impl Arranged<'_> {
    /// For each half-edge of the boundary the one that bounds the same wedge of the solid.
    pub(super) fn twins(&self, values: &[bool], faces: &[Face], triangles: &[[u32; 3]], face_of: &[u32]) -> Vec<u32> {
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
        let mut sides: Vec<(Side, u32)> = Vec::new();
        for group in lone.chunk_by(|a, b| a.0 == b.0) {
            sides.clear();
            sides.extend(group.iter().map(|(along, half_edge)| {
                let kept = &faces[face_of[*half_edge as usize / 3] as usize].kept;
                let is_forward = (ends(*half_edge)[0] == along[0]) != kept.is_flipped;
                (Side { ends: *along, facet: kept.facet, is_forward }, *half_edge)
            }));
            // diagonals of one facet belong together
            let mut k = 0;
            while k < sides.len() {
                let (side, half_edge) = sides[k];
                let opposite =
                    |(other, _): &(Side, u32)| other.facet == side.facet && other.is_forward != side.is_forward;
                if let Some(other) = sides[k + 1..].iter().position(opposite) {
                    let (_, back) = sides.remove(k + 1 + other);
                    sides.remove(k);
                    (twins[half_edge as usize], twins[back as usize]) = (back, half_edge);
                } else {
                    k += 1;
                }
            }
            self.pair_around(values, &sides, &mut twins);
        }
        twins
    }

    /// Pairs the half-edges at an edge that bound one wedge of the solid.
    fn pair_around(&self, values: &[bool], sides: &[(Side, u32)], twins: &mut [u32]) {
        let Some((first, _)) = sides.first() else { return };
        let half_edges: FxHashMap<Side, u32> = sides.iter().copied().collect();
        let order: Vec<Side> = sides.iter().map(|(side, _)| *side).collect();
        let mut members = half_planes(&self.arrangement, &self.facets, &order);
        Around::of_side(&self.arrangement, first).sort(&mut members);
        for (k, (_, side)) in members.iter().enumerate() {
            let after = if side.is_forward { &self.sheets.above } else { &self.sheets.below };
            if values[after[side.facet.index()].index()] {
                let (one, other) = (half_edges[side], half_edges[&members[(k + 1) % members.len()].1]);
                (twins[one as usize], twins[other as usize]) = (other, one);
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
