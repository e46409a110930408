//! The JSON side: nodes, meshes, materials and where their arrays lie in the buffer.

use std::collections::BTreeMap;
use std::f64::consts::FRAC_1_SQRT_2;

use gltf_json::accessor::{ComponentType, GenericComponentType, IndexComponentType, Type, sparse};
use gltf_json::buffer::{Stride, Target, View};
use gltf_json::extensions::mesh::Mesh as MeshExtensions;
use gltf_json::material::{PbrBaseColorFactor, PbrMetallicRoughness, StrengthFactor};
use gltf_json::mesh::{Mode, Primitive, Semantic};
use gltf_json::validation::{Checked, USize64};
use gltf_json::{Accessor, Asset, Buffer, Index, Material, Mesh, Node, Root, Scene};
use planecut_csg::{MaterialId, Mesh as InputMesh};
use rustc_hash::FxHashMap;
use serde_json::{Value, json};

use super::buffer::{IndexWidth, Offsets, Sections};
use super::geometry::Geometry;
use crate::color::material_color;
use crate::{ExportError, ExportOptions, Part};

/// Name of the extension that says that a mesh is a closed, oriented 2-manifold, and which split vertices are one.
///
/// <https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Vendor/EXT_mesh_manifold>
const MESH_MANIFOLD: &str = "EXT_mesh_manifold";

/// What a material is where it does not say: matt and no metal.
const METALLIC: f32 = 0.0;
const ROUGHNESS: f32 = 0.9;

/// A glTF document under construction. The root node has index 0, the parts' nodes follow.
pub(super) struct Document {
    root: Root,
    /// Translation of each part's node, kept apart because the JSON types of the library are single precision.
    translations: Vec<[f64; 3]>,
    materials: FxHashMap<(String, [u32; 5]), Index<Material>>,
}

/// The views that the accessors of a mesh look through.
struct Views {
    positions: Index<View>,
    normals: Index<View>,
    indices: Index<View>,
    /// Places and vertices to merge; none when no mesh has any.
    merges: Option<(Index<View>, Index<View>)>,
    vertex_width: IndexWidth,
    place_width: IndexWidth,
}

impl Document {
    /// Describes `parts`, and packs their arrays into the buffer that is returned beside. A part without triangles becomes
    /// a node without a mesh, since glTF forbids empty arrays.
    pub(super) fn build(parts: &[Part<'_>]) -> Result<(Self, Vec<u8>), ExportError> {
        let meshes = parts.iter().map(|part| Geometry::new(part.mesh)).collect::<Result<Vec<_>, _>>()?;
        let mut sections = Sections::for_meshes(&meshes);
        let offsets: Vec<Offsets> = meshes.iter().map(|mesh| sections.push(mesh)).collect();
        let mut document = Self { root: new_root(), translations: Vec::new(), materials: FxHashMap::default() };
        let mut bin = Vec::new();
        let views = (!sections.indices.is_empty()).then(|| document.push_views(&sections, &mut bin));
        drop(sections);
        document.root.nodes.push(node("planecut root"));
        for ((part, mesh), offsets) in parts.iter().zip(&meshes).zip(&offsets) {
            let mut node = node(part.name);
            if let Some(views) = views.as_ref().filter(|_| !mesh.indices.is_empty()) {
                node.mesh = Some(document.push_mesh(part, mesh, views, offsets));
            }
            document.translations.push(mesh.origin.to_array());
            document.root.nodes.push(node);
        }
        let children: Vec<_> = (1..document.root.nodes.len()).map(|child| Index::new(child as u32)).collect();
        document.root.nodes[0].children = (!children.is_empty()).then_some(children);
        Ok((document, bin))
    }

    /// The document as JSON bytes; `uri` is that of the buffer when it is not a GLB chunk.
    pub(super) fn to_json(&self, options: &ExportOptions, uri: Option<String>) -> Result<Vec<u8>, ExportError> {
        let failed = |error: serde_json::Error| ExportError::Encode { format: "glTF", message: error.to_string() };
        // Through text, so that single-precision numbers keep their short decimals.
        let text = serde_json::to_vec(&self.root).map_err(failed)?;
        let mut json: Value = serde_json::from_slice(&text).map_err(failed)?;
        // The transforms in double precision: readers that compute in it then get the exact frame.
        // A quarter turn about X takes Z-up to Y-up.
        json["nodes"][0]["rotation"] = json!([-FRAC_1_SQRT_2, 0.0, 0.0, FRAC_1_SQRT_2]);
        json["nodes"][0]["scale"] = json!(vec![options.scale; 3]);
        for (part, translation) in self.translations.iter().enumerate() {
            json["nodes"][part + 1]["translation"] = json!(translation);
            if options.convex_colliders {
                json["nodes"][part + 1]["extras"] = json!({"collider": "convex"});
            }
        }
        if let Some(uri) = uri {
            json["buffers"][0]["uri"] = uri.into();
        }
        serde_json::to_vec(&json).map_err(failed)
    }

    fn push_views(&mut self, sections: &Sections, bin: &mut Vec<u8>) -> Views {
        let mut push = |bytes: &[u8], stride, target| {
            // Accessors must start at multiples of their component's size; 4 fits all.
            bin.resize(bin.len().next_multiple_of(4), 0);
            let view = View {
                buffer: Index::new(0),
                byte_length: USize64::from(bytes.len()),
                byte_offset: Some(USize64::from(bin.len())),
                byte_stride: stride,
                name: None,
                target,
                extensions: None,
                extras: None,
            };
            bin.extend_from_slice(bytes);
            self.root.push(view)
        };
        let vertices = Some(Checked::Valid(Target::ArrayBuffer));
        let positions = push(&sections.positions, Some(Stride(12)), vertices);
        let normals = push(&sections.normals, Some(Stride(12)), vertices);
        let indices = push(&sections.indices, None, Some(Checked::Valid(Target::ElementArrayBuffer)));
        let merges = (!sections.merge_places.is_empty())
            .then(|| (push(&sections.merge_places, None, None), push(&sections.merge_vertices, None, None)));
        // A GLB chunk ends at a multiple of four, and so may the buffer in it.
        bin.resize(bin.len().next_multiple_of(4), 0);
        self.root.buffers.push(Buffer {
            byte_length: USize64::from(bin.len()),
            name: None,
            uri: None,
            extensions: None,
            extras: None,
        });
        let (vertex_width, place_width) = (sections.vertex_width, sections.place_width);
        Views { positions, normals, indices, merges, vertex_width, place_width }
    }

    fn push_mesh(&mut self, part: &Part<'_>, mesh: &Geometry, views: &Views, offsets: &Offsets) -> Index<Mesh> {
        let vertices = mesh.positions.len();
        let (min, max) = bounds(&mesh.positions);
        let mut positions = vectors(views.positions, offsets.positions, vertices);
        (positions.min, positions.max) = (Some(json!(min)), Some(json!(max)));
        let positions = self.root.push(positions);
        let normals = self.root.push(vectors(views.normals, offsets.normals, vertices));
        let mut primitives = Vec::with_capacity(mesh.runs.len());
        for (material, run) in &mesh.runs {
            let offset = offsets.indices + views.vertex_width.bytes() * run.start;
            let indices = self.root.push(scalars(views.indices, offset, run.len(), views.vertex_width));
            let attributes = [(Semantic::Positions, positions), (Semantic::Normals, normals)];
            let material = self.material(part.mesh, *material);
            primitives.push(primitive(&attributes, indices, Some(material)));
        }
        let manifold = mesh.merges.as_ref().map(|merges| {
            let all = scalars(views.indices, offsets.indices, mesh.indices.len(), views.vertex_width);
            self.manifold_extension(positions, all, merges.len(), views, offsets)
        });
        self.root.push(Mesh {
            extensions: manifold.map(|value| MeshExtensions {
                others: serde_json::Map::from_iter([(MESH_MANIFOLD.to_owned(), value)]),
            }),
            extras: None,
            name: name(part.name),
            primitives,
            weights: None,
        })
    }

    /// The extension object of one mesh. Its primitive reads the same indices as the visible ones, all at once, with the
    /// split vertices replaced by sparse values; the two merge accessors repeat these, as the extension demands.
    fn manifold_extension(
        &mut self,
        positions: Index<Accessor>,
        mut indices: Accessor,
        merges: usize,
        views: &Views,
        offsets: &Offsets,
    ) -> Value {
        if self.root.extensions_used.is_empty() {
            self.root.extensions_used.push(MESH_MANIFOLD.to_owned());
        }
        let merge_views = views.merges.filter(|_| merges > 0);
        indices.sparse = merge_views.map(|views_| sparse_merges(views_, merges, views, offsets));
        let indices = self.root.push(indices);
        let mut extension = json!({"manifoldPrimitive": primitive(&[(Semantic::Positions, positions)], indices, None)});
        if let Some((places, vertices)) = merge_views {
            let places = scalars(places, offsets.merge_places, merges, views.place_width);
            let vertices = scalars(vertices, offsets.merge_vertices, merges, views.vertex_width);
            extension["mergeIndices"] = self.root.push(places).value().into();
            extension["mergeValues"] = self.root.push(vertices).value().into();
        }
        extension
    }

    /// The glTF material for one of the mesh's; parts share those that are equal.
    fn material(&mut self, mesh: &InputMesh, id: MaterialId) -> Index<Material> {
        let material = &mesh.materials[id.0 as usize];
        let [r, g, b] = material_color(material);
        let metallic = share(material.metallic).unwrap_or(METALLIC);
        let roughness = share(material.roughness).unwrap_or(ROUGHNESS);
        let key = (material.name.clone(), [r, g, b, metallic, roughness].map(f32::to_bits));
        *self.materials.entry(key).or_insert_with(|| {
            self.root.push(Material {
                name: name(&material.name),
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
}

/// A factor from 0 to 1; none where it is not a number.
fn share(factor: Option<f32>) -> Option<f32> {
    factor.filter(|factor| !factor.is_nan()).map(|factor| factor.clamp(0.0, 1.0))
}

fn new_root() -> Root {
    let generator = Some(concat!("planecut ", env!("CARGO_PKG_VERSION")).to_owned());
    let scene = Scene { extensions: None, extras: None, name: None, nodes: vec![Index::new(0)] };
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
    attributes: &[(Semantic, Index<Accessor>)],
    indices: Index<Accessor>,
    material: Option<Index<Material>>,
) -> Primitive {
    Primitive {
        attributes: BTreeMap::from_iter(attributes.iter().map(|(key, at)| (Checked::Valid(key.clone()), *at))),
        extensions: None,
        extras: None,
        indices: Some(indices),
        material,
        mode: Checked::Valid(Mode::Triangles),
        targets: None,
    }
}

fn accessor(view: Index<View>, offset: usize, count: usize, component: ComponentType, type_: Type) -> Accessor {
    Accessor {
        buffer_view: Some(view),
        byte_offset: Some(USize64::from(offset)),
        count: USize64::from(count),
        component_type: Checked::Valid(GenericComponentType(component)),
        extensions: None,
        extras: None,
        type_: Checked::Valid(type_),
        min: None,
        max: None,
        name: None,
        normalized: false,
        sparse: None,
    }
}

fn vectors(view: Index<View>, offset: usize, count: usize) -> Accessor {
    accessor(view, offset, count, ComponentType::F32, Type::Vec3)
}

fn scalars(view: Index<View>, offset: usize, count: usize, width: IndexWidth) -> Accessor {
    accessor(view, offset, count, component(width), Type::Scalar)
}

fn component(width: IndexWidth) -> ComponentType {
    match width {
        IndexWidth::U16 => ComponentType::U16,
        IndexWidth::U32 => ComponentType::U32,
    }
}

fn sparse_merges(
    (places, vertices): (Index<View>, Index<View>),
    count: usize,
    views: &Views,
    offsets: &Offsets,
) -> sparse::Sparse {
    sparse::Sparse {
        count: USize64::from(count),
        indices: sparse::Indices {
            buffer_view: places,
            byte_offset: USize64::from(offsets.merge_places),
            component_type: Checked::Valid(IndexComponentType(component(views.place_width))),
            extensions: None,
            extras: None,
        },
        values: sparse::Values {
            buffer_view: vertices,
            byte_offset: USize64::from(offsets.merge_vertices),
            extensions: None,
            extras: None,
        },
        extensions: None,
        extras: None,
    }
}

fn bounds(positions: &[[f32; 3]]) -> ([f32; 3], [f32; 3]) {
    let start = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    positions.iter().fold(start, |(min, max), position| {
        let axis = |i: usize| position[i];
        (std::array::from_fn(|i| min[i].min(axis(i))), std::array::from_fn(|i| max[i].max(axis(i))))
    })
}
