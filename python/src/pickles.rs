//! Pickles: of an object bytes are kept, which the static method `_unpickle` of its class takes.

use pyo3::PyClass;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde::de::DeserializeOwned;

use crate::errors::{Failure, refuse};

/// What `__reduce__` gives: the function that makes the object again, and what it takes.
pub(crate) type Reduced<'py> = (Bound<'py, PyAny>, (Bound<'py, PyBytes>,));

/// An object as its bytes.
pub(crate) fn reduced<'py, T: PyClass>(
    object: &Bound<'py, T>,
    bytes: Result<Vec<u8>, rmp_serde::encode::Error>,
) -> PyResult<Reduced<'py>> {
    let bytes = bytes.map_err(Failure::of)?;
    Ok((object.as_any().get_type().getattr("_unpickle")?, (PyBytes::new(object.py(), &bytes),)))
}

/// What bytes hold. `what` says in an error what they are not, such as `is no pickled cell`.
pub(crate) fn unpickled<T: DeserializeOwned>(bytes: &[u8], what: &str) -> PyResult<T> {
    rmp_serde::from_slice(bytes).map_err(|error| refuse(format!("found what {what}: {error}")))
}
