//! planecut, a convex-CSG modeling kernel: half-spaces in, watertight meshes out.
//!
//! A solid is a union of convex bodies, and each body is an intersection of half-spaces `n·x ≤ d`. Every topological
//! decision is the exact sign of a small determinant of plane coefficients; coordinates are computed for people and for
//! files, and decide nothing. So no tolerance is needed, and the mesh that leaves is closed by construction.
//!
//! This crate gathers the four crates of the project under one name and adds the command line:
//!
//! | module | what it holds |
//! |---|---|
//! | [`kernel`] | exact signs, half-spaces, convex polyhedra that planes are added to and taken back from |
//! | [`csg`] | models made of brushes, their union as a mesh, checks of any mesh |
//! | [`import`] | readers of Quake-family `.map` files and of OBJ, STL, PLY and glTF meshes |
//! | [`export`] | writers of GLB, glTF, OBJ and STL, and rendered previews |
//!
//! # Example
//!
//! Two boxes that share a part, from planes to the bytes of a file:
//!
//! ```
//! use planecut::csg::{Brush, Material, MaterialId, Model, Tree, evaluate};
//! use planecut::export::{ExportOptions, Format, encode};
//! use planecut::kernel::DVec3;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let block = |min: f64, max: f64| Tree::from(Brush::cuboid(DVec3::splat(min), DVec3::splat(max), MaterialId(0)));
//! let model = Model {
//!     materials: vec![Material::named("stone")],
//!     tree: block(0.0, 2.0) | block(1.0, 3.0),
//! };
//! let evaluation = evaluate(&model)?;
//! assert!((evaluation.solid.volume - 15.0).abs() < 1e-12); // 8 + 8 − 1
//! let glb = encode(&evaluation.mesh, Format::Glb, &ExportOptions::default())?;
//! assert!(glb.starts_with(b"glTF"));
//! # Ok(())
//! # }
//! ```
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub use planecut_csg as csg;
pub use planecut_export as export;
pub use planecut_import as import;
pub use planecut_kernel as kernel;
