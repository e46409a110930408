//! What is seen from outside: vertices, edges and faces with coincident vertices merged and infinity planes hidden.
//!
//! Vertices joined by an edge of exactly zero length are one; edges shorter than the tolerance are contracted as well,
//! which cannot break the topology of a convex polytope. Planes that only touch an edge or a corner have no face.

use glam::{DVec3, DVec4};

use super::infinity::is_infinity;
use super::store::{NONE, PlaneState};
use super::{IncrementalPolytope, PlaneIdx, external};
use crate::meet::{direction, meet};

/// A vertex as seen from outside.
#[derive(Debug, Clone, PartialEq)]
pub struct Vertex {
    /// Homogeneous position: `(x, y, z, 1)`, or for an ideal vertex (the end of a ray) its unit direction `(x, y, z, 0)`.
    pub position: DVec4,
    /// The planes with a face at the vertex: at least three, at least two for an ideal one.
    pub planes: Vec<PlaneIdx>,
}

/// A face of a bounded polytope.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Face {
    /// The plane it lies on.
    pub plane: PlaneIdx,
    /// Its corners, counter-clockwise seen from outside, as indices into the vertices that
    /// [`IncrementalPolytope::to_mesh`] gives.
    pub vertices: Vec<usize>,
}

/// Which reported vertex each vertex of the simple structure belongs to.
struct Merged {
    /// By slot; [`NONE`] for a free slot or a vertex on two or more infinity planes.
    vertex: Vec<u32>,
    /// The slot that stands for each reported vertex, finite ones first.
    representative: Vec<u32>,
    finite: usize,
}

impl IncrementalPolytope {
    /// How many vertices are seen: finite ones and the ideal ends of rays and lines.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.merged().representative.len()
    }

    /// How many edges are seen: segments, rays and lines.
    #[must_use]
    pub fn edge_count(&self) -> usize {
        let merged = self.merged();
        let mut edges = self.visible_edges(&merged);
        edges.sort_unstable();
        edges.dedup();
        edges.len()
    }

    /// The vertices seen from outside, finite ones first.
    #[must_use]
    pub fn vertices(&self) -> Vec<Vertex> {
        let merged = self.merged();
        let mut planes: Vec<Vec<u32>> = vec![Vec::new(); merged.representative.len()];
        for slot in self.vertices.slots() {
            if merged.vertex[slot as usize] != NONE {
                let finite = self.vertices.planes[slot as usize].into_iter().filter(|p| !is_infinity(*p));
                planes[merged.vertex[slot as usize] as usize].extend(finite);
            }
        }
        let of = |(slot, mut planes): (&u32, Vec<u32>)| {
            planes.sort_unstable();
            planes.dedup();
            Vertex { position: self.position(*slot), planes: planes.into_iter().map(external).collect() }
        };
        merged.representative.iter().zip(planes).map(of).collect()
    }

    /// The finite vertices and the faces among them, each counter-clockwise seen from outside, by plane.
    ///
    /// For a bounded polytope this is its whole boundary. The coordinates are correctly rounded.
    #[must_use]
    pub fn to_mesh(&self) -> (Vec<DVec3>, Vec<Vec<usize>>) {
        let merged = self.merged();
        let faces = self.faces_of(&merged).into_iter().map(|face| face.vertices).collect();
        let positions = merged.representative[..merged.finite].iter().map(|slot| self.position(*slot).truncate());
        (positions.collect(), faces)
    }

    /// The faces that have an area, by plane; corners index the vertices of [`to_mesh`](Self::to_mesh).
    #[must_use]
    pub fn faces(&self) -> Vec<Face> {
        self.faces_of(&self.merged())
    }

    /// The vertices of the simple (perturbed) structure: the three planes of each, counter-clockwise seen from outside;
    /// `None` stands for an infinity plane. Empty where the set is.
    pub fn simple_vertices(&self) -> impl Iterator<Item = [Option<PlaneIdx>; 3]> {
        let shown = if self.is_empty() { 0 } else { usize::MAX };
        self.vertices
            .slots()
            .take(shown)
            .map(|slot| self.vertices.planes[slot as usize].map(|p| (!is_infinity(p)).then(|| external(p))))
    }

    /// The faces that have an area, exactly: for each its plane and the planes of its edges, counter-clockwise seen from
    /// outside. Edges of exactly zero length are left out; the tolerance takes no part. Corner `i` is where the plane and
    /// the edge planes `i` and `i + 1` meet, right-handed in this order. Infinity planes are `None`.
    #[must_use]
    pub fn facets(&self) -> Vec<(PlaneIdx, Vec<Option<PlaneIdx>>)> {
        let mut facets = Vec::new();
        for (slot, state) in self.planes.state.iter().enumerate() {
            let plane = slot as u32;
            if self.is_empty() || *state != PlaneState::Face || is_infinity(plane) {
                continue;
            }
            let mut edges = Vec::new();
            for vertex in self.vertices.face_ring(plane, self.planes.face_vertex[slot]) {
                // the edge from this vertex (plane, p, q) to the next lies on q
                let k = self.vertices.index_of(vertex, plane);
                let planes = self.vertices.planes[vertex as usize];
                let next = self.vertices.neighbours[vertex as usize][(k + 1) % 3];
                let across = self.vertices.planes[next as usize];
                let j = self.vertices.index_of(next, plane);
                if !self.is_exactly_on(planes, across[(j + 2) % 3]) {
                    let q = planes[(k + 2) % 3];
                    edges.push((!is_infinity(q)).then(|| external(q)));
                }
            }
            if edges.len() >= 3 {
                facets.push((external(plane), edges));
            }
        }
        facets
    }

    /// The homogeneous position of a vertex of the simple structure.
    fn position(&self, slot: u32) -> DVec4 {
        let planes = self.vertices.planes[slot as usize];
        if let Some(k) = planes.iter().position(|p| is_infinity(*p)) {
            // of the planes (M, b, c) the last two carry the ray, which runs along their cross product
            return direction(self.row(planes[(k + 1) % 3]), self.row(planes[(k + 2) % 3])).extend(0.0);
        }
        let [a, b, c] = planes.map(|p| self.row(p));
        meet(a, b, c).expect("the normals at a vertex are independent").extend(1.0)
    }

    fn merged(&self) -> Merged {
        let slots = self.vertices.planes.len();
        let mut merged = Merged { vertex: vec![NONE; slots], representative: Vec::new(), finite: 0 };
        if self.is_empty() {
            return merged;
        }
        let mut parent: Vec<u32> = (0..slots as u32).collect();
        for slot in self.vertices.slots() {
            for (k, neighbour) in self.vertices.neighbours[slot as usize].into_iter().enumerate() {
                if slot < neighbour && self.is_contracted(slot, k, neighbour) {
                    let (a, b) = (root(&mut parent, slot), root(&mut parent, neighbour));
                    parent[a.max(b) as usize] = a.min(b);
                }
            }
        }
        for ideal in [false, true] {
            for slot in self.vertices.slots().filter(|slot| self.infinity_planes(*slot) == usize::from(ideal)) {
                let first = root(&mut parent, slot) as usize;
                if merged.vertex[first] == NONE {
                    merged.vertex[first] = merged.representative.len() as u32;
                    merged.representative.push(slot);
                }
                merged.vertex[slot as usize] = merged.vertex[first];
            }
            if !ideal {
                merged.finite = merged.representative.len();
            }
        }
        merged
    }

    fn infinity_planes(&self, slot: u32) -> usize {
        self.vertices.planes[slot as usize].into_iter().filter(|p| is_infinity(*p)).count()
    }

    /// Whether the edge across index `k` of a vertex has no length, or less than the tolerance.
    fn is_contracted(&self, slot: u32, k: usize, neighbour: u32) -> bool {
        if self.infinity_planes(slot) != self.infinity_planes(neighbour) || self.infinity_planes(slot) > 1 {
            return false;
        }
        let planes = self.vertices.planes[slot as usize];
        let [p, q] = [planes[(k + 1) % 3], planes[(k + 2) % 3]];
        let across = self.vertices.planes[neighbour as usize].into_iter().find(|r| *r != p && *r != q);
        if across.is_some_and(|r| self.is_exactly_on(planes, r)) {
            return true;
        }
        !self.vertices.is_ideal(slot) && self.position(slot).distance(self.position(neighbour)) < self.epsilon
    }

    /// Pairs of different reported vertices joined by an edge between two finite planes.
    fn visible_edges(&self, merged: &Merged) -> Vec<(u32, u32)> {
        let mut edges = Vec::new();
        for slot in self.vertices.slots() {
            let planes = self.vertices.planes[slot as usize];
            for (k, neighbour) in self.vertices.neighbours[slot as usize].into_iter().enumerate() {
                let hidden = is_infinity(planes[(k + 1) % 3]) || is_infinity(planes[(k + 2) % 3]);
                let (a, b) = (merged.vertex[slot as usize], merged.vertex[neighbour as usize]);
                if !hidden && a < b && b != NONE {
                    edges.push((a, b));
                }
            }
        }
        edges
    }

    fn faces_of(&self, merged: &Merged) -> Vec<Face> {
        let mut faces = Vec::new();
        if self.is_empty() {
            return faces;
        }
        for (slot, state) in self.planes.state.iter().enumerate() {
            if *state != PlaneState::Face || is_infinity(slot as u32) {
                continue;
            }
            let mut vertices: Vec<usize> = Vec::new();
            for vertex in self.vertices.face_ring(slot as u32, self.planes.face_vertex[slot]) {
                let seen = merged.vertex[vertex as usize];
                if seen != NONE && (seen as usize) < merged.finite && vertices.last() != Some(&(seen as usize)) {
                    vertices.push(seen as usize);
                }
            }
            while vertices.len() > 1 && vertices.first() == vertices.last() {
                vertices.pop();
            }
            if vertices.len() >= 3 {
                faces.push(Face { plane: external(slot as u32), vertices });
            }
        }
        faces
    }
}

/// The root of a union-find tree, halving the path.
fn root(parent: &mut [u32], mut slot: u32) -> u32 {
    while parent[slot as usize] != slot {
        let above = parent[parent[slot as usize] as usize];
        parent[slot as usize] = above;
        slot = above;
    }
    slot
}
