//! What must hold between the views of any polytope, and counts taken from the exact facets.

use std::collections::{BTreeMap, BTreeSet};

use dashu_ratio::RBig;
use planecut_kernel::{Edge, EdgeIdx, EdgeKind, IncrementalPolytope, PlaneIdx, Vertex, VertexIdx};

/// Compares every view of a polytope with every other; `epsilon` is the polytope's tolerance.
///
/// # Errors
/// The first difference.
pub(crate) fn check(polytope: &IncrementalPolytope, epsilon: f64) -> Result<(), String> {
    polytope.check_invariants().map_err(|e| e.to_string())?;
    polytope.validate_topology().map_err(|e| e.to_string())?;
    let vertices: BTreeMap<VertexIdx, Vertex> = polytope.vertices().collect();
    let edges: BTreeMap<EdgeIdx, Edge> = polytope.edges().collect();
    agree("vertices listed", polytope.vertices().count(), vertices.len())?;
    agree("edges listed", polytope.edges().count(), edges.len())?;
    agree("vertex_count", polytope.vertex_count(), vertices.len())?;
    agree("edge_count", polytope.edge_count(), edges.len())?;
    check_local_vertices(polytope, &vertices)?;
    check_local_edges(polytope, &edges)?;
    for (name, edge) in &edges {
        check_edge(polytope, &vertices, *name, edge)?;
        check_direction(&vertices, edge, epsilon)?;
    }
    for (name, vertex) in &vertices {
        check_vertex(&edges, *name, vertex)?;
    }
    check_faces(polytope, &vertices)
}

/// With tolerance zero: what the facets say, as rationals.
///
/// # Errors
/// The first difference.
pub(crate) fn compare_with_facets(polytope: &IncrementalPolytope) -> Result<(), String> {
    let facets = polytope.facets();
    let mut points = BTreeSet::new();
    let mut ends_of_edges = 0;
    let across: BTreeMap<PlaneIdx, BTreeSet<PlaneIdx>> =
        facets.iter().map(|(plane, edges)| (*plane, edges.iter().flatten().copied().collect())).collect();
    for (plane, edges) in &facets {
        for edge in edges.iter().flatten() {
            let sees_back = across.get(edge).is_some_and(|back| back.contains(plane));
            agree(&format!("{edge:?}, across an edge of the facet {plane:?}, sees it"), sees_back, true)?;
        }
        ends_of_edges += edges.iter().flatten().count();
        for (k, edge) in edges.iter().enumerate() {
            if let (Some(a), Some(b)) = (edge, edges[(k + 1) % edges.len()]) {
                points.insert(meeting_point(polytope, [*plane, *a, b])?);
            }
        }
    }
    let finite = polytope.vertices().filter(|(_, vertex)| vertex.is_finite()).count();
    agree("finite vertices", finite, points.len())?;
    agree("edges in facets", 2 * polytope.edge_count(), ends_of_edges)?;
    let faces: Vec<PlaneIdx> = polytope.faces().iter().map(|face| face.plane).collect();
    agree("planes of faces", faces, facets.iter().map(|(plane, _)| *plane).collect())?;
    let seen: BTreeSet<Vec<u64>> = polytope
        .vertices()
        .filter_map(|(_, vertex)| vertex.to_euclidean())
        .map(|point| point.to_array().map(f64::to_bits).to_vec())
        .collect();
    let exact: BTreeSet<Vec<u64>> =
        points.iter().map(|point| point.iter().map(|c| (c.to_f64().value() + 0.0).to_bits()).collect()).collect();
    agree("positions", seen, exact)
}

fn agree<T: PartialEq + std::fmt::Debug>(what: &str, found: T, expected: T) -> Result<(), String> {
    let both = (found, expected);
    if both.0 == both.1 { Ok(()) } else { Err(format!("{what}: {:?} is not {:?}", both.0, both.1)) }
}

/// Where three planes meet, by Cramer's rule.
fn meeting_point(polytope: &IncrementalPolytope, planes: [PlaneIdx; 3]) -> Result<[RBig; 3], String> {
    let exact = |v: f64| RBig::try_from(v).map_err(|e| format!("{v}: {e:?}"));
    let mut rows = Vec::new();
    for plane in planes {
        let half_space = polytope.plane(plane).ok_or("a facet names a plane that is not there")?;
        let n = half_space.normal();
        rows.push([exact(n.x)?, exact(n.y)?, exact(n.z)?, exact(half_space.offset())?]);
    }
    let det = |u: usize, v: usize, w: usize| {
        let [a, b, c] = [&rows[0], &rows[1], &rows[2]];
        &a[u] * (&b[v] * &c[w] - &b[w] * &c[v]) - &a[v] * (&b[u] * &c[w] - &b[w] * &c[u])
            + &a[w] * (&b[u] * &c[v] - &b[v] * &c[u])
    };
    let w = det(0, 1, 2);
    if w <= RBig::ZERO {
        return Err(format!("{planes:?} are not right-handed"));
    }
    Ok([det(3, 1, 2) / &w, det(0, 3, 2) / &w, det(0, 1, 3) / &w])
}

/// More handles than the structure can have in use.
fn handles(polytope: &IncrementalPolytope) -> u32 {
    2 * polytope.simple_vertices().count() as u32 + 16
}

fn check_local_vertices(polytope: &IncrementalPolytope, vertices: &BTreeMap<VertexIdx, Vertex>) -> Result<(), String> {
    let mut smallest = BTreeMap::new();
    for idx in (0..handles(polytope)).map(VertexIdx) {
        let Some(vertex) = polytope.vertex(idx) else { continue };
        // the two ends of a line have the same edge
        let key = (vertex.edges.clone(), vertex.position.to_array().map(f64::to_bits));
        smallest.entry(key).or_insert((idx, vertex.clone()));
        if !vertices.values().any(|listed| *listed == vertex) {
            return Err(format!("vertex({idx:?}) is not listed: {vertex:?}"));
        }
    }
    let by_handle: BTreeMap<VertexIdx, Vertex> = smallest.into_values().collect();
    agree("vertex() and vertices()", &by_handle, vertices)
}

fn check_local_edges(polytope: &IncrementalPolytope, edges: &BTreeMap<EdgeIdx, Edge>) -> Result<(), String> {
    let mut smallest = BTreeMap::new();
    for idx in (0..4 * handles(polytope)).map(EdgeIdx) {
        if let Some(edge) = polytope.edge(idx) {
            let first = smallest.entry(edge.planes).or_insert((idx, edge.clone())).clone();
            agree("edge() from different half-edges", edge, first.1)?;
        }
    }
    agree("edge() and edges()", smallest.into_values().collect(), edges.clone())
}

fn check_edge(
    polytope: &IncrementalPolytope,
    vertices: &BTreeMap<VertexIdx, Vertex>,
    name: EdgeIdx,
    edge: &Edge,
) -> Result<(), String> {
    let (p, q) = edge.planes;
    agree("edge_by_planes", polytope.edge_by_planes(p, q), Some(name))?;
    agree("edge_by_planes, turned", polytope.edge_by_planes(q, p), Some(name))?;
    agree("order of planes", p < q && edge.is_on_plane(p) && edge.is_on_plane(q), true)?;
    let (a, b) = edge.vertices;
    agree("other_vertex", (edge.other_vertex(a), edge.other_vertex(b)), (Some(b), Some(a)))?;
    for end in [a, b] {
        let vertex = vertices.get(&end).ok_or_else(|| format!("{name:?} ends at {end:?}, which is not listed"))?;
        if !vertex.edges.contains(&name) || !vertex.planes.contains(&p) || !vertex.planes.contains(&q) {
            return Err(format!("{end:?} {vertex:?} does not know {name:?} {edge:?}"));
        }
    }
    let kind = match (vertices[&a].is_finite(), vertices[&b].is_finite()) {
        (true, true) => EdgeKind::Segment,
        (true, false) => EdgeKind::Ray,
        (false, false) => EdgeKind::Line,
        (false, true) => return Err(format!("{name:?} begins at its ideal end")),
    };
    agree("kind", edge.kind, kind)?;
    agree("kind by name", (edge.is_bounded(), edge.is_ray(), edge.is_line()), {
        (kind == EdgeKind::Segment, kind == EdgeKind::Ray, kind == EdgeKind::Line)
    })?;
    Ok(())
}

fn check_direction(vertices: &BTreeMap<VertexIdx, Vertex>, edge: &Edge, epsilon: f64) -> Result<(), String> {
    let [start, end] = [edge.vertices.0, edge.vertices.1].map(|end| &vertices[&end]);
    let is_unit = (edge.direction.length() - 1.0).abs() < 1e-14;
    let fits = match (start.to_euclidean(), end.to_euclidean()) {
        (Some(from), Some(to)) => {
            let along = to - from;
            // both ends are rounded, and the tolerance may have moved them along other edges
            let slack = f64::EPSILON * (from.abs().max_element() + to.abs().max_element());
            let merged = if epsilon > 0.0 { 20.0 * epsilon } else { 0.0 };
            along.length() * along.normalize_or_zero().distance(edge.direction) <= 4.0 * slack + 2.0 * merged
        }
        _ => end.direction().is_some_and(|direction| direction.distance(edge.direction) < 1e-14),
    };
    if is_unit && fits { Ok(()) } else { Err(format!("the direction of {edge:?} from {start:?} to {end:?}")) }
}

fn check_vertex(edges: &BTreeMap<EdgeIdx, Edge>, name: VertexIdx, vertex: &Vertex) -> Result<(), String> {
    for edge in &vertex.edges {
        let ends = edges.get(edge).ok_or_else(|| format!("{name:?} has {edge:?}, which is not listed"))?.vertices;
        agree("end of its edge", ends.0 == name || ends.1 == name, true)?;
    }
    if vertex.is_finite() {
        // around a vertex, faces and edges alternate
        agree("edges and planes at a vertex", vertex.edges.len(), vertex.planes.len())?;
        agree("three planes", vertex.planes.len() >= 3, true)
    } else {
        agree("edges and planes at an ideal vertex", (vertex.edges.len(), vertex.planes.len()), (1, 2))
    }
}

fn check_faces(polytope: &IncrementalPolytope, vertices: &BTreeMap<VertexIdx, Vertex>) -> Result<(), String> {
    let finite: BTreeSet<VertexIdx> =
        vertices.iter().filter(|(_, vertex)| vertex.is_finite()).map(|(name, _)| *name).collect();
    let order: Vec<VertexIdx> =
        polytope.vertices().map(|(name, _)| name).filter(|name| finite.contains(name)).collect();
    let (positions, polygons) = polytope.to_mesh();
    let listed: Vec<_> = order.iter().filter_map(|name| vertices[name].to_euclidean()).collect();
    agree("positions of the mesh", positions, listed)?;
    let faces = polytope.faces();
    let bounded: Vec<_> = faces.iter().filter(|face| face.is_bounded).map(|face| face.vertices.clone()).collect();
    agree("polygons of the mesh", polygons, bounded)?;
    let mut named: BTreeSet<PlaneIdx> = vertices.values().flat_map(|vertex| vertex.planes.clone()).collect();
    for face in &faces {
        let corners: BTreeSet<VertexIdx> = face.vertices.iter().map(|k| order[*k]).collect();
        agree("corners of a face, each once", corners.len(), face.vertices.len())?;
        let touching = finite.iter().filter(|name| vertices[name].planes.contains(&face.plane)).copied().collect();
        agree("corners of a face", corners, touching)?;
        named.remove(&face.plane);
    }
    agree("planes named by vertices without a face", named, BTreeSet::new())
}
