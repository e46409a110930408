//! What assets have beside triangles, read again: normals, texture coordinates, tangents, colours, sources, packed buffers, shared
//! meshes; and the formats of printers and scanners.

mod attributes;
mod held;
mod mesh_textures;
mod packages;
#[cfg(feature = "meshopt")]
mod packed;
mod shared;
mod support;
