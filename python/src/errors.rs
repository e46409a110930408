//! What goes wrong, as Python's exceptions.

use std::any::Any;
use std::fmt::Display;

use planecut::cells::coarsen::CoarsenError;
use planecut::coarsening::CoarseningError;
use planecut::csg::{EditError, EvaluateError};
use planecut::expression::ExpressionError;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::{PyErr, create_exception};

create_exception!(
    planecut,
    PlanecutError,
    PyValueError,
    "Input that cannot be used, told in one line: what was found, and what was expected.\n\n\
     Attributes:\n    path: The file, where the input is one, else None.\n    line: The line of the file, counted from 1, where there is one, else None.\n    json_path: \
     The place in a model file, as `$.model.box`, where there is one, else None."
);
create_exception!(
    planecut,
    InternalError,
    PyRuntimeError,
    "A bug in planecut. The objects that were worked on are as they were before."
);

/// Why something was not done, before it is an exception: made without the interpreter.
#[derive(Debug, Clone, Default)]
pub(crate) struct Failure {
    pub(crate) message: String,
    pub(crate) path: Option<String>,
    pub(crate) line: Option<usize>,
    pub(crate) json_path: Option<String>,
    pub(crate) is_bug: bool,
}

/// What work without the interpreter gives.
pub(crate) type Outcome<T> = Result<T, Failure>;

impl Failure {
    /// Input that cannot be used.
    pub(crate) fn of(error: impl Display) -> Self {
        Self { message: error.to_string(), ..Self::default() }
    }

    /// A bug.
    pub(crate) fn bug(error: impl Display) -> Self {
        Self { is_bug: true, ..Self::of(error) }
    }

    /// What a panic says.
    pub(crate) fn of_panic(payload: &(dyn Any + Send)) -> Self {
        let text = payload.downcast_ref::<&str>().copied().or(payload.downcast_ref::<String>().map(String::as_str));
        Self::bug(format!("found a bug in planecut, expected none: {}", text.unwrap_or("a panic without a message")))
    }
}

impl From<Failure> for PyErr {
    fn from(failure: Failure) -> Self {
        let Failure { message, path, line, json_path, is_bug } = failure;
        if is_bug {
            return InternalError::new_err(message);
        }
        let error = PlanecutError::new_err(message);
        Python::attach(|py| {
            let value = error.value(py);
            let set = || -> PyResult<()> {
                value.setattr("path", path)?;
                value.setattr("line", line)?;
                value.setattr("json_path", json_path)
            };
            // an exception takes any attribute
            if let Err(other) = set() {
                return other;
            }
            error
        })
    }
}

impl From<ExpressionError> for Failure {
    fn from(error: ExpressionError) -> Self {
        Self { is_bug: error.is_bug(), ..Self::of(&error) }
    }
}

impl From<EvaluateError> for Failure {
    fn from(error: EvaluateError) -> Self {
        ExpressionError::from(error).into()
    }
}

impl From<EditError> for Failure {
    fn from(error: EditError) -> Self {
        match error {
            EditError::Evaluate(error) => error.into(),
            _ => Self::of(error),
        }
    }
}

impl From<CoarsenError> for Failure {
    fn from(error: CoarsenError) -> Self {
        match error {
            CoarsenError::Evaluate(error) => error.into(),
            _ => Self::of(error),
        }
    }
}

impl From<CoarseningError> for Failure {
    fn from(error: CoarseningError) -> Self {
        Self { is_bug: error.is_bug(), ..Self::of(&error) }
    }
}

/// An exception for input that cannot be used.
pub(crate) fn refuse(message: impl Display) -> PyErr {
    Failure::of(message).into()
}

/// Adds the exceptions to the module.
pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    let error = py.get_type::<PlanecutError>();
    for attribute in ["path", "line", "json_path"] {
        error.setattr(attribute, py.None())?;
    }
    module.add("PlanecutError", error)?;
    module.add("InternalError", py.get_type::<InternalError>())
}
