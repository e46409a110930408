//! Solids from closed surfaces of facets, as convex cells.
//!
//! - `joining` makes corners one that differ by rounding, where the surface is open without that.
//! - `surface` merges points by position, checks that the surface is closed and pairs its triangles (`pairing`) along
//!   edges; `polygon` cuts facets into triangles.
//! - `planes` finds one plane for facets that were meant to lie on one, as exactly as corners are known (`precision`).
//! - `cells` cuts space along planes of facets (`choice` says which) until what is left in each `part` is convex
//!   (`edges`, `lumps`); `sides` does the same for surfaces that are closed by the ends of a slab.
//! - `body` makes a surface one leaf of a tree, a convex body (`convexity`) or a closed mesh; `convex_tree` cuts such meshes into cells.
//! - `winding` cuts space along all facets of a surface that crosses itself, and keeps what that winds around.
//!
//! The sum of the cells' volumes must be the volume that the facets enclose, by the divergence theorem; a surface for which it
//! is not has no inside.

mod body;
mod cells;
mod choice;
mod convex_tree;
mod convexity;
mod edges;
mod error;
pub(crate) mod exact;
mod joining;
mod lumps;
mod pairing;
mod part;
mod planes;
mod polygon;
mod precision;
mod sides;
mod surface;
mod winding;

use planecut_cells::joined;
use planecut_check::{CheckOptions, ContactKind, check_mesh};
use planecut_csg::stages::DisjointSets;
use planecut_csg::{Brush, MaterialId, Tree};
use planecut_kernel::DVec3;

pub use body::{MAX_CONVEX_TRIANGLES, SurfaceBody, SurfaceOptions, surface_body, surface_mesh};
pub use convex_tree::{ConvexTreeError, convex_tree};
pub use error::PolyhedronError;
pub use joining::join_near;
pub use polygon::{MAX_CONCAVE_CORNERS, triangulate};
pub use precision::Precision;
pub(crate) use sides::cells_within;
pub use winding::{MAX_CROSSING_TRIANGLES, polyhedron_by_winding};

use crate::tolerances::{GOOD_VOLUME, LESS_SLACK};
use joining::closed_surface;
use planes::Planes;
use surface::Surface;

/// Most convex cells of a surface.
pub const MAX_CELLS: u64 = 4_194_304;

/// How a surface is taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PolyhedronOptions {
    /// How exactly corners are known.
    pub precision: Precision,
}

impl Default for PolyhedronOptions {
    /// Corners computed in `f64`.
    fn default() -> Self {
        Self { precision: Precision::Double }
    }
}

/// The solid within a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Polyhedron {
    /// Convex cells that touch each other; one where the solid is convex.
    pub cells: Vec<Brush>,
    /// The volume within the facets, by the divergence theorem.
    pub volume: f64,
    /// Whether all facets were turned over: they were clockwise seen from outside.
    pub is_turned: bool,
    /// Whether there are several sheets of the surface at an edge or a corner.
    pub touches_itself: bool,
    /// How many facets were cut into triangles as their corners lie on no plane.
    pub bent_facets: usize,
    /// How many places of corners went because the surface was not closed without joining them to others, as near as rounding.
    pub joined_corners: usize,
}

impl From<Polyhedron> for Tree {
    fn from(polyhedron: Polyhedron) -> Self {
        Self::union_of(polyhedron.cells)
    }
}

/// The solid within a closed surface, as convex cells whose common walls are the same plane seen from both sides.
///
/// `facets` hold the numbers of their corners in `points`, counter-clockwise seen from outside; all may be clockwise instead.
/// They may have any number of corners and need not be convex. A facet whose corners lie on no plane, as exactly as they are
/// known ([`Precision`]), is cut into triangles. Points at the same position are one; where the surface is not closed with
/// that, also those that differ only by rounding ([`JOINED_CORNERS`](crate::tolerances::JOINED_CORNERS)). There may be several shells, and
/// shells of cavities with their facets seen from the cavity counter-clockwise; they may touch each other in edges and
/// corners. Faces have the material of their facet: `materials` holds one for each facet, or one for all. Where facets of
/// several materials lie side by side on one plane of a cell, the widest decides.
///
/// A convex solid is one cell with one face for each plane.
///
/// # Errors
/// [`PolyhedronError`] where the surface is not closed, crosses itself, or encloses nothing.
///
/// ```
/// use planecut_shapes::polyhedron::{PolyhedronError, PolyhedronOptions, polyhedron};
/// use planecut_csg::{MaterialId, Model, Material, Tree, evaluate};
/// use planecut_kernel::DVec3;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let points: Vec<DVec3> = (0..8).map(|k| DVec3::new((k % 2) as f64, (k / 2 % 2) as f64, (k / 4) as f64)).collect();
/// let mut facets: Vec<Vec<u32>> =
///     vec![vec![0, 2, 3, 1], vec![4, 5, 7, 6], vec![0, 1, 5, 4], vec![2, 6, 7, 3], vec![0, 4, 6, 2], vec![1, 3, 7, 5]];
/// let cube = polyhedron(&points, &facets, &[MaterialId(0)], &PolyhedronOptions::default())?;
/// assert_eq!((cube.cells.len(), cube.cells[0].faces.len(), cube.volume), (1, 6, 1.0));
/// facets.pop();
/// let open = polyhedron(&points, &facets, &[MaterialId(0)], &PolyhedronOptions::default());
/// assert!(matches!(open, Err(PolyhedronError::Open { edges: 4, .. })));
/// # Ok(())
/// # }
/// ```
pub fn polyhedron<F: AsRef<[u32]>>(
    points: &[DVec3],
    facets: &[F],
    materials: &[MaterialId],
    options: &PolyhedronOptions,
) -> Result<Polyhedron, PolyhedronError> {
    let material_of = material_of_facet(materials, facets.len())?;
    let (mut surface, joined_corners) = closed_surface(points, facets, options.precision)?;
    check_crossings(&surface)?;
    let mut best = solid(&surface, material_of);
    for _ in 0..MORE_TRIALS {
        if best.as_ref().map_or_else(is_final, |(_, off)| *off <= GOOD_VOLUME * surface.volume_slack()) {
            break;
        }
        surface.slack.iter_mut().for_each(|slack| *slack *= LESS_SLACK);
        if let Ok((solid, off)) = solid(&surface, material_of)
            && best.as_ref().map_or(true, |(_, least)| off < *least)
        {
            best = Ok((solid, off));
        }
    }
    best.map(|(solid, _)| Polyhedron { joined_corners, ..solid })
}

/// The material of each facet: one is given for each, or one for all.
fn material_of_facet(
    materials: &[MaterialId],
    facets: usize,
) -> Result<impl Fn(u32) -> MaterialId + Copy + '_, PolyhedronError> {
    if materials.len() != 1 && materials.len() != facets {
        return Err(PolyhedronError::Materials { found: materials.len(), facets });
    }
    Ok(move |facet: u32| if let [all] = materials { *all } else { materials[facet as usize] })
}

/// Whether less tolerance would not help.
fn is_final(error: &PolyhedronError) -> bool {
    !matches!(error, PolyhedronError::Inconsistent { .. })
}

const MORE_TRIALS: usize = 2;
/// The solid, and by how much the volume of its cells is off.
fn solid(
    surface: &Surface,
    material_of: impl Fn(u32) -> MaterialId + Copy,
) -> Result<(Polyhedron, f64), PolyhedronError> {
    let planes = Planes::of(surface)?;
    let cells = cells::cells(surface, &planes)?;
    let bodies: Vec<(Brush, f64)> =
        cells.iter().filter_map(|sides| cells::brush(sides, &planes, material_of)).collect();
    let (enclosed, found) = (surface.volume(), cells::volume(&bodies));
    let off = (enclosed - found).abs();
    if !(found.is_finite() && off <= surface.volume_slack()) {
        return Err(PolyhedronError::Inconsistent { enclosed, cells: found });
    }
    let brushes: Vec<Brush> = bodies.into_iter().map(|(brush, _)| brush).collect();
    let solid = Polyhedron {
        cells: if brushes.len() > 1 { joined(&brushes) } else { brushes },
        volume: enclosed,
        is_turned: surface.is_turned,
        touches_itself: surface.touches_itself,
        bent_facets: planes.bent_facets,
        joined_corners: 0,
    };
    Ok((solid, off))
}

/// Whether triangles that overlap in one plane belong to one surface: a concave face that its program has cut into a fan overlaps itself,
/// and is the same polygon all the same.
fn are_connected(surface: &Surface, [a, b]: [usize; 2]) -> bool {
    let mut sets = DisjointSets::new(surface.points.len());
    for &[p, q, r] in &surface.triangles {
        sets.join(p, q);
        sets.join(p, r);
    }
    sets.root(surface.triangles[a][0]) == sets.root(surface.triangles[b][0])
}

fn check_crossings(surface: &Surface) -> Result<(), PolyhedronError> {
    let size = surface.points.iter().map(|p| p.abs().max_element()).fold(f64::MIN_POSITIVE, f64::max);
    let slack = surface.slack.iter().copied().fold(0.0, f64::max);
    let options = CheckOptions { tolerance: 2.0 * slack / size, crossings: true };
    let report = check_mesh(&surface.points, &surface.triangles, &options);
    let Some(contact) = report.crossings.and_then(|crossings| crossings.first) else { return Ok(()) };
    let normals = contact.triangles.map(|t| polygon::area_vector(&surface.corners(t)));
    let is_thin = || normals[0].dot(normals[1]) < 0.0;
    if contact.kind == ContactKind::Overlap && (is_thin() || are_connected(surface, contact.triangles)) {
        return Ok(());
    }
    let mut facets = contact.triangles.map(|t| surface.facet_of[t] as usize);
    facets.sort_unstable();
    let position = contact.triangles.map(|t| surface.corners(t).iter().sum::<DVec3>() / 3.0);
    Err(PolyhedronError::Crossing { facets, kind: contact.kind, position: 0.5 * (position[0] + position[1]) })
}
