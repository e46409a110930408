//! Exact CSG over convex bodies: a [`Model`] of brushes in, the watertight [`Mesh`] of their union out.
//!
//! [`evaluate`] interns the planes of a model ([`PlaneTable`]), builds each brush's body, takes the boundary of the union straight
//! from brush faces (the skin) and welds it. Boolean operations add no planes, so nothing is ever rounded before the
//! coordinates of the finished mesh. [`check`] tells whether any mesh is watertight, manifold and free of crossings.
//!
//! ```
//! use planecut_csg::{Brush, BrushFace, Material, MaterialId, Model, evaluate};
//! use planecut_kernel::{DVec3, HalfSpace};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let cube = |x: f64| -> Result<Brush, planecut_kernel::HalfSpaceError> {
//!     let mut faces = Vec::new();
//!     for (axis, low, high) in [(DVec3::X, x, x + 2.0), (DVec3::Y, 0.0, 2.0), (DVec3::Z, 0.0, 2.0)] {
//!         for half_space in [HalfSpace::new(axis, high)?, HalfSpace::new(-axis, -low)?] {
//!             faces.push(BrushFace { half_space, material: MaterialId(0) });
//!         }
//!     }
//!     Ok(Brush { faces, ..Brush::default() })
//! };
//! let materials = vec![Material { name: "stone".into(), color: None }];
//! let union = evaluate(&Model { materials, brushes: vec![cube(0.0)?, cube(1.0)?] })?;
//! assert_eq!(union.solid.volume, 12.0);
//! assert_eq!(union.mesh.faces.len(), 6);
//! # Ok(())
//! # }
//! ```
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod body;
mod bounds;
mod brush;
pub mod check;
mod contract;
mod evaluate;
mod mesh;
mod neighbours;
mod plane_table;
mod skin;
mod sum;
mod weld;

pub use brush::{Brush, BrushFace, Material, MaterialId, Model};
pub use contract::{contract_edges, contract_short_edges};
pub use evaluate::{Evaluation, ModelSummary, SolidMeasures, StageTimes, evaluate, summarize};
pub use mesh::{Mesh, MeshFace};
pub use plane_table::{PlaneId, PlaneTable, SNAP_TOLERANCE};
pub use weld::WeldError;
