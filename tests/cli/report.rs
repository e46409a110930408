//! The report has the shape that scripts rely on, and says what is true of small models.

use serde_json::{Value, json};

use crate::support::{Run, block, folder, planecut, write_map};

/// Two boxes that overlap in a unit cube.
fn two_boxes() -> [String; 2] {
    [block([0; 3], [2; 3], "stone"), block([1; 3], [3; 3], "wood")]
}

fn info(brushes: &[String]) -> Run {
    let folder = folder();
    planecut([std::ffi::OsStr::new("info"), write_map(folder.path(), "m.map", brushes).as_os_str()])
}

/// The keys of a JSON text, in the order in which they stand there.
fn keys(text: &str) -> Vec<&str> {
    text.lines().filter_map(|line| line.trim().strip_prefix('"')?.split_once("\":")).map(|(key, _)| key).collect()
}

#[test]
fn keys_are_those_of_the_contract_in_its_order() {
    let run = info(&two_boxes()).expect_quiet_success();
    let text = String::from_utf8(run.stdout).expect("UTF-8");
    let expected = "planecut input format \
        model brushes planes empty_brushes redundant_planes snapped_planes materials unbounded_brushes brush_volume_sum \
        meshes mesh_triangles \
        solid volume area centroid min max cells \
        mesh vertices triangles faces components genus watertight manifold volume \
        noise collapsed thickest \
        signs total filtered small_int big \
        time_ms import evaluate weld triangulate export preview total \
        left_out warnings";
    assert_eq!(keys(&text), expected.split_whitespace().collect::<Vec<_>>());
    assert!(text.ends_with("}\n"));
}

#[test]
fn two_boxes_have_the_measures_of_two_boxes() {
    let report = info(&two_boxes()).json();
    let model = json!({
        "brushes": 2, "planes": 12, "empty_brushes": 0, "redundant_planes": 0, "snapped_planes": 0,
        "materials": 2, "unbounded_brushes": 0, "brush_volume_sum": 16.0, "meshes": 0, "mesh_triangles": 0
    });
    assert_eq!(report["model"], model);
    // Of each box's surface 3 of 24 units lie inside the other box.
    let solid = json!({
        "volume": 15.0, "area": 42.0, "centroid": [1.5, 1.5, 1.5], "min": [0.0, 0.0, 0.0], "max": [3.0, 3.0, 3.0],
        "cells": null
    });
    assert_eq!(report["solid"], solid);
    let mesh = &report["mesh"];
    // Seven corners of each box are left, and six points in which an edge of one meets a face of the other.
    assert_eq!((&mesh["vertices"], &mesh["faces"], &mesh["volume"]), (&json!(20), &json!(12), &json!(15.0)));
    assert_eq!((&mesh["components"], &mesh["genus"]), (&json!(1), &json!(0)));
    assert_eq!((&mesh["watertight"], &mesh["manifold"]), (&json!(true), &json!(true)));
    assert_eq!((&report["format"], &report["warnings"]), (&json!("map"), &json!([])));
}

#[test]
fn tiers_of_signs_add_up_to_the_total() {
    let signs = &info(&two_boxes()).json()["signs"];
    let count = |key: &str| signs[key].as_u64().expect("a count");
    assert!(count("total") > 0);
    assert_eq!(count("total"), count("filtered") + count("small_int") + count("big"));
}

#[test]
fn stages_take_no_longer_than_the_whole() {
    let times = info(&two_boxes()).json()["time_ms"].clone();
    let time = |key: &str| times[key].as_f64().expect("a number");
    let stages = ["import", "evaluate", "weld", "triangulate", "export", "preview"].map(time);
    assert!(stages.iter().all(|stage| *stage >= 0.0));
    // Each figure is cut to a microsecond.
    assert!(stages.iter().sum::<f64>() <= time("total") + 0.01, "{times}");
}

#[test]
fn a_room_has_an_inner_surface_and_a_ring_has_a_handle() {
    let walls = |min: [i32; 3], max: [i32; 3]| block(min, max, "stone");
    let ring = [
        walls([0, 0, 0], [4, 1, 1]),
        walls([0, 3, 0], [4, 4, 1]),
        walls([0, 0, 0], [1, 4, 1]),
        walls([3, 0, 0], [4, 4, 1]),
    ];
    let mesh = info(&ring).json()["mesh"].clone();
    assert_eq!((&mesh["components"], &mesh["genus"], &mesh["volume"]), (&json!(1), &json!(1), &json!(12.0)));
    let mut room = ring.to_vec();
    room.extend([walls([0, 0, 1], [4, 4, 2]), walls([0, 0, -1], [4, 4, 0])]);
    let mesh = info(&room).json()["mesh"].clone();
    assert_eq!((&mesh["components"], &mesh["genus"], &mesh["volume"]), (&json!(2), &json!(0), &json!(44.0)));
}

#[test]
fn brushes_that_add_nothing_are_counted_and_warned_of() {
    let unit = block([0; 3], [1; 3], "stone");
    let unbounded: Vec<&str> = unit.lines().filter(|line| !line.contains("( 1 1 1 )")).collect();
    let brushes = [block([5; 3], [4; 3], "stone"), unit.clone(), unbounded.join("\n") + "\n"];
    let run = info(&brushes);
    let report = run.lossy_json();
    assert_eq!((run.status, &report["left_out"]), (3, &json!(1)), "the one without end");
    let model = &report["model"];
    assert_eq!(
        (&model["brushes"], &model["empty_brushes"], &model["unbounded_brushes"]),
        (&json!(3), &json!(1), &json!(1))
    );
    assert_eq!(report["solid"]["volume"], json!(1.0));
    let expected =
        json!(["line 3: left out a brush without interior", "line 19: left out a brush that is not bounded"]);
    assert_eq!(report["warnings"], expected);
    let told: Vec<&str> = run.stderr.lines().collect();
    assert!(
        told.len() == 2 && told.iter().all(|line| line.starts_with("warning: ") && line.contains("m.map:")),
        "{told:?}"
    );
}

#[test]
fn an_empty_result_is_a_result() {
    let folder = folder();
    let map = write_map(folder.path(), "m.map", &[]);
    let (mesh, report) = (folder.path().join("m.obj"), folder.path().join("r.json"));
    let run = planecut([
        "build".as_ref(),
        map.as_os_str(),
        "-o".as_ref(),
        mesh.as_ref(),
        "--report".as_ref(),
        report.as_ref(),
    ]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(run.stderr.contains("the result is empty"), "{}", run.stderr);
    let report: Value = serde_json::from_slice(&std::fs::read(report).expect("a report")).expect("JSON");
    let expected = json!({
        "vertices": 0, "triangles": 0, "faces": 0, "components": 0, "genus": 0, "watertight": true, "manifold": true,
        "volume": 0.0
    });
    assert_eq!((&report["mesh"], &report["solid"]["volume"]), (&expected, &json!(0.0)));
    assert!(mesh.is_file());
}

#[test]
fn options_choose_brushes() {
    let folder = folder();
    let map = write_map(folder.path(), "m.map", &two_boxes());
    let run = planecut(["info".as_ref(), map.as_os_str(), "--skip-texture".as_ref(), "WO*".as_ref()]);
    assert_eq!(run.json()["solid"]["volume"], json!(8.0));
    let run = planecut(["info".as_ref(), map.as_os_str(), "--skip-class".as_ref(), "world*".as_ref(), "-q".as_ref()]);
    assert_eq!((run.json()["model"]["brushes"].clone(), run.stderr.as_str()), (json!(0), ""));
}
