//! What a body covers of a polygon on a face of another.

use std::ops::Range;

use planecut_kernel::DVec3;
use planecut_kernel::sign::Sign;

use super::Scene;
use super::corner_sides::CornerSides;
use super::section::{Clip, Polygon};
use super::signs::Signs;
use crate::body::{Body, BodyFace, Corner, Place, PolarDual, SomeFaces};
use crate::ids::{BodyFaceId, BodyId, Id, NearId};
use crate::plane_table::PlaneId;

/// For more pairs of a corner and a body near nothing is kept.
const MOST: usize = 1 << 20;

/// Clips polygons by bodies, reusing its buffers.
#[derive(Debug, Default)]
pub(super) struct Clipper {
    spare: Polygon,
    near: SomeFaces,
    /// How many corners the body has whose faces are clipped.
    corners: usize,
    /// Where each of these corners lies in each body near: a corner is seen from several faces.
    known: Vec<Found>,
    /// Beside which planes of bodies near they lie, and which these are for each: all of a body of few faces, some of one of many.
    sides: CornerSides,
    planes: Vec<Range<usize>>,
    /// The planes that cut a polygon.
    cuts: Vec<PlaneId>,
    /// The same of a body of many faces, each with its face.
    cut_by: Vec<(PlaneId, BodyFaceId)>,
}

/// How many corners are placed in a body of many faces to find planes beyond which many others lie.
const GUESSES: usize = 4;

/// A body that clips polygons on a face of another.
#[derive(Clone, Copy)]
pub(super) struct Cutter<'a> {
    pub(super) scene: &'a Scene<'a>,
    pub(super) signs: Signs<'a>,
    pub(super) face: &'a BodyFace,
    pub(super) body: BodyId,
    /// Its place among the bodies near.
    pub(super) place: NearId,
}

impl Clipper {
    /// Begins with the faces of another body; those near it are added then, itself among them.
    pub(super) fn begin(&mut self, scene: &Scene<'_>, body: BodyId) {
        let solid = scene.body(body);
        self.corners = solid.corner_count();
        self.known.clear();
        self.sides.begin(solid.all_corners());
        self.planes.clear();
    }

    /// Adds a body that may touch the one whose faces are clipped; false where a plane of either is surely between them, and nothing is added.
    pub(super) fn add_near(&mut self, scene: &Scene<'_>, body: BodyId, other: BodyId) -> bool {
        let (own, solid) = (scene.body(body), scene.body(other));
        let first = self.sides.planes();
        if self.sides.is_empty() {
            self.planes.push(first..first);
            return true;
        }
        let (is_apart, is_within) = match scene.polar_dual(other) {
            Some(dual) => self.add_some_planes(scene, own, solid, dual),
            None => {
                let is_apart = solid.faces.iter().any(|face| self.sides.add_plane(scene.table.half_space(face.plane)));
                (is_apart, !is_apart && self.sides.is_one_inside(first))
            }
        };
        if is_apart || !is_within && is_apart_by_own_planes(scene, body, solid) {
            self.sides.forget_from(first);
            return false;
        }
        self.planes.push(first..self.sides.planes());
        true
    }

    /// Adds the body itself to those near it.
    pub(super) fn add_itself(&mut self) {
        let end = self.sides.planes();
        self.planes.push(end..end);
    }

    /// Adds some planes of a body of many faces: those beyond which corners of the own body lie that are beyond none of those before. Tells whether all of them
    /// surely lie beyond one, and whether one surely lies within the body.
    fn add_some_planes(&mut self, scene: &Scene<'_>, own: &Body, other: &Body, dual: &PolarDual) -> (bool, bool) {
        let mut corner = own.corner_toward(scene.table, other.bounds.center() - own.bounds.center());
        self.sides.begin_search();
        let mut is_within = false;
        for guess in 0..GUESSES {
            match dual.place(corner) {
                Place::Outside(face) => {
                    if self.sides.add_plane(scene.table.half_space(other.faces[face.index()].plane)) {
                        return (true, false);
                    }
                    self.sides.drop_outside();
                }
                Place::Inside | Place::Near(_) => {
                    is_within = true;
                    self.sides.drop_corner(corner.number);
                }
                Place::Unknown => break,
            }
            // those that follow one another are near each other
            let Some(next) = self.sides.left(guess % 2 == 0) else { break };
            corner = &own.all_corners()[next.index()];
        }
        (false, is_within)
    }

    /// What a body covers of a polygon within a face. `out` is that part where it is [`Clip::Part`], else of no meaning.
    pub(super) fn clip(&mut self, cutter: Cutter<'_>, polygon: &Polygon, out: &mut Polygon) -> Clip {
        match cutter.scene.polar_dual(cutter.body) {
            Some(dual) => self.clip_by_dual(cutter, dual, polygon, out),
            None => self.clip_by_few(cutter, polygon, out),
        }
    }

    /// Takes a polygon on a face of the body to be clipped.
    pub(super) fn look_at(&mut self, polygon: &Polygon) {
        self.sides.look_at(polygon);
    }

    /// Whether the polygon that is looked at is known to lie beyond a plane of a body near.
    pub(super) fn is_known_outside(&self, place: NearId) -> bool {
        self.sides.is_known_outside_of_one(self.planes[place.index()].clone())
    }

    /// Whether a body is quickly seen to hold a polygon within a face, the one that is looked at. What it holds need not be clipped by
    /// others.
    pub(super) fn surely_holds(&mut self, cutter: Cutter<'_>, polygon: &Polygon) -> bool {
        let Some(dual) = cutter.scene.polar_dual(cutter.body) else {
            return !self.sides.is_empty() && self.sides.are_known_inside(self.planes[cutter.place.index()].clone());
        };
        !self.planes[cutter.place.index()].clone().any(|plane| self.sides.is_one_known_outside(plane))
            && (0..polygon.corners.len()).all(|i| matches!(self.place(cutter, dual, polygon, i), Found::Inside))
    }

    /// By the planes of a body of few faces: those on both sides of which corners lie. The polygon is the one that is looked at.
    fn clip_by_few(&mut self, cutter: Cutter<'_>, polygon: &Polygon, out: &mut Polygon) -> Clip {
        let Cutter { scene, signs, face, body, place } = cutter;
        if self.sides.is_empty() {
            out.copy_from(polygon);
            return self.clip_by_all(cutter, out);
        }
        let planes = self.planes[place.index()].clone();
        if self.sides.are_known_inside(planes.clone()) {
            return Clip::Whole;
        }
        self.cuts.clear();
        for (number, other) in planes.zip(&scene.body(body).faces) {
            if other.plane.index() == face.plane.index() {
                continue;
            }
            let spread = self.sides.spread(signs, (polygon, face.plane), (number, other.plane));
            match (spread.inside, spread.outside) {
                (false, true) => return Clip::Nothing,
                (true, true) => self.cuts.push(other.plane),
                (_, false) => {}
            }
        }
        let Some((first, others)) = self.cuts.split_first() else { return Clip::Whole };
        // signs tell that corners are on both sides of it
        if polygon.inside_of(signs, face.plane, *first, out) != Clip::Part {
            return Clip::Nothing;
        }
        for cut in others {
            if out.clip(signs, face.plane, *cut, &mut self.spare) == Clip::Nothing {
                return Clip::Nothing;
            }
        }
        Clip::Part
    }

    /// By the planes of all faces.
    fn clip_by_all(&mut self, Cutter { scene, signs, face, body, .. }: Cutter<'_>, polygon: &mut Polygon) -> Clip {
        let mut whole = true;
        let cuts = scene.body(body).faces.iter().map(|face| face.plane);
        for cut in cuts.filter(|cut| cut.index() != face.plane.index()) {
            match polygon.clip(signs, face.plane, cut, &mut self.spare) {
                Clip::Nothing => return Clip::Nothing,
                Clip::Part => whole = false,
                Clip::Whole => {}
            }
        }
        if whole { Clip::Whole } else { Clip::Part }
    }

    /// By planes beyond which corners lie, until there is none. Then all corners lie in the body, and so does the polygon.
    fn clip_by_dual(&mut self, cutter: Cutter<'_>, dual: &PolarDual, polygon: &Polygon, out: &mut Polygon) -> Clip {
        let Cutter { scene, signs, face, body, .. } = cutter;
        // mostly all of it is inside, and nothing need be cut
        let mut first = None;
        for i in 0..polygon.corners.len() {
            match self.place(cutter, dual, polygon, i) {
                Found::Inside => {}
                Found::Beyond(beyond) => {
                    first = Some((i, beyond));
                    break;
                }
                Found::Unknown => {
                    out.copy_from(polygon);
                    return self.clip_by_all(cutter, out);
                }
            }
        }
        let Some((mut i, mut beyond)) = first else { return Clip::Whole };
        let plane_of = |other: BodyFaceId| scene.body(body).faces[other.index()].plane;
        let mut clip = polygon.inside_of(signs, face.plane, plane_of(beyond), out);
        if clip == Clip::Whole {
            out.copy_from(polygon);
        }
        self.cut_by.clear();
        loop {
            self.cut_by.push((plane_of(beyond), beyond));
            // the first corner that is not known to lie within
            let mut first = i;
            match clip {
                Clip::Nothing => return Clip::Nothing,
                Clip::Part => first = 0,
                // signs decide
                Clip::Whole => out.corners[i].within = body,
            }
            let next = loop {
                let unknown = out.corners[first..].iter().position(|corner| corner.within != body);
                let Some(k) = unknown else { break None };
                i = first + k;
                first = i;
                let [_, ends @ ..] = out.corner(face.plane, i);
                let found = match faces_of(&self.cut_by, ends) {
                    Some(faces) => self.exact_place(cutter, dual, out, i, dual.place_on(&out.corners[i], faces)),
                    None => self.place(cutter, dual, out, i),
                };
                match found {
                    Found::Inside => out.corners[i].within = body,
                    Found::Beyond(other) => break Some(other),
                    Found::Unknown => {
                        return if self.clip_by_all(cutter, out) == Clip::Nothing { Clip::Nothing } else { Clip::Part };
                    }
                }
            };
            let Some(other) = next else { break };
            beyond = other;
            clip = out.clip(signs, face.plane, plane_of(other), &mut self.spare);
        }
        out.corners.iter_mut().for_each(|corner| corner.within = Corner::NOWHERE);
        Clip::Part
    }

    /// Where a corner lies, exactly where numbers do not tell.
    fn place(&mut self, cutter: Cutter<'_>, dual: &PolarDual, polygon: &Polygon, i: usize) -> Found {
        let number = polygon.corners[i].number.index();
        if number >= self.corners || self.corners.saturating_mul(self.planes.len()) > MOST {
            return self.find(cutter, dual, polygon, i);
        }
        if self.known.is_empty() {
            self.known.resize(self.planes.len() * self.corners, Found::Unknown);
        }
        let entry = cutter.place.index() * self.corners + number;
        if self.known[entry] == Found::Unknown {
            self.known[entry] = self.find(cutter, dual, polygon, i);
        }
        self.known[entry]
    }

    fn find(&mut self, cutter: Cutter<'_>, dual: &PolarDual, polygon: &Polygon, i: usize) -> Found {
        self.exact_place(cutter, dual, polygon, i, dual.place(&polygon.corners[i]))
    }

    /// Where a corner lies, of which it is known as well as numbers tell.
    fn exact_place(
        &mut self,
        Cutter { scene, signs, face, body, .. }: Cutter<'_>,
        dual: &PolarDual,
        polygon: &Polygon,
        i: usize,
        place: Place,
    ) -> Found {
        let corner = &polygon.corners[i];
        match place {
            Place::Inside => Found::Inside,
            Place::Outside(other) => Found::Beyond(other),
            Place::Near(other) => {
                let planes = polygon.corner(face.plane, i);
                dual.near(corner, other, &mut self.near);
                let faces = &scene.body(body).faces;
                let is_beyond = |other: &BodyFaceId| {
                    let plane = faces[other.index()].plane;
                    signs.side(corner, planes, plane) == Sign::Positive
                };
                self.near.iter().copied().find(is_beyond).map_or(Found::Inside, Found::Beyond)
            }
            Place::Unknown => Found::Unknown,
        }
    }
}

/// Of faces by which a polygon was cut, with their planes, one or two on whose planes a corner lies between two edges: the last ones.
fn faces_of(cut_by: &[(PlaneId, BodyFaceId)], ends: [PlaneId; 2]) -> Option<(BodyFaceId, Option<BodyFaceId>)> {
    // a bit for each, without a branch
    let some = &cut_by[cut_by.len().saturating_sub(64)..];
    let bit =
        |(k, (plane, _)): (usize, &(PlaneId, BodyFaceId))| u64::from((*plane == ends[0]) | (*plane == ends[1])) << k;
    let bits = some.iter().enumerate().map(bit).fold(0, |bits, bit| bits | bit);
    let last = bits.checked_ilog2()?;
    let other = (bits & !(1 << last)).checked_ilog2();
    let face = |place: u32| some[place as usize].1;
    Some((face(last), other.map(face)))
}

/// Whether a plane of a body is found beyond which all corners of another surely lie.
fn is_apart_by_own_planes(scene: &Scene<'_>, body: BodyId, other: &Body) -> bool {
    let own = scene.body(body);
    match scene.polar_dual(body) {
        // planes across an axis are faces of the boxes, which touch
        None => own.faces.iter().any(|face| {
            let normal = scene.table.half_space(face.plane).normal();
            let is_across_axis = normal.cmpne(DVec3::ZERO).bitmask().count_ones() == 1;
            !is_across_axis && face.is_surely_before(scene.table, other.all_corners())
        }),
        Some(dual) => {
            let corner = other.corner_toward(scene.table, own.bounds.center() - other.bounds.center());
            let Place::Outside(face) = dual.place(corner) else { return false };
            own.faces[face.index()].is_surely_before(scene.table, other.all_corners())
        }
    }
}

/// Where a corner lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Found {
    /// Inside of all planes or on some.
    Inside,
    /// Outside of the plane of this face.
    Beyond(BodyFaceId),
    Unknown,
}
