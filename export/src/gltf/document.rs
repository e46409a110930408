//! The JSON side: nodes, meshes, materials and where their arrays lie in the buffer.

use std::collections::BTreeMap;
use std::f64::consts::FRAC_1_SQRT_2;
use std::io::{self, Write};

use gltf_json::accessor::{ComponentType, GenericComponentType, IndexComponentType, Type, sparse};
use gltf_json::buffer::{Stride, Target, View};
use gltf_json::extensions::buffer::{Buffer as BufferExtensions, View as ViewExtensions};
use gltf_json::extensions::mesh::Mesh as MeshExtensions;
use gltf_json::material::{PbrBaseColorFactor, PbrMetallicRoughness, StrengthFactor};
use gltf_json::mesh::{Mode, Primitive, Semantic};
use gltf_json::validation::{Checked, USize64};
use gltf_json::{Accessor, Asset, Buffer, Index, Material, Mesh, Node, Root, Scene};
use planecut_csg::Material as InputMaterial;
use planecut_parallel::prelude::*;
use rustc_hash::FxHashMap;
use serde::Serialize;
use serde_json::{Value, json};

use super::geometry::Geometry;
use super::packed::Packed;
use super::repeats::Repeats;
use super::sections::{Kind, Section, Width};
use crate::material::material_color;
use crate::{ExportError, ExportOptions, Part, Unit};

/// Name of the extension that says that a mesh is a closed, oriented 2-manifold, and which split vertices are one.
///
/// <https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Vendor/EXT_mesh_manifold>
const MESH_MANIFOLD: &str = "EXT_mesh_manifold";

/// Names of the extensions that say that positions are on a grid, and that buffers are packed.
const QUANTIZATION: &str = "KHR_mesh_quantization";
const MESHOPT: &str = "EXT_meshopt_compression";

/// Alignment of arrays in bytes: no component is larger.
const ALIGNED: usize = 4;

/// What a material is where it does not say: matt and no metal.
const METALLIC: f32 = 0.0;
const ROUGHNESS: f32 = 0.9;

/// A glTF document and the arrays that it describes. The root node has index 0, the parts' nodes follow.
pub(super) struct Document<'a> {
    root: Root,
    options: ExportOptions,
    meshes: Vec<Geometry<'a>>,
    sections: Vec<Section>,
    /// For each section its packed form, where packing is asked for.
    packed: Vec<Packed>,
    /// Translation and scale of each part's node, kept apart because the JSON types of the library are single precision.
    places: Vec<([f64; 3], Option<f64>)>,
    materials: FxHashMap<(String, [u32; 5]), Index<Material>>,
}

impl<'a> Document<'a> {
    /// Describes `parts`. A part without triangles becomes a node without a mesh, since glTF forbids empty arrays; parts that are alike
    /// share a mesh.
    pub(super) fn build(parts: &[Part<'a>], options: &ExportOptions) -> Result<Self, ExportError> {
        let repeats = Repeats::of(parts, options);
        let firsts: Vec<&Part<'a>> = repeats.firsts().iter().map(|part| &parts[*part]).collect();
        let mut meshes: Vec<Geometry<'a>> =
            firsts.par_iter().map(|part| Geometry::new(part, options)).collect::<Result<_, _>>()?;
        if options.meshopt {
            Packed::turn_triangles(&mut meshes)?;
        }
        meshes.par_iter_mut().for_each(Geometry::find_merges);
        let sections = Section::of(&meshes, options.quantize);
        let packed = if options.meshopt {
            sections.par_iter().map(|section| Packed::of(section, &meshes)).collect::<Result<_, _>>()?
        } else {
            Vec::new()
        };
        let mut document = Self {
            root: new_root(),
            options: options.clone(),
            meshes: Vec::new(),
            sections,
            packed,
            places: Vec::new(),
            materials: FxHashMap::default(),
        };
        let views = document.push_views();
        document.root.nodes.push(node("planecut root"));
        let described: Vec<Option<Index<Mesh>>> = (0..meshes.len())
            .map(|number| {
                let is_empty = meshes[number].vertices.corners.is_empty();
                (!is_empty).then(|| document.push_mesh(firsts[number].name, number, &meshes[number], &views))
            })
            .collect();
        for (part, repeat) in parts.iter().zip(repeats.iter()) {
            let mesh = &meshes[repeat.first];
            let node = Node { mesh: described[repeat.first], ..node(part.name) };
            document.places.push(((mesh.rounding.origin + repeat.moved).to_array(), mesh.rounding.step));
            document.root.nodes.push(node);
        }
        let children: Vec<_> = (1..document.root.nodes.len()).map(|child| Index::new(child as u32)).collect();
        document.root.nodes[0].children = (!children.is_empty()).then_some(children);
        document.meshes = meshes;
        document.name_extensions();
        Ok(document)
    }

    /// How long the buffer is.
    pub(super) fn buffer_bytes(&self) -> usize {
        let long = |(number, section): (usize, &Section)| match self.packed.get(number) {
            Some(packed) => packed.bytes.len(),
            None => section.bytes(),
        };
        self.sections.iter().enumerate().map(|section| long(section).next_multiple_of(ALIGNED)).sum()
    }

    /// Writes the buffer.
    pub(super) fn write_buffer(&self, out: &mut dyn Write) -> io::Result<()> {
        for (number, section) in self.sections.iter().enumerate() {
            let long = match self.packed.get(number) {
                Some(packed) => {
                    out.write_all(&packed.bytes)?;
                    packed.bytes.len()
                }
                None => {
                    section.write(&self.meshes, out)?;
                    section.bytes()
                }
            };
            out.write_all(&[0; ALIGNED][..long.next_multiple_of(ALIGNED) - long])?;
        }
        Ok(())
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
        let described = self.meshes.iter().filter(|mesh| !mesh.vertices.corners.is_empty());
        for (value, mesh) in values.zip(described) {
            for (number, run) in mesh.runs.iter().enumerate().filter(|(_, run)| !run.sources.is_empty()) {
                value["primitives"][number]["extras"] = json!({"faces": run.sources});
            }
        }
    }

    /// Describes sections: in the buffer where they are, or, packed, in one that nobody sees, with where they really are beside it.
    fn push_views(&mut self) -> Vec<Index<View>> {
        let is_packed = !self.packed.is_empty();
        let (mut plain_end, mut packed_end) = (0, 0);
        let mut views = Vec::new();
        for (number, section) in self.sections.iter().enumerate() {
            let target = match section.kind {
                Kind::Indices(_) => Some(Target::ElementArrayBuffer),
                kind => kind.is_attribute().then_some(Target::ArrayBuffer),
            };
            let packed = self.packed.get(number).map(|packed| {
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
        if self.sections.is_empty() {
            return Vec::new();
        }
        let buffer = |bytes: usize| Buffer {
            byte_length: USize64::from(bytes),
            name: None,
            uri: None,
            extensions: None,
            extras: Default::default(),
        };
        self.root.buffers.push(buffer(self.buffer_bytes()));
        if is_packed {
            let fallback = BufferExtensions { others: extension(MESHOPT, json!({"fallback": true})) };
            self.root.buffers.push(Buffer { extensions: Some(fallback), ..buffer(plain_end) });
        }
        views.into_iter().map(|view| self.root.push(view)).collect()
    }

    /// Describes a mesh, which has a number.
    fn push_mesh(&mut self, called: &str, number: usize, mesh: &Geometry, views: &[Index<View>]) -> Index<Mesh> {
        let attributes = self.push_attributes(number, mesh, views);
        let indices = self.array(Kind::indices(mesh), number, views);
        let mut primitives = Vec::with_capacity(mesh.runs.len());
        for run in &mesh.runs {
            let indices = self.root.push(indices.part(run.corners.start, run.corners.len()));
            let material = self.material(&mesh.mesh.materials[run.material as usize]);
            primitives.push(primitive(attributes.clone(), indices, Some(material)));
        }
        let manifold = mesh.merge_count().map(|merges| {
            let positions = attributes.iter().find(|(semantic, _)| *semantic == Semantic::Positions);
            let positions: Vec<_> = positions.cloned().into_iter().collect();
            self.manifold_extension(positions, indices.whole(), merges, (number, mesh), views)
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
        views: &[Index<View>],
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
            let Some(array) = self.find_array(kind, number, views) else { continue };
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

    /// The array of a mesh; an empty one where it has none.
    fn array(&self, kind: Kind, mesh: usize, views: &[Index<View>]) -> Array {
        let nothing = Array { view: Index::new(0), start: 0, count: 0, stride: 1, component: ComponentType::U16 };
        self.find_array(kind, mesh, views).unwrap_or(nothing)
    }

    fn find_array(&self, kind: Kind, mesh: usize, views: &[Index<View>]) -> Option<Array> {
        let place = self.sections.iter().position(|section| section.kind == kind)?;
        let section = &self.sections[place];
        let (start, end) = (section.starts[mesh], section.starts[mesh + 1]);
        let component = match kind {
            Kind::Indices(Width::U16) | Kind::MergePlaces(Width::U16) | Kind::MergeVertices(Width::U16) => {
                ComponentType::U16
            }
            _ => ComponentType::U32,
        };
        (end > start).then(|| Array {
            view: views[place],
            start,
            count: end - start,
            stride: section.stride,
            component,
        })
    }

    /// The extension object of one mesh. Its primitive reads the same indices as the visible ones, all at once, with the
    /// split vertices replaced by sparse values; the two merge accessors repeat these, as the extension demands.
    fn manifold_extension(
        &mut self,
        positions: Vec<(Semantic, Index<Accessor>)>,
        mut indices: Accessor,
        merges: usize,
        (number, mesh): (usize, &Geometry),
        views: &[Index<View>],
    ) -> Value {
        let merged = (merges > 0).then(|| {
            let places = self.array(Kind::merge_places(mesh), number, views);
            (places, self.array(Kind::merge_vertices(mesh), number, views))
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
        let has_meshes = !self.sections.is_empty();
        let mut name = |extension: &str, is_required: bool| {
            self.root.extensions_used.push(extension.to_owned());
            if is_required {
                self.root.extensions_required.push(extension.to_owned());
            }
        };
        if self.meshes.iter().any(|mesh| !mesh.vertices.corners.is_empty() && mesh.merge_count().is_some()) {
            name(MESH_MANIFOLD, false);
        }
        if self.options.quantize && has_meshes {
            name(QUANTIZATION, true);
        }
        if !self.packed.is_empty() {
            name(MESHOPT, true);
        }
    }
}

/// An array within a view.
struct Array {
    view: Index<View>,
    /// Its first element.
    start: usize,
    count: usize,
    /// Bytes of an element.
    stride: usize,
    component: ComponentType,
}

impl Array {
    /// All of it, as scalars.
    fn whole(&self) -> Accessor {
        self.part(0, self.count)
    }

    /// Some of its elements, as scalars.
    fn part(&self, start: usize, count: usize) -> Accessor {
        Accessor {
            buffer_view: Some(self.view),
            byte_offset: Some(self.offset(start)),
            count: USize64::from(count),
            component_type: Checked::Valid(GenericComponentType(self.component)),
            extensions: None,
            extras: Default::default(),
            type_: Checked::Valid(Type::Scalar),
            min: None,
            max: None,
            name: None,
            normalized: false,
            sparse: None,
        }
    }

    /// Where an element lies in the view.
    fn offset(&self, element: usize) -> USize64 {
        USize64::from((self.start + element) * self.stride)
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

fn sparse_merges(places: &Array, vertices: &Array) -> sparse::Sparse {
    sparse::Sparse {
        count: USize64::from(places.count),
        indices: sparse::Indices {
            buffer_view: places.view,
            byte_offset: places.offset(0),
            component_type: Checked::Valid(IndexComponentType(places.component)),
            extensions: None,
            extras: Default::default(),
        },
        values: sparse::Values {
            buffer_view: vertices.view,
            byte_offset: vertices.offset(0),
            extensions: None,
            extras: Default::default(),
        },
        extensions: None,
        extras: Default::default(),
    }
}

/// The least and greatest coordinates as they are stored.
fn bounds(mesh: &Geometry) -> (Value, Value) {
    fn of<T: Copy + PartialOrd + Serialize>(positions: impl Iterator<Item = [T; 3]>) -> (Value, Value) {
        let wider = |(min, max): ([T; 3], [T; 3]), position: [T; 3]| {
            let pick = |other: [T; 3], is_better: fn(&T, &T) -> bool| {
                std::array::from_fn(|k| if is_better(&position[k], &other[k]) { position[k] } else { other[k] })
            };
            (pick(min, T::lt), pick(max, T::gt))
        };
        let bounds =
            positions.fold(None, |bounds, position| Some(wider(bounds.unwrap_or((position, position)), position)));
        bounds.map_or((Value::Null, Value::Null), |(min, max)| (json!(min), json!(max)))
    }
    let vertices = 0..mesh.vertices.origins.len();
    match mesh.rounding.step {
        Some(step) => of(vertices.map(|vertex| mesh.grid_position(vertex, step))),
        None => {
            let (min, max) = of(vertices.map(|vertex| mesh.position(vertex)));
            (as_parsed(min), as_parsed(max))
        }
    }
}

/// Single-precision numbers, which JSON values hold in double precision, as the JSON library parses their decimals: up to one unit in the last
/// place off, and so still the same in single precision. Files have had these digits from the beginning; they stay comparable byte by byte.
fn as_parsed(bounds: Value) -> Value {
    let parsed = |value: &Value| serde_json::from_str(&value.to_string()).unwrap_or_else(|_| value.clone());
    match bounds {
        Value::Array(numbers) => numbers.iter().map(parsed).collect(),
        other => other,
    }
}
