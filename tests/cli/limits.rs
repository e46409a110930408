//! Small files that stand for much: done, or refused with the count and the limit before memory or patience end.

use std::time::{Duration, Instant};

use planecut_testkit::data::data;

use super::support::{Run, agree, folder, planecut, run_with};

/// Runs the program, and sees that it took no longer than stated.
#[track_caller]
fn within(seconds: u64, args: &[&str]) -> Run {
    let begin = Instant::now();
    let run = planecut(args);
    assert!(begin.elapsed() < Duration::from_secs(seconds), "{args:?}: {:?}", begin.elapsed());
    run
}

#[cfg(target_os = "linux")]
#[test]
fn what_has_no_end_is_refused_at_the_stated_length_in_every_format() {
    let folder = folder();
    std::fs::write(folder.path().join("box.json"), BOX).expect("written");
    let limit = "found more than 1073741824 bytes, expected no more";
    for ending in ["json", "map", "csg", "obj", "stl", "ply", "glb", "gltf", "jsonl"] {
        let link = folder.path().join(format!("zero.{ending}"));
        std::os::unix::fs::symlink("/dev/zero", &link).expect("a link");
        let link = link.to_str().expect("a name");
        if ending == "jsonl" {
            let model = folder.path().join("box.json");
            let args = ["edit", model.to_str().expect("a name"), link, "-o", "-", "--format", "stl"];
            within(60, &args).expect_error(2, limit);
        } else {
            within(60, &["info", link]).expect_error(2, limit);
        }
    }
}

const BOX: &str = r#"{"planecut": 1, "model": {"box": {"min": [0, 0, 0], "max": [1, 1, 1]}}}"#;

#[test]
fn a_file_that_is_too_long_is_refused_before_it_is_read() {
    let folder = folder();
    for (ending, limit) in
        [("json", 1u64 << 30), ("map", 1 << 30), ("csg", 1 << 30), ("obj", 1 << 32), ("glb", 1 << 32)]
    {
        let path = folder.path().join(format!("long.{ending}"));
        let file = std::fs::File::create(&path).expect("made");
        // takes no place on the disk
        if file.set_len(limit + 1).is_err() {
            return;
        }
        let words = format!("found more than {limit} bytes, expected no more");
        within(10, &["info", path.to_str().expect("a name")]).expect_error(2, &words);
    }
}

#[test]
fn the_limit_of_pieces_is_stated_and_can_be_set() {
    let boxes = r#"{"planecut": 1, "model": {"array": {"of": {"box": {"min": [0, 0, 0], "max": [1, 1, 1]}}, "count": [7, 5, 1], "step": [2, 2, 1]}}}"#;
    let folder = folder();
    let run = |option: &str| run_with(folder.path(), &format!("info - --max-pieces {option}"), boxes.as_bytes());
    assert_eq!(run("35").json()["mesh"]["components"], 35);
    run("34").expect_error(2, "found 35 or more brushes in all, expected at most 34 (--max-pieces)");
    run("0").expect_error(2, "expected a whole number from 1 to 4194304");
    let cubes = "cube(1);".repeat(9);
    let csg = run_with(folder.path(), "info - --input-format csg --max-pieces 8", cubes.as_bytes());
    csg.expect_error(2, "standard input:1: found 9 convex bodies in all, expected at most 8 (--max-pieces)");
}

planecut_testkit::tests_on_data!(
    outlines_and_offsets_that_double_are_done_or_refused,
    chains_of_coplanar_boxes_and_tetrahedra_that_overlap_are_done,
);

fn info_of_data(name: &str) -> Run {
    within(120, &["info", data("regressions").join(name).to_str().expect("a name")])
}

fn outlines_and_offsets_that_double_are_done_or_refused() {
    let outlines = info_of_data("laughs_outline.json").json();
    // an octagon of radius 1, and 39 copies each 0.1 farther
    assert!(agree(&outlines["solid"]["max"][0], 1.0 + 3.9, 1e-12), "{outlines}");
    let offsets = info_of_data("csg_deepoffset.csg");
    offsets.expect_error(2, "csg_deepoffset.csg:1: found outlines of ");
    offsets.expect_error(2, " corners in all, each step counted, expected at most 1048576 (--max-pieces)");
}

fn chains_of_coplanar_boxes_and_tetrahedra_that_overlap_are_done() {
    let boxes = info_of_data("deep_0_slow.json").json();
    assert_eq!(boxes["model"]["brushes"], 3001);
    let bodies = info_of_data("obj_1500tetobjects.obj").json();
    assert_eq!(bodies["model"]["brushes"], 800);
}

#[test]
fn a_large_array_of_separate_boxes_is_built_box_by_box() {
    let folder = folder();
    let model = folder.path().join("array.json");
    let text = BOX.replace(r#"{"box""#, r#"{"array": {"count": [300, 300, 1], "step": [2, 2, 1], "of": {"box""#);
    std::fs::write(&model, text + "}}").expect("written");
    let report = folder.path().join("report.json");
    let name = |path: &std::path::Path| path.to_str().expect("a name").to_owned();
    let mesh = name(&folder.path().join("array.glb"));
    planecut(["build", &name(&model), "-o", &mesh, "--report", &name(&report)]).expect_quiet_success();
    let report: serde_json::Value =
        serde_json::from_slice(&std::fs::read(report).expect("a report")).expect("a report in JSON");
    assert_eq!(report["mesh"]["components"], 90_000);
    assert_eq!(report["mesh"]["triangles"], 12 * 90_000);
    assert_eq!(report["mesh"]["manifold"], true);
    assert!(agree(&report["solid"]["volume"], 90_000.0, 1e-12), "{report}");
    assert!(agree(&report["solid"]["area"], 6.0 * 90_000.0, 1e-12), "{report}");
}

#[test]
fn a_mesh_of_very_many_separate_surfaces_is_read_in_the_end() {
    let folder = folder();
    let name = |file: &str| folder.path().join(file).to_str().expect("a name").to_owned();
    let text = BOX.replace(r#"{"box""#, r#"{"array": {"count": [100, 100, 1], "step": [2, 2, 1], "of": {"box""#);
    std::fs::write(name("array.json"), text + "}}").expect("written");
    planecut(["build", &name("array.json"), "-o", &name("array.obj")]).expect_quiet_success();
    let report = within(60, &["info", &name("array.obj")]).expect_quiet_success();
    let report: serde_json::Value = serde_json::from_slice(&report.stdout).expect("a report in JSON");
    assert_eq!(report["mesh"]["components"], 10_000);
    assert!(agree(&report["solid"]["volume"], 10_000.0, 1e-12), "{report}");
}
