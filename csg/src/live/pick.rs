//! Which face a ray meets first.
//!
//! Mostly the bodies tell. Each one near the ray holds an interval of it; between the ends of all intervals lie stretches on which the tree of operations has one
//! value, and the first end at which that changes is on the boundary. The face there lies on the plane of that end, and which of those on the plane it is, their triangles
//! tell, where there are several. Nothing is kept for this from edit to edit.
//!
//! Where ends of different planes are too near each other to tell their order, as where a ray goes through an edge or a corner, in a face, or begins on the boundary, the triangles
//! of all faces near the ray tell.

use planecut_kernel::DVec3;
use rustc_hash::FxHashSet;

use super::tree::Member;
use super::{LiveFace, LiveModel};
use crate::base::{IN_BOX, Ray};
use crate::body::Body;
use crate::expression::{Expression, Restriction};
use crate::ids::{FaceId, Id, KeptLeafId, LeafId};
use crate::model::MaterialId;
use crate::plane_table::{PlaneId, PlaneTable};
use crate::tolerances::RAY_MARGIN;
use crate::weld::{Projection, WeldedFace};

/// What bodies tell of a ray.
enum Told {
    /// The first face and how far away it is.
    Met(FaceId, f64),
    Nothing,
    /// It is too near to call.
    Unclear,
}

/// Where a ray may enter or leave a body.
struct End {
    /// The member that it enters or leaves.
    member: usize,
    what: What,
    /// How far away that is, and between which bounds.
    at: f64,
    low: f64,
    high: f64,
    /// The face that it goes through, where that is clear.
    face: Option<(PlaneId, MaterialId)>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum What {
    Enters,
    Leaves,
    /// It may enter and leave it, or pass it by.
    Grazes,
}

impl LiveModel {
    /// The first face that the ray `origin + t·direction`, `t ≥ 0`, meets from either side, and the distance from the origin to where it does. `None` where it meets none, the
    /// direction is zero, or a number is not finite. Through an edge or a corner it may meet any of the faces there.
    ///
    /// It takes some microseconds, whatever the size of the model, and more where the ray meets edges, or very many brushes. Where a brush is a closed mesh, the first
    /// ray after an edit takes as long as making a tree of boxes around all triangles.
    ///
    /// ```
    /// use planecut_csg::{Brush, LiveModel, Material, MaterialId, Role};
    /// use planecut_kernel::DVec3;
    ///
    /// # fn main() -> Result<(), planecut_csg::EditError> {
    /// let mut model = LiveModel::new(vec![Material::named("stone")]);
    /// model.add_brush(Brush::cuboid(DVec3::ZERO, DVec3::splat(2.0), MaterialId(0)), Role::Add)?;
    /// let (face, distance) = model.pick(DVec3::new(1.0, 0.5, 5.0), -DVec3::Z).expect("it meets the top");
    /// assert_eq!((model.face(face).expect("it is there").normal(), distance), (DVec3::Z, 3.0));
    /// assert_eq!(model.pick(DVec3::new(1.0, 0.5, 5.0), DVec3::Z), None);
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn pick(&self, origin: DVec3, direction: DVec3) -> Option<(FaceId, f64)> {
        let ray = Ray::new(origin, direction)?;
        if let Some(evaluated) = &self.evaluated {
            return evaluated.first_hit(&ray);
        }
        match self.told_by_bodies(&ray) {
            Told::Met(face, distance) => Some((face, distance)),
            Told::Nothing => None,
            Told::Unclear => self.first_of_faces_near(&ray),
        }
    }

    fn told_by_bodies(&self, ray: &Ray) -> Told {
        let mut values = Values::new(self, ray);
        let mut ends = Vec::new();
        for k in 0..values.members.len() {
            let body = self.body_at(values.members[k].operand);
            let starts_inside = pass(&self.planes.table, body, ray, k, &mut ends);
            if starts_inside {
                values.turn(k);
            }
        }
        ends.sort_unstable_by(|a, b| a.low.total_cmp(&b.low));
        let mut rest = &ends[..];
        while let [first, ..] = rest {
            let mut high = first.high;
            let near = |end: &&End| {
                let is_near = end.low <= high;
                high = if is_near { high.max(end.high) } else { high };
                is_near
            };
            let (together, later) = rest.split_at(rest.iter().take_while(near).count());
            if first.low <= 0.0 || together.iter().any(|end| end.what == What::Grazes) {
                return Told::Unclear;
            }
            let before = values.value();
            together.iter().for_each(|end| values.turn(end.member));
            let after = values.value();
            if before != after {
                return self.face_at(ray, together, after);
            }
            if !lie_on_one_plane(together) && together.len() > 1 {
                return Told::Unclear;
            }
            rest = later;
        }
        Told::Nothing
    }

    /// The face at ends that are one place, where the ray goes into the solid or out of it.
    fn face_at(&self, ray: &Ray, ends: &[End], goes_in: bool) -> Told {
        let [End { face: Some((plane, _)), what, at, .. }, ..] = ends else { return Told::Unclear };
        if !lie_on_one_plane(ends) {
            return Told::Unclear;
        }
        let outward = if (*what == What::Enters) == goes_in { *plane } else { plane.flipped() };
        let mut materials: Vec<MaterialId> = ends.iter().filter_map(|end| Some(end.face?.1)).collect();
        materials.sort_unstable();
        materials.dedup();
        let mut faces: Vec<(FaceId, WeldedFace<'_>)> =
            materials.iter().flat_map(|material| self.faces_near(ray, outward, *material)).collect();
        // it is one of them: where it is none of the others, it is the largest
        faces.sort_unstable_by_key(|(_, face)| face.triangle_count());
        let Some(((largest, _), others)) = faces.split_last() else { return Told::Unclear };
        let is_met = |(_, face): &&(FaceId, WeldedFace<'_>)| {
            LiveFace::welded(*face).triangles().any(|corners| ray.distance_to(corners.map(|c| c.1)).is_some())
        };
        let found = others.iter().find(is_met).map_or(*largest, |(face, _)| *face);
        Told::Met(found, *at)
    }

    /// The first face by the triangles of all faces on planes of bodies near the ray.
    fn first_of_faces_near(&self, ray: &Ray) -> Option<(FaceId, f64)> {
        let mut sides: FxHashSet<(PlaneId, MaterialId)> = FxHashSet::default();
        for number in self.places.along(ray) {
            let near =
                self.body_at(number).faces.iter().filter(|face| ray.distance_to_box(&face.bounds, IN_BOX).is_some());
            sides.extend(near.flat_map(|face| [(face.plane, face.material), (face.plane.flipped(), face.material)]));
        }
        let faces = sides.into_iter().flat_map(|(plane, material)| self.faces_near(ray, plane, material));
        let distance = |(id, face)| {
            let distances =
                LiveFace::welded(face).triangles().filter_map(|corners| ray.distance_to(corners.map(|c| c.1)));
            distances.min_by(f64::total_cmp).map(|distance| (id, distance))
        };
        faces.filter_map(distance).min_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)))
    }

    /// The faces on a plane of which a ray may meet the boxes around them.
    fn faces_near(
        &self,
        ray: &Ray,
        plane: PlaneId,
        material: MaterialId,
    ) -> impl Iterator<Item = (FaceId, WeldedFace<'_>)> {
        let half_space = self.planes.table.half_space(plane);
        let (normal, projection) = (half_space.normal(), Projection::new(half_space.normal()));
        let rise = normal.dot(ray.direction());
        let place = ray.origin() + (half_space.offset() - normal.dot(ray.origin())) / rise * ray.direction();
        let size = place.abs().max_element().max(ray.origin().abs().max_element());
        // the less the ray is inclined to the plane, the less is known of where it meets it
        let margin = IN_BOX * size * normal.length() / rise.abs();
        let is_near = move |face: &WeldedFace<'_>| !margin.is_finite() || face.may_hold(projection, place, margin);
        self.welded.faces_on(plane, material).filter(move |(_, face)| is_near(face))
    }
}

/// Whether ends are known to be on faces of one plane, from either side.
fn lie_on_one_plane(ends: &[End]) -> bool {
    let plane = |end: &End| end.face.map(|(plane, _)| plane.index());
    ends.iter().all(|end| end.face.is_some() && plane(end) == plane(&ends[0]))
}

/// The value of the operations along a ray: which of the members, all near it, hold a place.
struct Values {
    members: Vec<Member>,
    holds: Vec<bool>,
    /// The operations on them.
    expression: Expression,
    restriction: Restriction,
}

impl Values {
    fn new(model: &LiveModel, ray: &Ray) -> Self {
        let member = |operand| Member { at: model.position(operand), operand };
        let mut members: Vec<Member> = model.places.along(ray).map(member).collect();
        members.sort_unstable();
        let nodes = model.tree.near(&mut members, |member| model.operand(member.operand).state.role);
        let expression = Expression::new(&nodes);
        let mut restriction = Restriction::default();
        let leaves: Vec<LeafId> = LeafId::all(members.len()).collect();
        restriction.restrict(&expression, &leaves);
        Self { holds: vec![false; members.len()], members, expression, restriction }
    }

    /// Notes that the ray enters or leaves a member.
    fn turn(&mut self, member: usize) {
        let holds = !self.holds[member];
        self.holds[member] = holds;
        self.restriction.set(&self.expression, KeptLeafId::from_index(member), 0, holds);
    }

    fn value(&self) -> bool {
        if self.members.is_empty() { self.expression.base() } else { self.restriction.root(0) }
    }
}

/// Ends of a ray in a body: the planes that it crosses in one direction.
struct Side {
    low: f64,
    high: f64,
    at: f64,
    at_low: f64,
    face: Option<(PlaneId, MaterialId)>,
    /// The bound of all planes but the one at `at`.
    others: f64,
}

impl Side {
    const NONE: Self = Self {
        low: f64::NEG_INFINITY,
        high: f64::NEG_INFINITY,
        at: f64::NEG_INFINITY,
        at_low: f64::NEG_INFINITY,
        face: None,
        others: f64::NEG_INFINITY,
    };

    /// Notes a plane; the farthest one counts.
    fn add(&mut self, at: f64, margin: f64, face: (PlaneId, MaterialId)) {
        self.low = self.low.max(at - margin);
        if at > self.at {
            self.others = self.high;
            (self.at, self.at_low, self.face) = (at, at - margin, Some(face));
        } else {
            self.others = self.others.max(at + margin);
        }
        self.high = self.high.max(at + margin);
    }

    /// The face of the plane that is farther than all others, if one is.
    fn clear_face(&self) -> Option<(PlaneId, MaterialId)> {
        self.face.filter(|_| self.at_low > self.others)
    }
}

/// Notes where a ray enters and leaves a body, as far as that is ahead; whether it begins inside.
fn pass(table: &PlaneTable, body: &Body, ray: &Ray, member: usize, ends: &mut Vec<End>) -> bool {
    let (origin, direction) = (ray.origin(), ray.direction());
    // distances back along the ray where it leaves, so that there the farthest counts, too
    let (mut enters, mut leaves) = (Side::NONE, Side::NONE);
    let mut may_miss = false;
    for face in &body.faces {
        let half_space = table.half_space(face.plane);
        let (normal, offset) = (half_space.normal(), half_space.offset());
        let (rise, room) = (normal.dot(direction), offset - normal.dot(origin));
        let size = normal.abs().element_sum();
        let margin = RAY_MARGIN * ((normal * origin).abs().element_sum() + offset.abs());
        if rise.abs() <= RAY_MARGIN * size {
            // so little inclined that where they meet is not known; within the body it does not rise by more than this
            let reach = body.bounds.min.abs().max(body.bounds.max.abs()).element_sum() + origin.abs().element_sum();
            let margin = if rise == 0.0 { margin } else { margin + RAY_MARGIN * size * reach };
            if room < -margin {
                return false;
            }
            may_miss |= room <= margin;
            continue;
        }
        let at = room / rise;
        let margin = (margin + RAY_MARGIN * size * at.abs()) / rise.abs();
        let face = (face.plane, face.material);
        if rise < 0.0 { enters.add(at, margin, face) } else { leaves.add(-at, margin, face) }
    }
    let [leaves_from, leaves_to] = [-leaves.high, -leaves.low];
    if enters.low > leaves_to || leaves_to < 0.0 {
        return false;
    }
    if may_miss || enters.high >= leaves_from {
        ends.push(End { member, what: What::Grazes, at: enters.at, low: enters.low, high: leaves_to, face: None });
        return false;
    }
    let (low, high, face) = (leaves_from, leaves_to, leaves.clear_face());
    ends.push(End { member, what: What::Leaves, at: -leaves.at, low, high, face });
    if enters.high < 0.0 {
        return true;
    }
    let (low, high, face) = (enters.low, enters.high, enters.clear_face());
    ends.push(End { member, what: What::Enters, at: enters.at, low, high, face });
    false
}

#[cfg(test)]
mod tests {
    use planecut_kernel::DMat3;

    use super::*;
    use crate::live::Role;
    use crate::model::{Brush, Material, Transform};

    /// A wall of boxes, each turned a little and reaching into its neighbours, with as many holes.
    fn wall() -> LiveModel {
        let turned = |k: u32, size: f64| {
            let half = DVec3::splat(0.5 * size);
            let turn = DMat3::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), f64::from(k));
            let at = DVec3::new((k % 8).into(), (k / 8).into(), 0.0);
            let transform = Transform::new(turn, at).expect("a rotation");
            Brush::cuboid(-half, half, MaterialId(0)).transformed(&transform).expect("it is near")
        };
        let mut live = LiveModel::new(vec![Material::named("stone")]);
        let boxes =
            (0..64).map(|k| (turned(k, 1.2), Role::Add)).chain((0..64).map(|k| (turned(k + 9, 0.6), Role::Subtract)));
        live.add_brushes(boxes.collect()).expect("it is bounded");
        live
    }

    #[test]
    fn bodies_tell_nearly_all_that_triangles_tell() {
        let live = wall();
        let (mut clear, mut met) = (0, 0);
        for k in 0..1000_u32 {
            let share = |prime: f64| (f64::from(k) * prime).fract();
            let origin = DVec3::new(9.0 * share(0.618_034), 9.0 * share(0.414_214), 5.0);
            let direction = DVec3::new(share(0.732_051) - 0.5, share(0.236_068) - 0.5, -2.0);
            let ray = Ray::new(origin, direction).expect("a direction");
            let expected = live.first_of_faces_near(&ray);
            met += u32::from(expected.is_some());
            let told = match live.told_by_bodies(&ray) {
                Told::Unclear => continue,
                Told::Nothing => None,
                Told::Met(face, distance) => Some((face, distance)),
            };
            clear += 1;
            assert_eq!(told.map(|met| met.0), expected.map(|met| met.0), "{origin} {direction}");
            let distances = [told, expected].map(|met| met.map_or(0.0, |met| met.1));
            assert!((distances[0] - distances[1]).abs() < 1e-13, "{distances:?}");
        }
        assert!(clear > 990 && met > 700, "{clear} {met}");
    }
}
