//! The faces of regions that change, and their triangles.

use planecut_kernel::DVec3;

use super::names::place;
use super::numbers::Numbers;
use super::{Pieces, State};
use crate::base::map_chunks;
use crate::model::MaterialId;
use crate::plane_table::PlaneTable;
use crate::weld::cancel::HalfEdge;
use crate::weld::nest::{self, Nester, Projection};
use crate::weld::triangulate::{Triangles, Triangulator};
use crate::weld::{WeldError, loops};

/// The number of a face, as long as it stays as it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FaceId(u32);

/// A planar, connected region of the boundary of a live model, with its triangles.
#[derive(Clone, Copy)]
pub struct LiveFace<'a> {
    numbers: &'a Numbers,
    state: &'a State,
    face: &'a Face,
}

impl<'a> LiveFace<'a> {
    pub(super) fn new(numbers: &'a Numbers, state: &'a State, FaceId(number): FaceId) -> Option<Self> {
        let face = state.faces.faces.get(number as usize).filter(|face| !face.pieces.is_empty())?;
        Some(Self { numbers, state, face })
    }

    /// What it is made of.
    #[must_use]
    pub fn material(&self) -> MaterialId {
        self.numbers.material(self.face.region)
    }

    /// The triangles, counter-clockwise seen from outside: for each corner the number of its vertex, equal for what is one
    /// corner of the solid as long as nothing changes there, and its position.
    pub fn triangles(&self) -> impl ExactSizeIterator<Item = [(u32, DVec3); 3]> + use<'a> {
        let Self { numbers, state, face } = *self;
        let corner = |piece: u32| {
            let position = numbers.position(state.pieces.half_edges[piece as usize].from);
            (state.vertices.at(piece), position)
        };
        face.triangles.iter().map(move |corners| corners.map(corner))
    }
}

/// The regions, by number.
#[derive(Default)]
pub(super) struct Regions {
    regions: Vec<Region>,
    changed: Vec<u32>,
}

#[derive(Default)]
struct Region {
    /// Its half-edges: first those of the last update, in the order of where they begin and end, then new ones.
    pieces: Vec<u32>,
    settled: usize,
    /// What came or went since the last update.
    changes: Vec<HalfEdge>,
    faces: Vec<u32>,
    /// Where corners touch the inside of edges: line and point.
    pinches: Vec<(u32, u32)>,
}

impl Regions {
    pub(super) fn add_piece(&mut self, number: u32, piece: &HalfEdge) {
        self.change(piece);
        self.regions[piece.region as usize].pieces.push(number);
    }

    /// Notes that a half-edge came or went.
    pub(super) fn change(&mut self, piece: &HalfEdge) {
        let region = piece.region;
        if region as usize >= self.regions.len() {
            self.regions.resize_with(region as usize + 1, Region::default);
        }
        let entry = &mut self.regions[region as usize];
        if entry.changes.is_empty() {
            self.changed.push(region);
        }
        entry.changes.push(*piece);
    }

    pub(super) fn changed(&self) -> &[u32] {
        &self.changed
    }

    /// The half-edges that were there at the last update, some of them gone by now, and the new ones.
    pub(super) fn pieces(&self, region: u32) -> (&[u32], &[u32]) {
        let region = &self.regions[region as usize];
        region.pieces.split_at(region.settled)
    }

    pub(super) fn add_pinch(&mut self, region: u32, pinch: (u32, u32)) {
        self.regions[region as usize].pinches.push(pinch);
    }

    /// Takes the pinches away that may be none any more, as something changed on their line or at their point: region, line
    /// and point of each.
    pub(super) fn take_doubtful_pinches(&mut self) -> Vec<(u32, u32, u32)> {
        let mut doubtful = Vec::new();
        for &region in &self.changed {
            let Region { pinches, changes, .. } = &mut self.regions[region as usize];
            pinches.retain(|&(line, point)| {
                let concerns = |piece: &HalfEdge| piece.line == line || piece.from == point || piece.to == point;
                let is_doubtful = changes.iter().any(concerns);
                if is_doubtful {
                    doubtful.push((region, line, point));
                }
                !is_doubtful
            });
        }
        doubtful
    }
}

/// Number of corners, of all faces together, from which several threads triangulate them.
const CORNERS_FOR_THREADS: usize = 400;

/// The faces, by number.
#[derive(Default)]
pub(super) struct Faces {
    faces: Vec<Face>,
    free: Vec<u32>,
    triangles: usize,
    removed: Vec<FaceId>,
    added: Vec<FaceId>,
    /// The place of the first half-edge of each point among those of the region that is looked at.
    first_at: Vec<u32>,
}

#[derive(Default)]
struct Face {
    region: u32,
    /// Its half-edges, loop by loop, the outer one first.
    pieces: Vec<u32>,
    /// Where each loop ends among them.
    loops: Vec<u32>,
    /// Three half-edges each: those that begin at its corners.
    triangles: Vec<[u32; 3]>,
    /// Whether it was met in the last update of its region.
    is_met: bool,
}

impl Faces {
    pub(super) fn begin_changes(&mut self) {
        self.removed.clear();
        self.added.clear();
    }

    /// The numbers of all faces, and some that are free.
    pub(super) fn ids(&self) -> impl Iterator<Item = FaceId> + use<> {
        (0..self.faces.len() as u32).map(FaceId)
    }

    pub(super) fn changes(&self) -> (&[FaceId], &[FaceId]) {
        (&self.removed, &self.added)
    }

    pub(super) fn triangle_count(&self) -> usize {
        self.triangles
    }

    /// Chains and nests the regions that have changed, and triangulates their new faces.
    pub(super) fn update(
        &mut self,
        table: &PlaneTable,
        numbers: &Numbers,
        regions: &mut Regions,
        pieces: &mut Pieces,
    ) -> Result<(), WeldError> {
        let (order, half_edges) = sorted(table, numbers, regions, pieces);
        self.first_at.resize(numbers.points.planes.len(), 0);
        let mut nester = Nester::new(table, &numbers.points);
        let mut following = Vec::with_capacity(half_edges.len());
        let mut found = nest::Faces::default();
        let first_at = &mut self.first_at;
        let mut start = 0;
        for members in half_edges.chunk_by(|a, b| a.region == b.region) {
            let plane = numbers.planes[members[0].region as usize];
            for (place, piece) in members.iter().enumerate().rev() {
                first_at[piece.from as usize] = (start + place) as u32;
            }
            let first = |point: u32| (first_at[point as usize] as usize).wrapping_sub(start);
            loops::follow(table, plane, members, start as u32, first, &mut following)?;
            nester.add_faces(plane, members, start as u32, &following[start..], &mut found)?;
            start += members.len();
        }
        for (place, next) in following.iter().enumerate() {
            let (piece, next) = (order[place], order[*next as usize]);
            if pieces.following[piece as usize] != next {
                pieces.following[piece as usize] = next;
                pieces.turned.push(pieces.half_edges[piece as usize].twin);
            }
        }
        let new: Vec<nest::Face<'_>> = found.iter().filter(|face| !self.is_known(pieces, &order, *face)).collect();
        let triangulate = |faces: &[nest::Face<'_>]| {
            let mut triangulator = Triangulator::new(table, &numbers.points);
            let triangles = faces.iter().map(|face| {
                let normal = table.half_space(numbers.planes[face.region as usize]).normal();
                triangulator.begin(Projection::new(normal));
                for members in face.loops() {
                    let corner = |place: &u32| {
                        let piece = order[*place as usize];
                        (piece, &half_edges[*place as usize], piece)
                    };
                    triangulator.add_loop(members.iter().map(corner));
                }
                let mut triangles = Triangles::default();
                triangulator.triangulate(&mut triangles);
                triangles.vertices
            });
            triangles.collect::<Vec<Vec<[u32; 3]>>>()
        };
        let corners: usize = new.iter().flat_map(|face| face.loops()).map(<[u32]>::len).sum();
        let triangles = if corners < CORNERS_FOR_THREADS || new.len() < 2 {
            triangulate(&new)
        } else {
            map_chunks(&new, 1, triangulate).0.concat()
        };
        for (face, triangles) in new.into_iter().zip(triangles) {
            self.add(pieces, &order, face, triangles);
        }
        for region in std::mem::take(&mut regions.changed) {
            let region = &mut regions.regions[region as usize];
            region.changes.clear();
            region.settled = region.pieces.len();
            for face in std::mem::take(&mut region.faces) {
                if std::mem::take(&mut self.faces[face as usize].is_met) {
                    region.faces.push(face);
                } else {
                    self.remove(face);
                }
            }
        }
        for FaceId(face) in &self.added {
            regions.regions[self.faces[*face as usize].region as usize].faces.push(*face);
        }
        Ok(())
    }

    /// Whether a face is there already; then it is noted as met.
    fn is_known(&mut self, pieces: &Pieces, order: &[u32], face: nest::Face<'_>) -> bool {
        let Some(first) = face.loops().next().and_then(|outer| outer.first()) else { return false };
        let Some(known) = self.faces.get_mut(pieces.face[order[*first as usize] as usize] as usize) else {
            return false;
        };
        let numbers = face.loops().flatten().map(|place| order[*place as usize]);
        let mut end = 0;
        let ends = face.loops().map(|members| {
            end += members.len() as u32;
            end
        });
        known.is_met = known.pieces.iter().copied().eq(numbers) && known.loops.iter().copied().eq(ends);
        known.is_met
    }

    fn add(&mut self, pieces: &mut Pieces, order: &[u32], face: nest::Face<'_>, triangles: Vec<[u32; 3]>) {
        let mut entry = Face { region: face.region, triangles, ..Face::default() };
        for members in face.loops() {
            entry.pieces.extend(members.iter().map(|place| order[*place as usize]));
            entry.loops.push(entry.pieces.len() as u32);
        }
        self.triangles += entry.triangles.len();
        let number = place(&mut self.faces, &mut self.free, Face::default());
        for piece in &entry.pieces {
            pieces.face[*piece as usize] = number;
        }
        self.faces[number as usize] = entry;
        self.added.push(FaceId(number));
    }

    fn remove(&mut self, face: u32) {
        let Face { triangles, .. } = std::mem::take(&mut self.faces[face as usize]);
        self.triangles -= triangles.len();
        self.free.push(face);
        self.removed.push(FaceId(face));
    }
}

/// The half-edges of all regions that have changed, region by region in the order of where they begin and end: their numbers and
/// themselves. Those that are gone are taken out of their regions.
fn sorted(table: &PlaneTable, numbers: &Numbers, regions: &mut Regions, pieces: &Pieces) -> (Vec<u32>, Vec<HalfEdge>) {
    let mut order = Vec::new();
    for &region in &regions.changed {
        let members = &mut regions.regions[region as usize].pieces;
        members.retain(|piece| !pieces.is_gone[*piece as usize]);
        // stable, as that finds what is sorted already
        members.sort_by(|p, q| {
            let [p, q] = [p, q].map(|piece| &pieces.half_edges[*piece as usize]);
            numbers.compare(table, p.from, q.from).then_with(|| numbers.compare(table, p.to, q.to))
        });
        order.extend_from_slice(members);
    }
    let half_edges = order.iter().map(|piece| pieces.half_edges[*piece as usize]).collect();
    (order, half_edges)
}
