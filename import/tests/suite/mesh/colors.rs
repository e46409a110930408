//! Colours of vertices and faces, as materials that go through set operations.

use planecut_csg::{Brush, Material, MaterialId, Model, Tree};
use planecut_import::mesh::{MeshFormat, SolidOptions, read_solid};

use super::support::{CUBE_QUADS, cube_corners, glb, split_cube};
use crate::measures::area_of;

fn read(bytes: &[u8], format: MeshFormat) -> Model {
    let import = read_solid(bytes, format, "m", &SolidOptions::default()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(import.warnings, []);
    import.model
}

/// Names and areas of the materials on a model's boundary, by name.
fn areas(model: &Model) -> Vec<(String, f64)> {
    let named = (0..).zip(&model.materials);
    let mut areas: Vec<(String, f64)> =
        named.map(|(id, material)| (material.name.clone(), area_of(model, MaterialId(id)))).collect();
    areas.retain(|(_, area)| *area > 0.0);
    areas.sort_by(|a, b| a.0.cmp(&b.0));
    areas
}

/// Grey of 188 on the scale of screens is half of white on that of light.
const HALF: f32 = 0.5;

#[test]
fn faces_of_ply_have_their_own_colours() {
    for number in ["uchar", "float"] {
        let mut text = format!(
            "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n\
             element face 6\nproperty list uchar int vertex_indices\n\
             property {number} red\nproperty {number} green\nproperty {number} blue\nproperty {number} alpha\nend_header\n"
        );
        cube_corners().iter().for_each(|[x, y, z]| text += &format!("{x} {y} {z}\n"));
        let full = if number == "uchar" { 255 } else { 1 };
        for (side, [a, b, c, d]) in CUBE_QUADS.iter().enumerate() {
            let red = if side < 2 { full } else { 0 };
            text += &format!("4 {a} {b} {c} {d} {red} 0 {} {full}\n", full - red);
        }
        let model = read(text.as_bytes(), MeshFormat::Ply);
        assert_eq!(areas(&model), [("#0000ff".to_owned(), 4.0), ("#ff0000".to_owned(), 2.0)], "{number}");
        assert_eq!(model.materials[0].color, Some([1.0, 0.0, 0.0]));
        // what is cut off leaves the colour of the tool
        let tool = Brush::cuboid([0.5, -1.0, -1.0], [2.0, 2.0, 2.0], MaterialId(2));
        let mut cut = Model { tree: model.tree - Tree::from(tool), ..model };
        cut.materials.push(Material::named("tool"));
        let expected = [("#0000ff", 2.0), ("#ff0000", 1.0), ("tool", 1.0)].map(|(name, area)| (name.to_owned(), area));
        assert_eq!(areas(&cut), expected);
    }
}

#[test]
fn triangles_have_the_mean_of_their_vertices_in_ply() {
    let mut bytes = b"ply\nformat binary_little_endian 1.0\nelement vertex 8\nproperty float x\nproperty float y\n\
        property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n\
        element face 6\nproperty list uchar int vertex_indices\nend_header\n"
        .to_vec();
    for [x, y, z] in cube_corners() {
        [x, y, z].iter().for_each(|v| bytes.extend(v.to_le_bytes()));
        // black below, white above
        bytes.extend([if z > 0.0 { 255u8 } else { 0 }; 3]);
    }
    for quad in CUBE_QUADS {
        bytes.push(4);
        quad.iter().for_each(|v| bytes.extend((*v as i32).to_le_bytes()));
    }
    let model = read(&bytes, MeshFormat::Ply);
    // a third and two thirds of the light of white, on the scale of screens
    let expected = [("#000000", 1.0), ("#9c9c9c", 2.0), ("#d5d5d5", 2.0), ("#ffffff", 1.0)];
    assert_eq!(areas(&model), expected.map(|(name, area)| (name.to_owned(), area)));
}

#[test]
fn vertices_of_obj_have_colours_after_their_coordinates() {
    let text = |full: &str, more: &str| {
        let mut text = format!("o cube\n{more}");
        cube_corners().iter().for_each(|[x, y, z]| text += &format!("v {x} {y} {z} {full} 0 0\n"));
        CUBE_QUADS.iter().for_each(|q| text += &format!("f {} {} {} {}\n", q[0] + 1, q[1] + 1, q[2] + 1, q[3] + 1));
        text
    };
    for full in ["1", "1.0", "255"] {
        let model = read(text(full, "").as_bytes(), MeshFormat::Obj);
        assert_eq!(areas(&model), [("#ff0000".to_owned(), 6.0)], "{full}");
    }
    // a material that the file names is meant more than a colour
    let model = read(text("1", "usemtl oak\n").as_bytes(), MeshFormat::Obj);
    assert_eq!(areas(&model), [("oak".to_owned(), 6.0)]);
    // a weight is no colour
    let weighed = text("1", "").replace(" 1 0 0\n", " 1\n");
    assert_eq!(areas(&read(weighed.as_bytes(), MeshFormat::Obj)), [("default".to_owned(), 6.0)]);
}

#[test]
fn vertices_of_gltf_shade_the_base_colour() {
    let brass = r#""materials": [{"name": "brass", "pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0, 1]}}],"#;
    for (component, kind) in [(5121, "VEC4"), (5123, "VEC3"), (5126, "VEC3")] {
        for has_material in [false, true] {
            let (json, mut buffer) = split_cube(r#""nodes": [{"mesh": 0}]"#, if has_material { brass } else { "" });
            let begin = buffer.len();
            // half of the light of white on the first side, white elsewhere
            for vertex in 0..24 {
                let light = if vertex < 4 { HALF } else { 1.0 };
                for _ in 0..if kind == "VEC4" { 4 } else { 3 } {
                    match component {
                        5121 => buffer.push((light * 255.0).round() as u8),
                        5123 => buffer.extend(((light * 65535.0).round() as u16).to_le_bytes()),
                        _ => buffer.extend(light.to_le_bytes()),
                    }
                }
            }
            let length = buffer.len() - begin;
            let whole = format!(r#""buffers": [{{"byteLength": {}}}]"#, buffer.len());
            let json = json
                .replace(r#""NORMAL": 9"#, r#""COLOR_0": 2"#)
                .replace(
                    r#""type": "SCALAR"}]"#,
                    &format!(
                        r#""type": "SCALAR"}}, {{"bufferView": 2, "componentType": {component}, "normalized": true, "count": 24, "type": "{kind}"}}]"#
                    ),
                )
                .replace(&format!(r#""buffers": [{{"byteLength": {begin}}}]"#), &whole)
                .replace(r#"}],
        "buffers""#, &format!(r#"}}, {{"buffer": 0, "byteOffset": {begin}, "byteLength": {length}}}],
        "buffers""#));
            let json =
                if has_material { json.replace(r#""indices": 1}"#, r#""indices": 1, "material": 0}"#) } else { json };
            let model = read(&glb(&json, &buffer), MeshFormat::Gltf);
            let expected = if has_material { ["brass", "brass #bcbcbc"] } else { ["#bcbcbc", "#ffffff"] };
            let mut expected: Vec<(String, f64)> =
                expected.iter().map(|name| ((*name).to_owned(), if name.contains("bc") { 1.0 } else { 5.0 })).collect();
            expected.sort_by(|a, b| a.0.cmp(&b.0));
            assert_eq!(areas(&model), expected, "{component} {kind}");
            let shaded = model.materials.iter().find(|material| material.name.contains("bc")).expect("a shade");
            let color = shaded.color.expect("a colour");
            let whole = if has_material { [1.0, 0.5, 0.0] } else { [1.0; 3] };
            let is_near = |(found, whole): (f32, f32)| (found - HALF * whole).abs() < 0.005;
            assert!(color.into_iter().zip(whole).all(is_near), "{color:?}");
        }
    }
}
