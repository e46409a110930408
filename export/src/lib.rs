//! Mesh writers.
//!
//! - [`encode`] turns a [`planecut_csg::Mesh`] into the bytes of a mesh file ([`Format`]); [`encode_parts`]
//!   does so for several named meshes in one file, and [`write_parts`] piece by piece. [`Format`] says what each format keeps of the mesh.
//! - [`write_pieces`] writes one file of many meshes that together are one surface, of which one at a time is read ([`MeshPieces`]).
//! - [`written`] tells what triangles such a file holds, where its precision is not that of the mesh.
//! - [`stored_positions`] finds positions that such a file stores without rounding.
//! - [`write_brushes`] puts convex bodies back into formats that editors open: a Quake map, or OpenSCAD's evaluated tree
//!   ([`BrushFormat`]).
//! - [`write_model`] puts a model with its whole tree of operations into the project's own model file, exactly.
//! - [`physics_files`] describes a rigid body for physics engines: MJCF, URDF or USD, with the meshes beside it ([`PhysicsFormat`]); [`MassProperties`]
//!   are its mass and inertia, [`Cuboid`] finds boxes among its colliders, [`Engine`] says what engines accept.
//! - [`AtomicFile`] and [`write_atomic`] put bytes under a file name, completely or not at all.
//!
//! Every writer gives the same bytes for the same input, whatever the number of threads.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod brushes;
mod decimal;
mod error;
mod file;
mod format;
mod gltf;
mod material;
mod model_file;
mod obj;
mod part;
mod physics;
mod pieces;
mod ply;
mod stl;
mod stored;
mod surface;
mod threemf;
mod write_pieces;
mod xml;

pub use brushes::{BrushFormat, write_brushes};
pub use error::ExportError;
pub use file::{AtomicFile, write_atomic};
pub use format::{Format, encode, encode_parts, write_parts, written};
pub use material::{distinct_color, material_color};
pub use model_file::write_model;
pub use obj::{write_mtl, write_mtl_of_pieces};
pub use part::{ExportOptions, Part, Projection, Shading, TextureMapping, Unit, Written};
pub use physics::{
    Collider, Cuboid, Engine, EngineLimits, MassProperties, PhysicsFile, PhysicsFormat, PrincipalInertia, RigidBody,
    physics_files,
};
pub use pieces::MeshPieces;
pub use stored::stored_positions;
pub use write_pieces::{PiecesWritten, write_pieces};

/// The example of the README, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}
