//! What is seen from outside: vertices, edges, faces, meshes and their validation.

mod consistency;
mod random;
mod solids;
