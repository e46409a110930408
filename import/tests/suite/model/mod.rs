//! The model file.

mod damaged;
mod errors;
mod forms;
mod limits;
mod meshes;
mod schema;
mod support;
