//! Damaged inputs: one line that names the file, exit status 2, nothing written, and what was there before left alone.

use std::path::{Path, PathBuf};

use crate::support::{ROOT, Run, everything_in, folder, planecut};

/// Files of the readers' own tests that are not damaged badly enough to be refused.
const READABLE: [&str; 3] = ["whole.map", "zero_area_face.map", "all_faces_without_area.map"];

fn damaged_maps() -> Vec<PathBuf> {
    let folder = Path::new(ROOT).join("import/tests/suite/map/damaged");
    let entries = std::fs::read_dir(folder).expect("the folder of the readers' tests");
    entries.map(|entry| entry.expect("an entry").path()).collect()
}

fn build_all_outputs(input: &Path, folder: &Path) -> Run {
    let mut args: Vec<PathBuf> = vec!["build".into(), input.into()];
    for (option, name) in [("-o", "a.glb"), ("-o", "sub/a.obj"), ("--preview", "a.png"), ("--report", "a.json")] {
        args.extend([option.into(), folder.join(name)]);
    }
    planecut(args)
}

#[test]
fn each_is_refused_with_one_line_and_leaves_nothing() {
    let mut refused = 0;
    for input in damaged_maps() {
        let name = input.file_name().and_then(|name| name.to_str()).expect("a plain name");
        if READABLE.contains(&name) {
            continue;
        }
        let folder = folder();
        build_all_outputs(&input, folder.path()).expect_error(2, name);
        assert_eq!(everything_in(folder.path()), [""; 0], "{name}");
        planecut(["info".as_ref(), input.as_os_str()]).expect_error(2, name);
        refused += 1;
    }
    assert!(refused > 0);
}

#[test]
fn the_others_are_built() {
    for input in damaged_maps().into_iter().filter(|path| READABLE.iter().any(|name| path.ends_with(name))) {
        let folder = folder();
        let run = build_all_outputs(&input, folder.path());
        // what has too few faces with an area is left out
        let expected = if input.ends_with("whole.map") { 0 } else { 3 };
        assert_eq!(run.status, expected, "{}", run.stderr);
        assert!(run.stderr.lines().all(|line| line.starts_with("warning: ")), "{}", run.stderr);
        assert_eq!(everything_in(folder.path()), ["a.glb", "a.json", "a.obj", "a.png", "sub"]);
    }
}

#[test]
fn older_outputs_stay_when_the_input_is_damaged() {
    let folder = folder();
    let (input, output) = (folder.path().join("m.map"), folder.path().join("a.glb"));
    std::fs::write(&input, "{ {").expect("written");
    std::fs::write(&output, "old").expect("written");
    planecut(["build".as_ref(), input.as_os_str(), "-o".as_ref(), output.as_ref()]).expect_error(2, "m.map:1: found");
    assert_eq!(std::fs::read(&output).expect("still there"), b"old");
    assert_eq!(everything_in(folder.path()), ["a.glb", "m.map"]);
}

#[test]
fn maps_damaged_at_random_are_built_or_refused() {
    damage_at_random("import/tests/suite/map/damaged/whole.map", "m.map", b"{}()\"0-9.e \n");
}

#[test]
fn trees_damaged_at_random_are_built_or_refused() {
    damage_at_random("examples/csg/clamp.csg", "m.csg", b"{}()[],;=%#*!0-9.e \n");
}

/// What cuts, repeats and flips of bytes make of a good file is built or refused, but never a panic or a hang.
fn damage_at_random(whole: &str, name: &str, bytes: &[u8]) {
    let whole = std::fs::read(Path::new(ROOT).join(whole)).expect("the undamaged file");
    let folder = folder();
    let input = folder.path().join(name);
    let seed = 0x5eed_u64;
    println!("seed {seed}");
    let mut state = seed;
    let mut below = |limit: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % limit
    };
    for round in 0..100 {
        let mut text = whole.clone();
        for _ in 0..=below(3) {
            let place = below(text.len());
            match below(3) {
                0 => text.truncate(place.max(1)),
                1 => text[place] = bytes[below(bytes.len())],
                _ => text.extend_from_slice(&whole[place.min(whole.len() - 1)..]),
            }
        }
        std::fs::write(&input, &text).expect("written");
        let run = planecut(["info".as_ref(), input.as_os_str()]);
        match run.status {
            0 | 3 => assert!(serde_json::from_slice::<serde_json::Value>(&run.stdout).is_ok(), "round {round}"),
            _ => run.expect_error(2, name),
        }
    }
}
