//! From a surface to convex cells.

use planecut_csg::stages::CompensatedSum;
use planecut_csg::{Brush, BrushFace, MaterialId};
use planecut_kernel::{HalfSpace, IncrementalPolytope};

use super::MAX_CELLS;
use super::choice::best_cut;
use super::edges::Edges;
use super::error::PolyhedronError;
use super::lumps::take_convex;
use super::part::{Part, PlaneSide, Points};
use super::planes::Planes;
use super::surface::Surface;

/// The convex cells within a surface, each as sides of its planes.
///
/// A part of space that is not convex is cut along the plane of a facet, so no plane is made that the surface does not have,
/// and all of the part is cut: each point is in one cell, however planes are rounded, so there are no gaps between cells.
pub(super) fn cells(surface: &Surface, planes: &Planes) -> Result<Vec<Vec<PlaneSide>>, PolyhedronError> {
    let points = Points::new(surface.points.clone(), planes.slack(surface), &planes.float_planes, true);
    cells_of(Part::whole(surface, planes), points).ok_or(PolyhedronError::TooLarge { limit: MAX_CELLS as usize })
}

/// The convex cells within the pieces of a part; `None` where there are more than [`MAX_CELLS`].
pub(super) fn cells_of(whole: Part, mut points: Points<'_>) -> Option<Vec<Vec<PlaneSide>>> {
    let mut waiting = vec![whole];
    let mut done = Vec::new();
    while let Some(mut part) = waiting.pop() {
        if part.pieces.is_empty() {
            done.push(part.walls);
            continue;
        }
        let mut edges = Edges::of(&part, &points);
        if part.drop_slivers(&edges, &points) {
            edges = Edges::of(&part, &points);
        }
        let lumps = take_convex(&mut part, &edges, &points);
        let found_some = !lumps.is_empty();
        done.extend(lumps);
        if done.len() + waiting.len() > MAX_CELLS as usize {
            return None;
        }
        if part.pieces.is_empty() {
            continue;
        }
        let edges = if found_some { Edges::of(&part, &points) } else { edges };
        // sheets that cannot be cut enclose nothing
        if let Some(plane) = best_cut(&part, &edges, &points) {
            waiting.extend(part.cut(&mut points, plane).into_iter().flatten());
        }
    }
    Some(done)
}

/// The body on the given sides of planes and its volume, without planes that have no face; `None` where nothing is left of it.
pub(super) fn brush(
    sides: &[PlaneSide],
    planes: &Planes,
    material_of: impl Fn(u32) -> MaterialId,
) -> Option<(Brush, f64)> {
    // walls between cells dissolve, so any material will do
    let inner = sides.iter().find_map(|side| side.facet).map_or(MaterialId(0), &material_of);
    let half_space = |side: &PlaneSide| -> HalfSpace {
        let plane = planes.half_spaces[side.plane as usize];
        if side.is_above { plane.flipped() } else { plane }
    };
    let mut polytope = IncrementalPolytope::with_epsilon(0.0);
    let mut materials = Vec::with_capacity(sides.len());
    for side in sides {
        let handle = polytope.add_plane(half_space(side)).plane();
        if materials.len() <= handle.0 {
            materials.resize(handle.0 + 1, inner);
        }
        materials[handle.0] = side.facet.map_or(inner, &material_of);
    }
    if polytope.is_empty() {
        return None;
    }
    let face = |(plane, _): (planecut_kernel::PlaneIdx, _)| {
        polytope.plane(plane).map(|half_space| BrushFace { half_space: *half_space, material: materials[plane.0] })
    };
    let faces: Vec<BrushFace> = polytope.facets().into_iter().filter_map(face).collect();
    let volume = polytope.measures().map_or(f64::INFINITY, |measures| measures.volume);
    Some((Brush { faces, ..Brush::default() }, volume))
}

/// The sum of volumes; infinite where a body is not bounded.
pub(super) fn volume(bodies: &[(Brush, f64)]) -> f64 {
    if bodies.iter().any(|(_, volume)| volume.is_infinite()) {
        return f64::INFINITY;
    }
    let mut sum = CompensatedSum::default();
    bodies.iter().for_each(|(_, volume)| sum.add(*volume));
    sum.value()
}
