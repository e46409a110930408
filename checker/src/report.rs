//! The answer of a check.

use std::fmt;

use crate::contact::Contact;
use crate::crossing::CrossingReport;
use crate::topology::{TopologyDefect, TopologyReport};

/// The answer of [`check_mesh`](crate::check_mesh). Its `Display` is one line: the first problem, or that there is none.
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
