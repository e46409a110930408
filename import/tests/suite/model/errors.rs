//! Every error of a model file, with its line, its place, what was found and what was expected.

use planecut_import::model::{ModelError, ModelOptions, read_model};

use super::support::{file, read};

/// Expects a text to be refused at `path`, with words for what was found and what was expected.
#[track_caller]
fn refused(text: &str, path: &str, found: &str, expected: &str) {
    let message = match read(text) {
        Ok(_) => panic!("accepted: {text}"),
        Err(error) => error.to_string(),
    };
    let line = message.strip_prefix("m.json:").and_then(|rest| rest.split_once(": ")).expect("file and line");
    assert!(line.0.parse::<u32>().is_ok(), "{message}");
    let (place, rest) = line.1.split_once(": found ").unwrap_or_else(|| panic!("no place: {message}"));
    let (left, right) = rest.split_once(", expected ").unwrap_or_else(|| panic!("nothing expected: {message}"));
    assert!(!message.contains('\n'), "{message:?}");
    assert_eq!(place, path, "{message}");
    assert!(left.contains(found), "{message}\nshould have found {found}");
    assert!(right.contains(expected), "{message}\nshould have expected {expected}");
}

/// The same for a file with this model alone.
#[track_caller]
fn bad(model: &str, path: &str, found: &str, expected: &str) {
    refused(&file(model), path, found, expected);
}

const CUBE: &str = r#"{"box": {"min": [0, 0, 0], "max": [1, 1, 1]}}"#;

#[test]
fn lines_and_paths_of_deep_places() {
    let text = "{\n\"planecut\": 1,\n\"model\": {\"union\": [\n  {\"sphere\": {\"radius\": 1}},\n  {\"sphere\": {\n    \"radius\": -2}}\n]}}";
    let error = read(text).expect_err("a negative radius");
    assert_eq!(error.to_string(), "m.json:6: $.model.union[1].sphere.radius: found -2, expected a number above 0");
    assert_eq!((error.line(), error.path()), (Some(6), Some("$.model.union[1].sphere.radius")));
    let carriage = text.replace('\n', "\r\n");
    assert_eq!(read(&carriage).expect_err("a negative radius").line(), Some(6));
}

#[test]
fn what_is_not_json() {
    for (text, path, found, expected) in [
        ("", "$", "the end of the file", "a value"),
        ("  \n ", "$", "the end of the file", "a value"),
        ("model", "$", "`model`", "a value"),
        ("{", "$", "the end of the file", "a key in quotes, or `}`"),
        ("{planecut: 1}", "$", "`planecut`", "a key in quotes"),
        ("{'planecut': 1}", "$", "`'planecut'`", "a key in quotes"),
        ("{\"planecut\" 1}", "$", "`1`", "`:`"),
        ("{\"planecut\": }", "$.planecut", "`}`", "a value"),
        ("{\"planecut\": 1,}", "$", "`}`", "a key in quotes"),
        ("{\"planecut\": 1 \"model\": 2}", "$", "`\"model\"`", "`,` or `}`"),
        ("{\"planecut\": [1, 2}", "$.planecut", "`}`", "`,` or `]`"),
        ("{\"planecut\": [1, ]}", "$.planecut[1]", "`]`", "a value"),
        ("{\"planecut\": 1} x", "$", "`x`", "the end of the file"),
        ("{\"planecut\": NaN}", "$.planecut", "`NaN`", "a value"),
        ("{\"planecut\": -Infinity}", "$.planecut", "`-Infinity`", "a number as JSON"),
        ("{\"planecut\": 01}", "$.planecut", "`01`", "a number as JSON"),
        ("{\"planecut\": +1}", "$.planecut", "`+1`", "a value"),
        ("{\"planecut\": 1.}", "$.planecut", "`1.`", "a number as JSON"),
        ("{\"planecut\": .5}", "$.planecut", "`.5`", "a value"),
        ("{\"planecut\": 0x10}", "$.planecut", "`0x10`", "a number as JSON"),
        ("{\"planecut\": 1e999}", "$.planecut", "`1e999`", "a number below 1.8e308"),
        ("{\"planecut\": truth}", "$.planecut", "`truth`", "a value"),
        ("{\"planecut\": \"one}", "$.planecut", "`\"one}`", "a closing `\"`"),
        ("{\"planecut\": \"a\nb\"}", "$.planecut", "`\"a`", "a closing `\"`"),
        ("{\"planecut\": \"\\x\"}", "$.planecut", "escape", "\\u and four digits"),
        ("{\"planecut\": \"\\ud800\"}", "$.planecut", "escape", "\\u and four digits"),
        ("{\"planecut\": 1, \"planecut\": 1}", "$.planecut", "the key `planecut` a second time", "each key once"),
        ("{\"planecut\": 1, \"model\": {\"a\": {\"b\": 1, \"\\u0062\": 2}}}", "$.model.a.b", "a second time", "once"),
        ("// a remark\n{}", "$", "`//`", "a value"),
    ] {
        refused(text, path, found, expected);
        assert!(matches!(read(text), Err(ModelError::Syntax { .. })), "{text}");
    }
}

#[test]
fn what_is_not_utf_8() {
    let options = ModelOptions::default();
    let error = read_model(b"{\n\"planecut\": \"\xff\"}", "m.json", &options).expect_err("refused");
    assert_eq!(error.to_string(), "m.json:2: $: found the byte 0xff at offset 15, expected text in UTF-8");
    read_model(format!("\u{feff}{}", file(CUBE)).as_bytes(), "m.json", &options).expect("a mark is no error");
}

#[test]
fn the_outermost_object() {
    refused("[]", "$", "an empty list", "an object with the keys planecut and model");
    refused("{}", "$", "an empty object", "the key `planecut` as well");
    refused("{\"planecut\": 1}", "$", "an object with planecut", "the key `model` as well");
    refused("{\"planecut\": 2, \"model\": 1}", "$.planecut", "2", "1, the version of the format");
    refused("{\"planecut\": \"1\", \"model\": 1}", "$.planecut", "the text \"1\"", "1, the version of the format");
    refused(
        &format!("{{\"planecut\": 1, \"model\": {CUBE}, \"colour\": 1}}"),
        "$.colour",
        "the key `colour`",
        "one of planecut, model, materials, parameters, parts, outlines",
    );
}

#[test]
fn nodes_that_are_none() {
    bad("1", "$.model", "1", "a NODE: an object with one of the keys halfspaces, points, box");
    bad("[]", "$.model", "an empty list", "a NODE");
    bad("null", "$.model", "null", "a NODE");
    bad("{}", "$.model", "an empty object", "a NODE");
    bad(r#"{"material": "m"}"#, "$.model", "an object with material", "a NODE");
    bad(r#"{"bax": {}}"#, "$.model.bax", "the key `bax`", "one of halfspaces, points, box");
    bad(r#"{"union": [], "box": {}}"#, "$.model", "both `union` and `box`", "only one");
    bad(&CUBE.replace("}}", "}, \"colour\": 1}"), "$.model.colour", "the key `colour`", "material, name, transform");
    bad(&CUBE.replace("}}", "}, \"with\": {}}"), "$.model.with", "the key `with` beside `box`", "it beside `use`");
    bad(&CUBE.replace("}}", "}, \"odd key\": {}}"), "$.model[\"odd key\"]", "the key `odd key`", "one of");
    for key in ["union", "intersection", "difference", "xor", "hull"] {
        bad(&format!("{{\"{key}\": []}}"), &format!("$.model.{key}"), "an empty list", "one or more nodes");
        bad(&format!("{{\"{key}\": {CUBE}}}"), &format!("$.model.{key}"), "an object with box", "one or more nodes");
        bad(&format!("{{\"{key}\": [{CUBE}, 7]}}"), &format!("$.model.{key}[1]"), "7", "a NODE");
    }
    bad(&format!("{{\"minkowski\": [{CUBE}]}}"), "$.model.minkowski", "a list of 1 value", "a list of two nodes");
    bad("{\"complement\": []}", "$.model.complement", "an empty list", "a NODE");
}

#[test]
fn bodies_with_wrong_keys_or_types() {
    bad(r#"{"box": 1}"#, "$.model.box", "1", "an object with the keys min, max");
    bad(r#"{"box": {"min": [0, 0, 0]}}"#, "$.model.box", "an object with min", "the key `max` as well");
    bad(
        r#"{"box": {"min": [0, 0], "max": [1, 1, 1]}}"#,
        "$.model.box.min",
        "a list of 2 values",
        "a list of 3 numbers",
    );
    bad(
        r#"{"box": {"min": [0, 0, "a"], "max": [1, 1, 1]}}"#,
        "$.model.box.min[2]",
        "the text \"a\"",
        "begins with `=`",
    );
    bad(
        r#"{"box": {"min": [0, 0, null], "max": [1, 1, 1]}}"#,
        "$.model.box.min[2]",
        "null",
        "a number or an expression",
    );
    bad(
        r#"{"sphere": {"radius": 1, "segment": 8}}"#,
        "$.model.sphere.segment",
        "the key `segment`",
        "radius, segments",
    );
    bad(r#"{"sphere": {}}"#, "$.model.sphere", "an empty object", "the key `radius`");
    bad(r#"{"points": []}"#, "$.model.points", "an empty list", "one or more lists of 3 numbers");
    bad(r#"{"points": [[1, 2]]}"#, "$.model.points[0]", "a list of 2 values", "a list of 3 numbers");
    bad(r#"{"halfspaces": []}"#, "$.model.halfspaces", "an empty list", "one or more lists of 4 numbers");
    bad(r#"{"halfspaces": [[1, 0, 0, 1], 7]}"#, "$.model.halfspaces[1]", "7", "a list of 4 numbers");
    bad(r#"{"regular": {"solid": "ball", "radius": 1}}"#, "$.model.regular.solid", "\"ball\"", "one of tetrahedron");
    bad(
        r#"{"extrude": {"outline": {"circle": {"radius": 1}}, "height": 1, "center": 1}}"#,
        "$.model.extrude.center",
        "1",
        "true or false",
    );
    bad(r#"{"material": 7, "sphere": {"radius": 1}}"#, "$.model.material", "7", "the name of a material");
    bad(r#"{"name": 7, "sphere": {"radius": 1}}"#, "$.model.name", "7", "a text");
}

#[test]
fn bodies_that_cannot_be() {
    bad(r#"{"sphere": {"radius": 0}}"#, "$.model.sphere.radius", "0", "a number above 0");
    bad(r#"{"sphere": {"radius": "=1-3"}}"#, "$.model.sphere.radius", "-2 from \"=1-3\"", "a number above 0");
    bad(
        r#"{"sphere": {"radius": 1, "segments": 2}}"#,
        "$.model.sphere.segments",
        "2",
        "a whole number from 3 to 10000",
    );
    bad(r#"{"sphere": {"radius": 1, "segments": 8.5}}"#, "$.model.sphere.segments", "8.5", "a whole number");
    bad(r#"{"sphere": {"radius": 1, "segments": 10001}}"#, "$.model.sphere.segments", "10001", "to 10000");
    bad(r#"{"sphere": {"radius": 1, "segments": 10000}}"#, "$.model", "50000002 planes", "at most 33554432");
    bad(r#"{"box": {"min": [0, 2, 0], "max": [1, 1, 1]}}"#, "$.model.box.max", "y = 1", "more than 2");
    bad(r#"{"cylinder": {"height": 0, "radius": 1}}"#, "$.model.cylinder.height", "0", "above 0");
    bad(
        r#"{"cylinder": {"height": 1, "radius": 1, "top_radius": -1}}"#,
        "$.model.cylinder.top_radius",
        "-1",
        "below 0",
    );
    bad(r#"{"wedge": {"size": [1, 0, 1]}}"#, "$.model.wedge.size", "0", "above 0");
    bad(r#"{"torus": {"radius": 1, "tube": 2}}"#, "$.model.torus.tube", "2", "");
    bad(r#"{"halfspaces": [[1, 0, 0, 1], [0, 0, 0, 1]]}"#, "$.model.halfspaces[1]", "a normal of zero", "not zero");
    bad(r#"{"halfspaces": [[1, 0, 0, 1e300]]}"#, "$.model.halfspaces[0]", "outside the accepted range", "magnitudes");
    bad(r#"{"points": [[0, 0, 0], [1e300, 0, 0]]}"#, "$.model.points[1]", "outside the accepted range", "magnitude");
    bad(r#"{"box": {"min": [0, 0, 0], "max": [1, 1, 1e300]}}"#, "$.model.box.max", "", "");
}

#[test]
fn maps_that_cannot_be() {
    let with = |extra: &str| CUBE.replace("}}", &format!("}}, {extra}}}"));
    bad(
        &with(r#""matrix": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]"#),
        "$.model.matrix[0]",
        "a list of 3 values",
        "4 numbers",
    );
    bad(&with(r#""matrix": [[1, 0, 0, 0]]"#), "$.model.matrix", "a list of 1 value", "3 or 4 rows of 4 numbers");
    bad(
        &with(r#""matrix": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 1, 1]]"#),
        "$.model.matrix[3]",
        "[0.0, 0.0, 1.0, 1.0]",
        "[0, 0, 0, 1]",
    );
    bad(&with(r#""matrix": [[1, 2, 3, 0], [2, 4, 6, 0], [0, 0, 1, 0]]"#), "$.model.matrix", "singular", "invertible");
    bad(
        &with(r#""transform": {"scale": 2}"#),
        "$.model.transform",
        "an object with scale",
        "a list of transform steps",
    );
    bad(&with(r#""transform": [{"move": [1, 2, 3]}]"#), "$.model.transform[0].move", "the key `move`", "translate");
    bad(&with(r#""transform": [{}]"#), "$.model.transform[0]", "an empty object", "a transform step");
    bad(
        &with(r#""transform": [{"scale": 1, "translate": [0, 0, 0]}]"#),
        "$.model.transform[0]",
        "both `scale` and `translate`",
        "only one",
    );
    bad(&with(r#""transform": [{"scale": 0}]"#), "$.model.transform[0].scale", "singular", "invertible");
    bad(
        &with(r#""transform": [{"scale": [1, 2]}]"#),
        "$.model.transform[0].scale",
        "a list of 2",
        "a list of 3 numbers",
    );
    bad(&with(r#""transform": [{"mirror": [0, 0, 0]}]"#), "$.model.transform[0].mirror", "singular", "invertible");
    bad(
        &with(r#""transform": [{"rotate": {"axis": [0, 0, 0], "angle": 5}}]"#),
        "$.model.transform[0].rotate.axis",
        "singular",
        "invertible",
    );
    bad(
        &with(r#""transform": [{"rotate": {"axis": [0, 0, 1]}}]"#),
        "$.model.transform[0].rotate",
        "an object with axis",
        "the key `angle`",
    );
    bad(&with(r#""transform": [{"rotate": 90}]"#), "$.model.transform[0].rotate", "90", "3 angles");
    let far = r#""transform": [{"translate": [1e300, 0, 0]}]"#;
    bad(&with(far), "$.model", "outside the accepted range", "less extreme");
}

#[test]
fn names_that_are_not_known() {
    bad(r#"{"use": "hole"}"#, "$.model.use", "the text \"hole\"", "the file defines none");
    bad(r#"{"use": 7}"#, "$.model.use", "7", "the name of a part");
    let with_part =
        |model: &str| format!(r#"{{"planecut": 1, "parts": {{"a": {CUBE}, "b": {CUBE}}}, "model": {model}}}"#);
    refused(&with_part(r#"{"use": "c"}"#), "$.model.use", "the text \"c\"", "the name of a part: a, b");
    refused(
        &with_part(r#"{"use": "a", "with": {"w": 1}}"#),
        "$.model.with.w",
        "the key `w`",
        "a parameter: the file defines none",
    );
    refused(&with_part(r#"{"use": "a", "with": 1}"#), "$.model.with", "1", "an object of parameters");
    bad(
        r#"{"extrude": {"outline": {"use": "o"}, "height": 1}}"#,
        "$.model.extrude.outline.use",
        "the text \"o\"",
        "the name of an outline: the file defines none",
    );
    bad(
        r#"{"sphere": {"radius": "=r"}}"#,
        "$.model.sphere.radius",
        "`r` in the expression \"=r\"",
        "a parameter of this file",
    );
}

#[test]
fn expressions_that_are_none() {
    let sphere = |radius: &str| format!(r#"{{"sphere": {{"radius": "{radius}"}}}}"#);
    bad(&sphere("=1 +"), "$.model.sphere.radius", "its end in the expression \"=1 +\"", "a number, a name or `(`");
    bad(&sphere("=(1"), "$.model.sphere.radius", "its end", "`)`");
    bad(&sphere("=1 / 0"), "$.model.sphere.radius", "\"=1 / 0\", which has no finite value", "a finite value");
    bad(&sphere("=1e999"), "$.model.sphere.radius", "`1e999`", "below 1.8e308");
    bad(&sphere("1"), "$.model.sphere.radius", "the text \"1\"", "begins with `=`");
}

#[test]
fn tables_with_bad_entries() {
    let with = |tables: &str| format!(r#"{{"planecut": 1, {tables}, "model": {CUBE}}}"#);
    refused(&with(r#""parameters": []"#), "$.parameters", "an empty list", "an object of names and numbers");
    refused(&with(r#""parameters": {"a b": 1}"#), "$.parameters[\"a b\"]", "the name `a b`", "letters");
    refused(&with(r#""parameters": {"sin": 1}"#), "$.parameters.sin", "the name `sin`", "no function's name");
    refused(&with(r#""parameters": {"a": [1]}"#), "$.parameters.a", "a list of 1 value", "a number");
    refused(&with(r#""parameters": {"a": "=1/0"}"#), "$.parameters.a", "no finite value", "finite");
    refused(
        &with(r#""materials": {"m": 1}"#),
        "$.materials.m",
        "1",
        "an object with the keys color, metallic, roughness",
    );
    refused(
        &with(r#""materials": {"m": {"color": [0, 0, 2]}}"#),
        "$.materials.m.color[2]",
        "2",
        "a number from 0 to 1",
    );
    refused(&with(r#""materials": {"m": {"color": "red"}}"#), "$.materials.m.color", "\"red\"", "a list of 3 numbers");
    refused(&with(r#""materials": {"m": {"gloss": 1}}"#), "$.materials.m.gloss", "the key `gloss`", "color, metallic");
    refused(&with(r#""materials": {"m": {"metallic": -1}}"#), "$.materials.m.metallic", "-1", "a number from 0 to 1");
    refused(&with(r#""parts": {"p": {"sphere": {}}}"#), "$.parts.p.sphere", "an empty object", "the key `radius`");
    refused(
        &with(r#""outlines": {"o": {"circle": {}}}"#),
        "$.outlines.o.circle",
        "an empty object",
        "the key `radius`",
    );
}

#[test]
fn circles() {
    let with = |tables: &str| format!(r#"{{"planecut": 1, {tables}, "model": {CUBE}}}"#);
    refused(
        &with(r#""parameters": {"a": "=b", "b": "=a + 1"}"#),
        "$.parameters.a",
        "a circle: a → b → a",
        "themselves",
    );
    refused(&with(r#""parameters": {"a": "=a"}"#), "$.parameters.a", "a circle: a → a", "themselves");
    refused(&with(r#""parts": {"p": {"use": "p"}}"#), "$.parts.p.use", "a circle: p → p", "themselves");
    refused(
        &with(r#""parts": {"p": {"union": [{"use": "q"}]}, "q": {"complement": {"use": "p"}}}"#),
        "$.parts.p.union[0].use",
        "a circle: p → q → p",
        "themselves",
    );
    refused(
        &with(
            r#""parts": {"p": {"extrude": {"outline": {"use": "o"}, "height": 1}}},
               "outlines": {"o": {"project": {"use": "p"}}}"#,
        ),
        "$.parts.p.extrude.outline.use",
        "a circle: p → o → p",
        "themselves",
    );
}

#[test]
fn copies_with_bad_counts_or_places() {
    let ring = |count: &str| format!(r#"{{"ring": {{"of": {CUBE}, "count": {count}}}}}"#);
    bad(&ring("0"), "$.model.ring.count", "0", "a whole number of at least 1");
    bad(&ring("2.5"), "$.model.ring.count", "2.5", "a whole number");
    bad(&ring("\"=1-2\""), "$.model.ring.count", "-1 from \"=1-2\"", "a whole number");
    let array = |count: &str| format!(r#"{{"array": {{"of": {CUBE}, "count": {count}, "step": [1, 1, 1]}}}}"#);
    bad(&array("[1, 0, 1]"), "$.model.array.count[1]", "0", "a whole number");
    bad(&array("4"), "$.model.array.count", "4", "a list of 3 numbers");
    let at = |places: &str| format!(r#"{{"instances": {{"of": {CUBE}, "at": {places}}}}}"#);
    bad(&at("[]"), "$.model.instances.at", "an empty list", "one or more places");
    bad(&at("[[1, 2]]"), "$.model.instances.at[0]", "a list of 2 values", "a list of 3 numbers");
    bad(&at("[7]"), "$.model.instances.at[0]", "7", "a place");
    bad(&at("[{\"shift\": 1}]"), "$.model.instances.at[0].shift", "the key `shift`", "matrix");
    bad(&at("[[{\"scale\": 0}]]"), "$.model.instances.at[0][0].scale", "singular", "invertible");
}

#[test]
fn outlines_that_cannot_be() {
    let extrude = |outline: &str| format!(r#"{{"extrude": {{"outline": {outline}, "height": 1}}}}"#);
    let at = |rest: &str| format!("$.model.extrude.outline{rest}");
    bad(&extrude("7"), &at(""), "7", "an OUTLINE: an object with one of the keys polygon");
    bad(&extrude(r#"{"box": 1}"#), &at(".box"), "the key `box`", "one of polygon, rectangle");
    bad(&extrude(r#"{"polygon": []}"#), &at(".polygon"), "an empty list", "three or more points");
    bad(&extrude(r#"{"polygon": [[0, 0], [1, 0]]}"#), &at(".polygon"), "a list of 2 values", "three or more points");
    bad(
        &extrude(r#"{"polygon": [[[0, 0], [1, 0]]]}"#),
        &at(".polygon[0]"),
        "a list of 2 values",
        "three or more points",
    );
    bad(
        &extrude(r#"{"polygon": [[0, 0], [1, 0], [1]]}"#),
        &at(".polygon[2]"),
        "a list of 1 value",
        "a list of 2 numbers",
    );
    bad(&extrude(r#"{"circle": {"radius": -1}}"#), &at(".circle.radius"), "-1", "above 0");
    bad(&extrude(r#"{"union": []}"#), &at(".union"), "an empty list", "one or more outlines");
    bad(
        &extrude(r#"{"offset": {"of": {"circle": {"radius": 1}}, "by": 1, "join": "sharp"}}"#),
        &at(".offset.join"),
        "\"sharp\"",
        "one of round, miter, bevel",
    );
    bad(
        &extrude(r#"{"circle": {"radius": 1}, "matrix": [[1, 0, 0], [0, 1, 0], [0, 1, 1]]}"#),
        &at(".matrix[2]"),
        "[0.0, 1.0, 1.0]",
        "[0, 0, 1]",
    );
    bad(
        &extrude(r#"{"circle": {"radius": 1}, "matrix": [[1, 0, 0]]}"#),
        &at(".matrix"),
        "a list of 1 value",
        "2 or 3 rows",
    );
}

#[test]
fn parameters_that_the_caller_sets() {
    let text = r#"{"planecut": 1, "parameters": {"w": 1, "h": "=w"}, "model": {"sphere": {"radius": "=h"}}}"#;
    let set = |name: &str, value: f64| {
        let options = ModelOptions { parameters: vec![(name.to_owned(), value)], ..ModelOptions::default() };
        read_model(text.as_bytes(), "m.json", &options)
    };
    assert_eq!(set("w", 3.0).expect("read").parameters, [("w".to_owned(), 3.0), ("h".to_owned(), 3.0)]);
    assert_eq!(set("h", 3.0).expect("read").parameters, [("w".to_owned(), 1.0), ("h".to_owned(), 3.0)]);
    let message = |name, value| set(name, value).expect_err("refused").to_string();
    assert_eq!(message("x", 1.0), "m.json: found a value for the parameter `x`, expected one of its parameters: w, h");
    assert_eq!(message("w", f64::NAN), "m.json: found the value NaN for the parameter `w`, expected a finite number");
}
