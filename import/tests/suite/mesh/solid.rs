//! Closed meshes as models: objects, materials, precision, and what is said of meshes that are no solid.

use std::num::NonZeroU32;

use glam::DVec3;
use planecut_cells::Solid;
use planecut_csg::Material;
use planecut_import::mesh::{MeshFormat, MeshImport, SolidOptions, read_parts, read_solid};
use planecut_kernel::IncrementalPolytope;

use super::support::{obj, ply, split_cube, stl_ascii, stl_binary};

fn read(bytes: &[u8], format: MeshFormat) -> MeshImport {
    read_solid(bytes, format, "m", &SolidOptions::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn refused(text: &str) -> String {
    let error = read_solid(text.as_bytes(), MeshFormat::Obj, "m.obj", &SolidOptions::default());
    let error = error.expect_err("no solid").to_string();
    assert!(!error.contains('\n'), "{error}");
    error
}

/// The unit cube as an object, `first` being the number of its first vertex, moved by `x`.
fn cube(name: &str, first: usize, x: f64, size: f64) -> String {
    let mut text = format!("o {name}\n");
    for k in 0..8 {
        let corner = [k & 1, k >> 1 & 1, k >> 2].map(|bit| f64::from(bit) * size);
        text += &format!("v {} {} {}\n", corner[0] + x, corner[1], corner[2]);
    }
    for quad in super::support::CUBE_QUADS {
        text += &format!(
            "f {} {} {} {}\n",
            quad[0] as usize + first,
            quad[1] as usize + first,
            quad[2] as usize + first,
            quad[3] as usize + first
        );
    }
    text
}

#[test]
fn every_format_gives_the_cube() {
    let files = [
        (MeshFormat::Obj, obj().into_bytes()),
        (MeshFormat::Stl, stl_binary()),
        (MeshFormat::Stl, stl_ascii().into_bytes()),
        (MeshFormat::Ply, ply("ascii")),
        (MeshFormat::Ply, ply("binary_little_endian")),
        (MeshFormat::Ply, ply("binary_big_endian")),
    ];
    for (format, bytes) in files {
        let import = read(&bytes, format);
        let brushes = import.model.tree.brushes();
        assert_eq!((brushes.len(), brushes[0].faces.len()), (1, 6), "{format:?}");
        assert_eq!(Solid::from_tree(&import.model.tree).volume(), Some(1.0), "{format:?}");
        assert_eq!(import.model.materials, vec![Material::named("default")], "{format:?}");
        assert!(import.warnings.is_empty(), "{format:?}: {:?}", import.warnings);
    }
}

#[test]
fn objects_are_united_and_bear_their_names_and_lines() {
    // two that overlap, and one inside the first
    let text = cube("first", 1, 0.0, 2.0) + &cube("second", 9, 1.0, 2.0) + &cube("third", 17, 0.5, 0.25);
    let import = read(text.as_bytes(), MeshFormat::Obj);
    let names: Vec<_> = import.model.tree.brushes().iter().map(|brush| brush.name.as_deref()).collect();
    assert_eq!(names, [Some("first"), Some("second"), Some("third")]);
    assert!(import.model.tree.source_lines().eq([10, 25, 40].map(NonZeroU32::new)));
    assert_eq!(Solid::from_tree(&import.model.tree).volume(), Some(12.0));
}

#[test]
fn groups_that_are_not_closed_are_one_solid() {
    let mut text = cube("whole", 1, 0.0, 1.0).replace("o whole", "g lower");
    let half = text.match_indices("f ").nth(3).expect("six faces").0;
    text.insert_str(half, "g upper\n");
    let import = read(text.as_bytes(), MeshFormat::Obj);
    assert_eq!(import.model.tree.brushes().len(), 1);
    assert_eq!(import.model.tree.brushes()[0].name, None);
}

#[test]
fn materials_of_obj_are_those_of_the_faces() {
    let text = cube("box", 1, 0.0, 1.0).replacen("f ", "usemtl old oak\nf ", 1);
    let last = text.rfind("f ").expect("faces");
    let text = format!("{}usemtl stone\n{}", &text[..last], &text[last..]);
    let import = read(text.as_bytes(), MeshFormat::Obj);
    assert_eq!(import.model.materials, [Material::named("old oak"), Material::named("stone")]);
    let faces = &import.model.tree.brushes()[0].faces;
    let of = |normal: DVec3| {
        faces.iter().find(|face| face.half_space.normal().normalize() == normal).expect("a side").material.0
    };
    assert_eq!((of(-DVec3::Z), of(DVec3::Y), of(DVec3::X)), (0, 0, 1));
}

#[test]
fn materials_of_gltf_have_their_factors() {
    let more = r#""materials": [{"name": "brass", "pbrMetallicRoughness":
        {"baseColorFactor": [0.75, 0.5, 0.25, 1.0], "metallicFactor": 1.0, "roughnessFactor": 0.25}}],"#;
    let nodes = r#""nodes": [{"mesh": 0, "name": "knob"}]"#;
    let (json, buffer) = split_cube(nodes, more);
    let json = json.replace(r#""indices": 1}"#, r#""indices": 1, "material": 0}"#);
    let import = read(&super::support::glb(&json, &buffer), MeshFormat::Gltf);
    let brass = Material {
        color: Some([0.75, 0.5, 0.25]),
        metallic: Some(1.0),
        roughness: Some(0.25),
        ..Material::named("brass")
    };
    assert_eq!(import.model.materials, [brass]);
    assert_eq!(import.model.tree.brushes()[0].name.as_deref(), Some("knob"));
}

#[test]
fn gltf_is_turned_so_that_z_points_up() {
    let (json, buffer) = split_cube(r#""nodes": [{"mesh": 0, "translation": [0, 10, 0]}]"#, "");
    let import = read(&super::support::glb(&json, &buffer), MeshFormat::Gltf);
    let solid = Solid::from_tree(&import.model.tree);
    assert!(solid.contains(DVec3::new(0.5, -0.5, 10.5)) && !solid.contains(DVec3::new(0.5, 10.5, 0.5)));
}

#[test]
fn a_mesh_that_is_inside_out_is_turned_with_a_warning() {
    let text: String = obj()
        .lines()
        .map(|line| match line.strip_prefix("f ") {
            Some(corners) => format!("f {}\n", corners.split(' ').rev().collect::<Vec<_>>().join(" ")),
            None => format!("{line}\n"),
        })
        .collect();
    let import = read(text.as_bytes(), MeshFormat::Obj);
    assert_eq!(import.warnings.len(), 1);
    assert!(import.warnings[0].message.contains("object `cube`"), "{}", import.warnings[0]);
    assert_eq!(Solid::from_tree(&import.model.tree).volume(), Some(1.0));
}

#[test]
fn what_is_no_solid_is_named_with_its_line_and_place() {
    let whole = obj();
    let last = whole.trim_end().rfind('\n').expect("lines");
    let open = refused(&whole[..last]);
    assert!(
        open.starts_with("m.obj:1") && open.contains("object `cube`: the surface is not closed: found 4 open edges"),
        "{open}"
    );
    let flat = refused("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 3 2 1\n");
    assert!(flat.contains("no volume"), "{flat}");
    let unreadable = refused("v 0 0\n");
    assert!(unreadable.starts_with("m.obj:1: found"), "{unreadable}");
}

/// Coordinates cut to six places, as other programs write them, leave planes of many corners planes.
#[test]
fn decimals_tell_how_exact_they_are() {
    let mut text = String::new();
    let sides = 48;
    let (sine, cosine) = 0.7f64.sin_cos();
    for k in 0..2 * sides {
        let angle = f64::from(k % sides) / f64::from(sides) * std::f64::consts::TAU;
        let (x, y, z) = (10.0 * angle.cos(), 10.0 * angle.sin(), if k < sides { 0.0 } else { 4.0 });
        text += &format!("v {:.6} {:.6} {:.6}\n", x, cosine * y - sine * z, sine * y + cosine * z);
    }
    for k in 0..sides {
        let (a, b) = (k + 1, (k + 1) % sides + 1);
        text += &format!("f {a} {b} {}\nf {a} {} {}\n", b + sides, b + sides, a + sides);
    }
    for k in 2..sides {
        text += &format!("f 1 {} {k}\nf {} {} {}\n", k + 1, sides + 1, k + sides, k + 1 + sides);
    }
    let import = read(text.as_bytes(), MeshFormat::Obj);
    let brushes = import.model.tree.brushes();
    assert_eq!((brushes.len(), brushes[0].faces.len()), (1, sides as usize + 2));
}

#[test]
fn convex_objects_hold_all_their_points_where_that_is_asked() {
    // no three of these decimals give a plane that a few floating-point numbers can be
    let text = "o gem\nv 0.1 0.2 0.9\nv 0.7 -0.3 0.05\nv 0.15 0.8 0.01\nv -0.6 -0.4 0.03\nv 0.07 0.11 -0.83\nv 7 7 7\n\
                f 1 2 3\nf 1 3 4\nf 1 4 2\nf 5 3 2\nf 5 4 3\nf 5 2 4\n";
    let parts = read_parts(text.as_bytes(), MeshFormat::Obj, "m", &SolidOptions::default())
        .unwrap_or_else(|error| panic!("{error}"));
    // the last one is of no facet
    assert_eq!(parts.points.len(), 5);
    let [brush] = parts.import.model.tree.brushes() else { panic!("one body") };
    let mut body = IncrementalPolytope::with_epsilon(0.0);
    for face in &brush.faces {
        body.add_plane(face.half_space);
    }
    assert!(parts.points.iter().all(|point| body.contains(*point)));
    assert_eq!(brush.name.as_deref(), Some("gem"));
}
