//! What a body covers of a polygon on a face of another.

use planecut_kernel::sign::Sign;

use super::Scene;
use super::section::{Clip, Polygon};
use crate::body::{BodyFace, Corner, Place, PolarDual};
use crate::ids::{BodyFaceId, BodyId, Id, NearId};

/// For more pairs of a corner and a body near nothing is kept.
const MOST: usize = 1 << 20;

/// Clips polygons by bodies, reusing its buffers.
#[derive(Debug, Default)]
pub(super) struct Clipper {
    spare: Polygon,
    near: Vec<BodyFaceId>,
    /// For each body near the one whose faces are clipped, the face at which the last point was found, or [`Id::NONE`].
    last: Vec<BodyFaceId>,
    /// How many corners the body has whose faces are clipped.
    corners: usize,
    /// Where each of these corners lies in each body near: a corner is seen from several faces.
    known: Vec<Found>,
}

/// A body that clips polygons on a face of another.
#[derive(Clone, Copy)]
pub(super) struct Cutter<'a> {
    pub(super) scene: &'a Scene<'a>,
    pub(super) face: &'a BodyFace,
    pub(super) body: BodyId,
    /// Its place among the bodies near.
    pub(super) place: NearId,
}

impl Clipper {
    /// Begins with the faces of another body: the number of its corners, and of the bodies near it.
    pub(super) fn begin(&mut self, corners: usize, near: usize) {
        self.corners = if corners.saturating_mul(near) <= MOST { corners } else { 0 };
        self.last.clear();
        self.last.resize(near, BodyFaceId::NONE);
        self.known.clear();
    }

    /// What a body covers of a polygon within a face. `out` is that part where it is [`Clip::Part`], else of no meaning.
    pub(super) fn clip(&mut self, cutter: Cutter<'_>, polygon: &Polygon, out: &mut Polygon) -> Clip {
        match cutter.scene.polar_dual(cutter.body) {
            Some(dual) => self.clip_by_dual(cutter, dual, polygon, out),
            None => {
                out.copy_from(polygon);
                self.clip_by_all(cutter, out)
            }
        }
    }

    /// Whether a body of many faces is quickly seen to hold a polygon within a face. What it holds need not be clipped by
    /// others.
    pub(super) fn surely_holds(&mut self, cutter: Cutter<'_>, polygon: &Polygon) -> bool {
        let Some(dual) = cutter.scene.polar_dual(cutter.body) else { return false };
        (0..polygon.corners.len()).all(|i| matches!(self.place(cutter, dual, polygon, i), Found::Inside(_)))
    }

    /// By the planes of all faces.
    fn clip_by_all(&mut self, Cutter { scene, face, body, .. }: Cutter<'_>, polygon: &mut Polygon) -> Clip {
        let mut whole = true;
        let cuts = scene.body(body).faces.iter().map(|face| face.plane);
        for cut in cuts.filter(|cut| cut.index() != face.plane.index()) {
            match polygon.clip(scene.table, face.plane, cut, &mut self.spare) {
                Clip::Nothing => return Clip::Nothing,
                Clip::Part => whole = false,
                Clip::Whole => {}
            }
        }
        if whole { Clip::Whole } else { Clip::Part }
    }

    /// By planes beyond which corners lie, until there is none. Then all corners lie in the body, and so does the polygon.
    fn clip_by_dual(&mut self, cutter: Cutter<'_>, dual: &PolarDual, polygon: &Polygon, out: &mut Polygon) -> Clip {
        let Cutter { scene, face, body, .. } = cutter;
        // mostly all of it is inside, or all beyond one plane, and nothing need be copied
        let mut first = None;
        for i in 0..polygon.corners.len() {
            match self.place(cutter, dual, polygon, i) {
                Found::Inside(_) => {}
                Found::Beyond(beyond) => {
                    if polygon.corners.iter().all(|corner| dual.is_beyond(corner, beyond)) {
                        return Clip::Nothing;
                    }
                    first = Some((i, beyond));
                    break;
                }
                Found::Unknown => {
                    out.copy_from(polygon);
                    return self.clip_by_all(cutter, out);
                }
            }
        }
        let Some((known, mut beyond)) = first else { return Clip::Whole };
        out.copy_from(polygon);
        out.corners[..known].iter_mut().for_each(|corner| corner.within = body);
        let mut i = known;
        loop {
            let cut = scene.body(body).faces[beyond.index()].plane;
            match out.clip(scene.table, face.plane, cut, &mut self.spare) {
                Clip::Nothing => return Clip::Nothing,
                Clip::Part => {}
                // signs decide
                Clip::Whole => out.corners[i].within = body,
            }
            let next = loop {
                let Some(k) = out.corners.iter().position(|corner| corner.within != body) else { break None };
                i = k;
                match self.place(cutter, dual, out, i) {
                    Found::Inside(_) => out.corners[i].within = body,
                    Found::Beyond(other) => break Some(other),
                    Found::Unknown => {
                        return if self.clip_by_all(cutter, out) == Clip::Nothing { Clip::Nothing } else { Clip::Part };
                    }
                }
            };
            match next {
                Some(other) => beyond = other,
                None => break,
            }
        }
        out.corners.iter_mut().for_each(|corner| corner.within = Corner::NOWHERE);
        Clip::Part
    }

    /// Where a corner lies, exactly where numbers do not tell.
    fn place(&mut self, cutter: Cutter<'_>, dual: &PolarDual, polygon: &Polygon, i: usize) -> Found {
        let number = polygon.corners[i].number.index();
        let found = if number >= self.corners {
            self.find(cutter, dual, polygon, i)
        } else {
            if self.known.is_empty() {
                self.known.resize(self.last.len() * self.corners, Found::Unknown);
            }
            let entry = cutter.place.index() * self.corners + number;
            if self.known[entry] == Found::Unknown {
                self.stay_near(cutter.place, polygon);
                self.known[entry] = self.find(cutter, dual, polygon, i);
            }
            self.known[entry]
        };
        if let Found::Inside(nearest) | Found::Beyond(nearest) = found {
            self.last[cutter.place.index()] = nearest;
        }
        found
    }

    /// Lets the search begin near a corner of the polygon that was placed with another face: faces that follow one another may lie
    /// far apart.
    fn stay_near(&mut self, place: NearId, polygon: &Polygon) {
        let known = |corner: &Corner| {
            let number = corner.number.index();
            let found =
                if number < self.corners { self.known[place.index() * self.corners + number] } else { Found::Unknown };
            match found {
                Found::Inside(nearest) | Found::Beyond(nearest) => Some(nearest),
                Found::Unknown => None,
            }
        };
        if let Some(nearest) = polygon.corners.iter().find_map(known) {
            self.last[place.index()] = nearest;
        }
    }

    fn find(&mut self, cutter: Cutter<'_>, dual: &PolarDual, polygon: &Polygon, i: usize) -> Found {
        let Cutter { scene, face, body, place } = cutter;
        let corner = &polygon.corners[i];
        let last = self.last[place.index()];
        match dual.place(corner, if last == BodyFaceId::NONE { dual.seed(corner) } else { last }) {
            Place::Inside(nearest) => Found::Inside(nearest),
            Place::Outside(other) => Found::Beyond(other),
            Place::Near(other) => {
                let planes = polygon.corner(face.plane, i);
                dual.near(corner, other, &mut self.near);
                let faces = &scene.body(body).faces;
                let is_beyond = |other: &BodyFaceId| {
                    let plane = faces[other.index()].plane;
                    scene.table.side(planes, &corner.point, plane) == Sign::Positive
                };
                self.near.iter().copied().find(is_beyond).map_or(Found::Inside(other), Found::Beyond)
            }
            Place::Unknown => Found::Unknown,
        }
    }
}

/// Where a corner lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Found {
    /// Inside of all planes or on some; this face is the nearest.
    Inside(BodyFaceId),
    /// Outside of the plane of this face.
    Beyond(BodyFaceId),
    Unknown,
}
