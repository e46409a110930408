//! OBJ and STL files are read again by small readers written here and compared with the mesh.

use glam::{DVec3, Vec3};
use planecut_csg::Mesh;
use planecut_export::{ExportOptions, Format, Part, encode, encode_parts};
use planecut_testkit::meshes;

struct Obj {
    positions: Vec<DVec3>,
    triangles: Vec<([u32; 3], String)>,
    objects: Vec<String>,
}

fn read_obj(bytes: &[u8]) -> Obj {
    let mut obj = Obj { positions: Vec::new(), triangles: Vec::new(), objects: Vec::new() };
    let mut material = String::new();
    for line in std::str::from_utf8(bytes).expect("UTF-8").lines() {
        let mut words = line.split_whitespace();
        let key = words.next().expect("no empty lines");
        match key {
            "v" => {
                let numbers: Vec<f64> = words.map(|word| word.parse().expect("a number")).collect();
                obj.positions.push(DVec3::from_slice(&numbers));
            }
            "f" => {
                let corners: Vec<u32> = words.map(|word| word.parse::<u32>().expect("an index") - 1).collect();
                obj.triangles.push((corners.try_into().expect("three corners"), material.clone()));
            }
            "usemtl" => material = words.next().expect("a name").to_owned(),
            "o" => obj.objects.push(words.next().expect("a name").to_owned()),
            "#" | "g" | "s" => {}
            other => panic!("unexpected {other}"),
        }
    }
    obj
}

fn material_of(mesh: &Mesh, triangle: usize) -> usize {
    mesh.faces[mesh.triangle_faces[triangle] as usize].material.0 as usize
}

#[test]
fn obj_keeps_every_bit_and_every_index() {
    for mesh in [meshes::cube_with_hole(), meshes::random_boxes(200, 21)] {
        let obj = read_obj(&encode(&mesh, Format::Obj, &ExportOptions::default()).expect("encoded"));
        assert_eq!(obj.positions, mesh.positions);
        let mut expected: Vec<_> = (0..mesh.triangles.len())
            .map(|t| (material_of(&mesh, t), mesh.triangles[t], mesh.materials[material_of(&mesh, t)].name.clone()))
            .collect();
        expected.sort_by_key(|(material, ..)| *material);
        let expected: Vec<_> = expected.into_iter().map(|(_, triangle, name)| (triangle, name)).collect();
        assert_eq!(obj.triangles, expected);
    }
}

#[test]
fn obj_scales_and_numbers_parts_on() {
    let meshes = [meshes::cube_with_hole(), meshes::random_boxes(3, 2)];
    let parts = [Part::new("a b", &meshes[0]), Part::new("", &meshes[1])];
    let obj = read_obj(
        &encode_parts(&parts, Format::Obj, &ExportOptions { scale: 0.5, ..ExportOptions::default() }).expect("encoded"),
    );
    assert_eq!(obj.objects, ["a_b", "solid"]);
    let expected: Vec<_> = meshes.iter().flat_map(|mesh| &mesh.positions).map(|&p| p * 0.5).collect();
    assert_eq!(obj.positions, expected);
    let found = meshes::volume(obj.triangles.iter().map(|(t, _)| t.map(|corner| obj.positions[corner as usize])));
    let expected: f64 = meshes.iter().map(meshes::mesh_volume).sum::<f64>() / 8.0;
    assert!((found / expected - 1.0).abs() < 1e-12);
}

#[test]
fn stl_has_the_triangles_in_single_precision() {
    let mesh = meshes::random_boxes(100, 9);
    let scale = 25.4;
    let bytes = encode(&mesh, Format::Stl, &ExportOptions { scale, ..ExportOptions::default() }).expect("encoded");
    assert!(!bytes.starts_with(b"solid"), "would be taken for a text file");
    let (header, records) = bytes.split_at(84);
    assert_eq!(u32::from_le_bytes(header[80..].try_into().expect("4 bytes")) as usize, mesh.triangles.len());
    assert_eq!(records.len(), 50 * mesh.triangles.len());
    for (record, (corners, &face)) in records.chunks(50).zip(mesh.triangles.iter().zip(&mesh.triangle_faces)) {
        let numbers: Vec<f32> =
            record[..48].chunks(4).map(|c| f32::from_le_bytes(c.try_into().expect("4 bytes"))).collect();
        let vectors: Vec<Vec3> = numbers.chunks(3).map(Vec3::from_slice).collect();
        assert!(vectors[0].as_dvec3().distance(mesh.faces[face as usize].normal) < 1e-6);
        assert_eq!(vectors[1..], corners.map(|corner| (mesh.positions[corner as usize] * scale).as_vec3()));
    }
}

/// The oracle of these tests is right where the answer is known: a cube of side 4 less a square prism of side 2.
#[test]
fn the_test_meshes_have_the_volumes_they_should() {
    assert!((meshes::mesh_volume(&meshes::cube_with_hole()) - (64.0 - 16.0)).abs() < 1e-12);
    let slab = meshes::box_mesh(DVec3::splat(-1.0), DVec3::new(1.0, 2.0, 3.0), "stone");
    assert!((meshes::mesh_volume(&slab) - 24.0).abs() < 1e-12);
}

#[test]
fn empty_meshes_are_valid_files() {
    let options = ExportOptions::default();
    assert_eq!(encode(&Mesh::default(), Format::Stl, &options).expect("encoded").len(), 84);
    assert!(read_obj(&encode(&Mesh::default(), Format::Obj, &options).expect("encoded")).triangles.is_empty());
}

#[test]
fn broken_indices_are_an_error_in_every_format() {
    let mut mesh = meshes::cube_with_hole();
    mesh.triangles[3][1] = 99;
    for format in Format::ALL {
        let message = encode(&mesh, format, &ExportOptions::default()).expect_err("refused").to_string();
        assert!(message.contains("triangle 3 names vertex 99"), "{message}");
    }
}
