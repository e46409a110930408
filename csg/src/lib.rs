//! Exact CSG over convex bodies: a [`Model`] of brushes in, the watertight [`Mesh`] of their union out.
//!
//! [`evaluate`] interns the planes of a model ([`PlaneTable`]), builds each brush's body, takes the boundary of the union straight
//! from brush faces and welds it. Boolean operations add no planes, so nothing is rounded between the planes and the
//! coordinates of the finished mesh. What decides by size before and after that is in [`tolerances`].
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
#![cfg_attr(not(test), deny(clippy::cast_possible_truncation, clippy::cast_possible_wrap, clippy::cast_sign_loss))]

mod arrangement;
mod base;
mod blocks;
mod body;
mod boundary;
mod closed_mesh;
mod evaluate;
mod expression;
mod ids;
mod live;
mod mesh;
mod model;
mod plane_table;
pub mod stages;
pub mod tolerances;
mod weld;

pub use arrangement::{CombineError, CombinedMeshes, Inside, combine_meshes, unite_meshes};
pub use blocks::{
    Block, BlockBuilder, BlockGrid, BlockNode, BlockOperation, BlockOptions, BlockPlace, BlockSides, BlockSurvey,
    BlocksError, BlocksSummary, BrushPlace, FirstOperand, NearPlaneFinder, NearRanges, PlaneMark, PlaneSurvey,
    PolarityStack, SeamEdge, SeamEdges, SharedBrushes, SnappedPlanes, TreeScatter, UnboundedBrush, brush_mark,
    evaluate_in_blocks, uncancelled_edges, unmatched_edges,
};
pub use body::BuiltBodies;
pub use closed_mesh::{ClosedMesh, ClosedMeshError, WindingRule};
pub use evaluate::{
    EvaluateError, Evaluation, ModelSummary, StageTimes, UnboundedBrushes, evaluate, evaluate_built, evaluate_with,
    summarize,
};
pub use expression::Polarity;
pub use live::{
    BrushId, Change, ConvexPiece, Edit, EditError, Edited, FaceBuffers, FaceId, FaceRange, LiveFace, LiveModel,
    LiveNode, ModelBuffers, NodeId, PlaneRemoval, Preview, PreviewFace, Role, Snap, SnapOptions, SnapTarget,
    TreeOperand,
};
pub use mesh::{Mesh, MeshFace, Noise, SolidMeasures, contract_edges, contract_short_edges};
pub use model::{
    Brush, BrushFace, CutMaterial, Cutaway, FaceSource, Material, MaterialId, MeshBody, Model, Operation, TextureAxes,
    TextureUnit, Transform, TransformError, Tree, TreeBuilder, TreeNode, TreeSink, UsedMaterials, sine_and_cosine,
};
pub use plane_table::{PlaneId, PlaneTable};
pub use planecut_parallel::{keep_freed_memory, spare_addresses};
pub use tolerances::SNAP_TOLERANCE;
pub use weld::WeldError;

/// The example of the README, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}
