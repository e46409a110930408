//! The solid of a surface that crosses itself: where its winding number is above zero.
//!
//! Space is cut along planes of facets until no facet passes through any part of it. Within a part the winding number of the surface is
//! then one integer; at some place in it, it is the sum of the solid angles of all triangles (van Oosterom and Strackee, 1983).

use std::f64::consts::PI;

use planecut_cells::joined;
use planecut_csg::stages::CompensatedSum;
use planecut_csg::{Brush, MaterialId};
use planecut_kernel::DVec3;

use super::cells;
use super::error::PolyhedronError;
use super::joining::closed_surface;
use super::part::{Part, PlaneSide, Points};
use super::planes::Planes;
use super::surface::Surface;
use super::{Polyhedron, PolyhedronOptions, material_of_facet};

/// Most triangles of a surface that is cut so.
pub const MAX_CROSSING_TRIANGLES: usize = 4096;
/// Most parts that space falls into.
const MAX_PARTS: usize = 1 << 17;
/// How many planes are tried for each cut.
const CANDIDATES: usize = 12;
/// What it costs to cut a piece in two, beside a piece more on one side than on the other.
const CUT_PIECE: usize = 3;
/// How far a sum of solid angles may be from an integer.
const WINDING_ROUNDING: f64 = 0.05;

/// The solid within a closed surface that may cross itself: all places around which the surface winds more than zero times, counted positive
/// in the sense in which the surface as a whole encloses a positive volume.
///
/// Arguments are those of [`polyhedron`](super::polyhedron), which is faster, and right where the surface does not cross itself.
///
/// # Errors
/// [`PolyhedronError`] where the surface is not closed, encloses nothing, has more than [`MAX_CROSSING_TRIANGLES`] triangles, or where the volumes of
/// all parts, each times its winding number, are not what the facets enclose by the divergence theorem.
pub fn polyhedron_by_winding<F: AsRef<[u32]>>(
    points: &[DVec3],
    facets: &[F],
    materials: &[MaterialId],
    options: &PolyhedronOptions,
) -> Result<Polyhedron, PolyhedronError> {
    let material_of = material_of_facet(materials, facets.len())?;
    let (surface, joined_corners) = closed_surface(points, facets, options.precision)?;
    if surface.triangles.len() > MAX_CROSSING_TRIANGLES {
        return Err(PolyhedronError::TooLarge { limit: MAX_CROSSING_TRIANGLES });
    }
    let planes = Planes::of(&surface)?;
    let wound = wound_parts(&surface, &planes, material_of)?;
    let (enclosed, found) = (surface.volume(), sum(wound.iter().map(|part| part.winding as f64 * part.volume)));
    if !(found.is_finite() && (enclosed - found).abs() <= surface.volume_slack()) {
        return Err(PolyhedronError::Inconsistent { enclosed, cells: found });
    }
    let kept: Vec<Wound> = wound.into_iter().filter(|part| part.winding > 0).collect();
    let volume = sum(kept.iter().map(|part| part.volume));
    let brushes: Vec<Brush> = kept.into_iter().map(|part| part.brush).collect();
    Ok(Polyhedron {
        cells: joined(&brushes),
        volume,
        is_turned: surface.is_turned,
        touches_itself: surface.touches_itself,
        bent_facets: planes.bent_facets,
        joined_corners,
    })
}

/// A part of space that no facet passes through.
struct Wound {
    brush: Brush,
    volume: f64,
    /// How often the surface winds around it; not zero.
    winding: i32,
}

fn sum(values: impl Iterator<Item = f64>) -> f64 {
    let mut sum = CompensatedSum::default();
    values.for_each(|value| sum.add(value));
    sum.value()
}

/// The parts that the surface winds around.
fn wound_parts(
    surface: &Surface,
    planes: &Planes,
    material_of: impl Fn(u32) -> MaterialId + Copy,
) -> Result<Vec<Wound>, PolyhedronError> {
    let mut wound = Vec::new();
    for walls in empty_parts(surface, planes)? {
        let Some((brush, volume)) = cells::brush(&walls, planes, material_of) else { continue };
        // nothing winds around what has no end
        if volume.is_infinite() {
            continue;
        }
        match winding_number(surface, inside(&brush)) {
            Some(0) => {}
            Some(winding) => wound.push(Wound { brush, volume, winding }),
            // at a place of noise beside the surface
            None if volume <= surface.volume_slack() => {}
            None => return Err(PolyhedronError::Inconsistent { enclosed: surface.volume(), cells: f64::NAN }),
        }
    }
    Ok(wound)
}

/// Parts of space with no piece of the surface within them, as sides of planes.
fn empty_parts(surface: &Surface, planes: &Planes) -> Result<Vec<Vec<PlaneSide>>, PolyhedronError> {
    let slack = planes.slack(surface);
    let mut points = Points::new(surface.points.clone(), slack, &planes.float_planes, true);
    let mut waiting = vec![Part::whole(surface, planes)];
    let mut done = Vec::new();
    while let Some(part) = waiting.pop() {
        if part.pieces.is_empty() {
            done.push(part.walls);
        } else {
            let plane = best_plane(&part, &points);
            waiting.extend(part.halves(&mut points, plane));
        }
        if done.len() + waiting.len() > MAX_PARTS {
            return Err(PolyhedronError::TooLarge { limit: MAX_PARTS });
        }
    }
    Ok(done)
}

/// Of some planes the one that cuts few pieces and leaves as many on one side as on the other.
fn best_plane(part: &Part, points: &Points<'_>) -> u32 {
    let step = part.pieces.len().div_ceil(CANDIDATES);
    let cost = |plane: u32| {
        let (mut below, mut above, mut cut) = (0_usize, 0_usize, 0_usize);
        for piece in part.pieces.iter().filter(|piece| piece.plane != plane) {
            let is_on = |side| piece.corners.iter().any(|corner| points.side(*corner, plane) == side);
            let (low, high) = (is_on(std::cmp::Ordering::Less), is_on(std::cmp::Ordering::Greater));
            below += usize::from(low);
            above += usize::from(high);
            cut += usize::from(low && high);
        }
        CUT_PIECE * cut + below.abs_diff(above)
    };
    let planes = part.pieces.iter().step_by(step).map(|piece| piece.plane);
    planes.min_by_key(|plane| (cost(*plane), *plane)).unwrap_or(part.pieces[0].plane)
}

/// A place within a bounded body that has an interior: amid its corners.
fn inside(brush: &Brush) -> DVec3 {
    let mut polytope = planecut_kernel::IncrementalPolytope::with_epsilon(0.0);
    brush.faces.iter().for_each(|face| {
        polytope.add_plane(face.half_space);
    });
    polytope.measures().map_or(DVec3::NAN, |measures| measures.centroid)
}

/// How often a surface winds around a place; `None` where that is no integer, as it is on the surface.
fn winding_number(surface: &Surface, place: DVec3) -> Option<i32> {
    let angles = (0..surface.triangles.len()).map(|t| half_solid_angle(surface.corners(t).map(|p| p - place)));
    let winding = sum(angles) / (2.0 * PI);
    ((winding - winding.round()).abs() <= WINDING_ROUNDING).then_some(winding.round() as i32)
}

/// Half of the solid angle of a triangle seen from the origin, positive where it is seen from inside.
fn half_solid_angle([a, b, c]: [DVec3; 3]) -> f64 {
    let (x, y, z) = (a.length(), b.length(), c.length());
    let scale = x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y;
    a.dot(b.cross(c)).atan2(scale)
}
