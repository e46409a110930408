//! The mesh of convex bodies that touch nothing, straight from their faces.

use glam::DVec3;

use super::totals::Totals;
use crate::body::Body;
use crate::ids::{Id, LeafId, number32};
use crate::mesh::{Mesh, MeshFace};
use crate::plane_table::PlaneTable;

/// Faces of more corners are left to the weld, whose triangulation takes less than quadratic time.
const MOST_CORNERS: usize = 32;

/// A mesh without materials, and the measures of what it bounds.
#[derive(Debug, Default)]
pub(super) struct ConvexMesh {
    pub(super) mesh: Mesh,
    pub(super) totals: Totals,
}

/// The mesh of some bodies; those that it does not hold are added to `rest`: bodies where more than three planes meet in a corner, whose faces
/// name that by different planes, and bodies of faces with many corners.
pub(super) fn mesh_of(
    table: &PlaneTable,
    bodies: impl Iterator<Item = (LeafId, Body)>,
    rest: &mut Vec<LeafId>,
) -> ConvexMesh {
    let mut mesh = ConvexMesh::default();
    let mut ring = Vec::new();
    for (leaf, body) in bodies {
        if is_simple(&body) {
            mesh.add(table, &body, &mut ring);
        } else {
            rest.push(leaf);
        }
    }
    mesh
}

/// Whether three faces meet at each corner, all by one number (Euler's formula tells), and none has many corners.
fn is_simple(body: &Body) -> bool {
    let counts = || body.faces.iter().map(|face| body.edges(face).len());
    let (sides, vertices): (usize, usize) = (counts().sum(), body.corner_count());
    sides == 3 * vertices && vertices + body.faces.len() == sides / 2 + 2 && counts().all(|count| count <= MOST_CORNERS)
}

impl ConvexMesh {
    fn add(&mut self, table: &PlaneTable, body: &Body, ring: &mut Vec<u32>) {
        let Self { mesh, totals } = self;
        let first = mesh.positions.len();
        let none = DVec3::splat(f64::NAN);
        mesh.positions.resize(first + body.corner_count(), none);
        for face in &body.faces {
            let edges = body.edges(face);
            for (k, corner) in body.corners(face).enumerate() {
                let at = &mut mesh.positions[first + corner.number.index()];
                if at.is_nan() {
                    let planes = [face.plane, edges[k], edges[(k + 1) % edges.len()]];
                    *at = table.position(planes).expect("the planes of a corner are independent");
                }
            }
        }
        let origin = mesh.positions[first];
        let (mut six_volume, mut area, mut moment) = (0.0, 0.0, DVec3::ZERO);
        for face in &body.faces {
            ring.clear();
            ring.extend(body.corners(face).map(|corner| number32(first + corner.number.index())));
            let at = |k: usize| mesh.positions[ring[k] as usize] - origin;
            let mut twice_area = DVec3::ZERO;
            for k in 1..ring.len() - 1 {
                let (a, b, c) = (at(0), at(k), at(k + 1));
                let normal = (b - a).cross(c - a);
                let weight = a.dot(normal);
                twice_area += normal;
                six_volume += weight;
                moment += weight * (a + b + c);
            }
            area += 0.5 * twice_area.length();
            let normal = table.half_space(face.plane).normal();
            let scaled = normal / normal.abs().max_element();
            mesh.triangle_faces.extend(std::iter::repeat_n(number32(mesh.faces.len()), ring.len() - 2));
            mesh.faces.push(MeshFace { normal: scaled.normalize(), material: face.material });
            cut_ears(&mesh.positions, ring, &mut mesh.triangles);
        }
        let volume = six_volume / 6.0;
        let own = &mesh.positions[first..];
        let extent = [own.iter().copied().fold(origin, DVec3::min), own.iter().copied().fold(origin, DVec3::max)];
        totals.add_solid(volume, area, volume * origin + moment / 24.0, extent);
    }
}

/// Triangulates a convex polygon: each time the ear with the shortest diagonal is cut. Leaves nothing of the ring.
fn cut_ears(positions: &[DVec3], ring: &mut Vec<u32>, triangles: &mut Vec<[u32; 3]>) {
    while ring.len() > 3 {
        let ends = |k: usize| [ring[(k + ring.len() - 1) % ring.len()], ring[(k + 1) % ring.len()]];
        let diagonal = |k: &usize| {
            let [before, after] = ends(*k).map(|vertex| positions[vertex as usize]);
            before.distance_squared(after)
        };
        let ear = (0..ring.len()).min_by(|a, b| diagonal(a).total_cmp(&diagonal(b))).unwrap_or(0);
        let [before, after] = ends(ear);
        triangles.push([before, ring[ear], after]);
        ring.remove(ear);
    }
    if let [a, b, c] = ring[..] {
        triangles.push([a, b, c]);
    }
}
