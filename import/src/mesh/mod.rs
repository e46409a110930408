//! Readers of indexed triangle meshes: OBJ, STL, PLY and glTF.
//!
//! Each gives the mesh as the file states it: nothing is repaired and no triangle is dropped. Vertices keep the file's
//! indices where it has meaningful ones (OBJ, PLY, glTF with `EXT_mesh_manifold`). STL has none and plain glTF splits vertices
//! where normals differ: there, vertices with equal coordinates become one. That cannot tell parts of a surface that merely
//! touch in a vertex or edge from parts that are connected, so a sound mesh may come back with pinched vertices or edges
//! used four times.

pub(crate) mod colors;
mod decimals;
mod error;
mod gltf;
pub(crate) mod merge;
mod obj;
mod ply;
mod polygon;
mod solid;
mod stl;
mod text;
mod textures;

use std::ops::Range;

use glam::{DVec2, DVec3};
use planecut_csg::Material;

pub use error::{MeshError, Place};
pub use planecut_csg::WindingRule;
pub use planecut_shapes::polyhedron::Precision;
pub(crate) use solid::joined_message;
pub use solid::{
    MeshImport, PartsImport, SolidError, SolidOptions, TrianglesImport, parts_of_mesh, read_parts, read_solid,
    read_triangles, solid_of_mesh,
};

use error::Fault;

/// A mesh file format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MeshFormat {
    /// Wavefront OBJ.
    Obj,
    /// STL, binary or ASCII.
    Stl,
    /// PLY, ASCII or binary in either byte order.
    Ply,
    /// glTF 2.0, as a binary container or as JSON with embedded buffers.
    Gltf,
}

impl MeshFormat {
    /// The format that a file name's extension stands for: `obj`, `stl`, `ply`, `glb` or `gltf` in any case.
    #[must_use]
    pub fn from_extension(extension: &str) -> Option<Self> {
        match extension.to_ascii_lowercase().as_str() {
            "obj" => Some(Self::Obj),
            "stl" => Some(Self::Stl),
            "ply" => Some(Self::Ply),
            "glb" | "gltf" => Some(Self::Gltf),
            _ => None,
        }
    }
}

/// A named part of a mesh.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MeshObject {
    /// The name, where the file gives one.
    pub name: Option<String>,
    /// Its triangles in [`IndexedMesh::triangles`]; never empty.
    pub triangles: Range<usize>,
}

/// An indexed triangle mesh as a file states it.
///
/// # Guarantees
/// Coordinates are finite, indices are below the number of positions, there is at least one triangle, and the objects' ranges
/// follow one another and hold every triangle once. Whether the surface is closed is for `planecut_check` to say.
#[derive(Debug, Clone, PartialEq)]
pub struct IndexedMesh {
    /// Vertex positions in the file's units and axes; of glTF, after the nodes' transforms.
    pub positions: Vec<DVec3>,
    /// Vertex indices of each triangle, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// The parts: OBJ objects (or groups, where there are no objects), solids of an ASCII STL, mesh nodes of glTF.
    pub objects: Vec<MeshObject>,
    /// How exactly the coordinates are known: by the type of the numbers, or by the looks of decimals.
    pub precision: Precision,
    /// The materials that OBJ (`usemtl`) and glTF name, as often as the file does.
    pub materials: Vec<Material>,
    /// Of each triangle the number of its material, where it has one; empty where the file names none.
    pub material_of: Vec<Option<u32>>,
    /// Of each triangle its colour, linear RGB, where it has one: its own, or the mean of those of its vertices; empty where the file gives none.
    /// [`painted`](Self::painted) makes materials of them.
    pub colors: Vec<Option<[f32; 3]>>,
    /// Of each triangle the texture coordinates at its corners, in whole pictures and `v` down, where all three have some; empty where the file gives
    /// none, or they were not asked for.
    pub textures: Vec<Option<[DVec2; 3]>>,
    /// Where in the file each triangle's facet begins; empty where that says nothing.
    pub places: Vec<Place>,
}

impl IndexedMesh {
    /// A mesh of one object, without materials.
    fn plain(positions: Vec<DVec3>, triangles: Vec<[u32; 3]>, precision: Precision) -> Self {
        let objects = objects_from_starts(Vec::new(), triangles.len());
        let (materials, material_of, colors) = (Vec::new(), Vec::new(), Vec::new());
        let (textures, places) = (Vec::new(), Vec::new());
        Self { positions, triangles, objects, precision, materials, material_of, colors, textures, places }
    }
}

/// Reads a mesh; `name` is what errors call the file.
///
/// Polygons are cut into triangles without adding or dropping vertices. Lines, points, normals and textures are passed over; [`read_textured_mesh`]
/// reads texture coordinates, too.
///
/// # Errors
/// [`MeshError`] where the data is damaged, truncated or not of this format, refers to other files, or holds no triangle.
pub fn read_mesh(bytes: &[u8], format: MeshFormat, name: &str) -> Result<IndexedMesh, MeshError> {
    read_some(bytes, format, name, false)
}

/// Reads a mesh with its texture coordinates: `vt` of OBJ, `TEXCOORD_0` of glTF, and of PLY `s t`, `u v` or `texture_u texture_v` of vertices or
/// `texcoord` of faces. Otherwise as [`read_mesh`].
///
/// # Errors
/// [`MeshError`] as [`read_mesh`], and where texture coordinates are damaged.
pub fn read_textured_mesh(bytes: &[u8], format: MeshFormat, name: &str) -> Result<IndexedMesh, MeshError> {
    read_some(bytes, format, name, true)
}

fn read_some(bytes: &[u8], format: MeshFormat, name: &str, has_textures: bool) -> Result<IndexedMesh, MeshError> {
    let check = |mesh: IndexedMesh| if mesh.triangles.is_empty() { Err(no_triangles()) } else { Ok(mesh) };
    read(bytes, format, has_textures).and_then(check).map_err(|fault| fault.in_file(name))
}

/// Reads a mesh that may be empty: without triangles and without vertices. Otherwise as [`read_mesh`].
///
/// # Errors
/// [`MeshError`] as [`read_mesh`], also where there are vertices without triangles. Of an OBJ file some statement must say that there is an object.
pub fn read_mesh_or_empty(bytes: &[u8], format: MeshFormat, name: &str) -> Result<IndexedMesh, MeshError> {
    let check = |mesh: IndexedMesh| {
        let is_empty = mesh.positions.is_empty();
        if mesh.triangles.is_empty() && !is_empty { Err(no_triangles()) } else { Ok(mesh) }
    };
    read(bytes, format, false).and_then(check).map_err(|fault| fault.in_file(name))
}

/// Texture coordinates are passed over unless they are asked for: they take time and memory.
fn read(bytes: &[u8], format: MeshFormat, has_textures: bool) -> Result<IndexedMesh, Fault> {
    match format {
        MeshFormat::Obj => obj::read(bytes, has_textures),
        MeshFormat::Stl => stl::read(bytes),
        MeshFormat::Ply => ply::read(bytes, has_textures),
        MeshFormat::Gltf => gltf::read(bytes, has_textures),
    }
}

fn no_triangles() -> Fault {
    Fault::new(Place::End, "no triangles", "at least one")
}

/// The objects of a mesh of `count` triangles that starts a new one at each `(first triangle, name)`; empty ones are dropped.
fn objects_from_starts(starts: Vec<(usize, Option<String>)>, count: usize) -> Vec<MeshObject> {
    let mut objects: Vec<MeshObject> = Vec::new();
    let mut pending = (0, None);
    for (start, name) in starts.into_iter().chain([(count, None)]) {
        let (begin, old_name) = std::mem::replace(&mut pending, (start, name));
        if begin < start {
            objects.push(MeshObject { name: old_name, triangles: begin..start });
        }
    }
    objects
}
