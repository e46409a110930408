//! planecut, a convex-CSG modeling kernel: half-spaces in, watertight meshes out.
//!
//! A solid is a union of convex bodies, and each body is an intersection of half-spaces `n·x ≤ d`. Every topological
//! decision is the exact sign of a small determinant of plane coefficients; coordinates are computed for people and for
//! files, and decide nothing about it. So Booleans take no tolerance, and the mesh that leaves is closed by construction. What does
//! decide by size, before and after (planes that are one but for noise, edges too short to survive rounding), is listed in
//! `docs/tolerances.md` and in [`csg::tolerances`].
//!
//! This crate gathers the crates of the project under one name and adds the command line:
//!
//! | module | what it holds |
//! |---|---|
//! | [`kernel`] | exact signs, [`HalfSpace`](kernel::HalfSpace), and [`IncrementalPolytope`](kernel::IncrementalPolytope): convex polyhedra whose planes can be added, moved and removed |
//! | [`csg`] | a [`Tree`](csg::Tree) of set operations on [`Brush`](csg::Brush)es: [`evaluate`](csg::evaluate) gives its boundary as a [`Mesh`](csg::Mesh), [`LiveModel`](csg::LiveModel) keeps it up to date through edits |
//! | [`cells`] | [`Solid`](cells::Solid): the inside as disjoint convex cells; [`coarsen`](cells::coarsen): few cells for colliders |
//! | [`shapes`] | [`primitives`](shapes::primitives), [`outline`](shapes::outline)s, [`shaping`](shapes::shaping), closed polyhedra |
//! | [`check`] | [`check_mesh`](check::check_mesh): is any mesh watertight, manifold, free of self-intersections |
//! | [`import`] | readers of the native [model file](import::model), of OpenSCAD's evaluated trees ([`scad`](import::scad)), of Quake-family [`map`](import::map)s, and of [`mesh`](import::mesh) files: OBJ, STL, PLY and glTF |
//! | [`export`] | [`encode`](export::encode) a mesh as GLB, glTF, OBJ, STL, 3MF or PLY; [`write_model`](export::write_model) writes a tree as a model file |
//! | [`enclosing`] | few convex cells around a solid, made the way that adds least |
//! | [`coarsening`] | the same of solids, meshes and hulls, as others read the cells |
//! | [`expression`] | solids as operations on solids, evaluated when somebody asks |
//! | [`reading`], [`triangles`] | solids of any file's bytes, and of triangles that a program has |
//! | `blocks` | models larger than memory, block by block, here or on many machines (feature `blocks`, on unless turned off) |
//! | `tiles` | 3D Tiles of them, with coarser levels of proven error (feature `blocks`) |
//! | `picture` | pictures of meshes and cells (feature `picture`, on unless turned off) |
//! | `cli` | the `planecut` program, for others that carry it (feature `cli`, on unless turned off) |
//!
//! Features off unless turned on: `serde` (planes, polytopes, models and meshes as data), `mint` (its vectors as arguments).
//!
//! Everything of `cells`, `shapes` and `check` can also be reached through [`csg`]. The feature `cli` (default) is for the program alone: with `default-features = false` a library
//! gets none of its dependencies.
//!
//! # Example
//!
//! A plate with a row of holes, from numbers to the bytes of a file:
//!
//! ```
//! use planecut::csg::{Brush, Material, MaterialId, Model, Solid, Transform, Tree, evaluate, primitives};
//! use planecut::export::{ExportOptions, Format, Part, encode, encode_parts};
//! use planecut::kernel::{DVec3, HalfSpace};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // A tree says how bodies are combined; nothing is evaluated yet.
//! let steel = MaterialId(0);
//! let mut tree = Tree::from(Brush::cuboid(DVec3::ZERO, DVec3::new(40.0, 10.0, 4.0), steel));
//! let hole = Tree::from(primitives::prism(8.0, 3.0, 4, steel)?); // over a square with corners on a circle of radius 3
//! for x in [8.0, 16.0, 24.0, 32.0] {
//!     tree = tree - hole.clone().transformed(&Transform::translation(DVec3::new(x, 5.0, -2.0))?)?;
//! }
//!
//! // Its boundary: a closed mesh, flat regions in one piece each.
//! let model = Model { materials: vec![Material::named("steel")], tree };
//! let evaluation = evaluate(&model)?;
//! assert!((evaluation.solid.volume - (40.0 * 10.0 - 4.0 * 18.0) * 4.0).abs() < 1e-9);
//! assert_eq!(evaluation.mesh.faces.len(), 6 + 4 * 4);
//! let glb = encode(&evaluation.mesh, Format::Glb, &ExportOptions::default())?;
//! assert!(glb.starts_with(b"glTF"));
//!
//! // Its cells: convex and disjoint. Planes cut them in place and can be removed again.
//! let mut solid = Solid::from_tree(&model.tree);
//! let whole = solid.volume();
//! let cut = solid.add_plane(HalfSpace::new(DVec3::X, 20.0)?);
//! assert!(solid.volume() < whole);
//! solid.remove_plane(cut);
//! assert_eq!(solid.volume(), whole);
//! let cells = solid.cell_meshes(&model.materials)?;
//! let parts: Vec<Part> = cells.iter().map(|mesh| Part::new("cell", mesh)).collect();
//! encode_parts(&parts, Format::Obj, &ExportOptions::default())?;
//! # Ok(())
//! # }
//! ```
//!
//! The same as a [model file](import::model), which any language can write:
//!
//! ```
//! use planecut::csg::evaluate;
//! use planecut::import::model::{ModelOptions, read_model};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let text = br#"{"planecut": 1, "parameters": {"holes": 4}, "model": {"difference": [
//!   {"box": {"min": [0, 0, 0], "max": ["=8 * holes + 8", 10, 4]}},
//!   {"array": {
//!     "of": {"prism": {"height": 8, "radius": 3, "sides": 4}, "transform": [{"translate": [8, 5, -2]}]},
//!     "count": ["=holes", 1, 1], "step": [8, 0, 0]
//!   }}
//! ]}}"#;
//! let import = read_model(text, "plate.json", &ModelOptions::default())?;
//! assert!((evaluate(&import.model)?.solid.volume - (40.0 * 10.0 - 4.0 * 18.0) * 4.0).abs() < 1e-9);
//! # Ok(())
//! # }
//! ```
//!
//! The programs in `examples/` model procedurally, cut and un-cut, and export.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

/// Trees of set operations and all that is made of them: everything of [`planecut_csg`], [`cells`] and [`shapes`]
/// under one name.
pub mod csg {
    pub use planecut_cells::*;
    pub use planecut_check as check;
    pub use planecut_csg::tolerances;
    pub use planecut_csg::*;
    pub use planecut_shapes::*;
}

pub use planecut_cells as cells;
pub use planecut_check as check;
pub use planecut_import as import;
pub use planecut_kernel as kernel;
pub use planecut_shapes as shapes;

pub mod export {
    //! What leaves: mesh files, convex bodies and, with the feature `picture`, what [`picture`](crate::picture) holds.
    pub use planecut_export::*;

    #[cfg(feature = "picture")]
    #[doc(no_inline)]
    pub use crate::picture::*;
}
#[cfg(feature = "blocks")]
pub mod blocks;
#[cfg(feature = "cli")]
pub mod cli;
pub mod coarsening;
pub mod enclosing;
pub mod expression;
#[cfg(feature = "picture")]
pub mod picture;
pub mod reading;
#[cfg(feature = "session")]
pub mod session;
#[cfg(feature = "blocks")]
pub mod tiles;
pub mod triangles;

/// The command line names the crate as other programs do.
#[cfg(feature = "cli")]
extern crate self as planecut;

/// The example of the README, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}
