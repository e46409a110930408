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

use crate::material::Looks;
use crate::part::{ExportOptions, Shading};
use smooth::SharedNormals;
use texture::Texture;

/// Marks a vertex that no triangle has used yet.
const NONE: u32 = u32::MAX;

/// Whether a triangle names three vertices.
pub(crate) fn has_three_corners([a, b, c]: &[u32; 3]) -> bool {
    a != b && b != c && c != a
}

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
    /// `sources` are those of the mesh's materials, where they are known; `has_normals` says whether normals are written, also those of flat faces.
    pub(crate) fn of(
        mesh: &Mesh,
        sources: &[FaceSource],
        triangles: &[u32],
        has_normals: bool,
        options: &ExportOptions,
    ) -> Self {
        let texture = options.texture.map(|mapping| Texture::new(mapping, sources));
        let mut splitter = Splitter::new(mesh, texture, options.vertex_colors, 3 * triangles.len());
        splitter.has_normals = has_normals;
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
    has_normals: bool,
    has_materials: bool,
    /// Which materials look alike, where textures go on from triangle to triangle.
    continued: Option<Looks>,
    vertices: Vertices,
}

/// What tells copies of a vertex apart whose texture goes on in other triangles: the normal, the coordinates as they are written, and the material
/// where vertices have one.
type ContinuedKey = ([u32; 3], [u32; 2], u32);

impl<'a> Splitter<'a> {
    fn new(mesh: &'a Mesh, texture: Option<Texture<'a>>, has_materials: bool, corners: usize) -> Self {
        let vertices = Vertices { corners: Vec::with_capacity(corners), ..Vertices::default() };
        let is_continued = texture.is_some_and(|texture| texture.is_continued_somewhere());
        let continued = is_continued.then(|| Looks::of(&mesh.materials));
        Self { mesh, texture, has_normals: true, has_materials, continued, vertices }
    }

    /// One copy of each vertex for each face that it belongs to; where its texture goes on from face to face, for each normal and each place in the
    /// picture.
    fn push_flat(&mut self, triangles: &[u32]) {
        if self.continued.is_some() {
            return self.push_flat_continued(triangles);
        }
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

    /// The same where some textures go on.
    fn push_flat_continued(&mut self, triangles: &[u32]) {
        let mut latest = vec![(NONE, NONE); self.mesh.positions.len()];
        let mut known: FxHashMap<(u32, ContinuedKey), u32> = FxHashMap::default();
        for &triangle in triangles {
            let face = self.mesh.triangle_faces[triangle as usize];
            let normal = self.mesh.faces[face as usize].normal;
            let told = if self.has_normals { unit(normal) } else { [0.0; 3] };
            for corner in self.mesh.triangles[triangle as usize] {
                if latest[corner as usize].0 != face {
                    let vertex = match self.continued_key(corner, face, told) {
                        None => self.push_vertex(corner, face, normal),
                        Some(key) => match known.get(&(corner, key)) {
                            Some(vertex) => *vertex,
                            None => {
                                let vertex = self.push_vertex(corner, face, normal);
                                known.insert((corner, key), vertex);
                                vertex
                            }
                        },
                    };
                    latest[corner as usize] = (face, vertex);
                }
                self.vertices.corners.push(latest[corner as usize].1);
            }
        }
    }

    /// What tells copies of a vertex apart at a face whose texture goes on; nothing at other faces.
    fn continued_key(&self, corner: u32, face: u32, normal: [f32; 3]) -> Option<ContinuedKey> {
        let looks = self.continued.as_ref()?;
        let texture = self.texture.filter(|texture| texture.is_continued(self.mesh, face))?;
        let at = texture.at(self.mesh, face, self.mesh.positions[corner as usize]);
        let at = written(at).map(f32::to_bits);
        let material = if self.has_materials { looks.of_face(self.mesh, face) } else { 0 };
        Some((normal.map(f32::to_bits), at, material))
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
        let mut known_continued: FxHashMap<(u32, ContinuedKey), u32> = FxHashMap::default();
        for &triangle in triangles {
            let face = self.mesh.triangle_faces[triangle as usize];
            let chart = self.texture.map_or(0, |texture| texture.chart(self.mesh, face));
            let material = if self.has_materials { self.mesh.faces[face as usize].material.0 } else { 0 };
            for (k, corner) in self.mesh.triangles[triangle as usize].into_iter().enumerate() {
                let shared = normals.shared_by(triangle, k);
                // the number of the normal stands for itself
                if let Some(key) = self.continued_key(corner, face, [0.0; 3]) {
                    let vertex = match known_continued.get(&(shared, key)) {
                        Some(vertex) => *vertex,
                        None => {
                            let vertex = self.push_vertex(corner, face, normals.normal(shared));
                            known_continued.insert((shared, key), vertex);
                            vertex
                        }
                    };
                    self.vertices.corners.push(vertex);
                    continue;
                }
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
            self.vertices.texture.push(written(texture.at(self.mesh, face, self.mesh.positions[corner as usize])));
        }
        if self.has_materials {
            self.vertices.materials.push(self.mesh.faces[face as usize].material.0);
        }
        vertex
    }
}

/// Texture coordinates as files have them.
fn written(DVec2 { x, y }: DVec2) -> [f32; 2] {
    [x as f32, y as f32]
}

/// In single precision, without the sign of zero.
fn unit(normal: DVec3) -> [f32; 3] {
    (normal.normalize().as_vec3() + glam::Vec3::ZERO).to_array()
}
