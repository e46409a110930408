//! glTF files are read again with an independent reader and compared with the mesh.

use std::collections::BTreeMap;

use glam::{DMat4, DQuat, DVec3};
use gltf::Gltf;
use gltf::mesh::util::ReadIndices;
use planecut_csg::Mesh;
use planecut_export::{ExportOptions, Format, Part, encode, encode_parts};
use planecut_testkit::meshes;

/// What a reader sees of one mesh node, in the coordinates of the scene.
struct Seen {
    triangles: Vec<[DVec3; 3]>,
    normals: Vec<[DVec3; 3]>,
    materials: Vec<String>,
}

/// World transform of a node, from its decimals: the reader's own types are single precision.
fn transform(json: &serde_json::Value, node: usize) -> DMat4 {
    let node = &json["nodes"][node];
    let numbers = |key: &str| -> Option<Vec<f64>> {
        Some(node.get(key)?.as_array()?.iter().map(|v| v.as_f64().expect("a number")).collect())
    };
    let vector = |key: &str, default: DVec3| numbers(key).map_or(default, |v| DVec3::from_slice(&v));
    let rotation = numbers("rotation").map_or(DQuat::IDENTITY, |v| DQuat::from_slice(&v));
    DMat4::from_scale_rotation_translation(vector("scale", DVec3::ONE), rotation, vector("translation", DVec3::ZERO))
}

fn read(glb: &[u8]) -> Vec<Seen> {
    let Gltf { document, blob } = Gltf::from_slice(glb).expect("passes the reader's full validation");
    let raw = gltf::Glb::from_slice(glb).expect("a GLB");
    let json: serde_json::Value = serde_json::from_slice(&raw.json).expect("JSON");
    let blob = blob.unwrap_or_default();
    let root = document.scenes().next().expect("a scene").nodes().next().expect("a root");
    assert_eq!(root.name(), Some("planecut root"));
    let mut all = Vec::new();
    for node in root.children() {
        let matrix = transform(&json, root.index()) * transform(&json, node.index());
        let mut seen = Seen { triangles: Vec::new(), normals: Vec::new(), materials: Vec::new() };
        for primitive in node.mesh().iter().flat_map(gltf::Mesh::primitives) {
            let reader = primitive.reader(|_| Some(&blob));
            let points: Vec<_> = reader.read_positions().expect("positions").collect();
            let normals: Vec<_> = reader.read_normals().expect("normals").collect();
            let point = |i: u32| matrix.transform_point3(glam::Vec3::from(points[i as usize]).as_dvec3());
            let normal = |i: u32| matrix.transform_vector3(glam::Vec3::from(normals[i as usize]).as_dvec3());
            let indices: Vec<u32> = reader.read_indices().expect("indices").into_u32().collect();
            for corners in indices.chunks_exact(3) {
                seen.triangles.push([corners[0], corners[1], corners[2]].map(point));
                seen.normals.push([corners[0], corners[1], corners[2]].map(normal));
            }
            seen.materials.push(primitive.material().name().expect("named").to_owned());
        }
        all.push(seen);
    }
    all
}

/// The reader's Y-up scene back in Z-up coordinates.
fn z_up(point: DVec3) -> DVec3 {
    DVec3::new(point.x, -point.z, point.y)
}

fn check_round_trip(mesh: &Mesh, scale: f64) {
    let options = ExportOptions { scale, ..ExportOptions::default() };
    let bytes = encode(mesh, Format::Glb, &options).expect("encoded");
    assert_eq!(bytes, encode(mesh, Format::Glb, &options).expect("encoded"), "two runs differ");
    let [seen] = &read(&bytes)[..] else { panic!("one mesh node expected") };

    assert_eq!(seen.triangles.len(), mesh.triangles.len());
    let base = seen.triangles[0][0];
    let found = meshes::volume(seen.triangles.iter().map(|t| t.map(|p| p - base)));
    let expected = meshes::mesh_volume(mesh) * scale.powi(3);
    assert!((found / expected - 1.0).abs() < 1e-6, "volume {found}, expected {expected}");

    for (triangle, normals) in seen.triangles.iter().zip(&seen.normals) {
        let [a, b, c] = *triangle;
        let geometric = (b - a).cross(c - a).normalize();
        for normal in normals {
            assert!(normal.normalize().distance(geometric) < 1e-5, "{normal} against {geometric}");
        }
    }

    let mut used: Vec<String> = mesh
        .triangle_faces
        .iter()
        .map(|&f| mesh.materials[mesh.faces[f as usize].material.0 as usize].name.clone())
        .collect();
    used.sort();
    used.dedup();
    let mut found = seen.materials.clone();
    found.sort();
    assert_eq!(found, used, "one primitive for each used material");
}

#[test]
fn triangles_volumes_normals_and_materials_survive() {
    let boxes = meshes::random_boxes(300, 11);
    for mesh in [meshes::box_mesh(DVec3::ZERO, DVec3::new(1.0, 2.0, 3.0), "stone"), meshes::cube_with_hole(), boxes] {
        check_round_trip(&mesh, 1.0);
        check_round_trip(&mesh, 0.0254);
    }
}

#[test]
fn more_than_65535_vertices_need_wide_indices() {
    let narrow = meshes::random_boxes(65_535 / 24, 5);
    let wide = meshes::random_boxes(65_535 / 24 + 1, 5);
    for (mesh, is_wide) in [(narrow, false), (wide, true)] {
        check_round_trip(&mesh, 1.0);
        let glb = encode(&mesh, Format::Glb, &ExportOptions::default()).expect("encoded");
        let Gltf { document, blob } = Gltf::from_slice(&glb).expect("valid");
        let primitive = document.meshes().next().expect("a mesh").primitives().next().expect("a primitive");
        let reader = primitive.reader(|_| blob.as_deref());
        assert_eq!(matches!(reader.read_indices(), Some(ReadIndices::U32(_))), is_wide);
    }
}

/// Integer coordinates far from the origin come back exactly, not just nearly.
#[test]
fn positions_on_a_grid_are_exact_far_away() {
    let corner = DVec3::new(1_000_003.0, -2_000_001.0, 524_287.0);
    let mesh = meshes::box_mesh(corner, corner + DVec3::new(7.0, 31.0, 1.0), "stone");
    let glb = encode(&mesh, Format::Glb, &ExportOptions::default()).expect("encoded");
    let Gltf { document, blob } = Gltf::from_slice(&glb).expect("valid");
    let node = document.nodes().nth(1).expect("the mesh node");
    let (translation, ..) = node.transform().decomposed();
    let primitive = node.mesh().expect("a mesh").primitives().next().expect("a primitive");
    let positions = primitive.reader(|_| blob.as_deref()).read_positions().expect("positions");
    let mut found: Vec<_> =
        positions.map(|p| [0, 1, 2].map(|i| f64::from(p[i]) + f64::from(translation[i])).map(|v| v as i64)).collect();
    let mut expected: Vec<_> = mesh.positions.iter().map(|p| p.to_array().map(|v| v as i64)).collect();
    found.sort_unstable();
    found.dedup();
    expected.sort_unstable();
    assert_eq!(found, expected);
}

#[test]
fn up_is_y() {
    let mesh = meshes::box_mesh(DVec3::ZERO, DVec3::new(1.0, 2.0, 30.0), "stone");
    let seen = read(&encode(&mesh, Format::Glb, &ExportOptions::default()).expect("encoded"));
    let points = || seen[0].triangles.iter().flatten().copied();
    let max = points().fold(DVec3::NEG_INFINITY, DVec3::max);
    let min = points().fold(DVec3::INFINITY, DVec3::min);
    assert!((max - min).distance(DVec3::new(1.0, 30.0, 2.0)) < 1e-12, "{min} to {max}");
    let expected: Vec<_> = mesh.positions.iter().map(|p| p.to_array().map(|v| v.round() as i64)).collect();
    assert!(points().all(|p| expected.contains(&z_up(p).to_array().map(|v| v.round() as i64))));
}

/// The manifold that `EXT_mesh_manifold` describes, by the extension's own rules.
fn manifold_indices(glb: &[u8], mesh: usize) -> Option<Vec<u32>> {
    let raw = gltf::Glb::from_slice(glb).expect("a GLB");
    let json: serde_json::Value = serde_json::from_slice(&raw.json).expect("JSON");
    let bin = raw.bin.expect("a buffer");
    let extension = json["meshes"][mesh]["extensions"].get("EXT_mesh_manifold")?;
    assert_eq!(json["extensionsUsed"], serde_json::json!(["EXT_mesh_manifold"]));
    let integers = |view: &serde_json::Value, offset: &serde_json::Value, component: u64, count: u64| -> Vec<u32> {
        let view = &json["bufferViews"][view.as_u64().expect("a view") as usize];
        let start = view["byteOffset"].as_u64().expect("an offset") + offset.as_u64().expect("an offset");
        let width = if component == 5123 { 2 } else { 4 };
        let bytes = &bin[start as usize..(start + count * width) as usize];
        bytes.chunks(width as usize).map(|c| c.iter().rev().fold(0, |sum, &b| sum << 8 | u32::from(b))).collect()
    };
    let accessor = |index: &serde_json::Value| &json["accessors"][index.as_u64().expect("an index") as usize];
    let number = |value: &serde_json::Value| value.as_u64().expect("a number");
    let read = |a: &serde_json::Value| {
        integers(&a["bufferView"], &a["byteOffset"], number(&a["componentType"]), number(&a["count"]))
    };

    let primitive = &extension["manifoldPrimitive"];
    let indices = accessor(&primitive["indices"]);
    for visible in json["meshes"][mesh]["primitives"].as_array().expect("primitives") {
        assert_eq!(visible["attributes"]["POSITION"], primitive["attributes"]["POSITION"], "one shared accessor");
        assert_eq!(accessor(&visible["indices"])["bufferView"], indices["bufferView"], "one shared view");
    }
    let (places, vertices) = (accessor(&extension["mergeIndices"]), accessor(&extension["mergeValues"]));
    let sparse = &indices["sparse"];
    for (merge, sparse_side) in [(places, &sparse["indices"]), (vertices, &sparse["values"])] {
        assert_eq!(
            (&merge["bufferView"], &merge["byteOffset"]),
            (&sparse_side["bufferView"], &sparse_side["byteOffset"])
        );
        assert_eq!(merge["count"], sparse["count"]);
    }
    assert_eq!(places["componentType"], sparse["indices"]["componentType"]);
    let mut all = read(indices);
    let places = read(places);
    assert!(places.windows(2).all(|pair| pair[0] < pair[1]), "places rise strictly");
    for (place, vertex) in places.into_iter().zip(read(vertices)) {
        all[place as usize] = vertex;
    }
    Some(all)
}

/// A position as single precision holds it, relative to a point.
fn single(position: DVec3, origin: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| f64::from((position[k] - origin[k]) as f32 + 0.0))
}

/// The positions of the only mesh of a file, and the translation of its node.
fn read_positions(glb: &[u8]) -> (Vec<[f64; 3]>, [f64; 3]) {
    let Gltf { document, blob } = Gltf::from_slice(glb).expect("valid");
    let blob = blob.expect("a buffer");
    let raw = gltf::Glb::from_slice(glb).expect("a GLB");
    let json: serde_json::Value = serde_json::from_slice(&raw.json).expect("JSON");
    let translation = [0, 1, 2].map(|k| json["nodes"][1]["translation"][k].as_f64().expect("a number"));
    let primitive = document.meshes().next().expect("a mesh").primitives().next().expect("a primitive");
    let positions = primitive.reader(|_| Some(&blob)).read_positions().expect("positions");
    (positions.map(|position| position.map(f64::from)).collect(), translation)
}

/// A triangle's positions, the least one first, and its corners in the same turn.
fn turned(mut corners: [u32; 3], position: impl Fn(u32) -> [f64; 3]) -> ([[u64; 3]; 3], [u32; 3]) {
    let key = |corner: u32| position(corner).map(f64::to_bits);
    let first = (0..3).min_by_key(|k| key(corners[*k])).expect("three");
    corners.rotate_left(first);
    (corners.map(key), corners)
}

#[test]
fn the_manifold_extension_restores_the_meshes_own_indices() {
    for mesh in [meshes::cube_with_hole(), meshes::random_boxes(40, 3), meshes::random_boxes(3_000, 4)] {
        let glb = encode(&mesh, Format::Glb, &ExportOptions::default()).expect("encoded");
        let found = manifold_indices(&glb, 0).expect("a manifold");
        // Triangles come in another order; no two of a solid have the same corners in the same turn.
        let (read, translation) = read_positions(&glb);
        let own: BTreeMap<[[u64; 3]; 3], [u32; 3]> = mesh
            .triangles
            .iter()
            .map(|corners| turned(*corners, |corner| single(mesh.positions[corner as usize], translation)))
            .collect();
        assert_eq!(own.len(), mesh.triangles.len());
        let expected: Vec<u32> = found
            .chunks(3)
            .flat_map(|corners| {
                let corners = [corners[0], corners[1], corners[2]];
                let (key, in_file) = turned(corners, |corner| read[corner as usize]);
                // the same turn for both
                let first = in_file.iter().position(|corner| *corner == corners[0]).expect("a corner");
                let mut own = own[&key];
                own.rotate_left(first);
                own
            })
            .collect();
        // Equal up to renaming vertices: the renaming must be one to one.
        let forward: BTreeMap<_, _> = expected.iter().zip(&found).collect();
        let backward: BTreeMap<_, _> = found.iter().zip(&expected).collect();
        assert_eq!(forward.len(), mesh.positions.len());
        assert_eq!(backward.len(), mesh.positions.len());
        assert!(expected.iter().zip(&found).all(|(e, f)| forward[e] == f && backward[f] == e));
    }
}

#[test]
fn an_open_mesh_does_not_claim_to_be_a_manifold() {
    let mut mesh = meshes::cube_with_hole();
    mesh.triangles.pop();
    mesh.triangle_faces.pop();
    let glb = encode(&mesh, Format::Glb, &ExportOptions::default()).expect("encoded");
    assert_eq!(manifold_indices(&glb, 0), None);
}

#[test]
fn an_empty_mesh_is_a_valid_file_without_meshes() {
    for format in [Format::Glb, Format::Gltf] {
        let bytes = encode(&Mesh::default(), format, &ExportOptions::default()).expect("encoded");
        let Gltf { document, blob } = Gltf::from_slice(&bytes).expect("valid");
        assert_eq!((document.nodes().len(), document.meshes().len(), blob), (2, 0, None));
    }
}

#[test]
fn parts_become_named_nodes_and_share_materials() {
    let meshes: Vec<Mesh> = (0..5)
        .map(|i| meshes::box_mesh(DVec3::splat(f64::from(i) * 3.0), DVec3::splat(f64::from(i) * 3.0 + 2.0), "stone"))
        .chain([Mesh::default(), meshes::cube_with_hole()])
        .collect();
    let names: Vec<String> = (0..meshes.len()).map(|i| format!("cell {i}")).collect();
    let parts: Vec<_> = meshes.iter().zip(&names).map(|(mesh, name)| Part::new(name, mesh)).collect();
    let glb = encode_parts(&parts, Format::Glb, &ExportOptions::default()).expect("encoded");
    let seen = read(&glb);
    for (seen, mesh) in seen.iter().zip(&meshes) {
        assert_eq!(seen.triangles.len(), mesh.triangles.len());
        if mesh.triangles.is_empty() {
            continue;
        }
        let found = meshes::volume(seen.triangles.iter().copied());
        assert!((found - meshes::mesh_volume(mesh)).abs() < 1e-9);
    }
    let document = Gltf::from_slice(&glb).expect("valid").document;
    let nodes: Vec<_> = document.nodes().skip(1).map(|node| node.name().expect("named").to_owned()).collect();
    assert_eq!(nodes, names);
    assert_eq!(document.materials().len(), 3, "stone once, and the two of the last part");
}

/// The JSON form holds the same document and the same buffer.
#[test]
fn gltf_embeds_the_buffer_of_the_glb() {
    let mesh = meshes::random_boxes(20, 8);
    let glb = encode(&mesh, Format::Glb, &ExportOptions::default()).expect("encoded");
    let text = encode(&mesh, Format::Gltf, &ExportOptions::default()).expect("encoded");
    let raw = gltf::Glb::from_slice(&glb).expect("a GLB");
    let expected: serde_json::Value = serde_json::from_slice(&raw.json).expect("JSON");
    let mut found: serde_json::Value = serde_json::from_slice(&text).expect("JSON");
    let uri = found["buffers"][0].as_object_mut().expect("a buffer").remove("uri").expect("a URI");
    assert_eq!(found, expected);
    let code =
        uri.as_str().and_then(|uri| uri.strip_prefix("data:application/octet-stream;base64,")).expect("a data URI");
    assert_eq!(decode_base64(code), raw.bin.expect("a buffer").to_vec());
}

fn decode_base64(code: &str) -> Vec<u8> {
    let digit = |c: u8| match c {
        b'A'..=b'Z' => c - b'A',
        b'a'..=b'z' => c - b'a' + 26,
        b'0'..=b'9' => c - b'0' + 52,
        b'+' => 62,
        _ => 63,
    };
    let digits = code.trim_end_matches('=').bytes().map(digit);
    let bits: Vec<u8> = digits.flat_map(|d| (0..6).rev().map(move |bit| d >> bit & 1)).collect();
    bits.chunks_exact(8).map(|byte| byte.iter().fold(0, |sum, bit| sum << 1 | bit)).collect()
}

#[test]
fn coordinates_beyond_single_precision_are_refused() {
    let mesh = meshes::box_mesh(DVec3::splat(-1e300), DVec3::splat(1e300), "stone");
    let message = encode(&mesh, Format::Glb, &ExportOptions::default()).expect_err("refused").to_string();
    assert!(message.contains("single precision"), "{message}");
}
