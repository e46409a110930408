//! Layered checks of the whole structure (paper §3.7): [`invariants`] of what is stored, [`topology`] of what is seen; and
//! the paper's planned fallback, to rebuild what fails them.

mod invariants;
mod topology;

#[cfg(test)]
mod corrupt;

pub use invariants::InvariantError;
pub use topology::TopologyError;

use thiserror::Error;

use super::IncrementalPolytope;

/// What [`IncrementalPolytope::validate_or_rebuild`] found and did.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Validation {
    /// Every check passed; nothing was changed.
    Sound,
    /// A check failed; the structure was rebuilt from the planes.
    Rebuilt(ValidationError),
}

/// A check that failed: a bug in this crate, never the user's mistake.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum ValidationError {
    /// What is stored is broken.
    #[error(transparent)]
    Invariant(#[from] InvariantError),
    /// What is seen is broken.
    #[error(transparent)]
    Topology(#[from] TopologyError),
}

impl IncrementalPolytope {
    /// Checks invariants and topology, and where they fail rebuilds the structure from the planes and their stamps
    /// (the paper's planned fallback, §3.7). Handles and stamps of planes stay, those of vertices and edges do not.
    ///
    /// It should never fire; [`rebuild_count`](Self::rebuild_count) tells how often it did.
    pub fn validate_or_rebuild(&mut self) -> Validation {
        match self.validate_all() {
            Ok(()) => Validation::Sound,
            Err(error) => {
                self.rebuild();
                self.finish_change();
                self.rebuilds += 1;
                debug_assert_eq!(self.validate_all(), Ok(()), "a fresh build is sound");
                Validation::Rebuilt(error)
            }
        }
    }

    /// How often [`validate_or_rebuild`](Self::validate_or_rebuild) had to rebuild; a clone goes on counting.
    #[must_use]
    pub fn rebuild_count(&self) -> u64 {
        self.rebuilds
    }

    fn validate_all(&self) -> Result<(), ValidationError> {
        // the links first: the checks of the topology walk along them
        self.check_invariants()?;
        Ok(self.validate_topology()?)
    }
}
