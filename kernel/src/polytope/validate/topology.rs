//! Checks of what is seen: the paper's validation table (§3.7), one error for each row.
//!
//! Euler's formula is asked of unbounded sets too. With V the finite vertices, `V − E + F` is the Euler characteristic with
//! compact supports of the boundary, because open edges count −1 (rays and lines as well) and open faces +1. A
//! closed convex set is `L × Q`, a linear space of dimension `l` times a set `Q` of dimension `3 − l` that holds no line; the
//! boundary is `L × ∂Q`, and the characteristic multiplies: `χ = (−1)^l χ(∂Q)`.
//! - `Q` bounded: `∂Q` is a sphere of dimension `2 − l`: χ is 2 for `l = 0` and for a slab (`l = 2`), 0 for a polygon times a
//!   line (`l = 1`) and, with nothing to bound, for all of space (`l = 3`).
//! - `Q` unbounded: `∂Q` is `ℝ^(2−l)` deformed, its characteristic `(−1)^(2−l)`, so χ is 1.

use std::collections::{BTreeMap, BTreeSet};

use thiserror::Error;

use super::super::infinity::is_infinity;
use super::super::{EdgeIdx, IncrementalPolytope, PlaneIdx, VertexIdx, external};
use crate::sign::{Row, Sign, cross_component};

/// A broken topology (paper §3.7): never the user's mistake.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum TopologyError {
    /// `V − E + F` is not what it is for such a set: missing or spurious vertices, edges or faces.
    #[error("Euler's formula fails: {vertices} finite vertices - {edges} edges + {faces} faces is not {expected}")]
    Euler {
        /// Finite vertices.
        vertices: usize,
        /// Segments, rays and lines.
        edges: usize,
        /// Seen faces.
        faces: usize,
        /// What the sum should be.
        expected: i64,
    },
    /// A finite vertex with fewer than three planes.
    #[error("vertex {vertex:?} has {planes} planes, a finite one needs three")]
    VertexDegree {
        /// The vertex.
        vertex: VertexIdx,
        /// How many different planes it has.
        planes: usize,
    },
    /// An ideal vertex with fewer than two planes.
    #[error("ideal vertex {vertex:?} has {planes} planes, it needs two")]
    IdealDegree {
        /// The vertex.
        vertex: VertexIdx,
        /// How many different planes it has, infinity planes left out.
        planes: usize,
    },
    /// An edge refers to a vertex that does not exist or does not know of it.
    #[error("edge {edge:?} refers to vertex {vertex:?}, which is not its end")]
    EdgeValidity {
        /// The edge.
        edge: EdgeIdx,
        /// What it refers to.
        vertex: VertexIdx,
    },
    /// A face with fewer than three corners, those at infinity included.
    #[error("the face of plane {plane:?} has {vertices} corners")]
    FaceSize {
        /// The plane.
        plane: PlaneIdx,
        /// Different corners.
        vertices: usize,
    },
    /// Two edges between the faces of the same two planes.
    #[error("edges {} both lie between planes {}", pair(.edges), pair(.planes))]
    EdgeUniqueness {
        /// The two planes.
        planes: (PlaneIdx, PlaneIdx),
        /// The two edges.
        edges: (EdgeIdx, EdgeIdx),
    },
}

fn pair<T: std::fmt::Debug>((a, b): &(T, T)) -> String {
    format!("{a:?} and {b:?}")
}

impl IncrementalPolytope {
    /// Checks what is seen against the paper's validation table (§3.7): degrees of vertices, ends of edges, sizes of
    /// faces, uniqueness of edges, and Euler's formula, for unbounded sets too. An empty set has nothing to check.
    ///
    /// Cost: about linear in the polytope.
    ///
    /// # Errors
    /// The first [`TopologyError`] found; a bug in this crate.
    pub fn validate_topology(&self) -> Result<(), TopologyError> {
        if self.is_empty() {
            return Ok(());
        }
        self.check_stored_vertices()?;
        self.check_stored_faces()?;
        let incidence = self.check_seen_vertices()?;
        let edges = self.check_seen_edges(&incidence)?;
        let faces = self.check_seen_faces(&incidence)?;
        let vertices = incidence.keys().filter(|vertex| !self.vertices.is_ideal(vertex.0)).count();
        let expected = self.expected_characteristic();
        if vertices as i64 - edges as i64 + faces as i64 == expected {
            Ok(())
        } else {
            Err(TopologyError::Euler { vertices, edges, faces, expected })
        }
    }

    /// Degrees and ends in the simple structure, without which nothing that is seen can be worked out.
    fn check_stored_vertices(&self) -> Result<(), TopologyError> {
        for slot in self.vertices.slots() {
            let vertex = VertexIdx(slot);
            let planes = self.vertices.planes(slot);
            let different: BTreeSet<u32> = planes.into_iter().collect();
            let real = different.iter().filter(|plane| !is_infinity(**plane)).count();
            let infinite = planes.into_iter().filter(|plane| is_infinity(*plane)).count();
            if infinite == 0 && real < 3 {
                return Err(TopologyError::VertexDegree { vertex, planes: real });
            }
            if infinite == 1 && real < 2 {
                return Err(TopologyError::IdealDegree { vertex, planes: real });
            }
            for (k, link) in (0u32..).zip(self.vertices.links(slot)) {
                let end = link.vertex();
                let knows = self.vertices.is_live(end)
                    && link.index() < 3
                    && self.vertices.link(end, link.index()).vertex() == slot
                    && self.vertices.link(end, link.index()).index() == k as usize
                    && self.vertices.planes(end).into_iter().filter(|plane| planes.contains(plane)).count() >= 2;
                if !knows {
                    return Err(TopologyError::EdgeValidity { edge: EdgeIdx(slot << 2 | k), vertex: VertexIdx(end) });
                }
            }
        }
        Ok(())
    }

    /// Every plane with a face has a ring of three corners or more in the simple structure; orphans have none.
    fn check_stored_faces(&self) -> Result<(), TopologyError> {
        let mut corners: BTreeMap<u32, usize> = BTreeMap::new();
        for slot in self.vertices.slots() {
            for plane in self.vertices.planes(slot) {
                *corners.entry(plane).or_default() += 1;
            }
        }
        let with_face = self.planes.faces().chain(corners.keys().copied().collect::<Vec<_>>());
        for plane in with_face.filter(|plane| !is_infinity(*plane)) {
            let start = self.planes.face_vertex(plane);
            let is_anchored = self.vertices.is_live(start) && self.vertices.planes(start).contains(&plane);
            // links are mutual, so that the ring closes; a face is one ring
            let vertices = if is_anchored { self.vertices.face_ring(plane, start).count() } else { 0 };
            if vertices < 3 || corners.get(&plane) != Some(&vertices) {
                return Err(TopologyError::FaceSize { plane: external(plane), vertices });
            }
        }
        Ok(())
    }

    /// Degrees of the seen vertices; gives the planes and edges of each.
    fn check_seen_vertices(&self) -> Result<BTreeMap<VertexIdx, Incidence>, TopologyError> {
        let mut incidence = BTreeMap::new();
        for (name, vertex) in self.vertices() {
            let planes = vertex.planes.len();
            if vertex.is_finite() && planes < 3 {
                return Err(TopologyError::VertexDegree { vertex: name, planes });
            }
            if !vertex.is_finite() && planes < 2 {
                return Err(TopologyError::IdealDegree { vertex: name, planes });
            }
            incidence.insert(name, Incidence { planes: vertex.planes, edges: vertex.edges });
        }
        Ok(incidence)
    }

    /// Ends and uniqueness of the seen edges; gives their number.
    fn check_seen_edges(&self, incidence: &BTreeMap<VertexIdx, Incidence>) -> Result<usize, TopologyError> {
        let mut by_planes = BTreeMap::new();
        let mut count = 0;
        for (name, edge) in self.edges() {
            count += 1;
            for vertex in [edge.vertices.0, edge.vertices.1] {
                let is_end = incidence.get(&vertex).is_some_and(|end| {
                    end.edges.binary_search(&name).is_ok()
                        && [edge.planes.0, edge.planes.1].iter().all(|plane| end.planes.binary_search(plane).is_ok())
                });
                if !is_end || edge.vertices.0 == edge.vertices.1 {
                    return Err(TopologyError::EdgeValidity { edge: name, vertex });
                }
            }
            if let Some(other) = by_planes.insert(edge.planes, name) {
                return Err(TopologyError::EdgeUniqueness { planes: edge.planes, edges: (other, name) });
            }
        }
        Ok(count)
    }

    /// Sizes of the seen faces, bounded ones by the vertices that name them; gives their number.
    fn check_seen_faces(&self, incidence: &BTreeMap<VertexIdx, Incidence>) -> Result<usize, TopologyError> {
        let mut corners: BTreeMap<PlaneIdx, usize> = BTreeMap::new();
        for plane in incidence.values().flat_map(|vertex| &vertex.planes) {
            *corners.entry(*plane).or_default() += 1;
        }
        let faces = self.faces();
        for face in &faces {
            let vertices = corners.remove(&face.plane).unwrap_or(0);
            let finite = face.vertices.len();
            if face.is_bounded && (vertices < 3 || finite != vertices) {
                return Err(TopologyError::FaceSize { plane: face.plane, vertices: finite.min(vertices) });
            }
        }
        match corners.into_iter().next() {
            Some((plane, vertices)) => Err(TopologyError::FaceSize { plane, vertices }),
            None => Ok(faces.len()),
        }
    }

    /// What `V − E + F` must be, from the normals alone; see the head of this file.
    fn expected_characteristic(&self) -> i64 {
        if self.is_bounded() {
            return 2;
        }
        let normals: Vec<&Row> = self.planes.slots().map(|plane| self.row(plane)).collect();
        let Some(&first) = normals.first() else { return 0 };
        let Some(second) = normals.iter().find(|normal| !are_parallel(first, normal)) else {
            let is_slab = normals.iter().any(|normal| are_opposite(first, normal));
            return if is_slab { 2 } else { 1 };
        };
        let is_flat = |normal: &&Row| crate::sign::orient3(first, second, normal) == Sign::Zero;
        if normals.iter().all(is_flat) && surround(&normals, first, second) { 0 } else { 1 }
    }
}

/// What a seen vertex touches.
struct Incidence {
    planes: Vec<PlaneIdx>,
    edges: Vec<EdgeIdx>,
}

fn are_parallel(a: &Row, b: &Row) -> bool {
    (0..3).all(|axis| cross_component(a, b, axis) == Sign::Zero)
}

fn are_opposite(a: &Row, b: &Row) -> bool {
    let (u, v) = (a.coefficients(), b.coefficients());
    are_parallel(a, b) && (0..3).any(|axis| u[axis] * v[axis] < 0.0)
}

/// Whether normals that all lie in the plane of `a` and `b` span it positively: turning from normal to normal, each time
/// as far as less than half a turn allows, one never comes to an end. Where they lie in a half-plane, the second
/// turn at the latest does.
fn surround(normals: &[&Row], a: &Row, b: &Row) -> bool {
    // all cross products are multiples of that of `a` and `b`: one component tells
    let component = (0..3).map(|axis| (axis, cross_component(a, b, axis))).find(|(_, sign)| *sign != Sign::Zero);
    let Some((axis, left)) = component else { return false };
    let turns_left = |from: &Row, to: &Row| cross_component(from, to, axis) == left;
    let mut at = a;
    for _ in 0..3 {
        let ahead = normals.iter().copied().filter(|normal| turns_left(at, normal));
        match ahead.reduce(|best, normal| if turns_left(best, normal) { normal } else { best }) {
            Some(farthest) => at = farthest,
            None => return false,
        }
    }
    true
}
