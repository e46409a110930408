//! What coarsening is asked for, and why it may fail.

use planecut_csg::{EvaluateError, Tree};
use thiserror::Error;

/// Fewest faces that a cell can be limited to: each bounded convex body fits into one of six faces among its own, not always into one of
/// five (a box).
pub const LEAST_MAX_FACES: usize = 6;
/// Fewest vertices that a cell can be limited to: those of a box.
pub const LEAST_MAX_VERTICES: usize = 8;

/// What a volume counts that cells share, where one that is added counts 1: of covers that add the same, the one whose cells overlap less is
/// better, and hulls that are smaller leave more choice.
pub const DEFAULT_OVERLAP_WEIGHT: f64 = 1.0 / 8.0;

/// On which side of the solid's boundary the cells stay.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Side {
    /// The cells enclose the solid.
    #[default]
    Outer,
    /// The solid encloses the cells.
    Inner,
}

/// What to make of a solid's convex parts. By default, as few cells as there can be without adding anything.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CoarsenOptions {
    /// Maximum number of cells. As many as there are, or more, leaves the parts as they are.
    pub max_cells: Option<usize>,
    /// Maximum volume added, relative to the solid's; of inner cells, lacking. Together with `max_cells` it goes first: then there may
    /// be more cells.
    pub max_excess: Option<f64>,
    /// Maximum number of faces of each cell, at least [`LEAST_MAX_FACES`].
    pub max_faces: Option<usize>,
    /// Maximum number of vertices of each cell, at least [`LEAST_MAX_VERTICES`].
    pub max_vertices: Option<usize>,
    /// What no cell may grow into: door and window openings. Where the solid itself is there, it stays.
    pub keep_clear: Option<Tree>,
    /// What a ball of this radius covers that comes from outside and touches nothing stays clear, but for a margin beside the solid, [`Coarsened::clear_tolerance`](super::Coarsened::clear_tolerance): nothing grows
    /// into doors and windows that are wide enough for it, into the inside of a mug, or a tunnel. There may be more cells then than `max_cells`. In the input's units.
    pub clear_radius: Option<f64>,
    /// Parts of different materials do not become one cell.
    pub by_material: bool,
    /// Cells that are thinner than this grow until they are not, on both sides alike; in the input's units.
    pub min_thickness: Option<f64>,
    /// Around the solid or within it.
    pub side: Side,
    /// How much volume that cells share counts, relative to volume that is added; by default [`DEFAULT_OVERLAP_WEIGHT`].
    pub overlap_weight: Option<f64>,
    /// Maximum distance between parts of one cell, each from the nearest other, about: a cell that reaches across more empty space is a bar in the air. There may be more cells
    /// then than `max_cells`. By default [`DEFAULT_MAX_GAP`](crate::tolerances::DEFAULT_MAX_GAP) of the diagonal of all, unless that would leave more cells.
    pub max_gap: Option<f64>,
}

/// Why parts were not coarsened.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum CoarsenError {
    /// There is nothing.
    #[error("found an empty solid, expected one with cells")]
    Empty,
    /// The solid, or what is to be kept clear, is not bounded.
    #[error("found a solid that reaches infinity, expected one that is bounded")]
    Unbounded,
    /// A leaf of the solid, or of what is to be kept clear, is a closed mesh: `convex_tree` of the crate of shapes makes cells of it.
    #[error("found a closed mesh as a leaf, expected convex bodies alone")]
    Mesh,
    /// Coordinates are so large or small that no hull can be made of them.
    #[error("found coordinates out of the accepted range, expected magnitudes between 2^-150 and 2^150")]
    OutOfRange,
    /// An option that cannot be met.
    #[error("{option}: found {found}, expected {expected}")]
    Option {
        /// Its name.
        option: &'static str,
        /// What was given.
        found: String,
        /// What is accepted.
        expected: &'static str,
    },
    /// The radius of a ball is so small, for the size of the solid or for the thickness of a shell, that what it reaches cannot be kept clear.
    #[error("clear_radius: found {found}, expected about {least} or more for a solid of this size")]
    Radius {
        /// What was given.
        found: f64,
        /// About the least that is accepted.
        least: f64,
    },
    /// Parts of a surface cannot be so small that they keep out of what is to stay clear.
    #[error("found no way to keep what a ball of radius {radius} reaches clear, expected a larger one")]
    NotClear {
        /// The radius.
        radius: f64,
    },
    /// A cell cannot have so few faces or vertices without growing into what is kept clear.
    #[error(
        "found a cell with {faces} faces and {vertices} vertices that cannot have fewer without growing into a region kept clear"
    )]
    Blocked {
        /// The faces it has.
        faces: usize,
        /// The vertices it has.
        vertices: usize,
    },
    /// The union has no mesh.
    #[error(transparent)]
    Evaluate(#[from] EvaluateError),
}

impl CoarsenOptions {
    /// Refuses numbers that mean nothing.
    pub(super) fn check(&self) -> Result<(), CoarsenError> {
        let refuse = |option, found: String, expected| Err(CoarsenError::Option { option, found, expected });
        if self.max_cells == Some(0) {
            return refuse("max_cells", "0".to_owned(), "at least 1");
        }
        if let Some(found) = self.max_excess.filter(|excess| excess.is_nan() || *excess < 0.0) {
            return refuse("max_excess", found.to_string(), "a number that is not negative");
        }
        if let Some(found) = self.max_faces.filter(|faces| *faces < LEAST_MAX_FACES) {
            return refuse("max_faces", found.to_string(), "at least 6");
        }
        if let Some(found) = self.max_vertices.filter(|vertices| *vertices < LEAST_MAX_VERTICES) {
            return refuse("max_vertices", found.to_string(), "at least 8");
        }
        for (option, found) in [("overlap_weight", self.overlap_weight), ("max_gap", self.max_gap)] {
            if let Some(found) = found.filter(|value| !value.is_finite() || *value < 0.0) {
                return refuse(option, found.to_string(), "a number that is not negative");
            }
        }
        if let Some(found) = self.clear_radius.filter(|radius| !radius.is_finite() || *radius <= 0.0) {
            return refuse("clear_radius", found.to_string(), "a number above 0");
        }
        if let Some(found) = self.min_thickness.filter(|thickness| !thickness.is_finite() || *thickness < 0.0) {
            return refuse("min_thickness", found.to_string(), "a number that is not negative");
        }
        Ok(())
    }
}
