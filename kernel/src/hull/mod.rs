//! The convex hull of points as a polytope.
//!
//! [`quick`] finds the facets with exact signs (quickhull: Barber, Dobkin, Huhdanpaa 1996); coplanar ones are joined
//! exactly; [`plane`] makes each a half-space that contains every point, climbing over [`neighbours`].

mod neighbours;
mod plane;
mod quick;

use glam::DVec3;
use thiserror::Error;

use crate::half_space::HalfSpace;
use crate::polytope::IncrementalPolytope;
use quick::Triangulation;

/// Largest accepted magnitude of a coordinate (`2^150`); one that is not zero must be at least its inverse.
pub const MAX_COORDINATE: f64 = f64::from_bits((1023 + 150) << 52);
/// Edges shorter than this part of the size of the points are contracted in what is reported of their hull.
const CONTRACTED: f64 = 1.0 / (1u64 << 32) as f64;

/// Why points have no hull that is a polytope.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum HullError {
    /// A coordinate is NaN or infinite.
    #[error("point {index} is not finite: {point}")]
    NotFinite {
        /// Which point.
        index: usize,
        /// The point.
        point: DVec3,
    },
    /// A coordinate is outside the accepted range ([`MAX_COORDINATE`]).
    #[error("point {index} is outside the accepted range: {point}")]
    OutOfRange {
        /// Which point.
        index: usize,
        /// The point.
        point: DVec3,
    },
    /// The hull has no interior.
    #[error("the hull of the points has no interior: it has dimension {dimension}")]
    NoInterior {
        /// The dimension of the hull, exactly: 2 where the points lie on a plane, 1 where they lie on a line, 0 where they
        /// are all one (or none).
        dimension: usize,
    },
}

/// The convex hull of points, in any order and as degenerate as they come: duplicates, collinear and coplanar ones.
///
/// The combinatorics are decided exactly. One plane is made for each facet, coplanar parts joined. Where its coefficients fit
/// (integers below 2⁵³ after scaling) the plane is exact, if all three coordinates of the points lie on a grid of less than
/// 2²⁴ steps or the normal can be written with whole numbers below 2²⁴, as along the axes; otherwise its normal is the exact
/// one rounded, and its offset that of the farthest point in this direction, rounded up. So the hull **contains every point,
/// exactly**, and each plane touches the points to within one rounding of its offset. In a facet's direction the hull thus
/// exceeds the true one by at most `2⁻⁵¹` of the largest coordinate, at a vertex by that over the sine of half its angle;
/// between facets that are coplanar but for rounding there can be vertices that are none of the points. Where facets meet at
/// less than about two degrees, as on a nearly flat hull, one more plane through their edge keeps rounding from opening it.
/// The epsilon of the polytope is `2⁻³²` of the size of the points, so that vertices where more than three rounded planes meet
/// are seen as one. The order of the planes is random, the same each time for the same points.
///
/// Cost: about `n log n`, and about five microseconds for each facet; more where many points lie on a line or on a circle.
///
/// # Errors
/// [`HullError`] where a point is not finite or out of range, or the hull has no interior.
///
/// ```
/// use planecut_kernel::{HullError, hull};
///
/// # fn main() -> Result<(), HullError> {
/// let mut points: Vec<[f64; 3]> = (0..27).map(|k| [k % 3, k / 3 % 3, k / 9].map(f64::from)).collect();
/// let cube = hull(&points)?;
/// assert_eq!((cube.vertex_count(), cube.planes().count()), (8, 6));
/// points.truncate(9);
/// assert_eq!(hull(&points).unwrap_err(), HullError::NoInterior { dimension: 2 });
/// # Ok(())
/// # }
/// ```
pub fn hull<P: Into<DVec3> + Copy>(points: &[P]) -> Result<IncrementalPolytope, HullError> {
    hull_of(&vectors(points))
}

fn hull_of(points: &[DVec3]) -> Result<IncrementalPolytope, HullError> {
    check_range(points)?;
    let triangulation = Triangulation::of(points)?;
    let (low, high) = bounds(points);
    let mut polytope = IncrementalPolytope::with_epsilon((high - low).max_element() * CONTRACTED);
    let neighbours = triangulation.vertex_neighbours();
    for facet in in_random_rounds(triangulation.facets()) {
        polytope.add_plane(plane::through(points, triangulation.corners(facet), &neighbours));
    }
    for edge in triangulation.sharp_edges() {
        if let Some(half_space) = plane::across_edge(points, &edge, &neighbours) {
            polytope.add_plane(half_space);
        }
    }
    if !polytope.is_bounded() {
        for (axis, direction) in DVec3::AXES.into_iter().enumerate() {
            let sides = [(direction, high[axis]), (-direction, -low[axis])];
            for half_space in sides.into_iter().filter_map(|(normal, offset)| HalfSpace::new(normal, offset).ok()) {
                polytope.add_plane(half_space);
            }
        }
    }
    debug_assert!(!polytope.is_empty(), "the hull of points that span space has an interior");
    Ok(polytope)
}

/// The boundary of the convex hull of points as triangles, each three numbers of points, counter-clockwise seen from outside.
///
/// The combinatorics are decided exactly: the triangles close, each corner is a point that no plane of three others cuts off, and no
/// point lies outside of a triangle's plane. Facets with more than three corners are cut into coplanar triangles. Points within a facet or an
/// edge may be corners or not.
///
/// Where only coordinates are needed this is several times faster than [`hull`], which makes exact planes of the facets.
///
/// # Errors
/// As [`hull`].
///
/// ```
/// use planecut_kernel::{HullError, hull_triangles};
///
/// # fn main() -> Result<(), HullError> {
/// let corners: Vec<[f64; 3]> = (0..8).map(|k| [k & 1, k >> 1 & 1, k >> 2].map(f64::from)).collect();
/// assert_eq!(hull_triangles(&corners)?.len(), 12);
/// # Ok(())
/// # }
/// ```
pub fn hull_triangles<P: Into<DVec3> + Copy>(points: &[P]) -> Result<Vec<[u32; 3]>, HullError> {
    let points = vectors(points);
    check_range(&points)?;
    Ok(Triangulation::of(&points)?.triangles().collect())
}

/// Triangles as [`hull_triangles`] has them, in floating point: points may stick out by the tolerance, about, or where facets are thinner than rounding by more. The triangles close all the
/// same. Several times faster, above all where many points lie on a plane, for volumes and other measures.
///
/// # Errors
/// As [`hull`].
///
/// ```
/// use planecut_kernel::{HullError, approximate_hull_triangles};
///
/// # fn main() -> Result<(), HullError> {
/// let corners: Vec<[f64; 3]> = (0..8).map(|k| [k & 1, k >> 1 & 1, k >> 2].map(f64::from)).collect();
/// assert_eq!(approximate_hull_triangles(&corners, 1e-9)?.len(), 12);
/// # Ok(())
/// # }
/// ```
pub fn approximate_hull_triangles<P: Into<DVec3> + Copy>(
    points: &[P],
    tolerance: f64,
) -> Result<Vec<[u32; 3]>, HullError> {
    let points = vectors(points);
    check_range(&points)?;
    let hull = match Triangulation::within(&points, tolerance)? {
        Some(hull) => hull,
        None => Triangulation::of(&points)?,
    };
    Ok(hull.triangles().collect())
}

fn vectors<P: Into<DVec3> + Copy>(points: &[P]) -> Vec<DVec3> {
    points.iter().map(|point| (*point).into()).collect()
}

/// In rounds that double, each in the order given: a random half of all last, a random half of the others before that, and so
/// on (Amenta, Choi, Rote 2003). Neighbours stay near each other, but no order of the facets makes every plane cut a large
/// part of what is there away.
fn in_random_rounds(mut facets: Vec<u32>) -> Vec<u32> {
    // the finalizer of splitmix64 (Steele, Lea, Flood 2014)
    let random = |facet: u32| {
        let z = (u64::from(facet) + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        let z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    };
    facets.sort_by_cached_key(|facet| std::cmp::Reverse(random(*facet).trailing_zeros()));
    facets
}

fn check_range(points: &[DVec3]) -> Result<(), HullError> {
    let fits = |v: f64| v == 0.0 || (MAX_COORDINATE.recip()..=MAX_COORDINATE).contains(&v.abs());
    for (index, &point) in points.iter().enumerate() {
        if !point.is_finite() {
            return Err(HullError::NotFinite { index, point });
        }
        if !point.to_array().into_iter().all(fits) {
            return Err(HullError::OutOfRange { index, point });
        }
    }
    Ok(())
}

fn bounds(points: &[DVec3]) -> (DVec3, DVec3) {
    points.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(*p), high.max(*p)))
}
