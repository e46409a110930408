//! Texture coordinates of mesh files: what is read of them, and what of damaged ones is said.

use glam::DVec2;
use planecut_csg::{MeshBody, Model};
use planecut_import::mesh::{IndexedMesh, MeshFormat, SolidOptions, read_mesh, read_solid, read_textured_mesh};
use planecut_testkit::textured::TexturedMesh;

fn read(bytes: &[u8], format: MeshFormat) -> IndexedMesh {
    read_textured_mesh(bytes, format, "m").unwrap_or_else(|error| panic!("{error}"))
}

#[track_caller]
fn refused(bytes: &[u8], format: MeshFormat, message: &str) {
    let error = read_textured_mesh(bytes, format, "m").expect_err("refused");
    assert_eq!(error.to_string(), message);
    assert!(read_mesh(bytes, format, "m").is_ok(), "nobody asked for them");
}

/// Coordinates with `v` up.
fn up(corners: Option<[DVec2; 3]>) -> Option<[[f64; 2]; 3]> {
    corners.map(|corners| corners.map(|at| [at.x, 1.0 - at.y]))
}

const CORNERS: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\n";

#[test]
fn corners_of_obj_name_their_coordinates_from_either_end() {
    let text = format!(
        "{CORNERS}vt 0.25 0.5\nvt 1 0 7\nvt 0.75\nf 1/1 2/2/1 3/-1\nf 1/1 2/2 3\nf 1//1 2 3/\nf 1/3 2/2 3/1 4/-3\n"
    );
    let mesh = read(text.as_bytes(), MeshFormat::Obj);
    let own = Some([[0.25, 0.5], [1.0, 0.0], [0.75, 0.0]]);
    let quad = [[0.75, 0.0], [1.0, 0.0], [0.25, 0.5], [0.25, 0.5]];
    let found: Vec<_> = mesh.textures.iter().copied().map(up).collect();
    assert_eq!(found[..3], [own, None, None], "where one has none the triangle has none");
    for (triangle, found) in mesh.triangles.iter().zip(&found).skip(3) {
        assert_eq!(*found, Some(triangle.map(|corner| quad[corner as usize])));
    }
    let plain = read_mesh(text.as_bytes(), MeshFormat::Obj, "m").expect("a mesh");
    assert_eq!(plain, IndexedMesh { textures: Vec::new(), ..mesh });
}

#[test]
fn what_is_wrong_with_coordinates_is_said_with_its_line() {
    for (statements, line, found, expected) in [
        ("f 1/2 2/1 3/1\n", 7, "`1/2`", "one of the 1 texture coordinates defined so far"),
        ("f 1/1 2/0 3/1\n", 7, "`2/0`", "one of the 1 texture coordinates defined so far"),
        ("f 1/1 2/1/1 3/-2/1\n", 7, "`3/-2/1`", "one of the 1 texture coordinates defined so far"),
        ("f 1/1 2/x 3/1\n", 7, "`2/x`", "one of the 1 texture coordinates defined so far"),
        ("vt\nf 1/1 2/1 3/1\n", 7, "nothing", "a finite number"),
        ("vt 1 nan\nf 1/1 2/1 3/1\n", 7, "`nan`", "a finite number"),
    ] {
        let text = format!("{CORNERS}vt 0.5 0.5\n{statements}");
        refused(text.as_bytes(), MeshFormat::Obj, &format!("m:{line}: found {found}, expected {expected}"));
    }
}

#[test]
fn vertices_and_faces_of_ply_have_coordinates() {
    let file = |names: [&str; 2], rows: &str, list: &str, face: &str| {
        format!(
            "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
             property float {}\nproperty float {}\nelement face 1\nproperty list uchar int vertex_indices\n{list}end_header\n\
             {rows}{face}\n",
            names[0], names[1]
        )
    };
    let rows = "0 0 0 0.5 0.25\n1 0 0 1 0\n1 1 0 0 1\n0 1 0 2 3\n";
    let own = Some([[0.5, 0.25], [1.0, 0.0], [0.0, 1.0]]);
    for names in [["s", "t"], ["u", "v"], ["texture_u", "texture_v"]] {
        let mesh = read(file(names, rows, "", "3 0 1 2").as_bytes(), MeshFormat::Ply);
        assert_eq!(mesh.textures.iter().copied().map(up).collect::<Vec<_>>(), [own], "{names:?}");
    }
    assert!(read(file(["s", "u"], rows, "", "3 0 1 2").as_bytes(), MeshFormat::Ply).textures.is_empty());
    let list = "property list uchar float texcoord\n";
    let of_face = read(file(["s", "t"], rows, list, "4 0 1 2 3 8 0 0 1 0 1 1 0 1").as_bytes(), MeshFormat::Ply);
    let quad = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    for (triangle, found) in of_face.triangles.iter().zip(&of_face.textures) {
        assert_eq!(up(*found), Some(triangle.map(|corner| quad[corner as usize])), "those of faces come first");
    }
    let short = file(["s", "t"], rows, list, "3 0 1 2 4 0 0 1 0");
    refused(short.as_bytes(), MeshFormat::Ply, "m:17: found 4 numbers of `texcoord`, expected 6 for 3 corners");
}

#[test]
fn a_gltf_mesh_has_the_coordinates_of_its_corners() {
    let ball = TexturedMesh::ball(5, 6, 1);
    for (node, is_mirrored) in [("", false), (r#""scale": [1, -1, 1]"#, true)] {
        let mesh = read(&ball.to_glb(node), MeshFormat::Gltf);
        assert_eq!(mesh.positions.len(), ball.positions.len());
        for (triangle, found) in ball.triangles.iter().zip(&mesh.textures) {
            let [a, b, c] = triangle.map(|[_, at]| ball.coordinates[at].to_array());
            assert_eq!(up(*found), Some(if is_mirrored { [a, c, b] } else { [a, b, c] }));
        }
        let plain = read_mesh(&ball.to_glb(node), MeshFormat::Gltf, "m").expect("a mesh");
        assert_eq!(plain, IndexedMesh { textures: Vec::new(), ..mesh });
    }
    // bytes of another number of coordinates, and no number
    let mut bytes = ball.to_glb("");
    let count = 3 * ball.triangles.len();
    let text = format!("\"count\":{count},\"type\":\"VEC2\"");
    let place = bytes.windows(text.len()).position(|window| window == text.as_bytes()).expect("an accessor");
    bytes[place..place + text.len()]
        .copy_from_slice(text.replace(&count.to_string(), &(count - 1).to_string()).as_bytes());
    let message = format!(
        "m: meshes/0/primitives/0: found {} texture coordinates, expected {count}, as many as positions",
        count - 1
    );
    refused(&bytes, MeshFormat::Gltf, &message);
    let mut bytes = ball.to_glb("");
    let end = bytes.len();
    bytes[end - 4..].copy_from_slice(&f32::NAN.to_le_bytes());
    refused(&bytes, MeshFormat::Gltf, "m: accessors/1: found the texture coordinate NaN, expected finite ones");
}

fn solid(ball: &TexturedMesh, textures: bool) -> Model {
    let options = SolidOptions { textures, ..SolidOptions::default() };
    read_solid(ball.to_obj().as_bytes(), MeshFormat::Obj, "m", &options).expect("a ball").model
}

#[test]
fn an_object_with_coordinates_is_a_mesh_also_where_it_is_convex() {
    let ball = TexturedMesh::ball(2, 4, 2);
    let plain = solid(&ball, false);
    assert!(!plain.tree.has_meshes());
    let model = solid(&ball, true);
    let leaf: &MeshBody = model.tree.meshes().next().expect("a mesh");
    assert_eq!(leaf.textures().len(), leaf.materials().len());
    let surfaces = leaf.mesh().surfaces();
    for (number, triangle) in leaf.mesh().triangles().iter().enumerate() {
        let axes = leaf.textures()[surfaces[number] as usize].expect("a texture");
        for (corner, [_, at]) in triangle.iter().zip(ball.triangles[number]) {
            let found = axes.at(leaf.mesh().positions()[*corner as usize]);
            let expected = DVec2::new(ball.coordinates[at].x, 1.0 - ball.coordinates[at].y);
            assert!(found.abs_diff_eq(expected, 1e-12), "{found} {expected}");
        }
    }
}
