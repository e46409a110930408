//! Materials and names, however hostile.

use planecut_csg::{Brush, Material, MaterialId};
use planecut_export::{BrushFormat, write_brushes};
use planecut_kernel::DVec3;
use std::collections::BTreeSet;

use super::support::{read, written};

fn cube(place: f64, material: u32) -> Brush {
    Brush::cuboid(DVec3::splat(place), DVec3::splat(place + 1.0), MaterialId(material))
}

const HOSTILE: [&str; 16] = [
    "",
    " ",
    "a b",
    "a_b",
    "\"",
    "q\"uo\"te",
    "{",
    "}",
    "( ) [ ]",
    "//",
    "/* x",
    "#ff0000",
    "zażółć",
    "\u{1F9F1}",
    "a\nb\tc\u{2028}d",
    "back\\slash",
];

#[test]
fn hostile_materials_stay_apart() {
    let materials = HOSTILE.map(Material::named);
    let cubes: Vec<Brush> = (0..materials.len()).map(|k| cube(2.0 * k as f64, k as u32)).collect();
    let text = written(&cubes, &materials, BrushFormat::Map, 1.0);
    let model = read(&text, BrushFormat::Map);
    assert_eq!(model.tree.brushes().len(), cubes.len());
    let names: BTreeSet<&str> = model.materials.iter().map(|material| material.name.as_str()).collect();
    assert_eq!(names.len(), materials.len(), "{names:?}");
    for (number, brush) in model.tree.brushes().iter().enumerate() {
        assert!(brush.faces.iter().all(|face| face.material == MaterialId(number as u32)), "in their order");
    }
    for name in names {
        assert!(!name.contains(|c: char| c.is_whitespace() || "\"(){}[]\\".contains(c)), "{name:?}");
    }
    assert_eq!(
        read(&written(&cubes, &materials, BrushFormat::Scad, 1.0), BrushFormat::Scad).tree.brushes().len(),
        cubes.len()
    );
}

#[test]
fn harmless_materials_keep_their_names_on_each_face() {
    let materials = ["city4_7", "*lava1", "{fence", "+0button", "größe/x-y.z"].map(Material::named);
    let mut brush = cube(0.0, 0);
    for (k, face) in brush.faces.iter_mut().enumerate() {
        face.material = MaterialId((k % materials.len()) as u32);
    }
    let model = read(&written(std::slice::from_ref(&brush), &materials, BrushFormat::Map, 1.0), BrushFormat::Map);
    let name = |model: &[Material], id: MaterialId| model[id.0 as usize].name.clone();
    for (before, after) in brush.faces.iter().zip(&model.tree.brushes()[0].faces) {
        assert_eq!(name(&model.materials, after.material), name(&materials, before.material));
    }
}

/// A body is shown in the colour of most of its surface.
#[test]
fn colours_come_back() {
    let red = Material { color: Some([1.0, 0.25, 0.0]), ..Material::named("red") };
    let blue = Material { color: Some([0.0, 0.1, 0.8]), ..Material::named("blue") };
    let mut slab = Brush::cuboid(DVec3::ZERO, DVec3::new(9.0, 9.0, 1.0), MaterialId(0));
    for face in slab.faces.iter_mut().filter(|face| face.half_space.normal().z != 0.0) {
        face.material = MaterialId(1);
    }
    let model =
        read(&written(&[slab, cube(20.0, 0)], &[red.clone(), blue.clone()], BrushFormat::Scad, 1.0), BrushFormat::Scad);
    for (brush, expected) in model.tree.brushes().iter().zip([blue, red]) {
        let found = model.materials[brush.faces[0].material.0 as usize].color.expect("a colour");
        for (found, expected) in found.into_iter().zip(expected.color.expect("a colour")) {
            // four digits of the scale of screens, which is at most 2.3 times as steep
            assert!((found - expected).abs() <= 2.3 * 0.5e-4 + f32::EPSILON, "{found} for {expected}");
        }
    }
}

#[test]
fn brushes_named_after_entities_are_in_entities() {
    let names = [
        Some("func_door #7"),
        None,
        Some("func_door #3"),
        Some("a pillar"),
        Some("func_door #7"),
        Some("bad\"class #1"),
    ];
    let brushes: Vec<Brush> = (0..)
        .zip(names)
        .map(|(k, name)| Brush { name: name.map(str::to_owned), ..cube(f64::from(2 * k), 0) })
        .collect();
    let model = read(&written(&brushes, &[Material::named("t")], BrushFormat::Map, 1.0), BrushFormat::Map);
    // the world comes first, then entities by number; numbers are those of the new file
    let found: Vec<_> = model.tree.brushes().iter().map(|brush| (brush.name.as_deref(), brush.faces.clone())).collect();
    let expected = [
        (None, 1),
        (None, 3),
        (None, 5),
        (Some("func_door #1"), 2),
        (Some("func_door #2"), 0),
        (Some("func_door #2"), 4),
    ];
    assert_eq!(found, expected.map(|(name, number)| (name, brushes[number].faces.clone())));
}

#[test]
fn nothing_at_all_is_written_as_an_empty_file() {
    for format in BrushFormat::ALL {
        let mut text = Vec::new();
        write_brushes(&[], &[], format, 1.0, &mut text).expect("written");
        assert_eq!(text.iter().filter(|byte| **byte == b'{').count(), 1, "{format:?}");
        assert_eq!(text.last(), Some(&b'\n'), "{format:?}");
    }
}
