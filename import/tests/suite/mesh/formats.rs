//! OBJ, STL and PLY: the same cube in every format, and the corners of each.

use glam::DVec3;
use planecut_import::mesh::{IndexedMesh, MeshError, MeshFormat, Precision, read_mesh};

use super::support::{assert_sound, check, obj, ply, stl_ascii, stl_binary};

fn read(bytes: impl AsRef<[u8]>, format: MeshFormat) -> Result<IndexedMesh, MeshError> {
    read_mesh(bytes.as_ref(), format, "file")
}

fn error(bytes: impl AsRef<[u8]>, format: MeshFormat) -> String {
    let message = read(bytes, format).expect_err("the file is broken").to_string();
    assert!(!message.contains('\n'), "one line: {message:?}");
    message
}

#[test]
fn a_cube_is_the_same_in_every_format() {
    let files: [(MeshFormat, Vec<u8>, Precision); 6] = [
        (MeshFormat::Obj, obj().into_bytes(), Precision::Double),
        (MeshFormat::Stl, stl_binary(), Precision::Single),
        (MeshFormat::Stl, stl_ascii().into_bytes(), Precision::Single),
        (MeshFormat::Ply, ply("ascii"), Precision::Single),
        (MeshFormat::Ply, ply("binary_little_endian"), Precision::Single),
        (MeshFormat::Ply, ply("binary_big_endian"), Precision::Single),
    ];
    for (format, bytes, precision) in files {
        let mesh = read(bytes, format).expect("the file is whole");
        assert_eq!((mesh.positions.len(), mesh.triangles.len(), mesh.precision), (8, 12, precision), "{format:?}");
        assert_eq!(mesh.objects.len(), 1);
        assert_eq!(mesh.objects[0].triangles, 0..12);
        assert_sound(&mesh, 1.0);
    }
}

#[test]
fn formats_are_known_by_extension() {
    let known = ["obj", "STL", "Ply", "glb", "gltf"].map(MeshFormat::from_extension);
    let formats = [MeshFormat::Obj, MeshFormat::Stl, MeshFormat::Ply, MeshFormat::Gltf, MeshFormat::Gltf];
    assert_eq!(known, formats.map(Some));
    assert_eq!(MeshFormat::from_extension("map"), None);
}

#[test]
fn obj_corners_may_carry_other_indices_and_count_backwards() {
    let text = "v 0 0 0\r\nv 1 0 0 # corner\r\nv 0 1 0 0.5 0.5 0.5\r\nv 0 0 1\r\nvt 0 0\r\nvn 0 0 1\r\n\
                f 1/1 3/1 2/1\r\nf 1//1 2//1 4//1\r\nf 2/1/1 3/1/1 4/1/1\r\nf -2 \\\r\n -4 -1\r\n";
    let mesh = read(text, MeshFormat::Obj).expect("the file is whole");
    assert_eq!(mesh.triangles, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]);
    assert_eq!(mesh.positions[1], DVec3::X);
    assert_sound(&mesh, 1.0 / 6.0);
}

#[test]
fn obj_polygons_keep_every_corner() {
    // A prism over an L with a corner on one of its sides: the other file's side has that corner too, so nothing may be lost.
    let outline = [(0, 0), (1, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)];
    let mut text = String::new();
    for z in 0..2 {
        outline.iter().for_each(|(x, y)| text += &format!("v {x} {y} {z}\n"));
    }
    let n = outline.len();
    let line =
        |corners: Vec<usize>| format!("f{}\n", corners.iter().map(|v| format!(" {}", v + 1)).collect::<String>());
    text += &line((0..n).rev().collect());
    text += &line((n..2 * n).collect());
    for k in 0..n {
        let l = (k + 1) % n;
        text += &line(vec![k, l, n + l, n + k]);
    }
    let mesh = read(text, MeshFormat::Obj).expect("the file is whole");
    assert_eq!(mesh.triangles.len(), 2 * (n - 2) + 2 * n);
    assert_sound(&mesh, 3.0);
}

#[test]
fn obj_objects_come_before_groups() {
    let parts = "v 0 0 0\nv 1 0 0\nv 0 1 0\ng left wing\nf 1 2 3\no  body \ng a\nf 1 2 3\ng b\nf 1 2 3\no tail\no end\nf 3 2 1\n";
    let names = |text: &str| -> Vec<(Option<String>, std::ops::Range<usize>)> {
        let mesh = read(text, MeshFormat::Obj).expect("the file is whole");
        mesh.objects.into_iter().map(|o| (o.name, o.triangles)).collect()
    };
    let named = |name: &str| Some(name.to_owned());
    assert_eq!(names(parts), [(None, 0..1), (named("body"), 1..3), (named("end"), 3..4)]);
    let groups: String = parts.lines().filter(|l| !l.starts_with('o')).map(|l| format!("{l}\n")).collect();
    assert_eq!(names(&groups), [(named("left wing"), 0..1), (named("a"), 1..2), (named("b"), 2..4)]);
}

#[test]
fn obj_errors_name_the_line() {
    let start = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let cases = [
        ("f 1 2 4\n", "file:4: found `4`, expected one of the 3 vertices defined so far"),
        ("f 1 2 0\n", "file:4: found `0`, expected one of the 3 vertices defined so far"),
        ("\nf 1 2 -4\n", "file:5: found `-4`, expected one of the 3 vertices defined so far"),
        ("f 1 2\n", "file:4: found a face with 2 corners, expected at least 3"),
        ("v 0 nan 0\n", "file:4: found `nan`, expected a finite number"),
        ("v 0 0\n", "file:4: found nothing, expected a finite number"),
        ("f 1 \\\n2 \\\n3\nv x 0 0\n", "file:7: found `x`, expected a finite number"),
        ("", "file: found no triangles, expected at least one"),
    ];
    for (text, expected) in cases {
        assert_eq!(error(format!("{start}{text}"), MeshFormat::Obj), expected);
    }
}

#[test]
fn stl_corners_merge_where_equal_and_only_there() {
    let text = "solid a\nfacet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet\nendsolid a\n\
                SOLID b\nFACET NORMAL 0 0 1 OUTER LOOP VERTEX -0 0 -0.0 VERTEX 0 1 0 VERTEX -1 1e-30 0 ENDLOOP ENDFACET\n";
    let mesh = read(text, MeshFormat::Stl).expect("the file is whole");
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
    let names: Vec<_> = mesh.objects.iter().map(|o| o.name.as_deref()).collect();
    assert_eq!(names, [Some("a"), Some("b")]);
}

#[test]
fn a_binary_stl_that_begins_with_solid_is_told_by_its_length() {
    let mut bytes = stl_binary();
    bytes[..5].copy_from_slice(b"solid");
    assert_sound(&read(bytes, MeshFormat::Stl).expect("the file is whole"), 1.0);
}

#[test]
fn stl_errors_name_the_place() {
    let mut claims_billions = stl_binary();
    claims_billions[80..84].fill(0xff);
    assert_eq!(
        error(claims_billions, MeshFormat::Stl),
        "file: byte 80: found a file of 684 bytes, expected 214748364834 bytes for the number of facets in the header, or `solid`"
    );
    let mut not_finite = stl_binary();
    not_finite[84 + 50 + 12..84 + 50 + 16].copy_from_slice(&f32::NAN.to_le_bytes());
    assert_eq!(
        error(not_finite, MeshFormat::Stl),
        "file: byte 146: found the corner [NaN, 0, 0], expected finite coordinates"
    );
    assert_eq!(
        error("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 z\n", MeshFormat::Stl),
        "file:4: found `z`, expected a finite number"
    );
    assert_eq!(
        error("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nendloop\n", MeshFormat::Stl),
        "file:5: found `endloop`, expected `vertex`"
    );
    assert_eq!(
        error("", MeshFormat::Stl),
        "file: byte 0: found a file of 0 bytes, expected a header of 84 bytes, or `solid`"
    );
}

#[test]
fn ply_errors_name_the_place() {
    let header = |vertices: &str, faces: &str| {
        format!(
            "ply\nformat ascii 1.0\nelement vertex {vertices}\nproperty double x\nproperty double y\nproperty double z\n\
             element face {faces}\nproperty list uchar int vertex_index\nend_header\n"
        )
    };
    let three = "0 0 0\n1 0 0\n0 1 0\n";
    let whole = read(format!("{}{three}3 0 1 2\n", header("3", "1")), MeshFormat::Ply).expect("the file is whole");
    assert_eq!(whole.precision, Precision::Double);
    let cases = [
        (
            format!("{}{three}3 0 1 3\n", header("3", "1")),
            "file:13: found vertex index 3, expected a whole number from 0, below 3",
        ),
        (
            format!("{}{three}3 0 1 -1\n", header("3", "1")),
            "file:13: found vertex index -1, expected a whole number from 0, below 3",
        ),
        (format!("{}{three}2 0 1\n", header("3", "1")), "file:13: found a face with 2 corners, expected at least 3"),
        (
            format!("{}{three}", header("4000000000", "1")),
            "file:10: found 18 bytes for 4000000000 records of element `vertex`, expected at least 12000000000",
        ),
        (header("x", "1"), "file:3: found `x`, expected the number of records"),
        (
            "ply\nformat ascii 1.0\nproperty float x\n".to_owned(),
            "file:3: found `property` first, expected `element` before it",
        ),
        (
            "ply\nformat utf8 1.0\n".to_owned(),
            "file:2: found `utf8`, expected `ascii`, `binary_little_endian` or `binary_big_endian`",
        ),
        ("plx\n".to_owned(), "file:1: found `plx`, expected `ply`"),
        ("ply\nformat ascii 1.0\nend_header\n".to_owned(), "file: found no element `vertex`, expected one"),
    ];
    for (text, expected) in cases {
        assert_eq!(error(text, MeshFormat::Ply), expected);
    }
    let mut cut = ply("binary_little_endian");
    cut.truncate(cut.len() - 1);
    assert!(error(&cut, MeshFormat::Ply).ends_with("found 3 bytes, expected 4 for a number"));
}

#[test]
fn an_open_mesh_is_read_and_then_found_open() {
    let text: String = obj().lines().take(15).map(|l| format!("{l}\n")).collect();
    let mesh = read(text, MeshFormat::Obj).expect("the file is whole");
    assert!(!check(&mesh).topology.watertight);
}
