//! The same input gives the same bytes, whatever the thread count; the order of brushes changes no figure.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use planecut_testkit::data::data;
use serde_json::Value;

use crate::support::{agree, folder, keep, planecut};

/// The bytes of every output of one run.
fn outputs(input: &Path, threads: &str) -> BTreeMap<&'static str, Vec<u8>> {
    let folder = folder();
    let names = ["a.glb", "a.gltf", "a.obj", "a.stl", "a.png"];
    let mut args: Vec<PathBuf> = vec!["build".into(), input.into(), "--preview-size".into(), "320x240".into()];
    for name in names {
        args.extend([if name == "a.png" { "--preview" } else { "-o" }.into(), folder.path().join(name)]);
    }
    args.extend(["--threads".into(), threads.into()]);
    planecut(args).expect_quiet_success();
    names.into_iter().map(|name| (name, std::fs::read(folder.path().join(name)).expect("an output"))).collect()
}

#[test]
fn threads_and_repeated_runs_give_the_same_bytes() {
    check_threads(&keep());
}

fn threads_and_repeated_runs_give_the_same_bytes_of_a_level() {
    check_threads(&data("map/romero/e1m1.map"));
}

planecut_testkit::tests_on_data!(threads_and_repeated_runs_give_the_same_bytes_of_a_level);

fn check_threads(input: &Path) {
    let expected = outputs(input, "1");
    for threads in ["1", "2", "5"] {
        for (name, bytes) in outputs(input, threads) {
            assert!(bytes == expected[name], "{} {name} with {threads} threads", input.display());
        }
    }
}

/// A map's text before, between and after its brushes is left out: one entity with all brushes, in the given order.
fn with_brushes_reordered(text: &str, order: impl FnOnce(&mut Vec<Vec<&str>>)) -> String {
    let mut brushes: Vec<Vec<&str>> = Vec::new();
    let mut depth = 0;
    for line in text.lines().map(str::trim) {
        depth += usize::from(line == "{");
        match (depth, line) {
            (2, "{") => brushes.push(Vec::new()),
            (2, line) if line.starts_with('(') => brushes.last_mut().expect("a brush was opened").push(line),
            _ => {}
        }
        depth -= usize::from(line == "}");
    }
    order(&mut brushes);
    let brushes = brushes.iter().map(|faces| format!("{{\n{}\n}}\n", faces.join("\n")));
    format!("{{\n\"classname\" \"worldspawn\"\n{}}}\n", brushes.collect::<String>())
}

fn shuffle<T>(items: &mut [T], mut state: u64) {
    for last in (1..items.len()).rev() {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        items.swap(last, (state >> 33) as usize % (last + 1));
    }
}

fn report_on(text: &str) -> Value {
    let folder = folder();
    let path = folder.path().join("m.map");
    std::fs::write(&path, text).expect("written");
    planecut(["info".as_ref(), path.as_os_str()]).json()
}

/// Where faces of different materials overlap in one plane the last brush wins, so counts are compared with one material.
#[test]
fn the_order_of_brushes_changes_no_figure() {
    let text = std::fs::read_to_string(keep()).expect("the example");
    let same_material = |line: &str| match line.rfind(") ") {
        Some(end) if line.starts_with('(') => {
            let (points, rest) = line.split_at(end + 2);
            let values = rest.split_once(' ').map_or("", |(_, values)| values);
            format!("{points}stone {values}\n")
        }
        _ => format!("{line}\n"),
    };
    let plain: String = text.lines().map(same_material).collect();
    let original = report_on(&with_brushes_reordered(&plain, |_| ()));
    let brushes = original["model"]["brushes"].as_u64();
    assert_eq!(brushes, report_on(&text)["model"]["brushes"].as_u64());
    for seed in 1..=4 {
        println!("seed {seed}");
        let shuffled = report_on(&with_brushes_reordered(&plain, |brushes| shuffle(brushes, seed)));
        for key in ["vertices", "triangles", "faces", "components", "genus", "watertight", "manifold"] {
            assert_eq!(shuffled["mesh"][key], original["mesh"][key], "{key}");
        }
        for key in ["volume", "area"] {
            let expected = original["solid"][key].as_f64().expect("a number");
            assert!(
                agree(&shuffled["solid"][key], expected, 1e-12),
                "{key}: {}, expected {expected}",
                shuffled["solid"][key]
            );
        }
    }
}
