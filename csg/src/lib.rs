//! Exact CSG over convex bodies: a [`Model`] of brushes in, the watertight [`Mesh`] of their union out.
//!
//! [`evaluate`] interns the planes of a model ([`PlaneTable`]), builds each brush's body, takes the boundary of the union straight
//! from brush faces (the skin) and welds it. Boolean operations add no planes, so nothing is ever rounded before the
//! coordinates of the finished mesh. [`check`] tells whether any mesh is watertight, manifold and free of crossings.
//!
//! ```
//! use planecut_csg::{Brush, Material, MaterialId, Model, Tree, evaluate};
//! use planecut_kernel::DVec3;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let cube = |x: f64| Brush::cuboid(DVec3::new(x, 0.0, 0.0), DVec3::new(x + 2.0, 2.0, 2.0), MaterialId(0));
//! let materials = vec![Material::named("stone")];
//! let union = evaluate(&Model { materials, tree: Tree::from(cube(0.0)) | cube(1.0).into() })?;
//! assert_eq!(union.solid.volume, 12.0);
//! assert_eq!(union.mesh.faces.len(), 6);
//! # Ok(())
//! # }
//! ```
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod blocks;
mod body;
mod bounds;
mod boxes;
mod brush;
mod caps;
pub mod check;
pub mod coarsen;
mod collapse;
mod contract;
mod corner;
mod cutaway;
mod distinct;
mod evaluate;
mod expression;
mod known_planes;
mod live;
mod locality;
mod mesh;
mod outer;
pub mod outline;
mod parallel;
mod plane_table;
pub mod polyhedron;
pub mod primitives;
mod sets;
pub mod shaping;
mod skin;
mod solid;
mod source;
mod sum;
mod transform;
mod tree;
mod weld;

pub use blocks::{Block, BlockOptions, BlocksError, BlocksSummary, evaluate_in_blocks};
pub use body::Built;
pub use brush::{Brush, BrushFace, Material, MaterialId, Model};
pub use contract::{contract_edges, contract_short_edges};
pub use cutaway::{CutMaterial, Cutaway};
pub use evaluate::{
    EvaluateError, Evaluation, ModelSummary, SolidMeasures, StageTimes, UnboundedBrushes, evaluate, evaluate_with,
    summarize,
};
pub use live::{BrushId, Change, Edit, EditError, Edited, FaceId, LiveFace, LiveModel, Role};
pub use mesh::{Mesh, MeshFace};
pub use outline::Outline;
pub use plane_table::{PlaneId, PlaneTable, SNAP_TOLERANCE};
pub use primitives::ShapeError;
pub use solid::{Cell, CellPlane, CutId, RayHit, Solid};
pub use source::{FaceSource, TextureAxes, TextureUnit};
pub use transform::{Transform, TransformError, sine_and_cosine};
pub use tree::{Operation, Tree, TreeNode};
pub use weld::WeldError;
