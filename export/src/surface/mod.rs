//! A mesh as renderers want it: vertices with normals, texture coordinates and colours, split where these differ.
//!
//! - `smooth`: which corners of triangles share a normal; `texture`: coordinates by projection.
//! - `single_precision`: edges too short for it.

mod single_precision;
mod smooth;
mod texture;

use glam::{DVec2, DVec3};
use planecut_csg::{FaceSource, Mesh};
use rustc_hash::FxHashMap;

pub(crate) use single_precision::without_lost_edges;

use crate::part::{ExportOptions, Shading};
use smooth::SharedNormals;
use texture::Texture;

/// Marks a vertex that no triangle has used yet.
const NONE: u32 = u32::MAX;

/// Vertices of one mesh, split.
#[derive(Debug, Default)]
pub(crate) struct Vertices {
    /// The vertex of the mesh that each was split from.
    pub(crate) origins: Vec<u32>,
    /// Unit normals.
    pub(crate) normals: Vec<[f32; 3]>,
    /// Texture coordinates, where asked for.
    pub(crate) texture: Vec<[f32; 2]>,
    /// Materials, where asked for.
    pub(crate) materials: Vec<u32>,
    /// Three for each triangle.
    pub(crate) corners: Vec<u32>,
}

impl Vertices {
    /// The vertices of some triangles of a checked mesh, in the order in which they are used. Triangles of a face follow one another;
    /// `sources` are those of the mesh's materials, where they are known.
    pub(crate) fn of(mesh: &Mesh, sources: &[FaceSource], triangles: &[u32], options: &ExportOptions) -> Self {
        let texture = options.texture.map(|mapping| Texture::new(mapping, sources));
        let mut splitter = Splitter::new(mesh, texture, options.vertex_colors, 3 * triangles.len());
        match options.shading {
            Shading::Flat => splitter.push_flat(triangles),
            Shading::Smooth { crease } => splitter.push_smooth(triangles, &SharedNormals::of(mesh, crease)),
        }
        splitter.vertices
    }

    /// Adds a copy of a vertex and returns its number.
    pub(crate) fn repeat(&mut self, vertex: u32) -> u32 {
        fn push<T: Copy>(values: &mut Vec<T>, vertex: u32) {
            values.extend(values.get(vertex as usize).copied());
        }
        push(&mut self.origins, vertex);
        push(&mut self.normals, vertex);
        push(&mut self.texture, vertex);
        push(&mut self.materials, vertex);
        self.origins.len() as u32 - 1
    }

    /// Numbers the vertices by their first use; each must be used.
    pub(crate) fn renumber(&mut self) {
        let mut new = vec![NONE; self.origins.len()];
        let mut next = 0;
        for corner in &mut self.corners {
            let place = &mut new[*corner as usize];
            if *place == NONE {
                *place = next;
                next += 1;
            }
            *corner = *place;
        }
        if new.is_sorted() {
            return;
        }
        let mut moved = vec![false; new.len()];
        move_to(&mut self.origins, &new, &mut moved);
        move_to(&mut self.normals, &new, &mut moved);
        move_to(&mut self.texture, &new, &mut moved);
        move_to(&mut self.materials, &new, &mut moved);
    }
}

/// Moves each value to its new place, one cycle of places after another, so that no second list is needed; an empty list stays so.
fn move_to<T: Copy>(values: &mut [T], new: &[u32], moved: &mut [bool]) {
    moved.fill(false);
    for start in 0..values.len() {
        let (mut value, mut at) = (values[start], start);
        while !moved[at] {
            moved[at] = true;
            at = new[at] as usize;
            std::mem::swap(&mut value, &mut values[at]);
        }
    }
}

/// Splits vertices.
struct Splitter<'a> {
    mesh: &'a Mesh,
    texture: Option<Texture<'a>>,
    has_materials: bool,
    vertices: Vertices,
}

impl<'a> Splitter<'a> {
    fn new(mesh: &'a Mesh, texture: Option<Texture<'a>>, has_materials: bool, corners: usize) -> Self {
        let vertices = Vertices { corners: Vec::with_capacity(corners), ..Vertices::default() };
        Self { mesh, texture, has_materials, vertices }
    }

    /// One copy of each vertex for each face that it belongs to.
    fn push_flat(&mut self, triangles: &[u32]) {
        let count = self.flat_count(triangles);
        self.vertices.origins.reserve_exact(count);
        self.vertices.normals.reserve_exact(count);
        // for each vertex of the mesh the face of its latest copy, and the copy: looking back by one face suffices
        let mut latest = vec![(NONE, NONE); self.mesh.positions.len()];
        for &triangle in triangles {
            let face = self.mesh.triangle_faces[triangle as usize];
            for corner in self.mesh.triangles[triangle as usize] {
                if latest[corner as usize].0 != face {
                    let normal = self.mesh.faces[face as usize].normal;
                    latest[corner as usize] = (face, self.push_vertex(corner, face, normal));
                }
                self.vertices.corners.push(latest[corner as usize].1);
            }
        }
    }

    /// How many vertices there are with one copy for each face.
    fn flat_count(&self, triangles: &[u32]) -> usize {
        let (mut latest, mut count) = (vec![NONE; self.mesh.positions.len()], 0);
        for &triangle in triangles {
            let face = self.mesh.triangle_faces[triangle as usize];
            for corner in self.mesh.triangles[triangle as usize] {
                let latest = &mut latest[corner as usize];
                count += usize::from(*latest != face);
                *latest = face;
            }
        }
        count
    }

    /// One copy of each vertex for each normal, and for each way in which its texture lies.
    fn push_smooth(&mut self, triangles: &[u32], normals: &SharedNormals) {
        let mut known: FxHashMap<(u32, u32, u32), u32> = FxHashMap::default();
        for &triangle in triangles {
            let face = self.mesh.triangle_faces[triangle as usize];
            let chart = self.texture.map_or(0, |texture| texture.chart(self.mesh, face));
            let material = if self.has_materials { self.mesh.faces[face as usize].material.0 } else { 0 };
            for (k, corner) in self.mesh.triangles[triangle as usize].into_iter().enumerate() {
                let shared = normals.shared_by(triangle, k);
                let vertex = match known.get(&(shared, chart, material)) {
                    Some(vertex) => *vertex,
                    None => {
                        let vertex = self.push_vertex(corner, face, normals.normal(shared));
                        known.insert((shared, chart, material), vertex);
                        vertex
                    }
                };
                self.vertices.corners.push(vertex);
            }
        }
    }

    fn push_vertex(&mut self, corner: u32, face: u32, normal: DVec3) -> u32 {
        let vertex = self.vertices.origins.len() as u32;
        self.vertices.origins.push(corner);
        self.vertices.normals.push(unit(normal));
        if let Some(texture) = self.texture {
            let DVec2 { x, y } = texture.at(self.mesh, face, self.mesh.positions[corner as usize]);
            self.vertices.texture.push([x as f32, y as f32]);
        }
        if self.has_materials {
            self.vertices.materials.push(self.mesh.faces[face as usize].material.0);
        }
        vertex
    }
}

/// In single precision, without the sign of zero.
fn unit(normal: DVec3) -> [f32; 3] {
    (normal.normalize().as_vec3() + glam::Vec3::ZERO).to_array()
}
