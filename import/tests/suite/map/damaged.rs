//! Damaged maps: each gives one clear line, and none a panic.

use planecut_import::map::{MapError, MapImport, MapOptions, read_map};

fn read(text: &[u8]) -> Result<MapImport, MapError> {
    read_map(text, "m", &MapOptions::default())
}

fn file(name: &str) -> Vec<u8> {
    let path = format!("{}/tests/suite/map/damaged/{name}.map", env!("CARGO_MANIFEST_DIR"));
    std::fs::read(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// The error of a stored file as the user sees it.
fn error_of(name: &str) -> String {
    match read_map(&file(name), "m", &MapOptions::default()) {
        Err(error) => error.to_string(),
        Ok(import) => panic!("{name} was read: {:?}", import.warnings),
    }
}

fn warnings_of(name: &str) -> (MapImport, Vec<String>) {
    let import = read(&file(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
    let warnings = import.warnings.iter().map(ToString::to_string).collect();
    (import, warnings)
}

/// All other files are this one with one thing broken.
#[test]
fn the_undamaged_map_is_read() {
    let (import, warnings) = warnings_of("whole");
    assert_eq!((import.model.tree.brushes().len(), import.model.tree.brushes()[0].faces.len()), (1, 6));
    assert!(warnings.is_empty(), "{warnings:?}");
}

macro_rules! damaged {
    ($($name:ident => $message:literal,)*) => {
        $(#[test]
        fn $name() {
            assert_eq!(error_of(stringify!($name)), $message);
        })*

        /// Every stored file is asserted on somewhere.
        #[test]
        fn no_file_is_forgotten() {
            let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/suite/map/damaged");
            let mut stored: Vec<String> = std::fs::read_dir(folder)
                .expect("the folder of this test")
                .map(|entry| entry.expect("an entry").file_name().into_string().expect("a plain name"))
                .collect();
            stored.sort();
            let mut named: Vec<String> = [$(stringify!($name)),*]
                .into_iter()
                .chain(["whole", "zero_area_face", "all_faces_without_area"])
                .map(|name| format!("{name}.map"))
                .collect();
            named.sort();
            assert_eq!(stored, named);
        }
    };
}

damaged! {
    binary =>
        "m:1: found `�ELF`, expected `{`",
    brush_in_brush =>
        "m:7: found `{`, expected `(` or `}` for the `{` of line 4",
    comments_only =>
        "m: holds no brushes: found nothing but white space and comments, expected an entity in braces",
    cut_after_brush =>
        "m:11: found the end of the file, expected a key in quotes, `{` or `}` for the `{` of line 2",
    cut_in_brush =>
        "m:7: found the end of the file, expected `(` or `}` for the `{` of line 4",
    cut_in_face =>
        "m:8: found the end of the file, expected a finite decimal number",
    cut_in_patch =>
        "m:10: found the end of the file, expected `}` for the `{` of line 6",
    empty =>
        "m: holds no brushes: found nothing but white space and comments, expected an entity in braces",
    extra_brace =>
        "m:13: found `}`, expected `{`",
    four_coordinates =>
        "m:6: found `1`, expected `)`",
    hexadecimal =>
        "m:7: found `0x3f`, expected a finite decimal number",
    infinite =>
        "m:6: found `-inf`, expected a finite decimal number",
    key_without_value =>
        "m:4: found `{`, expected a text in quotes",
    letters_for_number =>
        "m:5: found `left`, expected a finite decimal number",
    letters_for_value =>
        "m:9: found `zero`, expected a finite decimal number",
    missing_brush_brace =>
        r#"m:13: found `"classname"`, expected `(` or `}` for the `{` of line 12"#,
    missing_brush_end =>
        "m:11: found `{`, expected `(` or `}` for the `{` of line 4",
    missing_parenthesis =>
        "m:7: found `(`, expected `)`",
    missing_texture =>
        "m:9: found 4 values after the texture, expected 5, 6, 8 or 11",
    nan =>
        "m:6: found `nan`, expected a finite decimal number",
    number_1e300 =>
        "m:10: found a face whose plane is outside the accepted range, expected less extreme coordinates",
    number_1e400 =>
        "m:8: found `1e400`, expected a finite decimal number",
    one_axis =>
        "m:9: found `0`, expected `[`",
    short_axis =>
        "m:9: found `]`, expected a finite decimal number",
    text_file =>
        "m:1: found `Dear`, expected `{`",
    too_few_values =>
        "m:9: found 4 values after the texture, expected 5, 6, 8 or 11",
    too_many_values =>
        "m:9: found 9 values after the texture, expected 5, 6, 8 or 11",
    two_coordinates =>
        "m:6: found `)`, expected a finite decimal number",
    two_points =>
        "m:6: found `stone`, expected `(`",
    unquoted_key =>
        r#"m:2: found `"worldspawn"`, expected `{`"#,
    unterminated_key =>
        "m:3: found `worldspawn`, expected a text in quotes",
    unterminated_string =>
        r#"m:2: found a text in quotes without an end, expected a closing `"`"#,
    unterminated_texture =>
        r#"m:10: found a text in quotes without an end, expected a closing `"`"#,
    unterminated_value =>
        "m:4: found `wad`, expected a key in quotes, `{` or `}` for the `{` of line 2",
}

#[test]
fn a_face_without_area_is_left_out() {
    let (import, warnings) = warnings_of("zero_area_face");
    assert_eq!((import.model.tree.brushes().len(), import.model.tree.brushes()[0].faces.len()), (1, 5));
    assert_eq!(import.faces_left_out, 1);
    assert_eq!(warnings, ["line 8: left out a face whose three points lie on one line"]);
}

#[test]
fn a_brush_of_such_faces_is_left_out() {
    let (import, warnings) = warnings_of("all_faces_without_area");
    assert_eq!((import.brushes_read, import.model.tree.brushes().len()), (1, 0));
    assert_eq!((import.brushes_left_out, import.faces_left_out), (1, 2));
    assert_eq!(
        warnings,
        [
            "line 4: left out a brush without faces",
            "line 5: left out 2 faces whose three points lie on one line, the first of them here (lines 5, 6)",
            "no brush is left: 1 read, 0 of them skipped by option",
        ]
    );
}

#[test]
fn depth_is_no_danger() {
    let error = read(&b"{".repeat(100_000)).expect_err("no map");
    assert_eq!(error.to_string(), "m:1: found `{`, expected `(` or `}` for the `{` of line 1");
    let error = read(&b"{\n".repeat(100_000)).expect_err("no map");
    assert_eq!(error.to_string(), "m:3: found `{`, expected `(` or `}` for the `{` of line 2");
    let depth = 100_000;
    let patch = format!("{{{{patchDef2{}{}}}}}", "{".repeat(depth), "}".repeat(depth));
    assert_eq!(read(patch.as_bytes()).expect("a patch").patches_left_out, 1);
    let error = read(patch.trim_end_matches('}').as_bytes()).expect_err("not closed");
    assert_eq!(error.to_string(), "m:1: found the end of the file, expected `}` for the `{` of line 1");
}

/// Each of these took time in the square of its length if any step looked back or forward without a limit.
#[test]
fn endless_tokens_take_linear_time() {
    let long = "9".repeat(8_000_000);
    for (text, expected) in [
        (
            format!("{{ {{ ( {long} 0 0 )"),
            "m:1: found `9999999999999999999999999999999999999999…`, expected a finite decimal number",
        ),
        (
            format!("{{ {{ ( 0 0 0 ) ( 0 0 1 ) ( 0 1 0 ) {long}"),
            "m:1: found 0 values after the texture, expected 5, 6, 8 or 11",
        ),
        (format!("{{ \"{long}"), "m:1: found a text in quotes without an end, expected a closing `\"`"),
        (
            format!("{{ \"\" \"{}x", "\\\"".repeat(4_000_000)),
            "m:1: found a text in quotes without an end, expected a closing `\"`",
        ),
        (
            format!("//{long}"),
            "m: holds no brushes: found nothing but white space and comments, expected an entity in braces",
        ),
        (format!("{}x", "//\n".repeat(2_000_000)), "m:2000001: found `x`, expected `{`"),
        (format!("{}x", " \r".repeat(2_000_000)), "m:2000001: found `x`, expected `{`"),
    ] {
        assert_eq!(read(text.as_bytes()).expect_err("no map").to_string(), expected);
    }
}

#[test]
fn every_kind_of_error_knows_its_line() {
    let line = |name| read(&file(name)).expect_err("damaged").line();
    assert_eq!((line("nan"), line("number_1e300"), line("empty")), (Some(6), Some(10), None));
}
