//! `planecut coarsen` from its arguments to its files.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};

use crate::support::{Run, folder as scratch, planecut};

/// Four steps of a stair, each a body of its own.
fn stairs(folder: &Path) -> String {
    let step = |k: u32| json!({"box": {"min": [k, 0, 0], "max": [k + 1, 1, k + 1]}});
    let model = json!({"planecut": 1, "model": {"union": (0..4).map(step).collect::<Vec<_>>()}});
    let path = folder.join("stairs.json");
    fs::write(&path, model.to_string()).expect("written");
    path.display().to_string()
}

fn coarsen(input: &str, folder: &Path, more: &str) -> Run {
    let mut args = vec!["coarsen".to_owned(), input.to_owned()];
    args.extend(more.split_whitespace().map(|word| word.replace("DIR", &folder.display().to_string())));
    planecut(args)
}

fn report(folder: &Path) -> Value {
    serde_json::from_slice(&fs::read(folder.join("r.json")).expect("a report")).expect("JSON")
}

/// The JSON of a GLB.
fn glb_json(path: &Path) -> Value {
    let bytes = fs::read(path).expect("a file");
    let length = u32::from_le_bytes(bytes[12..16].try_into().expect("four bytes")) as usize;
    serde_json::from_slice(&bytes[20..20 + length]).expect("JSON")
}

#[test]
fn cells_are_written_as_colliders_and_told_in_the_report() {
    let folder = scratch();
    let input = stairs(folder.path());
    let options = "-o DIR/a.glb -o DIR/a.obj --max-cells 2 --report DIR/r.json --name cell{}-convcolonly";
    coarsen(&input, folder.path(), options).expect_quiet_success();
    let report = report(folder.path());
    let told = &report["coarsen"];
    assert_eq!((&told["cells_in"], &told["cells_out"], &told["exact_merges"]), (&json!(4), &json!(2), &json!(0)));
    assert_eq!((told["volume_in"].as_f64(), told["volume_out"].as_f64()), (Some(10.0), Some(11.0)));
    assert_eq!((told["excess"].as_f64(), told["sum_excess"].as_f64()), (Some(0.1), Some(0.1)));
    assert_eq!((report["mesh"]["components"].as_u64(), report["solid"]["volume"].as_f64()), (Some(2), Some(10.0)));
    let glb = glb_json(&folder.path().join("a.glb"));
    for number in 0..2 {
        let node = &glb["nodes"][number + 1];
        assert_eq!(node["name"], format!("cell{number}-convcolonly"));
        assert_eq!(node["extras"], json!({"collider": "convex"}));
        assert!(node["mesh"].is_u64());
    }
    let obj = fs::read_to_string(folder.path().join("a.obj")).expect("text");
    assert_eq!(obj.lines().filter(|line| line.starts_with("o ")).count(), 2);
}

#[test]
fn a_file_for_each_cell() {
    let folder = scratch();
    let input = stairs(folder.path());
    coarsen(&input, folder.path(), "-o DIR/parts/cell_{}.obj -o DIR/{}.stl --max-cells 3").expect_quiet_success();
    let cells: Vec<String> =
        (0..3).map(|k| folder.path().join(format!("parts/cell_{k}.obj")).display().to_string()).collect();
    for cell in &cells {
        planecut(["check", cell]).expect_quiet_success();
    }
    assert!(folder.path().join("2.stl").is_file() && !folder.path().join("3.stl").exists());
}

/// A sheet between two boxes, as thick as two roundings: it is part of what is enclosed, and has a number in all formats.
#[test]
fn numbers_of_files_are_the_same_in_all_formats() {
    let folder = scratch();
    let sheet = 3.0 + 2.0 * f64::EPSILON;
    let boxes = [(0.0, 1.0), (3.0, sheet), (5.0, 6.0)];
    let nodes = boxes.map(|(min, max)| json!({"box": {"min": [min, 0, 0], "max": [max, 1, 1]}}));
    let path = folder.path().join("sheet.json");
    fs::write(&path, json!({"planecut": 1, "model": {"union": nodes}}).to_string()).expect("written");
    let endings = ["glb", "obj", "stl", "map", "csg"];
    let outputs = endings.map(|ending| format!("-o DIR/part_{{}}.{ending} -o DIR/all.{ending}")).join(" ");
    let run = coarsen(&path.display().to_string(), folder.path(), &format!("{outputs} -q"));
    assert_eq!(run.status, 0, "{}", run.stderr);
    // vertices are farther from each other than 2⁻²² of the size of all cells; a thin cell grows by that, and by its roundings, to either side
    let thickest = 6.0 * f64::powi(2.0, -20);
    for ending in endings {
        let info = |name: &str| planecut(["info", &folder.path().join(name).display().to_string()]).json();
        for (number, min) in [(0, 0.0), (2, 5.0)] {
            let solid = info(&format!("part_{number}.{ending}"))["solid"].clone();
            assert_eq!((&solid["min"], &solid["volume"]), (&json!([min, 0.0, 0.0]), &json!(1.0)), "{number} {ending}");
        }
        let solid = info(&format!("part_1.{ending}"))["solid"].clone();
        let reach = ["min", "max"].map(|end| solid[end][0].as_f64().expect("a number"));
        assert!(reach[0] <= 3.0 && reach[1] >= sheet && reach[1] - reach[0] < thickest, "{ending}: {reach:?}");
        assert!(!folder.path().join(format!("part_3.{ending}")).exists(), "{ending}");
        let volume = info(&format!("all.{ending}"))["solid"]["volume"].as_f64().expect("a number");
        assert!((volume - 2.0).abs() < thickest, "{ending}: {volume}");
    }
}

#[test]
fn what_was_written_is_read_again_as_so_many_cells() {
    let folder = scratch();
    let input = stairs(folder.path());
    for ending in ["obj", "glb"] {
        coarsen(&input, folder.path(), &format!("-o DIR/a.{ending} --max-cells 3")).expect_quiet_success();
        let written = folder.path().join(format!("a.{ending}")).display().to_string();
        coarsen(&written, folder.path(), "-o DIR/b.glb --max-cells 1 --report DIR/r.json").expect_quiet_success();
        let report = report(folder.path());
        assert_eq!(report["coarsen"]["cells_in"], json!(3), "{ending}");
        // the ramp over all steps
        assert_eq!(report["coarsen"]["volume_out"].as_f64(), Some(11.5), "{ending}");
    }
}

#[test]
fn limits_that_cannot_be_met_together_are_told() {
    let folder = scratch();
    let input = stairs(folder.path());
    let run = coarsen(&input, folder.path(), "-o DIR/a.glb --max-cells 1 --max-excess 0.06 --report DIR/r.json");
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(run.stderr.starts_with("warning: ") && run.stderr.contains("1 were asked for"), "{}", run.stderr);
    assert_eq!(report(folder.path())["coarsen"]["cells_out"], json!(3));
}

#[test]
fn openings_stay_clear() {
    let folder = scratch();
    let wall = json!({"planecut": 1, "model": {"difference": [
        {"box": {"min": [0, 0, 0], "max": [3, 1, 3]}}, {"box": {"min": [1, -1, 0], "max": [2, 2, 2]}}]}});
    let door = json!({"planecut": 1, "model": {"box": {"min": [1, 0, 0], "max": [2, 1, 2]}}});
    for (name, model) in [("wall.json", wall), ("door.json", door)] {
        fs::write(folder.path().join(name), model.to_string()).expect("written");
    }
    let input = folder.path().join("wall.json").display().to_string();
    coarsen(&input, folder.path(), "-o DIR/a.glb --max-cells 1 --report DIR/r.json").expect_quiet_success();
    assert_eq!(report(folder.path())["coarsen"]["volume_out"].as_f64(), Some(9.0));
    let run =
        coarsen(&input, folder.path(), "-o DIR/a.glb --max-cells 1 --keep-clear DIR/door.json --report DIR/r.json -q");
    run.expect_quiet_success();
    assert_eq!(report(folder.path())["coarsen"]["volume_out"].as_f64(), Some(7.0));
}

#[test]
fn what_a_ball_can_reach_stays_clear() {
    let folder = scratch();
    let wall = json!({"planecut": 1, "model": {"difference": [
        {"box": {"min": [0, 0, 0], "max": [3, 1, 3]}}, {"box": {"min": [1, -1, 0], "max": [2, 2, 2]}}]}});
    fs::write(folder.path().join("wall.json"), wall.to_string()).expect("written");
    let input = folder.path().join("wall.json").display().to_string();
    let volume_with = |options: &str| {
        let options = format!("-o DIR/a.glb -o DIR/wall.stl --max-cells 1 -q --report DIR/r.json {options}");
        coarsen(&input, folder.path(), &options).expect_quiet_success();
        report(folder.path())["coarsen"]["volume_out"].as_f64()
    };
    assert_eq!(volume_with("--clear-radius 0.4"), Some(7.0));
    assert_eq!(report(folder.path())["coarsen"]["clear_tolerance"].as_f64(), Some(0.1));
    // it comes into the door by less than its tolerance
    assert_eq!(volume_with("--clear-radius 2"), Some(9.0));
    coarsen(&input, folder.path(), "-o DIR/b.glb --clear-radius 1e-3").expect_error(1, "clear_radius");
    coarsen(&input, folder.path(), "-o DIR/b.glb --clear-radius 0").expect_error(2, "--clear-radius");
    coarsen(&input, folder.path(), "-o DIR/b.glb --clear-radius 1 --inner").expect_error(2, "--inner");
    assert!(!folder.path().join("b.glb").exists());
}

#[test]
fn the_same_bytes_on_any_number_of_threads() {
    let folder = scratch();
    let input = format!("{}/examples/dovetail.json", crate::support::ROOT);
    let on = |threads: u32| {
        let options =
            format!("-o DIR/a.glb --max-cells 5 --threads {threads} --preview DIR/a.png --preview-size 64x48");
        coarsen(&input, folder.path(), &options).expect_quiet_success();
        ["a.glb", "a.png"].map(|name| fs::read(folder.path().join(name)).expect("a file"))
    };
    assert_eq!(on(1), on(4));
}

#[test]
fn unusable_input_is_refused_and_nothing_written() {
    let folder = scratch();
    let input = stairs(folder.path());
    coarsen(&input, folder.path(), "-o DIR/a.glb --keep-clear DIR/none.json").expect_error(2, "none.json");
    coarsen(&input, folder.path(), "-o DIR/a.glb --keep-clear DIR/none.txt").expect_error(2, "none.txt");
    coarsen(&input, folder.path(), "-o DIR/{}.txt").expect_error(2, ".txt");
    coarsen(&input, folder.path(), "-o DIR/stairs.json").expect_error(2, "stairs.json");
    let empty = folder.path().join("empty.json");
    fs::write(&empty, r#"{"planecut": 1, "model": {"difference": [{"sphere": {"radius": 1, "segments": 8}}, {"sphere": {"radius": 1, "segments": 8}}]}}"#).expect("written");
    coarsen(&empty.display().to_string(), folder.path(), "-o DIR/a.glb").expect_error(1, "empty solid");
    let ball = folder.path().join("ball.json");
    fs::write(&ball, r#"{"planecut": 1, "model": {"sphere": {"radius": 1, "segments": 16}}}"#).expect("written");
    let around = folder.path().join("around.json");
    let shell = r#"{"planecut": 1, "model": {"difference": [{"box": {"min": [-2, -2, -2], "max": [2, 2, 2]}}, {"sphere": {"radius": 1, "segments": 16}}]}}"#;
    fs::write(&around, shell).expect("written");
    let options = "-o DIR/a.glb --max-faces 20 --keep-clear DIR/around.json";
    coarsen(&ball.display().to_string(), folder.path(), options).expect_error(1, "ball.json");
    assert!(!folder.path().join("a.glb").exists());
}

/// Planes that touched cells without carrying a face made the boundary of their union fail to close.
#[test]
fn a_gear_is_coarsened_to_any_number_of_cells() {
    let folder = scratch();
    let input = format!("{}/examples/gear.json", crate::support::ROOT);
    for cells in [3, 8, 20] {
        coarsen(&input, folder.path(), &format!("-o DIR/a.glb --max-cells {cells} --report DIR/r.json"))
            .expect_quiet_success();
        assert_eq!(report(folder.path())["coarsen"]["cells_out"], json!(cells));
    }
}
