//! Objects that are not convex: one closed mesh each, whatever they do to themselves.

use std::num::NonZeroU32;

use planecut_csg::{MaterialId, WindingRule, evaluate};
use planecut_import::mesh::{MeshFormat, MeshImport, SolidOptions, read_solid};

use super::support::CUBE_QUADS;
use crate::measures::area_of;

fn read_as(text: &str, options: &SolidOptions) -> MeshImport {
    read_solid(text.as_bytes(), MeshFormat::Obj, "m.obj", options).unwrap_or_else(|error| panic!("{error}"))
}

fn read(text: &str) -> MeshImport {
    read_as(text, &SolidOptions::default())
}

fn volume(import: &MeshImport) -> f64 {
    evaluate(&import.model).unwrap_or_else(|error| panic!("{error}")).solid.volume
}

/// Cubes as one object: their least and greatest coordinates, and whether they are inside out.
fn cubes(all: &[(f64, f64, bool)]) -> String {
    let mut text = "o cubes\n".to_owned();
    for (min, max, _) in all {
        for k in 0..8 {
            let [x, y, z] = [k & 1, k >> 1 & 1, k >> 2].map(|bit| if bit == 0 { min } else { max });
            text += &format!("v {x} {y} {z}\n");
        }
    }
    for (number, (_, _, is_turned)) in all.iter().enumerate() {
        for mut quad in CUBE_QUADS {
            if *is_turned {
                quad.reverse();
            }
            let [a, b, c, d] = quad.map(|corner| corner as usize + 8 * number + 1);
            text += &format!("f {a} {b} {c} {d}\n");
        }
    }
    text
}

const CROSSING: [(f64, f64, bool); 2] = [(0.0, 2.0, false), (1.0, 3.0, false)];
const NESTED: [(f64, f64, bool); 2] = [(0.0, 3.0, false), (1.0, 2.0, false)];
const HOLLOW: [(f64, f64, bool); 2] = [(0.0, 3.0, false), (1.0, 2.0, true)];
const TWICE: [(f64, f64, bool); 2] = [(0.0, 2.0, false), (0.0, 2.0, false)];

#[test]
fn what_crosses_itself_lies_upon_itself_or_is_nested_is_one_mesh() {
    for (shells, expected) in [(CROSSING, 15.0), (NESTED, 27.0), (HOLLOW, 26.0), (TWICE, 8.0)] {
        let import = read(&cubes(&shells));
        let [leaf] = import.model.tree.brushes() else { panic!("one leaf") };
        assert!(leaf.is_mesh() && import.warnings.is_empty(), "{shells:?}");
        assert_eq!(leaf.name.as_deref(), Some("cubes"));
        assert_eq!(import.model.tree.source_line(0), NonZeroU32::new(18));
        assert_eq!(volume(&import), expected, "{shells:?}");
    }
}

#[test]
fn the_rule_says_what_is_inside() {
    use WindingRule::{NonZero, Odd, Positive};
    for (shells, rule, expected) in [
        (CROSSING, Odd, 14.0),
        (NESTED, Odd, 26.0),
        (NESTED, NonZero, 27.0),
        (TWICE, Odd, 0.0),
        // what winds the other way is inside with one rule and outside with another
        ([(0.0, 3.0, false), (5.0, 6.0, true)], Positive, 27.0),
        ([(0.0, 3.0, false), (5.0, 6.0, true)], NonZero, 28.0),
    ] {
        let import = read_as(&cubes(&shells), &SolidOptions { rule, ..SolidOptions::default() });
        assert_eq!(volume(&import), expected, "{shells:?} {rule:?}");
    }
}

#[test]
fn a_mesh_that_is_inside_out_is_turned_with_a_warning() {
    let turned = read(&cubes(&CROSSING.map(|(min, max, _)| (min, max, true))));
    assert_eq!(volume(&turned), 15.0);
    let message = &turned.warnings[0].message;
    assert_eq!(message, "object `cubes`: found facets that are clockwise seen from outside, turned them over");
}

#[test]
fn a_sheet_with_two_sides_encloses_nothing() {
    let mut both = cubes(&CROSSING[..1]);
    let turned: String = CUBE_QUADS.map(|[a, b, c, d]| format!("f {} {} {} {}\n", a + 1, d + 1, c + 1, b + 1)).concat();
    both += &turned;
    let error = read_solid(both.as_bytes(), MeshFormat::Obj, "m.obj", &SolidOptions::default()).expect_err("nothing");
    assert!(error.to_string().contains("encloses no volume") && !error.is_open(), "{error}");
}

#[test]
fn triangles_keep_the_materials_of_the_file() {
    let text = cubes(&CROSSING).replacen("f ", "usemtl oak\nf ", 1).replacen("f 9 ", "usemtl stone\nf 9 ", 1);
    let import = read(&text);
    let names: Vec<&str> = import.model.materials.iter().map(|material| material.name.as_str()).collect();
    assert_eq!(names, ["oak", "stone"]);
    // of each cube three sides are whole and three lack a quarter
    for material in [0, 1].map(MaterialId) {
        assert!((area_of(&import.model, material) - (3.0 * 4.0 + 3.0 * 3.0)).abs() < 1e-12);
    }
}

/// The unit cube as six squares that share no vertex, each of its corners off by less than `off`.
fn loose_cube(off: f64) -> String {
    let mut text = String::new();
    for (number, quad) in CUBE_QUADS.iter().enumerate() {
        for corner in quad {
            let shift = off * (number as f64 / 6.0);
            let [x, y, z] = [corner & 1, corner >> 1 & 1, corner >> 2].map(|bit| f64::from(bit) + shift);
            text += &format!("v {x} {y} {z}\n");
        }
        let [a, b, c, d] = [1, 2, 3, 4].map(|k| 4 * number + k);
        text += &format!("f {a} {b} {c} {d}\n");
    }
    text
}

#[test]
fn vertices_are_joined_within_the_distance_that_is_asked_for() {
    let text = loose_cube(0.01);
    let open = |close| {
        let options = SolidOptions { close, ..SolidOptions::default() };
        read_solid(text.as_bytes(), MeshFormat::Obj, "m.obj", &options).expect_err("open")
    };
    for close in [0.0, 0.001] {
        let error = open(close);
        assert!(error.is_open(), "{error}");
        let line = error.to_string();
        assert!(
            line.starts_with("m.obj:5: the surface is not closed: found 24 open edges, the first one from (0, 0, 0) ")
        );
    }
    let import = read_as(&text, &SolidOptions { close: 0.01, ..SolidOptions::default() });
    assert_eq!(import.warnings[0].message, "joined 16 vertices with others that are no farther than 0.01");
    assert!((volume(&import) - 1.0).abs() < 0.03);
}

#[test]
fn corners_that_differ_by_rounding_are_joined_without_being_asked() {
    let import = read(&loose_cube(1e-12));
    assert!(
        import.warnings.iter().any(|warning| warning.message.contains("corners that differ from others by rounding"))
    );
    assert!((volume(&import) - 1.0).abs() < 1e-9);
}

/// Refusing an open mesh takes no longer than reading it.
#[test]
fn an_open_grid_is_refused_at_its_first_open_edge() {
    const SIDE: usize = 300;
    let mut text = String::new();
    for k in 0..=SIDE {
        (0..=SIDE).for_each(|j| text += &format!("v {j} {k} {}\n", (j * k) % 7));
    }
    for k in 0..SIDE {
        for j in 0..SIDE {
            let a = k * (SIDE + 1) + j + 1;
            text += &format!("f {a} {} {} {}\n", a + 1, a + SIDE + 2, a + SIDE + 1);
        }
    }
    let error = read_solid(text.as_bytes(), MeshFormat::Obj, "m.obj", &SolidOptions::default()).expect_err("open");
    let begin = format!("m.obj:{}: the surface is not closed: found {} open edges", (SIDE + 1).pow(2) + 1, 4 * SIDE);
    assert!(error.to_string().starts_with(&begin), "{error}");
}
