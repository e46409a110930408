//! Cells within surfaces that are closed by something else, such as the ends of a slab.

use planecut_kernel::{DVec3, HalfSpace};

use super::cells::cells_of;
use super::part::{Part, Piece, PlaneSide, Points};
use super::planes::FloatPlane;
use super::precision::Precision;
use super::surface::merged;

/// Convex cells that together are what a surface of convex facets bounds, each as facets and whether the cell is on the side of
/// the facet's plane where the facet's solid is not. `half_spaces` are those of the facets, the solid below them.
///
/// Edges that only one facet has end the surface; what else bounds the solid there, the caller adds to each cell. `None` where
/// there are more than [`MAX_CELLS`](super::MAX_CELLS).
pub(crate) fn cells_within(
    points: &[DVec3],
    facets: &[Vec<u32>],
    half_spaces: &[HalfSpace],
) -> Option<Vec<Vec<(u32, bool)>>> {
    let float_planes: Vec<FloatPlane> = half_spaces.iter().map(FloatPlane::of).collect();
    let (points, number) = merged(points);
    let piece = |(facet, corners): (u32, &Vec<u32>)| Piece {
        plane: facet,
        is_reversed: false,
        facet,
        corners: corners.iter().map(|corner| number[*corner as usize]).collect(),
    };
    let whole = Part { walls: Vec::new(), pieces: (0..).zip(facets).map(piece).collect() };
    let slack = Precision::Double.slack(&points);
    let points = Points::new(points, slack, &float_planes, false);
    let side = |side: PlaneSide| (side.plane, side.is_above);
    let cells = cells_of(whole, points)?;
    Some(cells.into_iter().map(|cell| cell.into_iter().map(side).collect()).collect())
}
