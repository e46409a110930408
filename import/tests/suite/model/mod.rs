//! The model file.

mod damaged;
mod errors;
mod forms;
mod limits;
mod schema;
mod support;
