//! Maps that others made, in the data folder; ignored where it is absent.

use planecut_testkit::data::data;
use serde_json::{Value, json};

use crate::support::{Run, agree, planecut};

planecut_testkit::tests_on_data!(volumes_are_those_of_the_reference, editor_fixtures_are_built_or_refused_with_a_line);

fn info(name: &str) -> Run {
    planecut(["info".as_ref(), data("map").join(name).as_os_str()])
}

/// Volumes are those of manifold3d's union, which computes in double precision.
fn volumes_are_those_of_the_reference() {
    let text = std::fs::read(data("map/reference.json")).expect("reference.json");
    let reference: Value = serde_json::from_slice(&text).expect("JSON");
    let mut compared = 0;
    for (name, expected) in reference.as_object().expect("an object") {
        let Some(volume) = expected["union_volume"].as_f64() else { continue };
        let report = info(name).json();
        let mesh = &report["mesh"];
        assert_eq!((&mesh["watertight"], &mesh["manifold"]), (&json!(true), &json!(true)), "{name}");
        assert!(agree(&report["solid"]["volume"], volume, 1e-9), "{name}: {}, expected {volume}", report["solid"]);
        assert!(agree(&mesh["volume"], volume, 1e-9), "{name}: {mesh}, expected {volume}");
        let sum = expected["sum_volume"].as_f64().expect("a sum");
        assert!(agree(&report["model"]["brush_volume_sum"], sum, 1e-9), "{name}: {}, expected {sum}", report["model"]);
        assert_eq!(report["model"]["brushes"], expected["brushes"], "{name}");
        compared += 1;
    }
    assert!(compared > 0);
}

/// Editor fixtures, some of them invalid on purpose: brushes and the volume, or the line of the error.
fn editor_fixtures_are_built_or_refused_with_a_line() {
    let expected: [(&str, Result<u64, &str>); 11] = [
        ("01_Worldspawn_and_one_brush", Ok(1)),
        ("05_Quake_2_brush_format", Ok(1)),
        ("07_Quake_3_Valve220_brush_format", Ok(1)),
        ("08_Daikatana_brush_format", Ok(1)),
        ("10_Daikatana_map_header", Ok(1)),
        ("13_Ordered_layers_with_gaps_and_duplicates", Err(".map:21: found")),
        ("15_Grouped_entities_and_brushes", Ok(5)),
        // nothing but patches, which are left out
        ("18_Quake_3_patch", Ok(0)),
        ("19___TB_empty_material_name", Ok(1)),
        ("20_Quoted_material_names", Err(".map:3: found")),
        ("21_1424", Ok(1)),
    ];
    for (name, expected) in expected {
        let run = info(&format!("tb_worldreader/{name}.map"));
        match expected {
            Err(words) => run.expect_error(2, words),
            Ok(brushes) => {
                let report = run.lossy_json();
                // of a brush, two faces have no area and the others leave it without an end
                let is_lossy = matches!(name, "18_Quake_3_patch" | "21_1424");
                assert_eq!(run.status == 3, is_lossy, "{}", run.stderr);
                assert_eq!(report["model"]["brushes"], json!(brushes), "{name}");
                assert_eq!(report["mesh"]["manifold"], json!(true), "{name}");
            }
        }
    }
}
