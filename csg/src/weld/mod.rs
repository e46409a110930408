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
mod filled_faces;
mod large_face;
mod lines;
mod live;
mod loops;
pub(crate) mod manifold;
mod measure;
mod nest;
mod numbered_edges;
mod pinch_cuts;
mod pinches;
mod points;
mod region_corners;
mod regions;
mod slits;
mod stops;
pub(crate) mod triangulate;

use std::ops::Range;
use std::time::Duration;

use planecut_kernel::sign::Counts;
use planecut_parallel::drop_beside;
use planecut_parallel::prelude::*;
use thiserror::Error;

use crate::base::{Clock, Workers, by_group, map_weighed_chunks_into, repeated, takes_much_memory};
use crate::boundary::BoundaryEdge;
use crate::ids::{EdgeId, HalfEdgeId, Id, PointId, RegionId};
use crate::mesh::{Flaw, Mesh, Noise, SolidMeasures, proven};
use crate::model::{Material, MaterialId};
use crate::plane_table::PlaneTable;
use cancel::HalfEdge;
use crossings::Passed;
use filled_faces::filled_faces;
pub(crate) use live::LiveWeld;
pub(crate) use live::WeldedFace;
pub(crate) use nest::Projection;
use nest::{Faces, Nester, RegionPlane};
use points::Points;
use region_corners::RegionCorners;
use regions::{ByRegion, RegionPieces, Regions};

/// Number of boundary edges from which points and lines are numbered one after the other.
const MANY_EDGES: usize = 1 << 21;

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

/// Welds boundary edges into a mesh; `rank` orders materials by name, and noise stays at faces of the material of walls, where there is one.
pub(crate) fn weld(
    table: &PlaneTable,
    edges: Vec<BoundaryEdge>,
    rank: &[u32],
    materials: &[Material],
    walls: Option<MaterialId>,
) -> Result<Welded, WeldError> {
    let (regions, points, sorted, mut signs) = half_edges(table, edges, rank)?;
    let (nested, counted) = nest(table, &regions, &points, &sorted)?;
    signs += counted;
    let RegionPieces { pieces, ranges } = sorted;
    let Nested { following, faces, solid } = nested;
    drop(ranges);
    let (vertex, point) = manifold::vertices(&pieces, following);

    let begin = Clock::start();
    let (filled, counted) = filled_faces(table, &regions, &points, &pieces, faces);
    signs += counted;
    let twins = twins(pieces);
    let positions = points.into_positions();
    let (mut mesh, filled) = filled_faces::mesh_of(filled, &vertex, materials);
    drop(vertex);
    mesh.positions = point.par_iter().with_min_len(1024).map(|p| positions[p.index()]).collect();
    drop((point, positions));
    // an edge that is there twice is not paired
    let repeated = manifold::repeated_edges(&mesh);
    let is_closed = repeated.is_none();
    if let Some(repeated) = repeated {
        let mut labels = filled_faces::labels(&filled);
        manifold::split_repeated_edges(&mut mesh, &mut labels, repeated, |piece| twins[piece.index()]);
    }
    let (mesh, noise) = drop_beside((filled, twins), || proven(mesh, &solid, walls, is_closed))?;
    Ok(Welded { mesh, solid, noise, signs, triangulation: begin.elapsed() })
}

/// The half-edge that each is paired with.
fn twins(pieces: Vec<HalfEdge>) -> Vec<HalfEdgeId> {
    let twin = |piece: &HalfEdge| piece.twin;
    if takes_much_memory::<HalfEdge>(pieces.len()) {
        // in their place
        let mut twins: Vec<HalfEdgeId> = pieces.into_iter().map(|piece| twin(&piece)).collect();
        twins.shrink_to_fit();
        return twins;
    }
    pieces.par_iter().with_min_len(1024).map(twin).collect()
}

/// Numbers regions, points and lines, cancels what is opposite, and cuts and pairs what is left; half-edges are sorted by
/// region and place.
fn half_edges(
    table: &PlaneTable,
    edges: Vec<BoundaryEdge>,
    rank: &[u32],
) -> Result<(Regions, Points, RegionPieces, Counts), WeldError> {
    let number_points = || Points::identify(table, &edges);
    let number_lines = || {
        let (lines, of_edge, counts) = lines::identify(table, &edges);
        let by_line = by_group(lines.len(), of_edge.len(), |edge| of_edge[edge].index(), EdgeId::from_index);
        (lines, of_edge, by_line, counts)
    };
    let number_regions = || Regions::number(&edges, rank);
    // each has parts for one thread, during which the others go on; of very many edges what all take at once would be much memory
    let (found, (of_regions, of_lines)) = if edges.len() < MANY_EDGES {
        planecut_parallel::join(number_points, || planecut_parallel::join(number_regions, number_lines))
    } else {
        let (found, of_lines) = (number_points(), number_lines());
        (found, (number_regions(), of_lines))
    };
    let (mut points, ends, mut signs) = found;
    let ((mut regions, region_of_edge), (lines, line_of_edge, by_line, counted)) = (of_regions, of_lines);
    signs += counted;
    let runs = numbered_edges::runs(table, edges, &lines, &line_of_edge, &region_of_edge, &ends);
    // of a large model each of these is as large as its mesh
    drop((line_of_edge, region_of_edge, ends));
    let (parts, counted) = cancel::pieces(table, &points, &lines, &regions.planes, &runs, &by_line)?;
    signs += counted;
    let passed: Vec<&[Passed]> = parts.iter().map(|part| part.passed.as_slice()).collect();
    let is_crossed = parts.iter().any(|part| part.is_slit) || crossings::any(&passed);
    let pieces = if is_crossed {
        crossings::pieces(table, &mut points, &lines, &regions.planes, &runs, &by_line)?
    } else {
        drop((runs, by_line));
        cancel::joined(parts)
    };
    let mut by_region = ByRegion::of(&pieces, regions.planes.len());
    regions.sort(table, &mut by_region);
    let (mut sorted, pinches, counted) = RegionPieces::sort(table, &points, &regions.planes, pieces, by_region);
    signs += counted;
    if !pinches.is_empty() {
        sorted.cut(table, &points, &lines, &pinches);
    }
    Ok((regions, points, sorted, signs))
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
    RegionPieces { pieces, ranges }: &RegionPieces,
) -> Result<(Nested, Counts), WeldError> {
    let following = repeated(pieces.len(), || HalfEdgeId::NONE);
    let mut nested = Nested { following, faces: Vec::new(), solid: SolidMeasures::default() };
    if pieces.is_empty() {
        return Ok((nested, Counts::default()));
    }
    let extent = measure::extent(&points.positions, pieces);
    let middle = 0.5 * (extent.0 + extent.1);
    let workers = Workers::new(|| (Nester::default(), RegionCorners::default()));
    let work = |chunk: &[Range<usize>], mut following: &mut [HalfEdgeId]| {
        workers.with(|(nester, corners)| -> Result<_, WeldError> {
            let mut faces = Faces::with_room(following.len(), pieces.len(), chunk.len());
            // planes lie anywhere in memory: in a loop of their own several are on their way at once
            let plane = |range: &Range<usize>| regions.planes[pieces[range.start].region.index()];
            let planes = chunk.iter().map(|range| RegionPlane::new(table, points, plane(range)));
            let planes: Vec<RegionPlane<'_>> = planes.collect();
            for (range, plane) in chunk.iter().zip(&planes) {
                let (region, start) = (&pieces[range.clone()], range.start);
                let own = following.split_off_mut(..region.len()).expect("there is room for each half-edge");
                corners.set(region);
                let first = |point: PointId| corners.first_at(point).unwrap_or(region.len());
                loops::follow(table, plane.plane, region, start, first, own)?;
                nester.add_faces(plane, region, start, own, &mut faces)?;
            }
            let measures = measure::of_faces(&points.positions, pieces, &faces, ranges.len(), middle);
            Ok((faces, measures))
        })
    };
    let (parts, counts) = map_weighed_chunks_into(ranges, 512, Range::len, &mut nested.following, work);
    let parts = parts.into_iter().collect::<Result<Vec<_>, _>>()?;
    nested.solid = measure::sum(parts.iter().flat_map(|(_, measures)| measures), extent);
    nested.faces = parts.into_iter().map(|(faces, _)| faces).collect();
    Ok((nested, counts))
}
