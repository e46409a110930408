//! What is said of a file is what other readers find in it.

use glam::DVec3;
use planecut_csg::Mesh;
use planecut_export::{ExportOptions, Format, Part, encode_parts, written};

use super::support::written as read_glb;
use planecut_testkit::meshes::{cube_with_hole, random_boxes};

/// The volume between triangles and a point.
fn volume(triangles: impl Iterator<Item = [DVec3; 3]>, origin: DVec3) -> f64 {
    triangles.map(|[a, b, c]| (a - origin).dot((b - origin).cross(c - origin))).sum::<f64>() / 6.0
}

/// Meshes that single precision, or a grid, holds in part.
fn meshes() -> Vec<Mesh> {
    let mut far = random_boxes(60, 11);
    far.positions.iter_mut().for_each(|position| *position += DVec3::new(1e8, -3e7, 2e8));
    let mut flat = random_boxes(60, 12);
    flat.positions.iter_mut().for_each(|position| position.z *= 1e-5);
    vec![cube_with_hole(), random_boxes(40, 2), far, flat]
}

#[test]
fn a_glb_holds_what_is_said_of_it() {
    let meshes = meshes();
    let parts: Vec<Part<'_>> = meshes.iter().chain([&meshes[1]]).map(|mesh| Part::new("m", mesh)).collect();
    let total: usize = parts.iter().map(|part| part.mesh.triangles.len()).sum();
    for options in [ExportOptions::default(), ExportOptions { quantize: true, ..ExportOptions::default() }] {
        let told = written(&parts, Format::Glb, &options).expect("told").expect("single precision");
        let file = read_glb(&parts, &options);
        assert_eq!(told.triangles.len(), file.triangles());
        assert_eq!(told.is_reduced, told.triangles.len() < total);
        assert!(!options.quantize || told.is_reduced);
        let corners = |triangle: &[u32; 3]| triangle.map(|corner| told.positions[corner as usize]);
        // part by part, so that volumes are not lost beside those of others
        let mut rest = told.triangles.as_slice();
        for primitives in &file.parts {
            let (own, after) = rest.split_at(primitives.iter().map(|primitive| primitive.triangles.len()).sum());
            rest = after;
            let origin = own.first().map_or(DVec3::ZERO, |triangle| corners(triangle)[0]);
            let found = primitives.iter().flat_map(|primitive| {
                primitive.triangles.iter().map(|triangle| primitive.corners(*triangle).map(|corner| corner.position))
            });
            let (told, found) = (volume(own.iter().map(corners), origin), volume(found, origin));
            assert!((told - found).abs() <= 1e-9 * found.abs().max(1e-6), "{told} {found}");
        }
    }
}

#[test]
fn an_stl_file_holds_what_is_said_of_it() {
    let mut reduced = 0;
    for mesh in &meshes() {
        let parts = [Part::new("m", mesh)];
        let options = ExportOptions { scale: 0.1, ..ExportOptions::default() };
        let told = written(&parts, Format::Stl, &options).expect("told").expect("single precision");
        let bytes = encode_parts(&parts, Format::Stl, &options).expect("encoded");
        let count = u32::from_le_bytes(bytes[80..84].try_into().expect("four bytes")) as usize;
        assert_eq!((told.triangles.len(), bytes.len()), (count, 84 + 50 * count));
        reduced += usize::from(told.is_reduced);
        for (triangle, record) in told.triangles.iter().zip(bytes[84..].chunks(50)) {
            for (corner, bytes) in triangle.iter().zip(record[12..48].chunks(12)) {
                let at = |k: usize| f64::from(f32::from_le_bytes(bytes[4 * k..][..4].try_into().expect("four bytes")));
                let found = DVec3::new(at(0), at(1), at(2)) / 0.1;
                assert!(told.positions[*corner as usize].abs_diff_eq(found, 1e-15 * found.length()));
            }
        }
    }
    assert!(reduced > 0);
    let cube = cube_with_hole();
    for format in [Format::Obj, Format::ThreeMf, Format::Ply] {
        assert_eq!(written(&[Part::new("m", &cube)], format, &ExportOptions::default()).expect("told"), None);
    }
}
