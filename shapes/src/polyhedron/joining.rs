//! Corners that differ only by rounding, made one where the surface is not closed without that.

use planecut_kernel::DVec3;
use rustc_hash::FxHashMap;

use super::error::PolyhedronError;
use super::precision::Precision;
use super::surface::Surface;
use crate::tolerances::JOINED_CORNERS;

/// The least width of cells, relative to the largest coordinate.
const LEAST_WIDTH: f64 = 1.0 / (1u64 << 60) as f64;

/// The surface, closed by corners at the very same place or else by corners that are nearly there, as near as will do; and how many
/// places went for that.
///
/// # Errors
/// As [`Surface::new`] of the corners as they are.
pub(super) fn closed_surface<F: AsRef<[u32]>>(
    points: &[DVec3],
    facets: &[F],
    precision: Precision,
) -> Result<(Surface, usize), PolyhedronError> {
    let error = match Surface::new(points, facets, precision) {
        Err(error @ PolyhedronError::Open { .. }) => error,
        result => return result.map(|surface| (surface, 0)),
    };
    let closed = joining_distances(points, precision).find_map(|distance| {
        let (points, joined) = join_near(points, distance);
        let surface = if joined > 0 { Surface::new(&points, facets, precision).ok() } else { None };
        surface.map(|surface| (surface, joined))
    });
    closed.ok_or(error)
}

/// How near corners are that count as one where a surface is open otherwise, the smallest distance first.
pub(super) fn joining_distances(points: &[DVec3], precision: Precision) -> impl Iterator<Item = f64> {
    let size = points.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    let distances = [JOINED_CORNERS * size, precision.between_neighbours(points)];
    distances.into_iter().filter(|distance| *distance > 0.0)
}

/// Points moved to the nearest earlier one that no coordinate is farther from than `distance`, and how many places went. No point is moved
/// farther, so rows of near points do not run together. Linear but for places that are crowded at this distance.
///
/// ```
/// use planecut_kernel::DVec3;
/// use planecut_shapes::polyhedron::join_near;
///
/// let (points, gone) = join_near(&[0.0, 0.75, 1.5, 9.0].map(|x| DVec3::new(x, 5.0, -7.0)), 1.0);
/// assert_eq!((points[1].x, points[2].x, points[3].x, gone), (0.0, 1.5, 9.0, 1));
/// ```
///
/// # Panics
/// Where the distance is not above zero.
#[must_use]
pub fn join_near(points: &[DVec3], distance: f64) -> (Vec<DVec3>, usize) {
    assert!(distance > 0.0, "found a distance of {distance}, expected one above zero");
    // so wide that the numbers of cells are whole numbers
    let size = points.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    let width = distance.max(size * LEAST_WIDTH);
    let mut firsts: FxHashMap<[i64; 3], Vec<DVec3>> = FxHashMap::default();
    let mut left = FxHashMap::default();
    let joined: Vec<DVec3> = points
        .iter()
        .map(|point| {
            let point = *point + DVec3::ZERO;
            let cell = (point / width).floor().to_array().map(|v| v as i64);
            let place = near(&firsts, cell, point, distance).unwrap_or_else(|| {
                firsts.entry(cell).or_default().push(point);
                point
            });
            left.insert(point.to_array().map(f64::to_bits), place != point);
            place
        })
        .collect();
    (joined, left.into_values().filter(|is_gone| *is_gone).count())
}

/// A first point near another one: the nearest.
fn near(firsts: &FxHashMap<[i64; 3], Vec<DVec3>>, cell: [i64; 3], point: DVec3, distance: f64) -> Option<DVec3> {
    let around = (0..27).map(|k| [cell[0] + k % 3 - 1, cell[1] + k / 3 % 3 - 1, cell[2] + k / 9 - 1]);
    let off = |first: &DVec3| (*first - point).abs().max_element();
    let candidates = around.filter_map(|cell| firsts.get(&cell)).flatten().copied();
    candidates.filter(|first| off(first) <= distance).min_by(|a, b| off(a).total_cmp(&off(b)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_move_no_farther_than_the_distance() {
        let points = [0.0, 0.75, 1.5, 9.0, -0.5].map(|x| DVec3::new(x, 5.0, -7.0));
        let (moved, gone) = join_near(&points, 1.0);
        assert_eq!(moved.iter().map(|p| p.x).collect::<Vec<_>>(), [0.0, 0.0, 1.5, 9.0, 0.0]);
        assert_eq!(gone, 2);
        assert_eq!(join_near(&points, 0.1).1, 0);
        assert_eq!(join_near(&points, f64::MIN_POSITIVE).1, 0);
    }
}
