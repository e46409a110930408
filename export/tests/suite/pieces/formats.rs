//! Models in blocks through every format.

use glam::DVec3;
use planecut_export::{ExportOptions, Format, Projection, Shading, TextureMapping, encode};
use planecut_testkit::meshes;

use super::readers::{self, Read, options};
use super::support::{
    assert_closed_by_position, assert_index_closed, assert_measures, assert_one_fan_at_each_vertex, blocks, encoded,
    triangles,
};

/// The corners of pieces are written in the order of the pieces, to the last bit.
fn assert_same_triangles(read: &Read, pieces: &[planecut_csg::Mesh], scale: f64, what: &str) {
    let expected = pieces.iter().flat_map(triangles).map(|(corners, _)| corners.map(|corner| corner * scale));
    let key = |corners: [DVec3; 3]| corners.map(|corner| (corner + DVec3::ZERO).to_array().map(f64::to_bits));
    let mut expected: Vec<_> = expected.map(key).collect();
    let mut found: Vec<_> = read.triangles().into_iter().map(key).collect();
    expected.sort_unstable();
    found.sort_unstable();
    assert!(expected == found, "{what}: other triangles");
}

#[test]
fn obj_and_ply_are_watertight_by_index() {
    for seed in 0..8 {
        let (pieces, whole) = blocks(seed, 1.0, DVec3::ZERO);
        for (format, text) in [(Format::Obj, false), (Format::Ply, false), (Format::Ply, true)] {
            let what = format!("seed {seed}, {format:?}, text {text}");
            let scale = if text { 25.4 } else { 1.0 };
            let (bytes, written) = encoded(&pieces, format, &options(text, false, scale));
            let read = if format == Format::Obj { readers::obj(&bytes) } else { readers::ply(&bytes) };
            assert_index_closed(&read.indices, &what);
            assert_one_fan_at_each_vertex(&read.indices, &what);
            assert_same_triangles(&read, &pieces, scale, &what);
            assert_measures(read.with_materials(), &whole, scale, 1e-9, &what);
            assert_eq!((written.pieces, written.open_edges), (pieces.len(), 0), "{what}");
            assert_eq!(written.vertices, read.positions.len() as u64, "{what}");
            assert_eq!(written.triangles, read.indices.len() as u64, "{what}");
        }
    }
}

#[test]
fn stl_is_watertight_by_position() {
    let mut gone = 0;
    for seed in 0..8 {
        // far out single precision has few places: edges go
        let shift = if seed < 4 { DVec3::ZERO } else { DVec3::new(300_000.3, -700_000.7, 0.1) };
        let (pieces, whole) = blocks(seed, 1.0, shift);
        let mut found = Vec::new();
        for text in [false, true] {
            let what = format!("seed {seed}, text {text}");
            let read = readers::stl(&encoded(&pieces, Format::Stl, &options(text, false, 0.5)).0);
            assert_closed_by_position(&read.triangles(), &what);
            found.push(read.triangles());
            if seed < 4 {
                let expected: f64 = super::support::measures(triangles(&whole)).0 / 8.0;
                let (volume, _) = super::support::measures(read.with_materials());
                assert!((volume / expected - 1.0).abs() < 1e-5, "{what}: {volume}, expected {expected}");
            }
        }
        assert_eq!(found[0], found[1], "seed {seed}");
        let all: usize = pieces.iter().map(|piece| piece.triangles.len()).sum();
        assert!(found[0].len() == all || seed >= 4, "seed {seed}: edges that go");
        gone += all - found[0].len();
    }
    assert!(gone > 0, "no edge has gone");
}

/// A closed mesh of one piece makes the same file as if it were a part: on an integer grid also in single precision.
#[test]
fn one_closed_piece_is_as_a_part() {
    let texture = Some(TextureMapping { projection: Projection::Box, size: 1.0 });
    let smooth = Shading::Smooth { crease: 100.0 };
    let all = [
        ExportOptions::default(),
        ExportOptions { text: true, ..ExportOptions::default() },
        ExportOptions { texture, tangents: true, shading: smooth, vertex_colors: true, ..ExportOptions::default() },
        ExportOptions { scale: 0.0254, quantize: true, meshopt: cfg!(feature = "meshopt"), ..ExportOptions::default() },
    ];
    let mesh = meshes::cube_with_hole();
    for options in all {
        for format in [Format::Glb, Format::Gltf, Format::Obj, Format::Ply, Format::Stl] {
            let part = planecut_export::Part::new("piece 0", &mesh);
            let expected = match (format, options.text) {
                (Format::Stl, true) => planecut_export::encode_parts(
                    &[planecut_export::Part { name: "planecut", ..part }],
                    format,
                    &options,
                ),
                _ => planecut_export::encode_parts(&[part], format, &options),
            };
            let (bytes, written) = encoded(std::slice::from_ref(&mesh), format, &options);
            assert!(bytes == expected.expect("encoded"), "{format:?}, {options:?}");
            assert_eq!(
                (written.vertices, written.triangles),
                (mesh.positions.len() as u64, mesh.triangles.len() as u64)
            );
        }
    }
}

/// Normals and texture coordinates split vertices of PLY; OBJ has indices of its own for them.
#[test]
fn attributes_leave_obj_watertight() {
    let (pieces, whole) = blocks(3, 1.0, DVec3::ZERO);
    let texture = Some(TextureMapping { projection: Projection::Box, size: 1.0 });
    let options = ExportOptions { texture, shading: Shading::Smooth { crease: 30.0 }, ..ExportOptions::default() };
    let (bytes, _) = encoded(&pieces, Format::Obj, &options);
    let read = readers::obj(&bytes);
    assert_index_closed(&read.indices, "OBJ");
    assert_measures(read.with_materials(), &whole, 1.0, 1e-9, "OBJ");
    let text = String::from_utf8(bytes).expect("UTF-8");
    let lines = |key: &str| text.lines().filter(|line| line.starts_with(key)).count();
    let largest = |place: usize| -> usize {
        let corners = text.lines().filter_map(|line| line.strip_prefix("f ")).flat_map(|line| line.split(' '));
        corners
            .map(|corner| corner.split('/').nth(place).expect("an index").parse().expect("a number"))
            .max()
            .expect("one")
    };
    assert_eq!((largest(1), largest(2)), (lines("vt "), lines("vn ")));
    for text in [false, true] {
        let read = readers::ply(&encoded(&pieces, Format::Ply, &ExportOptions { text, ..options.clone() }).0);
        assert_closed_by_position(&read.triangles(), "PLY");
        assert_measures(read.with_materials(), &whole, 1.0, 1e-9, "PLY");
    }
}

#[test]
fn no_piece_and_empty_pieces_are_valid_files() {
    let options = ExportOptions::default();
    let empty = planecut_csg::Mesh::default();
    let cube = meshes::box_mesh(DVec3::ZERO, DVec3::ONE, "stone");
    for pieces in [vec![], vec![empty.clone()], vec![empty.clone(), cube, empty]] {
        let triangles = pieces.iter().map(|piece| piece.triangles.len()).sum::<usize>();
        assert_eq!(readers::obj(&encoded(&pieces, Format::Obj, &options).0).indices.len(), triangles);
        assert_eq!(readers::ply(&encoded(&pieces, Format::Ply, &options).0).indices.len(), triangles);
        assert_eq!(readers::stl(&encoded(&pieces, Format::Stl, &options).0).indices.len(), triangles);
        let (read, json) = readers::gltf(&encoded(&pieces, Format::Glb, &options).0);
        assert_eq!(read.indices.len(), triangles);
        assert_eq!(json["nodes"].as_array().expect("nodes").len(), pieces.len() + 1);
    }
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let (pieces, _) = blocks(5, 1.0, DVec3::ZERO);
    let smooth = ExportOptions { shading: Shading::Smooth { crease: 40.0 }, ..ExportOptions::default() };
    for format in [Format::Glb, Format::Obj, Format::Ply, Format::Stl] {
        for options in [ExportOptions::default(), smooth.clone()] {
            let with = |threads: usize| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
                pool.install(|| encoded(&pieces, format, &options).0)
            };
            assert!(with(1) == with(5), "{format:?}");
        }
    }
}

/// The materials of an OBJ file are those of its library, each once.
#[test]
fn the_library_has_all_materials() {
    let (pieces, _) = blocks(2, 1.0, DVec3::ZERO);
    let mut mtl = Vec::new();
    planecut_export::write_mtl_of_pieces(&super::support::Held(pieces.clone()), &mut mtl).expect("written");
    let mtl = String::from_utf8(mtl).expect("UTF-8");
    let mut named: Vec<&str> = mtl.lines().filter_map(|line| line.strip_prefix("newmtl ")).collect();
    named.sort_unstable();
    assert_eq!(named, ["brick", "stone"]);
    let read = readers::obj(&encoded(&pieces, Format::Obj, &ExportOptions::default()).0);
    assert!(read.materials.iter().all(|name| named.contains(&name.as_str())));
    encode(&pieces[0], Format::Obj, &ExportOptions::default()).expect("a piece alone is a mesh as well");
}
