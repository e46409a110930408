//! Writers of small mesh files, made for the tests of the readers: each file is put together from its specification.

#[cfg(feature = "meshopt")]
pub(crate) mod packed;

use planecut_check::{CheckOptions, CheckReport, TOLERANCE_F32, check_mesh};
use planecut_import::mesh::{IndexedMesh, Precision};

/// Corners of a unit cube, number `i` at the bits of `i`.
pub(crate) fn cube_corners() -> Vec<[f32; 3]> {
    (0..8u8).map(|i| [f32::from(i & 1), f32::from(i >> 1 & 1), f32::from(i >> 2)]).collect()
}

/// Its sides, counter-clockwise seen from outside.
pub(crate) const CUBE_QUADS: [[u32; 4]; 6] =
    [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];

/// Its sides as triangles.
pub(crate) fn cube_triangles() -> Vec<[u32; 3]> {
    CUBE_QUADS.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect()
}

pub(crate) fn obj() -> String {
    let mut text = String::from("# a cube\no cube\n");
    cube_corners().iter().for_each(|[x, y, z]| text += &format!("v {x} {y} {z}\n"));
    CUBE_QUADS.iter().for_each(|q| text += &format!("f {} {} {} {}\n", q[0] + 1, q[1] + 1, q[2] + 1, q[3] + 1));
    text
}

pub(crate) fn stl_binary() -> Vec<u8> {
    let corners = cube_corners();
    let triangles = cube_triangles();
    let mut bytes = vec![b' '; 80];
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for triangle in triangles {
        bytes.extend([0; 12]);
        triangle.iter().flat_map(|&v| corners[v as usize]).for_each(|x| bytes.extend(x.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

pub(crate) fn stl_ascii() -> String {
    let corners = cube_corners();
    let mut text = String::from("solid the cube\n");
    for triangle in cube_triangles() {
        text += "facet normal nan 0 0\n outer loop\n";
        for [x, y, z] in triangle.map(|v| corners[v as usize]) {
            text += &format!("  vertex {x:e} {y:e} {z:e}\n");
        }
        text += " endloop\nendfacet\n";
    }
    text + "endsolid the cube\n"
}

/// `format` is `ascii`, `binary_little_endian` or `binary_big_endian`; vertices and faces carry something else besides.
pub(crate) fn ply(format: &str) -> Vec<u8> {
    let mut bytes = format!(
        "ply\nformat {format} 1.0\ncomment a cube\nelement camera 1\nproperty list uchar short path\nelement vertex 8\n\
         property uchar red\nproperty float x\nproperty float y\nproperty float z\nelement face 6\n\
         property double weight\nproperty list uchar int vertex_indices\nend_header\n"
    )
    .into_bytes();
    let mut ascii = String::new();
    let swap = format == "binary_big_endian";
    let mut put = |number: &[u8]| {
        if swap { bytes.extend(number.iter().rev()) } else { bytes.extend(number) }
    };
    put(&2u8.to_le_bytes());
    put(&7i16.to_le_bytes());
    put(&(-7i16).to_le_bytes());
    ascii += "2 7 -7\n";
    for position in cube_corners() {
        put(&[9]);
        position.iter().for_each(|x| put(&x.to_le_bytes()));
        ascii += &format!("9 {} {} {}\n", position[0], position[1], position[2]);
    }
    for quad in CUBE_QUADS {
        put(&0.5f64.to_le_bytes());
        put(&[4]);
        quad.iter().for_each(|v| put(&v.to_le_bytes()));
        ascii += &format!("0.5 4 {} {} {} {}\n", quad[0], quad[1], quad[2], quad[3]);
    }
    if format == "ascii" {
        bytes.truncate(bytes.windows(11).position(|w| w == b"end_header\n").map_or(0, |at| at + 11));
        bytes.extend(ascii.bytes());
    }
    bytes
}

/// A binary container around a document and a buffer.
pub(crate) fn glb(json: &str, buffer: &[u8]) -> Vec<u8> {
    let mut json = json.as_bytes().to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut buffer = buffer.to_vec();
    buffer.resize(buffer.len().next_multiple_of(4), 0);
    let length = 12 + 8 + json.len() + 8 + buffer.len();
    let mut bytes = b"glTF".to_vec();
    bytes.extend(2u32.to_le_bytes());
    bytes.extend((length as u32).to_le_bytes());
    bytes.extend((json.len() as u32).to_le_bytes());
    bytes.extend(b"JSON");
    bytes.extend(json);
    bytes.extend((buffer.len() as u32).to_le_bytes());
    bytes.extend(b"BIN\0");
    bytes.extend(buffer);
    bytes
}

/// The bytes of numbers, one after the other.
pub(crate) fn floats(values: impl IntoIterator<Item = [f32; 3]>) -> Vec<u8> {
    values.into_iter().flatten().flat_map(f32::to_le_bytes).collect()
}

/// The bytes of 16-bit indices.
pub(crate) fn shorts(values: impl IntoIterator<Item = u16>) -> Vec<u8> {
    values.into_iter().flat_map(u16::to_le_bytes).collect()
}

/// A cube with four vertices of its own on each side, as a glTF document and its buffer: `nodes` and `more` members go in as given.
pub(crate) fn split_cube(nodes: &str, more: &str) -> (String, Vec<u8>) {
    let corners = cube_corners();
    let mut buffer = floats(CUBE_QUADS.iter().flatten().map(|&v| corners[v as usize]));
    let indices: Vec<u16> = (0..6).flat_map(|q| [0, 1, 2, 0, 2, 3].map(|k| 4 * q + k)).collect();
    let (vertices, used) = (buffer.len(), 2 * indices.len());
    buffer.extend(shorts(indices));
    let json = format!(
        r#"{{"asset": {{"version": "2.0"}}, {nodes}, {more}
        "meshes": [{{"name": "cube", "primitives": [{{"attributes": {{"POSITION": 0, "NORMAL": 9}}, "indices": 1}}]}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 24, "type": "VEC3"}},
                      {{"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"}}],
        "bufferViews": [{{"buffer": 0, "byteLength": {vertices}}},
                        {{"buffer": 0, "byteOffset": {vertices}, "byteLength": {used}}}],
        "buffers": [{{"byteLength": {}}}]}}"#,
        buffer.len()
    );
    (json, buffer)
}

/// The mesh checked with the tolerance that its precision asks for.
pub(crate) fn check(mesh: &IndexedMesh) -> CheckReport {
    let single = CheckOptions { tolerance: TOLERANCE_F32, ..CheckOptions::default() };
    let options = if mesh.precision == Precision::Single { single } else { CheckOptions::default() };
    check_mesh(&mesh.positions, &mesh.triangles, &options)
}

/// Fails unless the mesh is one sound surface without handles and with the given volume.
pub(crate) fn assert_sound(mesh: &IndexedMesh, volume: f64) {
    let report = check(mesh);
    assert!(report.is_sound(), "{report}");
    assert_eq!((report.topology.components, report.topology.genus), (1, Some(0)));
    assert!((report.topology.measures.volume - volume).abs() <= 1e-12 * volume, "{}", report.topology.measures.volume);
}
