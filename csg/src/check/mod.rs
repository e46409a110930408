//! Is a triangle mesh the boundary of a solid: watertight, manifold, and nowhere passing through itself?
//!
//! Topology comes from indices alone ([`check_topology`]); crossings come from positions, with exact signs and one stated
//! tolerance for the rounding of the file they were read from ([`CheckOptions::tolerance`]).

mod bvh;
mod crossing;
mod edges;
mod measure;
mod orient;
mod pair;
mod separation;
mod sheet;
mod topology;

use std::fmt;

use glam::DVec3;

pub use crossing::{Contact, ContactKind, CrossingReport};
pub use measure::{Measures, measure_triangles};
pub use topology::{TopologyDefect, TopologyReport, check_topology};

/// Tolerance for positions that are exact decimals or `f64`.
///
/// Rounding to `f64` moves a vertex by up to `√3 · 2^-53` of its largest coordinate and a depth by twice that, `4e-16`; the rest
/// is room for positions that were computed, or printed with ten digits or more.
pub const TOLERANCE_F64: f64 = 1e-9;
/// Tolerance for positions that were rounded to `f32`: a depth moves by up to `2 √3 · 2^-24 ≈ 2.1e-7` of the largest coordinate.
pub const TOLERANCE_F32: f64 = 4e-7;

/// What [`check_mesh`] looks at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CheckOptions {
    /// Depth below which triangles that cross or overlap count as touching, relative to the diagonal of the bounding box or
    /// to the largest coordinate, whichever is greater.
    ///
    /// - A *crossing* counts where two triangles share interior points (by exact signs), no plane holds both, and neither can be
    ///   moved by the tolerance or less so that they only touch. Triangles that share corners or edges are no exception.
    /// - An *overlap* counts where one triangle lies in the plane of a larger one within the tolerance and they share area,
    ///   a hundred times deeper in the plane than the tolerance, and both are wider than it.
    /// - An *edge crossing* counts where surfaces pass through each other along an edge, all four wings reaching a hundred
    ///   times the tolerance from it at angles above one degree.
    ///
    /// Zero (or a negative number) means: crossings and overlaps are decided by exact signs alone.
    pub tolerance: f64,
    /// Whether to look for crossings at all; without, only the topology is checked.
    pub crossings: bool,
}

impl Default for CheckOptions {
    fn default() -> Self {
        Self { tolerance: TOLERANCE_F64, crossings: true }
    }
}

/// The answer of [`check_mesh`]. Its `Display` is one line: the first problem, or that there is none.
#[derive(Debug, Clone, PartialEq)]
pub struct CheckReport {
    /// What the indices say.
    pub topology: TopologyReport,
    /// What the positions say; `None` where it was not asked, or where indices or coordinates are unusable.
    pub crossings: Option<CrossingReport>,
}

/// The first problem of a mesh, topology before crossings.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum MeshProblem {
    /// It is not a closed, oriented 2-manifold.
    #[error("{0}")]
    Topology(TopologyDefect),
    /// It passes through itself.
    #[error("{0}")]
    Contact(Contact),
}

impl CheckReport {
    /// The first problem, if there is any.
    #[must_use]
    pub fn first_problem(&self) -> Option<MeshProblem> {
        let contact = || self.crossings.as_ref()?.first.map(MeshProblem::Contact);
        self.topology.first_defect.map(MeshProblem::Topology).or_else(contact)
    }

    /// Whether no problem was found.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        self.first_problem().is_none()
    }
}

impl fmt::Display for CheckReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.first_problem(), &self.crossings) {
            (Some(problem), _) => write!(f, "{problem}"),
            (None, Some(_)) => f.write_str("watertight, manifold, not self-crossing"),
            (None, None) => f.write_str("watertight, manifold"),
        }
    }
}

/// Checks a triangle mesh given by vertex positions and the vertex indices of each triangle. Any data is accepted; what cannot
/// be used is a defect in the report.
///
/// The result does not depend on the number of threads.
#[must_use]
pub fn check_mesh(positions: &[DVec3], triangles: &[[u32; 3]], options: &CheckOptions) -> CheckReport {
    let (topology, twins) = topology::analyse(positions, triangles);
    let usable = twins.len() == 3 * triangles.len();
    let tolerance = options.tolerance.max(0.0);
    let crossings =
        (options.crossings && usable).then(|| crossing::find_crossings(positions, triangles, &twins, tolerance));
    CheckReport { topology, crossings }
}
