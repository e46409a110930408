//! Closed meshes as operands: vertices joined, every edge closed.

use glam::DVec3;
use planecut_parallel::prelude::*;
use rustc_hash::FxHashMap;

use super::predicates::best_axis;
use super::surface::{Surface, are_safe};
use super::triangle_tree::TriangleTree;
use crate::ids::{Id, PointId, TriangleId, number32};
use crate::mesh::connectivity::{HalfEdges, NO_TWIN, next};
use crate::model::MaterialId;

/// Why triangles are not the boundary of a solid.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ClosedMeshError {
    /// A coordinate is infinite or not a number.
    #[error("vertex {vertex} is at {position}, which is not finite")]
    NotFinite {
        /// The vertex.
        vertex: usize,
        /// Where it is.
        position: DVec3,
    },
    /// A triangle refers to a vertex that there is not.
    #[error("triangle {triangle} refers to vertex {vertex} of {vertices}")]
    NoVertex {
        /// The triangle.
        triangle: usize,
        /// The vertex.
        vertex: u32,
        /// The number of vertices.
        vertices: usize,
    },
    /// Along an edge more triangles run one way than the other.
    #[error("the mesh is not closed: {count} open edges, the first one from {from} to {to}")]
    Open {
        /// Where the first open edge begins.
        from: DVec3,
        /// Where it ends.
        to: DVec3,
        /// The number of open edges.
        count: usize,
    },
}

/// A closed mesh: along every edge as many triangles run one way as the other. It may cross itself, and be nested in itself.
#[derive(Debug, Clone, Default)]
pub struct ClosedMesh {
    /// The places of vertices; no two are the same.
    positions: Vec<DVec3>,
    /// The vertices of each triangle, counter-clockwise seen from outside.
    triangles: Vec<[u32; 3]>,
    /// The material of each triangle.
    materials: Vec<MaterialId>,
    twins: Vec<u32>,
    tree: TriangleTree,
    is_flat: Vec<bool>,
    is_safe: bool,
}

impl ClosedMesh {
    /// Joins vertices that are at the same place, to the bit, and makes sure that the mesh is closed. Triangles two of whose vertices
    /// are joined are left out. `material` gives the material of a triangle from its place in the list.
    ///
    /// # Errors
    /// Where a coordinate is not finite, a vertex is missing, or an edge is open.
    pub fn new(
        positions: &[DVec3],
        triangles: &[[u32; 3]],
        material: impl Fn(usize) -> MaterialId,
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
        let mut materials = Vec::with_capacity(triangles.len());
        for (source, triangle) in triangles.iter().enumerate() {
            let [a, b, c] = triangle.map(|vertex| joined[vertex as usize]);
            if a != b && b != c && c != a {
                kept.push([a, b, c]);
                materials.push(material(source));
            }
        }
        let twins = closed_twins(&places, &kept)?;
        let is_safe = are_safe(&places);
        let mut mesh = Self { positions: places, triangles: kept, materials, twins, is_safe, ..Self::default() };
        mesh.find_flat();
        let with_area: Vec<u32> = (0..number32(mesh.triangles.len())).filter(|t| !mesh.is_flat[*t as usize]).collect();
        mesh.tree = TriangleTree::new(&with_area, |t| mesh.triangles[t as usize].map(|v| mesh.positions[v as usize]));
        Ok(mesh)
    }

    /// The number of triangles.
    #[must_use]
    pub fn triangles(&self) -> usize {
        self.triangles.len()
    }

    fn find_flat(&mut self) {
        let surface = surface(&[self]).0;
        let is_flat = |k: usize| best_axis(&surface, TriangleId::from_index(k)).is_none();
        self.is_flat = (0..self.triangles.len()).into_par_iter().with_min_len(1 << 12).map(is_flat).collect();
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

/// The twins of half-edges, where every edge is closed.
fn closed_twins(positions: &[DVec3], triangles: &[[u32; 3]]) -> Result<Vec<u32>, ClosedMeshError> {
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
    let mut open: Vec<u32> = uses.values().filter(|(sum, _)| *sum != 0).map(|(_, half_edge)| *half_edge).collect();
    open.sort_unstable();
    match open.first() {
        None => Ok(twins),
        Some(&first) => {
            let [from, to] = [first, next(first)].map(|h| positions[half_edges.from(h) as usize]);
            Err(ClosedMeshError::Open { from, to, count: open.len() })
        }
    }
}

/// All triangles of operands, with vertices joined between operands whose boxes touch; and which of them have no area.
pub(super) fn surface(meshes: &[&ClosedMesh]) -> (Surface, Vec<bool>) {
    let mut all = Surface { is_safe: meshes.iter().all(|mesh| mesh.is_safe), ..Surface::default() };
    let mut is_flat = Vec::new();
    let boxes: Vec<crate::base::Bounds> = meshes.iter().map(|mesh| mesh.tree.all_bounds()).collect();
    let tree = crate::base::Boxes::new(boxes);
    let mut near = Vec::new();
    let mut known: FxHashMap<[u64; 3], PointId> = FxHashMap::default();
    for (operand, mesh) in (0..).zip(meshes) {
        let mut number: Vec<PointId> = Vec::with_capacity(mesh.positions.len());
        let bounds = mesh.tree.all_bounds();
        tree.touching(&bounds, &mut near);
        let common: Vec<crate::base::Bounds> =
            near.iter().filter(|k| **k != operand).map(|k| tree.get(*k).intersection(&bounds)).collect();
        let is_common = |p: &DVec3| common.iter().any(|b| b.min.cmple(*p).all() && p.cmple(b.max).all());
        for position in &mesh.positions {
            let fresh = PointId::from_index(all.positions.len());
            let joined = if is_common(position) {
                *known.entry(position.to_array().map(f64::to_bits)).or_insert(fresh)
            } else {
                fresh
            };
            if joined == fresh {
                all.positions.push(*position);
            }
            number.push(joined);
        }
        let sides = 3 * number32(all.corners.len());
        all.corners.extend(mesh.triangles.iter().map(|triangle| triangle.map(|v| number[v as usize])));
        all.twins.extend(mesh.twins.iter().map(|twin| if *twin == NO_TWIN { NO_TWIN } else { twin + sides }));
        all.operands.extend(std::iter::repeat_n(operand, mesh.triangles.len()));
        all.materials.extend(&mesh.materials);
        is_flat.extend(&mesh.is_flat);
    }
    (all, is_flat)
}

/// The hierarchies of boxes of operands, with triangles numbered as in their common surface.
pub(super) fn trees(meshes: &[&ClosedMesh]) -> Vec<TriangleTree> {
    let mut first = 0;
    let of = |mesh: &&ClosedMesh| {
        let tree = mesh.tree.renumbered(first);
        first += number32(mesh.triangles.len());
        tree
    };
    meshes.iter().map(of).collect()
}
