//! The bodies of brushes that change, and what of them is another than before.

use planecut_kernel::PlaneIdx;
use rustc_hash::FxHashMap;

use super::LiveModel;
use super::history::New;
use super::operand::{Operand, State};
use super::polytopes::{KeptPolytope, LEAST_PLANES, OUTER_BOX, PLANES_PER_CHANGE};
use crate::base::Bounds;
use crate::base::map_chunks;
use crate::body::{Body, BodyFace, BrushBody, ShapeBuilder, built_or_build, mark_of, read};
use crate::boundary::BoundaryEdge;
use crate::evaluate::UnboundedBrushes;
use crate::ids::{BodyFaceId, EdgeId, Id, OperandId};
use crate::model::MaterialId;
use crate::plane_table::PlaneId;

/// Number of brushes from which several threads build them.
pub(super) const MANY: usize = 32;

/// A body in the place of which another is put, or was, and for each of its faces the edges of the boundary on it.
pub(super) struct Placed {
    pub(super) number: OperandId,
    pub(super) body: Option<Body>,
    pub(super) edges: Vec<Vec<(BoundaryEdge, EdgeId)>>,
    /// Where it was replaced by another, how that one differs.
    pub(super) difference: Option<Difference>,
}

/// How a body differs from the one before it.
pub(super) struct Difference {
    /// The faces of the new body that the old one did not have, ascending.
    pub(super) faces: Vec<BodyFaceId>,
    /// A box around these and around the faces of the old body that the new one does not have. Points outside of it lie in
    /// both bodies or in neither: what lies in one alone is bounded by such faces.
    pub(super) bounds: Bounds,
}

impl LiveModel {
    /// The bodies of brushes as they are now; none for those that are gone, or are meshes. `before` are the brushes that were edited, as
    /// they were.
    pub(super) fn build(&mut self, numbers: &[OperandId], before: &[New]) -> Vec<Placed> {
        let placed = |number: OperandId, body: Option<Body>| {
            let edges = body.as_ref().map_or(Vec::new(), |body| vec![Vec::new(); body.faces.len()]);
            Placed { number, body, edges, difference: None }
        };
        if numbers.len() >= MANY {
            let (chunks, _) = map_chunks(numbers, MANY, |chunk| {
                let mut builder = ShapeBuilder::default();
                let body = |number: &OperandId| placed(*number, self.body(self.operand(*number), &mut builder));
                chunk.iter().map(body).collect::<Vec<Placed>>()
            });
            return chunks.into_iter().flatten().collect();
        }
        let build = |number: &OperandId| {
            let id = self.operand(*number).id;
            let old = before.iter().find(|(other, _)| *other == id).and_then(|(_, state)| state.as_deref());
            let body = match self.take_polytope(*number, old) {
                Some(mut kept) => {
                    let body = self.body_by(self.operand(*number), &mut kept);
                    self.polytopes.keep(id, kept);
                    body
                }
                None => {
                    let mut builder = self.buffers.builder.take().unwrap_or_default();
                    let body = self.body(self.operand(*number), &mut builder);
                    self.buffers.builder = Some(builder);
                    body
                }
            };
            placed(*number, body)
        };
        numbers.iter().map(build).collect()
    }

    /// The polytope by which the body of a brush is to be built: the kept one, or a new one where it is edited in a few of
    /// many planes. `old` is what the brush was, where it was edited itself.
    fn take_polytope(&mut self, number: OperandId, old: Option<&State>) -> Option<KeptPolytope> {
        let operand = self.operand(number);
        let (id, count) = (operand.id, operand.uses.len());
        let known = self.polytopes.take(id);
        let operand = self.operand(number);
        if !operand.is_there || operand.state.brush.is_mesh() || count < LEAST_PLANES {
            return None;
        }
        let Some(old) = old else { return known };
        let same = operand.state.places_in(old).into_iter().flatten().count();
        let changes = count.max(old.planes.len()) - same;
        (changes * PLANES_PER_CHANGE <= count).then(|| known.unwrap_or_default())
    }

    fn body(&self, operand: &Operand, builder: &mut ShapeBuilder) -> Option<Body> {
        if !operand.is_there || operand.state.brush.is_mesh() {
            return None;
        }
        let table = &self.planes.table;
        let planes = self.ids(operand);
        let brush = &operand.state.brush;
        let bounded = match built_or_build(table, &self.built, brush, &planes, builder) {
            BrushBody::Unbounded if self.unbounded == UnboundedBrushes::Keep => {
                let materials: Vec<MaterialId> = brush.faces.iter().map(|face| face.material).collect();
                self.outer.cut(table, &planes, &materials)
            }
            other => other,
        };
        bounded.bounded()
    }

    /// The same by a kept polytope.
    fn body_by(&self, operand: &Operand, kept: &mut KeptPolytope) -> Option<Body> {
        let table = &self.planes.table;
        let faces = &operand.state.brush.faces;
        let mut handles = operand.state.planes.clone();
        let mut planes = self.ids(operand);
        let mut update = |handles: &[PlaneIdx], planes: &[PlaneId]| {
            kept.update(handles, |k| *table.half_space(planes[k]));
            let places = kept.places(planes);
            let last = faces.last().map_or(MaterialId(0), |face| face.material);
            let material = |place: usize| faces.get(place).map_or(last, |face| face.material);
            read(table, kept.polytope(), planes, material, |plane| places[plane.0] as usize)
        };
        let bounded = match update(&handles, &planes) {
            BrushBody::Unbounded if self.unbounded == UnboundedBrushes::Keep => {
                handles.extend(OUTER_BOX);
                planes.extend(self.outer.planes());
                update(&handles, &planes)
            }
            other => other,
        };
        bounded.bounded()
    }

    /// The ids of the planes of a brush.
    fn ids(&self, operand: &Operand) -> Vec<PlaneId> {
        operand.uses.iter().map(|used| self.planes.id(*used)).collect()
    }

    /// Puts bodies in the place of others; gives these. Edges on faces of the same plane and material go over to the body
    /// that is there now.
    pub(super) fn place(&mut self, bodies: Vec<Placed>) -> Vec<Placed> {
        self.bodies_on_plane.resize(self.planes.table.len(), 0);
        self.buffers.face_on_plane.resize(self.planes.table.len(), BodyFaceId::NONE);
        bodies.into_iter().map(|placed| self.place_one(placed)).collect()
    }

    fn place_one(&mut self, mut placed: Placed) -> Placed {
        let operand = self.operands[placed.number.index()].as_mut().expect("the brush is there");
        if let Some(old) = &operand.body {
            self.places.remove(&old.bounds, placed.number);
            self.marks.remove(operand.mark);
            for face in &old.faces {
                let count = &mut self.bodies_on_plane[face.plane.index() as usize];
                *count -= u8::from(*count < u8::MAX);
            }
        }
        if let Some(new) = &placed.body {
            self.places.insert(&new.bounds, placed.number);
            operand.mark = mark_of(new.planes_and_materials());
            self.marks.insert(operand.mark);
            for face in &new.faces {
                let count = &mut self.bodies_on_plane[face.plane.index() as usize];
                *count = count.saturating_add(1);
            }
        }
        std::mem::swap(&mut operand.body, &mut placed.body);
        std::mem::swap(&mut operand.edges, &mut placed.edges);
        placed.difference = None;
        if let (Some(new), Some(old)) = (&operand.body, &placed.body) {
            let face_on_plane = &mut self.buffers.face_on_plane;
            placed.difference = Some(hand_over([new, old], [&mut operand.edges, &mut placed.edges], face_on_plane));
        }
        placed
    }
}

/// Gives edges on faces of an old body to the faces of the same plane and material of a new one; tells how the bodies differ.
/// `face_on_plane` is a buffer that holds [`Id::NONE`] for each plane.
fn hand_over(
    [new, old]: [&Body; 2],
    [new_edges, old_edges]: [&mut [Vec<(BoundaryEdge, EdgeId)>]; 2],
    face_on_plane: &mut [BodyFaceId],
) -> Difference {
    for (k, face) in BodyFaceId::all(old.faces.len()).zip(&old.faces) {
        face_on_plane[face.plane.index() as usize] = k;
    }
    let mut difference = Difference { faces: Vec::new(), bounds: Bounds::EMPTY };
    let mut is_gone = vec![true; old.faces.len()];
    for (k, face) in BodyFaceId::all(new.faces.len()).zip(&new.faces) {
        let is_same = |other: &&BodyFace| (other.plane, other.material) == (face.plane, face.material);
        let place = face_on_plane[face.plane.index() as usize].index();
        let before = old.faces.get(place).filter(is_same);
        if before.is_some() {
            std::mem::swap(&mut new_edges[k.index()], &mut old_edges[place]);
        }
        if before.is_some_and(|before| is_rotated(new.edges(face), old.edges(before))) {
            is_gone[place] = false;
        } else {
            difference.faces.push(k);
            difference.bounds = difference.bounds.union(&face.bounds);
        }
    }
    for (face, is_gone) in old.faces.iter().zip(is_gone) {
        face_on_plane[face.plane.index() as usize] = BodyFaceId::NONE;
        if is_gone {
            difference.bounds = difference.bounds.union(&face.bounds);
        }
    }
    difference
}

/// Whether two cycles of different planes are the same but for where they begin.
pub(super) fn is_rotated(one: &[PlaneId], other: &[PlaneId]) -> bool {
    one.len() == other.len()
        && other.iter().position(|plane| one.first() == Some(plane)).is_some_and(|start| {
            let (end, begin) = other.split_at(start);
            begin.iter().chain(end).eq(one)
        })
}

/// How many bodies have each mark.
#[derive(Debug, Clone, Default)]
pub(super) struct Marks(FxHashMap<u64, u32>);

impl Marks {
    fn insert(&mut self, mark: u64) {
        *self.0.entry(mark).or_default() += 1;
    }

    fn remove(&mut self, mark: u64) {
        let count = self.0.get_mut(&mark).expect("the mark of a body that is there");
        *count -= 1;
        if *count == 0 {
            self.0.remove(&mark);
        }
    }

    /// Whether one body alone has a mark.
    pub(super) fn is_single(&self, mark: u64) -> bool {
        self.0.get(&mark) == Some(&1)
    }
}
