//! Text and packages: STL and PLY in both forms, 3MF, MTL.

use std::io::Read;

use planecut_csg::{Material, Mesh};
use planecut_export::{
    ExportOptions, Format, Part, Projection, Shading, TextureMapping, Unit, encode_parts, write_mtl,
};
use planecut_import::mesh::{IndexedMesh, MeshFormat, read_mesh};

use planecut_testkit::meshes::{cube_with_hole, mesh_volume, random_boxes, volume};

fn volume_of(mesh: &IndexedMesh) -> f64 {
    volume(mesh.triangles.iter().map(|t| t.map(|corner| mesh.positions[corner as usize])))
}

#[test]
fn ply_has_the_mesh_as_it_is() {
    for mesh in [cube_with_hole(), random_boxes(300, 6)] {
        for text in [false, true] {
            let options = ExportOptions { text, ..ExportOptions::default() };
            let bytes = encode_parts(&[Part::new("m", &mesh)], Format::Ply, &options).expect("encoded");
            let read = read_mesh(&bytes, MeshFormat::Ply, "m.ply").expect("read");
            assert!(read.positions == mesh.positions && read.triangles == mesh.triangles, "as text: {text}");
        }
    }
}

#[test]
fn split_vertices_of_ply_keep_the_triangles() {
    let mesh = random_boxes(50, 7);
    let texture = Some(TextureMapping { projection: Projection::Box, size: 1.0 });
    for text in [false, true] {
        let shading = Shading::Smooth { crease: 10.0 };
        let options = ExportOptions { text, texture, shading, ..ExportOptions::default() };
        let parts = [Part::new("a", &mesh), Part::new("b", &mesh)];
        let bytes = encode_parts(&parts, Format::Ply, &options).expect("encoded");
        let read = read_mesh(&bytes, MeshFormat::Ply, "m.ply").expect("read");
        assert_eq!(read.triangles.len(), 2 * mesh.triangles.len());
        assert!((volume_of(&read) / mesh_volume(&mesh) - 2.0).abs() < 1e-12);
    }
}

#[test]
fn text_of_stl_has_the_triangles_of_the_binary_form() {
    let mesh = random_boxes(80, 8);
    let read = |text: bool| {
        let options = ExportOptions { text, ..ExportOptions::default() };
        let bytes = encode_parts(&[Part::new("two\nlines", &mesh)], Format::Stl, &options).expect("encoded");
        read_mesh(&bytes, MeshFormat::Stl, "m.stl").expect("read")
    };
    let (binary, text) = (read(false), read(true));
    let single = |mesh: &IndexedMesh| mesh.positions.iter().map(|position| position.as_vec3()).collect::<Vec<_>>();
    assert!(single(&binary) == single(&text) && binary.triangles == text.triangles);
}

#[test]
fn a_3mf_package_holds_every_vertex_and_triangle() {
    let (one, other) = (cube_with_hole(), random_boxes(20, 4));
    let nothing = Mesh::default();
    let parts = [Part::new("one & only", &one), Part::new("", &other), Part::new("nothing", &nothing)];
    let options = ExportOptions { unit: Some(Unit::Inch), ..ExportOptions::default() };
    let bytes = encode_parts(&parts, Format::ThreeMf, &options).expect("encoded");
    assert_eq!(bytes, encode_parts(&parts, Format::ThreeMf, &options).expect("encoded"), "two runs differ");
    let mut package = zip::ZipArchive::new(std::io::Cursor::new(bytes)).expect("a package");
    let mut names: Vec<String> = package.file_names().map(|name| name.expect("a name").into_owned()).collect();
    names.sort();
    assert_eq!(names, ["3D/3dmodel.model", "[Content_Types].xml", "_rels/.rels"]);
    let mut model = String::new();
    package.by_name("3D/3dmodel.model").expect("there").read_to_string(&mut model).expect("text");
    assert!(model.contains("unit=\"inch\"") && model.contains("name=\"one &amp; only\""));
    let count = |word: &str| model.matches(word).count();
    assert_eq!(count("<vertex "), one.positions.len() + other.positions.len());
    assert_eq!(count("<triangle "), one.triangles.len() + other.triangles.len());
    assert_eq!((count("<object "), count("<item ")), (2, 2), "what has no triangles is no object");
    for position in one.positions.iter().chain(&other.positions) {
        let [x, y, z] = position.to_array();
        let attributes = |key: &str, value: f64| {
            let before = format!("{key}=\"");
            let mut values = model.split(&before).skip(1).filter_map(|rest| rest.split('"').next());
            values.any(|text| text.parse() == Ok(value))
        };
        assert!(attributes("x", x) && attributes("y", y) && attributes("z", z), "{position}");
    }
}

#[test]
fn obj_names_the_materials_of_its_library() {
    let mut mesh = cube_with_hole();
    mesh.materials[0] = Material { color: Some([0.0, 1.0, 0.0]), roughness: Some(0.25), ..mesh.materials[0].clone() };
    let parts = [Part::new("m", &mesh)];
    let options = ExportOptions { material_library: Some("m.mtl".to_owned()), ..ExportOptions::default() };
    let obj = String::from_utf8(encode_parts(&parts, Format::Obj, &options).expect("encoded")).expect("text");
    let mut library = Vec::new();
    write_mtl(&parts, &mut library).expect("written");
    let library = String::from_utf8(library).expect("text");
    assert!(obj.lines().any(|line| line == "mtllib m.mtl"));
    for used in obj.lines().filter_map(|line| line.strip_prefix("usemtl ")) {
        assert!(library.lines().any(|line| line.strip_prefix("newmtl ") == Some(used)), "{used}");
    }
    assert!(library.contains("Kd 0.0000 1.0000 0.0000") && library.contains("Pr 0.2500"), "{library}");
}

#[test]
fn obj_with_normals_and_texture_has_the_same_triangles() {
    let mesh = random_boxes(50, 12);
    let texture = Some(TextureMapping { projection: Projection::Box, size: 1.0 });
    let options = ExportOptions { texture, shading: Shading::Smooth { crease: 30.0 }, ..ExportOptions::default() };
    let parts = [Part::new("a", &mesh), Part::new("b", &mesh)];
    let text = encode_parts(&parts, Format::Obj, &options).expect("encoded");
    let read = read_mesh(&text, MeshFormat::Obj, "m.obj").expect("read");
    assert_eq!(read.positions.len(), 2 * mesh.positions.len(), "vertices are not split");
    assert!((volume_of(&read) / mesh_volume(&mesh) - 2.0).abs() < 1e-12);
    let text = String::from_utf8(text).expect("text");
    let count = |word: &str| text.lines().filter(|line| line.starts_with(word)).count() as u64;
    let (textures, normals) = (count("vt "), count("vn "));
    for corner in text.lines().filter_map(|line| line.strip_prefix("f ")).flat_map(str::split_whitespace) {
        let numbers: Vec<u64> = corner.split('/').map(|number| number.parse().expect("a number")).collect();
        let [_, texture, normal] = numbers[..] else { panic!("{corner}") };
        assert!((1..=textures).contains(&texture) && (1..=normals).contains(&normal), "{corner}");
    }
}
