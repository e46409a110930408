//! From boundary edges to a watertight mesh.
//!
//! - [`points`] and [`lines`] get one number each, however many planes name them.
//! - [`cancel`]: on each line opposite edges of a region cancel; what survives is cut where any of it ends (and at
//!   [`pinches`]) and paired around the line.
//! - [`crossings`]: faces that cross in a line are slit along it, edges that cross in a point are cut there.
//! - [`loops`] chains the rest, [`nest`] finds which hole belongs to which face.
//! - [`triangulate`]: each face on its own.
//! - [`manifold`] joins corners to vertices so that the mesh is an oriented 2-manifold; edges of mere noise are
//!   contracted.
//!
//! The page `docs/weld.md` of the project says why.
//!
//! Nothing here is hoped for: an interval whose directed edges do not sum to zero, or a half-edge without a twin, is a
//! [`WeldError`].

mod cancel;
mod crossings;
mod lines;
mod loops;
mod manifold;
mod measure;
mod nest;
mod pinches;
mod points;
mod triangulate;

use std::time::{Duration, Instant};

use planecut_kernel::DVec3;
use planecut_kernel::sign::Counts;
use rayon::prelude::*;
use thiserror::Error;

use crate::brush::{Material, MaterialId};
use crate::caps::flip_caps;
use crate::collapse::collapse_thin;
use crate::contract::contract_short_edges;
use crate::evaluate::SolidMeasures;
use crate::mesh::{Mesh, MeshFace};
use crate::plane_table::{PlaneId, PlaneTable};
use crate::skin::BoundaryEdge;
use cancel::{HalfEdge, Run, Surviving};
use manifold::Labels;
use nest::{FaceLoops, Projection};
use points::Points;
use triangulate::{Corner, Triangles, Turns};

/// The boundary does not close: a bug in this crate, never the user's mistake. Points are numbers of the weld.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum WeldError {
    /// The directed edges of an interval do not sum to zero.
    #[error("internal error: the boundary is open between points {from} and {to}; please report this model")]
    Open {
        /// Where the open piece begins.
        from: u32,
        /// Where it ends.
        to: u32,
    },
    /// Two faces claim the same side of a plane.
    #[error("internal error: two owners of region {region}; please report this model")]
    Overlap {
        /// Number of the region.
        region: u32,
    },
    /// A hole lies in no outer loop of its region.
    #[error("internal error: a hole of region {region} lies in no face; please report this model")]
    Hole {
        /// Number of the region.
        region: u32,
    },
    /// Around an edge, solid and empty wedges do not alternate.
    #[error(
        "internal error: faces around the edge between points {from} and {to} do not alternate; please report this model"
    )]
    Wedge {
        /// One end of the edge.
        from: u32,
        /// The other.
        to: u32,
    },
}

/// Edges shorter than this share of the largest coordinate come from planes that were meant to meet in a point: noise of
/// decimal text or rotations is some `1e-15`, what anybody models is far longer.
const CONTRACTION: f64 = 1e-12;

/// What the weld gives.
pub(crate) struct Welded {
    pub(crate) mesh: Mesh,
    pub(crate) solid: SolidMeasures,
    pub(crate) signs: Counts,
    pub(crate) triangulation: Duration,
}

/// The regions of the boundary: oriented planes with a material, in an order that does not depend on the brushes'.
struct Regions {
    planes: Vec<PlaneId>,
    materials: Vec<MaterialId>,
}

/// Welds boundary edges into a mesh; `rank` orders materials by name.
pub(crate) fn weld(
    table: &PlaneTable,
    edges: &[BoundaryEdge],
    rank: &[u32],
    materials: &[Material],
) -> Result<Welded, WeldError> {
    let before = Counts::now();
    let (regions, numbers) = Regions::number(edges, rank);
    let (mut points, runs, lines) = runs_of(table, edges, &regions.planes, &numbers)?;
    let runs = points.renumber(table, runs);
    let pinches = pinches::find(table, &points, &runs, regions.planes.len());
    let pieces = cancel::half_edges(table, &points, &lines, &regions.planes, &runs, &pinches)?;
    let pieces = order_by_region(&pieces);
    let following = loops::following(table, &regions.planes, &pieces)?;
    let faces = nest::faces(table, &regions.planes, &points, &pieces, &following)?;
    let solid = measure::measures(&points.positions, &pieces, &faces);
    let (vertex, point) = manifold::vertices(&pieces, &following);
    let signs = Counts::since(before);

    let begin = Instant::now();
    let mut mesh = Mesh {
        positions: point.iter().map(|p| points.positions[*p as usize]).collect(),
        materials: materials.to_vec(),
        ..Mesh::default()
    };
    let mut labels = triangulate_faces(table, &regions, &points, &pieces, &faces, &vertex, &mut mesh);
    manifold::split_repeated_edges(&mut mesh, &mut labels, &pieces);
    let noise = CONTRACTION * solid.min.abs().max(solid.max.abs()).max_element();
    contract_short_edges(&mut mesh, noise);
    collapse_thin(&mut mesh, noise);
    flip_caps(&mut mesh, noise);
    Ok(Welded { mesh, solid, signs, triangulation: begin.elapsed() })
}

impl Regions {
    /// The regions, and the number of the region of each edge.
    fn number(edges: &[BoundaryEdge], rank: &[u32]) -> (Self, Vec<u32>) {
        let key = |edge: &BoundaryEdge| (edge.face, rank[edge.material.0 as usize], edge.material);
        let mut keys: Vec<(PlaneId, u32, MaterialId)> = edges.iter().map(key).collect();
        keys.dedup();
        keys.sort_unstable();
        keys.dedup();
        let numbers = edges.iter().map(|edge| keys.binary_search(&key(edge)).unwrap_or_default() as u32).collect();
        let regions =
            Self { planes: keys.iter().map(|k| k.0).collect(), materials: keys.iter().map(|k| k.2).collect() };
        (regions, numbers)
    }
}

/// Numbers points and lines and cancels what is opposite.
fn runs_of(
    table: &PlaneTable,
    edges: &[BoundaryEdge],
    planes: &[PlaneId],
    regions: &[u32],
) -> Result<(Points, Vec<Run>, Vec<lines::Line>), WeldError> {
    let triples: Vec<[PlaneId; 3]> =
        edges.iter().flat_map(|e| [[e.face, e.edge, e.start], [e.face, e.edge, e.end]]).collect();
    let pairs: Vec<[PlaneId; 2]> = edges.iter().map(|e| [e.face, e.edge]).collect();
    let ((mut points, ends), (lines, of_pair)) =
        rayon::join(|| Points::identify(table, &triples), || lines::identify(table, &pairs));
    let mut numbered: Vec<Run> = edges
        .iter()
        .enumerate()
        .map(|(k, edge)| Run {
            line: of_pair[k],
            region: regions[k],
            edge: edge.edge,
            from: ends[2 * k],
            to: ends[2 * k + 1],
            forward: lines[of_pair[k] as usize].is_along(table, edge.face, edge.edge),
        })
        .collect();
    let Surviving { runs, slits, passed } = cancel::surviving_runs(table, &points, &lines, planes, &mut numbered)?;
    let runs = crossings::cut_runs(table, &points, &lines, passed, runs);
    let runs = crossings::add_slits(table, &mut points, planes, slits, runs);
    Ok((points, runs, lines))
}

/// Sorts half-edges by region and place, keeping the pairs.
fn order_by_region(pieces: &[HalfEdge]) -> Vec<HalfEdge> {
    let mut order: Vec<u32> = (0..pieces.len() as u32).collect();
    order.sort_unstable_by_key(|k| {
        let piece = &pieces[*k as usize];
        (piece.region, piece.from, piece.to)
    });
    let mut place = vec![0; pieces.len()];
    for (new, old) in order.iter().enumerate() {
        place[*old as usize] = new as u32;
    }
    order
        .into_iter()
        .map(|old| {
            let piece = pieces[old as usize];
            HalfEdge { twin: place[piece.twin as usize], ..piece }
        })
        .collect()
}

/// Fills the triangles and faces of a mesh, in parallel over faces; gives the half-edge behind each side.
fn triangulate_faces(
    table: &PlaneTable,
    regions: &Regions,
    points: &Points,
    pieces: &[HalfEdge],
    faces: &[FaceLoops],
    vertex: &[u32],
    mesh: &mut Mesh,
) -> Labels {
    let corner = |at: &Projection, k: u32| {
        let piece = &pieces[k as usize];
        Corner {
            at: at.of(points.positions[piece.from as usize]),
            point: piece.from,
            vertex: vertex[k as usize],
            line: piece.line,
            piece: k,
        }
    };
    let parts: Vec<(Triangles, Vec<u32>)> = faces
        .par_chunks(64)
        .map(|chunk| {
            let (mut triangles, mut ends) = (Triangles::default(), Vec::new());
            for face in chunk {
                let normal = table.half_space(regions.planes[face.region as usize]).normal();
                let at = Projection::new(normal);
                let loops: Vec<Vec<Corner>> =
                    face.loops.iter().map(|pieces| pieces.iter().map(|k| corner(&at, *k)).collect()).collect();
                triangulate::triangulate(&loops, Turns { table, points, projection: at }, &mut triangles);
                ends.push(triangles.vertices.len() as u32);
            }
            (triangles, ends)
        })
        .collect();
    let mut labels = Labels::new();
    for (triangles, ends) in parts {
        let mut start = 0;
        for end in ends {
            let face = mesh.faces.len();
            let region = faces[face].region as usize;
            let normal: DVec3 = table.half_space(regions.planes[region]).normal();
            let scaled = normal / normal.abs().max_element();
            mesh.faces.push(MeshFace { normal: scaled.normalize(), material: regions.materials[region] });
            mesh.triangle_faces.extend(std::iter::repeat_n(face as u32, (end - start) as usize));
            start = end;
        }
        mesh.triangles.extend(triangles.vertices);
        labels.extend(triangles.labels);
    }
    labels
}
