//! What goes wrong, as JavaScript's exceptions.

use std::fmt::Display;

use js_sys::{Error, Reflect};
use planecut::reading::ReadError;
use wasm_bindgen::JsValue;

/// Why something was not done.
#[derive(Debug, Default)]
pub(crate) struct Failure {
    message: String,
    line: Option<u32>,
    json_path: Option<String>,
}

pub(crate) type Outcome<T> = Result<T, Failure>;

impl Failure {
    /// Input that cannot be used.
    pub(crate) fn of(error: impl Display) -> Self {
        Self { message: error.to_string(), ..Self::default() }
    }
}

impl From<ReadError> for Failure {
    fn from(error: ReadError) -> Self {
        Self { line: error.line(), json_path: error.json_path().map(str::to_owned), ..Self::of(&error) }
    }
}

impl From<Failure> for JsValue {
    /// An `Error` of the name `PlanecutError`, with `line` and `jsonPath` where there are some.
    fn from(Failure { message, line, json_path }: Failure) -> Self {
        let error = Error::new(&message);
        error.set_name("PlanecutError");
        let set = |name: &str, value: Self| {
            // an object of our own takes any property
            let _ = Reflect::set(&error, &name.into(), &value);
        };
        set("line", line.map_or(Self::NULL, Self::from));
        set("jsonPath", json_path.map_or(Self::NULL, |path| Self::from(path.as_str())));
        error.into()
    }
}
