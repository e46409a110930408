//! glTF: containers, transforms, primitive modes, sparse accessors, and `EXT_mesh_manifold`.

use glam::DVec3;
use planecut_check::TopologyDefect;
use planecut_import::mesh::{IndexedMesh, MeshFormat, Precision, read_mesh};

use super::support::{CUBE_QUADS, assert_sound, check, cube_corners, cube_triangles, floats, glb, shorts, split_cube};

const ONE_NODE: &str = r#""scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}]"#;

fn read(bytes: &[u8]) -> IndexedMesh {
    read_mesh(bytes, MeshFormat::Gltf, "file").unwrap_or_else(|error| panic!("{error}"))
}

fn error(bytes: &[u8]) -> String {
    read_mesh(bytes, MeshFormat::Gltf, "file").expect_err("the file is broken").to_string()
}

fn cube_with(nodes: &str) -> IndexedMesh {
    let (json, buffer) = split_cube(nodes, "");
    read(&glb(&json, &buffer))
}

fn extent(mesh: &IndexedMesh) -> (DVec3, DVec3) {
    let first = mesh.positions[0];
    mesh.positions.iter().fold((first, first), |(low, high), &p| (low.min(p), high.max(p)))
}

#[test]
fn split_vertices_are_merged() {
    let mesh = cube_with(ONE_NODE);
    assert_eq!((mesh.positions.len(), mesh.triangles.len(), mesh.precision), (8, 12, Precision::Single));
    assert_eq!(mesh.objects[0].name.as_deref(), Some("cube"));
    assert_sound(&mesh, 1.0);
}

#[test]
fn transforms_are_applied_from_the_root_down() {
    let mesh = cube_with(
        r#""scenes": [{"nodes": [0]}], "nodes": [{"translation": [10, 0, 0], "children": [1]},
           {"mesh": 0, "name": "box", "scale": [2, 3, 4], "rotation": [0, 0, 0.7071068, 0.7071068]}]"#,
    );
    assert_sound(&mesh, 24.0);
    // Scaled, then turned from x to y, then moved; the quarter turn is exact although its quaternion is rounded.
    assert_eq!(extent(&mesh), (DVec3::new(7.0, 0.0, 0.0), DVec3::new(10.0, 2.0, 4.0)));
    assert_eq!(mesh.objects[0].name.as_deref(), Some("box"));
}

#[test]
fn mirrored_nodes_stay_right_side_out() {
    assert_sound(&cube_with(r#""nodes": [{"mesh": 0, "scale": [-2, 1, 1]}]"#), 2.0);
    let mirror = r#""nodes": [{"mesh": 0, "matrix": [0,1,0,0, 1,0,0,0, 0,0,1,0, 5,6,7,1]}]"#;
    let mesh = cube_with(mirror);
    assert_sound(&mesh, 1.0);
    assert_eq!(extent(&mesh), (DVec3::new(5.0, 6.0, 7.0), DVec3::new(6.0, 7.0, 8.0)));
}

#[test]
fn nodes_are_not_merged_with_each_other() {
    let mesh = cube_with(
        r#""scenes": [{"nodes": [0]}, {"nodes": [0, 1]}],
           "nodes": [{"mesh": 0}, {"mesh": 0, "translation": [1, 1, 0]}, {"mesh": 0}]"#,
    );
    assert_eq!((mesh.positions.len(), mesh.objects.len()), (16, 2), "a node that no scene holds is not there");
    let report = check(&mesh);
    assert!(report.is_sound(), "{report}");
    assert_eq!(report.topology.components, 2);
}

#[test]
fn json_with_an_embedded_buffer_is_read() {
    let (json, buffer) = split_cube(ONE_NODE, "");
    // Base64, most significant six bits first.
    let alphabet = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let bits: Vec<u8> = buffer.iter().flat_map(|b| (0..8).rev().map(move |k| b >> k & 1)).collect();
    let digit = |chunk: &[u8]| (0..6).fold(0, |d, k| d << 1 | chunk.get(k).copied().unwrap_or(0));
    let text: String = bits.chunks(6).map(|chunk| alphabet[usize::from(digit(chunk))] as char).collect();
    let embedded = json.replace(
        r#""buffers": [{"#,
        &format!(r#""buffers": [{{"uri": "data:application/octet-stream;base64,{text}", "#),
    );
    assert_sound(&read(embedded.as_bytes()), 1.0);
    let external = json.replace(r#""buffers": [{"#, r#""buffers": [{"uri": "cube.bin", "#);
    assert_eq!(
        error(external.as_bytes()),
        "file: buffers/0: found `cube.bin`, expected an embedded buffer, `data:…;base64,…`"
    );
}

#[test]
fn strips_fans_and_plain_lists_give_triangles() {
    // A square pyramid: its base a strip, its sides a fan around the top, and the whole again as a plain list.
    let base = [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]];
    let fan = [[0.5, 0.5, 3.0], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0]];
    let buffer = floats(base.into_iter().chain(fan));
    let json = format!(
        r#"{{"asset": {{"version": "2.0"}}, "nodes": [{{"mesh": 0}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "mode": 5}}, {{"attributes": {{"POSITION": 1}}, "mode": 6}},
                                    {{"attributes": {{"POSITION": 1}}, "mode": 1}}]}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"}},
                      {{"bufferView": 0, "byteOffset": 48, "componentType": 5126, "count": 6, "type": "VEC3"}}],
        "bufferViews": [{{"buffer": 0, "byteLength": {}}}], "buffers": [{{"byteLength": {0}}}]}}"#,
        buffer.len()
    );
    let mesh = read(&glb(&json, &buffer));
    assert_eq!((mesh.positions.len(), mesh.triangles.len()), (5, 6));
    assert_sound(&mesh, 1.0);
}

/// Two cubes that share an edge by position, each side with its own vertices, and the manifold's indices as sparse changes.
fn touching_cubes(with_extension: bool) -> Vec<u8> {
    let corners = cube_corners();
    let positions = [0.0, 1.0].into_iter().flat_map(|shift| {
        let corners = corners.clone();
        CUBE_QUADS
            .into_iter()
            .flatten()
            .map(move |v| corners[v as usize])
            .map(move |[x, y, z]| [x + shift, y + shift, z])
    });
    let mut buffer = floats(positions);
    let indices: Vec<u16> = (0..12).flat_map(|q| [0, 1, 2, 0, 2, 3].map(|k| 4 * q + k)).collect();
    // The manifold uses, within each cube, the first of the vertices at a corner.
    let flat: Vec<u32> = CUBE_QUADS.into_iter().flatten().collect();
    let first = |v: u16| {
        let (cube, local) = (v / 24, usize::from(v % 24));
        24 * cube + flat.iter().position(|&c| c == flat[local]).map_or(0, |p| p as u16)
    };
    let changed: Vec<u16> = (0..72).filter(|&i| first(indices[usize::from(i)]) != indices[usize::from(i)]).collect();
    let at_indices = buffer.len();
    buffer.extend(shorts(indices.iter().copied()));
    let at_changed = buffer.len();
    buffer.extend(shorts(changed.iter().copied()));
    let at_values = buffer.len();
    buffer.extend(shorts(changed.iter().map(|&i| first(indices[usize::from(i)]))));
    let (total, count, changed_length) = (buffer.len(), changed.len(), 2 * changed.len());
    let extension = if with_extension {
        r#", "extensions": {"EXT_mesh_manifold": {"manifoldPrimitive": {"attributes": {"POSITION": 0}, "indices": 2, "mode": 4}}}"#
    } else {
        ""
    };
    let json = format!(
        r#"{{"asset": {{"version": "2.0"}}, "nodes": [{{"mesh": 0}}], "extensionsUsed": ["EXT_mesh_manifold"],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 1}}]{extension}}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 48, "type": "VEC3"}},
                      {{"bufferView": 1, "componentType": 5123, "count": 72, "type": "SCALAR"}},
                      {{"bufferView": 1, "componentType": 5123, "count": 72, "type": "SCALAR", "sparse": {{"count": {count},
                        "indices": {{"bufferView": 2, "componentType": 5123}}, "values": {{"bufferView": 3}}}}}}],
        "bufferViews": [{{"buffer": 0, "byteLength": {at_indices}}},
                        {{"buffer": 0, "byteOffset": {at_indices}, "byteLength": 144}},
                        {{"buffer": 0, "byteOffset": {at_changed}, "byteLength": {changed_length}}},
                        {{"buffer": 0, "byteOffset": {at_values}, "byteLength": {changed_length}}}],
        "buffers": [{{"byteLength": {total}}}]}}"#
    );
    glb(&json, &buffer)
}

#[test]
fn the_manifold_extension_keeps_touching_parts_apart() {
    let manifold = read(&touching_cubes(true));
    assert_eq!((manifold.positions.len(), manifold.triangles.len()), (16, 24));
    let report = check(&manifold);
    assert!(report.is_sound(), "{report}");
    assert_eq!(report.topology.components, 2);

    // Without it the cubes are glued at their common edge: watertight, but no manifold.
    let merged = read(&touching_cubes(false));
    assert_eq!(merged.positions.len(), 14);
    let topology = check(&merged).topology;
    assert!(
        topology.watertight && matches!(topology.first_defect, Some(TopologyDefect::DuplicateEdge { uses: 2, .. }))
    );
}

#[test]
fn quantized_positions_are_scaled() {
    let triangles: Vec<u16> = cube_triangles().into_iter().flatten().map(|v| v as u16).collect();
    let mut buffer: Vec<u8> = cube_corners().iter().flat_map(|p| p.map(|x| if x > 0.0 { 255 } else { 0 })).collect();
    buffer.extend(shorts(triangles));
    let json = r#"{"asset": {"version": "2.0"}, "extensionsRequired": ["KHR_mesh_quantization"], "nodes": [{"mesh": 0, "scale": [2, 2, 2]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [{"bufferView": 0, "componentType": 5121, "normalized": true, "count": 8, "type": "VEC3"},
                      {"bufferView": 0, "byteOffset": 24, "componentType": 5123, "count": 36, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": 96}], "buffers": [{"byteLength": 96}]}"#;
    assert_sound(&read(&glb(json, &buffer)), 8.0);
}

#[test]
fn errors_name_the_place() {
    let (json, buffer) = split_cube(ONE_NODE, "");
    let broken = |from: &str, to: &str| {
        assert!(json.contains(from), "{from}");
        error(&glb(&json.replace(from, to), &buffer))
    };
    let cases = [
        (
            r#""count": 24"#,
            r#""count": 25"#,
            "file: accessors/0: found 25 values at byte 0, expected a range within the 288 bytes",
        ),
        (
            r#""count": 24"#,
            r#""count": 4000000000000000000"#,
            "file: accessors/0: found 4000000000000000000 values at byte 0, expected a range within the 288 bytes",
        ),
        (
            r#""count": 24"#,
            r#""count": 20"#,
            "file: meshes/0/primitives/0: found vertex index 20, expected an index below 20",
        ),
        (r#""count": 36"#, r#""count": 35"#, "file: meshes/0/primitives/0: found 35 indices, expected a multiple of 3"),
        (r#""VEC3""#, r#""VEC2""#, "file: accessors/0: found the type `VEC2`, expected `VEC3`"),
        ("5126", "5124", "file: accessors/0: found component type 5124, expected 5120 to 5123, 5125 or 5126"),
        ("5123", "5126", "file: accessors/1: found component type 5126, expected 5121, 5123 or 5125 for indices"),
        ("5123", "5125", "file: accessors/1: found 36 values at byte 0, expected a range within the 72 bytes"),
        (
            r#""byteLength": 288"#,
            r#""byteLength": 9999"#,
            "file: bufferViews/0: found 9999 bytes from byte 0 of buffer 0, expected a range within its 360 bytes",
        ),
        (r#""mesh": 0"#, r#""mesh": 1"#, "file: nodes/0: found mesh 1, expected one of 1"),
        (r#""mesh": 0"#, r#""children": [0]"#, "file: nodes/0: found a node with two parents, expected a tree"),
        (r#""mesh": 0"#, r#""camera": 0"#, "file: found no triangles, expected at least one"),
        (r#""2.0""#, r#""1.0""#, "file: asset/version: found `1.0`, expected `2.0`"),
        (
            ONE_NODE,
            &format!(r#"{ONE_NODE}, "extensionsRequired": ["KHR_draco_mesh_compression"]"#),
            "file: extensionsRequired: found the required extension `KHR_draco_mesh_compression`, expected a file without it",
        ),
    ];
    for (from, to, expected) in cases {
        assert_eq!(broken(from, to), expected);
    }
    assert_eq!(
        error(b"{\"asset\":\n [}"),
        "file:2: found JSON that is not a glTF document (expected value), expected glTF 2.0"
    );
    assert_eq!(error(b"glTF\x01\0\0\0"), "file: byte 4: found container version 1, expected 2");
}

#[test]
fn shared_nodes_are_refused_before_they_multiply() {
    // Were nodes allowed two parents, thirty levels would place the cube a thousand million times.
    let nodes: Vec<String> = (0..30).map(|k| format!(r#"{{"children": [{0}, {0}]}}"#, k + 1)).collect();
    let (json, buffer) =
        split_cube(&format!(r#""scenes": [{{"nodes": [0]}}], "nodes": [{}, {{"mesh": 0}}]"#, nodes.join(", ")), "");
    assert!(error(&glb(&json, &buffer)).contains("a node with two parents"));
}

#[cfg(not(feature = "meshopt"))]
#[test]
fn packed_buffers_need_a_feature() {
    let (json, buffer) = split_cube(ONE_NODE, "");
    let packed = r#""extensions": {"EXT_meshopt_compression": {"buffer": 0, "byteLength": 9, "byteStride": 12, "count": 24, "mode": "ATTRIBUTES"}}"#;
    let json = json.replace(r#""byteLength": 288}"#, &format!(r#""byteLength": 288, {packed}}}"#));
    assert_eq!(
        error(&glb(&json, &buffer)),
        "file: bufferViews/0/extensions/EXT_meshopt_compression: found packed bytes, and a program built without the feature `meshopt`, expected one that is built with it"
    );
}
