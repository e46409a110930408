//! Maps that others made, in the data folder; ignored where it is absent.

use std::path::Path;

use planecut_import::map::{MapImport, MapOptions, read_map};
use planecut_testkit::data::data;
use serde_json::Value;

planecut_testkit::tests_on_data!(
    brush_counts_are_those_of_the_reference,
    counts_are_those_of_the_comments,
    lines_are_those_of_opening_braces,
    boxes_have_the_bounds_of_the_reference,
    editor_fixtures,
    a_quoted_template_read_as_a_map
);

/// All maps, as `folder/file` and text, by name.
fn maps() -> Vec<(String, Vec<u8>)> {
    let folder = data("map");
    let entries = |path: &Path| std::fs::read_dir(path).expect("a folder").map(|e| e.expect("an entry").path());
    let files = entries(&folder).filter(|path| path.is_dir()).flat_map(|path| entries(&path).collect::<Vec<_>>());
    let mut maps: Vec<(String, Vec<u8>)> = files
        .filter(|path| path.extension().is_some_and(|ending| ending == "map"))
        .map(|path| {
            let name = path.strip_prefix(&folder).expect("inside").to_str().expect("a plain name").replace('\\', "/");
            (name, std::fs::read(&path).expect("a readable file"))
        })
        .collect();
    maps.sort();
    maps
}

fn reference() -> Value {
    let text = std::fs::read(data("map/reference.json")).expect("reference.json");
    serde_json::from_slice(&text).expect("JSON")
}

fn read(name: &str) -> MapImport {
    let text = std::fs::read(data("map").join(name)).expect("a readable file");
    read_map(&text, name, &MapOptions::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn brush_counts_are_those_of_the_reference() {
    let reference = reference();
    let mut compared = 0;
    for (name, text) in maps() {
        let Some(brushes) = reference[&name]["brushes"].as_u64() else { continue };
        let import = read_map(&text, &name, &MapOptions::default()).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(import.model.tree.brushes().len() as u64, brushes, "{name}");
        assert_eq!(import.warnings, [], "{name}");
        compared += 1;
    }
    let stated = reference.as_object().expect("an object").values().filter(|map| map["brushes"].is_u64()).count();
    assert_eq!(compared, stated);
}

/// An editor's map says so itself: it numbers entities and brushes in comments.
fn counts_are_those_of_the_comments() {
    for (name, text) in maps() {
        let Ok(import) = read_map(&text, &name, &MapOptions::default()) else { continue };
        let text = String::from_utf8_lossy(&text);
        let comments = |word| text.lines().filter(|line| line.starts_with(word)).count();
        let (entities, brushes) = (comments("// entity "), comments("// brush "));
        if entities > 0 {
            assert_eq!((import.entities, import.brushes_read), (entities, brushes), "{name}");
        }
    }
}

fn lines_are_those_of_opening_braces() {
    for (name, text) in maps() {
        let Ok(import) = read_map(&text, &name, &MapOptions::default()) else { continue };
        let text = String::from_utf8_lossy(&text);
        let lines: Vec<&str> = text.lines().collect();
        for line in import.model.tree.source_lines() {
            let line = line.expect("a brush of a file").get() as usize;
            assert_eq!(lines[line - 1].trim(), "{", "{name}:{line}");
            assert!(lines[line].trim_start().starts_with('('), "{name}:{line}");
        }
    }
}

/// The bounds of a box are the offsets of its axis planes.
fn boxes_have_the_bounds_of_the_reference() {
    let reference = reference();
    for name in ["ericw/q1_cube.map", "trenchbroom/cube.map"] {
        let import = read(name);
        let mut bounds = [f64::NAN; 6];
        for face in &import.model.tree.brushes()[0].faces {
            let normal = face.half_space.normal().to_array();
            let axis = normal.iter().position(|n| *n != 0.0).expect("a normal");
            let slot = if normal[axis] < 0.0 { axis } else { axis + 3 };
            bounds[slot] = face.half_space.offset() / normal[axis];
        }
        let expected: Vec<f64> = serde_json::from_value(reference[name]["bbox"].clone()).expect("six numbers");
        assert_eq!(bounds.to_vec(), expected, "{name}");
    }
}

/// Every editor fixture gives what is stated here: `Ok((brushes, patches, faces left out))` or the line of the error.
fn editor_fixtures() {
    let expected = [
        ("01_Worldspawn_and_one_brush", Ok((1, 0, 0))),
        ("05_Quake_2_brush_format", Ok((1, 0, 0))),
        ("07_Quake_3_Valve220_brush_format", Ok((1, 0, 0))),
        ("08_Daikatana_brush_format", Ok((1, 0, 0))),
        ("10_Daikatana_map_header", Ok((1, 0, 0))),
        // Cut off inside a quoted value.
        ("13_Ordered_layers_with_gaps_and_duplicates", Err(Some(21))),
        ("15_Grouped_entities_and_brushes", Ok((5, 0, 0))),
        ("18_Quake_3_patch", Ok((0, 1, 0))),
        ("19___TB_empty_material_name", Ok((1, 0, 0))),
        // A template with all braces doubled, not a map.
        ("20_Quoted_material_names", Err(Some(3))),
        ("21_1424", Ok((1, 0, 2))),
    ];
    for (name, text) in maps() {
        let Some(fixture) = name.strip_prefix("tb_worldreader/").and_then(|file| file.strip_suffix(".map")) else {
            continue;
        };
        let found = read_map(&text, &name, &MapOptions::default())
            .map(|import| (import.model.tree.brushes().len(), import.patches_left_out, import.faces_left_out))
            .map_err(|error| error.line());
        let stated = expected.iter().find(|(stated, _)| *stated == fixture).map(|(_, result)| *result);
        assert_eq!(Some(found), stated, "{name}");
    }
}

fn a_quoted_template_read_as_a_map() {
    let template = std::fs::read_to_string(data("map/tb_worldreader/20_Quoted_material_names.map")).expect("a text");
    let text = template.replace("{{", "{").replace("}}", "}").replace("{0}", r#""some \"quoted\" {name}""#);
    let import = read_map(text.as_bytes(), "m", &MapOptions::default()).expect("a map");
    let names: Vec<&str> = import.model.materials.iter().map(|material| material.name.as_str()).collect();
    assert_eq!((import.model.tree.brushes().len(), names), (1, vec![r#"some "quoted" {name}"#]));
}
