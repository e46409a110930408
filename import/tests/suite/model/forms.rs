//! What each key of a model file makes: volumes from formulas, attributes from the rules of the page.

use std::f64::consts::PI;
use std::num::NonZeroU32;

use planecut_csg::MaterialId;

use super::support::{assert_close, file, model, read, volume};

const CUBE: &str = r#"{"box": {"min": [0, 0, 0], "max": [1, 1, 1]}}"#;

/// The area of a regular polygon inscribed in a circle.
fn polygon(n: f64, radius: f64) -> f64 {
    n / 2.0 * radius * radius * (2.0 * PI / n).sin()
}

#[track_caller]
fn expect(node: &str, expected: f64) {
    assert_close(volume(&file(node)), expected, node);
}

#[test]
fn convex_bodies_have_the_volumes_of_their_formulas() {
    expect(CUBE, 1.0);
    expect(r#"{"halfspaces": [[1, 0, 0, 1], [0, 1, 0, 1], [0, 0, 1, 1], [-1, -1, -1, 0]]}"#, 27.0 / 6.0);
    expect(r#"{"points": [[0, 0, 0], [2, 0, 0], [0, 3, 0], [0, 0, 4], [0.1, 0.1, 0.1]]}"#, 4.0);
    expect(r#"{"cylinder": {"height": 3, "radius": 2, "segments": 12}}"#, 3.0 * polygon(12.0, 2.0));
    expect(r#"{"cylinder": {"height": 3, "radius": 2}}"#, 3.0 * polygon(32.0, 2.0));
    let frustum = |a: f64, b: f64| 3.0 / 3.0 * (1.0 + a / b + (a / b).powi(2)) * polygon(8.0, b);
    expect(r#"{"cylinder": {"height": 3, "radius": 1, "top_radius": 2, "segments": 8}}"#, frustum(1.0, 2.0));
    expect(r#"{"cylinder": {"height": 3, "radius": 0, "top_radius": 2, "segments": 8}}"#, polygon(8.0, 2.0));
    expect(r#"{"cone": {"height": 3, "radius": 2, "segments": 8}}"#, polygon(8.0, 2.0));
    expect(r#"{"prism": {"height": 3, "radius": 2, "sides": 5}}"#, 3.0 * polygon(5.0, 2.0));
    expect(r#"{"pyramid": {"height": 3, "radius": 2, "sides": 5}}"#, polygon(5.0, 2.0));
    expect(r#"{"wedge": {"size": [2, 3, 4]}}"#, 12.0);
    let edge = 3.0_f64.sqrt().recip() * 2.0 * 2.0;
    expect(r#"{"regular": {"solid": "cube", "radius": 2}}"#, edge.powi(3));
    expect(r#"{"regular": {"solid": "octahedron", "radius": 2}}"#, 4.0 / 3.0 * 8.0);
    expect(r#"{"regular": {"solid": "tetrahedron", "radius": 2}}"#, 8.0 * 3.0_f64.sqrt() / 27.0 * 8.0);
}

/// A sphere of rings: frusta between neighbouring rings, worked out from the page.
fn rings(radius: f64, segments: f64) -> f64 {
    let count = ((segments + 1.0) / 2.0).floor();
    let ring = |i: f64| {
        let angle = PI * (i + 0.5) / count;
        (radius * angle.sin(), radius * angle.cos())
    };
    let slab = |i: f64| {
        let ((a, top), (b, bottom)) = (ring(i), ring(i + 1.0));
        (top - bottom) / 3.0 * (a * a + a * b + b * b) * polygon(segments, 1.0)
    };
    (0..count as u32 - 1).map(|i| slab(f64::from(i))).sum()
}

#[test]
fn spheres_and_capsules_have_the_rings_of_the_page() {
    expect(r#"{"sphere": {"radius": 2, "segments": 12}}"#, rings(2.0, 12.0));
    expect(r#"{"sphere": {"radius": 2, "segments": 7}}"#, rings(2.0, 7.0));
    expect(r#"{"sphere": {"radius": 2}}"#, rings(2.0, 32.0));
    let (n, radius, height) = (12.0, 2.0, 5.0);
    let widest = radius * (PI * 2.5 / 6.0).sin();
    expect(
        r#"{"capsule": {"height": 5, "radius": 2, "segments": 12}}"#,
        rings(radius, n) + height * polygon(n, widest),
    );
}

#[test]
fn operations_are_those_of_sets() {
    let (a, b) = (CUBE, r#"{"box": {"min": [0.5, 0, 0], "max": [2, 1, 1]}}"#);
    expect(&format!("{{\"union\": [{a}, {b}]}}"), 2.0);
    expect(&format!("{{\"intersection\": [{a}, {b}]}}"), 0.5);
    expect(&format!("{{\"difference\": [{a}, {b}]}}"), 0.5);
    expect(&format!("{{\"difference\": [{a}]}}"), 1.0);
    expect(&format!("{{\"xor\": [{a}, {b}]}}"), 1.5);
    expect(&format!("{{\"xor\": [{a}, {b}, {a}]}}"), 1.5);
    expect(&format!("{{\"intersection\": [{a}, {{\"complement\": {b}}}]}}"), 0.5);
    expect(&format!("{{\"hull\": [{a}, {{\"box\": {{\"min\": [3, 0, 0], \"max\": [4, 1, 1]}}}}]}}"), 4.0);
    expect(&format!("{{\"minkowski\": [{a}, {b}]}}"), 2.5 * 2.0 * 2.0);
    expect(r#"{"points": [[0, 0, 0], [1, 0, 0], [0, 1, 0]]}"#, 0.0);
}

#[test]
fn extrusions_and_revolutions() {
    let extrude = |outline: &str, rest: &str| format!(r#"{{"extrude": {{"outline": {outline}, "height": 2{rest}}}}}"#);
    let square = r#"{"rectangle": {"min": [-1, -1], "max": [1, 1]}}"#;
    expect(&extrude(square, ""), 8.0);
    expect(&extrude(square, r#", "scale": 0"#), 8.0 / 3.0);
    expect(&extrude(square, r#", "scale": [1, 2], "slices": 4"#), 12.0);
    expect(&extrude(r#"{"polygon": [[0, 0], [2, 0], [0, 1]]}"#, ""), 2.0);
    expect(&extrude(r#"{"polygon": [[[0, 0], [3, 0], [3, 3], [0, 3]], [[1, 1], [2, 1], [2, 2], [1, 2]]]}"#, ""), 16.0);
    expect(&extrude(r#"{"circle": {"radius": 2, "segments": 8}}"#, ""), 2.0 * polygon(8.0, 2.0));
    let shifted = r#"{"rectangle": {"min": [0, -1], "max": [2, 1]}}"#;
    for (key, area) in [("union", 6.0), ("intersection", 2.0), ("difference", 2.0), ("xor", 4.0)] {
        expect(&extrude(&format!("{{\"{key}\": [{square}, {shifted}]}}"), ""), 2.0 * area);
    }
    expect(&extrude(&format!(r#"{{"offset": {{"of": {square}, "by": 1, "join": "miter"}}}}"#), ""), 32.0);
    expect(&extrude(&format!(r#"{{"offset": {{"of": {square}, "by": -0.5}}}}"#), ""), 2.0);
    expect(&extrude(&format!(r#"{{"slice": {{"of": {CUBE}, "z": 0.5}}}}"#), ""), 2.0);
    expect(&extrude(&format!(r#"{{"project": {CUBE}}}"#), ""), 2.0);
    expect(&extrude(r#"{"rectangle": {"min": [0, 0], "max": [1, 1]}, "matrix": [[2, 1, 5], [0, 3, 1]]}"#, ""), 12.0);
    // A rectangle from r to R turned about z: a ring over a regular polygon.
    let tube = r#"{"rectangle": {"min": [1, 0], "max": [2, 1]}}"#;
    let ring = polygon(8.0, 2.0) - polygon(8.0, 1.0);
    expect(&format!(r#"{{"revolve": {{"outline": {tube}, "segments": 8}}}}"#), ring);
    expect(&format!(r#"{{"revolve": {{"outline": {tube}, "segments": 8, "angle": 90}}}}"#), ring / 4.0);
}

#[test]
fn extrusions_stand_on_the_plane_or_about_it() {
    let bounds = |rest: &str| {
        let text = format!(r#"{{"extrude": {{"outline": {{"circle": {{"radius": 1}}}}, "height": 3{rest}}}}}"#);
        let solid = planecut_csg::evaluate(&model(&text).model).expect("a solid").solid;
        (solid.min.z, solid.max.z)
    };
    assert_eq!((bounds(""), bounds(r#", "center": true"#)), ((0.0, 3.0), (-1.5, 1.5)));
}

#[track_caller]
fn expect_bounds(node: &str, min: [f64; 3], max: [f64; 3]) {
    let solid = planecut_csg::evaluate(&model(node).model).expect("a solid").solid;
    let far = (solid.min - glam::DVec3::from(min)).abs().max((solid.max - glam::DVec3::from(max)).abs());
    assert!(far.max_element() < 1e-12, "{node}: {} {}, expected {min:?} {max:?}", solid.min, solid.max);
}

#[test]
fn steps_come_one_after_the_other_and_the_matrix_last() {
    let block = |rest: &str| format!(r#"{{"box": {{"min": [0, 0, 0], "max": [3, 2, 1]}}, {rest}}}"#);
    let steps = |steps: &str| block(&format!("\"transform\": [{steps}]"));
    expect_bounds(&steps(r#"{"translate": [1, 2, 3]}"#), [1.0, 2.0, 3.0], [4.0, 4.0, 4.0]);
    expect_bounds(&steps(r#"{"rotate": [0, 0, 90]}"#), [-2.0, 0.0, 0.0], [0.0, 3.0, 1.0]);
    expect_bounds(&steps(r#"{"rotate": [90, 0, 90]}"#), [0.0, 0.0, 0.0], [1.0, 3.0, 2.0]);
    expect_bounds(&steps(r#"{"rotate": {"axis": [0, 0, 2], "angle": -90}}"#), [0.0, -3.0, 0.0], [2.0, 0.0, 1.0]);
    expect_bounds(&steps(r#"{"scale": 2}"#), [0.0; 3], [6.0, 4.0, 2.0]);
    expect_bounds(&steps(r#"{"scale": [1, -2, 3]}"#), [0.0, -4.0, 0.0], [3.0, 0.0, 3.0]);
    expect_bounds(&steps(r#"{"mirror": [5, 0, 0]}"#), [-3.0, 0.0, 0.0], [0.0, 2.0, 1.0]);
    expect_bounds(&steps(r#"{"translate": [1, 0, 0]}, {"scale": 2}"#), [2.0, 0.0, 0.0], [8.0, 4.0, 2.0]);
    expect_bounds(&steps(r#"{"scale": 2}, {"translate": [1, 0, 0]}"#), [1.0, 0.0, 0.0], [7.0, 4.0, 2.0]);
    let turn = "[[0, -1, 0, 10], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]";
    expect_bounds(
        &block(&format!(r#""matrix": {turn}, "transform": [{{"translate": [1, 0, 0]}}]"#)),
        [8.0, 1.0, 0.0],
        [10.0, 4.0, 1.0],
    );
    let inner = block(r#""transform": [{"translate": [1, 0, 0]}]"#);
    expect_bounds(
        &format!(r#"{{"union": [{inner}], "transform": [{{"scale": 2}}]}}"#),
        [2.0, 0.0, 0.0],
        [8.0, 4.0, 2.0],
    );
    expect_bounds(
        &format!(r#"{{"hull": [{inner}], "transform": [{{"scale": 2}}]}}"#),
        [2.0, 0.0, 0.0],
        [8.0, 4.0, 2.0],
    );
}

#[test]
fn copies_are_put_where_they_belong() {
    let at = format!(
        r#"{{"instances": {{"of": {CUBE}, "at": [[5, 0, 0], [{{"scale": 2}}, {{"translate": [0, 5, 0]}}], {{"matrix": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 3, 7]]}}]}}}}"#
    );
    expect(&at, 1.0 + 8.0 + 3.0);
    expect_bounds(&at, [0.0, 0.0, 0.0], [6.0, 7.0, 10.0]);
    let array = format!(r#"{{"array": {{"of": {CUBE}, "count": [3, 2, 2], "step": [2, -3, 1]}}}}"#);
    expect(&array, 12.0);
    expect_bounds(&array, [0.0, -3.0, 0.0], [5.0, 1.0, 2.0]);
    let ring = format!(r#"{{"ring": {{"of": {CUBE}, "count": 4}}, "transform": [{{"translate": [1, 0, 0]}}]}}"#);
    expect(&ring, 4.0);
    expect_bounds(&ring, [0.0, -1.0, 0.0], [2.0, 1.0, 1.0]);
    let part_of_a_ring = format!(r#"{{"ring": {{"of": {CUBE}, "count": 2, "angle": 180}}}}"#);
    expect_bounds(&part_of_a_ring, [-1.0, 0.0, 0.0], [1.0, 1.0, 1.0]);
}

#[test]
fn parts_take_parameters_and_those_that_depend_on_them_follow() {
    let with = |uses: &str| {
        format!(
            r#"{{"planecut": 1,
                "parameters": {{"w": 2, "d": "=w / 2", "far": 10}},
                "parts": {{
                  "inner": {{"box": {{"min": [0, 0, 0], "max": ["=w", "=d", 1]}}}},
                  "outer": {{"use": "inner"}},
                  "shifted": {{"use": "inner", "with": {{"w": "=w + 1"}}}}
                }},
                "model": {{"union": [{uses}]}}}}"#
        )
    };
    assert_close(volume(&with(r#"{"use": "inner"}"#)), 2.0, "as the file says");
    assert_close(volume(&with(r#"{"use": "inner", "with": {"w": 4}}"#)), 8.0, "d follows w");
    assert_close(volume(&with(r#"{"use": "inner", "with": {"w": 4, "d": 1}}"#)), 4.0, "both");
    assert_close(volume(&with(r#"{"use": "inner", "with": {"w": "=d", "d": "=w"}}"#)), 2.0, "numbers of the outside");
    assert_close(volume(&with(r#"{"use": "outer", "with": {"w": 4}}"#)), 8.0, "parts within see it");
    assert_close(volume(&with(r#"{"use": "shifted", "with": {"w": 5}}"#)), 18.0, "one on the other");
    let twice = r#"{"use": "inner"}, {"use": "inner", "transform": [{"translate": ["=far", 0, 0]}]}, {"use": "inner", "with": {"d": 3}, "transform": [{"translate": ["=2 * far", 0, 0]}]}"#;
    assert_close(volume(&with(twice)), 2.0 + 2.0 + 6.0, "several uses");
}

#[test]
fn the_innermost_material_and_name_win() {
    let cube = |x: u32, rest: &str| format!(r#"{{"box": {{"min": [{x}, 0, 0], "max": [{}, 1, 1]}}{rest}}}"#, x + 1);
    let text = format!(
        r#"{{"planecut": 1, "materials": {{"m": {{}}, "n": {{"color": [0, 0.5, 1], "metallic": "=1/2", "roughness": 1}}}},
            "parts": {{"p": {{"union": [{}, {}]}}}},
            "model": {{"union": [
              {},
              {{"material": "m", "name": "outer", "union": [{}, {}, {{"use": "p"}}, {{"hull": [{}]}}]}},
              {{"use": "p"}}
            ]}}}}"#,
        cube(0, ""),
        cube(2, r#", "material": "n", "name": "part""#),
        cube(4, ""),
        cube(6, ""),
        cube(8, r#", "material": "n", "name": "inner""#),
        cube(10, ""),
    );
    let import = read(&text).expect("read");
    let names: Vec<&str> = import.model.materials.iter().map(|material| material.name.as_str()).collect();
    assert_eq!(names, ["m", "n", "default"]);
    let n = &import.model.materials[1];
    assert_eq!((n.color, n.metallic, n.roughness), (Some([0.0, 0.5, 1.0]), Some(0.5), Some(1.0)));
    let brushes = import.model.tree.brushes().iter().map(|brush| {
        let material = brush.faces[0].material;
        assert!(brush.faces.iter().all(|face| face.material == material));
        (material, brush.name.as_deref())
    });
    let (m, n, default) = (MaterialId(0), MaterialId(1), MaterialId(2));
    let expected = [
        (default, None),
        (m, Some("outer")),
        (n, Some("inner")),
        (m, Some("outer")),
        (n, Some("part")),
        (m, Some("outer")),
        (default, None),
        (n, Some("part")),
    ];
    assert_eq!(brushes.collect::<Vec<_>>(), expected);
}

#[test]
fn brushes_know_their_lines() {
    let import =
        model("{\"union\": [\n{\"sphere\": {\"radius\": 1}},\n{\"hull\": [\n{\"sphere\": {\"radius\": 1}}]}]}");
    let lines: Vec<u32> = import.model.tree.source_lines().map(|line| line.map_or(0, NonZeroU32::get)).collect();
    assert_eq!(lines[0], 2);
    assert!(lines[1] == 3 || lines[1] == 4, "{lines:?}");
}

#[test]
fn numbers_may_be_expressions_wherever_they_stand() {
    expect(r#"{"box": {"min": ["=0", 0, 0], "max": ["=2 ^ 3", "=sqrt(4)", "=sin(30)"]}}"#, 8.0);
    expect(r#"{"halfspaces": [["=1", 0, 0, 1], [0, 1, 0, 1], [0, 0, 1, "=1"], [-1, -1, -1, 0]]}"#, 27.0 / 6.0);
    expect(r#"{"prism": {"height": 1, "radius": 2, "sides": "=2 + 2"}, "transform": [{"scale": "=1 / 2"}]}"#, 1.0);
}
