//! What OpenSCAD forgives.

use planecut_import::scad::{ScadImport, ScadOptions, read_scad};

use super::{assert_volume, evaluated, read};

fn assert_warns(text: &str, expected: f64, warning: &str) {
    assert_volume(text, expected);
    let warnings = read(text).warnings;
    assert!(warnings.iter().any(|w| w.message.contains(warning) && w.line > 0), "{text}: {warnings:?}");
}

#[test]
fn sizes_that_are_none_give_nothing() {
    for text in [
        "cube([1, 0, 1]);",
        "cube([1, -1, 1]);",
        "sphere(0);",
        "sphere(-1);",
        "cylinder(h = -1, r = 1);",
        "cylinder(h = 1, r1 = -1, r2 = 2);",
        "cylinder(h = 1, r1 = 0, r2 = 0);",
        "linear_extrude(height = -1) square(1);",
        "linear_extrude(height = 1) square([0, 1]);",
        "rotate_extrude(angle = 0) square(1);",
        "intersection() { cube(1); group(); }",
        "difference() { group(); cube(1); }",
        "union();",
        "hull();",
        "minkowski();",
        "group() { difference() {} }",
        "polyhedron(points = undef, faces = undef);",
    ] {
        let evaluation = evaluated(text);
        assert!(evaluation.mesh.triangles.is_empty() && evaluation.solid.volume == 0.0, "{text}");
    }
}

#[test]
fn values_of_another_kind_are_the_defaults() {
    assert_volume("cube(undef);", 1.0);
    assert_volume("cube(size = \"large\");", 1.0);
    assert_volume("cube(size = [2, true, 3]);", 1.0);
    // `inf` and `nan` are names that OpenSCAD does not know when it reads its own output
    assert_volume("cube(size = [inf, 1, 1]);", 1.0);
    assert_volume("multmatrix([[nan, 0, 0, 0], [0, 2, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) cube(1);", 2.0);
}

#[test]
fn what_has_another_dimension_is_left_out() {
    assert_warns("union() { cube(1); square(3); }", 1.0, "an outline among them");
    assert_warns("linear_extrude(height = 1) { square(2); cube(9); }", 4.0, "a solid among them");
    assert_warns("intersection() { cube(2); square(3); }", 0.0, "an outline among them");
    let import = read("cube(1); square(4);");
    assert!(
        import.warnings.iter().any(|warning| warning.message.contains("nothing extrudes")),
        "{:?}",
        import.warnings
    );
}

#[test]
fn matrices_that_flatten_leave_nothing() {
    let flat = "multmatrix([[1, 0, 0, 0], [0, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])";
    assert_warns(&format!("cube(1); {flat} cube(5);"), 1.0, "flattens solids");
    assert_warns(&format!("linear_extrude(height = 1) {{ square(2); {flat} square(9); }}"), 4.0, "flattens outlines");
    let upright = "multmatrix([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]])";
    // turned upright, and back again: once flat, always flat
    assert_warns(&format!("linear_extrude(height = 1) {upright} {upright} square(2);"), 0.0, "flattens outlines");
}

#[test]
fn surfaces_that_bound_no_solid_are_left_out() {
    let points = "points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]";
    assert_volume(&format!("polyhedron({points}, faces = [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]]);"), 1.0 / 6.0);
    let turned = format!("polyhedron({points}, faces = [[2, 1, 0], [1, 3, 0], [2, 3, 1], [0, 3, 2]]);");
    assert_warns(&turned, 1.0 / 6.0, "turned around");
    let open = format!("cube(1); polyhedron({points}, faces = [[0, 1, 2], [0, 3, 1], [1, 3, 2]]);");
    assert_warns(&open, 1.0, "not closed");
    let nan = "polyhedron(points = [[0, nan, 0], [1, 0, 0], [0, 1, 0]], faces = [[0, 1, 2]]); cube(1);";
    assert_warns(nan, 1.0, "three finite numbers");
}

/// A cube of faces of which each has corners of its own, off by rounding.
fn cube_of_six_faces(off: f64) -> String {
    let (mut points, mut faces) = (Vec::new(), Vec::new());
    for face in 0..6 {
        let (axis, side) = (face / 2, face % 2);
        for k in [0, 1, 3, 2] {
            let mut point = [0.0; 3];
            point[axis] = side as f64;
            point[(axis + 1) % 3] = (k % 2) as f64;
            point[(axis + 2) % 3] = (k / 2) as f64;
            let shown = point.map(|v| format!("{:e}", 8.0 * v + off * face as f64));
            points.push(format!("[{}]", shown.join(", ")));
        }
        let first = 4 * face;
        let (b, d) = if side == 1 { (first + 3, first + 1) } else { (first + 1, first + 3) };
        faces.push(format!("[{first}, {b}, {}, {d}]", first + 2));
    }
    format!("polyhedron(points = [{}], faces = [{}]);", points.join(", "), faces.join(", "))
}

#[test]
fn corners_that_differ_by_rounding_are_joined_and_told() {
    assert_volume(&cube_of_six_faces(0.0), 512.0);
    assert!(read(&cube_of_six_faces(0.0)).warnings.is_empty());
    for off in [1e-16, 1e-12, 1e-10] {
        let text = cube_of_six_faces(off);
        let volume = evaluated(&text).solid.volume;
        assert!((volume - 512.0).abs() < 512.0 * 10.0 * off + 1e-9, "{off}: {volume}");
        let warnings = read(&text).warnings;
        let is_told = warnings.iter().any(|warning| warning.message.contains("differ from others by rounding"));
        assert!(off < 1e-15 || is_told, "{off}: {warnings:?}");
        assert!(warnings.iter().all(|warning| warning.left_out == 0), "{warnings:?}");
    }
    let far = read(&format!("cube(1); {}", cube_of_six_faces(1e-3)));
    assert_eq!(far.warnings.iter().map(|warning| warning.left_out).collect::<Vec<_>>(), [1], "{:?}", far.warnings);
}

/// A facet whose corners are at two places has no part in the surface.
#[test]
fn facets_with_corners_at_one_place_do_not_make_a_solid_touch_itself() {
    let points = "points = [[0, 0, 0], [3, 0, 0], [0, 3, 0], [0, 0, 3], [0, 0, 3]]";
    // clockwise seen from outside, the edge from corner 1 to the top has a facet of its own
    let text =
        format!("polyhedron({points}, faces = [[0, 1, 2], [0, 3, 1], [1, 4, 2], [2, 3, 0], [1, 3, 4], [2, 4, 3]]);");
    assert_volume(&text, 4.5);
    let beside = "multmatrix([[1, 0, 0, 9], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) cube(1);";
    assert_volume(&format!("union() {{ {text} {beside} }}"), 5.5);
    assert!(read(&format!("cube(1); {text}")).warnings.is_empty());
}

/// A cube of 10 with a pit in its top: a pyramid over all of the top, 1 deep; two of its facets name the pit's tip twice.
///
/// Its sum with a unit cube: 11 x 11 x 11 but for a pit. The sum's depth at a place is the least depth over the unit square before that, so the pit is a pyramid
/// of base 9 x 9, 0.9 deep: volume 24.3.
#[test]
fn the_sum_of_a_body_with_a_pit_is_the_body_that_slides() {
    let points = "[[0, 10, 10], [10, 10, 10], [10, 0, 10], [0, 0, 10], [0, 0, 0], [10, 0, 0], [10, 10, 0], [0, 10, 0], \
                  [5, 5, 9], [5, 5, 9]]";
    let faces = "[[4, 5, 6, 7], [3, 2, 5, 4], [2, 1, 6, 5], [1, 0, 7, 6], [0, 3, 4, 7], [0, 8, 3], [1, 2, 9], \
                 [0, 1, 9, 8], [2, 3, 8, 9]]";
    let body = format!("polyhedron(points = {points}, faces = {faces});");
    assert_volume(&body, 1000.0 - 100.0 / 3.0);
    assert_volume(&format!("minkowski() {{ {body} cube(1); }}"), 1331.0 - 81.0 * 0.9 / 3.0);
}

#[test]
fn what_touches_itself_is_not_combined() {
    let bow = "linear_extrude(height = 1) polygon(points = [[0, 0], [2, 2], [2, 0], [0, 2]]);";
    assert_volume(bow, 2.0);
    assert_warns(&format!("union() {{ {bow} cube([1, 1, 9]); }}"), 9.0, "touches itself");
    let options = ScadOptions { keep_touching: true, ..ScadOptions::default() };
    let kept =
        read_scad(format!("union() {{ {bow} cube([1, 1, 9]); }}").as_bytes(), "test.csg", &options).expect("read");
    assert_eq!(kept.warnings, []);
    // beyond the column over the unit square: of the triangle (0, 0), (1, 1), (0, 2) the half with y above 1, and all of the other one
    let volume = planecut_csg::evaluate(&kept.model).expect("a mesh").solid.volume;
    assert!((volume - (9.0 + 1.5)).abs() < 1e-12, "{volume}");
    // two cones tip to tip
    let cones = "rotate_extrude($fn = 4) polygon(points = [[0, 1], [1, 0], [1, 2]]);";
    assert_warns(&format!("{cones} cube([9, 9, 9]);"), 729.0, "touches itself");
    // both axes shrink to nothing: the hole ends in the very tip of the outside
    let frame = "difference() { square(4, center = true); square(2, center = true); }";
    let tips = format!("linear_extrude(height = 3, scale = [0, 0]) {frame}");
    assert_volume(&tips, 12.0);
    assert_warns(&format!("cube(9); {tips}"), 729.0, "touches itself");
}

#[test]
fn outlines_on_both_sides_of_the_axis_are_left_out() {
    assert_warns("cube(1); rotate_extrude() square(2, center = true);", 1.0, "both sides of the axis");
}

#[test]
fn keeping_on_leaves_out_what_is_not_supported() {
    let options = ScadOptions { keep_going: true, ..ScadOptions::default() };
    let text = b"cube(1);\nsurface(file = \"a.png\");\ndifference() { cube(9); frob() cube(8); }";
    let ScadImport { model, warnings } = read_scad(text, "test.csg", &options).expect("goes on");
    assert_eq!(warnings.iter().map(|warning| warning.line).collect::<Vec<_>>(), [2, 3]);
    assert!(warnings.iter().all(|warning| warning.message.contains("is left out")), "{warnings:?}");
    assert_eq!(planecut_csg::evaluate(&model).expect("a mesh").solid.volume, 729.0);
}

#[test]
fn an_import_that_is_not_there_is_left_out() {
    assert_warns("cube(1); import(file = \"nowhere.stl\");", 1.0, "cannot be read");
}
