//! Meshes that others made: scans, prints, game assets, hard operands of another kernel's tests. What each is, is in the README of the data.

use std::path::Path;

use planecut_testkit::data::data;
use serde_json::Value;

use crate::support::{agree, folder, planecut};

planecut_testkit::tests_on_data!(
    closed_meshes_have_the_volume_of_their_triangles,
    meshes_that_cross_themselves_come_out_sound,
    meshes_that_are_no_solid_are_refused_with_what_is_wrong,
    pairs_of_scans_have_the_volumes_of_another_kernel,
    vertices_a_little_apart_are_joined,
);

fn json_of(path: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(path).expect("a file")).expect("JSON")
}

/// Builds a file as OBJ, has the mesh checked, and gives the report.
#[track_caller]
fn built_soundly(input: &Path) -> Value {
    let folder = folder();
    let (mesh, report) = (folder.path().join("out.obj"), folder.path().join("report.json"));
    let arguments = ["build".as_ref(), input.as_os_str(), "-o".as_ref(), mesh.as_os_str(), "--report".as_ref()];
    let run = planecut(arguments.into_iter().chain([report.as_os_str(), "--quiet".as_ref()]));
    assert_eq!(run.status, 0, "{}: {}", input.display(), run.stderr);
    let check = planecut(["check".as_ref(), mesh.as_os_str()]);
    assert_eq!(check.status, 0, "{}: {}", input.display(), check.stderr);
    let report = json_of(&report);
    let volume = report["solid"]["volume"].as_f64().expect("a volume");
    assert!(volume > 0.0 && agree(&report["mesh"]["volume"], volume, 1e-9), "{report}");
    report
}

fn closed_meshes_have_the_volume_of_their_triangles() {
    let reference = json_of(&data("mesh/reference.json"));
    let ember = [112932, 472042, 520644, 58011, 65004, 79741, 88566, 99865].map(|number| format!("ember/{number}.stl"));
    let others =
        ["manifold/Cray_left.obj", "manifold/Havocglass8_right.obj", "manifold/Offset2.obj", "manifold/Offset3.obj"];
    let more = [
        "manifold/Offset4.obj",
        "trimesh/featuretype.STL",
        "vhacd/torus1.obj",
        "vhacd/cube-notch.obj",
        "vhacd/hose.obj",
    ];
    for name in ember.iter().map(String::as_str).chain(others).chain(more) {
        let report = built_soundly(&data("mesh").join(name));
        let volume = reference["meshes"][name]["signed_volume"].as_f64().expect("a volume");
        assert!(agree(&report["solid"]["volume"], volume, 1e-9), "{name}: {volume}, {}", report["solid"]);
    }
}

fn meshes_that_cross_themselves_come_out_sound() {
    let names = [
        "manifold/self_intersectA.obj",
        "trimesh/rabbit.obj",
        "vhacd/al.obj",
        "vhacd/lamp.obj",
        "vhacd/cow-nonormals.obj",
    ];
    let more = [
        "manifold/Generic_Twin_7863.1.t0_left.obj",
        "manifold/Generic_Twin_7863.1.t0_right.obj",
        "vhacd/ob_chair_gothic.obj",
    ];
    for name in names.into_iter().chain(more) {
        let report = built_soundly(&data("mesh").join(name));
        assert!(report["model"]["meshes"].as_u64().is_some_and(|meshes| meshes > 0), "{name}: {report}");
    }
}

fn meshes_that_are_no_solid_are_refused_with_what_is_wrong() {
    let folder = folder();
    let out = folder.path().join("out.glb");
    for (name, words) in [
        (
            "vhacd/bunny.obj",
            "bunny.obj:3919: the surface is not closed: found 42 open edges, the first one from (-0.141841754, ",
        ),
        ("vhacd/deer_bound.obj", "deer_bound.obj:2579: the surface is not closed: found 8 open edges"),
        ("vhacd/teapot.obj", "teapot.obj:3646: the surface is not closed: found 160 open edges"),
        ("manifold/Cray_right.obj", "expected finite coordinates of at most 2^100"),
        // sheets with two sides
        ("coacd/Bottle.obj", "encloses no volume"),
        ("coacd/KitchenPot.obj", "encloses no volume"),
    ] {
        let input = data("mesh").join(name);
        let run = planecut(["build".as_ref(), input.as_os_str(), "-o".as_ref(), out.as_os_str()]);
        run.expect_error(2, words);
        let is_open = words.contains("not closed");
        assert_eq!(run.stderr.contains("--close EPS joins vertices"), is_open, "{}", run.stderr);
    }
}

/// The pairs of the EMBER benchmark, as model files: volumes within what the other kernel moves vertices by, and identities among our own.
fn pairs_of_scans_have_the_volumes_of_another_kernel() {
    let reference = json_of(&data("mesh/reference.json"));
    let folder = folder();
    for pair in reference["pairs"].as_array().expect("pairs") {
        let mut nodes = Vec::new();
        for which in ["a", "b"] {
            let name = pair[which].as_str().expect("a name");
            let copy = Path::new(name).file_name().expect("a name").to_string_lossy().into_owned();
            std::fs::copy(data("mesh").join(name), folder.path().join(&copy)).expect("a copy");
            nodes.push(format!(r#"{{"mesh": "{copy}", "matrix": {}}}"#, pair[format!("matrix_{which}")]));
        }
        let nodes = nodes.join(", ");
        let volume_of = |node: &str| {
            let model = folder.path().join("m.json");
            std::fs::write(&model, format!(r#"{{"planecut": 1, "model": {node}}}"#)).expect("a file");
            let info = planecut(["info".as_ref(), model.as_os_str()]).json();
            info["solid"]["volume"].as_f64().expect("a volume")
        };
        let [difference, intersection, union] = ["difference", "intersection", "union"].map(|operation| {
            let volume = volume_of(&format!(r#"{{"{operation}": [{nodes}]}}"#));
            assert!(agree(&pair[operation], volume, 1e-6), "{operation} of {}: {volume}", pair["a"]);
            volume
        });
        let xor = volume_of(&format!(r#"{{"xor": [{nodes}]}}"#));
        assert!((xor + intersection - union).abs() < 1e-12 * union, "{}", pair["a"]);
        let first = volume_of(nodes.split(r#", {"mesh""#).next().expect("a node"));
        assert!((first - difference - intersection).abs() < 1e-12 * first, "{}", pair["a"]);
    }
}

/// A torus taken apart: each triangle has vertices of its own, off by up to 4e-6.
fn vertices_a_little_apart_are_joined() {
    let text = std::fs::read_to_string(data("mesh/vhacd/torus1.obj")).expect("a mesh");
    let vertices: Vec<[f64; 3]> = text.lines().filter_map(|line| line.strip_prefix("v ")).map(numbers).collect();
    let (mut loose, mut count) = (String::new(), 0);
    for line in text.lines().filter_map(|line| line.strip_prefix("f ")) {
        for corner in line.split_whitespace() {
            let corner: usize = corner.split('/').next().and_then(|corner| corner.parse().ok()).expect("a number");
            let [x, y, z] = vertices[corner - 1];
            loose += &format!("v {} {y} {z}\n", x + f64::from(count % 5) * 1e-6);
            count += 1;
        }
        loose += "f -3 -2 -1\n";
    }
    let folder = folder();
    let input = folder.path().join("loose.obj");
    std::fs::write(&input, loose).expect("a file");
    let info = |close: &str| planecut(["info".as_ref(), input.as_os_str(), "--close".as_ref(), close.as_ref()]).json();
    assert_eq!(info("1e-9")["model"], Value::Null);
    let closed = info("1e-5");
    assert!(agree(&closed["solid"]["volume"], 0.801_636_182_524_537_6, 1e-5), "{closed}");
    assert_eq!(closed["warnings"].as_array().map(Vec::len), Some(2), "the file's own mesh is open; what was joined");
}

fn numbers(line: &str) -> [f64; 3] {
    let mut numbers = line.split_whitespace().map(|word| word.parse().expect("a number"));
    [(); 3].map(|()| numbers.next().expect("three numbers"))
}
