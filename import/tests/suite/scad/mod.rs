//! The reader of OpenSCAD's evaluated trees.

mod damage;
mod forms;
mod leniency;
mod meshes;
mod reference;
mod shapes;

use planecut_csg::{Evaluation, evaluate};
use planecut_import::scad::{ScadError, ScadImport, ScadOptions, read_scad};

/// Reads a text that has to be right.
fn read(text: &str) -> ScadImport {
    read_scad(text.as_bytes(), "test.csg", &ScadOptions::default()).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn refused(text: &[u8]) -> ScadError {
    let read = read_scad(text, "test.csg", &ScadOptions::default());
    read.err().unwrap_or_else(|| panic!("accepted: {}", String::from_utf8_lossy(text)))
}

fn evaluated(text: &str) -> Evaluation {
    evaluate(&read(text).model).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn volume(text: &str) -> f64 {
    evaluated(text).solid.volume
}

fn assert_volume(text: &str, expected: f64) {
    let found = volume(text);
    assert!((found - expected).abs() <= 1e-12 * expected.abs().max(1.0), "{found} instead of {expected}: {text}");
}
