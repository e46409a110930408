//! Models on which version 0.1 failed, by name; what each showed is in the README of the data. Those of the readers are in `losses.rs`, those of
//! coarsening in `enclosed.rs`, those of `check` in `check.rs`.

use std::path::{Path, PathBuf};

use planecut_testkit::data::data;
use serde_json::Value;

use crate::support::{agree, folder, planecut};

planecut_testkit::tests_on_data!(
    sheets_around_a_line_do_not_cross,
    a_body_far_away_or_a_tool_without_end_erases_nothing,
    a_face_is_not_folded,
    a_rotated_pencil_passes_the_check,
    parts_with_slivers_pass_the_check,
    a_mesh_that_crosses_itself_is_refused_without_a_panic,
);

/// Builds a file as a mesh in double precision, in `folder`; gives the mesh and the report.
#[track_caller]
fn built(folder: &Path, name: &str) -> (PathBuf, Value) {
    let (mesh, report) = (folder.join("out.obj"), folder.join("report.json"));
    let input = data(name);
    let arguments = ["build", "--quiet", "-o"].map(AsRef::as_ref);
    let outputs = [mesh.as_os_str(), "--report".as_ref(), report.as_os_str(), input.as_os_str()];
    planecut(arguments.into_iter().chain(outputs)).expect_quiet_success();
    let report = std::fs::read(&report).expect("a report");
    (mesh, serde_json::from_slice(&report).expect("JSON"))
}

/// Builds a file and has its mesh checked, in double and in single precision; gives the report.
#[track_caller]
fn built_soundly(name: &str) -> Value {
    let folder = folder();
    let (mesh, report) = built(folder.path(), name);
    let single = folder.path().join("out.glb");
    let input = data(name);
    let arguments = ["build", "--quiet", "-o"].map(AsRef::as_ref);
    planecut(arguments.into_iter().chain([single.as_os_str(), input.as_os_str()])).expect_quiet_success();
    for mesh in [mesh, single] {
        let check = planecut(["check".as_ref(), mesh.as_os_str()]);
        assert_eq!(check.status, 0, "{name}: {}", check.stderr);
    }
    assert!(agree(&report["mesh"]["volume"], report["solid"]["volume"].as_f64().expect("a volume"), 1e-6), "{report}");
    report
}

fn sheets_around_a_line_do_not_cross() {
    for name in ["min_wedge_error", "min_edgecross_xorwedge2", "min_edgecross_diag"] {
        built_soundly(&format!("regressions/{name}.json"));
    }
}

/// A plate of 1 × 1 × 1e-3, or 1e-6, beside a unit cube; a unit cube of which a quarter is cut off.
fn a_body_far_away_or_a_tool_without_end_erases_nothing() {
    let cases =
        [("stray_plate_1e-3_far_1e9", 1.001), ("stray_plate_1e-6_far_1e6", 1.000_001), ("big_cutter_1e12", 0.75)];
    for (name, volume) in cases {
        let folder = folder();
        let (_, report) = built(folder.path(), &format!("regressions/{name}.json"));
        // at 1e9 a coordinate is rounded by 1e-7
        assert!(agree(&report["mesh"]["volume"], volume, 1e-6), "{name}: {report}");
        assert_eq!(report["noise"]["collapsed"], 0, "{name}");
    }
}

fn a_face_is_not_folded() {
    built_soundly("regressions/min_fold.json");
}

fn a_rotated_pencil_passes_the_check() {
    built_soundly("regressions/pencilrot_6_check_cross.json");
}

fn parts_with_slivers_pass_the_check() {
    built_soundly("regressions/keys.csg");
    built_soundly("regressions/mfxsp20.map");
}

fn a_mesh_that_crosses_itself_is_refused_without_a_panic() {
    let rabbit = data("mesh/trimesh/rabbit.obj");
    let folder = folder();
    let out = folder.path().join("out.glb");
    let run = planecut(["build".as_ref(), rabbit.as_os_str(), "-o".as_ref(), out.as_os_str()]);
    assert!(matches!(run.status, 0..=3) && !run.stderr.contains("panicked"), "{}: {}", run.status, run.stderr);
    assert_eq!(run.status == 0 || run.status == 3, out.exists(), "{}", run.stderr);
}
