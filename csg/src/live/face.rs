//! The faces of a live model, however its boundary is worked out: what they are, and where they come from.

use planecut_kernel::{DVec3, PlaneIdx};
use rustc_hash::FxHashMap;

use super::{BrushId, LiveModel, Operand};
use crate::base::Bounds;
use crate::ids::{FaceId, number32};
use crate::mesh::Mesh;
use crate::model::MaterialId;
use crate::plane_table::PlaneId;
use crate::tolerances::ON_FACE;
use crate::weld::WeldedFace;

/// A planar, connected region of the boundary of a live model, with its triangles.
#[derive(Clone, Copy)]
pub struct LiveFace<'a>(Kind<'a>);

#[derive(Clone, Copy)]
enum Kind<'a> {
    Welded(WeldedFace<'a>),
    Evaluated { mesh: &'a Mesh, triangles: &'a [[u32; 3]], material: MaterialId },
}

impl<'a> LiveFace<'a> {
    pub(super) fn welded(face: WeldedFace<'a>) -> Self {
        Self(Kind::Welded(face))
    }

    pub(super) fn evaluated(mesh: &'a Mesh, triangles: &'a [[u32; 3]], material: MaterialId) -> Self {
        Self(Kind::Evaluated { mesh, triangles, material })
    }

    /// What it is made of.
    #[must_use]
    pub fn material(&self) -> MaterialId {
        match self.0 {
            Kind::Welded(face) => face.material(),
            Kind::Evaluated { material, .. } => material,
        }
    }

    /// Its unit outward normal.
    #[must_use]
    pub fn normal(&self) -> DVec3 {
        // of a sliver rounding says little, of the largest triangle the most
        self.largest_triangle().map_or(DVec3::ZERO, |corners| across(corners).normalize_or_zero())
    }

    fn largest_triangle(&self) -> Option<[DVec3; 3]> {
        let area = |corners: &[DVec3; 3]| across(*corners).length_squared();
        let triangles = self.triangles().map(|corners| corners.map(|corner| corner.1));
        triangles.max_by(|a, b| area(a).total_cmp(&area(b)))
    }

    fn plane(&self) -> Option<PlaneId> {
        match self.0 {
            Kind::Welded(face) => Some(face.plane()),
            Kind::Evaluated { .. } => None,
        }
    }

    /// The triangles, counter-clockwise seen from outside: for each corner the number of its vertex, equal for what is one
    /// corner of the solid as long as nothing changes there, and its position. While a brush of the model is a closed mesh,
    /// vertices are numbered again by each edit.
    pub fn triangles(&self) -> impl ExactSizeIterator<Item = [(u32, DVec3); 3]> + use<'a> {
        let Self(kind) = *self;
        let count = match kind {
            Kind::Welded(face) => face.triangle_count(),
            Kind::Evaluated { triangles, .. } => triangles.len(),
        };
        (0..count).map(move |place| match kind {
            Kind::Welded(face) => face.triangle(place),
            Kind::Evaluated { mesh, triangles, .. } => {
                triangles[place].map(|vertex| (vertex, mesh.positions[vertex as usize]))
            }
        })
    }
}

impl LiveFace<'_> {
    /// Its corners, each once, and its triangles, counter-clockwise seen from outside, by places among them.
    #[must_use]
    pub fn indexed(&self) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let (mut positions, mut triangles) = (Vec::new(), Vec::new());
        self.append_indexed(&mut positions, &mut triangles, |at| at, &mut FxHashMap::default());
        (positions, triangles)
    }

    /// Adds its corners, each once and in another form, and its triangles by places among all corners that are there then. `places` is a buffer.
    pub(super) fn append_indexed<P>(
        &self,
        positions: &mut Vec<P>,
        triangles: &mut Vec<[u32; 3]>,
        form: impl Fn(DVec3) -> P,
        places: &mut FxHashMap<u32, u32>,
    ) {
        places.clear();
        let mut corner = |(vertex, at): (u32, DVec3)| {
            *places.entry(vertex).or_insert_with(|| {
                positions.push(form(at));
                number32(positions.len()) - 1
            })
        };
        triangles.extend(self.triangles().map(|corners| corners.map(&mut corner)));
    }

    /// Directed edges of which those that are left when opposite ones cancel go around it, counter-clockwise seen from outside.
    pub(super) fn edges(&self) -> impl Iterator<Item = [DVec3; 2]> {
        let (welded, evaluated) = match self.0 {
            Kind::Welded(face) => (Some(face), None),
            Kind::Evaluated { .. } => (None, Some(self.triangles())),
        };
        let around = |corners: [(u32, DVec3); 3]| {
            let [a, b, c] = corners.map(|corner| corner.1);
            [[a, b], [b, c], [c, a]]
        };
        welded.into_iter().flat_map(WeldedFace::edges).chain(evaluated.into_iter().flatten().flat_map(around))
    }
}

impl LiveModel {
    /// The brush and its plane on which a face lies; of several the first that faces the same way. `None` where there is no such face, and where a brush of the model
    /// is a closed mesh.
    #[must_use]
    pub fn source_of_face(&self, id: FaceId) -> Option<(BrushId, PlaneIdx)> {
        let face = self.face(id)?;
        let plane = face.plane()?;
        let [a, b, c] = face.largest_triangle()?;
        let middle = (a + b + c) / 3.0;
        let bounds = Bounds { min: a.min(b).min(c), max: a.max(b).max(c) };
        let source = |operand: &Operand| {
            let place = operand.uses.iter().position(|used| self.planes.id(*used).index() == plane.index())?;
            // a face that is subtracted shows its back
            let is_turned = (self.planes.id(operand.uses[place]) != plane)
                != self.tree.takes_away(operand.state.place, operand.state.role);
            let half_spaces = operand.state.brush.half_spaces();
            let outside = half_spaces.map(|half| half.signed_distance(middle)).fold(f64::NEG_INFINITY, f64::max);
            let size = (bounds.max - bounds.min).length() + middle.length();
            Some((is_turned, outside > ON_FACE * size, operand.id, operand.state.planes[place]))
        };
        let near = self.places.near(&bounds).map(|(number, _)| self.operand(number));
        near.filter_map(source).min().map(|(_, _, brush, plane)| (brush, plane))
    }
}

/// Twice the area of a triangle along its normal.
fn across([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}
