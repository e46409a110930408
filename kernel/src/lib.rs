//! Exact dynamic convex polyhedra: half-spaces are added, moved and removed in about a microsecond.
//!
//! [`IncrementalPolytope`] keeps the vertices, edges and faces of an intersection of [`HalfSpace`]s up to date while
//! planes are added and removed. Plane coefficients are taken as exact numbers and every decision about the structure is an exact
//! [`sign`]; the only epsilon is that of the view ([`IncrementalPolytope::with_epsilon`]): which short edges are reported. Unbounded,
//! degenerate and empty sets are ordinary cases. What a removal costs does not depend on
//! the number of planes, because it is known beforehand which of them can bound what is new.
//!
//! The idea is that of the paper "Topology-Based Halfspace Deletion for Dynamic Convex Polytopes", whose sections the
//! documentation names; here it is exact and local. `docs/kernel.md` explains the algorithm, with proofs, costs and what
//! was rejected.
//!
//! ```
//! use planecut_kernel::{DVec3, HalfSpace, IncrementalPolytope};
//!
//! # fn main() -> Result<(), planecut_kernel::HalfSpaceError> {
//! let mut octant = IncrementalPolytope::new();
//! for axis in DVec3::AXES {
//!     octant.add_plane(HalfSpace::new(-axis, 0.0)?);
//! }
//! assert!(!octant.is_bounded());
//! let lid = octant.add_plane(HalfSpace::new(DVec3::ONE, 3.0)?).plane();
//! let measures = octant.measures().expect("the lid bounds it");
//! assert!((measures.volume - 4.5).abs() < 1e-12);
//! octant.remove_plane(lid);
//! assert!(!octant.is_bounded());
//! # Ok(())
//! # }
//! ```
//! # Vectors
//!
//! Every function that takes a vector takes whatever converts into one: `[f64; 3]`, a tuple, [`DVec3`], and with the feature `mint` the
//! vectors and points of that crate. [`HalfSpace::from_array`] takes a plane as four numbers. What is returned is a [`DVec3`], which
//! `to_array()` makes an array, and [`HalfSpace::to_array`] a plane. So no version of `glam` that the caller uses can clash with the one in here:
//!
//! ```
//! use planecut_kernel::{HalfSpace, IncrementalPolytope};
//!
//! # fn main() -> Result<(), planecut_kernel::HalfSpaceError> {
//! let mut cube = IncrementalPolytope::new();
//! for axis in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
//!     cube.add_plane(HalfSpace::new(axis, 1.0)?);
//!     cube.add_plane(HalfSpace::new(axis.map(|v| -v), 0.0)?);
//! }
//! assert!(cube.contains([0.5, 0.5, 1.0]));
//! let corners: Vec<[f64; 3]> = cube.to_mesh().0.iter().map(|corner| corner.to_array()).collect();
//! assert_eq!(corners.len(), 8);
//! # Ok(())
//! # }
//! ```
//!
//! # Features
//!
//! None is on by default. `mint`: vectors of that crate as arguments. `serde`: planes, handles, results and whole polytopes as data.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod arithmetic;
mod half_space;
mod hull;
mod meet;
mod polytope;
pub mod sign;

pub use arithmetic::{DoubleDouble, decompose, decompose_odd, round_quotient};
pub use glam::{DMat3, DVec2, DVec3, DVec4};
pub use half_space::{HalfSpace, HalfSpaceError, MAX_NORMAL, MAX_NORMAL_RATIO, MAX_OFFSET_RATIO, MIN_NORMAL};
pub use hull::{HullError, MAX_COORDINATE, approximate_hull_triangles, hull, hull_triangles};
pub use meet::{compare_exactly, direction_across, line_coordinates, line_direction, meet, planar_turn};
pub use polytope::{
    AddPlaneResult, BoundaryLine, BoundingBox, ClippedLine, ClosestFeature, ClosestPoint, DEFAULT_EPSILON, Edge,
    EdgeIdx, EdgeKind, Face, FacePolygon, FacetEdge, IncrementalPolytope, InscribedBall, InteriorPoint, InvariantError,
    Location, Measures, MovePlaneResult, PlaneIdx, RecessionCone, RemovePlaneResult, RemovePlanesResult, Support,
    TopologyError, Validation, ValidationError, Vertex, VertexIdx,
};

/// The example of the README, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}
