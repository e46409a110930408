//! Real trees, held against volumes that others computed.

use std::fs;

use planecut_check::check_topology;
use planecut_csg::evaluate;
use planecut_import::scad::{ScadOptions, read_scad};
use planecut_testkit::data::data;
use serde_json::Value;

planecut_testkit::tests_on_data!(volumes_are_those_of_the_reference);

/// What differs, and why.
const KNOWN: [(&str, &str); 3] = [
    ("tests3d_issues/issue2841.csg", "the reference is a known error of OpenSCAD: less than the volume of one operand"),
    ("tests3d_issues/issue2841b.csg", "the same"),
    ("examples/rotate_extrude.csg", "OpenSCAD's font renderer rounds the outlines of letters"),
];

fn volumes_are_those_of_the_reference() {
    let folder = data("csg");
    let reference = fs::read(folder.join("reference.json")).expect("reference.json");
    let reference: Vec<Value> = serde_json::from_slice(&reference).expect("JSON");
    let mut failures = Vec::new();
    for entry in &reference {
        let file = entry["file"].as_str().expect("a name");
        if KNOWN.iter().any(|(known, _)| *known == file) || entry["ops"].get("text").is_some() {
            continue;
        }
        let expected = entry["volume"].as_f64().expect("a volume");
        let is_twice = entry["checked"].as_str().expect("a text").starts_with("two evaluators");
        let tolerance = if is_twice { 1e-6 } else { 3e-5 };
        let text = fs::read(folder.join(file)).expect("a tree");
        let options = ScadOptions { folder: folder.join(file).with_file_name(""), ..ScadOptions::default() };
        let import = read_scad(&text, file, &options).unwrap_or_else(|error| panic!("{error}"));
        let evaluation = evaluate(&import.model).unwrap_or_else(|error| panic!("{file}: {error}"));
        let volume = evaluation.solid.volume;
        let off = (volume - expected).abs() / expected.abs();
        if off.is_nan() || off > tolerance {
            failures.push(format!("{file}: {volume} for {expected}, off by {off:.1e}"));
        }
        let topology = check_topology(&evaluation.mesh.positions, &evaluation.mesh.triangles);
        if !topology.watertight || !topology.manifold {
            failures.push(format!("{file}: not watertight or not manifold"));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
