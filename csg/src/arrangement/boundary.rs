//! The boundary of a combination of meshes: the facets that have the solid on one side alone, as a mesh.

use planecut_kernel::DVec3;
use planecut_kernel::sign::{Counts, Sign};
use planecut_parallel::prelude::*;
use rustc_hash::FxHashMap;

use super::around::Around;
use super::facets::Side;
use super::merge::Face;
use super::predicates::best_axis;
use super::surface::sorted;
use super::winding::Windings;
use super::{Arranged, Arrangement, measures};
use crate::base::map_chunks;
use crate::closed_mesh::connectivity::{HalfEdges, NO_TWIN, next};
use crate::ids::{FacetId, HalfEdgeId, Id, LineId, PointId, StateId, number32};
use crate::mesh::{Flaw, Mesh, MeshFace, Noise, SolidMeasures, proven};
use crate::model::MaterialId;
use crate::weld::Projection;
use crate::weld::manifold::split_repeated_edges;
use crate::weld::triangulate::{ExactPoints, LoopCorner, Triangles, Triangulator};

/// A facet of the boundary.
#[derive(Debug, Clone, Copy)]
pub(super) struct Kept {
    pub(super) facet: FacetId,
    /// Whether the solid is above it, so that the triangle it is a part of faces inwards.
    pub(super) is_flipped: bool,
    pub(super) material: MaterialId,
}

/// The triangles of facets, one facet after the other.
#[derive(Debug, Default)]
struct FilledFacets {
    triangles: Vec<[u32; 3]>,
    /// The number of triangles of each facet.
    counts: Vec<u32>,
}

/// Points of an arrangement, seen along an axis.
struct ArrangementPoints<'a>(&'a Arrangement);

impl ExactPoints for ArrangementPoints<'_> {
    fn turn(&self, points: [PointId; 3], Projection { u, v }: Projection) -> Sign {
        let turn = self.0.points.turn(&self.0.surface, points, 3 - u - v);
        if (u + 1) % 3 == v { turn } else { turn.flip() }
    }

    fn order(&self, a: PointId, b: PointId, Projection { u, v }: Projection) -> std::cmp::Ordering {
        self.0.points.compare_along(&self.0.surface, a, b, [u, v])
    }
}

impl Arranged {
    /// The boundary of what `is_solid` says of combinations of winding numbers, and its measures.
    pub(super) fn boundary(&self, is_solid: impl Fn(&Windings) -> bool) -> Result<(Mesh, SolidMeasures, Noise), Flaw> {
        let values: Vec<bool> = self.sheets.states.windings.iter().map(&is_solid).collect();
        let kept = self.kept(&values, &is_solid);
        let solid = measures::of_facets(self, &kept);
        let faces = self.faces(&kept);
        drop(kept);
        let (parts, _): (Vec<FilledFacets>, Counts) = map_chunks(&faces, 1 << 10, |faces| self.filled(faces));
        let triangles: Vec<[u32; 3]> = parts.iter().flat_map(|part| &part.triangles).copied().collect();
        let counts = parts.iter().flat_map(|part| &part.counts);
        let mut triangle_faces = Vec::with_capacity(triangles.len());
        for (face, count) in (0..).zip(counts) {
            triangle_faces.extend(std::iter::repeat_n(face, *count as usize));
        }
        let twins = self.twins(&values, &faces, &triangles, &triangle_faces);
        let (vertices, points) = fans(&triangles, &twins);
        let Arrangement { surface, points: all, .. } = &self.arrangement;
        let mut mesh = Mesh {
            positions: points.iter().map(|point| all.at(surface, *point)).collect(),
            triangles: vertices,
            triangle_faces,
            faces: faces.iter().map(|face| self.mesh_face(&face.kept)).collect(),
            materials: Vec::new(),
        };
        let side = |half_edge: u32| HalfEdgeId::from_index(half_edge as usize);
        let mut labels = (0..number32(triangles.len())).map(|t| [0, 1, 2].map(|k| side(3 * t + k))).collect();
        split_repeated_edges(&mut mesh, &mut labels, |piece| side(twins[piece.index()]));
        let (mesh, noise) = proven(mesh, &solid)?;
        Ok((mesh, solid, noise))
    }

    fn kept(&self, values: &[bool], is_solid: &impl Fn(&Windings) -> bool) -> Vec<Kept> {
        let all = FacetId::all(self.facets.len()).filter(|facet| !self.facets.is_gone(*facet));
        all.filter_map(|facet| {
            let [above, below] = [&self.sheets.above, &self.sheets.below].map(|states| states[facet.index()]);
            let (is_above, is_below) = (values[above.index()], values[below.index()]);
            let material = || self.material(facet, if is_above { below } else { above }, is_above, is_solid);
            (is_above != is_below).then(|| Kept { facet, is_flipped: is_above, material: material() })
        })
        .collect()
    }

    /// The material of a facet. Where several lie upon each other they take turns from the empty side to the solid one, those that lower
    /// a winding number first, then by material and operand; the one at whose turn the solid begins gives its own.
    fn material(
        &self,
        facet: FacetId,
        empty: StateId,
        is_flipped: bool,
        is_solid: &impl Fn(&Windings) -> bool,
    ) -> MaterialId {
        let surface = &self.arrangement.surface;
        let triangle = |facet| self.facets.triangle(&self.arrangement.cells, facet);
        let doubles = self.facets.doubles(facet);
        if doubles.is_empty() {
            return surface.material(triangle(facet));
        }
        let turn_of = |facet: FacetId, is_same: bool| {
            let triangle = triangle(facet);
            (is_same != is_flipped, surface.material(triangle), surface.operands[triangle.index()])
        };
        let mut turns = vec![turn_of(facet, true)];
        turns.extend(doubles.iter().map(|double| turn_of(double.facet, double.is_same)));
        turns.sort_unstable();
        let mut windings: FxHashMap<u32, i32> = self.sheets.states.windings[empty.index()].iter().copied().collect();
        for &(is_up, material, operand) in &turns {
            *windings.entry(operand).or_insert(0) += if is_up { 1 } else { -1 };
            let mut now: Windings =
                windings.iter().map(|(k, v)| (*k, *v)).filter(|(_, winding)| *winding != 0).collect();
            now.sort_unstable();
            if is_solid(&now) {
                return material;
            }
        }
        turns[0].1
    }

    /// How a facet is seen from outside the solid.
    fn projection(&self, kept: &Kept) -> Option<Projection> {
        let triangle = self.facets.triangle(&self.arrangement.cells, kept.facet);
        let (axis, sign) = best_axis(&self.arrangement.surface, triangle)?;
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let is_upright = (sign == Sign::Positive) != kept.is_flipped;
        Some(if is_upright { Projection { u, v } } else { Projection { u: v, v: u } })
    }

    fn mesh_face(&self, kept: &Kept) -> MeshFace {
        let [a, b, c] = self.arrangement.surface.places(self.facets.triangle(&self.arrangement.cells, kept.facet));
        // lengths whose products neither overflow nor vanish
        let (p, q) = (b - a, c - a);
        let normal = (p / p.abs().max_element()).cross(q / q.abs().max_element());
        let normal = (normal / normal.abs().max_element()).normalize_or(DVec3::Z);
        MeshFace { normal: if kept.is_flipped { -normal } else { normal }, material: kept.material }
    }

    /// The loops of a facet, as seen from outside the solid, without segments that run both ways along it.
    pub(super) fn loops(&self, kept: &Kept) -> Vec<Vec<PointId>> {
        let Arrangement { surface, cells, points: all, .. } = &self.arrangement;
        let mut loops: Vec<Vec<PointId>> = match self.facets.cell(kept.facet) {
            None => vec![surface.corners[kept.facet.index()].to_vec()],
            Some(cell) => {
                cells.loops(cell).flat_map(|points| without_slits(points, |point| all.at(surface, point))).collect()
            }
        };
        if kept.is_flipped {
            loops.iter_mut().for_each(|points| points.reverse());
        }
        loops
    }

    fn filled(&self, faces: &[Face]) -> FilledFacets {
        let exact = ArrangementPoints(&self.arrangement);
        let mut triangulator = Triangulator::new(&exact);
        let mut filled = FilledFacets::default();
        for Face { kept, loops } in faces {
            let before = filled.triangles.len();
            if loops.is_empty() {
                let [a, b, c] = self.arrangement.surface.corners[kept.facet.index()].map(|point| point.number());
                filled.triangles.push(if kept.is_flipped { [a, c, b] } else { [a, b, c] });
            } else if let Some(projection) = self.projection(kept) {
                triangulator.begin(projection);
                let mut first = 0;
                for points in loops {
                    triangulator.add_loop(points.iter().enumerate().map(|(k, point)| LoopCorner {
                        point: *point,
                        at: self.arrangement.points.at(&self.arrangement.surface, *point),
                        line: LineId::from_index(first + k),
                        piece: HalfEdgeId::from_index(first + k),
                    }));
                    first += points.len();
                }
                let mut triangles = Triangles::default();
                triangulator.triangulate(&mut triangles);
                let all: Vec<PointId> = loops.concat();
                filled
                    .triangles
                    .extend(triangles.corners.iter().map(|corners| corners.map(|k| all[k.index()].number())));
            }
            filled.counts.push(number32(filled.triangles.len() - before));
        }
        filled
    }

    /// For each half-edge of the boundary the one that bounds the same wedge of the solid.
    fn twins(&self, values: &[bool], faces: &[Face], triangles: &[[u32; 3]], face_of: &[u32]) -> Vec<u32> {
        let mut twins = HalfEdges::new(self.arrangement.points.len(), triangles).twins();
        let ends = |half_edge: u32| {
            let corners = triangles[half_edge as usize / 3];
            let from = corners[half_edge as usize % 3];
            let to = corners[(half_edge as usize + 1) % 3];
            [from, to].map(|point| PointId::from_index(point as usize))
        };
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
            let mut order: Vec<Side> = sides.iter().map(|(side, _)| *side).collect();
            let Some(first) = order.first() else { continue };
            Around::new(&self.arrangement, first).sort(&self.facets, &mut order);
            let half_edge = |side: &Side| sides.iter().find(|(other, _)| other == side).map_or(NO_TWIN, |(_, h)| *h);
            for (k, side) in order.iter().enumerate() {
                let after = if side.is_forward { &self.sheets.above } else { &self.sheets.below };
                if values[after[side.facet.index()].index()] {
                    let (one, other) = (half_edge(side), half_edge(&order[(k + 1) % order.len()]));
                    (twins[one as usize], twins[other as usize]) = (other, one);
                }
            }
        }
        twins
    }
}

/// The vertices of triangles, joined around each fan of triangles alone; and for each vertex its point.
fn fans(triangles: &[[u32; 3]], twins: &[u32]) -> (Vec<[u32; 3]>, Vec<PointId>) {
    let mut vertices = vec![[u32::MAX; 3]; triangles.len()];
    let mut points = Vec::new();
    for start in 0..number32(twins.len()) {
        let corner = |half_edge: u32| (half_edge as usize / 3, half_edge as usize % 3);
        let (t, k) = corner(start);
        if vertices[t][k] != u32::MAX {
            continue;
        }
        let number = number32(points.len());
        points.push(PointId::from_index(triangles[t][k] as usize));
        let mut half_edge = start;
        loop {
            let (t, k) = corner(half_edge);
            if vertices[t][k] != u32::MAX {
                break;
            }
            vertices[t][k] = number;
            match twins[half_edge as usize] {
                NO_TWIN => break,
                twin => half_edge = next(twin),
            }
        }
    }
    (vertices, points)
}

/// The loops that are left of one without the segments that it runs along both ways; the one around the others first.
fn without_slits(points: &[PointId], at: impl Fn(PointId) -> DVec3) -> Vec<Vec<PointId>> {
    let count = points.len();
    let to = |k: usize| points[(k + 1) % count];
    let mut place: FxHashMap<(PointId, PointId), usize> = FxHashMap::default();
    place.extend((0..count).map(|k| ((points[k], to(k)), k)));
    let back: Vec<Option<usize>> = (0..count).map(|k| place.get(&(to(k), points[k])).copied()).collect();
    if back.iter().all(Option::is_none) {
        return vec![points.to_vec()];
    }
    let mut next: Vec<usize> = (0..count).map(|k| (k + 1) % count).collect();
    let mut previous: Vec<usize> = (0..count).map(|k| (k + count - 1) % count).collect();
    for (k, back) in back.iter().enumerate() {
        let Some(back) = back.filter(|back| *back > k) else { continue };
        for (one, other) in [(k, back), (back, k)] {
            let (before, after) = (previous[one], next[other]);
            (next[before], previous[after]) = (after, before);
        }
    }
    let mut is_done: Vec<bool> = back.iter().map(Option::is_some).collect();
    let mut loops = Vec::new();
    for start in 0..count {
        let mut members = Vec::new();
        let mut k = start;
        while !std::mem::replace(&mut is_done[k], true) {
            members.push(points[k]);
            k = next[k];
        }
        if !members.is_empty() {
            loops.push(members);
        }
    }
    loops.sort_by(|a, b| area(b, &at).total_cmp(&area(a, &at)));
    loops
}

/// Twice the area within a loop.
pub(super) fn area(points: &[PointId], at: impl Fn(PointId) -> DVec3) -> f64 {
    let origin = at(points[0]);
    let fan = points.windows(2).map(|ends| (at(ends[0]) - origin).cross(at(ends[1]) - origin));
    fan.sum::<DVec3>().length()
}
