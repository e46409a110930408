//! Questions to a polytope, none of which changes it: support points, membership, clipping, distances, bounds, faces.
//!
//! All decisions are exact for the `f64` numbers asked with; floating point decides first wherever its error bound lets
//! it. Empty, unbounded and degenerate sets are ordinary cases, and the type of each answer says what comes back.

mod bounds;
mod clip;
mod closest;
mod cone;
mod contains;
mod face;
mod interior;
mod linear_program;
mod support;
mod witness;

pub use bounds::BoundingBox;
pub use clip::ClippedLine;
pub use closest::{ClosestFeature, ClosestPoint};
pub use cone::RecessionCone;
pub use contains::Location;
pub use face::{BoundaryLine, FacePolygon};
pub use interior::{InscribedBall, InteriorPoint};
pub use support::Support;

use super::IncrementalPolytope;
use super::infinity::is_infinity;

impl IncrementalPolytope {
    /// The planes with a face, without the infinity planes.
    pub(super) fn face_slots(&self) -> impl Iterator<Item = u32> + '_ {
        self.planes.faces().filter(|plane| !is_infinity(*plane))
    }
}
