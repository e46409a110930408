//! The triangles of all faces, and the mesh that they make.

use planecut_kernel::DVec3;
use planecut_kernel::sign::Counts;

use super::cancel::HalfEdge;
use super::large_face::{FaceEdge, LargeFace};
use super::manifold::Labels;
use super::nest::{Faces, Projection};
use super::points::Points;
use super::regions::Regions;
use super::triangulate::{Triangles, Triangulator, WeldPoints};
use crate::base::{Workers, by_parts, concat_made, concat_owned, map_owned, starts_of, with_room};
use crate::ids::{HalfEdgeId, Id, PointId, RegionId, VertexId, number32};
use crate::mesh::{Mesh, MeshFace};
use crate::model::Material;
use crate::plane_table::PlaneTable;

/// Least number of triangles that a thread makes in a row.
const TRIANGLES_OF_CHUNK: usize = 1 << 10;

/// The triangles of some faces.
pub(super) struct FilledFaces {
    triangles: Triangles,
    faces: Vec<MeshFace>,
    /// For each triangle the place of its face among these.
    triangle_faces: Vec<u32>,
}

/// Fills faces with triangles, in parallel; faces are dropped part by part, as of a large model they take as much memory as triangles do.
pub(super) fn filled_faces(
    table: &PlaneTable,
    regions: &Regions,
    points: &Points,
    pieces: &[HalfEdge],
    faces: Vec<Faces>,
) -> (Vec<FilledFaces>, Counts) {
    let exact = WeldPoints { table, points, half_edges: pieces, planes: &regions.planes };
    let workers = Workers::new(|| (Triangulator::new(&exact), Vec::new()));
    let fill = |faces: Faces, (triangulator, edges): &mut (Triangulator<'_>, Vec<FaceEdge>)| {
        let mut triangles = Triangles::default();
        let mut mesh_faces = with_room(faces.len(), regions.planes.len());
        let mut projections = Vec::with_capacity(faces.len());
        // planes lie anywhere in memory: in a loop of their own several are on their way at once
        for face in faces.iter() {
            let normal = table.half_space(regions.planes[face.region.index()]).normal();
            mesh_faces.push(mesh_face(regions, face.region, normal));
            projections.push(Projection::new(normal));
        }
        let count = faces.triangle_count();
        triangles.corners = with_room(count, pieces.len());
        triangles.on_loops.reserve(count);
        let mut triangle_faces = with_room(count, pieces.len());
        for (number, (face, projection)) in (0..).zip(faces.iter().zip(projections)) {
            edges.clear();
            edges.extend(face.loops().flatten().map(|k| pieces[k.index()].edge_of_face(*k)));
            let at = |point: PointId| projection.of(points.positions[point.index()]);
            match LargeFace::of_many(edges, at) {
                Some(large) => large.list(&mut triangles),
                None => {
                    triangulator.begin(projection);
                    for pieces_of_loop in face.loops() {
                        triangulator.add_loop(pieces_of_loop.iter().map(|k| points.corner(*k, &pieces[k.index()])));
                    }
                    triangulator.triangulate(&mut triangles);
                }
            }
            triangle_faces.resize(triangles.corners.len(), number);
        }
        // room for more may be as much again
        triangles.corners.shrink_to_fit();
        triangles.on_loops.shrink_to_fit();
        mesh_faces.shrink_to_fit();
        triangle_faces.shrink_to_fit();
        FilledFaces { triangles, faces: mesh_faces, triangle_faces }
    };
    map_owned(faces, |part| workers.with(|worker| fill(part, worker)))
}

fn mesh_face(regions: &Regions, region: RegionId, normal: DVec3) -> MeshFace {
    let scaled = normal / normal.abs().max_element();
    MeshFace { normal: scaled.normalize(), material: regions.materials[region.index()] }
}

/// The mesh of faces, without positions, and their triangles by half-edges, in parts; `vertex` gives the vertex at which each half-edge begins.
pub(super) fn mesh_of(parts: Vec<FilledFaces>, vertex: &[VertexId], materials: &[Material]) -> (Mesh, Vec<Triangles>) {
    let first = starts_of(parts.iter().map(|part| part.faces.len()));
    let (mut filled, mut faces, mut triangle_faces) = (Vec::new(), Vec::new(), Vec::new());
    for part in parts {
        filled.push(part.triangles);
        faces.push(part.faces);
        triangle_faces.push(part.triangle_faces);
    }
    let faces = concat_owned(faces);
    let triangle_faces = concat_made(triangle_faces, |part, face| number32(first[part]) + *face);
    let corner = |piece: HalfEdgeId| vertex[piece.index()].number();
    let triangle = |part: usize, k: usize| filled[part].corners[k].map(corner);
    let triangles = by_parts(filled.iter().map(|part| part.corners.len()), TRIANGLES_OF_CHUNK, triangle);
    (Mesh { triangles, triangle_faces, faces, materials: materials.to_vec(), ..Mesh::default() }, filled)
}

/// The half-edge behind each side of each triangle.
pub(super) fn labels(filled: &[Triangles]) -> Labels {
    let label = |part: usize, triangle: usize| {
        let (corners, on_loops) = (filled[part].corners[triangle], filled[part].on_loops[triangle]);
        [0, 1, 2].map(|k| if on_loops >> k & 1 == 1 { corners[k] } else { HalfEdgeId::NONE })
    };
    by_parts(filled.iter().map(|part| part.corners.len()), TRIANGLES_OF_CHUNK, label)
}
