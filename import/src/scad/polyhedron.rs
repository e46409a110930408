//! `polyhedron`: a solid of given corners and faces.

use planecut_csg::{MaterialId, MeshBody, WindingRule};
use planecut_kernel::DVec3;
use planecut_shapes::polyhedron::{PolyhedronError, Precision, SurfaceBody, SurfaceOptions, surface_body};
use rustc_hash::FxHashMap;

use super::arguments::Arguments;
use super::leaf::corners;
use super::problem::Body;
use super::syntax::Node;
use super::value::Value;
use crate::mesh::joined_message;
use crate::mesh::merge::PositionMerger;

/// Significant digits of the numbers that OpenSCAD writes.
const DIGITS: u32 = 6;

/// Corners, and of each face their numbers, counter-clockwise seen from outside.
type Surface = (Vec<DVec3>, Vec<Vec<u32>>);

/// The solid, and what is to be said of it.
///
/// # Errors
/// Why there is none, in one line.
pub(super) fn body(node: &Node<'_>, material: MaterialId) -> Result<(Body, Vec<String>), String> {
    let (points, facets) = surface(node)?;
    if facets.is_empty() {
        return Ok((Body::default(), Vec::new()));
    }
    match solid(&points, &facets, material) {
        Ok(solid) => {
            let turned =
                solid.is_turned.then(|| "a polyhedron whose faces are all turned around is turned back".to_owned());
            let joined = (solid.joined_corners > 0).then(|| joined_message(solid.joined_corners));
            let touches = |mesh: &MeshBody| touches_itself(mesh.mesh().positions(), mesh.mesh().triangles());
            let touches_itself = solid.brush.mesh.as_ref().is_some_and(touches);
            let body = Body { tree: solid.brush.into(), touches_itself, ..Body::default() };
            Ok((body, turned.into_iter().chain(joined).collect()))
        }
        Err(PolyhedronError::NoVolume) => Ok((Body::default(), Vec::new())),
        Err(error) => Err(error.to_string()),
    }
}

/// The solid within a surface whose corners are known as OpenSCAD writes them. Where one has more digits than that, something
/// else wrote the tree, which had reason to write them; and what is convex with planar faces as it stands is meant so.
fn solid(points: &[DVec3], facets: &[Vec<u32>], material: MaterialId) -> Result<SurfaceBody, PolyhedronError> {
    let rule = WindingRule::Positive;
    let known_to = |precision| surface_body(points, facets, &[material], &SurfaceOptions { precision, rule });
    let is_short = |v: f64| format!("{v:.*e}", DIGITS as usize - 1).parse() == Ok(v);
    let exactly = known_to(Precision::Double);
    let is_meant = |solid: &SurfaceBody| !solid.brush.is_mesh() && solid.bent_facets == 0;
    if exactly.as_ref().is_ok_and(is_meant) || !points.iter().flat_map(|point| point.to_array()).all(is_short) {
        return exactly;
    }
    known_to(Precision::Digits(DIGITS))
}

fn surface(node: &Node<'_>) -> Result<Surface, String> {
    let arguments = Arguments::of(node, &["points", "faces", "convexity"]);
    let given = arguments.get("points").map(Value::items).unwrap_or_default();
    let faces = arguments.get("faces").or_else(|| arguments.get("triangles"));
    let numbers: Vec<u32> = (0..u32::try_from(given.len()).unwrap_or(u32::MAX)).collect();
    let mut facets = Vec::new();
    for face in faces.map(Value::items).unwrap_or_default() {
        // OpenSCAD lists them clockwise
        let mut facet = corners(face, &numbers);
        facet.reverse();
        facet.dedup();
        if facet.len() >= 3 {
            facets.push(facet);
        }
    }
    let mut points = vec![DVec3::ZERO; given.len()];
    for corner in facets.iter().flatten() {
        let at = *corner as usize;
        let point = given[at].finite::<3>();
        points[at] = DVec3::from_array(point.ok_or_else(|| format!("its point {at} is not three finite numbers"))?);
    }
    Ok((points, facets))
}

/// Whether a surface is no closed manifold once corners at the same place are one: an edge has other than two faces, or a corner
/// more than one fan of them.
pub(super) fn touches_itself<F: AsRef<[u32]>>(points: &[DVec3], facets: &[F]) -> bool {
    let mut places = PositionMerger::default();
    let mut place = |corner: &u32| places.index(points[*corner as usize]).expect("no more places than corners");
    let facets = facets.iter().map(|facet| {
        let mut facet: Vec<u32> = facet.as_ref().iter().map(&mut place).collect();
        facet.dedup();
        while facet.len() > 1 && facet.first() == facet.last() {
            facet.pop();
        }
        facet
    });
    // a facet whose corners are at fewer than three places has no part in the surface
    let facets: Vec<Vec<u32>> = facets.filter(|facet| facet.len() > 2).collect();
    // after each corner of a face, seen from that corner: where the face came from, by where it goes
    let mut fans: FxHashMap<(u32, u32), u32> = FxHashMap::default();
    let mut degree = vec![0_u32; places.into_positions().len()];
    for facet in &facets {
        let n = facet.len();
        for k in 0..n {
            let (before, at, after) = (facet[(k + n - 1) % n], facet[k], facet[(k + 1) % n]);
            degree[at as usize] += 1;
            if fans.insert((at, after), before).is_some() {
                return true;
            }
        }
    }
    if fans.keys().any(|(from, to)| !fans.contains_key(&(*to, *from))) {
        return true;
    }
    // going from face to face comes back after all of them
    let is_one_fan = |corner: u32, start: u32| {
        let faces = degree[corner as usize] as usize;
        let around = std::iter::successors(Some(start), |next| fans.get(&(corner, *next)).copied());
        around.skip(1).take(faces).position(|next| next == start) == Some(faces - 1)
    };
    let starts: FxHashMap<u32, u32> = fans.keys().copied().collect();
    starts.into_iter().any(|(corner, start)| !is_one_fan(corner, start))
}
