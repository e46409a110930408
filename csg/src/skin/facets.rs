//! The faces of a body of many, found by where they are.
//!
//! A face of one body meets few faces of another. Those are found in a hierarchy of their boxes, and only their planes cut it.
//! What is left may still lie outside of the body as a whole; one corner tells, against bounds of whole groups of planes.
//!
//! **Why that is enough.** Let `F` be a face, `B` the body and `P` what the planes of faces of `B` that meet `F` leave of `F`.
//! If `F ∩ B` has an area, it is `P`: a point of `F` beyond any plane of `B` is joined within `F` to one strictly inside `B`,
//! and where the way crosses into `B` a face of `B` meets `F` beyond whose plane the point lies. So `P` lies in `B`, or
//! `F ∩ B` has no area. If a corner of `P` lies strictly inside of all planes whose faces do not meet `F`, so does all
//! of `P` near it, and the former holds; if it lies outside of one of them, the latter.

use planecut_kernel::sign::Sign;

use super::contact::misses;
use super::section::Polygon;
use crate::body::{Body, BodyFace};
use crate::bounds::Bounds;
use crate::plane_table::{PlaneId, PlaneTable};

/// Bodies of fewer faces are asked face by face.
const MANY: usize = 20;
/// Leaves hold at most this many faces.
const LEAF: usize = 4;
/// Relative room for rounding where bounds of planes are held against bounds of a point.
const ROOM: f64 = 1e-12;

/// Faces that are near each other: where they are, and bounds of the coefficients of their planes.
#[derive(Debug, Clone, Copy)]
struct Group {
    bounds: Bounds,
    low: [f64; 4],
    high: [f64; 4],
    start: u32,
    end: u32,
    /// Index of the second child (the first follows the group); 0 for a leaf.
    second: u32,
}

/// A hierarchy of the faces of a body.
#[derive(Debug, Clone, Default)]
pub(super) struct Facets {
    groups: Vec<Group>,
    /// The faces in the order of the leaves.
    order: Vec<u32>,
    /// The planes without their sides, ascending, and the face on each.
    by_plane: Vec<(u32, u32)>,
}

/// Where a convex polygon lies, as far as one corner of it tells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Place {
    Inside,
    Outside,
    Unknown,
}

impl Facets {
    /// The hierarchy of a body of many faces.
    pub(super) fn of(table: &PlaneTable, body: &Body) -> Option<Self> {
        if body.faces.len() < MANY {
            return None;
        }
        let mut by_plane: Vec<(u32, u32)> = (0..).zip(&body.faces).map(|(k, face)| (face.plane.index(), k)).collect();
        by_plane.sort_unstable();
        let mut facets = Self { groups: Vec::new(), order: (0..body.faces.len() as u32).collect(), by_plane };
        let planes: Vec<[f64; 4]> = body.faces.iter().map(|face| coefficients(table, face)).collect();
        facets.split_all(body, &planes);
        Some(facets)
    }

    /// Splits ranges until they are short; the first half of each directly follows it.
    fn split_all(&mut self, body: &Body, planes: &[[f64; 4]]) {
        // (start, end, the group whose second child this is)
        let mut waiting = vec![(0, self.order.len(), None)];
        while let Some((start, end, second_of)) = waiting.pop() {
            let number = self.groups.len();
            if let Some(parent) = second_of {
                let parent: &mut Group = &mut self.groups[parent];
                parent.second = number as u32;
            }
            let range = &mut self.order[start..end];
            let mut group = Group::of(range.iter().map(|k| (&body.faces[*k as usize], &planes[*k as usize])));
            (group.start, group.end) = (start as u32, end as u32);
            let bounds = group.bounds;
            self.groups.push(group);
            if end - start > LEAF {
                let axis = (bounds.max - bounds.min).max_position();
                let half = range.len() / 2;
                let key = |k: &u32| body.faces[*k as usize].bounds.center()[axis];
                range.select_nth_unstable_by(half, |a, b| key(a).total_cmp(&key(b)).then(a.cmp(b)));
                waiting.extend([(start + half, end, Some(number)), (start, start + half, None)]);
            }
        }
    }

    /// The face on a plane, whatever its side.
    pub(super) fn on_plane(&self, plane: PlaneId) -> Option<u32> {
        let at = self.by_plane.binary_search_by_key(&plane.index(), |entry| entry.0).ok()?;
        Some(self.by_plane[at].1)
    }

    /// The planes of the faces that may meet a polygon within a box and on the plane of a face, but for this plane itself.
    pub(super) fn near(
        &self,
        table: &PlaneTable,
        body: &Body,
        face: &BodyFace,
        bounds: &Bounds,
        found: &mut Vec<PlaneId>,
    ) {
        let half_space = table.half_space(face.plane);
        let (normal, offset) = (half_space.normal(), half_space.offset());
        let meets = |other: &Bounds| other.touches(bounds) && !misses(other, normal, offset);
        found.clear();
        let mut waiting: Vec<u32> = vec![0];
        while let Some(number) = waiting.pop() {
            let group = &self.groups[number as usize];
            if !meets(&group.bounds) {
                continue;
            }
            if group.second != 0 {
                waiting.extend([number + 1, group.second]);
                continue;
            }
            let faces = group.faces(&self.order).map(|k| &body.faces[k]);
            let other_planes = faces.filter(|other| other.plane.index() != face.plane.index());
            found.extend(other_planes.filter(|other| meets(&other.bounds)).map(|other| other.plane));
        }
        found.sort_unstable();
    }

    /// Where a polygon on the plane of a face lies that has been cut by the planes `near`.
    pub(super) fn place(
        &self,
        table: &PlaneTable,
        body: &Body,
        face: &BodyFace,
        near: &[PlaneId],
        polygon: &Polygon,
    ) -> Place {
        let (planes, corner) = (polygon.corner(face.plane, 0), &polygon.corners[0]);
        let point = Bounds::EMPTY.with_point(corner);
        let mut place = Place::Inside;
        let mut waiting: Vec<u32> = vec![0];
        while let Some(number) = waiting.pop() {
            let group = &self.groups[number as usize];
            if group.surely_hold(&point) {
                continue;
            }
            if group.second != 0 {
                waiting.extend([number + 1, group.second]);
                continue;
            }
            for other in group.faces(&self.order).map(|k| body.faces[k].plane) {
                if other.index() == face.plane.index() || near.binary_search(&other).is_ok() {
                    continue;
                }
                match table.side(planes, corner, other) {
                    Sign::Positive => return Place::Outside,
                    Sign::Zero => place = Place::Unknown,
                    Sign::Negative => {}
                }
            }
        }
        place
    }
}

impl Group {
    fn of<'a>(faces: impl Iterator<Item = (&'a BodyFace, &'a [f64; 4])>) -> Self {
        let (low, high) = ([f64::INFINITY; 4], [f64::NEG_INFINITY; 4]);
        let mut group = Self { bounds: Bounds::EMPTY, low, high, start: 0, end: 0, second: 0 };
        for (face, plane) in faces {
            group.bounds = group.bounds.union(&face.bounds);
            for (k, coefficient) in plane.iter().enumerate() {
                group.low[k] = group.low[k].min(*coefficient);
                group.high[k] = group.high[k].max(*coefficient);
            }
        }
        group
    }

    fn faces<'a>(&self, order: &'a [u32]) -> impl Iterator<Item = usize> + 'a {
        order[self.start as usize..self.end as usize].iter().map(|k| *k as usize)
    }

    /// Whether all points of a box lie strictly inside of all planes.
    fn surely_hold(&self, point: &Bounds) -> bool {
        let (mut highest, mut magnitude) = (-self.low[3], self.low[3].abs());
        for k in 0..3 {
            let (low, high) = (point.min[k], point.max[k]);
            let product = (self.low[k] * low).max(self.low[k] * high).max(self.high[k] * low).max(self.high[k] * high);
            highest += product;
            magnitude += product.abs();
        }
        highest < -ROOM * magnitude
    }
}

/// The coefficients of a plane, the largest of its normal scaled to 1.
fn coefficients(table: &PlaneTable, face: &BodyFace) -> [f64; 4] {
    let half_space = table.half_space(face.plane);
    let scale = half_space.normal().abs().max_element().recip();
    let normal = half_space.normal() * scale;
    [normal.x, normal.y, normal.z, half_space.offset() * scale]
}
