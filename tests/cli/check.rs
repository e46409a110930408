//! `check` and `info` on meshes: sound ones, the program's own, and ones with one thing wrong.

use std::path::Path;

use planecut_testkit::data::data;

use crate::support::{agree, block, folder, keep, planecut, write_map};

/// A tetrahedron with one corner at `(x, 0, 0)`, as OBJ; its vertices are numbered from `first`.
fn tetrahedron(x: f64, first: usize) -> String {
    let mut text = String::new();
    for [dx, y, z] in [[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4]] {
        text += &format!("v {} {y} {z}\n", x + f64::from(dx));
    }
    for [a, b, c] in [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]] {
        text += &format!("f {} {} {}\n", first + a, first + b, first + c);
    }
    text
}

fn write_obj(folder: &Path, text: &str) -> std::path::PathBuf {
    let path = folder.join("a.obj");
    std::fs::write(&path, text).expect("written");
    path
}

#[track_caller]
fn not_sound(text: &str, words: &str) {
    let folder = folder();
    let mesh = write_obj(folder.path(), text);
    let run = planecut(["check".as_ref(), mesh.as_os_str()]);
    run.expect_error(1, words);
    assert!(run.stderr.contains("a.obj"), "{}", run.stderr);
    assert_eq!(run.stdout, b"");
}

#[test]
fn a_sound_mesh_gets_one_line_on_standard_output() {
    let folder = folder();
    let mesh = write_obj(folder.path(), &tetrahedron(0.0, 1));
    let run = planecut(["check".as_ref(), mesh.as_os_str()]).expect_quiet_success();
    let line = String::from_utf8(run.stdout).expect("UTF-8");
    assert!(line.contains("watertight, manifold, not self-crossing") && line.lines().count() == 1, "{line}");
}

#[test]
fn each_fault_is_named() {
    let whole = tetrahedron(0.0, 1);
    let open = whole.lines().take(7).collect::<Vec<_>>().join("\n");
    not_sound(&open, "open edge");
    not_sound(&(whole.clone() + "f 1 3 2\nf 1 2 3\n"), "edge between vertices");
    not_sound(&(whole + &tetrahedron(1.0, 5)), "cross");
}

#[test]
fn tolerance_decides_how_deep_a_crossing_counts() {
    let folder = folder();
    let mesh = write_obj(folder.path(), &(tetrahedron(0.0, 1) + &tetrahedron(3.9999, 5)));
    planecut(["check".as_ref(), mesh.as_os_str()]).expect_error(1, "cross");
    planecut(["check".as_ref(), mesh.as_os_str(), "--tolerance".as_ref(), "1e-3".as_ref()]).expect_quiet_success();
}

#[test]
fn what_is_no_mesh_is_unusable() {
    let folder = folder();
    for text in ["", "v 0 0 0\n", "f 1 2 3\n", "v 0 0 nan\n", "v 0 0\n", "\u{0}\u{1}"] {
        let mesh = write_obj(folder.path(), text);
        planecut(["check".as_ref(), mesh.as_os_str()]).expect_error(2, "a.obj");
        planecut(["info".as_ref(), mesh.as_os_str()]).expect_error(2, "a.obj");
    }
}

/// Nothing is the boundary of nothing.
#[test]
fn an_empty_mesh_is_sound() {
    let folder = folder();
    let nothing = r#"{"planecut": 1, "model": {"difference": [{"box": {"min": [0,0,0], "max": [1,1,1]}}, {"box": {"min": [0,0,0], "max": [2,2,2]}}]}}"#;
    let model = folder.path().join("nothing.json");
    std::fs::write(&model, nothing).expect("written");
    for format in ["glb", "gltf", "obj", "stl", "ply"] {
        let mesh = folder.path().join(format!("a.{format}"));
        planecut(["build".as_ref(), model.as_os_str(), "-q".as_ref(), "-o".as_ref(), mesh.as_ref()])
            .expect_quiet_success();
        let run = planecut(["check".as_ref(), mesh.as_os_str()]).expect_quiet_success();
        let line = String::from_utf8(run.stdout).expect("UTF-8");
        assert!(line.contains("watertight, manifold, not self-crossing; vertices 0, triangles 0"), "{format}: {line}");
    }
}

/// The defect of the indices is told, not the many crossings that come with it.
#[test]
fn topology_is_told_before_crossings() {
    let doubled = tetrahedron(0.0, 1) + &"f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n".repeat(2);
    not_sound(&doubled, "used 3 times in each direction");
    not_sound(&(tetrahedron(0.0, 1) + &tetrahedron(1.0, 5) + "f 1 1 1\n"), "names one vertex twice");
}

/// Everything that is written can be read back, is sound, and has the volume of the report.
#[test]
fn what_build_writes_is_sound() {
    let folder = folder();
    let boxes = [block([0; 3], [2; 3], "a"), block([1; 3], [3; 3], "b"), block([3, 1, 1], [5, 2, 2], "c")];
    for (map, tolerance) in [(keep(), 1e-6), (write_map(folder.path(), "m.map", &boxes), 1e-12)] {
        let volume = planecut(["info".as_ref(), map.as_os_str()]).json()["solid"]["volume"].as_f64().expect("a number");
        for format in ["glb", "gltf", "obj", "stl"] {
            let mesh = folder.path().join(format!("a.{format}"));
            planecut(["build".as_ref(), map.as_os_str(), "-o".as_ref(), mesh.as_ref()]).expect_quiet_success();
            planecut(["check".as_ref(), mesh.as_os_str()]).expect_quiet_success();
            let report = planecut(["info".as_ref(), mesh.as_os_str()]).json();
            assert!(agree(&report["mesh"]["volume"], volume, tolerance), "{format}: {}", report["mesh"]);
            assert_eq!(report["mesh"]["manifold"].as_bool(), Some(true), "{format}");
        }
    }
}

/// Where a solid touches itself OBJ and glTF keep its vertices apart; STL cannot say that they are two.
#[test]
fn only_stl_loses_where_a_solid_touches_itself() {
    let folder = folder();
    for (name, second) in [("corner.map", [1, 1, 1]), ("edge.map", [1, 1, 0])] {
        let boxes = [block([0; 3], [1; 3], "a"), block(second, second.map(|low| low + 1), "a")];
        let map = write_map(folder.path(), name, &boxes);
        for format in ["glb", "gltf", "obj", "stl"] {
            let mesh = folder.path().join(format!("a.{format}"));
            planecut(["build".as_ref(), map.as_os_str(), "-o".as_ref(), mesh.as_ref()]).expect_quiet_success();
            let run = planecut(["check".as_ref(), mesh.as_os_str()]);
            match format {
                "stl" => run.expect_error(1, "a.stl"),
                _ => drop(run.expect_quiet_success()),
            }
        }
    }
}

/// Slivers, needles along one line, and fins thinner than single precision can say.
fn outputs_thinner_than_the_tolerance_are_sound() {
    let folder = folder();
    for name in ["pencilrot_6_check_cross.json", "keys.csg", "mfxsp20.map"] {
        let model = data(&format!("regressions/{name}"));
        for format in ["obj", "glb"] {
            let mesh = folder.path().join(format!("a.{format}"));
            planecut(["build".as_ref(), model.as_os_str(), "-q".as_ref(), "-o".as_ref(), mesh.as_ref()])
                .expect_quiet_success();
            planecut(["check".as_ref(), mesh.as_os_str()]).expect_quiet_success();
        }
    }
}

fn many_copies_and_corners_are_told_by_topology() {
    let cases = [("ngon4000", "open edge"), ("dup400", "used 400 times"), ("deg8000", "names one vertex twice")];
    for (name, words) in cases {
        let mesh = data(&format!("regressions/{name}.obj"));
        planecut(["check".as_ref(), mesh.as_os_str()]).expect_error(1, words);
    }
}

planecut_testkit::tests_on_data!(
    outputs_thinner_than_the_tolerance_are_sound,
    many_copies_and_corners_are_told_by_topology,
);
