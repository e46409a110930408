//! Data types through serde's data model.

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, from_value, to_value};

/// A copy by way of data; numbers are kept bit for bit.
///
/// # Panics
///
/// Panics if the value cannot be written, or what was written cannot be read.
pub fn through_data<T: Serialize + DeserializeOwned>(value: &T) -> T {
    from_value(to_value(value).expect("it can be written")).expect("it can be read")
}

/// The error with which data is refused.
///
/// # Panics
///
/// Panics if it is accepted.
#[must_use]
pub fn refusal<T: DeserializeOwned>(data: Value) -> String {
    match from_value::<T>(data) {
        Ok(_) => panic!("it is accepted"),
        Err(error) => error.to_string(),
    }
}
