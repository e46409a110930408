//! The parts of a glTF document that say where triangles are. Unknown properties are passed over.
//!
//! Accessors and primitives are the types of the crate `gltf`. The types around them are ours, because the crate's lose what is needed here:
//! its nodes hold transforms in single precision, its materials do not tell a factor that is stated from one by default, its scenes
//! must list nodes although the specification does not ask for it, and extensions that it does not know are untyped.

use gltf::json::accessor::Accessor;
use gltf::json::mesh::Primitive;
use serde::Deserialize;

use super::super::error::{Fault, Place};

#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(super) struct Document {
    pub(super) asset: Asset,
    pub(super) extensions_required: Vec<String>,
    pub(super) scenes: Vec<Scene>,
    pub(super) nodes: Vec<Node>,
    pub(super) meshes: Vec<Mesh>,
    pub(super) materials: Vec<Material>,
    pub(super) accessors: Vec<Accessor>,
    pub(super) buffer_views: Vec<BufferView>,
    pub(super) buffers: Vec<Buffer>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Asset {
    pub(super) version: String,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Scene {
    pub(super) nodes: Vec<usize>,
}

/// Either `matrix` (by columns) or the other three, which are applied scale first.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Node {
    pub(super) name: Option<String>,
    pub(super) children: Vec<usize>,
    pub(super) mesh: Option<usize>,
    pub(super) matrix: Option<[f64; 16]>,
    pub(super) translation: Option<[f64; 3]>,
    /// A quaternion, real part last.
    pub(super) rotation: Option<[f64; 4]>,
    pub(super) scale: Option<[f64; 3]>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Mesh {
    pub(super) name: Option<String>,
    pub(super) primitives: Vec<Primitive>,
    #[serde(default)]
    pub(super) extensions: MeshExtensions,
}

#[derive(Debug, Default, Deserialize)]
pub(super) struct MeshExtensions {
    #[serde(rename = "EXT_mesh_manifold")]
    pub(super) manifold: Option<Manifold>,
}

/// `EXT_mesh_manifold`: the whole mesh once more, with vertices split only where the surface is.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Manifold {
    pub(super) manifold_primitive: Primitive,
}

#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(super) struct Material {
    pub(super) name: Option<String>,
    pub(super) pbr_metallic_roughness: PbrMetallicRoughness,
}

/// Factors that are 1 where the file says nothing.
#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(super) struct PbrMetallicRoughness {
    pub(super) base_color_factor: Option<[f32; 4]>,
    pub(super) metallic_factor: Option<f32>,
    pub(super) roughness_factor: Option<f32>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct BufferView {
    pub(super) buffer: usize,
    #[serde(default)]
    pub(super) byte_offset: usize,
    pub(super) byte_length: usize,
    pub(super) byte_stride: Option<usize>,
    #[serde(default)]
    pub(super) extensions: ViewExtensions,
}

#[derive(Debug, Default, Deserialize)]
pub(super) struct ViewExtensions {
    #[serde(rename = "EXT_meshopt_compression")]
    pub(super) packed: Option<PackedView>,
}

/// `EXT_meshopt_compression`: where the packed bytes of a view are, and how they are packed. The view's own buffer is not read.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct PackedView {
    pub(super) buffer: usize,
    #[serde(default)]
    pub(super) byte_offset: usize,
    pub(super) byte_length: usize,
    pub(super) byte_stride: usize,
    pub(super) count: usize,
    #[cfg_attr(not(feature = "meshopt"), expect(dead_code, reason = "only the decoder asks"))]
    pub(super) mode: String,
    #[cfg_attr(not(feature = "meshopt"), expect(dead_code, reason = "only the decoder asks"))]
    pub(super) filter: Option<String>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Buffer {
    pub(super) uri: Option<String>,
    #[serde(default)]
    pub(super) extensions: BufferExtensions,
}

#[derive(Debug, Default, Deserialize)]
pub(super) struct BufferExtensions {
    #[serde(rename = "EXT_meshopt_compression")]
    pub(super) packed: Option<Fallback>,
}

/// A buffer that is a fallback is for readers that do not know the extension: its views are packed elsewhere, and it may have no bytes.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Fallback {
    pub(super) fallback: bool,
}

/// Parses a document of version 2.
pub(super) fn parse(json: &[u8]) -> Result<Document, Fault> {
    let document: Document = serde_json::from_slice(json).map_err(|error| {
        // The parser's message ends with the place, which stands before it here.
        let message = error.to_string();
        let what = message.split(" at line ").next().unwrap_or(&message).escape_debug().to_string();
        Fault::new(Place::Line(error.line()), format!("JSON that is not a glTF document ({what})"), "glTF 2.0")
    })?;
    if !document.asset.version.starts_with("2.") {
        let found = format!("`{}`", document.asset.version.escape_debug());
        return Err(Fault::new(Place::Json("asset/version".to_owned()), found, "`2.0`"));
    }
    Ok(document)
}
