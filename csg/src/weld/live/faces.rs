//! The faces of regions that change: which loops bound each, and its triangles.
//!
//! What is said of a face depends on its loops alone. A loop that stays keeps its face, unless a new outer loop around it has come; so of the loops of a
//! region only those are looked at that changed, and those of the faces that these bound.

use rustc_hash::FxHashMap;
use smallvec::SmallVec;

use super::loops::{Loop, Loops};
use super::names::place;
use super::numbers::Context;
use super::pieces::Pieces;
use super::regions::{Region, Regions};
use super::triangulation::{Changed, EdgeChanges, FaceTriangulator, Job, Triangulation};
use crate::ids::{FaceId, HalfEdgeId, Id, LoopId, RegionId, holds, number32};
use crate::weld::WeldError;
use crate::weld::large_face::LargeFace;
use crate::weld::nest::RegionPlane;
use crate::weld::triangulate::TriangulatorBuffers;

/// The faces, by number.
#[derive(Clone, Default)]
pub(super) struct Faces {
    faces: Vec<Face>,
    free: Vec<FaceId>,
    loops: Loops,
    triangles: usize,
    removed: Vec<FaceId>,
    added: Vec<FaceId>,
    buffers: TriangulatorBuffers,
    changed_regions: Vec<RegionId>,
}

#[derive(Clone)]
pub(super) struct Face {
    /// [`Id::NONE`] for a number that is free.
    pub(super) region: RegionId,
    outer: LoopId,
    /// The holes, in no order.
    holes: Vec<LoopId>,
    /// How many half-edges its loops have.
    corners: usize,
    pub(super) triangulation: Triangulation,
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

/// Some loops of a region: few, mostly.
type SomeLoops = SmallVec<[LoopId; 8]>;

/// Holes, each with the outer loop around it.
type OwnedHoles = SmallVec<[(LoopId, LoopId); 4]>;

/// What a change of a region has left of its faces.
#[derive(Default)]
struct Left {
    /// Those that have lost or gained a loop, and those that are new.
    touched: SmallVec<[FaceId; 8]>,
    made: SmallVec<[FaceId; 8]>,
    /// Half-edges of loops that are gone, each with the face that it bounded.
    pieces: SmallVec<[(HalfEdgeId, FaceId); 32]>,
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
        context: &Context<'_>,
        regions: &mut Regions,
        pieces: &mut Pieces,
    ) -> Result<(), WeldError> {
        let mut changes: FxHashMap<FaceId, EdgeChanges> = FxHashMap::default();
        let mut changed = std::mem::take(&mut self.changed_regions);
        regions.take_changed(&mut changed);
        for &number in &changed {
            self.update_region(context, number, regions.get_mut(number), pieces, &mut changes)?;
        }
        self.changed_regions = changed;
        self.triangulate(context, pieces, |face| Changed::Edges(changes.remove(&face).unwrap_or_default()));
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
    pub(super) fn follow(&mut self, context: &Context<'_>, pieces: &Pieces, loops: &[LoopId], faces: &[FaceId]) {
        for &number in loops {
            let region = self.faces[self.loops.get(number).face.index()].region;
            self.loops.follow(context, &context.plane(region), pieces, number);
        }
        self.removed.extend_from_slice(faces);
        self.added.extend_from_slice(faces);
        self.triangles -= faces.iter().map(|face| self.faces[face.index()].triangulation.count()).sum::<usize>();
        self.triangulate(context, pieces, |_| Changed::Places);
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
            self.loops.keep(gone.pieces);
        }
        let plane = context.plane(number);
        let mut new = SomeLoops::new();
        for piece in left.pieces.iter().map(|(piece, _)| *piece).chain(region.new.drain(..)) {
            if !pieces.is_gone[piece.index()] && pieces.loop_of[piece.index()] == LoopId::NONE {
                new.push(self.loops.walk(context, &plane, pieces, piece));
            }
        }
        region.gone.clear();
        let (outers, holes): (SomeLoops, SomeLoops) =
            new.iter().copied().partition(|number| self.loops.get(*number).is_outer);
        let mut owned = OwnedHoles::new();
        if !holes.is_empty() {
            let old = region.faces.iter().map(|face| self.faces[face.index()].outer);
            let all: SomeLoops = old.filter(|outer| *outer != LoopId::NONE).chain(outers.iter().copied()).collect();
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
        mut outers: SomeLoops,
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
        owned: &mut OwnedHoles,
    ) -> Option<()> {
        let outer = |faces: &Self, face: FaceId| faces.faces[face.index()].outer;
        let around: SomeLoops =
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
        let mut old: Vec<Option<Box<LargeFace>>> = Vec::with_capacity(self.added.len());
        for face in &self.added {
            let nothing = Triangulation::Whole(Vec::new());
            old.push(match std::mem::replace(&mut self.faces[face.index()].triangulation, nothing) {
                Triangulation::Large(large) => Some(large),
                Triangulation::One(_) | Triangulation::Two(_) | Triangulation::Whole(_) => None,
            });
        }
        let job = |(face, large): (&FaceId, Option<Box<LargeFace>>)| {
            let Face { region, outer, holes, corners, .. } = &self.faces[face.index()];
            let outer = self.loops.get(*outer);
            Job { face: *face, region: *region, outer, holes, corners: *corners, large, changed: changed(*face) }
        };
        let jobs = self.added.iter().zip(old).map(job).collect();
        let triangulator = FaceTriangulator { context: *context, pieces, loops: &self.loops };
        for (face, triangulation) in triangulator.triangulate(jobs, &mut self.buffers) {
            self.triangles += triangulation.count();
            self.faces[face.index()].triangulation = triangulation;
        }
    }

    /// A face, where there is one of this number.
    pub(super) fn get(&self, number: FaceId) -> Option<&Face> {
        self.faces.get(number.index()).filter(|face| face.region != RegionId::NONE)
    }

    /// The loop around a face.
    pub(super) fn outer_loop(&self, face: &Face) -> &Loop {
        self.loops.get(face.outer)
    }

    /// The loops of a face, the outer one first.
    pub(super) fn loops_of<'a>(&'a self, face: &'a Face) -> impl Iterator<Item = &'a Loop> {
        std::iter::once(&face.outer).chain(&face.holes).map(|number| self.loops.get(*number))
    }
}
