//! Closed triangle meshes: every edge closed, vertices joined where that takes it.

pub(crate) mod connectivity;
mod error;
mod rule;

use glam::DVec3;
use planecut_parallel::prelude::*;
use rustc_hash::FxHashMap;

use crate::ids::number32;
use connectivity::{HalfEdges, NO_TWIN, next};
pub use error::ClosedMeshError;
pub use rule::WindingRule;

/// Vertices or triangles that one thread looks at in a row.
const CHUNK: usize = 1 << 13;

/// A closed mesh: along every edge as many triangles run one way as the other. It may cross itself, lie upon itself, and be nested in itself.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ClosedMesh {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    surfaces: Vec<u32>,
    twins: Vec<u32>,
    stars: Vec<Star>,
}

/// The triangles around a vertex.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Star {
    /// A half-edge that starts there; [`NO_TWIN`] where none does.
    pub(crate) first: u32,
    /// How many do.
    pub(crate) degree: u32,
}

impl ClosedMesh {
    /// Makes sure that a mesh is closed. Where it is not by its indices, vertices are joined that are at the same place, to the bit, and
    /// triangles two of whose vertices are joined are left out. `surface` gives, from the place of a triangle in the list, the place
    /// of what it is made of in another list, the one of [`MeshBody`](crate::MeshBody).
    ///
    /// # Errors
    /// Where a coordinate is not finite, the mesh is too small, a vertex is missing, or an edge is open.
    pub fn new(
        positions: &[DVec3],
        triangles: &[[u32; 3]],
        surface: impl Fn(usize) -> u32,
    ) -> Result<Self, ClosedMeshError> {
        check(positions, triangles)?;
        if !triangles.par_iter().with_min_len(CHUNK).any(is_collapsed) {
            let half_edges = HalfEdges::new(positions.len(), triangles);
            let twins = half_edges.twins();
            if !twins.par_iter().with_min_len(CHUNK).any(|twin| *twin == NO_TWIN) {
                let surfaces = (0..triangles.len()).map(surface).collect();
                let stars = stars(positions.len(), &half_edges);
                return Ok(Self {
                    positions: positions.to_vec(),
                    triangles: triangles.to_vec(),
                    surfaces,
                    twins,
                    stars,
                });
            }
        }
        Self::joined(positions, triangles, surface)
    }

    /// The same with vertices joined.
    fn joined(
        positions: &[DVec3],
        triangles: &[[u32; 3]],
        surface: impl Fn(usize) -> u32,
    ) -> Result<Self, ClosedMeshError> {
        let (joined, positions) = join(positions);
        let mut sources = Vec::with_capacity(triangles.len());
        let mut kept = Vec::with_capacity(triangles.len());
        for (source, triangle) in triangles.iter().enumerate() {
            let triangle = triangle.map(|vertex| joined[vertex as usize]);
            if !is_collapsed(&triangle) {
                kept.push(triangle);
                sources.push(source);
            }
        }
        let half_edges = HalfEdges::new(positions.len(), &kept);
        let twins = half_edges.twins();
        if let Some((first, count)) = open_edges(&half_edges, &twins) {
            let [from, to] = [first, next(first)].map(|half_edge| positions[half_edges.from(half_edge) as usize]);
            return Err(ClosedMeshError::Open { triangle: sources[first as usize / 3], from, to, count });
        }
        let stars = stars(positions.len(), &half_edges);
        Ok(Self { positions, triangles: kept, surfaces: sources.into_iter().map(surface).collect(), twins, stars })
    }

    /// The places of vertices.
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

    /// The triangles around each vertex.
    pub(crate) fn stars(&self) -> &[Star] {
        &self.stars
    }
}

/// Least size of a mesh, `2^-240`, so that products of differences of its coordinates do not underflow.
const MIN_SIZE: f64 = f64::from_bits((1023 - 240) << 52);

/// Refuses coordinates that are not finite, meshes that are too small, and numbers of vertices that there are not.
fn check(positions: &[DVec3], triangles: &[[u32; 3]]) -> Result<(), ClosedMeshError> {
    if !positions.par_iter().with_min_len(CHUNK).all(|position| position.is_finite())
        && let Some(vertex) = positions.iter().position(|position| !position.is_finite())
    {
        return Err(ClosedMeshError::NotFinite { vertex, position: positions[vertex] });
    }
    let smallest = positions.iter().copied().reduce(DVec3::min).unwrap_or_default();
    let largest = positions.iter().copied().reduce(DVec3::max).unwrap_or_default();
    let size = (largest - smallest).max_element();
    if size > 0.0 && size < MIN_SIZE {
        return Err(ClosedMeshError::TooSmall { size });
    }
    let vertices = positions.len();
    let is_there = |triangle: &[u32; 3]| triangle.iter().all(|vertex| (*vertex as usize) < vertices);
    if !triangles.par_iter().with_min_len(CHUNK).all(is_there)
        && let Some(triangle) = triangles.iter().position(|triangle| !is_there(triangle))
    {
        let vertex = triangles[triangle].into_iter().max().unwrap_or(0);
        return Err(ClosedMeshError::NoVertex { triangle, vertex, vertices });
    }
    Ok(())
}

fn is_collapsed([a, b, c]: &[u32; 3]) -> bool {
    a == b || b == c || c == a
}

fn stars(vertices: usize, half_edges: &HalfEdges<'_>) -> Vec<Star> {
    let star = |vertex: u32| Star {
        first: half_edges.leaving(vertex).first().copied().unwrap_or(NO_TWIN),
        degree: half_edges.degree(vertex),
    };
    (0..number32(vertices)).into_par_iter().with_min_len(CHUNK).map(star).collect()
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

/// The first of the half-edges along open edges, and how many of these edges there are. Edges of more than two triangles are closed where
/// as many run one way as the other.
fn open_edges(half_edges: &HalfEdges<'_>, twins: &[u32]) -> Option<(u32, usize)> {
    let lone = (0..number32(twins.len())).filter(|h| twins[*h as usize] == NO_TWIN);
    let mut uses: FxHashMap<[u32; 2], (i32, u32)> = FxHashMap::default();
    for half_edge in lone {
        let (a, b) = (half_edges.from(half_edge), half_edges.to(half_edge));
        let entry = uses.entry([a.min(b), a.max(b)]).or_insert((0, half_edge));
        entry.0 += if a < b { 1 } else { -1 };
    }
    let open = uses.values().filter(|(sum, _)| *sum != 0).map(|(_, half_edge)| *half_edge);
    open.clone().min().map(|first| (first, open.count()))
}
