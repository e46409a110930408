//! A closed surface as one leaf of a tree: a convex body where it is one, a closed mesh otherwise.

use planecut_csg::{Brush, ClosedMesh, ClosedMeshError, MaterialId, MeshBody, WindingRule};
use planecut_kernel::DVec3;
use rustc_hash::FxHashMap;

use super::convexity::may_be_convex;
use super::error::PolyhedronError;
use super::joining::{join_near, joining_distances};
use super::polygon::{MAX_CONCAVE_CORNERS, triangulate as cut};
use super::precision::Precision;
use super::surface::{MAX_COORDINATE, six_volumes};
use super::{PolyhedronOptions, material_of_facet, polyhedron};

/// Surfaces of more triangles are not tried as one convex body: that takes longer than to combine them as they are.
pub const MAX_CONVEX_TRIANGLES: usize = 1 << 13;

/// Surfaces with more volume than this share of their size have more than two-sided sheets: for those, sums are zero but for rounding.
const NO_VOLUME: f64 = 1e-9;

/// How a surface becomes a leaf.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceOptions {
    /// How exactly corners are known.
    pub precision: Precision,
    /// What is inside.
    pub rule: WindingRule,
}

/// A closed surface as a leaf of a tree.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceBody {
    /// The leaf.
    pub brush: Brush,
    /// Whether all facets were turned over: they were clockwise seen from outside.
    pub is_turned: bool,
    /// How many facets of a convex body were cut into triangles as their corners lie on no plane; those of a closed mesh always are.
    pub bent_facets: usize,
    /// How many places of corners went because the surface was not closed without joining them to others, as near as rounding.
    pub joined_corners: usize,
}

/// A closed surface as one leaf of a tree: a convex body with one face for each plane where it is one, and a closed mesh otherwise.
///
/// Arguments are those of [`polyhedron`]. The surface may cross itself, lie upon itself and be nested in itself: what is inside is said by the rule.
/// A surface that as a whole encloses a negative volume is turned over.
///
/// # Errors
/// [`PolyhedronError`] where the surface is not closed, or is a sheet with two sides.
///
/// ```
/// use planecut_csg::{Material, MaterialId, Model, WindingRule, evaluate};
/// use planecut_kernel::DVec3;
/// use planecut_shapes::polyhedron::{Precision, SurfaceOptions, surface_body};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// // two tetrahedra that pass through each other
/// let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let points: Vec<DVec3> = corners.into_iter().chain(corners.map(|corner| corner + 0.125)).collect();
/// let facets: Vec<[u32; 3]> =
///     [0, 4].iter().flat_map(|k| [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].map(|f| f.map(|v| v + k))).collect();
/// let options = SurfaceOptions { precision: Precision::Double, rule: WindingRule::Positive };
/// let both = surface_body(&points, &facets, &[MaterialId(0)], &options)?;
/// assert!(both.brush.is_mesh());
/// let solid = evaluate(&Model { materials: vec![Material::default()], tree: both.brush.into() })?.solid;
/// // what is in both is a tetrahedron with sides of 1 - 3/8
/// assert!((solid.volume - (2.0 - 0.625f64.powi(3)) / 6.0).abs() < 1e-12);
/// # Ok(())
/// # }
/// ```
pub fn surface_body<F: AsRef<[u32]>>(
    points: &[DVec3],
    facets: &[F],
    materials: &[MaterialId],
    options: &SurfaceOptions,
) -> Result<SurfaceBody, PolyhedronError> {
    let mut body = surface_mesh(points, facets, materials, options)?;
    let is_tried = body.brush.mesh.as_ref().is_some_and(|leaf| {
        let mesh = leaf.mesh();
        mesh.triangles().len() <= MAX_CONVEX_TRIANGLES
            && may_be_convex(mesh.positions(), mesh.triangles(), options.precision)
    });
    let convex = if is_tried { convex_body(points, facets, materials, options.precision) } else { None };
    if let Some((brush, bent_facets)) = convex {
        (body.brush, body.bent_facets) = (brush, bent_facets);
    }
    Ok(body)
}

/// The same as a closed mesh, also where it is a convex body: each triangle keeps its surface.
///
/// # Errors
/// As [`surface_body`].
pub fn surface_mesh<F: AsRef<[u32]>>(
    points: &[DVec3],
    facets: &[F],
    materials: &[MaterialId],
    options: &SurfaceOptions,
) -> Result<SurfaceBody, PolyhedronError> {
    check_points(points)?;
    let material_of = material_of_facet(materials, facets.len())?;
    let (mut triangles, facet_of) = triangles_of(points, facets)?;
    let six_volumes = six_volumes(points, &triangles);
    if six_volumes < 0.0 {
        triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
    }
    let (surfaces, of_surface) = surfaces(&facet_of, material_of);
    let closed = |points: &[DVec3]| ClosedMesh::new(points, &triangles, |triangle| surfaces[triangle]);
    let (mesh, joined_corners) = match closed(points) {
        Err(open @ ClosedMeshError::Open { .. }) => closed_by_joining(points, options.precision, closed).ok_or(open),
        mesh => mesh.map(|mesh| (mesh, 0)),
    }
    .map_err(|error| fault(&error, &facet_of))?;
    if is_two_sided(&mesh, six_volumes) {
        return Err(PolyhedronError::NoVolume);
    }
    let brush = Brush::of_mesh(MeshBody::new(mesh, of_surface).with_rule(options.rule));
    Ok(SurfaceBody { brush, is_turned: six_volumes < 0.0, bent_facets: 0, joined_corners })
}

/// Whether each triangle lies on its own mirror image: a sheet of two sides, which winds around nothing.
fn is_two_sided(mesh: &ClosedMesh, six_volumes: f64) -> bool {
    let nowhere = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (low, high) = mesh.positions().iter().fold(nowhere, |(low, high), p| (low.min(*p), high.max(*p)));
    let size = if mesh.positions().is_empty() { DVec3::ZERO } else { high - low };
    if six_volumes.abs() > NO_VOLUME * size.max_element().powi(3) {
        return false;
    }
    let mut sides: FxHashMap<[u32; 3], i32> = FxHashMap::default();
    for triangle in mesh.triangles() {
        let mut corners = *triangle;
        corners.sort_unstable();
        let first = triangle.iter().position(|corner| *corner == corners[0]).unwrap_or(0);
        let is_ascending = triangle[(first + 1) % 3] == corners[1];
        *sides.entry(corners).or_default() += if is_ascending { 1 } else { -1 };
    }
    sides.values().all(|sum| *sum == 0)
}

fn check_points(points: &[DVec3]) -> Result<(), PolyhedronError> {
    // not true of NaN
    let is_accepted = |p: &DVec3| p.to_array().iter().all(|v| v.abs() <= MAX_COORDINATE);
    match points.iter().position(|p| !is_accepted(p)) {
        Some(point) => Err(PolyhedronError::Point { point, position: points[point] }),
        None => Ok(()),
    }
}

/// Facets as triangles, and the facet of each.
fn triangles_of<F: AsRef<[u32]>>(points: &[DVec3], facets: &[F]) -> Result<(Vec<[u32; 3]>, Vec<u32>), PolyhedronError> {
    let (mut triangles, mut facet_of) = (Vec::with_capacity(facets.len()), Vec::with_capacity(facets.len()));
    for (number, facet) in (0..).zip(facets) {
        let corners = facet.as_ref();
        if let Some(&point) = corners.iter().find(|point| **point as usize >= points.len()) {
            return Err(PolyhedronError::UnknownPoint { facet: number as usize, point, points: points.len() });
        }
        match *corners {
            [a, b, c] => triangles.push([a, b, c]),
            [] | [_] | [_, _] => {}
            _ => {
                let places: Vec<DVec3> = corners.iter().map(|corner| points[*corner as usize]).collect();
                let cut = cut(&places).ok_or(PolyhedronError::TooManyCorners {
                    facet: number as usize,
                    corners: corners.len(),
                    limit: MAX_CONCAVE_CORNERS,
                })?;
                triangles.extend(cut.into_iter().map(|triangle| triangle.map(|k| corners[k])));
            }
        }
        facet_of.resize(triangles.len(), number);
    }
    Ok((triangles, facet_of))
}

/// For each triangle the place of its material in a list, and the list.
fn surfaces(facet_of: &[u32], material_of: impl Fn(u32) -> MaterialId) -> (Vec<u32>, Vec<MaterialId>) {
    let mut places: FxHashMap<MaterialId, u32> = FxHashMap::default();
    let mut list = Vec::new();
    let mut place = |facet: &u32| {
        let material = material_of(*facet);
        *places.entry(material).or_insert_with(|| {
            list.push(material);
            list.len() as u32 - 1
        })
    };
    let of_triangles = facet_of.iter().map(&mut place).collect();
    (of_triangles, list)
}

/// The mesh with corners joined that differ by rounding, by the smallest distance that closes it, and how many places went.
fn closed_by_joining(
    points: &[DVec3],
    precision: Precision,
    closed: impl Fn(&[DVec3]) -> Result<ClosedMesh, ClosedMeshError>,
) -> Option<(ClosedMesh, usize)> {
    joining_distances(points, precision).find_map(|distance| {
        let (near, joined) = join_near(points, distance);
        let mesh = if joined > 0 { closed(&near).ok() } else { None };
        mesh.map(|mesh| (mesh, joined))
    })
}

fn convex_body<F: AsRef<[u32]>>(
    points: &[DVec3],
    facets: &[F],
    materials: &[MaterialId],
    precision: Precision,
) -> Option<(Brush, usize)> {
    let solid = polyhedron(points, facets, materials, &PolyhedronOptions { precision }).ok()?;
    let mut cells = solid.cells;
    if cells.len() == 1 { cells.pop().map(|cell| (cell, solid.bent_facets)) } else { None }
}

/// What is wrong with the mesh of facets, said of these.
fn fault(error: &ClosedMeshError, facet_of: &[u32]) -> PolyhedronError {
    match *error {
        ClosedMeshError::Open { triangle, from, to, count } => {
            PolyhedronError::Open { facet: facet_of[triangle] as usize, from, to, edges: count }
        }
        ClosedMeshError::NoVertex { triangle, vertex, vertices } => {
            PolyhedronError::UnknownPoint { facet: facet_of[triangle] as usize, point: vertex, points: vertices }
        }
        ClosedMeshError::NotFinite { vertex, position } => PolyhedronError::Point { point: vertex, position },
        ClosedMeshError::TooSmall { size } => PolyhedronError::TooSmall { size },
        _ => PolyhedronError::NoVolume,
    }
}
