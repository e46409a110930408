//! Exact CSG over convex bodies.
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
mod weld;

pub use brush::{Brush, BrushFace, Material, MaterialId, Model};
pub use contract::contract_short_edges;
pub use evaluate::{Evaluation, ModelSummary, SolidMeasures, StageTimes, evaluate, summarize};
pub use mesh::{Mesh, MeshFace};
pub use plane_table::{PlaneId, PlaneTable, SNAP_TOLERANCE};
pub use weld::WeldError;
