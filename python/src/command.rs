//! The command `planecut`.

use std::ffi::OsString;

use pyo3::prelude::*;

/// Runs the program `planecut` on arguments, the first of which is its own name, and gives its exit status. For a process that does nothing else.
#[pyfunction]
fn run_command(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| planecut::cli::run(arguments))
}

/// Adds the function to the module.
pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(run_command, module)?)
}
