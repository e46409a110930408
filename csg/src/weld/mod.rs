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

mod around;
mod cancel;
mod crossings;
mod delaunay;
mod large_face;
mod lines;
mod live;
mod loops;
pub(crate) mod manifold;
mod measure;
mod nest;
mod pinches;
mod points;
mod slits;
mod stops;
pub(crate) mod triangulate;

use crate::ids::number32;
use std::ops::Range;
use std::time::Duration;

use planecut_kernel::DVec3;
use planecut_kernel::sign::Counts;
use planecut_parallel::prelude::*;
use thiserror::Error;

use crate::base::{Clock, by_group, map_chunks};
use crate::boundary::BoundaryEdge;
use crate::ids::{EdgeId, HalfEdgeId, Id, PointId, RegionId, VertexId};
use crate::mesh::{Flaw, Mesh, MeshFace, Noise, SolidMeasures, proven};
use crate::model::{Material, MaterialId};
use crate::plane_table::{PlaneId, PlaneTable};
use cancel::{HalfEdge, Pieces, Run};
use large_face::{FaceEdge, LargeFace};
pub(crate) use live::LiveWeld;
pub(crate) use live::WeldedFace;
use manifold::Labels;
pub(crate) use nest::Projection;
use nest::{Faces, Nester};
use points::Points;
use triangulate::{Triangles, Triangulator, WeldPoints};

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
    /// An edge of the mesh is not used once each way.
    #[error("internal error: the mesh is not closed; please report this model")]
    OpenMesh,
    /// A triangle faces against its face.
    #[error("internal error: a face of the mesh is folded; please report this model")]
    Folded,
    /// Volume or area of the mesh are not those of the solid.
    #[error("internal error: the mesh has another volume or area than the solid; please report this model")]
    Measures,
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

impl From<Flaw> for WeldError {
    fn from(flaw: Flaw) -> Self {
        match flaw {
            Flaw::Open => Self::OpenMesh,
            Flaw::Folded => Self::Folded,
            Flaw::Measures => Self::Measures,
        }
    }
}

impl WeldError {
    fn open(piece: &HalfEdge) -> Self {
        Self::Open { from: piece.from.number(), to: piece.to.number() }
    }

    fn overlap(region: RegionId) -> Self {
        Self::Overlap { region: region.number() }
    }

    fn hole(region: RegionId) -> Self {
        Self::Hole { region: region.number() }
    }

    fn wedge(piece: &HalfEdge) -> Self {
        Self::Wedge { from: piece.from.number(), to: piece.to.number() }
    }
}

/// What the weld gives.
pub(crate) struct Welded {
    pub(crate) mesh: Mesh,
    pub(crate) solid: SolidMeasures,
    pub(crate) noise: Noise,
    pub(crate) signs: Counts,
    pub(crate) triangulation: Duration,
}

/// The regions of the boundary: oriented planes with a material.
struct Regions {
    planes: Vec<PlaneId>,
    materials: Vec<MaterialId>,
    /// The places of the materials by name.
    ranks: Vec<u32>,
}

/// Welds boundary edges into a mesh; `rank` orders materials by name, and noise stays at faces of the material of walls, where there is one.
pub(crate) fn weld(
    table: &PlaneTable,
    edges: &[BoundaryEdge],
    rank: &[u32],
    materials: &[Material],
    walls: Option<MaterialId>,
) -> Result<Welded, WeldError> {
    let (regions, points, pieces, mut signs) = half_edges(table, edges, rank)?;
    let (nested, counted) = nest(table, &regions, &points, &pieces)?;
    signs += counted;
    let (vertex, point) = manifold::vertices(&pieces, &nested.following);

    let begin = Clock::start();
    let positions = point.par_iter().with_min_len(4096).map(|p| points.positions[p.index()]).collect();
    let mut mesh = Mesh { positions, materials: materials.to_vec(), ..Mesh::default() };
    let (mut labels, counted) = triangulate_faces(table, &regions, &points, &pieces, &nested.faces, &vertex, &mut mesh);
    signs += counted;
    manifold::split_repeated_edges(&mut mesh, &mut labels, |piece| pieces[piece.index()].twin);
    let solid = nested.solid;
    let (mesh, noise) = proven(mesh, &solid, walls)?;
    Ok(Welded { mesh, solid, noise, signs, triangulation: begin.elapsed() })
}

impl Regions {
    /// The regions, and the number of the region of each edge.
    fn number(edges: &[BoundaryEdge], rank: &[u32]) -> (Self, Vec<RegionId>) {
        let key = |edge: &BoundaryEdge| (edge.face, rank[edge.material.0 as usize], edge.material);
        // the edges of a face follow one another
        let same_face = || edges.chunk_by(|a, b| (a.face, a.material) == (b.face, b.material));
        let mut keys: Vec<(PlaneId, u32, MaterialId)> = same_face().map(|edges| key(&edges[0])).collect();
        keys.sort_unstable();
        keys.dedup();
        let mut numbers = Vec::with_capacity(edges.len());
        for edges in same_face() {
            let number = keys.binary_search(&key(&edges[0])).expect("the region of each edge is among the keys");
            let number = RegionId::from_index(number);
            numbers.extend(std::iter::repeat_n(number, edges.len()));
        }
        let regions = Self {
            planes: keys.iter().map(|k| k.0).collect(),
            materials: keys.iter().map(|k| k.2).collect(),
            ranks: keys.iter().map(|k| k.1).collect(),
        };
        (regions, numbers)
    }

    /// Puts regions in an order that depends on the boundary alone, not on the bodies that it came from: by the first of
    /// their points, their planes and materials.
    fn sort(&mut self, table: &PlaneTable, pieces: &mut [HalfEdge]) {
        let mut first = vec![PointId::NONE; self.planes.len()];
        for piece in pieces.iter() {
            let first = &mut first[piece.region.index()];
            *first = piece.from.min(*first);
        }
        let regions = RegionId::all(first.len());
        let mut order: Vec<(PointId, RegionId)> = first.into_iter().zip(regions.clone()).collect();
        let further = |region: RegionId| (table.order(self.planes[region.index()]), self.ranks[region.index()]);
        order.par_sort_unstable_by(|p, q| p.0.cmp(&q.0).then_with(|| further(p.1).cmp(&further(q.1))));
        let mut number = vec![RegionId::NONE; order.len()];
        for (new, (_, old)) in regions.zip(&order) {
            number[old.index()] = new;
        }
        self.planes = order.iter().map(|(_, old)| self.planes[old.index()]).collect();
        self.materials = order.iter().map(|(_, old)| self.materials[old.index()]).collect();
        self.ranks = order.iter().map(|(_, old)| self.ranks[old.index()]).collect();
        pieces.iter_mut().for_each(|piece| piece.region = number[piece.region.index()]);
    }
}

/// Numbers regions, points and lines, cancels what is opposite, and cuts and pairs what is left; half-edges are sorted by
/// region and place.
fn half_edges(
    table: &PlaneTable,
    edges: &[BoundaryEdge],
    rank: &[u32],
) -> Result<(Regions, Points, Vec<HalfEdge>, Counts), WeldError> {
    // each has parts for one thread, during which the others go on
    let ((mut points, ends, mut signs), ((mut regions, of_edge), (lines, of_pair, counted))) = planecut_parallel::join(
        || Points::identify(table, edges),
        || planecut_parallel::join(|| Regions::number(edges, rank), || lines::identify(table, edges)),
    );
    signs += counted;
    let run = |(k, edge): (usize, &BoundaryEdge)| Run {
        line: of_pair[k],
        region: of_edge[k],
        edge: edge.edge,
        from: ends[k][0],
        to: ends[k][1],
        forward: lines[of_pair[k].index()].is_along(table, edge.face, edge.edge),
    };
    let runs: Vec<Run> = edges.par_iter().enumerate().with_min_len(1024).map(run).collect();
    let by_line = by_group(lines.len(), of_pair.iter().map(|line| line.index()), EdgeId::from_index);
    let (Pieces { mut pieces, slits, passed }, counted) =
        cancel::pieces(table, &points, &lines, &regions.planes, &runs, &by_line)?;
    signs += counted;
    if !slits.is_empty() || crossings::any(&passed) {
        pieces = crossings::pieces(table, &mut points, &lines, &regions.planes, &runs, &by_line)?;
    }
    regions.sort(table, &mut pieces);
    let mut sorted = order_by_region(&pieces, regions.planes.len());
    let (pinches, counted) = pinches::find(table, &points, &sorted);
    signs += counted;
    if !pinches.is_empty() {
        cancel::cut_further(table, &points, &lines, &pinches, &mut pieces);
        sorted = order_by_region(&pieces, regions.planes.len());
    }
    Ok((regions, points, sorted, signs))
}

/// Sorts half-edges by region and place, keeping the pairs.
fn order_by_region(pieces: &[HalfEdge], regions: usize) -> Vec<HalfEdge> {
    let (_, mut order) = by_group(regions, pieces.iter().map(|piece| piece.region.index()), HalfEdgeId::from_index);
    let region = |k: &HalfEdgeId| pieces[k.index()].region;
    order.par_chunk_by_mut(|a, b| region(a) == region(b)).for_each(|members| {
        members.sort_unstable_by_key(|k| {
            let piece = &pieces[k.index()];
            (piece.from, piece.to)
        });
    });
    let mut place = vec![HalfEdgeId::NONE; pieces.len()];
    for (new, old) in HalfEdgeId::all(order.len()).zip(&order) {
        place[old.index()] = new;
    }
    let piece = |old: HalfEdgeId| {
        let piece = pieces[old.index()];
        HalfEdge { twin: place[piece.twin.index()], ..piece }
    };
    order.into_par_iter().with_min_len(4096).map(piece).collect()
}

/// Half-edges chained to loops, these nested to faces.
struct Nested {
    /// What follows each half-edge in its loop.
    following: Vec<HalfEdgeId>,
    faces: Vec<Faces>,
    solid: SolidMeasures,
}

fn nest(
    table: &PlaneTable,
    regions: &Regions,
    points: &Points,
    pieces: &[HalfEdge],
) -> Result<(Nested, Counts), WeldError> {
    let mut nested =
        Nested { following: Vec::with_capacity(pieces.len()), faces: Vec::new(), solid: SolidMeasures::default() };
    if pieces.is_empty() {
        return Ok((nested, Counts::default()));
    }
    let extent = measure::extent(&points.positions, pieces);
    let middle = 0.5 * (extent.0 + extent.1);
    let by_region = regions_of(pieces);
    let (parts, counts) = map_chunks(&by_region, 16, |chunk| -> Result<_, WeldError> {
        let mut nester = Nester::new(table, points);
        let (mut following, mut faces, mut measures) = (Vec::new(), Faces::default(), Vec::new());
        for range in chunk {
            let (region, start) = (&pieces[range.clone()], range.start);
            let plane = regions.planes[region[0].region.index()];
            let done = following.len();
            let first = |point: PointId| region.partition_point(|piece| piece.from < point);
            loops::follow(table, plane, region, start, first, &mut following)?;
            nester.add_faces(plane, region, start, &following[done..], &mut faces)?;
        }
        measure::of_faces(&points.positions, pieces, &faces, middle, &mut measures);
        Ok((following, faces, measures))
    });
    let mut measures = Vec::new();
    for part in parts {
        let (following, faces, measured) = part?;
        nested.following.extend(following);
        nested.faces.push(faces);
        measures.extend(measured);
    }
    nested.solid = measure::sum(measures.iter(), extent);
    Ok((nested, counts))
}

/// Where the half-edges of each region begin and end.
fn regions_of(pieces: &[HalfEdge]) -> Vec<Range<usize>> {
    let mut end = 0;
    let region = |members: &[HalfEdge]| {
        let start = end;
        end += members.len();
        start..end
    };
    pieces.chunk_by(|a, b| a.region == b.region).map(region).collect()
}

/// The triangles of some faces.
struct FilledFaces {
    vertices: Vec<[u32; 3]>,
    labels: Labels,
    /// The region of each face, and where its triangles end.
    ends: Vec<(RegionId, u32)>,
}

/// Fills the triangles and faces of a mesh, in parallel over faces; gives the half-edge behind each side.
fn triangulate_faces(
    table: &PlaneTable,
    regions: &Regions,
    points: &Points,
    pieces: &[HalfEdge],
    faces: &[Faces],
    vertex: &[VertexId],
    mesh: &mut Mesh,
) -> (Labels, Counts) {
    let (parts, counts) = map_chunks(faces, 1, |chunk| {
        let exact = WeldPoints { table, points };
        let mut triangulator = Triangulator::new(&exact);
        let (mut filled, mut edges): (Vec<FilledFaces>, Vec<FaceEdge>) = (Vec::new(), Vec::new());
        for faces in chunk {
            let (mut triangles, mut ends) = (Triangles::default(), Vec::new());
            for face in faces.iter() {
                let normal = table.half_space(regions.planes[face.region.index()]).normal();
                let projection = Projection::new(normal);
                edges.clear();
                edges.extend(face.loops().flatten().map(|k| pieces[k.index()].edge_of_face(*k)));
                let at = |point: PointId| projection.of(points.positions[point.index()]);
                match LargeFace::of_many(&edges, at) {
                    Some(large) => large.list(&mut triangles),
                    None => {
                        triangulator.begin(projection);
                        for pieces_of_loop in face.loops() {
                            triangulator.add_loop(pieces_of_loop.iter().map(|k| points.corner(*k, &pieces[k.index()])));
                        }
                        triangulator.triangulate(&mut triangles);
                    }
                }
                ends.push((face.region, number32(triangles.corners.len())));
            }
            let corner = |piece: HalfEdgeId| vertex[piece.index()].number();
            let vertices = triangles.corners.iter().map(|corners| corners.map(corner)).collect();
            filled.push(FilledFaces { vertices, labels: triangles.labels, ends });
        }
        filled
    });
    let parts = || parts.iter().flatten();
    let count = parts().map(|filled| filled.vertices.len()).sum();
    mesh.triangles.reserve_exact(count);
    mesh.triangle_faces.reserve_exact(count);
    let mut labels = Labels::with_capacity(count);
    for FilledFaces { vertices, labels: of_sides, ends } in parts() {
        let mut start = 0;
        for &(region, end) in ends {
            let face = mesh.faces.len();
            let normal: DVec3 = table.half_space(regions.planes[region.index()]).normal();
            let scaled = normal / normal.abs().max_element();
            mesh.faces.push(MeshFace { normal: scaled.normalize(), material: regions.materials[region.index()] });
            mesh.triangle_faces.extend(std::iter::repeat_n(number32(face), (end - start) as usize));
            start = end;
        }
        mesh.triangles.extend_from_slice(vertices);
        labels.extend_from_slice(of_sides);
    }
    (labels, counts)
}
