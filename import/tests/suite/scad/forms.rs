//! What the grammar accepts, and what it says where it does not.

use std::num::NonZeroU32;

use planecut_kernel::DVec3;

use super::{assert_volume, read, refused};

#[test]
fn white_space_comments_and_empty_statements_do_not_matter() {
    assert_volume("/* a\n * box */ cube ( size=[1,2 , 3] ,center=false ) ; ; // end", 6.0);
    assert_volume("group(){cube([1,2,3]);};group();", 6.0);
    assert_volume("\u{feff}cube(2);\r\n", 8.0);
}

#[test]
fn a_single_statement_needs_no_braces() {
    assert_volume("multmatrix([[2,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) group() cube(1); cube(1);", 2.0);
    assert_volume("difference() { union() cube(3); cube(1); }", 26.0);
}

#[test]
fn arguments_have_names_or_places() {
    for text in ["cube([1, 2, 3], true);", "cube(center = true, size = [1, 2, 3]);", "cube(size = [1, 2, 3],);"] {
        assert_volume(text, 6.0);
    }
    assert_volume("cylinder(2, 1, 1, $fn = 4);", 4.0);
    assert_volume("cylinder(h = 2, d = 2, $fn = 4);", 4.0);
}

#[test]
fn errors_name_line_and_what_was_expected() {
    let cases = [
        ("cube(1);\ncube(1", 2, "the end of the file", "`,` or `)`"),
        ("cube(1);\n}", 2, "`}`", "a node such as `cube(…)`"),
        ("group() {\n cube(1);\n\n", 2, "the end of the file", "a statement or `}`"),
        ("group()\n}", 2, "`}`", "`;`, `{` or a statement"),
        ("cube(size = [1, 2);", 1, "`)`", "`,` or `]`"),
        ("cube(size = x);", 1, "`x`", "a value"),
        ("a = 3;\ncube(a);", 1, "an assignment to `a`", "an evaluated tree"),
        ("cube(\"1);", 1, "a text in quotes without an end", "a closing `\"`"),
        ("/* cube(1);", 1, "a comment without an end", "a closing `*/`"),
        ("\n\nfrob(1);", 3, "`frob`, which is not supported", "--keep-going"),
        ("teapot(size = 2);", 1, "`teapot`, which is not supported", "--keep-going"),
        ("surface(file = \"a.png\");", 1, "a `surface` of `a.png`, which is not supported", "`.dat`"),
        ("import(file = \"a.dxf\");", 1, "`a.dxf`, which is not supported", "`.stl`"),
        ("linear_extrude(file = \"a.dxf\", height = 3);", 1, "`a.dxf`, which is not supported", "children"),
        ("cube(1e30);", 1, "for `max`", "1e25"),
        ("sphere(1, $fn = 1e9);", 1, "1000000000 segments", "at most 10000"),
    ];
    for (text, line, found, expected) in cases {
        let error = refused(text.as_bytes());
        assert_eq!(error.line(), Some(line), "{error}");
        let message = error.to_string();
        assert!(message.starts_with(&format!("test.csg:{line}: found ")), "{message}");
        assert!(message.contains(found) && message.contains(expected) && !message.contains('\n'), "{message}");
    }
}

#[test]
fn brushes_know_their_lines() {
    let import =
        read("group() {\n cube(1);\n\n multmatrix([[1,0,0,4],[0,1,0,0],[0,0,1,0],[0,0,0,1]])\n  sphere(1);\n}");
    assert!(import.model.tree.source_lines().eq([2, 5].map(NonZeroU32::new)));
}

#[test]
fn texts_keep_what_was_escaped() {
    let message = refused(br#"import(file = "a\"b\\c\n.dxf");"#).to_string();
    assert!(message.contains(r#"a\"b\\c\n.dxf"#), "{message}");
}

#[cfg(not(feature = "text"))]
#[test]
fn letters_need_a_feature() {
    let error = refused(b"linear_extrude(height = 1) { text(text = \"A\", size = 10); }").to_string();
    assert!(error.contains("found a text, and a program built without the feature `text`"), "{error}");
}

/// More of them than are made at a time, in the order of the text, among nodes that do not wait for any, and one that is made of the shadow of another.
#[test]
fn linear_extrusions_that_are_made_together_stay_in_order() {
    const COUNT: u32 = 150;
    let at = |x: u32, what: &str| format!("multmatrix([[1,0,0,{x}],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) {what}\n");
    let mut text = String::from("linear_extrude(height = 2) projection() linear_extrude(height = 7) square([1, 3]);\n");
    for k in 1..COUNT {
        let solid = format!("linear_extrude(height = {k}) square([1, 2]);");
        text += &at(2 * k, if k % 7 == 0 { "cube([1, 2, 1]);" } else { &solid });
    }
    let import = read(&text);
    assert!(import.model.tree.source_lines().eq((1..=COUNT).map(NonZeroU32::new)));
    let heights = (1..COUNT).map(|k| if k % 7 == 0 { 1 } else { k });
    let bounds = import.model.tree.brushes().iter().map(|brush| {
        let of = |normal: DVec3| brush.faces.iter().find(|face| face.half_space.normal().normalize() == normal);
        let offset =
            |normal: DVec3| of(normal).map(|face| face.half_space.offset() / face.half_space.normal().length());
        [offset(DVec3::NEG_X), offset(DVec3::Z)]
    });
    let expected =
        [[0.0, 2.0]].into_iter().chain((1..).zip(heights).map(|(k, height)| [-2.0 * f64::from(k), f64::from(height)]));
    assert!(bounds.eq(expected.map(|bounds| bounds.map(Some))));
}

#[test]
fn a_fault_in_one_of_several_linear_extrusions_is_told_with_its_line() {
    let text = b"linear_extrude(height = 1) square(1);\nlinear_extrude(height = 1, file = \"x.dxf\") square(1);\ncube(1);\nlinear_extrude(height = 1) square(2);\n";
    let error = refused(text).to_string();
    assert!(error.contains("test.csg:2"), "{error}");
}
