//! Whole pictures, compared with those that someone has looked at.
//!
//! With `PLANECUT_BLESS=1` in the environment the pictures are written: look at them before they are committed.

use std::fs;
use std::path::Path;

use glam::DVec3;
use planecut_cells::Solid;
use planecut_csg::{Brush, CutMaterial, Material, MaterialId, Model, Transform, Tree, evaluate};
use planecut_export::distinct_color;
use planecut_kernel::HalfSpace;
use planecut_picture::{Background, CameraKind, PaintedMesh, Picture, PreviewOptions, PreviewStyle, render};
use planecut_shapes::primitives;

use crate::support::{SMALL, hatched, in_one_color};

const GOLDEN: PreviewOptions = PreviewOptions { width: 240, height: 180, ..SMALL };

/// A bracket with a hole, a pin through it, and a foot of a third material.
fn bracket() -> Model {
    let cuboid = |min: [f64; 3], max: [f64; 3], material: u32| {
        Tree::from(Brush::cuboid(DVec3::from(min), DVec3::from(max), MaterialId(material)))
    };
    // Upright cylinders, laid down along x and moved to where the hole is.
    let lying = |[start, length]: [f64; 2], radius: f64, segments: u32, material: u32| {
        let upright = primitives::cylinder(length, radius, radius, segments, MaterialId(material)).expect("a cylinder");
        let down = Transform::rotation(DVec3::Y, 90.0).expect("a rotation");
        let there = Transform::translation(DVec3::new(start, 20.0, 36.0)).expect("a translation");
        Tree::from(upright).transformed(&down.then(&there).expect("a transform")).expect("moved")
    };
    let plates = cuboid([0.0, 0.0, 0.0], [60.0, 40.0, 10.0], 0) | cuboid([0.0, 0.0, 0.0], [10.0, 40.0, 54.0], 0);
    let body = plates - lying([-5.0, 20.0], 10.0, 24, 0);
    let pin = lying([-14.0, 44.0], 6.0, 16, 1);
    let foot = cuboid([34.0, 6.0, 10.0], [54.0, 34.0, 22.0], 2);
    let colored = |name: &str, color: [f32; 3]| Material { color: Some(color), ..Material::named(name) };
    let materials =
        vec![colored("steel", [0.32, 0.42, 0.55]), colored("brass", [0.75, 0.52, 0.16]), Material::named("rubber")];
    Model { materials, tree: body | pin | foot }
}

fn picture_of(model: &Model, cuts: &[CutMaterial], options: &PreviewOptions) -> Picture {
    let mesh = evaluate(model).expect("evaluated").mesh;
    render(&hatched(&mesh, cuts), options).expect("drawn")
}

/// The bracket without what is nearer than the axis of its hole.
fn cut_picture(options: &PreviewOptions) -> Picture {
    let cut = bracket().cut_open(&HalfSpace::new(DVec3::NEG_Y, -20.0).expect("a half-space"));
    picture_of(&cut.model, &cut.cuts, options)
}

fn cells_picture(options: &PreviewOptions) -> Picture {
    let model = bracket();
    let solid = Solid::from_tree(&model.tree);
    let cells = solid.cell_meshes(&model.materials).expect("cells");
    assert!(cells.len() > 2, "{} cells", cells.len());
    let colored = |(number, cell)| in_one_color(cell, distinct_color(number));
    let parts: Vec<PaintedMesh<'_>> = cells.iter().enumerate().map(colored).collect();
    render(&PaintedMesh::exploded(&parts, 0.5), options).expect("drawn")
}

/// Compares with the picture of that name, or writes it.
fn check(name: &str, found: &Picture) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/suite/golden").join(format!("{name}.png"));
    if std::env::var_os("PLANECUT_BLESS").is_some_and(|value| value == "1") {
        fs::write(&path, found.to_png().expect("encoded")).expect("written");
        return;
    }
    let bytes = fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let expected = image::load_from_memory(&bytes).expect("a PNG").to_rgba8();
    let size = (found.width, found.height);
    let is_same_size = (expected.width(), expected.height()) == size;
    if is_same_size && *expected.as_raw() == found.pixels {
        return;
    }
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let write = |kind: &str, picture: &Picture| {
        let path = folder.join(format!("{name}.{kind}.png"));
        fs::write(&path, picture.to_png().expect("encoded")).expect("written");
        path.display().to_string()
    };
    let actual = write("actual", found);
    assert!(is_same_size, "{name} is {size:?} large, not as it was: see {actual}");
    let pairs = || found.pixels.as_chunks::<4>().0.iter().zip(expected.as_raw().as_chunks::<4>().0);
    let count = pairs().filter(|(a, b)| a != b).count();
    let largest = found.pixels.iter().zip(expected.as_raw()).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0);
    // Red where anything differs, brighter where more does, on black.
    let red = |(a, b): (&[u8; 4], &[u8; 4])| {
        let most = a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0);
        [if most > 0 { 64 + most / 4 * 3 } else { 0 }, 0, 0, 255]
    };
    let difference = Picture { pixels: pairs().flat_map(red).collect(), ..found.clone() };
    let difference = write("difference", &difference);
    panic!("{name}: {count} pixels differ, by up to {largest}: see {actual} and {difference}");
}

#[test]
fn styles_and_backgrounds() {
    use Background::{Dark, Light, Transparent};
    use CameraKind::{Orthographic, Perspective};
    use PreviewStyle::{Shaded, Technical, Wireframe, XRay};
    let cases = [
        ("shaded", Shaded, Perspective, Light),
        ("shaded_orthographic_dark", Shaded, Orthographic, Dark),
        ("shaded_transparent", Shaded, Perspective, Transparent),
        ("technical", Technical, Orthographic, Light),
        ("technical_perspective_dark", Technical, Perspective, Dark),
        ("xray", XRay, Perspective, Light),
        ("xray_orthographic_dark", XRay, Orthographic, Dark),
        ("wireframe", Wireframe, Perspective, Light),
        ("wireframe_orthographic_transparent", Wireframe, Orthographic, Transparent),
    ];
    for (name, style, camera, background) in cases {
        check(name, &picture_of(&bracket(), &[], &PreviewOptions { style, camera, background, ..GOLDEN }));
    }
}

#[test]
fn cells_apart() {
    check("cells", &cells_picture(&GOLDEN));
    check("cells_xray", &cells_picture(&PreviewOptions { style: PreviewStyle::XRay, ..GOLDEN }));
}

#[test]
fn cut_open() {
    check("cut", &cut_picture(&GOLDEN));
    let drawing =
        PreviewOptions { style: PreviewStyle::Technical, camera: CameraKind::Orthographic, elevation: 25.0, ..GOLDEN };
    check("cut_technical", &cut_picture(&drawing));
}

#[cfg(feature = "text")]
#[test]
fn labelled() {
    let labels = PreviewOptions { dimensions: true, scale_bar: true, unit: Some("mm"), ..GOLDEN };
    check("labels", &picture_of(&bracket(), &[], &labels));
    let drawing = PreviewOptions {
        width: 480,
        height: 360,
        style: PreviewStyle::Technical,
        camera: CameraKind::Orthographic,
        background: Background::Dark,
        ..labels
    };
    check("labels_technical_dark", &picture_of(&bracket(), &[], &drawing));
}
