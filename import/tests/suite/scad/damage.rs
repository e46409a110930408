//! Damaged trees: no panic, no hang, and one clear line.

use std::fs;
use std::path::Path;

use planecut_csg::evaluate;
use planecut_import::scad::{ScadOptions, read_scad};
use planecut_testkit::random::Rng;

use super::{evaluated, refused};

/// Reads what may be right or wrong, and evaluates what can be read.
fn survive(text: &[u8]) {
    let options = ScadOptions { keep_going: false, ..ScadOptions::default() };
    match read_scad(text, "test.csg", &options) {
        Ok(import) => drop(evaluate(&import.model)),
        Err(error) => {
            let message = error.to_string();
            let is_clear =
                message.starts_with("test.csg:") && message.contains("found ") && message.contains("expected ");
            assert!(is_clear && !message.contains(['\n', '\r']), "{message:?}");
        }
    }
}

/// Trees that use the whole language.
fn originals() -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/csg");
    let mut files: Vec<_> =
        fs::read_dir(folder).expect("the examples").map(|entry| entry.expect("a file").path()).collect();
    files.sort();
    files.iter().map(|file| fs::read(file).expect("a file")).collect()
}

#[test]
fn files_cut_off_anywhere() {
    println!("seed 51");
    let mut random = Rng::new(51);
    for text in originals() {
        for _ in 0..12 {
            survive(&text[..random.below(text.len())]);
        }
    }
}

#[test]
fn values_of_other_kinds_and_sizes() {
    let values = [
        "undef", "\"x\"", "[]", "[[1]]", "true", "-1", "0", "1e308", "-1e308", "1e-308", "nan", "[inf, 0]", "1e9",
        "0.5",
    ];
    println!("seed 52");
    let mut random = Rng::new(52);
    for text in originals() {
        let text = String::from_utf8(text).expect("a text");
        let places: Vec<(usize, usize)> =
            text.match_indices("= ").map(|(at, _)| at + 2).map(|at| (at, value_end(&text, at))).collect();
        for _ in 0..25 {
            let (start, end) = places[random.below(places.len())];
            let value = values[random.below(values.len())];
            survive(format!("{}{value}{}", &text[..start], &text[end..]).as_bytes());
        }
    }
}

/// Where a value ends: at the next comma or parenthesis outside of brackets.
fn value_end(text: &str, start: usize) -> usize {
    let mut depth = 0;
    let ends = |byte: u8| {
        depth += i32::from(byte == b'[') - i32::from(byte == b']');
        depth == 0 && matches!(byte, b',' | b')')
    };
    start + text.as_bytes()[start..].iter().copied().position(ends).unwrap_or(0)
}

#[test]
fn bytes_that_are_others() {
    println!("seed 53");
    let mut random = Rng::new(53);
    for text in originals() {
        for _ in 0..25 {
            let mut text = text.clone();
            for _ in 0..=random.below(4) {
                let at = random.below(text.len());
                text[at] = random.below(256) as u8;
            }
            survive(&text);
        }
    }
}

#[test]
fn ten_thousand_groups_in_one_another() {
    let groups = "group() {".repeat(10_000);
    let closed = format!("{groups}cube(2);{}", "}".repeat(10_000));
    assert_eq!(evaluated(&closed).solid.volume, 8.0);
    assert_eq!(refused(groups.as_bytes()).line(), Some(1));
    let differences = format!("{}cube(3);{}", "difference() {".repeat(10_000), "}".repeat(10_000));
    assert_eq!(evaluated(&differences).solid.volume, 27.0);
    let matrices = "multmatrix([[1, 0, 0, 1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) ".repeat(10_000);
    assert_eq!(evaluated(&format!("{matrices}cube(1);")).solid.max.x, 10_001.0);
    survive(format!("cube(size = {}1{});", "[".repeat(100_000), "]".repeat(100_000)).as_bytes());
}

#[test]
fn numbers_that_are_too_large() {
    for text in [
        "cube(1e308);",
        "sphere(r = 1e200);",
        "multmatrix([[1e308, 0, 0, 0], [0, 1e308, 0, 0], [0, 0, 1e308, 0], [0, 0, 0, 1]]) cube(1e20);",
        "linear_extrude(height = 1e308) square(1);",
        "linear_extrude(height = 1, twist = 1e300) square(1);",
        "linear_extrude(height = 1, slices = 1e300) square(1);",
        "linear_extrude(height = 1, scale = 1e300) square(1);",
        "linear_extrude(height = 1) offset(r = 1e300) square(1);",
        "rotate_extrude($fn = 1e300) square(1);",
        "rotate_extrude(angle = 1e300) square(1);",
        "resize(newsize = [1e300, 0, 0]) cube(1);",
        "polyhedron(points = [[0, 0, 0], [1e300, 0, 0], [0, 1, 0], [0, 0, 1]], faces = [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]]);",
        "polyhedron(points = [[0, 0, 0]], faces = [[0, 1e300, -1]]);",
        "sphere(1, $fn = 10000);",
        "minkowski() { cube(1e25); cube(1e25); }",
    ] {
        survive(text.as_bytes());
    }
}

#[test]
fn no_text_at_all() {
    for text in [&b""[..], b"\n\n", b"// nothing", b"\0\0\0", b"\xff\xfe", b"{", b"(", b"!", b"cube", b"cube("] {
        survive(text);
    }
}
