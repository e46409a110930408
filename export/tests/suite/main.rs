//! The writers: one executable. How much memory they take is measured by `../memory.rs`, alone in its process.
#![forbid(unsafe_code)]

mod assets;
mod brushes;
mod full_disk;
mod gltf;
mod model_file;
mod obj_stl;
mod pieces;
