//! Meshes in pieces: written as one file, read again by the small readers of `readers` and compared with the whole.

mod formats;
mod gltf;
mod readers;
mod refused;
mod seams;
mod support;
