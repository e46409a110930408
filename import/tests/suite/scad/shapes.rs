//! Shapes with OpenSCAD's corners: volumes from formulas of their own.

use std::f64::consts::{PI, TAU};

use planecut_csg::MaterialId;

use super::{assert_volume, evaluated, read, volume};

/// The area of a regular polygon.
fn polygon(radius: f64, n: f64) -> f64 {
    0.5 * n * radius * radius * (TAU / n).sin()
}

#[test]
fn resize_takes_numbers_as_truth_values() {
    // 1 x 2 x 3 to a height of 7: the factor is 7/3 where `auto` is set
    let resized = |auto: &str| format!("resize(newsize = [0, 0, 7], auto = {auto}) cube([1, 2, 3]);");
    let (alone, one, both) = (14.0, 14.0 * 7.0 / 3.0, 14.0 * 49.0 / 9.0);
    for (auto, expected) in [
        ("[1, 1, 1]", both),
        ("[1, 0, 1]", one),
        ("[0, 2.5, 0]", one),
        ("[0, 0, 0]", alone),
        ("[true, 1, false]", both),
        ("1", both),
        ("0", alone),
        ("true", both),
        ("[1]", one),
        ("undef", alone),
    ] {
        assert_volume(&resized(auto), expected);
    }
}

#[test]
fn circles_have_the_fragments_of_the_special_variables() {
    // $fn where it is above 0, but at least 3; else by angle and length, but at least 5
    let cases = [
        ("$fn = 7", 3.0, 7.0),
        ("$fn = 1", 3.0, 3.0),
        ("$fn = 6.9", 3.0, 6.0),
        ("$fn = 0, $fa = 12, $fs = 2", 3.0, 10.0),
        ("$fa = 12, $fs = 0.1", 3.0, 30.0),
        ("$fa = 50, $fs = 0.1", 3.0, 8.0),
        ("$fa = 12, $fs = 100", 3.0, 5.0),
        ("", 1.0, 5.0),
    ];
    for (variables, radius, n) in cases {
        let text = format!("linear_extrude(height = 2) circle(r = {radius}, {variables});");
        assert_volume(&text, 2.0 * polygon(radius, n));
        assert_volume(&format!("cylinder(h = 2, r = {radius}, {variables});"), 2.0 * polygon(radius, n));
    }
}

#[test]
fn cones_are_frusta() {
    for (bottom, top) in [(2.0, 1.0), (0.0, 2.0), (3.0, 0.0)] {
        let sum = bottom * bottom + bottom * top + top * top;
        let expected = polygon(1.0, 8.0) * 5.0 / 3.0 * sum;
        assert_volume(&format!("cylinder(h = 5, r1 = {bottom}, r2 = {top}, $fn = 8, center = true);"), expected);
    }
}

#[test]
fn spheres_are_rings_half_a_step_from_the_poles() {
    for n in [3u32, 4, 5, 8, 30] {
        let rings = n.div_ceil(2);
        let angle = |ring: u32| PI * (f64::from(ring) + 0.5) / f64::from(rings);
        let frustum = |ring: u32| {
            let [(a, z), (b, w)] = [ring, ring + 1].map(|ring| (2.0 * angle(ring).sin(), 2.0 * angle(ring).cos()));
            polygon(1.0, f64::from(n)) * (z - w) / 3.0 * (a * a + a * b + b * b)
        };
        let expected: f64 = (0..rings - 1).map(frustum).sum();
        assert_volume(&format!("sphere(r = 2, $fn = {n});"), expected);
    }
}

#[test]
fn matrices_move_solids_and_outlines() {
    let matrix = "[[2, 0, 0, 5], [0, 3, 0, 0], [0, 0, -4, 1], [0, 0, 0, 1]]";
    let evaluation = evaluated(&format!("multmatrix({matrix}) cube([1, 1, 1]);"));
    assert_eq!((evaluation.solid.volume, evaluation.solid.min.z, evaluation.solid.max.z), (24.0, -3.0, 1.0));
    assert_volume(&format!("linear_extrude(height = 2) multmatrix({matrix}) square([1, 1]);"), 12.0);
    // of a matrix in three dimensions an outline takes the first two rows and columns
    let tilted = "[[1, 0, 0, 0], [0, 0.5, -0.8, 0], [0, 0.8, 0.5, 7], [0, 0, 0, 1]]";
    assert_volume(&format!("linear_extrude(height = 2) multmatrix({tilted}) square([3, 4]);"), 12.0);
}

#[test]
fn twisted_extrusions_keep_the_volume_of_their_slices() {
    // a square about the axis: each slice is a square antiprism cut along its shorter diagonals; by Simpson's rule its volume
    // is that of its ends and of its middle section, an octagon or a square
    let (slices, twist) = (6.0, 90.0f64);
    let turn = (twist / slices).to_radians();
    let [side, half] = [2.0, 1.0];
    let at = |angle: f64| (half * (angle.cos() - angle.sin()), half * (angle.cos() + angle.sin()));
    // the middle section's corners are the middles of the upright edges and of the diagonals
    let corner = |k: u32, angle: f64| {
        let (x, y) = at(angle);
        match k % 4 {
            0 => (x, y),
            1 => (-y, x),
            2 => (-x, -y),
            _ => (y, -x),
        }
    };
    let middle = |p: (f64, f64), q: (f64, f64)| (0.5 * (p.0 + q.0), 0.5 * (p.1 + q.1));
    let section: Vec<(f64, f64)> = (0..4)
        .flat_map(|k| {
            let upright = middle(corner(k, 0.0), corner(k, -turn));
            let [across, other] =
                [middle(corner(k, 0.0), corner(k + 1, -turn)), middle(corner(k + 1, 0.0), corner(k, -turn))];
            let length = |a: (f64, f64), b: (f64, f64)| (a.0 - b.0).hypot(a.1 - b.1);
            let is_first = length(corner(k, 0.0), corner(k + 1, -turn)) < length(corner(k + 1, 0.0), corner(k, -turn));
            [upright, if is_first { across } else { other }]
        })
        .collect();
    let next = section.iter().cycle().skip(1);
    let area: f64 = section.iter().zip(next).map(|(p, q)| 0.5 * (p.0 * q.1 - p.1 * q.0)).sum();
    let expected = 12.0 * (2.0 * side * side + 4.0 * area) / 6.0;
    assert_volume("linear_extrude(height = 12, twist = 90, slices = 6) square([2, 2], center = true);", expected);
}

#[test]
fn turned_outlines_are_sums_of_wedges() {
    // a square ring of width 2 and height 3 from radius 4 on, in n steps of a turn
    let ring = |n: f64, step: f64| n * 0.5 * step.sin() * (36.0 - 16.0) * 3.0;
    let square = "multmatrix([[1, 0, 0, 4], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) square([2, 3]);";
    assert_volume(&format!("rotate_extrude($fn = 12) {square}"), ring(12.0, TAU / 12.0));
    assert_volume(&format!("rotate_extrude(angle = 90, $fn = 12) {square}"), ring(3.0, TAU / 12.0));
    // 5 of 12 steps of 30° fit into 160°
    assert_volume(&format!("rotate_extrude(angle = -160, $fn = 12) {square}"), ring(5.0, 160.0f64.to_radians() / 5.0));
    let bounds = evaluated(&format!("rotate_extrude(angle = 90, $fn = 12) {square}")).solid;
    assert!(bounds.min.x.abs() < 1e-12 && bounds.min.y.abs() < 1e-12 && bounds.max.x == 6.0, "{bounds:?}");
    let bounds = evaluated(&format!("rotate_extrude(angle = -90, $fn = 12) {square}")).solid;
    assert!(bounds.max.y.abs() < 1e-12 && bounds.max.x == 6.0, "{bounds:?}");
    // an odd number of steps begins on the other side of the axis
    let bounds = evaluated(&format!("rotate_extrude($fn = 5) {square}")).solid;
    assert!(bounds.min.x == -6.0 && bounds.max.x < 5.0, "{bounds:?}");
}

#[test]
fn offsets_hulls_and_sums_of_outlines() {
    assert_volume("linear_extrude(height = 1) offset(delta = 1) square([4, 2]);", 24.0);
    assert_volume("linear_extrude(height = 1) offset(delta = -0.5) square([4, 2]);", 3.0);
    let quarter = polygon(1.0, 16.0) / 4.0;
    assert_volume("linear_extrude(height = 1) offset(r = 1, $fn = 16) square([4, 2]);", 8.0 + 12.0 + 4.0 * quarter);
    assert_volume("linear_extrude(height = 1) hull() { square([1, 4]); square([3, 1]); }", 1.0 * 4.0 + 0.5 * 2.0 * 5.0);
    assert_volume("linear_extrude(height = 1) minkowski() { square([4, 2]); square([1, 3]); }", 25.0);
}

/// A twist shows each corner on a straight line, even one that is there by rounding alone.
#[test]
fn hulls_of_cut_outlines_have_no_corners_by_rounding() {
    let triangle = "polygon([[1.538, 0], [-1.873, 3.244], [-1.751, -3.033]]);";
    let hexagon =
        "polygon([[1.042, 0], [0.564, 0.977], [-1.066, 1.846], [-3.216, 0], [-0.892, -1.545], [0.978, -1.694]]);";
    let twisted = |outline: &str| volume(&format!("linear_extrude(height = 5.069, twist = -90, slices = 4) {outline}"));
    let tips = twisted(&format!("hull() {{ difference() {{ {triangle} {hexagon} }} }}"));
    assert!((tips - twisted(triangle)).abs() < 1e-9 * tips, "{tips}");
}

#[test]
fn hulls_sums_sections_and_shadows_of_solids() {
    assert_volume(
        "hull() { cube([2, 2, 1]); cube([1, 1, 3]); }",
        volume("hull() { cube([1, 1, 3]); cube([2, 2, 1]); }"),
    );
    // of a single body that is flattened a hull takes the corners
    let flat = |what: &str| format!("multmatrix([[1,0,0,0],[0,1,0,0],[0,0,0,0],[0,0,0,1]]) {what}");
    assert_volume(
        &format!("hull() {{ {} cube([1, 1, 3]); }}", flat("cube([3, 3, 9]);")),
        3.0 * (9.0 + 3.0 + 1.0) / 3.0,
    );
    assert_volume(&format!("hull() {{ {} cube([1, 1, 3]); }}", flat("union() { cube(3); cube(5); }")), 3.0);
    assert_volume(&format!("union() {{ {} cube([1, 1, 3]); }}", flat("cube([3, 3, 9]);")), 3.0);
    assert_volume(&format!("hull() {{ {} }}", flat("cube([3, 3, 9]);")), 0.0);
    assert_volume("minkowski() { cube([4, 2, 1]); cube([1, 3, 2]); }", 75.0);
    let nothing = "intersection() { cube(1); multmatrix([[1,0,0,1],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) cube(1); }";
    assert_volume(&format!("minkowski() {{ {nothing} cube([1, 3, 2]); }}"), 6.0);
    assert_volume(&format!("minkowski() {{ cube([1, 3, 2]); {nothing} cube([1, 1, 1]); }}"), 2.0 * 4.0 * 3.0);
    assert_volume(
        "linear_extrude(height = 1) projection() multmatrix([[1,0,0,0],[0,1,0,0],[0,0,1,9],[0,0,0,1]]) cube([2, 3, 4]);",
        6.0,
    );
    let ball = "multmatrix([[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) cylinder(h = 4, r1 = 4, r2 = 0, $fn = 4, center = true);";
    assert_volume(&format!("linear_extrude(height = 1) projection(cut = true) {ball}"), 8.0);
    // a solid that stands on the plane shows its floor
    assert_volume("linear_extrude(height = 1) projection(cut = true) cube([2, 3, 4]);", 6.0);
    assert_volume("resize(newsize = [8, 0, 0], auto = [false, true, false]) cube([2, 3, 5]);", 8.0 * 12.0 * 5.0);
    assert_volume("resize(newsize = [8, 6, 0]) cube([2, 3, 5]);", 8.0 * 6.0 * 5.0);
}

#[test]
fn colors_become_materials_and_survive() {
    let import =
        read("difference() { color([1, 0, 0, 1]) cube(4); color([0, 0.5, 1, 0.25]) { color([0, 1, 0]) cube(2); } }");
    let names: Vec<&str> = import.model.materials.iter().map(|material| material.name.as_str()).collect();
    assert_eq!(names, ["uncolored", "#ff0000", "#0080ff40"], "the outer color wins");
    let evaluation = planecut_csg::evaluate(&import.model).expect("a mesh");
    let area = |material: u32| {
        let mesh = &evaluation.mesh;
        let of =
            |triangle: &usize| mesh.faces[mesh.triangle_faces[*triangle] as usize].material == MaterialId(material);
        let area = |triangle: usize| {
            let [a, b, c] = mesh.triangles[triangle].map(|vertex| mesh.positions[vertex as usize]);
            0.5 * (b - a).cross(c - a).length()
        };
        (0..mesh.triangles.len()).filter(of).map(area).sum::<f64>()
    };
    // three faces of the small cube are walls of the hole, the other three holes in the large one
    assert_eq!([area(0), area(1), area(2)], [0.0, 96.0 - 12.0, 12.0]);
}

#[test]
fn modifiers_say_what_counts() {
    assert_volume("cube(1); %cube(5); *cube(6);", 1.0);
    assert_volume("#cube(2);", 8.0);
    assert_volume("difference() { %cube(9); cube(3); cube(1); }", 26.0);
    let shifted = "multmatrix([[3, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])";
    assert_volume(&format!("cube(9); {shifted} group() {{ cube(8); !cube(2); }}"), 8.0);
}
