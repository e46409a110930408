//! Triangle meshes: OBJ, STL, PLY and glTF.

mod colors;
mod damaged;
mod files;
mod formats;
mod gltf;
mod leaves;
#[cfg(feature = "meshopt")]
mod packed;
mod solid;
mod support;
mod textures;
