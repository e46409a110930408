//! Arguments that make no sense: exit status 2 and one line, before any work is done.

use std::path::Path;

use crate::support::{block, everything_in, folder, planecut, write_map};

/// Runs `planecut` in a folder that holds a good `m.map`, a folder `d.obj` and a folder `d.map`, and expects it to be
/// refused with one line about `words`.
#[track_caller]
fn refused(args: &str, words: &str) {
    let folder = folder();
    write_map(folder.path(), "m.map", &[block([0; 3], [1; 3], "stone")]);
    std::fs::write(folder.path().join("m.csg"), "cube();").expect("written");
    for name in ["d.obj", "d.map"] {
        std::fs::create_dir(folder.path().join(name)).expect("made");
    }
    let before = everything_in(folder.path());
    let run = crate::support::finish(crate::support::command().current_dir(&folder).args(args.split(' ')));
    run.expect_error(2, words);
    assert_eq!(run.stdout, b"");
    assert_eq!(everything_in(folder.path()), before, "{args}");
}

#[test]
fn arguments_the_parser_does_not_know() {
    refused("biuld m.map", "biuld");
    refused("build m.map", "-o");
    refused("build m.map -o a.glb --reprot r.json", "--reprot");
    refused("build m.map -o a.glb n.map", "found 2 inputs, expected one, or --combine union");
    refused("build m.map n.map -o a.glb --combine sum", "sum");
    refused("build - - -o a.glb --combine union", "standard input twice");
    refused("build m.map -o a.glb --close 0", "above 0");
    refused("build m.map -o a.glb --close 0.1", "--winding or --close with another input");
    refused("build m.map -o a.glb --winding even", "even");
    refused("coarsen m.map n.map -o a.glb", "n.map");
    refused("build -o a.glb", "INPUT");
    refused("coarsen m.map -o a.glb --max-cells 0", "at least 1");
    refused("coarsen m.map -o a.glb --max-faces 5", "at least 6");
    refused("coarsen m.map -o a.glb --max-vertices 7", "at least 8");
    refused("coarsen m.map -o a.glb --max-excess=-0.1", "not negative");
    refused("coarsen m.map -o a.glb --min-thickness nan", "between 0");
    refused("coarsen m.map -o a.glb --inner --max-faces 8", "--inner");
    refused("render m.map -o a.png --style sketch", "sketch");
}

#[test]
fn numbers_out_of_range() {
    for threads in ["0", "-1", "1.5", "many", "1025", "99999999999999999999"] {
        refused(&format!("build m.map -o a.glb --threads {threads}"), threads);
    }
    for size in ["0x0", "640", "99999x99999", "16384x16384", "1e3x1e3"] {
        refused(&format!("build m.map -o a.glb --preview p.png --preview-size {size}"), size);
        refused(&format!("render m.map -o p.png --size {size}"), size);
    }
    for scale in ["0", "-1", "nan", "inf", "1e99"] {
        refused(&format!("build m.map -o a.glb --scale {scale}"), scale);
    }
    refused("check a.obj --tolerance -1", "-1");
}

#[test]
fn names_that_do_not_end_well() {
    refused("build m.map -o a.fbx", "a.fbx: found a name that ends in `.fbx`, expected `.glb`");
    refused("build m.map -o a", "a: found a name without an ending");
    refused("build m.map -o a.glb --preview p.jpg", "p.jpg: found");
    refused("render m.map -o p.jpg", "p.jpg: found");
    refused(
        "build m.scad -o a.glb",
        "m.scad: found a name that ends in `.scad`, expected `.json`, `.map`, `.csg`, `.obj`",
    );
    refused("info m.xyz", "m.xyz: found");
    refused("check m.map", "m.map: found a name that ends in `.map`, expected a mesh");
}

#[test]
fn options_for_another_input() {
    refused("build m.map -o a.glb --set a=1", "found --set with another input, expected it with a model file (.json)");
    refused("info m.map --set a=1", "found --set with another input");
    refused(
        "build m.json -o a.glb --world-only",
        "found --world-only, --skip-texture or --skip-class with another input",
    );
    refused("render - -o a.png --skip-class x", "expected it with a map (.map)");
    for setting in ["a", "a=", "=1", "a=b", "a=nan", "a=1e999"] {
        refused(&format!("build m.json -o a.glb --set {setting}"), "expected NAME=VALUE, the value a number");
    }
    refused("build m.json -o a.glb --input-format dxf", "dxf");
    refused(
        "build m.json -o a.glb --keep-going",
        "found --keep-going with another input, expected it with an OpenSCAD tree",
    );
    refused("info m.obj --input-format map --set a=1", "found --set with another input");
}

#[test]
fn outputs_that_cannot_be() {
    refused("build m.map -o d.obj", "d.obj: found a folder");
    refused("build m.map -o a.obj -o ./a.obj", "a.obj: found two outputs of this name");
    refused("build m.map -o a.obj --report a.obj", "a.obj: found two outputs of this name");
    refused("build m.map -o a.obj --report d.obj/../m.map", "m.map: found the input");
    refused("build m.map -o -", "--format");
    refused("build m.map -o a.obj --format obj", "-o -");
    refused("build m.map -o - --format fbx", "fbx");
    refused("build m.map -o - --format obj --report -", "standard output twice");
}

#[test]
fn inputs_that_are_not_there() {
    refused("build n.map -o a.glb", "n.map: found no such file");
    refused("build d.map -o a.glb", "d.map: found a folder");
    refused("info n.stl", "n.stl: found no such file");
    refused("check n.obj", "n.obj: found no such file");
}

#[test]
fn help_and_version_go_to_standard_output() {
    for args in [vec!["--help"], vec!["build", "--help"], vec!["--version"], vec!["help", "check"]] {
        let run = planecut(&args).expect_quiet_success();
        assert!(!run.stdout.is_empty(), "{args:?}");
    }
    let version = String::from_utf8(planecut(["--version"]).stdout).expect("UTF-8");
    assert_eq!(version, format!("planecut {}\n", env!("CARGO_PKG_VERSION")));
}

#[test]
fn no_arguments_are_an_error_of_one_line() {
    planecut([] as [&Path; 0]).expect_error(2, "subcommand");
}

#[cfg(unix)]
#[test]
fn a_file_name_cannot_break_the_line() {
    planecut(["info", "a\nerror: b\x1b[2J.map"]).expect_error(2, "found no such file");
}
