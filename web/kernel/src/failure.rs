//! What goes wrong, as JavaScript's exceptions.

use std::fmt::Display;

use js_sys::{Error, Reflect};
use planecut::coarsening::CoarseningError;
use planecut::csg::{EditError, EvaluateError};
use planecut::expression::ExpressionError;
use planecut::reading::ReadError;
use wasm_bindgen::JsValue;

/// Why something was not done.
#[derive(Debug, Default)]
pub(crate) struct Failure {
    message: String,
    line: Option<u32>,
    json_path: Option<String>,
    is_bug: bool,
}

pub(crate) type Outcome<T> = Result<T, Failure>;

impl Failure {
    /// Input that cannot be used.
    pub(crate) fn of(error: impl Display) -> Self {
        Self { message: error.to_string(), ..Self::default() }
    }

    /// A bug of ours.
    pub(crate) fn bug(error: impl Display) -> Self {
        Self { is_bug: true, ..Self::of(error) }
    }

    /// Something in a file, at a line counted from 1; 0 where there is none.
    pub(crate) fn of_line(name: &str, line: u32, message: &str) -> Self {
        match line {
            0 => Self::of(format!("{name}: {message}")),
            line => Self { line: Some(line), ..Self::of(format!("{name}:{line}: {message}")) },
        }
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
            other => Self::of(other),
        }
    }
}

impl From<CoarseningError> for Failure {
    fn from(error: CoarseningError) -> Self {
        Self { is_bug: error.is_bug(), ..Self::of(&error) }
    }
}

impl From<ReadError> for Failure {
    fn from(error: ReadError) -> Self {
        Self { line: error.line(), json_path: error.json_path().map(str::to_owned), ..Self::of(&error) }
    }
}

impl From<Failure> for JsValue {
    /// An `Error` of the name `PlanecutError`, with `line` and `jsonPath` where there are some; `InternalError` for a bug.
    fn from(Failure { message, line, json_path, is_bug }: Failure) -> Self {
        let error = Error::new(&message);
        error.set_name(if is_bug { "InternalError" } else { "PlanecutError" });
        let set = |name: &str, value: Self| {
            // an object of our own takes any property
            let _ = Reflect::set(&error, &name.into(), &value);
        };
        set("line", line.map_or(Self::NULL, Self::from));
        set("jsonPath", json_path.map_or(Self::NULL, |path| Self::from(path.as_str())));
        error.into()
    }
}
