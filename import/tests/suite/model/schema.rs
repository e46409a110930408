//! `docs/model.schema.json` says what the reader says: the examples fit both, and files with one fault fit neither.

use std::path::{Path, PathBuf};

use jsonschema::Validator;
use planecut_import::model::{ModelOptions, read_model};
use serde_json::{Value, json};

use super::support::{file, read};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn schema() -> Value {
    let text = std::fs::read(root().join("docs/model.schema.json")).expect("the schema");
    serde_json::from_slice(&text).expect("JSON")
}

fn validator() -> Validator {
    jsonschema::draft202012::options().build(&schema()).expect("a schema of draft 2020-12")
}

#[test]
fn the_schema_is_one() {
    assert_eq!(schema()["$schema"], json!("https://json-schema.org/draft/2020-12/schema"));
    assert!(jsonschema::draft202012::meta::validate(&schema()).is_ok());
}

#[test]
fn every_example_fits_the_schema_and_is_read() {
    let validator = validator();
    let mut examples = 0;
    for entry in std::fs::read_dir(root().join("examples")).expect("the examples") {
        let path = entry.expect("an entry").path();
        if path.extension().is_none_or(|ending| ending != "json") {
            continue;
        }
        let text = std::fs::read(&path).expect("an example");
        let value: Value = serde_json::from_slice(&text).expect("JSON");
        if let Err(error) = validator.validate(&value) {
            panic!("{}: {error} at {}", path.display(), error.instance_path());
        }
        let import = read_model(&text, &path.display().to_string(), &ModelOptions::default());
        let import = import.unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(import.warnings, [], "{}", path.display());
        examples += 1;
    }
    assert!(examples >= 10, "{examples}");
}

#[test]
fn the_page_and_the_schema_know_the_same_keys() {
    let page = std::fs::read_to_string(root().join("docs/model-file.md")).expect("the page");
    for definition in ["node", "outline"] {
        let keys =
            schema()["$defs"][definition]["properties"].as_object().expect("keys").keys().cloned().collect::<Vec<_>>();
        for key in keys {
            assert!(page.contains(&format!("\"{key}\"")), "the page does not explain {key}");
        }
    }
}

const CUBE: &str = r#"{"box": {"min": [0, 0, 0], "max": [1, 1, 1]}}"#;
const DISC: &str = r#"{"circle": {"radius": 1}}"#;

/// Models with one node of each kind, and every optional key.
fn good() -> Vec<String> {
    let mut models: Vec<String> = [
        r#"{"halfspaces": [[1, 0, 0, 1]]}"#,
        r#"{"points": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, "=1"]]}"#,
        r#"{"sphere": {"radius": 1, "segments": 8}}"#,
        r#"{"cylinder": {"height": 1, "radius": 1, "top_radius": 0, "segments": 8}}"#,
        r#"{"cone": {"height": 1, "radius": 1}}"#,
        r#"{"prism": {"height": 1, "radius": 1, "sides": 5}}"#,
        r#"{"pyramid": {"height": 1, "radius": 1, "sides": 4}}"#,
        r#"{"wedge": {"size": [1, 2, 3]}}"#,
        r#"{"capsule": {"height": 1, "radius": 1, "segments": 6}}"#,
        r#"{"regular": {"solid": "icosahedron", "radius": 1}}"#,
        r#"{"torus": {"radius": 3, "tube": 1, "segments": 6, "tube_segments": 6}}"#,
        r#"{"mesh": {"file": "./l.obj", "scale": "=1/2", "rule": "nonzero", "close": 1e-9}}"#,
        r#"{"halfspaces": [[1, 0, 0, 1], [0, 1, 0, "=1"]], "materials": ["m", null], "material": "n"}"#,
        r#"{"mesh": {"vertices": [[0, 0, 0], [1, 0, 0], [0, "=1", 0], [0, 0, 1]],
            "triangles": [[0, 2, 1], [0, 1, 3], [0, 3, "=2"], [1, 2, 3]], "materials": ["m", null, "m", "n"], "rule": "odd"}}"#,
    ]
    .map(str::to_owned)
    .into();
    for outline in [
        DISC.to_owned(),
        r#"{"polygon": [[0, 0], [1, 0], [0, 1]]}"#.to_owned(),
        r#"{"polygon": [[[0, 0], [3, 0], [0, 3]]], "matrix": [[1, 0, 0], [0, 1, 0]]}"#.to_owned(),
        r#"{"rectangle": {"min": [0, 0], "max": [1, 1]}}"#.to_owned(),
        format!(r#"{{"offset": {{"of": {DISC}, "by": 1, "join": "miter", "segments": 8}}}}"#),
        format!(r#"{{"slice": {{"of": {CUBE}, "z": 0.5}}}}"#),
        format!(r#"{{"project": {CUBE}}}"#),
        format!(r#"{{"union": [{DISC}, {DISC}]}}"#),
        format!(r#"{{"xor": [{DISC}]}}"#),
    ] {
        models.push(format!(r#"{{"extrude": {{"outline": {outline}, "height": 1, "center": true}}}}"#));
    }
    models.push(format!(
        r#"{{"extrude": {{"outline": {DISC}, "height": 1, "twist": 90, "scale": [1, 2], "slices": 9}}}}"#
    ));
    models.push(
        r#"{"revolve": {"outline": {"rectangle": {"min": [1, 0], "max": [2, 1]}}, "angle": 90, "segments": 8}}"#
            .to_owned(),
    );
    for key in ["union", "intersection", "difference", "xor", "hull", "minkowski"] {
        models.push(format!(r#"{{"{key}": [{CUBE}, {CUBE}], "name": "n"}}"#));
    }
    models.push(format!(
        r#"{{"complement": {CUBE}, "transform": [], "matrix": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]}}"#
    ));
    models.push(format!(r#"{{"instances": {{"of": {CUBE}, "at": [[1, 2, 3], [], [{{"scale": 2}}, {{"mirror": [1, 0, 0]}}], {{"matrix": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}}]}}}}"#));
    models.push(format!(r#"{{"array": {{"of": {CUBE}, "count": [1, 2, "=1+2"], "step": [1, 2, 3]}}}}"#));
    models.push(format!(
        r#"{{"ring": {{"of": {CUBE}, "count": 3, "angle": -90}}, "transform": [{{"rotate": {{"axis": [0, 0, 1], "angle": 5}}}}, {{"rotate": [1, 2, 3]}}]}}"#
    ));
    models
}

#[test]
fn what_the_schema_takes_the_reader_takes() {
    let validator = validator();
    for model in good() {
        let value: Value = serde_json::from_str(&file(&model)).expect("JSON");
        if let Err(error) = validator.validate(&value) {
            panic!("{model}\n{error}");
        }
        read(&file(&model)).unwrap_or_else(|error| panic!("{model}\n{error}"));
    }
}

/// Every way to spoil one value of a file.
fn spoiled(value: &Value, at: &str, found: &mut Vec<(String, Value)>) {
    let pointer = |key: &str| format!("{at}/{key}");
    match value {
        Value::Object(members) => {
            for (key, value) in members {
                found.push((format!("{} renamed", pointer(key)), json!({"rename": key})));
                found.push((format!("{} null", pointer(key)), Value::Null));
                spoiled(value, &pointer(key), found);
            }
        }
        Value::Array(items) => {
            found.push((format!("{at} with one more"), json!("more")));
            for (index, item) in items.iter().enumerate() {
                spoiled(item, &pointer(&index.to_string()), found);
            }
        }
        _ => found.push((format!("{at} null"), Value::Null)),
    }
}

/// A copy of `value` with the change that `spoiled` describes.
fn with_change(value: &Value, description: &str) -> Option<Value> {
    let mut copy = value.clone();
    let (pointer, change) = description.split_once(' ')?;
    match change {
        "null" => *copy.pointer_mut(pointer)? = Value::Null,
        "renamed" => {
            let (parent, key) = pointer.rsplit_once('/')?;
            let members = copy.pointer_mut(parent)?.as_object_mut()?;
            let value = members.remove(key)?;
            members.insert(format!("{key}s"), value);
        }
        _ => copy.pointer_mut(pointer)?.as_array_mut()?.push(json!("more")),
    }
    Some(copy)
}

/// The schema and the reader refuse the same changes. (Names of parts, numbers that contradict each other and lists that must be as long as others are
/// beyond a schema; no change here makes such.)
#[test]
fn one_fault_anywhere_is_refused_by_both() {
    let validator = validator();
    let mut refused = 0;
    for model in good() {
        let whole: Value = serde_json::from_str(&file(&model)).expect("JSON");
        let mut changes = Vec::new();
        spoiled(&whole, "", &mut changes);
        changes.retain(|(description, _)| !description.ends_with("/materials with one more"));
        for (description, _) in changes {
            let Some(changed) = with_change(&whole, &description) else { continue };
            let (by_schema, by_reader) = (validator.is_valid(&changed), read(&changed.to_string()).is_ok());
            assert_eq!(by_schema, by_reader, "{description}\n{changed}\n{:?}", read(&changed.to_string()).err());
            refused += usize::from(!by_schema);
        }
    }
    assert!(refused > 500, "{refused}");
}

#[test]
fn faults_beyond_one_change() {
    let validator = validator();
    for model in [
        "{}".to_owned(),
        r#"{"material": "m"}"#.to_owned(),
        r#"{"union": []}"#.to_owned(),
        format!(r#"{{"minkowski": [{CUBE}]}}"#),
        format!(r#"{{"union": [{CUBE}], "hull": [{CUBE}]}}"#),
        CUBE.replace("}}", r#"}, "with": {}}"#),
        r#"{"mesh": ""}"#.to_owned(),
        r#"{"mesh": {"file": "l.obj", "scale": 0}}"#.to_owned(),
        r#"{"mesh": {"file": "l.obj", "rule": "even"}}"#.to_owned(),
        r#"{"mesh": {"vertices": [], "triangles": []}}"#.to_owned(),
        r#"{"mesh": {"vertices": [[0, 0, 0]]}}"#.to_owned(),
        r#"{"mesh": {"vertices": [[0, 0, 0]], "triangles": [[0, 0, -1]]}}"#.to_owned(),
        r#"{"mesh": {"vertices": [[0, 0, 0]], "triangles": [[0, 0, 0.5]]}}"#.to_owned(),
        r#"{"mesh": {"file": "l.obj", "vertices": [[0, 0, 0]], "triangles": [[0, 0, 0]]}}"#.to_owned(),
        r#"{"mesh": {"vertices": [[0, 0, 0]], "triangles": [[0, 0, 0]], "close": 1}}"#.to_owned(),
        r#"{"halfspaces": [[1, 0, 0, 1]], "materials": []}"#.to_owned(),
        r#"{"mesh": "l.obj", "materials": ["m"]}"#.to_owned(),
        CUBE.replace("}}", r#"}, "materials": [null, null, null, null, null, null]}"#),
        r#"{"sphere": {"radius": 0}}"#.to_owned(),
        r#"{"sphere": {"radius": "1"}}"#.to_owned(),
        r#"{"sphere": {"radius": 1, "segments": 2}}"#.to_owned(),
        r#"{"sphere": {"radius": 1, "segments": 8.5}}"#.to_owned(),
        r#"{"cylinder": {"height": 1, "radius": -1}}"#.to_owned(),
        format!(r#"{{"ring": {{"of": {CUBE}, "count": 0}}}}"#),
        format!(r#"{{"array": {{"of": {CUBE}, "count": [1, 1], "step": [1, 1, 1]}}}}"#),
        CUBE.replace("}}", r#"}, "transform": [{"scale": 1, "translate": [0, 0, 0]}]}"#),
        CUBE.replace("}}", r#"}, "transform": [{}]}"#),
        r#"{"extrude": {"outline": {"polygon": [[0, 0], [1, 0]]}, "height": 1}}"#.to_owned(),
        format!(r#"{{"revolve": {{"outline": {DISC}, "angle": 400}}}}"#),
    ] {
        let value: Value = serde_json::from_str(&file(&model)).expect("JSON");
        assert!(!validator.is_valid(&value) && read(&file(&model)).is_err(), "{model}");
    }
}
