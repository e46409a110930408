//! glTF 2.0: binary containers, and JSON with embedded buffers.
//!
//! Every mesh node of every scene becomes an object, with the transforms of its ancestors applied in `f64`. Within a node's mesh,
//! over all its primitives, vertices with equal coordinates become one: formats for rendering split vertices where normals or
//! materials differ. Two parts that merely touch are glued by that. A mesh with the extension `EXT_mesh_manifold` says
//! which vertices are one; there its indices are taken as they stand. Vertices of different nodes stay different.
//! Buffers may be packed (`EXT_meshopt_compression`) and positions whole numbers (`KHR_mesh_quantization`).
//!
//! Points, lines, morph targets and skins are passed over.
//!
//! Accessors, primitives and the items of arrays are read with the crate `gltf`. Ours are: the container ([`container`] says why), what the crate's
//! document loses ([`document`]), the limits that a hostile file meets, and the extensions, of which the crate has none of these.

mod accessor;
mod container;
mod document;
mod geometry;
#[cfg_attr(not(feature = "meshopt"), path = "packed_missing.rs")]
mod packed;
mod transform;

use glam::{DVec2, DVec3};
use planecut_csg::Material;

use super::error::{Fault, Place};
use super::{IndexedMesh, MeshObject, Precision, textures};

use accessor::Buffers;
use document::Document;
use geometry::Geometry;

/// Most triangles over all nodes: a small file can ask for the same mesh, or the same accessor, any number of times.
const MAX_TRIANGLES: usize = 200_000_000;

/// Extensions that a file may require: they do not change where triangles are, or they are read.
const HARMLESS: [&str; 3] = ["KHR_mesh_quantization", "EXT_mesh_manifold", "EXT_meshopt_compression"];
const HARMLESS_PREFIXES: [&str; 4] = ["KHR_materials_", "KHR_texture_", "EXT_texture_", "KHR_lights_"];

/// Reads a glTF file, with `TEXCOORD_0` where texture coordinates are asked for.
pub(super) fn read(bytes: &[u8], has_textures: bool) -> Result<IndexedMesh, Fault> {
    let (json, binary) = container::split(bytes)?;
    let document = document::parse(json)?;
    check_requirements(&document)?;
    let buffers = Buffers::new(&document, json, binary)?;
    let mut mesh = IndexedMesh::plain(Vec::new(), Vec::new(), Precision::Single);
    mesh.materials = document.materials.iter().enumerate().map(material).collect();
    let mut geometries: Vec<Option<Geometry>> = document.meshes.iter().map(|_| None).collect();
    for placed in transform::placed_meshes(&document)? {
        let slot = &mut geometries[placed.mesh];
        if slot.is_none() {
            *slot = Some(geometry::read(&document, &buffers, placed.mesh, has_textures)?);
        }
        let Some(geometry) = slot else { continue };
        append(&mut mesh, geometry, &placed)?;
    }
    mesh.textures = textures::known(mesh.textures);
    Ok(mesh)
}

/// A material of the file; one without a name is called by its number.
fn material((number, material): (usize, &document::Material)) -> Material {
    let name = material.name.clone().unwrap_or_else(|| format!("material {number}"));
    let factors = &material.pbr_metallic_roughness;
    let color = factors.base_color_factor.map(|[r, g, b, _]| [r, g, b]);
    Material { color, metallic: factors.metallic_factor, roughness: factors.roughness_factor, ..Material::named(name) }
}

fn check_requirements(document: &Document) -> Result<(), Fault> {
    let is_harmless = |name: &str| HARMLESS.contains(&name) || HARMLESS_PREFIXES.iter().any(|p| name.starts_with(p));
    match document.extensions_required.iter().find(|name| !is_harmless(name)) {
        None => Ok(()),
        Some(name) => {
            let found = format!("the required extension `{}`", name.escape_debug());
            Err(Fault::new(Place::Json("extensionsRequired".to_owned()), found, "a file without it"))
        }
    }
}

/// Appends a mesh in the place that a node gives it.
fn append(mesh: &mut IndexedMesh, geometry: &Geometry, placed: &transform::PlacedMesh) -> Result<(), Fault> {
    let too_many = || Fault::whole("more triangles", format!("at most {MAX_TRIANGLES} over all nodes"));
    if geometry.triangles.len() > MAX_TRIANGLES - mesh.triangles.len() {
        return Err(too_many());
    }
    if geometry.triangles.is_empty() {
        return Ok(());
    }
    let shift = u32::try_from(mesh.positions.len()).map_err(|_| too_many())?;
    if u32::try_from(mesh.positions.len() + geometry.positions.len()).is_err() {
        return Err(too_many());
    }
    let place = |p: &DVec3| placed.transform.transform_point3(*p);
    mesh.positions.extend(geometry.positions.iter().map(place));
    if mesh.positions[shift as usize..].iter().any(|p| !p.is_finite()) {
        let found = "a transform that leaves no finite coordinates";
        return Err(Fault::new(Place::Json(format!("nodes/{}", placed.node)), found, "finite ones"));
    }
    // A mirrored mesh would be inside out.
    let mirrored = placed.transform.matrix3.determinant() < 0.0;
    let turned = |[a, b, c]: [u32; 3]| if mirrored { [a, c, b] } else { [a, b, c] };
    let first = mesh.triangles.len();
    mesh.triangles.extend(geometry.triangles.iter().map(|t| turned(t.map(|v| v + shift))));
    mesh.material_of.extend(&geometry.material_of);
    mesh.colors.extend(&geometry.colors);
    let turned = |[a, b, c]: [DVec2; 3]| if mirrored { [a, c, b] } else { [a, b, c] };
    mesh.textures.extend(geometry.textures.iter().map(|texture| texture.map(turned)));
    mesh.objects.push(MeshObject { name: placed.name.clone(), triangles: first..mesh.triangles.len() });
    Ok(())
}
