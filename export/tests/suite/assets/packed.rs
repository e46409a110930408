//! Quantised and packed buffers.

use glam::DVec3;
use planecut_export::{ExportOptions, Format, Part, Projection, Shading, TextureMapping, encode_parts};
use planecut_import::mesh::{IndexedMesh, MeshFormat, read_mesh};
use serde_json::Value;

use super::support::written;
use planecut_testkit::meshes::{box_mesh, cube_with_hole, random_boxes};

fn quantized() -> ExportOptions {
    ExportOptions { quantize: true, ..ExportOptions::default() }
}

#[test]
fn positions_on_a_coarser_grid_stay_exact() {
    // half units up to 8191 from the middle
    let corner = DVec3::new(-8191.5, 100.0, 2.5);
    let mesh = box_mesh(corner, corner + DVec3::new(16000.0, 33.0, 0.5), "m");
    let file = written(&[Part::new("m", &mesh)], &quantized());
    for vertex in file.parts.iter().flatten().flat_map(|primitive| &primitive.vertices) {
        assert!(mesh.positions.contains(&vertex.position), "{}", vertex.position);
    }
    assert_eq!(file.json["extensionsRequired"], serde_json::json!(["KHR_mesh_quantization"]));
}

#[test]
fn other_positions_are_off_by_half_a_step_at_most() {
    let mesh = random_boxes(60, 11);
    let plain = written(&[Part::new("m", &mesh)], &ExportOptions::default());
    let file = written(&[Part::new("m", &mesh)], &quantized());
    let step = file.json["nodes"][1]["scale"][0].as_f64().expect("a step");
    assert_eq!(step.log2().fract(), 0.0, "a power of two");
    assert_eq!(file.triangles(), plain.triangles());
    for (one, other) in plain.parts.iter().flatten().zip(file.parts.iter().flatten()) {
        assert_eq!(one.triangles, other.triangles);
        for (one, other) in one.vertices.iter().zip(&other.vertices) {
            assert!((one.position - other.position).abs().max_element() <= step * 0.5 * (1.0 + 1e-6));
            assert!((one.normal - other.normal).abs().max_element() <= 0.5 / 127.0 + 1e-6);
        }
    }
}

/// The bytes of a view: those in the buffer, or what is packed there.
fn view(json: &Value, bin: &[u8], number: usize) -> Vec<u8> {
    let view = &json["bufferViews"][number];
    let number = |value: &Value| value.as_u64().unwrap_or(0) as usize;
    let packed = &view["extensions"]["EXT_meshopt_compression"];
    let place = if packed.is_null() { view } else { packed };
    let bytes = &bin[number(&place["byteOffset"])..][..number(&place["byteLength"])];
    if packed.is_null() {
        return bytes.to_vec();
    }
    assert_eq!(json["buffers"][number(&view["buffer"])]["extensions"]["EXT_meshopt_compression"]["fallback"], true);
    let (count, stride) = (number(&packed["count"]), number(&packed["byteStride"]));
    assert_eq!(count * stride, number(&view["byteLength"]));
    fn attributes<const STRIDE: usize>(bytes: &[u8], count: usize) -> Vec<u8>
    where
        [u8; STRIDE]: Default,
    {
        meshopt::decode_vertex_buffer::<[u8; STRIDE]>(bytes, count).expect("decoded").concat()
    }
    match (packed["mode"].as_str().expect("a mode"), stride) {
        ("ATTRIBUTES", 4) => attributes::<4>(bytes, count),
        ("ATTRIBUTES", 8) => attributes::<8>(bytes, count),
        ("ATTRIBUTES", 12) => attributes::<12>(bytes, count),
        ("ATTRIBUTES", 16) => attributes::<16>(bytes, count),
        ("TRIANGLES", 2) => narrow(&meshopt::decode_index_buffer::<u16>(bytes, count).expect("decoded")),
        ("TRIANGLES", 4) => wide(&meshopt::decode_index_buffer::<u32>(bytes, count).expect("decoded")),
        ("INDICES", 2) => narrow(&meshopt::decode_index_sequence::<u16>(bytes, count).expect("decoded")),
        ("INDICES", 4) => wide(&meshopt::decode_index_sequence::<u32>(bytes, count).expect("decoded")),
        other => panic!("{other:?}"),
    }
}

fn narrow(numbers: &[u16]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

fn wide(numbers: &[u32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

/// What is packed comes out as the arrays of the same file without packing, but for triangles, which may begin at another corner: then
/// the places of merged corners are others too, and are applied to both before these are compared.
#[test]
fn packed_buffers_hold_what_the_others_do() {
    let texture = Some(TextureMapping { projection: Projection::Box, size: 1.0 });
    let all = ExportOptions {
        quantize: true,
        texture,
        tangents: true,
        vertex_colors: true,
        shading: Shading::Smooth { crease: 30.0 },
        ..ExportOptions::default()
    };
    let meshes = [cube_with_hole(), random_boxes(40, 2), random_boxes(3_000, 3)];
    for options in [ExportOptions::default(), quantized(), all] {
        let parts: Vec<Part<'_>> = meshes.iter().map(|mesh| Part::new("m", mesh)).collect();
        let read = |meshopt: bool| {
            let options = ExportOptions { meshopt, ..options.clone() };
            let bytes = encode_parts(&parts, Format::Glb, &options).expect("encoded");
            let raw = gltf::Glb::from_slice(&bytes).expect("a GLB");
            let json: Value = serde_json::from_slice(&raw.json).expect("JSON");
            (bytes.len(), json, raw.bin.expect("a buffer").into_owned())
        };
        let ((plain_length, plain_json, plain_bin), (packed_length, json, bin)) = (read(false), read(true));
        assert!(packed_length < plain_length, "{packed_length} {plain_length}");
        assert_eq!(json["accessors"].as_array().map(Vec::len), plain_json["accessors"].as_array().map(Vec::len));
        let views = json["bufferViews"].as_array().expect("views").len();
        for number in 0..views {
            let (one, other) = (view(&plain_json, &plain_bin, number), view(&json, &bin, number));
            if json["bufferViews"][number]["extensions"]["EXT_meshopt_compression"]["mode"] == "ATTRIBUTES" {
                assert!(one == other, "view {number}");
            }
        }
        let manifolds = |json: &Value, bin: &[u8]| -> Vec<Vec<[u32; 3]>> {
            let meshes = json["meshes"].as_array().expect("meshes").iter();
            meshes.map(|mesh| turned(&merged(json, bin, mesh))).collect()
        };
        assert!(manifolds(&plain_json, &plain_bin) == manifolds(&json, &bin));
    }
}

/// The corners of a mesh's manifold by the rules of the extension.
fn merged(json: &Value, bin: &[u8], mesh: &Value) -> Vec<u32> {
    let number = |value: &Value| value.as_u64().unwrap_or(0) as usize;
    let numbers = |accessor: &Value| -> Vec<u32> {
        let accessor = &json["accessors"][number(accessor)];
        let bytes = view(json, bin, number(&accessor["bufferView"]));
        let width = if accessor["componentType"] == 5123 { 2 } else { 4 };
        let bytes = &bytes[number(&accessor["byteOffset"])..][..number(&accessor["count"]) * width];
        bytes.chunks(width).map(|c| c.iter().rev().fold(0, |sum, &b| sum << 8 | u32::from(b))).collect()
    };
    let extension = &mesh["extensions"]["EXT_mesh_manifold"];
    let mut corners = numbers(&extension["manifoldPrimitive"]["indices"]);
    if extension.get("mergeIndices").is_some() {
        let (places, vertices) = (numbers(&extension["mergeIndices"]), numbers(&extension["mergeValues"]));
        places.iter().zip(vertices).for_each(|(place, vertex)| corners[*place as usize] = vertex);
    }
    corners
}

/// Triangles that begin with their least corner.
fn turned(corners: &[u32]) -> Vec<[u32; 3]> {
    let (triangles, _) = corners.as_chunks::<3>();
    let turn = |mut triangle: [u32; 3]| {
        let first = (0..3).min_by_key(|k| triangle[*k]).expect("three");
        triangle.rotate_left(first);
        triangle
    };
    triangles.iter().copied().map(turn).collect()
}

/// The volume that triangles enclose.
fn volume(mesh: &IndexedMesh) -> f64 {
    let origin = mesh.positions[0];
    let corner = |v: u32| mesh.positions[v as usize] - origin;
    mesh.triangles.iter().map(|[a, b, c]| corner(*a).dot(corner(*b).cross(corner(*c)))).sum::<f64>() / 6.0
}

/// Own files come back as they were written, whether packed, on a grid, or both.
#[test]
fn own_files_are_read_again() {
    // few vertices, and more than 16 bits can number
    let meshes = [cube_with_hole(), random_boxes(40, 2), random_boxes(3_000, 3)];
    let smooth = Shading::Smooth { crease: 30.0 };
    for mesh in &meshes {
        let parts = [Part::new("m", mesh), Part::new("n", mesh)];
        let read = |format: Format, options: &ExportOptions| {
            let bytes = encode_parts(&parts, format, options).expect("encoded");
            read_mesh(&bytes, MeshFormat::Gltf, "file").expect("read")
        };
        for shading in [Shading::Flat, smooth] {
            let plain_options = ExportOptions { shading, ..ExportOptions::default() };
            let plain = read(Format::Glb, &plain_options);
            let packed = ExportOptions { meshopt: true, ..plain_options.clone() };
            for format in [Format::Glb, Format::Gltf] {
                let again = read(format, &packed);
                assert_eq!(again.triangles.len(), plain.triangles.len());
                assert!((volume(&again) - volume(&plain)).abs() <= 1e-12 * volume(&plain));
            }
            let on_grid = ExportOptions { quantize: true, ..plain_options.clone() };
            let both = ExportOptions { meshopt: true, ..on_grid.clone() };
            let (on_grid, both) = (read(Format::Glb, &on_grid), read(Format::Gltf, &both));
            assert_eq!(both.triangles.len(), on_grid.triangles.len());
            assert!((volume(&both) - volume(&on_grid)).abs() <= 1e-12 * volume(&on_grid));
            // all corners are moved by half a step at most: the volume changes by that much times the surface
            let far = plain.positions.iter().fold(DVec3::ZERO, |far, p| far.max((*p - plain.positions[0]).abs()));
            let step = (far.max_element() / f64::from(i16::MAX)).log2().ceil().exp2();
            let area = |[a, b, c]: &[u32; 3]| {
                let [a, b, c] = [a, b, c].map(|v| plain.positions[*v as usize]);
                (b - a).cross(c - a).length() / 2.0
            };
            let bound = step * plain.triangles.iter().map(area).sum::<f64>();
            let off = (volume(&both) - volume(&plain)).abs();
            assert!(off <= bound, "{off} {bound}");
        }
    }
}
