//! The exact views of a bounded polytope, `facets()` and `vertices()`, and the ideal vertices of an unbounded one.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use dashu_int::IBig;
use planecut_kernel::{DVec3, IncrementalPolytope, PlaneIdx, Vertex};

use crate::exact::{Coefficients, det3, sign};
use crate::solid::Solid;
use crate::structure::agree;

/// Largest outward component of a unit direction that should stay inside a unit normal's half-space.
const DIRECTION_TOLERANCE: f64 = 1e-12;

/// `facets()` names the face loops by planes alone.
///
/// # Errors
/// The first difference from the exact solid.
pub(super) fn compare_facets(
    polytope: &IncrementalPolytope,
    rank: &HashMap<PlaneIdx, usize>,
    solid: &Solid,
    normals: &[[IBig; 3]],
) -> Result<(), String> {
    let mut facets: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (plane, edges) in polytope.facets() {
        let known: Option<Vec<usize>> = edges.iter().map(|e| e.map(|e| rank[&e])).collect();
        facets.insert(rank[&plane], known.ok_or("a bounded polytope has an edge on an infinity plane")?);
    }
    let owners: Vec<usize> = solid.facets.iter().map(|f| f.plane).collect();
    agree("planes of facets()", &facets.keys().copied().collect(), &owners)?;
    for facet in &solid.facets {
        let edges = &facets[&facet.plane];
        let corners: Vec<usize> = (0..edges.len())
            .map(|k| corner(solid, normals, [facet.plane, edges[k], edges[(k + 1) % edges.len()]]))
            .collect::<Result<_, _>>()?;
        agree("corners of a facet", &corners.iter().copied().collect(), &facet.vertices)?;
        agree("edge planes of a facet", &edges.len(), &facet.vertices.len())?;
        for (k, &to) in corners.iter().enumerate() {
            let from = corners[(k + corners.len() - 1) % corners.len()];
            let joined = solid.edges.contains(&[from.min(to), from.max(to)]);
            if !joined || !solid.vertices[from].planes.contains(&edges[k]) {
                return Err(format!("facet {}: edge {k} does not lie on plane {}", facet.plane, edges[k]));
            }
        }
    }
    Ok(())
}

/// The vertex on three planes, which must be right-handed in this order.
fn corner(solid: &Solid, normals: &[[IBig; 3]], planes: [usize; 3]) -> Result<usize, String> {
    let [a, b, c] = planes;
    agree("orientation of a facet's corner", &sign(&det3(&normals[a], &normals[b], &normals[c])), &1)?;
    let on_all = |v: &usize| planes.iter().all(|p| solid.vertices[*v].planes.contains(p));
    (0..solid.vertices.len()).find(on_all).ok_or_else(|| format!("planes {planes:?} do not meet in a vertex"))
}

/// `vertices()` of a bounded polytope: each finite, with planes that pass through it exactly.
///
/// # Errors
/// The first difference from the exact solid.
pub(super) fn compare_vertices(
    polytope: &IncrementalPolytope,
    rank: &HashMap<PlaneIdx, usize>,
    solid: &Solid,
) -> Result<(), String> {
    let vertices = seen_vertices(polytope);
    agree("length of vertices()", &vertices.len(), &solid.vertices.len())?;
    let owners: BTreeSet<usize> = solid.facets.iter().map(|f| f.plane).collect();
    let mut found = BTreeSet::new();
    for vertex in vertices {
        let planes: BTreeSet<usize> = vertex.planes.iter().map(|p| rank[p]).collect();
        let exact = solid.vertices.iter().position(|v| {
            planes.iter().all(|p| v.planes.contains(p))
                && v.planes.iter().filter(|p| owners.contains(p)).all(|p| planes.contains(p))
        });
        let name = exact.ok_or_else(|| format!("no vertex is where the planes {planes:?} meet"))?;
        let position: Vec<f64> =
            solid.vertices[name].position.iter().map(|c| c.to_f64().value()).chain([1.0]).collect();
        agree("position of a vertex", &vertex.position.to_array().to_vec(), &position)?;
        if !found.insert(name) {
            return Err(format!("vertices() lists the vertex on {planes:?} twice"));
        }
    }
    Ok(())
}

fn seen_vertices(polytope: &IncrementalPolytope) -> Vec<Vertex> {
    polytope.vertices().map(|(_, vertex)| vertex).collect()
}

/// Ideal vertices: unit directions that stay inside and lie in their planes, after all finite ones.
///
/// # Errors
/// The first vertex that does not fit.
pub(super) fn check_ideal_vertices(
    polytope: &IncrementalPolytope,
    rank: &HashMap<PlaneIdx, usize>,
    planes: &[Coefficients],
    expected: usize,
) -> Result<(), String> {
    let vertices = seen_vertices(polytope);
    let first = vertices.iter().position(|v| v.position.w == 0.0).unwrap_or(vertices.len());
    agree("ideal vertices", &(vertices.len() - first), &expected)?;
    for vertex in &vertices[first..] {
        let u = vertex.position.truncate();
        let outward = |c: &Coefficients| {
            let n = DVec3::new(c[0], c[1], c[2]);
            (n / n.abs().max_element()).normalize().dot(u)
        };
        let own = vertex.planes.iter().map(|p| outward(&planes[rank[p]]).abs());
        let worst = planes.iter().map(outward).chain(own).fold((u.length() - 1.0).abs(), f64::max);
        if vertex.position.w != 0.0 || vertex.planes.len() < 2 || worst.is_nan() || worst > DIRECTION_TOLERANCE {
            return Err(format!("ideal vertex {vertex:?} is off by {worst:e}"));
        }
    }
    Ok(())
}
