//! Models that are larger than memory: [`planning`] makes a [`plan`] of their blocks, which are evaluated to [`pieces`].

mod pieces;
mod plan;
mod planning;

use planecut::blocks::{BlocksError, evaluate_block as piece_of};
use planecut::export::ExportError;
use planecut::expression::ExpressionError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::errors::Failure;
use crate::files::said;
use crate::job::Job;

impl From<BlocksError> for Failure {
    fn from(error: BlocksError) -> Self {
        match &error {
            BlocksError::Io { path, .. } | BlocksError::Export(ExportError::Write { path, .. }) => said(path, &error),
            BlocksError::Damaged { path, expected } if path.as_os_str().is_empty() => {
                Self::of(format!("found other bytes, expected {expected}"))
            }
            BlocksError::Damaged { path, .. } => said(path, &error),
            BlocksError::Evaluate { source, .. } => {
                Self { is_bug: ExpressionError::from(*source).is_bug(), ..Self::of(&error) }
            }
            BlocksError::Tree | BlocksError::Seam { .. } => Self::bug(&error),
            _ => Self::of(&error),
        }
    }
}

/// The piece of a block, from the bytes of its file: the same ones wherever it is called and however many threads there are. For clusters that the package does not know.
///
/// Args:
///     data: The content of `Block.path`.
///     threads: Number of threads; by default one for each core.
///
/// Returns:
///     The content for `Block.piece_path`. `PlanecutError` for bytes that are no block of this version of planecut.
#[pyfunction]
#[pyo3(signature = (data, *, threads=None))]
fn evaluate_block<'py>(py: Python<'py>, data: &[u8], threads: Option<usize>) -> PyResult<Bound<'py, PyBytes>> {
    let data = data.to_vec();
    let piece = Job::new(py, threads, None)?.run(py, move || Ok(piece_of(&data)?))?;
    Ok(PyBytes::new(py, &piece))
}

/// Adds the functions and classes to the module.
pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(planning::plan, module)?)?;
    module.add_function(wrap_pyfunction!(plan::open, module)?)?;
    module.add_function(wrap_pyfunction!(evaluate_block, module)?)?;
    module.add_class::<plan::Plan>()?;
    module.add_class::<plan::Block>()?;
    module.add_class::<plan::Counts>()?;
    module.add_class::<pieces::Pieces>()
}
