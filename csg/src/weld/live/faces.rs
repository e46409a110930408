//! The faces of regions that change, and their triangles.

use crate::ids::number32;
use planecut_kernel::DVec3;

use super::names::place;
use super::numbers::Numbers;
use super::{Pieces, State};
use crate::base::map_chunks;
use crate::ids::{FaceId, HalfEdgeId, Id, PointId, PointOnLine, RegionId};
use crate::model::MaterialId;
use crate::plane_table::{PlaneId, PlaneTable};
use crate::weld::cancel::HalfEdge;
use crate::weld::nest::{self, Nester, Projection};
use crate::weld::triangulate::{Triangles, Triangulator, WeldPoints};
use crate::weld::{WeldError, loops};

/// A planar, connected region of the boundary, with its triangles.
#[derive(Clone, Copy)]
pub(crate) struct WeldedFace<'a> {
    numbers: &'a Numbers,
    state: &'a State,
    face: &'a Face,
}

impl<'a> WeldedFace<'a> {
    pub(super) fn new(numbers: &'a Numbers, state: &'a State, number: FaceId) -> Option<Self> {
        let face = state.faces.faces.get(number.index()).filter(|face| !face.pieces.is_empty())?;
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
        self.face.triangles.len()
    }

    /// A triangle: for each corner the number of its vertex, and its position.
    pub(crate) fn triangle(&self, place: usize) -> [(u32, DVec3); 3] {
        let Self { numbers, state, face } = self;
        let corner = |piece: HalfEdgeId| {
            let position = numbers.position(state.pieces.half_edges[piece.index()].from);
            (state.vertices.at(piece).number(), position)
        };
        face.triangles[place].map(corner)
    }
}

/// The regions, by number.
#[derive(Default)]
pub(super) struct Regions {
    regions: Vec<Region>,
    changed: Vec<RegionId>,
}

#[derive(Default)]
struct Region {
    /// Its half-edges: first those of the last update, in the order of where they begin and end, then new ones.
    pieces: Vec<HalfEdgeId>,
    settled: usize,
    /// What came or went since the last update.
    changes: Vec<HalfEdge>,
    faces: Vec<FaceId>,
    /// Where corners touch the inside of edges.
    pinches: Vec<PointOnLine>,
}

impl Regions {
    pub(super) fn add_piece(&mut self, number: HalfEdgeId, piece: &HalfEdge) {
        self.change(piece);
        self.regions[piece.region.index()].pieces.push(number);
    }

    /// Notes that a half-edge came or went.
    pub(super) fn change(&mut self, piece: &HalfEdge) {
        let region = piece.region;
        if region.index() >= self.regions.len() {
            self.regions.resize_with(region.index() + 1, Region::default);
        }
        let entry = &mut self.regions[region.index()];
        if entry.changes.is_empty() {
            self.changed.push(region);
        }
        entry.changes.push(*piece);
    }

    pub(super) fn changed(&self) -> &[RegionId] {
        &self.changed
    }

    /// The half-edges that were there at the last update, some of them gone by now, and the new ones.
    pub(super) fn pieces(&self, region: RegionId) -> (&[HalfEdgeId], &[HalfEdgeId]) {
        let region = &self.regions[region.index()];
        region.pieces.split_at(region.settled)
    }

    pub(super) fn add_pinch(&mut self, region: RegionId, pinch: PointOnLine) {
        self.regions[region.index()].pinches.push(pinch);
    }

    /// Takes the pinches away that may be none any more, as something changed on their line or at their point; the region
    /// of each as well.
    pub(super) fn take_doubtful_pinches(&mut self) -> Vec<(RegionId, PointOnLine)> {
        let mut doubtful = Vec::new();
        for &region in &self.changed {
            let Region { pinches, changes, .. } = &mut self.regions[region.index()];
            pinches.retain(|&pinch| {
                let PointOnLine { line, point } = pinch;
                let concerns = |piece: &HalfEdge| piece.line == line || piece.from == point || piece.to == point;
                let is_doubtful = changes.iter().any(concerns);
                if is_doubtful {
                    doubtful.push((region, pinch));
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
    free: Vec<FaceId>,
    triangles: usize,
    removed: Vec<FaceId>,
    added: Vec<FaceId>,
    /// The place of the first half-edge of each point among those of the region that is looked at.
    first_at: Vec<HalfEdgeId>,
}

struct Face {
    region: RegionId,
    /// Its half-edges, loop by loop, the outer one first.
    pieces: Vec<HalfEdgeId>,
    /// Where each loop ends among them.
    loops: Vec<u32>,
    /// Three half-edges each: those that begin at its corners.
    triangles: Vec<[HalfEdgeId; 3]>,
    /// Whether it was met in the last update of its region.
    is_met: bool,
}

impl Default for Face {
    /// What a free number has.
    fn default() -> Self {
        let (pieces, loops, triangles) = (Vec::new(), Vec::new(), Vec::new());
        Self { region: RegionId::NONE, pieces, loops, triangles, is_met: false }
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

    /// Chains and nests the regions that have changed, and triangulates their new faces.
    pub(super) fn update(
        &mut self,
        table: &PlaneTable,
        numbers: &Numbers,
        regions: &mut Regions,
        pieces: &mut Pieces,
    ) -> Result<(), WeldError> {
        let (order, half_edges) = sorted(table, numbers, regions, pieces);
        self.first_at.resize(numbers.points.planes.len(), HalfEdgeId::NONE);
        let mut nester = Nester::new(table, &numbers.points);
        let mut following = Vec::with_capacity(half_edges.len());
        let mut found = nest::Faces::default();
        let first_at = &mut self.first_at;
        let mut start = 0;
        for members in half_edges.chunk_by(|a, b| a.region == b.region) {
            let plane = numbers.planes[members[0].region.index()];
            for (place, piece) in members.iter().enumerate().rev() {
                first_at[piece.from.index()] = HalfEdgeId::from_index(start + place);
            }
            let first = |point: PointId| first_at[point.index()].index().wrapping_sub(start);
            loops::follow(table, plane, members, start, first, &mut following)?;
            nester.add_faces(plane, members, start, &following[start..], &mut found)?;
            start += members.len();
        }
        for (place, next) in following.iter().enumerate() {
            let (piece, next) = (order[place], order[next.index()]);
            if pieces.following[piece.index()] != next {
                pieces.following[piece.index()] = next;
                pieces.turned.push(pieces.half_edges[piece.index()].twin);
            }
        }
        let new: Vec<nest::Face<'_>> = found.iter().filter(|face| !self.is_known(pieces, &order, *face)).collect();
        let triangulate = |faces: &[nest::Face<'_>]| {
            let exact = WeldPoints { table, points: &numbers.points };
            let mut triangulator = Triangulator::new(&exact);
            let triangles = faces.iter().map(|face| {
                let normal = table.half_space(numbers.planes[face.region.index()]).normal();
                triangulator.begin(Projection::new(normal));
                for members in face.loops() {
                    triangulator.add_loop(
                        members.iter().map(|k| numbers.points.corner(order[k.index()], &half_edges[k.index()])),
                    );
                }
                let mut triangles = Triangles::default();
                triangulator.triangulate(&mut triangles);
                triangles.corners
            });
            triangles.collect::<Vec<Vec<[HalfEdgeId; 3]>>>()
        };
        let corners: usize = new.iter().flat_map(|face| face.loops()).map(<[HalfEdgeId]>::len).sum();
        let triangles = if corners < CORNERS_FOR_THREADS || new.len() < 2 {
            triangulate(&new)
        } else {
            map_chunks(&new, 1, triangulate).0.concat()
        };
        for (face, triangles) in new.into_iter().zip(triangles) {
            self.add(pieces, &order, face, triangles);
        }
        for region in std::mem::take(&mut regions.changed) {
            let region = &mut regions.regions[region.index()];
            region.changes.clear();
            region.settled = region.pieces.len();
            for face in std::mem::take(&mut region.faces) {
                if std::mem::take(&mut self.faces[face.index()].is_met) {
                    region.faces.push(face);
                } else {
                    self.remove(face);
                }
            }
        }
        for face in &self.added {
            regions.regions[self.faces[face.index()].region.index()].faces.push(*face);
        }
        Ok(())
    }

    /// Whether a face is there already; then it is noted as met.
    fn is_known(&mut self, pieces: &Pieces, order: &[HalfEdgeId], face: nest::Face<'_>) -> bool {
        let Some(first) = face.loops().next().and_then(|outer| outer.first()) else { return false };
        let Some(known) = self.faces.get_mut(pieces.face[order[first.index()].index()].index()) else {
            return false;
        };
        let numbers = face.loops().flatten().map(|place| order[place.index()]);
        let mut end = 0;
        let ends = face.loops().map(|members| {
            end += number32(members.len());
            end
        });
        known.is_met = known.pieces.iter().copied().eq(numbers) && known.loops.iter().copied().eq(ends);
        known.is_met
    }

    fn add(
        &mut self,
        pieces: &mut Pieces,
        order: &[HalfEdgeId],
        face: nest::Face<'_>,
        triangles: Vec<[HalfEdgeId; 3]>,
    ) {
        let mut entry = Face { region: face.region, triangles, ..Face::default() };
        for members in face.loops() {
            entry.pieces.extend(members.iter().map(|place| order[place.index()]));
            entry.loops.push(number32(entry.pieces.len()));
        }
        self.triangles += entry.triangles.len();
        let number = place(&mut self.faces, &mut self.free, Face::default());
        for piece in &entry.pieces {
            pieces.face[piece.index()] = number;
        }
        self.faces[number.index()] = entry;
        self.added.push(number);
    }

    fn remove(&mut self, face: FaceId) {
        let Face { triangles, .. } = std::mem::take(&mut self.faces[face.index()]);
        self.triangles -= triangles.len();
        self.free.push(face);
        self.removed.push(face);
    }
}

/// The half-edges of all regions that have changed, region by region in the order of where they begin and end: their numbers and
/// themselves. Those that are gone are taken out of their regions.
fn sorted(
    table: &PlaneTable,
    numbers: &Numbers,
    regions: &mut Regions,
    pieces: &Pieces,
) -> (Vec<HalfEdgeId>, Vec<HalfEdge>) {
    let mut order = Vec::new();
    for &region in &regions.changed {
        let members = &mut regions.regions[region.index()].pieces;
        members.retain(|piece| !pieces.is_gone[piece.index()]);
        // stable, as that finds what is sorted already
        members.sort_by(|p, q| {
            let [p, q] = [p, q].map(|piece| &pieces.half_edges[piece.index()]);
            numbers.compare(table, p.from, q.from).then_with(|| numbers.compare(table, p.to, q.to))
        });
        order.extend_from_slice(members);
    }
    let half_edges = order.iter().map(|piece| pieces.half_edges[piece.index()]).collect();
    (order, half_edges)
}
