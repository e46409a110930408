//! The boundary of a union of bodies, as directed boundary edges of the kept regions; no cells, no fragments.
//!
//! On each face of each body ([`face`]) the regions that other bodies swallow are convex polygons ([`section`]). What the
//! weld needs are only the edges where the kept region ends: pieces of the face's own edges, and pieces of the section
//! edges, each clipped in one dimension by the other sections. Coplanar faces: of two that face the same way one owner
//! emits; two that face each other vanish.

mod face;
mod section;

use planecut_kernel::sign::Counts;
use rayon::prelude::*;

use crate::body::Body;
use crate::brush::MaterialId;
use crate::neighbours::Neighbours;
use crate::plane_table::{PlaneId, PlaneTable};

/// A piece of the boundary of the kept region of a plane: on the line of `face` and `edge`, directed along
/// `n_face × n_edge`, so that the region lies to the left.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct BoundaryEdge {
    /// The plane of the region, outward.
    pub(crate) face: PlaneId,
    /// The plane that ends the region, oriented away from it.
    pub(crate) edge: PlaneId,
    /// The plane that ends the piece at its start.
    pub(crate) start: PlaneId,
    /// The plane that ends the piece at its end.
    pub(crate) end: PlaneId,
    pub(crate) material: MaterialId,
}

/// The boundary edges of the union of bodies. `rank` orders materials: where coplanar faces overlap, the lower rank wins,
/// so that the outcome does not depend on the order of the bodies.
pub(crate) fn skin_of_union(table: &PlaneTable, bodies: &[Body], rank: &[u32]) -> (Vec<BoundaryEdge>, Counts) {
    let neighbours = Neighbours::new(bodies);
    let chunk = (bodies.len() / (8 * rayon::current_num_threads()).max(1)).clamp(1, 256);
    let parts: Vec<(Vec<BoundaryEdge>, Counts)> = (0..bodies.len())
        .collect::<Vec<usize>>()
        .par_chunks(chunk)
        .map(|chunk| {
            let before = Counts::now();
            let mut edges = Vec::new();
            let mut worker = face::FaceWorker::new(table, bodies, rank);
            let mut near = Vec::new();
            for &body in chunk {
                neighbours.of(body, &bodies[body].bounds, &mut near);
                for face in 0..bodies[body].faces.len() {
                    worker.emit(body, face, &near, &mut edges);
                }
            }
            (edges, Counts::since(before))
        })
        .collect();
    let mut counts = Counts::default();
    let mut edges = Vec::with_capacity(parts.iter().map(|(part, _)| part.len()).sum());
    for (part, counted) in parts {
        edges.extend(part);
        counts += counted;
    }
    (edges, counts)
}
