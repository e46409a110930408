//! glTF with packed buffers (`EXT_meshopt_compression`): all modes, filters and strides, and what is wrong with them.

use glam::DVec3;
use planecut_import::mesh::{IndexedMesh, MeshFormat, read_mesh};

use super::support::packed::{Positions, attributes, packed_cube};
use super::support::{assert_sound, glb};

fn read(json: &str, buffer: &[u8]) -> IndexedMesh {
    read_mesh(&glb(json, buffer), MeshFormat::Gltf, "file").unwrap_or_else(|error| panic!("{error}"))
}

fn error(json: &str, buffer: &[u8]) -> String {
    read_mesh(&glb(json, buffer), MeshFormat::Gltf, "file").expect_err("the file is broken").to_string()
}

#[test]
fn all_modes_and_widths_are_read() {
    for (positions, volume) in [(Positions::Floats, 1.0), (Positions::Exponential, 1.0), (Positions::Shorts, 27.0)] {
        for (mode, width) in [("TRIANGLES", 2), ("TRIANGLES", 4), ("INDICES", 2), ("INDICES", 4)] {
            let (json, buffer) = packed_cube(positions, mode, width);
            let mesh = read(&json, &buffer);
            assert_eq!((mesh.positions.len(), mesh.triangles.len()), (8, 12), "{positions:?} {mode} {width}");
            assert_sound(&mesh, volume);
        }
    }
}

#[test]
fn a_fallback_is_not_asked_for() {
    let (json, buffer) = packed_cube(Positions::Floats, "TRIANGLES", 2);
    // bytes of its own, elsewhere: readers that know the extension need not have them
    let elsewhere = json.replace(
        r#""extensions": {"EXT_meshopt_compression": {"fallback": true}}"#,
        r#""uri": "fallback.bin", "extensions": {"EXT_meshopt_compression": {"fallback": true}}"#,
    );
    assert_ne!(elsewhere, json);
    assert_sound(&read(&elsewhere, &buffer), 1.0);
    let no_fallback = json.replace(r#"{"fallback": true}"#, "{}");
    assert_eq!(
        error(&no_fallback, &buffer),
        "file: buffers/1: found a buffer without data, expected a data address or a binary chunk"
    );
    let unpacked = json.replacen(
        r#""extensions": {"EXT_meshopt_compression":
            {"buffer": 0, "byteLength""#,
        r#""extensions": {"EXT_other":
            {"buffer": 0, "byteLength""#,
        1,
    );
    assert_eq!(
        error(&unpacked, &buffer),
        "file: bufferViews/0: found 96 bytes from byte 0 of buffer 1, expected a range within its 0 bytes"
    );
}

#[test]
fn normalized_numbers_are_fractions_and_nodes_give_them_their_size() {
    let (json, buffer) = packed_cube(Positions::Shorts, "INDICES", 2);
    // 3 of 32767, and the node makes 6 of it
    let json = json
        .replace(r#""componentType": 5122"#, r#""componentType": 5122, "normalized": true"#)
        .replace(r#"{"mesh": 0}"#, r#"{"mesh": 0, "translation": [1, 2, 3], "scale": [65534, 65534, 65534]}"#);
    let mesh = read(&json, &buffer);
    let far = mesh.positions.iter().fold(DVec3::NEG_INFINITY, |far, p| far.max(*p));
    assert!((far - DVec3::new(7.0, 8.0, 9.0)).abs().max_element() < 1e-12, "{far}");
    let near = mesh.positions.iter().fold(DVec3::INFINITY, |near, p| near.min(*p));
    assert_eq!(near, DVec3::new(1.0, 2.0, 3.0));
}

/// A triangle of positions within elements of any stride: others' attributes lie between them.
#[test]
fn all_strides_are_read() {
    let corners = [[1.0f32, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, -9.0]];
    for stride in (12..=256).step_by(4) {
        let mut plain = Vec::new();
        for corner in corners {
            let start = plain.len();
            plain.extend(corner.iter().flat_map(|x| x.to_le_bytes()));
            plain.extend((12..stride).map(|k| (k * 7 + start) as u8));
        }
        let buffer = attributes(&plain, stride);
        let json = format!(
            r#"{{"asset": {{"version": "2.0"}}, "nodes": [{{"mesh": 0}}], "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}}}]}}],
            "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}}],
            "bufferViews": [{{"buffer": 0, "byteLength": {}, "byteStride": {stride}, "extensions": {{"EXT_meshopt_compression":
                {{"buffer": 0, "byteLength": {}, "byteStride": {stride}, "count": 3, "mode": "ATTRIBUTES", "filter": "NONE"}}}}}}],
            "buffers": [{{"byteLength": {}}}]}}"#,
            plain.len(),
            buffer.len(),
            buffer.len()
        );
        let expected = corners.map(|corner| DVec3::from_array(corner.map(f64::from)));
        assert_eq!(read(&json, &buffer).positions, expected, "{stride}");
    }
}

/// Directions are no positions, but are unpacked as any numbers are.
#[test]
fn filters_of_directions_are_applied() {
    let directions = [[0.6f32, 0.0, 0.8, 0.0], [0.0, -1.0, 0.0, 0.0], [-0.36, 0.48, -0.8, 0.0]];
    let bytes: Vec<[i8; 4]> = meshopt::encode_filter_oct(&directions, 8);
    let shorts: Vec<[i16; 4]> = meshopt::encode_filter_oct(&directions, 16);
    let quaternions = meshopt::encode_filter_quat(&directions, 16);
    let wide = |elements: &[[i16; 4]]| elements.iter().flatten().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>();
    let cases = [
        (bytes.iter().flatten().map(|x| x.cast_unsigned()).collect(), 4, 5120, "OCTAHEDRAL", 0.02),
        (wide(&shorts), 8, 5122, "OCTAHEDRAL", 1e-4),
        (wide(&quaternions), 8, 5122, "QUATERNION", 1e-4),
    ];
    for (plain, stride, component, filter, tolerance) in cases {
        let buffer = attributes(&plain, stride);
        let length = buffer.len();
        let json = format!(
            r#"{{"asset": {{"version": "2.0"}}, "nodes": [{{"mesh": 0}}], "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}}}]}}],
            "accessors": [{{"bufferView": 0, "componentType": {component}, "normalized": true, "count": 3, "type": "VEC3"}}],
            "bufferViews": [{{"buffer": 0, "byteLength": {}, "byteStride": {stride}, "extensions": {{"EXT_meshopt_compression":
                {{"buffer": 0, "byteLength": {length}, "byteStride": {stride}, "count": 3, "mode": "ATTRIBUTES", "filter": "{filter}"}}}}}}],
            "buffers": [{{"byteLength": {length}}}]}}"#,
            plain.len()
        );
        for (position, direction) in read(&json, &buffer).positions.iter().zip(directions) {
            let direction = DVec3::from_array([direction[0], direction[1], direction[2]].map(f64::from));
            // a quaternion and its opposite are one rotation
            let off = (*position - direction).abs().max_element();
            let opposite = if filter == "QUATERNION" { (*position + direction).abs().max_element() } else { off };
            assert!(off.min(opposite) < tolerance, "{filter} {stride}: {position} {direction}");
        }
    }
}

#[test]
fn errors_name_the_place() {
    let (json, buffer) = packed_cube(Positions::Floats, "TRIANGLES", 2);
    let indices = "bufferViews/1/extensions/EXT_meshopt_compression";
    let attributes = "bufferViews/0/extensions/EXT_meshopt_compression";
    let broken = |changes: &[(&str, &str)]| {
        let mut changed = json.clone();
        for (from, to) in changes {
            assert!(changed.contains(from), "{from}");
            changed = changed.replace(from, to);
        }
        error(&changed, &buffer)
    };
    let huge = "4000000000000000000";
    let cases: [(&[(&str, &str)], String); 14] = [
        (
            &[(r#""mode": "TRIANGLES""#, r#""mode": "POINTS""#)],
            format!("{indices}: found the mode `POINTS`, expected `ATTRIBUTES`, `TRIANGLES` or `INDICES`"),
        ),
        (
            &[(r#""mode": "ATTRIBUTES""#, r#""mode": "ATTRIBUTES", "filter": "COLOR""#)],
            format!(
                "{attributes}: found the filter `COLOR`, expected `NONE`, `OCTAHEDRAL`, `QUATERNION` or `EXPONENTIAL`"
            ),
        ),
        (
            &[(r#""mode": "ATTRIBUTES""#, r#""mode": "ATTRIBUTES", "filter": "OCTAHEDRAL""#)],
            format!("{attributes}: found byte stride 12, expected 4 or 8 for the filter `OCTAHEDRAL`"),
        ),
        (
            &[(r#""mode": "TRIANGLES""#, r#""mode": "TRIANGLES", "filter": "EXPONENTIAL""#)],
            format!("{indices}: found the filter `EXPONENTIAL` of indices, expected `NONE`"),
        ),
        (
            &[(r#""byteStride": 12"#, r#""byteStride": 6"#), (r#""byteLength": 96"#, r#""byteLength": 48"#)],
            format!("{attributes}: found byte stride 6, expected a multiple of 4 from 4 to 256"),
        ),
        (
            &[(r#""byteStride": 12"#, r#""byteStride": 260"#), (r#""byteLength": 96"#, r#""byteLength": 2080"#)],
            format!("{attributes}: found byte stride 260, expected a multiple of 4 from 4 to 256"),
        ),
        (
            &[(r#""byteStride": 12"#, r#""byteStride": 0"#), (r#""byteLength": 96"#, r#""byteLength": 0"#)],
            format!("{attributes}: found byte stride 0, expected a multiple of 4 from 4 to 256"),
        ),
        (
            &[
                (r#""byteStride": 2, "count": 36"#, r#""byteStride": 3, "count": 36"#),
                (r#""byteLength": 72"#, r#""byteLength": 108"#),
            ],
            format!("{indices}: found byte stride 3, expected 2 or 4"),
        ),
        (
            &[
                (r#""byteStride": 2, "count": 36"#, r#""byteStride": 2, "count": 35"#),
                (r#""byteLength": 72"#, r#""byteLength": 70"#),
            ],
            format!("{indices}: found 35 indices, expected a multiple of 3"),
        ),
        (
            &[(r#""byteStride": 2, "count": 36"#, r#""byteStride": 2, "count": 39"#)],
            "bufferViews/1: found 72 bytes, expected 39 packed elements of 2".to_owned(),
        ),
        (
            &[
                (r#""byteStride": 2, "count": 36"#, r#""byteStride": 2, "count": 3000000000000000000"#),
                (r#""byteLength": 72"#, r#""byteLength": 6000000000000000000"#),
            ],
            format!(
                "{indices}: found 3000000000000000000 elements in 37 bytes, expected at least 1000000000000000017 bytes"
            ),
        ),
        (
            &[
                (r#""count": 8, "mode""#, r#""count": 1000000000000000000, "mode""#),
                (r#""byteLength": 96"#, r#""byteLength": 12000000000000000000"#),
            ],
            format!(
                "{attributes}: found 1000000000000000000 elements in 237 bytes, expected at least 187500000000000033 bytes"
            ),
        ),
        (
            &[(r#""count": 8, "mode""#, &format!(r#""count": {huge}, "mode""#))],
            format!("bufferViews/0: found 96 bytes, expected {huge} packed elements of 12"),
        ),
        (
            &[(r#""buffer": 0, "byteLength": 237"#, r#""buffer": 0, "byteLength": 239"#)],
            format!("{attributes}: found packed bytes that are damaged, expected 8 elements of 12 bytes"),
        ),
    ];
    for (changes, expected) in cases {
        assert_eq!(broken(changes), format!("file: {expected}"));
    }
    let mut other = buffer.clone();
    other[0] = 0xa7;
    assert_eq!(
        error(&json, &other),
        format!("file: {attributes}: found packed bytes without a known head, expected attributes of version 0 or 1")
    );
}

#[test]
fn the_same_bytes_are_not_unpacked_again_and_again() {
    let (json, buffer) = packed_cube(Positions::Floats, "TRIANGLES", 2);
    // a third view of all that the first one has, in a second primitive
    let first = json.find(r#"{"buffer": 1"#).expect("a view");
    let end = json[first..].find("}}},").expect("its end") + first + 3;
    let mut again = json.clone();
    again.insert_str(json.find("}}}]").expect("the last view's end") + 3, &format!(", {}", &json[first..end]));
    let again =
        again.replace(r#""indices": 1}"#, r#""indices": 1}, {"attributes": {"POSITION": 2}, "indices": 1}"#).replace(
            r#""accessors": ["#,
            r#""accessors": [{"bufferView": 2, "componentType": 5126, "count": 8, "type": "VEC3"}, "#,
        );
    let again = again
        .replace(r#""POSITION": 2"#, r#""POSITION": 9"#)
        .replace(r#""POSITION": 0"#, r#""POSITION": 1"#)
        .replace(r#""indices": 1"#, r#""indices": 2"#)
        .replace(r#""POSITION": 9"#, r#""POSITION": 0"#);
    let place = "bufferViews/2/extensions/EXT_meshopt_compression";
    assert_eq!(
        error(&again, &buffer),
        format!("file: {place}: found packed bytes that other views have, expected bytes of its own")
    );
}
