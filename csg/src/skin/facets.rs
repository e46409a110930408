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

use std::ops::ControlFlow;

use planecut_kernel::sign::Sign;

use super::contact::misses;
use super::section::Polygon;
use crate::body::{Body, BodyFace};
use crate::bounds::Bounds;
use crate::boxes::Boxes;
use crate::plane_table::{PlaneId, PlaneTable};

/// Bodies of fewer faces are asked face by face.
const MANY: usize = 20;
/// Relative room for rounding where bounds of planes are held against bounds of a point.
const ROOM: f64 = 1e-12;

/// Bounds of the coefficients of some planes.
#[derive(Debug, Clone, Copy)]
struct Coefficients {
    low: [f64; 4],
    high: [f64; 4],
}

/// A hierarchy of the faces of a body.
#[derive(Debug, Clone, Default)]
pub(super) struct Facets {
    /// Where the faces are.
    boxes: Boxes,
    /// Of each node of this hierarchy, what its planes are like.
    coefficients: Vec<Coefficients>,
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
        let planes: Vec<[f64; 4]> = body.faces.iter().map(|face| coefficients(table, face)).collect();
        let boxes = Boxes::new(body.faces.iter().map(|face| face.bounds).collect());
        let coefficients =
            boxes.nodes().map(|faces| Coefficients::of(faces.iter().map(|k| &planes[*k as usize]))).collect();
        Some(Self { boxes, coefficients, by_plane })
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
        let mut faces = Vec::new();
        self.boxes.find(meets, &mut faces);
        found.clear();
        let planes = faces.into_iter().map(|k| body.faces[k as usize].plane);
        found.extend(planes.filter(|other| other.index() != face.plane.index()));
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
        let outside = self.boxes.walk(
            |node| !self.coefficients[node].surely_hold(&point),
            |k| {
                let other = body.faces[k as usize].plane;
                if other.index() == face.plane.index() || near.binary_search(&other).is_ok() {
                    return ControlFlow::Continue(());
                }
                match table.side(planes, corner, other) {
                    Sign::Positive => return ControlFlow::Break(()),
                    Sign::Zero => place = Place::Unknown,
                    Sign::Negative => {}
                }
                ControlFlow::Continue(())
            },
        );
        if outside.is_break() { Place::Outside } else { place }
    }
}

impl Coefficients {
    fn of<'a>(planes: impl Iterator<Item = &'a [f64; 4]>) -> Self {
        let mut all = Self { low: [f64::INFINITY; 4], high: [f64::NEG_INFINITY; 4] };
        for plane in planes {
            for (k, coefficient) in plane.iter().enumerate() {
                all.low[k] = all.low[k].min(*coefficient);
                all.high[k] = all.high[k].max(*coefficient);
            }
        }
        all
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
