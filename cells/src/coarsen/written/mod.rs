//! Cells as a file holds them: the hull of vertices that the file's numbers can say, which holds the cell.
//!
//! - [`corners`]: the corners of a cell, and points with exact coordinates whose hull holds it.
//! - [`merge`]: corners that are nearly one become one.
//! - [`grow`]: corners moved outward.
//! - [`near`]: which of many points are near one.
//!
//! **Why the written cell holds the cell.** Let `h(n)` be how far a body reaches in a direction `n` of unit length. Let a cell's corners be `v`, each at
//! most `e` from the vertex that is written for it (merging and rounding together), but each of these first moved by `g·m`, where `n·m ≥ 1` for
//! every unit normal `n` of a face at the corner. The direction in which a corner is the farthest is a sum of such normals with factors that are not
//! negative, and since it has unit length, these add up to 1 at least: so `m` reaches 1 in it. The hull of what is written thus
//! reaches `h(n) + g − e` at least, in all directions, and holds the cell where `g ≥ e`. The same is true where a corner becomes the eight corners
//! of a cube of side `2·g` around it, which is done where faces meet so sharply that `m` would be long.
//!
//! That says how far to go, and that it ends. It is not what is relied on: the hull of what is written and of the points around the cell is computed
//! with exact signs, and taken only if none of its corners is one of the latter.

mod corners;
mod grow;
mod merge;
mod near;

use planecut_csg::stages::Bounds;
use planecut_csg::{Brush, Material, MaterialId, Mesh, MeshFace};
use planecut_kernel::{DVec3, hull_triangles};
use planecut_parallel::prelude::*;

use super::CoarsenError;
use super::part::{Part, bounds_of};
use crate::tolerances::{MOST_WRITTEN_SEPARATION, SAME_FACE, WRITTEN_SEPARATION, WRITTEN_SEPARATION_OF_ALL};
use corners::Corners;
use grow::{Shape, grown};
use merge::{Clusters, distinct};
use near::Near;

/// How often the growth is doubled before a cell is refused: from one rounding to beyond the accepted range of coordinates.
const MOST_GROWTHS: usize = 200;

/// Distance between unit normals within which a face is looked for first.
const NEARLY: f64 = 0.01;

/// How often sharp corners are moved twice as far before the cell becomes its box.
const MOST_SHARP: u32 = 32;

/// What the vertices of written cells must fulfil.
pub struct Writing<'a> {
    /// Factor from the units of the cells to those of the positions.
    pub scale: f64,
    /// No more vertices than this, at least 8: a cell that is too sharp for so few becomes its box.
    pub max_vertices: usize,
    /// Whether the written cells hold the cells. Otherwise vertices are rounded to the nearest, as cells within a solid want it.
    pub encloses: bool,
    /// Whether vertices keep a distance from each other that readers in single precision need; `docs/tolerances.md` says which.
    pub is_separated: bool,
    /// Where a reader finds the positions of a mesh. What it returns must be stored as it is, also without some of its points.
    pub stored: &'a (dyn Fn(&[DVec3]) -> Vec<DVec3> + Sync),
}

/// The meshes that are written for convex cells, each closed, convex by exact signs of its own positions, and around its cell.
///
/// Every position is a corner of the hull of all of its mesh, up to coplanar ones, and each triangle belongs to the face that it lies along. No two positions
/// are nearer to each other than `WRITTEN_SEPARATION` of the size of their cell (`docs/tolerances.md`), where that is asked for. A cell of which rounding to the nearest leaves no body,
/// where nothing is to be enclosed, has no triangles.
///
/// # Errors
/// [`CoarsenError::OutOfRange`] for positions that the file cannot say, [`CoarsenError::Unbounded`] for a cell without end.
pub fn written_meshes(
    cells: &[Brush],
    materials: &[Material],
    writing: &Writing<'_>,
) -> Result<Vec<Mesh>, CoarsenError> {
    let parts: Vec<Option<Part>> = cells.par_iter().map(Part::of_brush).collect::<Result<_, _>>()?;
    let bounds = parts.iter().flatten().fold(Bounds::EMPTY, |all, part| Bounds {
        min: all.min.min(part.bounds.min),
        max: all.max.max(part.bounds.max),
    });
    let size = extent(&bounds);
    let mesh = |part: &Option<Part>| match part {
        Some(part) => {
            let separation = if writing.is_separated { separation(part, size) * writing.scale } else { 0.0 };
            written_mesh(part, materials, writing, separation)
        }
        None => Ok(Mesh::default()),
    };
    parts.par_iter().map(mesh).collect()
}

/// How far the vertices of a cell stay from each other, among cells of some size together.
fn separation(part: &Part, size: f64) -> f64 {
    let own = extent(&part.bounds);
    (WRITTEN_SEPARATION * own).max((WRITTEN_SEPARATION_OF_ALL * size).min(MOST_WRITTEN_SEPARATION * own))
}

fn extent(bounds: &Bounds) -> f64 {
    (bounds.max - bounds.min).max_element().max(0.0)
}

fn written_mesh(
    part: &Part,
    materials: &[Material],
    writing: &Writing<'_>,
    separation: f64,
) -> Result<Mesh, CoarsenError> {
    let corners = Corners::of(part, writing.scale);
    let (positions, triangles) = if writing.encloses {
        enclosing(&corners, writing, separation).ok_or(CoarsenError::OutOfRange)?
    } else {
        around(&distinct(&(writing.stored)(&corners.places()), separation), &[]).unwrap_or_default()
    };
    Ok(with_faces(positions, triangles, &corners.normals, part.material, materials))
}

/// Positions and the triangles of their hull.
type Surface = (Vec<DVec3>, Vec<[u32; 3]>);

/// The hull of stored positions that holds a cell, grown as little as powers of two allow.
fn enclosing(corners: &Corners, writing: &Writing<'_>, separation: f64) -> Option<Surface> {
    let clusters = Clusters::of(corners, separation);
    let stored = |places: &[DVec3]| distinct(&(writing.stored)(places), separation);
    let nearest = (writing.stored)(&clusters.places(corners));
    let first = 2.0 * clusters.largest_move(corners, &nearest).max(corners.rounding());
    let (mut growth, mut shape, mut sharp) = (0.0, Shape::Rounded, 0);
    for _ in 0..MOST_GROWTHS {
        let positions = stored(&grown(corners, &clusters, growth, separation, shape));
        sharp += u32::from(shape == Shape::Sharp);
        match around(&positions, &corners.holding) {
            Some(surface) if surface.0.len() <= writing.max_vertices => {
                let is_far = shape == Shape::Sharp && !is_within_reach(&surface.0, &corners.holding);
                if !is_far {
                    return Some(surface);
                }
                // sharp corners that are moved so far add more than the box does
                (growth, shape) = (first, Shape::Box);
            }
            // enclosed, but with more vertices than it may have
            Some(_) if shape != Shape::Box => shape = shape.with_fewer_vertices(),
            // a corner of opposite faces can be moved as far as one likes
            None if sharp > MOST_SHARP => (growth, shape, sharp) = (first, Shape::Box, 0),
            _ => growth = if growth == 0.0 { first } else { 2.0 * growth },
        }
    }
    None
}

/// Whether positions lie within the box around points, as wide again on all sides.
fn is_within_reach(positions: &[DVec3], held: &[DVec3]) -> bool {
    let (own, held) = (bounds_of(positions), bounds_of(held));
    let size = held.max - held.min;
    own.min.cmpge(held.min - size).all() && own.max.cmple(held.max + size).all()
}

/// The hull of positions, where it has an interior and its corners hold some more points; positions that it does not need are left out.
fn around(positions: &[DVec3], held: &[DVec3]) -> Option<Surface> {
    let all: Vec<DVec3> = positions.iter().chain(held).copied().collect();
    let mut triangles = hull_triangles(&all).ok()?;
    let mut numbers = vec![None; all.len()];
    let mut used = Vec::new();
    // a point that lies just where a position is stands for it
    let own = |corner: u32| {
        if (corner as usize) < positions.len() { Some(corner as usize) } else { equal(positions, all[corner as usize]) }
    };
    for corner in triangles.iter_mut().flatten() {
        let place = own(*corner)?;
        *corner = *numbers[place].get_or_insert_with(|| {
            used.push(positions[place]);
            used.len() as u32 - 1
        });
    }
    Some((used, triangles))
}

fn equal(positions: &[DVec3], point: DVec3) -> Option<usize> {
    positions.iter().position(|position| *position == point)
}

/// Triangles with the faces of the cell that they lie along; one that lies along none is a face of its own.
fn with_faces(
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    normals: &[DVec3],
    material: MaterialId,
    materials: &[Material],
) -> Mesh {
    let mut all = normals.to_vec();
    let mut near = Near::new(NEARLY);
    normals.iter().enumerate().for_each(|(face, normal)| near.insert(face, *normal));
    let mut faced: Vec<(usize, [u32; 3])> = Vec::with_capacity(triangles.len());
    for corners in triangles {
        let normal = normal_of(corners.map(|corner| positions[corner as usize]));
        let along = |face: &usize| normals[*face].dot(normal);
        let most = |a: &usize, b: &usize| along(a).total_cmp(&along(b)).then(a.cmp(b));
        // of most triangles one that is near enough is found without asking all
        let nearest = near.around(normal).filter(|face| normals[*face].distance(normal) <= NEARLY).max_by(most);
        let face = nearest.or_else(|| (0..normals.len()).max_by(most));
        let face = face.filter(|face| along(face) >= SAME_FACE).unwrap_or_else(|| {
            all.push(normal);
            all.len() - 1
        });
        faced.push((face, corners));
    }
    faced.sort_by_key(|(face, _)| *face);
    let mut mesh = Mesh { positions, materials: materials.to_vec(), ..Mesh::default() };
    for run in faced.chunk_by(|a, b| a.0 == b.0) {
        mesh.triangle_faces.resize(mesh.triangle_faces.len() + run.len(), mesh.faces.len() as u32);
        mesh.triangles.extend(run.iter().map(|(_, corners)| *corners));
        mesh.faces.push(MeshFace { normal: all[run[0].0], material });
    }
    mesh
}

fn normal_of([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).normalize_or_zero().cross((c - a).normalize_or_zero()).normalize_or(DVec3::Z)
}
