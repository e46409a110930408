//! Which edges of a finished mesh are rounding noise, by the sizes of the faces that they lie between.
//!
//! An edge runs from one plane to another along the line of two more. Where its length is rounding noise, it is that of the planes at its
//! two ends; so it is compared with the coordinates of the faces there, and not with those of whatever else is in the model: neither
//! a body far away nor a large face beside the edge makes noise of a thin body.

use glam::DVec3;
use planecut_parallel::prelude::*;
use rustc_hash::FxHashSet;

use super::collapse::collapse_thin;
use super::contract::contract_noise;
use super::flip_caps::{flat_triangles, flip_caps, is_flat};
use super::{CHUNK, Mesh};
use crate::base::{by_group, map_chunks};
use crate::model::MaterialId;
use crate::tolerances::CONTRACTION;

/// An edge that is short enough to be noise.
#[derive(Debug, Clone, Copy)]
pub(super) struct NoiseEdge {
    /// Its vertices, the smaller one first.
    pub(super) ends: [u32; 2],
    length: f64,
    /// Up to which length it is noise.
    pub(super) bound: f64,
}

/// The largest coordinate of some points, whatever its sign.
pub(super) fn largest_coordinate(points: impl Iterator<Item = DVec3>) -> f64 {
    points.map(|point| point.abs().max_element()).fold(0.0, f64::max)
}

/// The vertices of faces on the walls of a block, of a material of their own: what is at walls stays as it is, noise or not, so that the block beside
/// it has the same there.
pub(super) fn vertices_on_walls(mesh: &Mesh, walls: Option<MaterialId>) -> FxHashSet<u32> {
    let is_on_wall = |face: &u32| Some(mesh.faces[*face as usize].material) == walls;
    let on_walls = mesh.triangles.iter().zip(&mesh.triangle_faces).filter(|(_, face)| is_on_wall(face));
    on_walls.flat_map(|(triangle, _)| *triangle).collect()
}

/// The length of the longest edge of a mesh that may be noise.
pub(super) fn longest_noise(mesh: &Mesh) -> f64 {
    CONTRACTION * largest_coordinate(mesh.positions.iter().copied())
}

/// The edges that are noise, shortest first.
pub(super) fn noise_edges(mesh: &Mesh, walls: Option<MaterialId>) -> Vec<NoiseEdge> {
    let length = |[a, b]: [u32; 2]| mesh.positions[a as usize].distance(mesh.positions[b as usize]);
    let longest = longest_noise(mesh);
    let sides = |triangle: &[u32; 3]| {
        let [a, b, c] = *triangle;
        [[a, b], [b, c], [c, a]].into_iter().filter(|[a, b]| a < b)
    };
    let is_short = |ends: &[u32; 2]| length(*ends) <= longest;
    let of_chunk = |triangles: &[[u32; 3]]| triangles.iter().flat_map(sides).filter(is_short).collect::<Vec<_>>();
    let mut short: Vec<[u32; 2]> = map_chunks(&mesh.triangles, CHUNK, of_chunk).0.concat();
    if !short.is_empty() && walls.is_some() {
        let fixed = vertices_on_walls(mesh, walls);
        short.retain(|ends| !ends.iter().any(|end| fixed.contains(end)));
    }
    if short.is_empty() {
        return Vec::new();
    }
    let sizes = FaceSizes::around(mesh, &short);
    let edge = |ends: &[u32; 2]| {
        let edge = NoiseEdge { ends: *ends, length: length(*ends), bound: CONTRACTION * sizes.at_ends(*ends) };
        (edge.length <= edge.bound).then_some(edge)
    };
    let mut noise: Vec<NoiseEdge> = short.par_iter().with_min_len(1024).filter_map(edge).collect();
    noise.par_sort_unstable_by(|p, q| p.length.total_cmp(&q.length).then(p.ends.cmp(&q.ends)));
    noise
}

/// The sizes of the faces around some vertices: their largest coordinates.
struct FaceSizes {
    sizes: Vec<f64>,
    /// For each vertex its place among these, [`NO_PLACE`] for others.
    place: Vec<u32>,
    /// Where the faces at each begin.
    starts: Vec<u32>,
    /// The faces at each vertex, ascending, once for each triangle.
    faces: Vec<u32>,
}

/// The place of a vertex that is not asked for.
const NO_PLACE: u32 = u32::MAX;

impl FaceSizes {
    fn around(mesh: &Mesh, edges: &[[u32; 2]]) -> Self {
        let (mut place, mut count) = (vec![NO_PLACE; mesh.positions.len()], 0);
        for end in edges.iter().flatten() {
            let place = &mut place[*end as usize];
            if *place == NO_PLACE {
                *place = count;
                count += 1;
            }
        }
        let chunks = mesh.triangles.par_chunks(CHUNK).zip(mesh.triangle_faces.par_chunks(CHUNK));
        let of_chunk = |(triangles, faces): (&[[u32; 3]], &[u32])| {
            // of faces that follow one another, and of a triangle and a vertex of it
            let mut sizes: Vec<(u32, f64)> = Vec::new();
            let mut at_vertices: Vec<(u32, u32)> = Vec::new();
            for (triangle, &face) in triangles.iter().zip(faces) {
                let size = largest_coordinate(triangle.iter().map(|v| mesh.positions[*v as usize]));
                match sizes.last_mut() {
                    Some((last, largest)) if *last == face => *largest = largest.max(size),
                    _ => sizes.push((face, size)),
                }
                let places = triangle.iter().map(|v| place[*v as usize]).filter(|place| *place != NO_PLACE);
                at_vertices.extend(places.map(|place| (place, face)));
            }
            (sizes, at_vertices)
        };
        let parts: Vec<_> = chunks.map(of_chunk).collect();
        let mut sizes = vec![0.0_f64; mesh.faces.len()];
        for (face, size) in parts.iter().flat_map(|(sizes, _)| sizes) {
            let largest = &mut sizes[*face as usize];
            *largest = largest.max(*size);
        }
        let at_vertices: Vec<(u32, u32)> = parts.into_iter().flat_map(|(_, at_vertices)| at_vertices).collect();
        let (place_of, face_of) = (|k: usize| at_vertices[k].0 as usize, |k: usize| at_vertices[k].1);
        let (starts, mut faces) = by_group(count as usize, at_vertices.len(), place_of, face_of);
        for ends in starts.windows(2) {
            faces[ends[0] as usize..ends[1] as usize].sort_unstable();
        }
        Self { sizes, place, starts, faces }
    }

    /// The faces at a vertex.
    fn at(&self, vertex: u32) -> &[u32] {
        let place = self.place[vertex as usize] as usize;
        &self.faces[self.starts[place] as usize..self.starts[place + 1] as usize]
    }

    /// The smaller one of the sizes at both ends of an edge: the largest size of the faces that meet it in that end alone, or, where all
    /// lie along it, of these.
    fn at_ends(&self, [a, b]: [u32; 2]) -> f64 {
        let (at_a, at_b) = (self.at(a), self.at(b));
        let largest =
            |faces: &mut dyn Iterator<Item = &u32>| faces.map(|face| self.sizes[*face as usize]).reduce(f64::max);
        let beyond = |own: &[u32], others: &[u32]| {
            largest(&mut own.iter().filter(|face| others.binary_search(face).is_err()))
                .or_else(|| largest(&mut own.iter()))
                .unwrap_or(0.0)
        };
        beyond(at_a, at_b).min(beyond(at_b, at_a))
    }
}

/// What was removed from a mesh as rounding noise.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Noise {
    /// How many edges were contracted, and vertices joined where a gap, tunnel or bubble was closed.
    pub collapsed: usize,
    /// The largest distance by which a vertex moved in that, in the input's units.
    pub thickest: f64,
}

impl Noise {
    /// Counts vertices that moved.
    pub(super) fn add(&mut self, collapsed: usize, moved: f64) {
        self.collapsed += collapsed;
        self.thickest = self.thickest.max(moved);
    }
}

/// Whether a triangle of a part of a mesh may be noise, or have an edge that is.
pub(crate) fn may_be_noise(part: &Mesh) -> bool {
    let longest = longest_noise(part);
    let is_suspicious = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|v| part.positions[v as usize]);
        let shortest = a.distance_squared(b).min(b.distance_squared(c)).min(c.distance_squared(a));
        shortest.sqrt() <= longest || is_flat([a, b, c])
    };
    part.triangles.par_iter().with_min_len(CHUNK).any(is_suspicious)
}

/// The height up to which a triangle is noise, by its own coordinates.
pub(super) fn noise_height(corners: [DVec3; 3]) -> f64 {
    CONTRACTION * largest_coordinate(corners.into_iter())
}

/// A mesh without the rounding noise of another that the weld made, and how much that was; nothing where there is none, or where the mesh
/// is not closed. What is at faces of the material of walls stays as it is.
pub(crate) fn without_noise(mesh: &Mesh, walls: Option<MaterialId>) -> Option<(Mesh, Noise)> {
    let edges = noise_edges(mesh, walls);
    let caps = flat_triangles(mesh);
    if edges.is_empty() && caps.is_empty() {
        return None;
    }
    let (mut cleared, mut noise) = (mesh.clone(), Noise::default());
    contract_noise(&mut cleared, edges, &mesh.positions, &mut noise);
    collapse_thin(&mut cleared, walls, &mut noise)?;
    flip_caps(&mut cleared, walls)?;
    Some((cleared, noise))
}
