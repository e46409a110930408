//! The faces of regions that change: which loops bound each, and its triangles.
//!
//! What is said of a face depends on its loops alone. A loop that stays keeps its face, unless a new outer loop around it has come; so of the loops of a
//! region only those are looked at that changed, and those of the faces that these bound.

use planecut_kernel::DVec3;
use planecut_parallel::prelude::*;
use rustc_hash::FxHashMap;

use super::loops::{Loop, Loops};
use super::names::place;
use super::numbers::Numbers;
use super::regions::{Region, Regions};
use super::{Pieces, State};
use crate::base::{map_chunks, sortable};
use crate::ids::{FaceId, HalfEdgeId, Id, LoopId, PointId, RegionId, holds, number32};
use crate::model::MaterialId;
use crate::plane_table::{PlaneId, PlaneTable};
use crate::weld::WeldError;
use crate::weld::large_face::{FaceEdge, LARGE, LargeFace};
use crate::weld::nest::{Projection, RegionPlane};
use crate::weld::triangulate::{Triangles, Triangulator, WeldPoints, convex_quadrilateral};

/// A planar, connected region of the boundary, with its triangles.
#[derive(Clone, Copy)]
pub(crate) struct WeldedFace<'a> {
    numbers: &'a Numbers,
    state: &'a State,
    face: &'a Face,
}

impl<'a> WeldedFace<'a> {
    pub(super) fn new(numbers: &'a Numbers, state: &'a State, number: FaceId) -> Option<Self> {
        let face = state.faces.faces.get(number.index()).filter(|face| face.region != RegionId::NONE)?;
        Some(Self { numbers, state, face })
    }

    /// What it is made of.
    pub(crate) fn material(&self) -> MaterialId {
        self.numbers.material(self.face.region)
    }

    /// Its plane, directed out of the solid.
    pub(crate) fn plane(&self) -> PlaneId {
        self.numbers.planes[self.face.region.index()]
    }

    pub(crate) fn triangle_count(&self) -> usize {
        self.face.triangulation.count()
    }

    /// Whether it may hold a place on its plane, seen in a projection, or pass it by no more than a margin.
    pub(crate) fn may_hold(&self, projection: Projection, place: DVec3, margin: f64) -> bool {
        self.state.faces.loops.get(self.face.outer).extent.is_near(projection.of(place), margin)
    }

    /// The edges around it, loop by loop: first around all of it, then around holes in the order of where they begin.
    pub(crate) fn edges(self) -> impl Iterator<Item = [DVec3; 2]> + use<'a> {
        let Self { numbers, state, face } = self;
        let ends = |piece: &HalfEdgeId| {
            let half_edge = &state.pieces.half_edges[piece.index()];
            [half_edge.from, half_edge.to].map(|point| numbers.position(point))
        };
        let mut loops: Vec<&Loop> = state.faces.loops_of(face).collect();
        loops[1..].sort_by_cached_key(|hole| ends(&hole.pieces[0]).map(|at| at.to_array().map(sortable)));
        loops.into_iter().flat_map(|members| &members.pieces).map(ends)
    }

    /// A triangle: for each corner the number of its vertex, and its position.
    pub(crate) fn triangle(&self, place: usize) -> [(u32, DVec3); 3] {
        let Self { numbers, state, face } = self;
        let corner = |piece: HalfEdgeId| {
            let position = numbers.position(state.pieces.half_edges[piece.index()].from);
            (state.vertices.at(piece).number(), position)
        };
        face.triangulation.triangle(place).map(corner)
    }
}

/// Number of corners, of all faces together, from which several threads triangulate them.
const CORNERS_FOR_THREADS: usize = 400;

/// A triangulation changes with its face where fewer than one in this number of its edges come or go; otherwise it is made anew, which takes less for each edge.
const CHANGED_SHARE: usize = 3;

/// The faces, by number.
#[derive(Clone, Default)]
pub(super) struct Faces {
    faces: Vec<Face>,
    free: Vec<FaceId>,
    loops: Loops,
    triangles: usize,
    removed: Vec<FaceId>,
    added: Vec<FaceId>,
}

#[derive(Clone)]
struct Face {
    /// [`Id::NONE`] for a number that is free.
    region: RegionId,
    outer: LoopId,
    /// The holes, in no order.
    holes: Vec<LoopId>,
    /// How many half-edges its loops have.
    corners: usize,
    triangulation: Triangulation,
    /// Its place among the faces of its region.
    place: u32,
}

impl Default for Face {
    /// What a free number has.
    fn default() -> Self {
        let (holes, triangulation) = (Vec::new(), Triangulation::Whole(Vec::new()));
        Self { region: RegionId::NONE, outer: LoopId::NONE, holes, corners: 0, triangulation, place: 0 }
    }
}

/// The triangles of a face: three half-edges each, those that begin at its corners.
#[derive(Clone)]
enum Triangulation {
    One([HalfEdgeId; 3]),
    Two([[HalfEdgeId; 3]; 2]),
    Whole(Vec<[HalfEdgeId; 3]>),
    /// Those of a face of many corners, kept so that they can change with it.
    Large(Box<LargeFace>),
}

impl Triangulation {
    fn count(&self) -> usize {
        match self {
            Self::One(_) => 1,
            Self::Two(_) => 2,
            Self::Whole(triangles) => triangles.len(),
            Self::Large(large) => large.triangle_count(),
        }
    }

    fn triangle(&self, place: usize) -> [HalfEdgeId; 3] {
        match self {
            Self::One(triangle) => *triangle,
            Self::Two(triangles) => triangles[place],
            Self::Whole(triangles) => triangles[place],
            Self::Large(large) => large.triangle(place),
        }
    }
}

/// A face that is to be triangulated: the triangulation that it has, where it can change with it, and what has changed since.
struct Job {
    face: FaceId,
    large: Option<Box<LargeFace>>,
    changes: Changed,
}

/// What has changed of a large face.
enum Changed {
    /// Edges came and went.
    Edges(EdgeChanges),
    /// Corners have moved, and nothing else.
    Places,
}

/// What a change of a region has left of its faces.
#[derive(Default)]
struct Left {
    /// Those that have lost or gained a loop, and those that are new.
    touched: Vec<FaceId>,
    made: Vec<FaceId>,
    /// Half-edges of loops that are gone, each with the face that it bounded.
    pieces: Vec<(HalfEdgeId, FaceId)>,
    has_new_outers: bool,
}

impl Left {
    fn touch(&mut self, face: FaceId) {
        if face != FaceId::NONE && !holds(&self.touched, face) {
            self.touched.push(face);
        }
    }

    /// All of them.
    fn faces(&self) -> impl Iterator<Item = FaceId> + '_ {
        self.touched.iter().chain(&self.made).copied()
    }
}

/// Edges that a face has lost and gained.
#[derive(Default)]
struct EdgeChanges {
    gone: Vec<FaceEdge>,
    new: Vec<FaceEdge>,
}

/// What it takes to work on regions.
#[derive(Clone, Copy)]
struct Context<'a> {
    table: &'a PlaneTable,
    numbers: &'a Numbers,
}

impl Context<'_> {
    fn plane(&self, region: RegionId) -> RegionPlane<'_> {
        RegionPlane::new(self.table, &self.numbers.points, self.numbers.planes[region.index()])
    }
}

impl Faces {
    pub(super) fn begin_changes(&mut self) {
        self.removed.clear();
        self.added.clear();
    }

    /// The numbers of all faces, and some that are free.
    pub(super) fn ids(&self) -> impl Iterator<Item = FaceId> + use<> {
        FaceId::all(self.faces.len())
    }

    pub(super) fn changes(&self) -> (&[FaceId], &[FaceId]) {
        (&self.removed, &self.added)
    }

    pub(super) fn triangle_count(&self) -> usize {
        self.triangles
    }

    /// Chains and nests what has changed in regions, and triangulates the faces that are others than before.
    pub(super) fn update(
        &mut self,
        table: &PlaneTable,
        numbers: &Numbers,
        regions: &mut Regions,
        pieces: &mut Pieces,
    ) -> Result<(), WeldError> {
        let context = Context { table, numbers };
        let mut changes: FxHashMap<FaceId, EdgeChanges> = FxHashMap::default();
        for number in regions.take_changed() {
            self.update_region(&context, number, regions.get_mut(number), pieces, &mut changes)?;
        }
        self.triangulate(&context, pieces, |face| Changed::Edges(changes.remove(&face).unwrap_or_default()));
        Ok(())
    }

    /// The faces of some loops, ascending.
    pub(super) fn of_loops(&self, loops: &[LoopId]) -> Vec<FaceId> {
        let mut faces: Vec<FaceId> = loops.iter().map(|number| self.loops.get(*number).face).collect();
        faces.sort_unstable();
        faces.dedup();
        faces
    }

    /// Triangulates faces again whose corners have moved, and measures their loops that have.
    pub(super) fn follow(
        &mut self,
        table: &PlaneTable,
        numbers: &Numbers,
        pieces: &Pieces,
        loops: &[LoopId],
        faces: &[FaceId],
    ) {
        let context = Context { table, numbers };
        for &number in loops {
            let region = self.faces[self.loops.get(number).face.index()].region;
            self.loops.follow(table, numbers, &context.plane(region), pieces, number);
        }
        self.removed.extend_from_slice(faces);
        self.added.extend_from_slice(faces);
        self.triangles -= faces.iter().map(|face| self.faces[face.index()].triangulation.count()).sum::<usize>();
        self.triangulate(&context, pieces, |_| Changed::Places);
    }

    fn update_region(
        &mut self,
        context: &Context<'_>,
        number: RegionId,
        region: &mut Region,
        pieces: &mut Pieces,
        changes: &mut FxHashMap<FaceId, EdgeChanges>,
    ) -> Result<(), WeldError> {
        let broken = self.loops.chain(context.table, context.numbers.planes[number.index()], region, pieces)?;
        let mut left = Left::default();
        for broken in broken {
            self.unhook(broken);
            let gone = self.loops.take(pieces, broken);
            left.touch(gone.face);
            left.pieces.extend(gone.pieces.iter().map(|piece| (*piece, gone.face)));
        }
        let plane = context.plane(number);
        let mut new: Vec<LoopId> = Vec::new();
        for piece in left.pieces.iter().map(|(piece, _)| *piece).chain(region.new.drain(..)) {
            if !pieces.is_gone[piece.index()] && pieces.loop_of[piece.index()] == LoopId::NONE {
                new.push(self.loops.walk(context.table, context.numbers, &plane, pieces, piece));
            }
        }
        region.gone.clear();
        let (outers, holes): (Vec<LoopId>, Vec<LoopId>) =
            new.iter().partition(|number| self.loops.get(**number).is_outer);
        let mut owned: Vec<(LoopId, LoopId)> = Vec::with_capacity(holes.len());
        if !holes.is_empty() {
            let old = region.faces.iter().map(|face| self.faces[face.index()].outer);
            let all: Vec<LoopId> = old.filter(|outer| *outer != LoopId::NONE).chain(outers.iter().copied()).collect();
            for hole in holes {
                let owner = self.owner(&plane, pieces, &all, hole).ok_or_else(|| WeldError::hole(number))?;
                left.touch(self.loops.get(owner).face);
                owned.push((hole, owner));
            }
        }
        left.has_new_outers = !outers.is_empty();
        self.continue_faces(number, region, pieces, &mut left, outers);
        self.move_holes(&plane, pieces, &mut left, &mut owned).ok_or_else(|| WeldError::hole(number))?;
        new.retain(|number| self.loops.get(*number).is_outer);
        for (hole, owner) in owned {
            self.hook(hole, self.loops.get(owner).face);
            new.push(hole);
        }
        self.note_edges(pieces, &left, &new, changes);
        self.finish(region, left);
        Ok(())
    }

    /// Takes a loop out of its face.
    fn unhook(&mut self, number: LoopId) {
        let (face, place, corners) = {
            let old = self.loops.get(number);
            (old.face, old.place, old.pieces.len())
        };
        let face = &mut self.faces[face.index()];
        face.corners -= corners;
        if face.outer == number {
            face.outer = LoopId::NONE;
            return;
        }
        face.holes.swap_remove(place as usize);
        if let Some(moved) = face.holes.get(place as usize) {
            self.loops.get_mut(*moved).place = place;
        }
    }

    /// Makes a loop one of a face.
    fn hook(&mut self, number: LoopId, face: FaceId) {
        let entry = &mut self.faces[face.index()];
        let member = self.loops.get_mut(number);
        member.face = face;
        entry.corners += member.pieces.len();
        if member.is_outer {
            entry.outer = number;
        } else {
            member.place = number32(entry.holes.len());
            entry.holes.push(number);
        }
    }

    /// The smallest of some outer loops around a hole. Where there is but one, the hole can lie nowhere else.
    fn owner(&self, plane: &RegionPlane<'_>, pieces: &Pieces, outers: &[LoopId], hole: LoopId) -> Option<LoopId> {
        if let [only] = outers {
            return Some(*only);
        }
        let extent = |number: &LoopId| &self.loops.get(*number).extent;
        let outline = |number: LoopId| self.loops.outline(pieces, number);
        let is_around =
            |outer: &&LoopId| extent(outer).holds(extent(&hole)) && plane.contains(outline(**outer), outline(hole));
        outers.iter().filter(is_around).min_by(|p, q| extent(p).area.total_cmp(&extent(q).area)).copied()
    }

    /// Gives new outer loops faces: those that have lost their outer loops and shared edges with them, the largest loops first, or
    /// new ones.
    fn continue_faces(
        &mut self,
        number: RegionId,
        region: &mut Region,
        pieces: &Pieces,
        left: &mut Left,
        mut outers: Vec<LoopId>,
    ) {
        outers.sort_by(|p, q| self.loops.get(*q).extent.area.total_cmp(&self.loops.get(*p).extent.area));
        let headless = |faces: &Self, face: FaceId| faces.faces[face.index()].outer == LoopId::NONE;
        for outer in outers {
            let shared = left.pieces.iter().filter(|(piece, face)| {
                pieces.loop_of[piece.index()] == outer && !pieces.is_gone[piece.index()] && headless(self, *face)
            });
            let largest = shared.map(|(_, face)| *face).max_by_key(|face| self.faces[face.index()].corners);
            // where nothing of the old outer loop is left, the holes tell
            let largest = largest.or_else(|| {
                let faces = left.touched.iter().copied().filter(|face| headless(self, *face));
                faces.max_by_key(|face| self.faces[face.index()].corners)
            });
            let face = largest.unwrap_or_else(|| {
                let place_in_region = number32(region.faces.len());
                let new = Face { region: number, place: place_in_region, ..Face::default() };
                let face: FaceId = place(&mut self.faces, &mut self.free, new);
                region.faces.push(face);
                left.made.push(face);
                face
            });
            self.hook(outer, face);
        }
    }

    /// Finds the holes of touched faces that lie in others now, and takes them out; with each the outer loop around it. That takes a new outer loop,
    /// or one that is gone.
    fn move_holes(
        &mut self,
        plane: &RegionPlane<'_>,
        pieces: &Pieces,
        left: &mut Left,
        owned: &mut Vec<(LoopId, LoopId)>,
    ) -> Option<()> {
        let outer = |faces: &Self, face: FaceId| faces.faces[face.index()].outer;
        let around: Vec<LoopId> =
            left.faces().map(|face| outer(self, face)).filter(|outer| *outer != LoopId::NONE).collect();
        let first = owned.len();
        for &face in &left.touched {
            if outer(self, face) != LoopId::NONE && (!left.has_new_outers || around.len() == 1) {
                continue;
            }
            for &hole in &self.faces[face.index()].holes {
                let owner = self.owner(plane, pieces, &around, hole)?;
                if self.loops.get(owner).face != face {
                    owned.push((hole, owner));
                }
            }
        }
        for (hole, _) in &owned[first..] {
            let of_hole = self.loops.get(*hole);
            left.pieces.extend(of_hole.pieces.iter().map(|piece| (*piece, of_hole.face)));
            self.unhook(*hole);
        }
        Some(())
    }

    /// Notes what edges the triangulations of touched faces lose and gain, where these are of the kind that can change; `new` are the loops that
    /// came to faces.
    fn note_edges(&self, pieces: &Pieces, left: &Left, new: &[LoopId], changes: &mut FxHashMap<FaceId, EdgeChanges>) {
        let is_large = |face: FaceId| matches!(self.faces[face.index()].triangulation, Triangulation::Large(_));
        if !left.touched.iter().any(|face| is_large(*face)) {
            return;
        }
        let edge = |piece: HalfEdgeId| pieces.half_edges[piece.index()].edge_of_face(piece);
        let mut before: FxHashMap<HalfEdgeId, FaceId> = FxHashMap::default();
        for &(piece, face) in left.pieces.iter().filter(|(_, face)| is_large(*face)) {
            before.insert(piece, face);
            let now = pieces.loop_of[piece.index()];
            if now == LoopId::NONE || self.loops.get(now).face != face {
                changes.entry(face).or_default().gone.push(edge(piece));
            }
        }
        for entry in new.iter().map(|number| self.loops.get(*number)).filter(|entry| is_large(entry.face)) {
            let added = entry.pieces.iter().filter(|piece| before.get(piece) != Some(&entry.face));
            changes.entry(entry.face).or_default().new.extend(added.map(|piece| edge(*piece)));
        }
    }

    /// Lists the faces that are gone or others than before, and frees the numbers of those without an outer loop.
    fn finish(&mut self, region: &mut Region, left: Left) {
        for &face in &left.touched {
            let entry = &mut self.faces[face.index()];
            self.removed.push(face);
            self.triangles -= entry.triangulation.count();
            if entry.outer != LoopId::NONE {
                self.added.push(face);
                continue;
            }
            let place = std::mem::take(entry).place;
            region.faces.swap_remove(place as usize);
            if let Some(moved) = region.faces.get(place as usize) {
                self.faces[moved.index()].place = place;
            }
            self.free.push(face);
        }
        self.added.extend(left.made);
    }

    /// Triangulates the faces that were added.
    fn triangulate(&mut self, context: &Context<'_>, pieces: &Pieces, mut changed: impl FnMut(FaceId) -> Changed) {
        let (mut jobs, mut whole): (Vec<Job>, Vec<FaceId>) = (Vec::new(), Vec::new());
        for &face in &self.added {
            let entry = &mut self.faces[face.index()];
            let nothing = Triangulation::Whole(Vec::new());
            let large = match std::mem::replace(&mut entry.triangulation, nothing) {
                Triangulation::Large(large) => Some(large),
                Triangulation::One(_) | Triangulation::Two(_) | Triangulation::Whole(_) => None,
            };
            if entry.corners < LARGE {
                whole.push(face);
            } else {
                jobs.push(Job { face, large, changes: changed(face) });
            }
        }
        let faces = &*self;
        let of_large = |job: Job| (job.face, faces.triangulate_large(context, pieces, job));
        let done: Vec<(FaceId, Option<Box<LargeFace>>)> = if jobs.len() < 2 {
            jobs.into_iter().map(of_large).collect()
        } else {
            jobs.into_par_iter().with_max_len(1).map(of_large).collect()
        };
        let corners = |face: &FaceId| self.faces[face.index()].corners;
        whole.extend(done.iter().filter(|(_, large)| large.is_none()).map(|(face, _)| *face));
        let in_parts = whole.len() > 1 && whole.iter().map(corners).sum::<usize>() >= CORNERS_FOR_THREADS;
        let of_whole = |chunk: &[FaceId]| self.triangulate_whole(context, pieces, chunk);
        let triangles: Vec<Triangulation> =
            if in_parts { map_chunks(&whole, 1, of_whole).0.into_iter().flatten().collect() } else { of_whole(&whole) };
        let whole = whole.into_iter().zip(triangles);
        let large = done.into_iter().filter_map(|(face, large)| Some((face, Triangulation::Large(large?))));
        for (face, triangulation) in whole.chain(large).collect::<Vec<_>>() {
            self.triangles += triangulation.count();
            self.faces[face.index()].triangulation = triangulation;
        }
    }

    /// The triangulation of a large face: the old one where little has changed, or a new one; none where there is none.
    fn triangulate_large(&self, context: &Context<'_>, pieces: &Pieces, job: Job) -> Option<Box<LargeFace>> {
        let Job { face, large, changes } = job;
        let entry = &self.faces[face.index()];
        let plane = context.plane(entry.region);
        let at = |point: PointId| plane.position(point);
        if let Some(mut large) = large {
            let is_done = match &changes {
                Changed::Places => large.follow(at).is_ok(),
                Changed::Edges(EdgeChanges { gone, new }) => {
                    (gone.len() + new.len()) * CHANGED_SHARE < entry.corners && large.change(gone, new, at).is_ok()
                }
            };
            if is_done {
                return Some(large);
            }
        }
        let edge = |piece: &HalfEdgeId| pieces.half_edges[piece.index()].edge_of_face(*piece);
        let edges: Vec<FaceEdge> = self.loops_of(entry).flat_map(|of| &of.pieces).map(edge).collect();
        LargeFace::new(&edges, at).ok().map(Box::new)
    }

    /// The triangles of faces that are triangulated as a whole, loops in the order of the half-edges with which they begin.
    fn triangulate_whole(&self, context: &Context<'_>, pieces: &Pieces, faces: &[FaceId]) -> Vec<Triangulation> {
        let Context { table, numbers } = *context;
        let exact = WeldPoints { table, points: &numbers.points };
        let mut triangulator = Triangulator::new(&exact);
        let mut found = Triangles::default();
        let half_edge = |piece: HalfEdgeId| &pieces.half_edges[piece.index()];
        let triangles = faces.iter().map(|face| {
            let entry = &self.faces[face.index()];
            let outer = &self.loops.get(entry.outer).pieces;
            let projection = Projection::new(table.half_space(numbers.planes[entry.region.index()]).normal());
            match outer[..] {
                [a, b, c] if entry.holes.is_empty() => return Triangulation::One([a, b, c]),
                [a, b, c, d] if entry.holes.is_empty() => {
                    let at = |piece: HalfEdgeId| projection.of(numbers.position(half_edge(piece).from));
                    if let Some(two) = convex_quadrilateral([a, b, c, d].map(at)) {
                        return Triangulation::Two(two.map(|corners| corners.map(|corner| outer[corner])));
                    }
                }
                _ => {}
            }
            triangulator.begin(projection);
            let mut holes: Vec<&Loop> = self.loops_of(entry).skip(1).collect();
            holes.sort_by(|p, q| pieces.compare(table, numbers, p.pieces[0], q.pieces[0]));
            for members in self.loops_of(entry).take(1).chain(holes) {
                let corner = |piece: &HalfEdgeId| numbers.points.corner(*piece, half_edge(*piece));
                triangulator.add_loop(members.pieces.iter().map(corner));
            }
            found.corners.clear();
            found.labels.clear();
            triangulator.triangulate(&mut found);
            Triangulation::Whole(found.corners.clone())
        });
        triangles.collect()
    }

    /// The loops of a face, the outer one first.
    fn loops_of<'a>(&'a self, face: &'a Face) -> impl Iterator<Item = &'a Loop> {
        std::iter::once(&face.outer).chain(&face.holes).map(|number| self.loops.get(*number))
    }
}
