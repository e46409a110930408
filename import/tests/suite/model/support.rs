//! Small model files to read.

use std::path::Path;

use planecut_import::model::{ModelError, ModelImport, ModelOptions, read_model};

/// Reads a text as the file `m.json` beside the files of these tests.
pub(crate) fn read(text: &str) -> Result<ModelImport, ModelError> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/files");
    read_model(text.as_bytes(), "m.json", &ModelOptions { folder, ..ModelOptions::default() })
}

/// A file with this model alone.
pub(crate) fn file(model: &str) -> String {
    format!("{{\"planecut\": 1, \"model\": {model}}}")
}

/// Reads a file with this model alone.
#[track_caller]
pub(crate) fn model(model: &str) -> ModelImport {
    read(&file(model)).unwrap_or_else(|error| panic!("{model}\n{error}"))
}

/// The volume of a file with this model alone.
#[track_caller]
pub(crate) fn volume(text: &str) -> f64 {
    let import = read(text).unwrap_or_else(|error| panic!("{text}\n{error}"));
    let evaluation = planecut_csg::evaluate(&import.model).unwrap_or_else(|error| panic!("{text}\n{error}"));
    evaluation.solid.volume
}

/// Fails the test unless two numbers agree to twelve digits.
#[track_caller]
pub(crate) fn assert_close(found: f64, expected: f64, what: &str) {
    assert!((found - expected).abs() <= 1e-12 * expected.abs().max(1.0), "{what}: {found}, expected {expected}");
}
