//! Reading glTF again with another's reader.

use glam::{DMat4, DQuat, DVec2, DVec3, DVec4};
use gltf::Gltf;
use planecut_export::{ExportOptions, Format, Part, encode_parts};
use serde_json::Value;

/// A vertex as a reader sees it, Z-up and in the units of the input.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Vertex {
    pub(crate) position: DVec3,
    pub(crate) normal: DVec3,
    pub(crate) texture: Option<DVec2>,
    pub(crate) tangent: Option<DVec4>,
    pub(crate) color: Option<DVec4>,
}

/// A primitive of a node.
pub(crate) struct Primitive {
    pub(crate) vertices: Vec<Vertex>,
    pub(crate) triangles: Vec<[u32; 3]>,
    pub(crate) material: Option<String>,
    pub(crate) extras: Value,
}

impl Primitive {
    pub(crate) fn corners(&self, triangle: [u32; 3]) -> [Vertex; 3] {
        triangle.map(|corner| self.vertices[corner as usize])
    }
}

/// A file with its JSON, and the primitives of each part's node.
pub(crate) struct File {
    pub(crate) json: Value,
    pub(crate) parts: Vec<Vec<Primitive>>,
}

impl File {
    pub(crate) fn triangles(&self) -> usize {
        self.parts.iter().flatten().map(|primitive| primitive.triangles.len()).sum()
    }
}

/// Writes parts as GLB and reads them again.
pub(crate) fn written(parts: &[Part<'_>], options: &ExportOptions) -> File {
    let bytes = encode_parts(parts, Format::Glb, options).expect("encoded");
    assert_eq!(bytes, encode_parts(parts, Format::Glb, options).expect("encoded"), "two runs differ");
    let raw = gltf::Glb::from_slice(&bytes).expect("a GLB");
    let json: Value = serde_json::from_slice(&raw.json).expect("JSON");
    // the reader knows no quantised positions: it is told that it need not
    let mut plain = json.clone();
    plain.as_object_mut().expect("an object").remove("extensionsRequired");
    let text = serde_json::to_vec(&plain).expect("JSON");
    let Gltf { document, .. } = Gltf::from_slice_without_validation(&text).expect("glTF");
    let bin = raw.bin.unwrap_or_default();
    let root = document.scenes().next().expect("a scene").nodes().next().expect("a root");
    let z_up = |node: usize| transform(&json, node);
    let parts = root.children().map(|node| {
        let matrix = z_up(node.index());
        let primitives = node.mesh().into_iter().flat_map(|mesh| mesh.primitives().collect::<Vec<_>>());
        primitives.map(|primitive| read(&json, &bin, &primitive, matrix)).collect()
    });
    File { parts: parts.collect(), json }
}

/// The transform of a node alone: without the root's, lengths and axes are those of the input.
fn transform(json: &Value, node: usize) -> DMat4 {
    let numbers = |key: &str| -> Option<Vec<f64>> {
        Some(json["nodes"][node].get(key)?.as_array()?.iter().map(|v| v.as_f64().expect("a number")).collect())
    };
    let vector = |key: &str, default: DVec3| numbers(key).map_or(default, |v| DVec3::from_slice(&v));
    DMat4::from_scale_rotation_translation(
        vector("scale", DVec3::ONE),
        DQuat::IDENTITY,
        vector("translation", DVec3::ZERO),
    )
}

fn read(json: &Value, bin: &[u8], primitive: &gltf::Primitive<'_>, matrix: DMat4) -> Primitive {
    let reader = primitive.reader(|_| Some(bin));
    let accessor = |name: &str| {
        primitive.attributes().find(|(semantic, _)| semantic.to_string() == name).map(|(_, accessor)| accessor)
    };
    let numbers = |name: &str| accessor(name).map(|accessor| numbers(json, bin, accessor.index()));
    let positions = numbers("POSITION").expect("positions");
    let [normals, textures, tangents, colors] = ["NORMAL", "TEXCOORD_0", "TANGENT", "COLOR_0"].map(numbers);
    let normals = normals.expect("normals");
    let wide = |values: &Option<Vec<Vec<f64>>>, k: usize| values.as_ref().map(|values| DVec4::from_slice(&values[k]));
    let vertices = (0..positions.len()).map(|k| Vertex {
        position: matrix.transform_point3(DVec3::from_slice(&positions[k])),
        normal: DVec3::from_slice(&normals[k]),
        texture: textures.as_ref().map(|textures| DVec2::from_slice(&textures[k])),
        tangent: wide(&tangents, k),
        color: wide(&colors, k),
    });
    let indices: Vec<u32> = reader.read_indices().expect("indices").into_u32().collect();
    let (triangles, _) = indices.as_chunks::<3>();
    let extras = &json["meshes"];
    let mesh = extras.as_array().into_iter().flatten().find_map(|mesh| {
        let found = mesh["primitives"].as_array()?.iter().find(|other| {
            other["indices"] == primitive.indices().map_or(Value::Null, |indices| indices.index().into())
        })?;
        Some(found["extras"].clone())
    });
    Primitive {
        vertices: vertices.collect(),
        triangles: triangles.to_vec(),
        material: primitive.material().name().map(str::to_owned),
        extras: mesh.unwrap_or(Value::Null),
    }
}

/// The values of an accessor by the rules of glTF, `KHR_mesh_quantization` included.
fn numbers(json: &Value, bin: &[u8], accessor: usize) -> Vec<Vec<f64>> {
    let accessor = &json["accessors"][accessor];
    let number = |value: &Value| value.as_u64().unwrap_or(0) as usize;
    let view = &json["bufferViews"][number(&accessor["bufferView"])];
    let start = number(&view["byteOffset"]) + number(&accessor["byteOffset"]);
    let width = match accessor["type"].as_str().expect("a type") {
        "VEC2" => 2,
        "VEC3" => 3,
        "VEC4" => 4,
        other => panic!("{other}"),
    };
    let normalized = accessor["normalized"] == Value::Bool(true);
    let share = |value: f64, most: f64| if normalized { (value / most).max(-1.0) } else { value };
    let stride = number(&view["byteStride"]);
    (0..number(&accessor["count"]))
        .map(|element| {
            let at = |k: usize, bytes: usize| &bin[start + element * stride + k * bytes..][..bytes];
            let value = |k: usize| match number(&accessor["componentType"]) {
                5120 => share(f64::from(at(k, 1)[0] as i8), 127.0),
                5121 => share(f64::from(at(k, 1)[0]), 255.0),
                5122 => share(f64::from(i16::from_le_bytes(at(k, 2).try_into().expect("two"))), 32767.0),
                5123 => share(f64::from(u16::from_le_bytes(at(k, 2).try_into().expect("two"))), 65535.0),
                5126 => f64::from(f32::from_le_bytes(at(k, 4).try_into().expect("four"))),
                other => panic!("component {other}"),
            };
            (0..width).map(value).collect()
        })
        .collect()
}
