//! Closed triangle meshes: vertices joined, every edge closed.

pub(crate) mod connectivity;
mod error;
mod rule;

use glam::DVec3;
use rustc_hash::FxHashMap;

use crate::ids::number32;
use connectivity::{HalfEdges, NO_TWIN, next};
pub use error::ClosedMeshError;
pub use rule::WindingRule;

/// A closed mesh: along every edge as many triangles run one way as the other. It may cross itself, lie upon itself, and be nested in itself.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ClosedMesh {
    /// The places of vertices; no two are the same.
    positions: Vec<DVec3>,
    /// The vertices of each triangle, counter-clockwise seen from outside.
    triangles: Vec<[u32; 3]>,
    /// What the surface of each triangle is made of, as a place in a list that whoever uses the mesh has.
    surfaces: Vec<u32>,
    /// For each half-edge the one that runs back along the same edge, where there is exactly one of both.
    twins: Vec<u32>,
}

impl ClosedMesh {
    /// Joins vertices that are at the same place, to the bit, and makes sure that the mesh is closed. Triangles two of whose vertices
    /// are joined are left out. `surface` gives, from the place of a triangle in the list, the place of what it is made of in another list,
    /// the one of [`MeshBody`](crate::MeshBody).
    ///
    /// # Errors
    /// Where a coordinate is not finite, a vertex is missing, or an edge is open.
    pub fn new(
        positions: &[DVec3],
        triangles: &[[u32; 3]],
        surface: impl Fn(usize) -> u32,
    ) -> Result<Self, ClosedMeshError> {
        if let Some(vertex) = positions.iter().position(|position| !position.is_finite()) {
            return Err(ClosedMeshError::NotFinite { vertex, position: positions[vertex] });
        }
        let vertices = positions.len();
        let is_missing = |triangle: &[u32; 3]| triangle.iter().any(|vertex| *vertex as usize >= vertices);
        if let Some(triangle) = triangles.iter().position(is_missing) {
            let vertex = triangles[triangle].into_iter().max().unwrap_or(0);
            return Err(ClosedMeshError::NoVertex { triangle, vertex, vertices });
        }
        let (joined, places) = join(positions);
        let mut kept = Vec::with_capacity(triangles.len());
        let mut surfaces = Vec::with_capacity(triangles.len());
        for (source, triangle) in triangles.iter().enumerate() {
            let [a, b, c] = triangle.map(|vertex| joined[vertex as usize]);
            if a != b && b != c && c != a {
                kept.push([a, b, c]);
                surfaces.push(surface(source));
            }
        }
        match closed_twins(&places, &kept) {
            Ok(twins) => Ok(Self { positions: places, triangles: kept, surfaces, twins }),
            Err((half_edge, count)) => {
                let corners = kept[half_edge / 3];
                let [from, to] = [half_edge % 3, (half_edge + 1) % 3].map(|k| corners[k]);
                let is_whole = |triangle: &[u32; 3]| {
                    let [a, b, c] = triangle.map(|vertex| joined[vertex as usize]);
                    a != b && b != c && c != a
                };
                let whole = triangles.iter().enumerate().filter(|(_, triangle)| is_whole(triangle));
                let triangle = whole.map(|(source, _)| source).nth(half_edge / 3).unwrap_or(0);
                let [from, to] = [from, to].map(|vertex| places[vertex as usize]);
                Err(ClosedMeshError::Open { triangle, from, to, count })
            }
        }
    }

    /// The places of vertices; no two are the same.
    #[must_use]
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// The vertices of each triangle, counter-clockwise seen from outside.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// For each triangle the place of what it is made of in a list of surfaces.
    #[must_use]
    pub fn surfaces(&self) -> &[u32] {
        &self.surfaces
    }

    /// For each half-edge the one that runs back along the same edge, where there is exactly one of both.
    pub(crate) fn twins(&self) -> &[u32] {
        &self.twins
    }
}

/// For each vertex the number of its place, and the places.
fn join(positions: &[DVec3]) -> (Vec<u32>, Vec<DVec3>) {
    let mut number: FxHashMap<[u64; 3], u32> = FxHashMap::default();
    number.reserve(positions.len());
    let mut places = Vec::with_capacity(positions.len());
    let mut of = |position: &DVec3| {
        *number.entry((*position + 0.0).to_array().map(f64::to_bits)).or_insert_with(|| {
            places.push(*position + 0.0);
            number32(places.len()) - 1
        })
    };
    let joined = positions.iter().map(&mut of).collect();
    (joined, places)
}

/// The twins of half-edges, where every edge is closed; otherwise the first open half-edge, and how many open edges there are.
fn closed_twins(positions: &[DVec3], triangles: &[[u32; 3]]) -> Result<Vec<u32>, (usize, usize)> {
    let half_edges = HalfEdges::new(positions.len(), triangles);
    let twins = half_edges.twins();
    // edges of more than two triangles are closed where as many run one way as the other
    let lone = (0..number32(twins.len())).filter(|h| twins[*h as usize] == NO_TWIN);
    let mut uses: FxHashMap<[u32; 2], (i32, u32)> = FxHashMap::default();
    for half_edge in lone {
        let (a, b) = (half_edges.from(half_edge), half_edges.from(next(half_edge)));
        let entry = uses.entry([a.min(b), a.max(b)]).or_insert((0, half_edge));
        entry.0 += if a < b { 1 } else { -1 };
    }
    let open = uses.values().filter(|(sum, _)| *sum != 0).map(|(_, half_edge)| *half_edge as usize);
    match open.clone().min() {
        None => Ok(twins),
        Some(first) => Err((first, open.count())),
    }
}
