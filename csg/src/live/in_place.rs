//! A plane of a brush that moves along its normal so little that nothing but places changes: most steps of a drag.
//!
//! Between where the face was and where it is lies a part of space that the body gains or loses. As long as no corner of an
//! arrangement of the bodies lies in it, not even on its border, each edge of another body that enters it leaves it at the other side, and
//! between the two places the arrangement is that on the face, moved along: the same boundary edges, by the same planes. That is certain
//! where the body has the same faces and edges before and after, each body near either stays away from it or passes
//! within its other faces, has all of its corners surely before or beyond both places, and no two of these come together there.

use planecut_kernel::{DVec3, HalfSpace};

use super::history::New;
use super::operand::State;
use super::{Change, LiveModel};
use crate::base::Bounds;
use crate::body::{Body, PlaneFilter};
use crate::ids::{BodyFaceId, Id, OperandId};
use crate::plane_table::{PlaneTable, size_of};
use planecut_kernel::sign::Sign;

/// Room between the shadows of two bodies on a plane, as a share of the coordinates, in which they are not sure to be apart.
const SHADOW_ROOM: f64 = 1e-9;

/// A plane of a brush that is to move.
struct Shift {
    number: OperandId,
    /// Its place in the brush, and the face of the body on it.
    place: usize,
    face: BodyFaceId,
    from: HalfSpace,
    to: HalfSpace,
}

impl LiveModel {
    /// Does a change that moves a plane along its normal, where nothing but places changes; gives the states before. Otherwise
    /// nothing is done.
    pub(super) fn move_in_place(&mut self, new: &[New]) -> Option<(Change, Vec<New>)> {
        let [(id, Some(state))] = new else { return None };
        let shift = self.shift(*self.by_id.get(id)?, state)?;
        // mostly what is near the face as it is tells already, before a body is built for nothing
        self.passing(&shift, &self.body_at(shift.number).faces[shift.face.index()].bounds)?;
        let Shift { number, place, from, to, .. } = shift;
        let operand = self.operand(number);
        let used = operand.uses[place];
        let sizes = [operand.size, size_of(state.brush.half_spaces())];
        let plane = self.planes.id(used).index();
        if !self.planes.move_plane(used, &to, sizes) {
            return None;
        }
        let set_state = |model: &mut Self, state| {
            let operand = model.operands[number.index()].as_mut().expect("the brush is there");
            std::mem::replace(&mut operand.state, state)
        };
        let before = vec![(*id, Some(set_state(self, state.clone())))];
        let body = self.build(&[number], &before).pop().and_then(|placed| placed.body);
        let body = body.filter(|body| self.is_same_but_for_places(&shift, body, plane));
        let Some(body) = body else {
            let (_, old) = before.into_iter().next().expect("one brush");
            set_state(self, old.expect("it was there"));
            let [size, other] = sizes;
            assert!(self.planes.move_plane(used, &from, [other, size]), "a plane moves back to where it was");
            return None;
        };
        let operand = self.operands[number.index()].as_mut().expect("the brush is there");
        let old = operand.body.replace(body).expect("it has a body");
        operand.size = sizes[1];
        self.places.remove(&old.bounds, number);
        self.places.insert(&self.body_at(number).bounds.clone(), number);
        self.welded.follow_plane(&self.planes.table);
        let (removed, added) = self.welded.changes();
        Some((Change { brushes: vec![*id], removed: removed.to_vec(), added: added.to_vec() }, before))
    }

    /// The plane that a state of a brush moves, where it does nothing else.
    fn shift(&self, number: OperandId, state: &State) -> Option<Shift> {
        let operand = self.operand(number);
        let (old, body) = (&operand.state, operand.body.as_ref()?);
        if !operand.is_there || state.brush.is_mesh() || old.brush.faces.len() != state.brush.faces.len() {
            return None;
        }
        let place = old.brush.faces.iter().zip(&state.brush.faces).position(|(before, after)| before != after)?;
        let [before, after] = [&**old, state].map(|state| state.brush.faces[place]);
        let (from, to) = (before.half_space, after.half_space);
        if from.normal() != to.normal() || before.material != after.material {
            return None;
        }
        let mut moved_back = state.clone();
        moved_back.brush.faces[place] = before;
        if moved_back != **old {
            return None;
        }
        let plane = self.planes.id(operand.uses[place]);
        let face = body.place_on(plane)?;
        let is_alone = self.bodies_on_plane[plane.index() as usize] == 1 && body.faces[face.index()].plane == plane;
        let is_bounded = !body.faces.iter().any(|face| self.outer.holds(face.plane));
        (is_alone && is_bounded && self.marks.is_single(operand.mark)).then_some(Shift {
            number,
            place,
            face,
            from,
            to,
        })
    }

    /// Whether a body whose plane has moved makes the same boundary edges as before; then it is known what moves with them.
    fn is_same_but_for_places(&mut self, shift: &Shift, new: &Body, plane: u32) -> bool {
        let old = self.body_at(shift.number);
        if !has_same_faces(old, new) {
            return false;
        }
        let [one, other] = [old, new].map(|body| &body.faces[shift.face.index()].bounds);
        let within = one.union(other);
        let Some(near) = self.passing(shift, &within) else { return false };
        if self.welded.knows_what_moves(plane) {
            return true;
        }
        let operands = near.iter().chain([&shift.number]).map(|number| self.operand(*number));
        let edges = operands.flat_map(|operand| {
            let faces = operand.body.iter().flat_map(|body| &body.faces);
            faces.zip(&operand.edges).filter(|(face, _)| face.bounds.touches(&within)).flat_map(|(_, edges)| edges)
        });
        // borrowed apart from the weld
        let edges: Vec<_> = edges.copied().collect();
        self.welded.find_what_moves(&self.planes.table, plane, edges.iter())
    }

    /// The bodies that pass through the part of space between the face where it was and where it is, of those that touch a box; nothing where
    /// something else may change than places.
    fn passing(&self, shift: &Shift, within: &Bounds) -> Option<Vec<OperandId>> {
        let old = self.body_at(shift.number);
        let table: &PlaneTable = &self.planes.table;
        let sides: Vec<&HalfSpace> =
            old.edges(&old.faces[shift.face.index()]).iter().map(|side| table.half_space(*side)).collect();
        let filters: Vec<PlaneFilter> = sides.iter().map(|side| PlaneFilter::new(side)).collect();
        let ends = [&shift.from, &shift.to].map(PlaneFilter::new);
        let normal = shift.to.normal().normalize();
        let across = normal.any_orthonormal_vector();
        let axes = [across, normal.cross(across)];
        let mut passing = Vec::new();
        let mut shadows: Vec<Shadow> = Vec::new();
        for number in self.places.touching(within)?.filter(|number| *number != shift.number) {
            let body = self.body_at(number);
            let corners = body.all_corners();
            let extent = |side: &HalfSpace| body.bounds.extent_along(side.normal(), side.offset());
            let all = |filter: &PlaneFilter, sign: Sign| corners.iter().all(|corner| filter.side(corner) == sign);
            let is_beyond = |(side, filter): (&&HalfSpace, &PlaneFilter)| {
                let (low, high) = extent(side);
                low > 0.0 || high > 0.0 && all(filter, Sign::Positive)
            };
            let stays_before = |sign: Sign| ends.iter().all(|end| all(end, sign));
            if sides.iter().zip(&filters).any(is_beyond) || stays_before(Sign::Positive) || stays_before(Sign::Negative)
            {
                continue;
            }
            let is_within = |(side, filter): (&&HalfSpace, &PlaneFilter)| {
                let (_, high) = extent(side);
                high < 0.0 || all(filter, Sign::Negative)
            };
            let is_between = |corner| {
                let [one, other] = ends.map(|end| end.side(corner));
                one == Sign::Zero || one != other
            };
            if !sides.iter().zip(&filters).all(is_within) || corners.iter().any(is_between) {
                return None;
            }
            passing.push(number);
            shadows.push(Shadow::of(body, axes));
        }
        are_apart(&mut shadows).then_some(passing)
    }
}

/// Whether two bodies have the same faces in the same order, with the same edges: the places of corners may differ.
fn has_same_faces(one: &Body, other: &Body) -> bool {
    one.faces.len() == other.faces.len()
        && one.faces.iter().zip(&other.faces).all(|(a, b)| {
            (a.plane, a.material) == (b.plane, b.material) && super::bodies::is_rotated(one.edges(a), other.edges(b))
        })
}

/// What a body covers as it is projected onto two axes.
#[derive(Debug, Clone, Copy)]
struct Shadow {
    min: [f64; 2],
    max: [f64; 2],
}

impl Shadow {
    fn of(body: &Body, axes: [DVec3; 2]) -> Self {
        let mut shadow = Self { min: [f64::INFINITY; 2], max: [f64::NEG_INFINITY; 2] };
        for corner in body.all_corners() {
            // rounded, and the axes are not quite perpendicular: many times less than this
            let room = corner.error + SHADOW_ROOM * corner.at.abs().max_element();
            for (k, axis) in axes.iter().enumerate() {
                let at = axis.dot(corner.at);
                shadow.min[k] = shadow.min[k].min(at - room);
                shadow.max[k] = shadow.max[k].max(at + room);
            }
        }
        shadow
    }
}

/// Whether no two of some shadows touch.
fn are_apart(shadows: &mut [Shadow]) -> bool {
    shadows.sort_by(|a, b| a.min[0].total_cmp(&b.min[0]));
    (0..shadows.len()).all(|k| {
        let one = &shadows[k];
        let beside = shadows[k + 1..].iter().take_while(|other| other.min[0] <= one.max[0]);
        beside.into_iter().all(|other| other.min[1] > one.max[1] || other.max[1] < one.min[1])
    })
}
