//! Models are written and read back by the project's own reader: the same brushes, bit for bit, under the same operations.

mod empty;
mod limits;
mod meshes;
mod random;
mod refused;
mod schema;
mod support;
mod text;
