//! Is a triangle mesh the boundary of a solid: watertight, manifold, and nowhere passing through itself?
//!
//! For any mesh, whatever made it: a slice of positions (anything that converts to `[f64; 3]`) and a slice of triangles, three
//! vertex indices each, counter-clockwise seen from outside. Topology comes from indices alone ([`check_topology`]); crossings come
//! from positions, with exact signs and one stated tolerance for the rounding of the file they were read from
//! ([`CheckOptions::tolerance`]).
//!
//! ```
//! use planecut_check::{CheckOptions, TopologyDefect, check_mesh};
//!
//! let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
//! let tetrahedron = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
//! let report = check_mesh(&corners, &tetrahedron, &CheckOptions::default());
//! assert!(report.is_sound());
//! assert_eq!(report.to_string(), "watertight, manifold, not self-crossing");
//! assert_eq!((report.topology.genus, report.topology.measures.volume), (Some(0), 1.0 / 6.0));
//!
//! let open = check_mesh(&corners, &tetrahedron[..3], &CheckOptions::default());
//! assert_eq!(open.topology.first_defect, Some(TopologyDefect::OpenEdge { a: 0, b: 2 }));
//! ```
//!
//! No code is shared with the kernel and the pipeline of planecut, whose meshes this crate judges: half-edges, disjoint sets, box
//! tree, sums and exact signs are its own. With the feature `parallel` (default) it works on all processor cores.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod axis;
mod bvh;
mod components;
mod contact;
mod crossing;
mod edges;
mod forest;
mod hubs;
mod measure;
mod obb;
mod options;
mod orient;
mod pair;
mod parallel;
mod report;
mod separation;
mod sheet;
mod sum;
mod topology;

use glam::DVec3;

pub use contact::{Contact, ContactKind};
pub use crossing::CrossingReport;
pub use measure::{Measures, measure_triangles};
pub use options::{CheckOptions, TOLERANCE_F32, TOLERANCE_F64};
pub use report::{CheckReport, MeshProblem};
pub use topology::{TopologyDefect, TopologyReport};

/// Checks a triangle mesh given by vertex positions and the vertex indices of each triangle. Any data is accepted; what cannot
/// be used is a defect in the report.
///
/// The result does not depend on the number of threads.
#[must_use]
pub fn check_mesh<P: Copy + Into<[f64; 3]>>(
    positions: &[P],
    triangles: &[[u32; 3]],
    options: &CheckOptions,
) -> CheckReport {
    let positions = vectors(positions);
    let (topology, twins) = topology::analyse(&positions, triangles);
    let usable = twins.len() == 3 * triangles.len();
    let tolerance = options.tolerance.max(0.0);
    let crossings =
        (options.crossings && usable).then(|| crossing::find_crossings(&positions, triangles, &twins, tolerance));
    CheckReport { topology, crossings }
}

/// The topology of a mesh. Linear in its size for vertices of bounded degree.
#[must_use]
pub fn check_topology<P: Copy + Into<[f64; 3]>>(positions: &[P], triangles: &[[u32; 3]]) -> TopologyReport {
    topology::analyse(&vectors(positions), triangles).0
}

fn vectors<P: Copy + Into<[f64; 3]>>(positions: &[P]) -> Vec<DVec3> {
    positions.iter().map(|&p| DVec3::from_array(p.into())).collect()
}

/// The example of the README, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}
