//! The triangles of faces that have changed.

use std::sync::{Mutex, PoisonError};

use smallvec::SmallVec;

use super::loops::{Loop, Loops};
use super::numbers::Context;
use super::pieces::Pieces;
use crate::base::map_chunks;
use crate::ids::{FaceId, HalfEdgeId, Id, LoopId, PointId, RegionId};
use crate::weld::large_face::{FaceEdge, LARGE, LargeFace};
use crate::weld::nest::Projection;
use crate::weld::triangulate::{Triangles, Triangulator, TriangulatorBuffers, WeldPoints, convex_quadrilateral};

/// Number of corners, of all faces together, from which several threads triangulate them: to wake another one takes as long as a few hundred.
const CORNERS_FOR_THREADS: usize = 400;

/// A triangulation changes with its face where fewer than one in this number of its edges come or go; otherwise a new one is made, which takes less for each edge.
const CHANGED_SHARE: usize = 3;

/// Number of corners that are looked at, as a triangulation follows them, in the time that it takes to triangulate one.
const FOLLOWED: usize = 256;

/// The triangles of a face: three half-edges each, those that begin at its corners.
#[derive(Clone)]
pub(super) enum Triangulation {
    One([HalfEdgeId; 3]),
    Two([[HalfEdgeId; 3]; 2]),
    Whole(Vec<[HalfEdgeId; 3]>),
    /// Those of a face of many corners, kept so that they can change with it.
    Large(Box<LargeFace>),
}

impl Triangulation {
    pub(super) fn count(&self) -> usize {
        match self {
            Self::One(_) => 1,
            Self::Two(_) => 2,
            Self::Whole(triangles) => triangles.len(),
            Self::Large(large) => large.triangle_count(),
        }
    }

    pub(super) fn triangle(&self, place: usize) -> [HalfEdgeId; 3] {
        match self {
            Self::One(triangle) => *triangle,
            Self::Two(triangles) => triangles[place],
            Self::Whole(triangles) => triangles[place],
            Self::Large(large) => large.triangle(place),
        }
    }
}

/// What has changed of a large face.
pub(super) enum Changed {
    /// Edges came and went.
    Edges(EdgeChanges),
    /// Corners have moved, and nothing else.
    Places,
}

/// Edges that a face has lost and gained.
#[derive(Default)]
pub(super) struct EdgeChanges {
    pub(super) gone: Vec<FaceEdge>,
    pub(super) new: Vec<FaceEdge>,
}

/// A face that is to be triangulated.
pub(super) struct Job<'a> {
    pub(super) face: FaceId,
    pub(super) region: RegionId,
    pub(super) outer: &'a Loop,
    /// Its holes, in no order.
    pub(super) holes: &'a [LoopId],
    /// How many half-edges its loops have.
    pub(super) corners: usize,
    /// The triangulation that it has, where it can change with it, and what has changed since.
    pub(super) large: Option<Box<LargeFace>>,
    pub(super) changed: Changed,
}

impl Job<'_> {
    /// How much work it is to change its triangulation or to make a new one: as many corners of a new triangulation take as long.
    fn work(&self) -> usize {
        match (&self.large, &self.changed) {
            (Some(_), Changed::Places) => self.corners / FOLLOWED,
            (Some(_), Changed::Edges(EdgeChanges { gone, new })) => {
                self.corners.min(CHANGED_SHARE * (gone.len() + new.len()))
            }
            (None, _) => self.corners,
        }
    }
}

/// What it takes to triangulate faces.
#[derive(Clone, Copy)]
pub(super) struct FaceTriangulator<'a> {
    pub(super) context: Context<'a>,
    pub(super) pieces: &'a Pieces,
    pub(super) loops: &'a Loops,
}

impl<'a> FaceTriangulator<'a> {
    /// Triangulates faces, on several threads where there are many corners.
    pub(super) fn triangulate(
        self,
        jobs: Vec<Job<'a>>,
        buffers: &mut TriangulatorBuffers,
    ) -> Vec<(FaceId, Triangulation)> {
        let (large, mut whole): (Vec<Job<'a>>, Vec<Job<'a>>) = jobs.into_iter().partition(|job| job.corners >= LARGE);
        let of_large = |mut job: Job<'a>| (self.large(&mut job), job);
        let in_parts =
            |jobs: &[Job<'_>]| jobs.len() > 1 && jobs.iter().map(Job::work).sum::<usize>() >= CORNERS_FOR_THREADS;
        let large: Vec<(Option<Box<LargeFace>>, Job<'a>)> = if !in_parts(&large) {
            large.into_iter().map(of_large).collect()
        } else {
            let jobs: Vec<Mutex<Option<Job<'a>>>> = large.into_iter().map(|job| Mutex::new(Some(job))).collect();
            let take = |k: usize| jobs[k].lock().unwrap_or_else(PoisonError::into_inner).take().expect("each once");
            planecut_parallel::map_parts(jobs.len(), |k| of_large(take(k)))
        };
        let mut done = Vec::with_capacity(large.len() + whole.len());
        for (triangulation, job) in large {
            match triangulation {
                Some(large) => done.push((job.face, Triangulation::Large(large))),
                None => whole.push(job),
            }
        }
        if in_parts(&whole) {
            let of_chunk = |jobs: &[Job<'_>]| {
                let mut done = Vec::with_capacity(jobs.len());
                self.whole(jobs, &mut TriangulatorBuffers::default(), &mut done);
                done
            };
            done.extend(map_chunks(&whole, 1, of_chunk).0.into_iter().flatten());
        } else {
            self.whole(&whole, buffers, &mut done);
        }
        done
    }

    /// The triangulation of a large face: the old one where little has changed, or a new one; none where there is none.
    fn large(self, job: &mut Job<'_>) -> Option<Box<LargeFace>> {
        let plane = self.context.plane(job.region);
        let at = |point: PointId| plane.position(point);
        if let Some(mut large) = job.large.take() {
            let is_done = match &job.changed {
                Changed::Places => large.follow(at).is_ok(),
                Changed::Edges(EdgeChanges { gone, new }) => {
                    (gone.len() + new.len()) * CHANGED_SHARE < job.corners && large.change(gone, new, at).is_ok()
                }
            };
            if is_done {
                return Some(large);
            }
        }
        let edge = |piece: &HalfEdgeId| self.pieces.half_edges[piece.index()].edge_of_face(*piece);
        let holes = job.holes.iter().map(|hole| self.loops.get(*hole));
        let edges: Vec<FaceEdge> =
            std::iter::once(job.outer).chain(holes).flat_map(|members| &members.pieces).map(edge).collect();
        LargeFace::new(&edges, at).ok().map(Box::new)
    }

    /// Adds the triangles of faces that are triangulated as a whole, loops in the order of the half-edges with which they begin.
    fn whole(self, jobs: &[Job<'_>], buffers: &mut TriangulatorBuffers, done: &mut Vec<(FaceId, Triangulation)>) {
        let Context { table, numbers } = self.context;
        let (half_edges, planes) = (&self.pieces.half_edges, &numbers.planes);
        let exact = WeldPoints { table, points: numbers.points(), half_edges, planes };
        let mut triangulator = Triangulator::with_buffers(&exact, std::mem::take(buffers));
        let mut found = Triangles::default();
        let half_edge = |piece: HalfEdgeId| &self.pieces.half_edges[piece.index()];
        let mut triangulate = |job: &Job<'_>| {
            let outer = &job.outer.pieces;
            let projection = Projection::of_plane(table, numbers.planes[job.region.index()]);
            match outer[..] {
                [a, b, c] if job.holes.is_empty() => return Triangulation::One([a, b, c]),
                [a, b, c, d] if job.holes.is_empty() => {
                    let at = |piece: HalfEdgeId| projection.of(numbers.position(half_edge(piece).from));
                    if let Some(two) = convex_quadrilateral([a, b, c, d].map(at)) {
                        return Triangulation::Two(two.map(|corners| corners.map(|corner| outer[corner])));
                    }
                }
                _ => {}
            }
            triangulator.begin(projection);
            let mut holes: SmallVec<[&Loop; 4]> = job.holes.iter().map(|hole| self.loops.get(*hole)).collect();
            holes.sort_by(|p, q| self.pieces.compare(&self.context, p.pieces[0], q.pieces[0]));
            for members in std::iter::once(job.outer).chain(holes) {
                let corner = |piece: &HalfEdgeId| numbers.points().corner(*piece, half_edge(*piece));
                triangulator.add_loop(members.pieces.iter().map(corner));
            }
            found.corners.clear();
            found.on_loops.clear();
            triangulator.triangulate(&mut found);
            Triangulation::Whole(found.corners.clone())
        };
        done.extend(jobs.iter().map(|job| (job.face, triangulate(job))));
        *buffers = triangulator.into_buffers();
    }
}
