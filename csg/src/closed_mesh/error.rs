//! Why triangles are no closed mesh.

use glam::DVec3;
use thiserror::Error;

/// Why triangles are not the boundary of a solid.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ClosedMeshError {
    /// A coordinate is infinite or not a number.
    #[error("found vertex {vertex} at {position}, expected finite coordinates")]
    NotFinite {
        /// The vertex.
        vertex: usize,
        /// Where it is.
        position: DVec3,
    },
    /// All of it is so small that products of coordinates are no numbers any more.
    #[error("found a mesh of the size {size:e}, expected at least 2^-240")]
    TooSmall {
        /// The largest difference of two coordinates along an axis.
        size: f64,
    },
    /// A triangle refers to a vertex that there is not.
    #[error("found vertex {vertex} in triangle {triangle}, expected a number below {vertices}")]
    NoVertex {
        /// The triangle.
        triangle: usize,
        /// The vertex.
        vertex: u32,
        /// The number of vertices.
        vertices: usize,
    },
    /// Along an edge more triangles run one way than the other.
    #[error("found {count} open {}, the first one from {from} to {to}, expected a closed mesh", if *.count == 1 { "edge" } else { "edges" })]
    Open {
        /// The triangle that it belongs to, as it was given.
        triangle: usize,
        /// Where the first open edge begins.
        from: DVec3,
        /// Where it ends.
        to: DVec3,
        /// The number of open edges.
        count: usize,
    },
}
