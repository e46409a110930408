//! Texture coordinates of meshes that are read, cut, moved and written: everywhere those of the file, interpolated within its triangles.

use glam::{DMat3, DVec2, DVec3};
use planecut_csg::{Brush, FaceSource, MaterialId, Mesh, Model, Transform, Tree, evaluate};
use planecut_export::{ExportOptions, Format, Part, Projection, Shading, TextureMapping, encode_parts};
use planecut_import::mesh::{MeshFormat, SolidOptions, read_solid};
use planecut_import::model::{ModelOptions, read_model};
use planecut_testkit::textured::TexturedMesh;

use super::support::written;

/// The corners of a triangle with their texture coordinates, `v` up.
type Triangle = ([DVec3; 3], [DVec2; 3]);

fn options(shading: Shading) -> ExportOptions {
    let texture = Some(TextureMapping { projection: Projection::Source, size: 1.0 });
    ExportOptions { texture, shading, text: true, ..ExportOptions::default() }
}

fn read(bytes: &[u8], format: MeshFormat) -> Model {
    let options = SolidOptions { textures: true, ..SolidOptions::default() };
    read_solid(bytes, format, "m", &options).unwrap_or_else(|error| panic!("{error}")).model
}

fn built(model: &Model) -> (Mesh, Vec<FaceSource>) {
    let (split, sources) = model.split_by_source(&[], false);
    (evaluate(&split).expect("evaluated").mesh, sources)
}

/// What a GLB holds.
fn of_glb(part: Part<'_>) -> Vec<Triangle> {
    let file = written(&[part], &ExportOptions { text: false, ..options(Shading::Flat) });
    let primitives = file.parts.iter().flatten();
    let triangles = primitives.flat_map(|primitive| primitive.triangles.iter().map(|t| primitive.corners(*t)));
    let up = |at: DVec2| DVec2::new(at.x, 1.0 - at.y);
    triangles.map(|t| (t.map(|c| c.position), t.map(|c| up(c.texture.expect("coordinates"))))).collect()
}

/// The numbers of lines that begin with a word.
fn lines<'t>(text: &'t str, word: &str) -> impl Iterator<Item = Vec<f64>> + use<'t> {
    let word = format!("{word} ");
    let numbers = |line: &str| line.split(' ').map(|number| number.parse().expect("a number")).collect();
    text.lines().filter_map(move |line| line.strip_prefix(&word).map(numbers))
}

/// What an OBJ file holds, and how many places in the picture it names.
fn of_obj(part: Part<'_>) -> (Vec<Triangle>, usize) {
    let text =
        String::from_utf8(encode_parts(&[part], Format::Obj, &options(Shading::Flat)).expect("encoded")).expect("text");
    let positions: Vec<DVec3> = lines(&text, "v").map(|v| DVec3::from_slice(&v)).collect();
    let coordinates: Vec<DVec2> = lines(&text, "vt").map(|v| DVec2::from_slice(&v)).collect();
    let corner = |word: &str| -> (DVec3, DVec2) {
        let (vertex, at) = word.split_once('/').expect("both");
        let [vertex, at] = [vertex, at].map(|number| number.parse::<usize>().expect("a number") - 1);
        (positions[vertex], coordinates[at])
    };
    let triangle = |line: &str| {
        let corners: Vec<(DVec3, DVec2)> = line.split(' ').map(corner).collect();
        ([0, 1, 2].map(|k| corners[k].0), [0, 1, 2].map(|k| corners[k].1))
    };
    (text.lines().filter_map(|line| line.strip_prefix("f ")).map(triangle).collect(), coordinates.len())
}

/// What a PLY file holds, and how many vertices.
fn of_ply(part: Part<'_>) -> (Vec<Triangle>, usize) {
    let text =
        String::from_utf8(encode_parts(&[part], Format::Ply, &options(Shading::Flat)).expect("encoded")).expect("text");
    let (header, body) = text.split_once("end_header\n").expect("a header");
    let count = lines(header, "element vertex").next().expect("a count")[0] as usize;
    let rows: Vec<Vec<f64>> =
        body.lines().map(|line| line.split(' ').map(|number| number.parse().expect("a number")).collect()).collect();
    let corner = |number: f64| {
        let row = &rows[number as usize];
        (DVec3::from_slice(row), DVec2::new(row[3], row[4]))
    };
    let triangle = |row: &Vec<f64>| {
        let corners = [1, 2, 3].map(|k| corner(row[k]));
        (corners.map(|(position, _)| position), corners.map(|(_, at)| at))
    };
    (rows[count..].iter().map(triangle).collect(), count)
}

/// Sees that triangles have the coordinates of the mesh that they lie in; of others there are as many as are said.
#[track_caller]
fn check(source: &TexturedMesh, triangles: &[Triangle], room: f64, error: f64, others: usize) {
    let mut found_others = 0;
    for (corners, found) in triangles {
        let expected = source.at(*corners, room);
        let is_right = |expected: &[DVec2; 3]| (0..3).all(|k| expected[k].abs_diff_eq(found[k], error));
        found_others += usize::from(expected.is_empty());
        assert!(expected.is_empty() || expected.iter().any(is_right), "{corners:?}: {found:?}, not {expected:?}");
    }
    assert_eq!(found_others, others, "of {}", triangles.len());
    assert!(triangles.len() > others);
}

/// Sees that a mesh has the coordinates of a source in all formats. Triangles of other sources are those with `normal`.
#[track_caller]
fn check_written(source: &TexturedMesh, (mesh, sources): &(Mesh, Vec<FaceSource>), size: f64, others: usize) {
    let part = Part { name: "m", mesh, sources };
    // positions in single precision, beside coordinates that grow by some pictures along each unit of size
    check(source, &of_glb(part), 1e-6 * size, 2e-5, others);
    check(source, &of_obj(part).0, 1e-9 * size, 1e-6, others);
    check(source, &of_ply(part).0, 1e-9 * size, 1e-6, others);
}

fn maps() -> [Transform; 4] {
    let mirrored = DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0));
    let sheared = DMat3::from_cols(DVec3::X, DVec3::new(0.5, 1.0, 0.0), DVec3::new(-0.25, 0.75, 1.5));
    let both = DMat3::from_cols(DVec3::new(0.0, 1.5, 0.25), DVec3::new(1.0, 0.0, 0.0), DVec3::new(0.0, 0.5, 0.75));
    let linear = [DMat3::IDENTITY, mirrored, sheared, both];
    linear.map(|linear| Transform::new(linear, DVec3::new(0.25, -3.0, 0.5)).expect("a map"))
}

/// A box that takes a part of whatever is around its corner, and its triangles in what is left.
fn cutter(corner: DVec3) -> Tree {
    Tree::from(Brush::cuboid(corner, corner + 100.0, MaterialId(0)))
}

#[test]
fn what_a_cut_leaves_of_a_mesh_keeps_its_coordinates() {
    let ball = TexturedMesh::ball(7, 11, 1);
    assert!(evaluate(&read(ball.to_obj().as_bytes(), MeshFormat::Obj)).expect("a ball").solid.volume > 3.0);
    for (bytes, format) in [(ball.to_obj().into_bytes(), MeshFormat::Obj), (ball.to_glb(""), MeshFormat::Gltf)] {
        let model = read(&bytes, format);
        let whole = built(&model);
        assert_eq!(whole.0.triangles.len(), ball.triangles.len());
        check_written(&ball, &whole, 1.0, 0);
        for map in maps() {
            let moved = ball.moved(|p| map.point(p));
            let tree = model.tree.clone().transformed(&map).expect("moved");
            let center = map.point(DVec3::new(0.1, 0.05, -0.15));
            let cut = built(&Model { tree: tree - cutter(center), ..model.clone() });
            let (mesh, sources) = &cut;
            let of_cutter = |face: &u32| sources[mesh.faces[*face as usize].material.0 as usize].brush == 1;
            let others = mesh.triangle_faces.iter().filter(|face| of_cutter(face)).count();
            assert!(others >= 3);
            check_written(&moved, &cut, 1.0, others);
        }
    }
}

#[test]
fn a_mirrored_node_of_a_gltf_file_mirrors_its_picture() {
    let ball = TexturedMesh::ball(6, 8, 2);
    let model = read(&ball.to_glb(r#""scale": [-2, 1, 0.5], "translation": [5, 0, 1]"#), MeshFormat::Gltf);
    // y is up in the file
    let moved = ball.moved(|p| DVec3::new(-2.0 * p.x + 5.0, 0.5 * p.y - 1.0, p.z));
    let cut = built(&Model { tree: model.tree.clone() - cutter(DVec3::splat(90.0)), ..model });
    check_written(&moved, &cut, 1.0, 0);
}

#[test]
fn meshes_that_a_model_names_are_moved_with_their_pictures() {
    let ball = TexturedMesh::ball(6, 9, 3);
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("ball.obj"), ball.to_obj()).expect("a file");
    let text = br#"{"planecut": 1, "model": {"difference": [{"union": [
        {"mesh": {"file": "ball.obj", "scale": 2}, "matrix": [[0, 1, 0, 3], [1, 0, 0, 0], [0, 0, 1, 0]]},
        {"mesh": "ball.obj", "matrix": [[1, 0, 0, -3], [0, 1, 0.5, 0], [0, 0, 1, 0]]}
    ]}, {"box": {"min": [-9, 0, 0], "max": [9, 9, 9]}}]}}"#;
    let options = ModelOptions { folder: folder.path().to_owned(), textures: true, ..ModelOptions::default() };
    let model = read_model(text, "m.json", &options).expect("a model").model;
    let (mesh, sources) = built(&model);
    let all = of_obj(Part { name: "m", mesh: &mesh, sources: &sources }).0;
    let (right, left): (Vec<Triangle>, Vec<Triangle>) = all.into_iter().partition(|(corners, _)| corners[0].x > 0.0);
    // two sides of the cutter in each ball
    let of_cutter = |(corners, _): &&Triangle| [1, 2].iter().any(|axis| corners.iter().all(|p| p[*axis].abs() < 1e-12));
    let turned = ball.moved(|p| DVec3::new(2.0 * p.y + 3.0, 2.0 * p.x, 2.0 * p.z));
    check(&turned, &right, 1e-9, 1e-6, right.iter().filter(of_cutter).count());
    let sheared = ball.moved(|p| DVec3::new(p.x - 3.0, p.y + 0.5 * p.z, p.z));
    check(&sheared, &left, 1e-9, 1e-6, left.iter().filter(of_cutter).count());
}

#[test]
fn small_triangles_far_away_keep_their_digits() {
    let small = TexturedMesh::ball(5, 7, 4).moved(|p| p * 1e-3 + DVec3::new(1e4, -1e4, 1e4));
    let model = read(small.to_obj().as_bytes(), MeshFormat::Obj);
    let cut = built(&Model { tree: model.tree.clone() - cutter(DVec3::new(1e4, -1e4, 1e4)), ..model });
    let (mesh, sources) = &cut;
    let of_cutter = |face: &&u32| sources[mesh.faces[**face as usize].material.0 as usize].brush == 1;
    let others = mesh.triangle_faces.iter().filter(of_cutter).count();
    let part = Part { name: "m", mesh, sources };
    check(&small, &of_obj(part).0, 1e-11, 1e-6, others);
    let moved = Transform::new(DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0)), DVec3::splat(3e4)).expect("a map");
    let tree = read(small.to_obj().as_bytes(), MeshFormat::Obj).tree.transformed(&moved).expect("moved");
    let (mesh, sources) = built(&Model { tree, ..read(small.to_obj().as_bytes(), MeshFormat::Obj) });
    let part = Part { name: "m", mesh: &mesh, sources: &sources };
    check(&small.moved(|p| moved.point(p)), &of_obj(part).0, 1e-11, 1e-6, 0);
}

#[test]
fn a_lone_mesh_comes_back_with_its_own_vertices_and_coordinates() {
    let ball = TexturedMesh::ball(12, 24, 5);
    let (mesh, sources) = built(&read(ball.to_obj().as_bytes(), MeshFormat::Obj));
    let part = Part { name: "m", mesh: &mesh, sources: &sources };
    let (triangles, places) = of_obj(part);
    assert_eq!((mesh.positions.len(), places), (ball.positions.len(), ball.pairs()));
    assert_eq!(of_ply(part).1, ball.pairs());
    // those of the file, to the bit: single precision holds them
    let own = ball.triangles.iter().map(|t| (t.map(|[p, _]| ball.positions[p]), t.map(|[_, at]| ball.coordinates[at])));
    let key =
        |(p, at): &Triangle| (p.map(|p| p.to_array().map(f64::to_bits)), at.map(|at| at.to_array().map(f64::to_bits)));
    let sorted = |triangles: &mut dyn Iterator<Item = Triangle>| {
        let mut keys: Vec<_> = triangles.map(|triangle| key(&triangle)).collect();
        keys.sort_unstable();
        keys
    };
    assert_eq!(sorted(&mut triangles.into_iter()), sorted(&mut own.into_iter()));
    let smooth = ExportOptions { text: false, ..options(Shading::Smooth { crease: 180.0 }) };
    let file = written(&[part], &smooth);
    let [primitive] = &file.parts[0][..] else { panic!("one material, expected one primitive") };
    assert_eq!(primitive.vertices.len(), ball.pairs());
    let colored = written(&[part], &ExportOptions { vertex_colors: true, ..smooth });
    assert_eq!(colored.parts[0][0].vertices.len(), ball.pairs());
}

#[test]
fn our_own_files_are_read_with_the_coordinates_that_they_were_written_with() {
    let ball = TexturedMesh::ball(6, 8, 7);
    let model = read(ball.to_obj().as_bytes(), MeshFormat::Obj);
    // off the centre of the file, so that readers find what is in no single-precision place of the ball
    let map = Transform::translation(DVec3::new(10.0, 20.0, -5.0)).expect("a map");
    let (tree, moved) = (model.tree.transformed(&map).expect("moved"), ball.moved(|p| map.point(p)));
    let model = Model { tree: tree - cutter(DVec3::new(10.1, 20.1, -5.1)), ..model };
    let (mesh, sources) = built(&model);
    let others = mesh.triangle_faces.iter().filter(|face| {
        let material = mesh.faces[**face as usize].material;
        sources[material.0 as usize].brush == 1
    });
    let others = others.count();
    let part = Part { name: "m", mesh: &mesh, sources: &sources };
    // of a mesh that is a manifold a GLB says which vertices are one, and has coordinates at others
    for (format, reader) in
        [(Format::Glb, MeshFormat::Gltf), (Format::Obj, MeshFormat::Obj), (Format::Ply, MeshFormat::Ply)]
    {
        let bytes = encode_parts(&[part], format, &options(Shading::Flat)).expect("encoded");
        let (mesh, sources) = built(&read(&bytes, reader));
        assert!(sources.iter().all(|source| source.texture.is_some()), "{format:?}");
        check(&moved, &of_obj(Part { name: "m", mesh: &mesh, sources: &sources }).0, 2e-6, 2e-5, others);
    }
}

#[test]
fn both_triangles_of_a_flat_face_come_from_one_source() {
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n\
        f 4/4 3/3 2/2 1/1\nf 5/1 6/2 7/3 8/4\nf 1/1 2/2 6/3 5/4\nf 2/1 3/2 7/3 6/4\nf 3/1 4/2 8/3 7/4\nf 4/1 1/2 5/3 8/4\n";
    let (mesh, sources) = built(&read(text.as_bytes(), MeshFormat::Obj));
    assert_eq!((mesh.triangles.len(), sources.len()), (12, 6));
    let file = written(
        &[Part { name: "m", mesh: &mesh, sources: &sources }],
        &ExportOptions { text: false, ..options(Shading::Flat) },
    );
    assert_eq!(file.parts[0].iter().map(|primitive| primitive.vertices.len()).sum::<usize>(), 24);
}

#[test]
fn coordinates_that_are_not_asked_for_change_nothing() {
    let ball = TexturedMesh::ball(2, 4, 6);
    let textured = ball.to_obj();
    let without = |line: &str| {
        let words: Vec<&str> = line.split(' ').map(|word| word.split('/').next().unwrap_or(word)).collect();
        // lines keep their numbers
        if line.starts_with("vt") { "\n".to_owned() } else { words.join(" ") + "\n" }
    };
    let plain: String = textured.lines().map(without).collect();
    let read =
        |text: &str| read_solid(text.as_bytes(), MeshFormat::Obj, "m", &SolidOptions::default()).expect("a ball").model;
    assert_eq!(read(&textured), read(&plain));
    assert!(!read(&textured).tree.has_meshes(), "a convex body");
    let asked = SolidOptions { textures: true, ..SolidOptions::default() };
    let without = read_solid(plain.as_bytes(), MeshFormat::Obj, "m", &asked).expect("a ball").model;
    assert_eq!(without, read(&plain), "there are none");
}
