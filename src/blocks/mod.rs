//! Models that are larger than memory: cut into blocks, which are evaluated one by one, on this machine or on many.
//!
//! The tree of a model goes by piece by piece ([`TreeSink`](planecut_csg::TreeSink)), and a [`PlanBuilder`] writes what each block is to know of it into a file of its own
//! ([`BlockPlan`]). A block is evaluated from these bytes alone ([`evaluate_block`]), wherever that is done, and gives a piece of the mesh, as bytes.
//! [`Pieces`] are all of them: it is proven that neighbours end in the same edges on the wall between them, so that together they are one closed surface.
//!
//! Memory holds one block for each thread, the walls, and what is small beside the model: planes that noise makes different, and brushes that both add and take.
//!
//! Way of a model through this folder: `build` → `spool` (all brushes in a file, with `sorted` numbers of them) → `scatter` (the files of
//! blocks, `plan`) → `evaluate` (`piece`) → `pieces`.
//!
//! ```
//! use planecut::blocks::{BlockPlan, PlanBuilder, evaluate_all};
//! use planecut::csg::{BlockOptions, Brush, Material, MaterialId, Operation, TreeSink};
//! use planecut::kernel::DVec3;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let folder = tempfile::tempdir()?;
//! let mut builder = PlanBuilder::create(folder.path(), BlockOptions { brushes: 100 })?;
//! builder.begin(Operation::Union)?;
//! for k in 0..1000 {
//!     let at = DVec3::new(f64::from(k % 40), f64::from(k / 40), 0.0);
//!     builder.leaf(Brush::cuboid(at, at + 0.75, MaterialId(0)), None)?;
//! }
//! builder.end()?;
//! let plan: BlockPlan = builder.finish(vec![Material::named("stone")])?;
//! let pieces = evaluate_all(&plan, 2, &|_, _| true)?;
//! assert!(pieces.count() >= 10);
//! assert!((pieces.solid().volume - 1000.0 * 0.75_f64.powi(3)).abs() < 1e-9);
//! # Ok(())
//! # }
//! ```

mod build;
mod bytes;
mod error;
mod evaluate;
mod local;
mod piece;
mod pieces;
mod plan;
mod scatter;
mod sorted;
mod spool;

pub use build::PlanBuilder;
pub use error::BlocksError;
pub use evaluate::evaluate_block;
pub use local::evaluate_all;
pub use pieces::Pieces;
pub use plan::{BlockPlan, ModelCounts, PlannedBlock};
