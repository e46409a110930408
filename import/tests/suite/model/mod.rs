//! The model file.

mod damaged;
mod errors;
mod face_materials;
mod forms;
mod inline_meshes;
mod limits;
mod meshes;
mod schema;
mod stream;
mod support;
