//! Texture coordinates of meshes that are read, from the command line: `--uv source`.

use std::path::Path;

use planecut::kernel::{DVec2, DVec3};
use planecut_testkit::textured::TexturedMesh;

use crate::support::{Run, block, command, finish, folder, write_map};

fn write(folder: &Path, name: &str, bytes: impl AsRef<[u8]>) {
    std::fs::write(folder.join(name), bytes).expect("written");
}

fn run(folder: &Path, args: &str) -> Run {
    finish(command().current_dir(folder).args(args.split_whitespace()))
}

/// The corners of the triangles of an OBJ file with their texture coordinates.
fn triangles(path: &Path) -> Vec<([DVec3; 3], [DVec2; 3])> {
    let text = std::fs::read_to_string(path).expect("a file");
    let rows = |word: &str| -> Vec<Vec<f64>> {
        let numbers = |line: &str| line.split(' ').map(|number| number.parse().expect("a number")).collect();
        text.lines().filter_map(|line| line.strip_prefix(word)).map(numbers).collect()
    };
    let (positions, coordinates) = (rows("v "), rows("vt "));
    let corner = |word: &str| -> (DVec3, DVec2) {
        let (vertex, at) = word.split_once('/').expect("both");
        let [vertex, at] = [vertex, at].map(|number| number.parse::<usize>().expect("a number") - 1);
        (DVec3::from_slice(&positions[vertex]), DVec2::from_slice(&coordinates[at]))
    };
    let triangle = |line: &str| {
        let corners: Vec<(DVec3, DVec2)> = line.split(' ').map(corner).collect();
        ([0, 1, 2].map(|k| corners[k].0), [0, 1, 2].map(|k| corners[k].1))
    };
    text.lines().filter_map(|line| line.strip_prefix("f ")).map(triangle).collect()
}

/// Sees that what lies in triangles of a ball has its coordinates; gives how many triangles do, and how many lie elsewhere.
#[track_caller]
fn counted(ball: &TexturedMesh, path: &Path) -> (usize, usize) {
    let (mut own, mut others) = (0, 0);
    for (corners, found) in triangles(path) {
        let expected = ball.at(corners, 1e-9);
        let is_right = |expected: &[DVec2; 3]| (0..3).all(|k| expected[k].abs_diff_eq(found[k], 1e-6));
        assert!(expected.is_empty() || expected.iter().any(is_right), "{corners:?}: {found:?}, not {expected:?}");
        if expected.is_empty() {
            others += 1;
        } else {
            own += 1;
        }
    }
    (own, others)
}

const CUTTER: &str = r#"{"planecut": 1, "model": {"box": {"min": [0, 0, 0], "max": [4, 4, 4]}}}"#;

#[test]
fn what_is_left_of_a_mesh_has_its_own_coordinates() {
    let (folder, ball) = (folder(), TexturedMesh::ball(8, 12, 1));
    let path = folder.path();
    write(path, "ball.obj", ball.to_obj());
    write(path, "ball.glb", ball.to_glb(""));
    write(path, "cutter.json", CUTTER);
    run(path, "build cutter.json -o cutter.stl").expect_quiet_success();
    for input in ["ball.obj", "ball.glb"] {
        let args =
            format!("build {input} cutter.stl --combine difference --uv source -o out.obj -o out.glb -o out.ply");
        run(path, &args).expect_quiet_success();
        let (own, others) = counted(&ball, &path.join("out.obj"));
        assert!(own > 100 && others > 3, "{own} {others}");
        // what was written is read again
        run(path, "build out.ply --uv source -o again.obj").expect_quiet_success();
        assert!(counted(&ball, &path.join("again.obj")).0 >= own - 10);
    }
}

#[test]
fn meshes_keep_their_pictures_beside_others_and_within_models() {
    let (folder, ball) = (folder(), TexturedMesh::ball(6, 8, 2));
    let path = folder.path();
    write(path, "ball.obj", ball.to_obj());
    write_map(path, "m.map", &[block([4, 0, 0], [5, 1, 1], "stone"), block([6, 0, 0], [7, 1, 1], "stone")]);
    run(path, "build m.map ball.obj --combine union --uv source -o out.obj").expect_quiet_success();
    assert_eq!(counted(&ball, &path.join("out.obj")), (ball.triangles.len(), 24));
    let mirrored = ball.moved(|p| DVec3::new(-p.x, p.y + 0.5 * p.z, p.z));
    write(
        path,
        "m.json",
        r#"{"planecut": 1, "model": {"mesh": "ball.obj", "matrix": [[-1, 0, 0, 0], [0, 1, 0.5, 0], [0, 0, 1, 0]]}}"#,
    );
    write(
        path,
        "m.csg",
        "multmatrix([[-1, 0, 0, 0], [0, 1, 0.5, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) { import(file = \"ball.obj\"); }",
    );
    for input in ["m.json", "m.csg"] {
        run(path, &format!("build {input} --uv source -o out.obj")).expect_quiet_success();
        assert_eq!(counted(&mirrored, &path.join("out.obj")), (ball.triangles.len(), 0), "{input}");
    }
}

#[test]
fn cells_and_parts_have_them_too() {
    // bent, so that no two triangles have a plane in common: a face of a cell has one texture
    let bent = |p: DVec3| p * (1.0 + 0.05 * (37.0 * p.x + 11.0 * p.y + 5.0 * p.z).sin());
    let (folder, ball) = (folder(), TexturedMesh::ball(6, 8, 3).moved(bent));
    let path = folder.path();
    write(
        path,
        "m.json",
        r#"{"planecut": 1, "model": {"union": [
        {"name": "ball", "difference": [{"mesh": "ball.obj"}, {"box": {"min": [0, 0, 0], "max": [4, 4, 4]}}]},
        {"name": "block", "box": {"min": [5, 0, 0], "max": [6, 1, 1]}}]}}"#,
    );
    write(path, "ball.obj", ball.to_obj());
    for option in ["", "--parts", "--cells", "--ids"] {
        run(path, &format!("build m.json --uv source {option} -o out.obj -o out.glb")).expect_quiet_success();
        let (own, others) = counted(&ball, &path.join("out.obj"));
        assert!(own > 60 && others >= 12 + 3, "{option}: {own} {others}");
    }
}

#[test]
fn nothing_changes_unless_they_are_asked_for() {
    let (folder, ball) = (folder(), TexturedMesh::ball(8, 12, 4));
    let path = folder.path();
    let textured = ball.to_obj();
    let without = |line: &str| {
        let words: Vec<&str> = line.split(' ').map(|word| word.split('/').next().unwrap_or(word)).collect();
        if line.starts_with("vt") { "\n".to_owned() } else { words.join(" ") + "\n" }
    };
    write(path, "plain.obj", textured.lines().map(without).collect::<String>());
    write(path, "textured.obj", textured);
    write(path, "cutter.json", CUTTER);
    for options in ["", "--uv box --uv-size 2", "--ids --smooth 40", "--cells"] {
        for name in ["plain", "textured"] {
            let outputs = format!("-o {name}.glb -o out-{name}.obj -o {name}.ply");
            run(path, &format!("build {name}.obj cutter.json --combine difference {options} {outputs}"))
                .expect_quiet_success();
        }
        for [a, b] in
            [["plain.glb", "textured.glb"], ["out-plain.obj", "out-textured.obj"], ["plain.ply", "textured.ply"]]
        {
            let [a, b] = [a, b].map(|name| std::fs::read(path.join(name)).expect("written"));
            assert!(a == b, "{options}");
        }
    }
}

#[test]
fn damaged_coordinates_are_told_of_where_they_are_needed() {
    let (folder, ball) = (folder(), TexturedMesh::ball(4, 5, 5));
    let path = folder.path();
    let text = ball.to_obj();
    let line = text.lines().count();
    let (rest, _) = text.trim_end().rsplit_once('/').expect("a corner");
    write(path, "m.obj", format!("{rest}/999\n"));
    run(path, "build m.obj -o out.obj").expect_quiet_success();
    let count = ball.coordinates.len();
    let message = format!("/999`, expected one of the {count} texture coordinates defined so far");
    let refused = run(path, "build m.obj --uv source -o out.obj");
    refused.expect_error(2, &message);
    refused.expect_error(2, &format!("m.obj:{line}: found `"));
}
