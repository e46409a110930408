//! Collapse of noise that is not a disk: tunnels and bubbles between planes that were meant to meet.
//!
//! Four rounded planes through one corner leave edges of `1e-16`; those are contracted one by one ([`super::contract`]), as
//! long as the surface stays what it is. More planes can leave a tunnel, a bridge or a bubble of that size, which no single
//! contraction may close. Here all corners that short edges join become one place; triangles that lose their area go, the
//! sides of what is left are joined through what went, and each fan of triangles gets a vertex of its own.

use crate::ids::number32;
use rustc_hash::FxHashMap;

use super::Mesh;
use super::noise::{Noise, noise_edges};
use crate::base::DisjointSets;
use crate::closed_mesh::connectivity::{HalfEdges, NO_TWIN, next};
use crate::model::MaterialId;

/// No half-edge or vertex yet.
const NONE: u32 = u32::MAX;

/// Collapses what is joined by edges that are rounding noise, changing the topology where it must: tunnels, gaps, bridges and bubbles
/// that thin go. A closed, oriented 2-manifold stays one; of any other mesh it gives back nothing. What is at walls stays.
pub(super) fn collapse_thin(mesh: &mut Mesh, walls: Option<MaterialId>, noise: &mut Noise) -> Option<()> {
    let Some(place) = places(mesh, walls) else { return Some(()) };
    for (at, place) in mesh.positions.iter().zip(&place) {
        let moved = at.distance(mesh.positions[*place as usize]);
        noise.add(usize::from(moved > 0.0), moved);
    }
    let twins = HalfEdges::new(mesh.positions.len(), &mesh.triangles).twins();
    if twins.contains(&NO_TWIN) {
        return None;
    }
    let at = |h: u32| place[mesh.triangles[(h / 3) as usize][(h % 3) as usize] as usize];
    let corners = |t: u32| [at(3 * t), at(3 * t + 1), at(3 * t + 2)];
    let is_kept = |t: u32| {
        let [a, b, c] = corners(t);
        a != b && b != c && c != a
    };
    // From a side of a triangle between two places on through its other side between them.
    let across = |h: u32| {
        let side = [next(h), next(next(h))].into_iter().find(|side| at(*side) != at(next(*side)));
        twins[side.expect("two sides of three join two places") as usize]
    };
    let count = number32(mesh.triangles.len());
    let kept: Vec<u32> = (0..count).filter(|t| is_kept(*t)).collect();
    let mut number = vec![NONE; count as usize];
    for (new, old) in kept.iter().enumerate() {
        number[*old as usize] = number32(new);
    }
    let mut joined = Joined {
        places: kept.iter().map(|t| corners(*t)).collect(),
        faces: kept.iter().map(|t| mesh.triangle_faces[*t as usize]).collect(),
        twins: Vec::with_capacity(3 * kept.len()),
        midpoints: Vec::new(),
        first_midpoint: number32(mesh.positions.len()),
    };
    for h in kept.iter().flat_map(|t| [3 * t, 3 * t + 1, 3 * t + 2]) {
        let mut twin = twins[h as usize];
        while !is_kept(twin / 3) {
            twin = across(twin);
        }
        joined.twins.push(3 * number[(twin / 3) as usize] + twin % 3);
    }
    joined.split_repeated(mesh);
    joined.write(mesh);
    Some(())
}

/// For each vertex the least one that edges of noise join it with; nothing where there are no such edges.
fn places(mesh: &Mesh, walls: Option<MaterialId>) -> Option<Vec<u32>> {
    let edges = noise_edges(mesh, walls);
    let mut sets = DisjointSets::new(mesh.positions.len());
    edges.iter().for_each(|edge| sets.join(edge.ends[0], edge.ends[1]));
    (!edges.is_empty()).then(|| (0..number32(mesh.positions.len())).map(|v| sets.root(v)).collect())
}

/// Triangles between places, joined by their sides.
struct Joined {
    places: Vec<[u32; 3]>,
    faces: Vec<u32>,
    twins: Vec<u32>,
    /// Places that were added in the middle of others.
    midpoints: Vec<[u32; 2]>,
    first_midpoint: u32,
}

impl Joined {
    fn ends(&self, h: u32) -> (u32, u32) {
        let places = &self.places[(h / 3) as usize];
        (places[(h % 3) as usize], places[((h + 1) % 3) as usize])
    }

    /// Gives each fan its vertex: the one at the start of each half-edge, and the place of each vertex.
    fn fans(&self) -> (Vec<u32>, Vec<u32>) {
        let mut vertex = vec![NONE; self.twins.len()];
        let mut places = Vec::new();
        for start in 0..number32(vertex.len()) {
            let mut h = start;
            if vertex[h as usize] == NONE {
                places.push(self.ends(h).0);
            }
            while vertex[h as usize] == NONE {
                vertex[h as usize] = number32(places.len()) - 1;
                h = next(self.twins[h as usize]);
            }
        }
        (vertex, places)
    }

    /// Puts a midpoint into every edge but the first that joins the same two vertices.
    fn split_repeated(&mut self, mesh: &Mesh) {
        loop {
            let (vertex, _) = self.fans();
            let mut seen: FxHashMap<(u32, u32), u32> = FxHashMap::default();
            let mut repeated = Vec::new();
            for h in 0..number32(self.twins.len()) {
                let (a, b) = (vertex[h as usize], vertex[next(h) as usize]);
                if a < b && seen.insert((a, b), h).is_some() {
                    repeated.push(h);
                }
            }
            if repeated.is_empty() {
                return;
            }
            for h in repeated {
                self.split(h);
            }
            debug_assert_eq!(self.first_midpoint as usize, mesh.positions.len());
        }
    }

    /// Splits the two triangles at a half-edge by its midpoint.
    fn split(&mut self, h: u32) {
        let back = self.twins[h as usize];
        let (a, b) = self.ends(h);
        let middle = self.first_midpoint + number32(self.midpoints.len());
        self.midpoints.push([a, b]);
        let halves = [h, back].map(|h| self.split_triangle(h, middle));
        // the near half of each side lies against the far half of the other
        for k in 0..2 {
            let (near, far) = ([h, back][k], halves[1 - k]);
            self.twins[near as usize] = far;
            self.twins[far as usize] = near;
        }
    }

    /// Cuts the triangle of a half-edge `a → b` from the middle to its tip; it keeps `a`. Gives the half-edge from the middle
    /// to `b`.
    fn split_triangle(&mut self, h: u32, middle: u32) -> u32 {
        let (t, k) = ((h / 3) as usize, (h % 3) as usize);
        let (far, side) = (self.places[t][(k + 1) % 3], next(h));
        let tip = self.places[t][(k + 2) % 3];
        let added = 3 * number32(self.places.len());
        self.places[t][(k + 1) % 3] = middle;
        self.places.push([middle, far, tip]);
        self.faces.push(self.faces[t]);
        // far → tip moves to the new triangle, and middle → tip comes in its place
        let outer = self.twins[side as usize];
        self.twins.extend([NONE, outer, side]);
        self.twins[outer as usize] = added + 1;
        self.twins[side as usize] = added + 2;
        added
    }

    /// Makes this the mesh: triangles of a face follow one another, faces without triangles go.
    fn write(mut self, mesh: &mut Mesh) {
        let (vertex, places) = self.fans();
        let mut positions = std::mem::take(&mut mesh.positions);
        for [a, b] in std::mem::take(&mut self.midpoints) {
            positions.push(0.5 * (positions[a as usize] + positions[b as usize]));
        }
        mesh.positions = places.iter().map(|place| positions[*place as usize]).collect();
        let mut order: Vec<usize> = (0..self.faces.len()).collect();
        order.sort_by_key(|t| self.faces[*t]);
        mesh.triangles = order.iter().map(|t| [0, 1, 2].map(|k| vertex[3 * t + k])).collect();
        mesh.triangle_faces = order.iter().map(|t| self.faces[*t]).collect();
        mesh.drop_empty_faces();
    }
}
