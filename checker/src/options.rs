//! What a check looks at, and what it tolerates.

/// Tolerance for positions that are exact decimals or `f64`.
///
/// Rounding to `f64` moves a vertex by up to `√3 · 2^-53` of its largest coordinate and a depth by twice that, `4e-16`; the rest
/// is room for positions that were computed, or printed with ten digits or more.
pub const TOLERANCE_F64: f64 = 1e-9;
/// How far rounding positions to `f32` moves a depth at most, relative to the largest coordinate: `2 √3 · 2^-24`, rounded down.
pub(crate) const ROUNDING_F32: f64 = 2.06e-7;
/// Tolerance for positions that were rounded to `f32`: a depth moves by up to `2 √3 · 2^-24 ≈ 2.1e-7` of the largest coordinate.
pub const TOLERANCE_F32: f64 = 4e-7;

/// What [`check_mesh`](crate::check_mesh) looks at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CheckOptions {
    /// Depth below which triangles that cross or overlap count as touching, relative to the diagonal of the bounding box or
    /// to the largest coordinate, whichever is greater.
    ///
    /// - A *crossing* counts where two triangles share interior points (by exact signs), no plane holds both, and neither can be
    ///   moved by the tolerance or less so that they only touch. Triangles that share corners or edges are no exception.
    /// - An *overlap* counts where one triangle lies in the plane of a larger one within the tolerance and they share area,
    ///   a hundred times deeper in the plane than the tolerance, and both are wider than it. Solids and gaps thinner than the
    ///   tolerance are none. So triangles that face opposite ways count only where they lie in one plane, those of two surfaces
    ///   to the last digits of `f64` and those of one surface by exact signs; and not at all where the tolerance allows for
    ///   positions in `f32`, which closes such gaps. Triangles that face the same way count where exact signs say that they meet,
    ///   and in `f32` where both are of one connected surface, which is folded there.
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
