//! A mesh as a renderer wants it: vertices split so that each face has its own flat normal.

use std::ops::Range;

use glam::DVec3;
use planecut_csg::{MaterialId, Mesh};

use super::origin::choose_origin;
use crate::ExportError;
use crate::single_precision::without_lost_edges;
use crate::topology::is_oriented_manifold;

/// Marks a mesh vertex that no triangle has used yet.
const NONE: u32 = u32::MAX;

/// Vertex and index arrays of one mesh, with what is needed to undo the splitting.
pub(super) struct Geometry {
    /// The point that `positions` are relative to; exact in single precision.
    pub(super) origin: DVec3,
    /// One per split vertex.
    pub(super) positions: Vec<[f32; 3]>,
    /// Unit normals, as many as positions.
    pub(super) normals: Vec<[f32; 3]>,
    /// Corners of the triangles, grouped by material.
    pub(super) indices: Vec<u32>,
    /// The part of `indices` that each used material has.
    pub(super) runs: Vec<(MaterialId, Range<usize>)>,
    /// For a closed, oriented 2-manifold: pairs `(place in indices, vertex)` in rising order, which turn `indices` into
    /// the manifold's own. `None` for any other mesh.
    pub(super) merges: Option<Vec<(u32, u32)>>,
}

impl Geometry {
    /// Splits the vertices of a checked mesh. Edges that single precision cannot hold are contracted; triangles that name a
    /// vertex twice have no area by construction and are left out.
    pub(super) fn new(mesh: &Mesh) -> Result<Self, ExportError> {
        let origin = choose_origin(&mesh.positions);
        let mesh = &*without_lost_edges(mesh, |position| (position - origin).as_vec3());
        let order = triangles_by_material(mesh);
        let points = relative_positions(&mesh.positions, origin)?;
        let mut splitter = Splitter::new(points, 3 * order.len());
        let mut runs: Vec<(MaterialId, Range<usize>)> = Vec::new();
        for &triangle in &order {
            let face = mesh.triangle_faces[triangle as usize];
            let material = mesh.faces[face as usize].material;
            let start = splitter.indices.len();
            splitter.push(mesh.triangles[triangle as usize], face, mesh.faces[face as usize].normal);
            match runs.last_mut() {
                Some((last, range)) if *last == material => range.end += 3,
                _ => runs.push((material, start..start + 3)),
            }
        }
        splitter.check_size()?;
        let manifold: Vec<_> = order.iter().map(|&triangle| mesh.triangles[triangle as usize]).collect();
        let merges = is_oriented_manifold(&manifold).then(|| splitter.merges(&manifold));
        let Splitter { positions, normals, indices, .. } = splitter;
        Ok(Self { origin, positions, normals, indices, runs, merges })
    }
}

/// Numbers of the triangles with three different corners, ordered by material, then as in the mesh.
fn triangles_by_material(mesh: &Mesh) -> Vec<u32> {
    let mut order: Vec<u32> = (0..)
        .zip(&mesh.triangles)
        .filter(|(_, [a, b, c])| a != b && b != c && c != a)
        .map(|(triangle, _)| triangle)
        .collect();
    order.sort_by_key(|&triangle| mesh.faces[mesh.triangle_faces[triangle as usize] as usize].material);
    order
}

fn relative_positions(positions: &[DVec3], origin: DVec3) -> Result<Vec<[f32; 3]>, ExportError> {
    let convert = |(vertex, &position): (usize, &DVec3)| {
        let relative = position - origin;
        // Adding zero turns -0 into 0, which some JSON readers do not tell from it in the bounds.
        let single = relative.as_vec3() + glam::Vec3::ZERO;
        if single.is_finite() {
            return Ok(single.to_array());
        }
        Err(ExportError::CoordinateRange { vertex, value: relative[relative.abs().max_position()] })
    };
    positions.iter().enumerate().map(convert).collect()
}

/// Gives each mesh vertex one copy per face that uses it.
struct Splitter {
    /// Single-precision position of each mesh vertex.
    points: Vec<[f32; 3]>,
    /// For each mesh vertex the face of its latest copy, and the copy. Triangles of a face follow one another, so
    /// looking back by one face suffices.
    latest: Vec<(u32, u32)>,
    /// For each mesh vertex its first copy, which stands for it in the manifold.
    first: Vec<u32>,
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    indices: Vec<u32>,
}

impl Splitter {
    fn new(points: Vec<[f32; 3]>, corners: usize) -> Self {
        let vertices = points.len();
        Self {
            points,
            latest: vec![(NONE, NONE); vertices],
            first: vec![NONE; vertices],
            positions: Vec::with_capacity(corners),
            normals: Vec::with_capacity(corners),
            indices: Vec::with_capacity(corners),
        }
    }

    fn push(&mut self, corners: [u32; 3], face: u32, normal: DVec3) {
        for corner in corners {
            let vertex = corner as usize;
            if self.latest[vertex].0 != face {
                let copy = self.positions.len() as u32;
                self.latest[vertex] = (face, copy);
                if self.first[vertex] == NONE {
                    self.first[vertex] = copy;
                }
                self.positions.push(self.points[vertex]);
                self.normals.push(normal.normalize().as_vec3().to_array());
            }
            self.indices.push(self.latest[vertex].1);
        }
    }

    /// Numbers of vertices and of places in the index list must hold in 32 bits, with one value to spare.
    fn check_size(&self) -> Result<(), ExportError> {
        if self.indices.len() < NONE as usize {
            return Ok(());
        }
        Err(ExportError::TooLarge { what: format!("{} triangle corners in a glTF mesh", self.indices.len()) })
    }

    fn merges(&self, manifold: &[[u32; 3]]) -> Vec<(u32, u32)> {
        let corners = manifold.iter().flatten().map(|&corner| self.first[corner as usize]);
        let places = (0..).zip(self.indices.iter().zip(corners));
        places.filter(|(_, (split, merged))| *split != merged).map(|(place, (_, merged))| (place, merged)).collect()
    }
}
