//! The JSON side: nodes, meshes, materials and where their arrays lie in the buffer.

use std::collections::BTreeMap;
use std::f64::consts::FRAC_1_SQRT_2;

use glam::DVec3;
use gltf_json::accessor::{ComponentType, GenericComponentType, Type};
use gltf_json::buffer::{Stride, Target, View};
use gltf_json::extensions::buffer::{Buffer as BufferExtensions, View as ViewExtensions};
use gltf_json::extensions::mesh::Mesh as MeshExtensions;
use gltf_json::material::{PbrBaseColorFactor, PbrMetallicRoughness, StrengthFactor};
use gltf_json::mesh::{Mode, Primitive, Semantic};
use gltf_json::validation::{Checked, USize64};
use gltf_json::{Accessor, Asset, Buffer, Index, Material, Mesh, Node, Root, Scene};
use planecut_csg::Material as InputMaterial;
use rustc_hash::FxHashMap;
use serde_json::{Value, json};

use super::arrays::{Arrays, bounds, sparse_merges};
use super::geometry::Geometry;
use super::group::{ALIGNED, Group};
use super::sections::Kind;
use crate::material::material_color;
use crate::{ExportError, ExportOptions, Unit};

/// Name of the extension that says that a mesh is a closed, oriented 2-manifold, and which split vertices are one.
///
/// <https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Vendor/EXT_mesh_manifold>
const MESH_MANIFOLD: &str = "EXT_mesh_manifold";

/// Names of the extensions that say that positions are on a grid, and that buffers are packed.
const QUANTIZATION: &str = "KHR_mesh_quantization";
const MESHOPT: &str = "EXT_meshopt_compression";

/// What a material is where it does not say: matt and no metal.
const METALLIC: f32 = 0.0;
const ROUGHNESS: f32 = 0.9;

/// A glTF document. The root node has index 0, the parts' nodes follow.
pub(super) struct Document {
    root: Root,
    options: ExportOptions,
    /// How long the buffer is so far.
    buffer_bytes: usize,
    /// How long it would be if nothing were packed.
    plain_bytes: usize,
    /// For each primitive of each mesh what its triangles come from.
    sources: Vec<Vec<Vec<[u32; 3]>>>,
    /// Translation and scale of each part's node, kept apart because the JSON types of the library are single precision.
    places: Vec<([f64; 3], Option<f64>)>,
    materials: FxHashMap<(String, [u32; 5]), Index<Material>>,
    has_manifolds: bool,
}

impl Document {
    /// One without meshes.
    pub(super) fn new(options: &ExportOptions) -> Self {
        let mut document = Self {
            root: new_root(),
            options: options.clone(),
            buffer_bytes: 0,
            plain_bytes: 0,
            sources: Vec::new(),
            places: Vec::new(),
            materials: FxHashMap::default(),
            has_manifolds: false,
        };
        document.root.nodes.push(node("planecut root"));
        document
    }

    /// Describes meshes, with their names, whose arrays follow in the buffer. One without triangles is none, since glTF forbids empty arrays.
    pub(super) fn push_group(&mut self, group: &mut Group<'_>, names: &[&str]) -> Vec<Option<Index<Mesh>>> {
        let arrays = Arrays { views: self.push_views(group), sections: &group.sections };
        let meshes = group.meshes.iter_mut().zip(names).enumerate();
        let described = meshes.map(|(number, (mesh, called))| {
            let is_empty = mesh.vertices.corners.is_empty();
            (!is_empty).then(|| self.push_mesh(called, number, mesh, &arrays))
        });
        described.collect()
    }

    /// Adds the node of a part, at a place.
    pub(super) fn push_node(&mut self, called: &str, mesh: Option<Index<Mesh>>, origin: DVec3, step: Option<f64>) {
        self.places.push((origin.to_array(), step));
        self.root.nodes.push(Node { mesh, ..node(called) });
    }

    /// Ends the document once everything is described.
    pub(super) fn finish(&mut self) {
        let children: Vec<_> = (1..self.root.nodes.len()).map(|child| Index::new(child as u32)).collect();
        self.root.nodes[0].children = (!children.is_empty()).then_some(children);
        let buffer = |bytes: usize| Buffer {
            byte_length: USize64::from(bytes),
            name: None,
            uri: None,
            extensions: None,
            extras: Default::default(),
        };
        if self.buffer_bytes > 0 {
            self.root.buffers.push(buffer(self.buffer_bytes));
            if self.options.meshopt {
                let fallback = BufferExtensions { others: extension(MESHOPT, json!({"fallback": true})) };
                self.root.buffers.push(Buffer { extensions: Some(fallback), ..buffer(self.plain_bytes) });
            }
        }
        self.name_extensions();
    }

    /// How long the buffer is.
    pub(super) fn buffer_bytes(&self) -> usize {
        self.buffer_bytes
    }

    /// The document as JSON bytes; `uri` is that of the buffer when it is not a GLB chunk.
    pub(super) fn to_json(&self, uri: Option<&str>) -> Result<Vec<u8>, ExportError> {
        let failed = |error: serde_json::Error| ExportError::Encode { format: "glTF", message: error.to_string() };
        let mut json = serde_json::to_value(&self.root).map_err(failed)?;
        self.shorten_factors(&mut json);
        self.name_sources(&mut json);
        // The transforms in double precision: readers that compute in it then get the exact frame.
        // A quarter turn about X takes Z-up to Y-up.
        json["nodes"][0]["rotation"] = json!([-FRAC_1_SQRT_2, 0.0, 0.0, FRAC_1_SQRT_2]);
        let scale = self.options.scale * self.options.unit.map_or(1.0, Unit::meters);
        json["nodes"][0]["scale"] = json!(vec![scale; 3]);
        for (part, (translation, step)) in self.places.iter().enumerate() {
            let node = &mut json["nodes"][part + 1];
            node["translation"] = json!(translation);
            if let Some(step) = step {
                node["scale"] = json!(vec![step; 3]);
            }
            if self.options.convex_colliders {
                node["extras"] = json!({"collider": "convex"});
            }
        }
        if let Some(uri) = uri {
            json["buffers"][0]["uri"] = uri.into();
        }
        serde_json::to_vec(&json).map_err(failed)
    }

    /// Gives the single-precision factors of materials their short decimals: 0.1, where JSON values would hold all digits of the number in double precision.
    fn shorten_factors(&self, json: &mut Value) {
        let values = json.get_mut("materials").and_then(Value::as_array_mut).into_iter().flatten();
        for (value, material) in values.zip(&self.root.materials) {
            let factors = &material.pbr_metallic_roughness;
            let value = &mut value["pbrMetallicRoughness"];
            value["baseColorFactor"] = json!(factors.base_color_factor.0.map(short));
            value["metallicFactor"] = json!(short(factors.metallic_factor.0));
            value["roughnessFactor"] = json!(short(factors.roughness_factor.0));
        }
    }

    /// Says in the extras of primitives what their triangles come from: `{"faces": [[triangles, brush, plane], …]}`.
    fn name_sources(&self, json: &mut Value) {
        let values = json.get_mut("meshes").and_then(Value::as_array_mut).into_iter().flatten();
        for (value, sources) in values.zip(&self.sources) {
            for (number, sources) in sources.iter().enumerate().filter(|(_, sources)| !sources.is_empty()) {
                value["primitives"][number]["extras"] = json!({"faces": sources});
            }
        }
    }

    /// Describes sections: in the buffer where they are, or, packed, in one that nobody sees, with where they really are beside it.
    fn push_views(&mut self, group: &Group<'_>) -> Vec<Index<View>> {
        let is_packed = !group.packed.is_empty();
        let (mut plain_end, mut packed_end) = (self.plain_bytes, self.buffer_bytes);
        let mut views = Vec::new();
        for (number, section) in group.sections.iter().enumerate() {
            let target = match section.kind {
                Kind::Indices(_) => Some(Target::ElementArrayBuffer),
                kind => kind.is_attribute().then_some(Target::ArrayBuffer),
            };
            let packed = group.packed.get(number).map(|packed| {
                let mut extension = json!({
                    "buffer": 0, "byteOffset": packed_end, "byteLength": packed.bytes.len(),
                    "byteStride": section.stride, "count": section.count(), "mode": packed.mode,
                });
                if packed_end == 0
                    && let Some(fields) = extension.as_object_mut()
                {
                    fields.remove("byteOffset");
                }
                packed_end += packed.bytes.len().next_multiple_of(ALIGNED);
                extension
            });
            views.push(View {
                buffer: Index::new(u32::from(is_packed)),
                byte_length: USize64::from(section.bytes()),
                byte_offset: Some(USize64::from(plain_end)),
                byte_stride: section.kind.is_attribute().then_some(Stride(section.stride)),
                name: None,
                target: target.map(Checked::Valid),
                extensions: packed.map(|value| ViewExtensions { others: extension(MESHOPT, value) }),
                extras: Default::default(),
            });
            plain_end += section.bytes().next_multiple_of(ALIGNED);
        }
        self.plain_bytes = plain_end;
        self.buffer_bytes += group.bytes();
        views.into_iter().map(|view| self.root.push(view)).collect()
    }

    /// Describes a mesh, which has a number.
    fn push_mesh(&mut self, called: &str, number: usize, mesh: &mut Geometry, arrays: &Arrays<'_>) -> Index<Mesh> {
        self.sources.push(mesh.runs.iter_mut().map(|run| std::mem::take(&mut run.sources)).collect());
        self.has_manifolds |= mesh.merge_count().is_some();
        let attributes = self.push_attributes(number, mesh, arrays);
        let indices = arrays.get(Kind::indices(mesh), number);
        let mut primitives = Vec::with_capacity(mesh.runs.len());
        for run in &mesh.runs {
            let indices = self.root.push(indices.part(run.corners.start, run.corners.len()));
            let material = self.material(&mesh.mesh.materials[run.material as usize]);
            primitives.push(primitive(attributes.clone(), indices, Some(material)));
        }
        let manifold = mesh.merge_count().map(|merges| {
            let positions = attributes.iter().find(|(semantic, _)| *semantic == Semantic::Positions);
            let positions: Vec<_> = positions.cloned().into_iter().collect();
            self.manifold_extension(positions, indices.whole(), merges, (number, &*mesh), arrays)
        });
        self.root.push(Mesh {
            extensions: manifold.map(|value| MeshExtensions { others: extension(MESH_MANIFOLD, value) }),
            extras: Default::default(),
            name: name(called),
            primitives,
            weights: None,
        })
    }

    fn push_attributes(
        &mut self,
        number: usize,
        mesh: &Geometry,
        arrays: &Arrays<'_>,
    ) -> Vec<(Semantic, Index<Accessor>)> {
        let kinds = [
            (Semantic::Positions, Kind::Positions, Type::Vec3),
            (Semantic::Normals, Kind::Normals, Type::Vec3),
            (Semantic::Tangents, Kind::Tangents, Type::Vec4),
            (Semantic::TexCoords(0), Kind::Texture, Type::Vec2),
            (Semantic::Colors(0), Kind::Colors, Type::Vec4),
        ];
        let quantized = self.options.quantize;
        let mut attributes = Vec::new();
        for (semantic, kind, type_) in kinds {
            let Some(array) = arrays.find(kind, number) else { continue };
            let (component, normalized) = match (kind, quantized) {
                (Kind::Positions, true) => (ComponentType::I16, false),
                (Kind::Normals | Kind::Tangents, true) => (ComponentType::I8, true),
                (Kind::Colors, true) => (ComponentType::U8, true),
                (Kind::Colors, false) => (ComponentType::U16, true),
                _ => (ComponentType::F32, false),
            };
            let mut accessor = Accessor {
                component_type: Checked::Valid(GenericComponentType(component)),
                type_: Checked::Valid(type_),
                normalized,
                ..array.whole()
            };
            if kind == Kind::Positions {
                let (min, max) = bounds(mesh);
                (accessor.min, accessor.max) = (Some(min), Some(max));
            }
            attributes.push((semantic, self.root.push(accessor)));
        }
        attributes
    }

    /// The extension object of one mesh. Its primitive reads the same indices as the visible ones, all at once, with the
    /// split vertices replaced by sparse values; the two merge accessors repeat these, as the extension demands.
    fn manifold_extension(
        &mut self,
        positions: Vec<(Semantic, Index<Accessor>)>,
        mut indices: Accessor,
        merges: usize,
        (number, mesh): (usize, &Geometry),
        arrays: &Arrays<'_>,
    ) -> Value {
        let merged = (merges > 0).then(|| {
            let places = arrays.get(Kind::merge_places(mesh), number);
            (places, arrays.get(Kind::merge_vertices(mesh), number))
        });
        indices.sparse = merged.as_ref().map(|(places, vertices)| sparse_merges(places, vertices));
        let indices = self.root.push(indices);
        let mut extension = json!({"manifoldPrimitive": primitive(positions, indices, None)});
        if let Some((places, vertices)) = merged {
            extension["mergeIndices"] = self.root.push(places.whole()).value().into();
            extension["mergeValues"] = self.root.push(vertices.whole()).value().into();
        }
        extension
    }

    /// The glTF material for one of a mesh's; meshes share those that are equal. Where vertices have the colours, it is white.
    fn material(&mut self, material: &InputMaterial) -> Index<Material> {
        let white = self.options.vertex_colors;
        let [r, g, b] = if white { [1.0; 3] } else { material_color(material) };
        let called = if white { "" } else { material.name.as_str() };
        let metallic = share(material.metallic).unwrap_or(METALLIC);
        let roughness = share(material.roughness).unwrap_or(ROUGHNESS);
        let key = (called.to_owned(), [r, g, b, metallic, roughness].map(f32::to_bits));
        *self.materials.entry(key).or_insert_with(|| {
            self.root.push(Material {
                name: name(called),
                pbr_metallic_roughness: PbrMetallicRoughness {
                    base_color_factor: PbrBaseColorFactor([r, g, b, 1.0]),
                    metallic_factor: StrengthFactor(metallic),
                    roughness_factor: StrengthFactor(roughness),
                    ..Default::default()
                },
                ..Default::default()
            })
        })
    }

    fn name_extensions(&mut self) {
        let has_meshes = self.buffer_bytes > 0;
        let mut name = |extension: &str, is_required: bool| {
            self.root.extensions_used.push(extension.to_owned());
            if is_required {
                self.root.extensions_required.push(extension.to_owned());
            }
        };
        if self.has_manifolds {
            name(MESH_MANIFOLD, false);
        }
        if self.options.quantize && has_meshes {
            name(QUANTIZATION, true);
        }
        if self.options.meshopt && has_meshes {
            name(MESHOPT, true);
        }
    }
}

/// The number whose shortest decimal in double precision is that of `factor` in single precision.
fn short(factor: f32) -> f64 {
    factor.to_string().parse().unwrap_or(f64::from(factor))
}

fn extension(name: &str, value: Value) -> serde_json::Map<String, Value> {
    serde_json::Map::from_iter([(name.to_owned(), value)])
}

/// A factor from 0 to 1; none where it is not a number.
fn share(factor: Option<f32>) -> Option<f32> {
    factor.filter(|factor| !factor.is_nan()).map(|factor| factor.clamp(0.0, 1.0))
}

fn new_root() -> Root {
    let generator = Some(concat!("planecut ", env!("CARGO_PKG_VERSION")).to_owned());
    let scene = Scene { extensions: None, extras: Default::default(), name: None, nodes: vec![Index::new(0)] };
    Root {
        asset: Asset { generator, ..Default::default() },
        scene: Some(Index::new(0)),
        scenes: vec![scene],
        ..Default::default()
    }
}

fn name(name: &str) -> Option<String> {
    (!name.is_empty()).then(|| name.to_owned())
}

fn node(called: &str) -> Node {
    Node { name: name(called), ..Default::default() }
}

fn primitive(
    attributes: Vec<(Semantic, Index<Accessor>)>,
    indices: Index<Accessor>,
    material: Option<Index<Material>>,
) -> Primitive {
    Primitive {
        attributes: BTreeMap::from_iter(attributes.into_iter().map(|(key, at)| (Checked::Valid(key), at))),
        extensions: None,
        extras: Default::default(),
        indices: Some(indices),
        material,
        mode: Checked::Valid(Mode::Triangles),
        targets: None,
    }
}
