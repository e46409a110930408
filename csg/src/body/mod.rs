//! The exact boundary of each brush, as plane ids: what the boundary is made of.
//!
//! - [`shape`] is a body in numbers of its own, which it keeps whatever table its planes are in.
//! - [`build`] makes those of brushes, where they were not made before ([`BuiltBodies`]).
//! - [`pattern`] knows bodies again that differ from another one in the distances of their planes alone.
//! - [`polar_dual`] tells where points lie in a body of many faces.

mod build;
mod built;
mod corner;
mod directions;
mod face_neighbours;
mod kinds;
mod outer;
mod pattern;
mod polar_dual;
mod shape;

use std::sync::{Arc, OnceLock};

use planecut_kernel::sign::Sign;
use planecut_kernel::{DVec3, IncrementalPolytope, PlaneIdx};

use crate::base::Bounds;
use crate::ids::{BodyFaceId, Id};
use crate::model::MaterialId;
use crate::plane_table::{PlaneId, PlaneTable};

pub(crate) use build::{
    BrushBodies, BrushExtent, BrushExtents, BrushPlanes, brush_extents, build, build_bodies, build_other_bodies,
    built_or_build, read,
};
pub use built::BuiltBodies;
pub(crate) use built::ShapeBuilder;
pub(crate) use corner::{Corner, PlaneFilter};
pub(crate) use kinds::{kinds, mark_of, mark_of_faces};
pub(crate) use outer::OuterBox;
pub(crate) use polar_dual::{Place, PolarDual, SomeFaces};
use shape::Corners;
pub(crate) use shape::Shape;

/// A face of a [`Body`].
#[derive(Debug, Clone)]
pub(crate) struct BodyFace {
    pub(crate) plane: PlaneId,
    pub(crate) material: MaterialId,
    pub(crate) bounds: Bounds,
    /// Its edges and corners among those of the body.
    start: u32,
    end: u32,
}

impl BodyFace {
    /// Whether all of some corners surely lie beyond its plane.
    pub(crate) fn is_surely_before<'a>(
        &self,
        table: &PlaneTable,
        corners: impl IntoIterator<Item = &'a Corner>,
    ) -> bool {
        let filter = PlaneFilter::new(table.half_space(self.plane));
        corners.into_iter().all(|corner| filter.side(corner) == Sign::Positive)
    }
}

/// A bounded convex body with interior.
#[derive(Debug, Clone)]
pub struct Body {
    pub(crate) faces: Vec<BodyFace>,
    /// The planes of the edges, face by face.
    edges: Vec<PlaneId>,
    corners: Arc<Corners>,
    pub(crate) bounds: Bounds,
    pub(crate) volume: f64,
    /// For a body of many faces their planes without sides, ascending, and the face on each; made when first asked for.
    by_plane: OnceLock<Vec<(u32, BodyFaceId)>>,
}

impl Body {
    /// The body of a polytope whose planes are in a table: `face_of` gives the id and the material of each; nothing where the polytope is not
    /// bounded.
    #[must_use]
    pub fn of_polytope(
        table: &PlaneTable,
        polytope: &IncrementalPolytope,
        face_of: impl Fn(PlaneIdx) -> (PlaneId, MaterialId),
    ) -> Option<Self> {
        if !polytope.is_bounded() {
            return None;
        }
        let plane = |handle: PlaneIdx| table.row(face_of(handle).0);
        Some(Self::new(&Shape::of(polytope, plane)?, face_of))
    }

    /// A shape whose planes are in a table: `face_of` gives the id and the material of each.
    pub(crate) fn new(shape: &Shape, face_of: impl Fn(PlaneIdx) -> (PlaneId, MaterialId)) -> Self {
        let structure = &shape.corners.structure;
        let face = |(face, plane): (&shape::Face, &PlaneIdx)| {
            let (plane, material) = face_of(*plane);
            BodyFace { plane, material, bounds: face.bounds, start: face.start, end: face.end }
        };
        Self {
            faces: shape.faces.iter().zip(&structure.planes).map(face).collect(),
            edges: structure.edges.iter().map(|plane| face_of(*plane).0).collect(),
            corners: Arc::clone(&shape.corners),
            bounds: shape.bounds,
            volume: shape.volume,
            by_plane: OnceLock::new(),
        }
    }

    /// Where points lie in it, for a body of many faces.
    pub(crate) fn polar_dual(&self, table: &PlaneTable) -> Option<&PolarDual> {
        let half_spaces = || self.faces.iter().map(|face| table.half_space(face.plane));
        let edges = self.faces.iter().map(|face| face.start..face.end);
        self.corners
            .polar_dual
            .get_or_init(|| PolarDual::new(half_spaces, edges, &self.corners, &self.bounds).map(Box::new))
            .as_deref()
    }

    /// The planes and materials of its faces.
    pub(crate) fn planes_and_materials(&self) -> impl Iterator<Item = (PlaneId, MaterialId)> {
        self.faces.iter().map(|face| (face.plane, face.material))
    }

    /// The planes of the edges of a face, counter-clockwise seen from outside.
    #[inline]
    pub(crate) fn edges(&self, face: &BodyFace) -> &[PlaneId] {
        &self.edges[face.start as usize..face.end as usize]
    }

    /// The corners of a face: corner `i` between the edges `i` and `i + 1`.
    pub(crate) fn corners(&self, face: &BodyFace) -> impl ExactSizeIterator<Item = &Corner> + Clone {
        let numbers = &self.corners.numbers[face.start as usize..face.end as usize];
        numbers.iter().map(|number| &self.corners.different[number.index()])
    }

    /// All corners, each once.
    pub(crate) fn all_corners(&self) -> &[Corner] {
        &self.corners.different
    }

    /// How many different corners there are: their numbers are below this.
    #[inline]
    pub(crate) fn corner_count(&self) -> usize {
        self.corners.different.len()
    }

    /// A corner that lies far in a direction, though not always the farthest one.
    pub(crate) fn corner_toward(&self, table: &PlaneTable, direction: DVec3) -> &Corner {
        let farthest = |corner: &&Corner, other: &&Corner| corner.at.dot(direction).total_cmp(&other.at.dot(direction));
        let farthest = match self.polar_dual(table) {
            Some(dual) => self.corners(&self.faces[dual.face_toward(direction).index()]).max_by(farthest),
            None => self.all_corners().iter().max_by(farthest),
        };
        farthest.expect("a body has corners")
    }

    /// Whether all of some corners surely lie beyond one of its planes.
    pub(crate) fn is_surely_apart_from<'a>(
        &self,
        table: &PlaneTable,
        corners: impl Iterator<Item = &'a Corner> + Clone,
    ) -> bool {
        let Some(first) = corners.clone().next() else { return true };
        if let Some(dual) = self.polar_dual(table) {
            let Place::Outside(face) = dual.place(first) else { return false };
            return self.faces[face.index()].is_surely_before(table, corners);
        }
        self.faces.iter().any(|face| face.is_surely_before(table, corners.clone()))
    }

    /// The face on a plane, whatever its side.
    pub(crate) fn face_on(&self, plane: PlaneId) -> Option<&BodyFace> {
        self.place_on(plane).map(|place| &self.faces[place.index()])
    }

    /// The place of the face on a plane, whatever its side.
    pub(crate) fn place_on(&self, plane: PlaneId) -> Option<BodyFaceId> {
        const MANY: usize = 16;
        let mut faces = BodyFaceId::all(self.faces.len()).zip(&self.faces);
        if self.faces.len() < MANY {
            return faces.find(|(_, face)| face.plane.index() == plane.index()).map(|(place, _)| place);
        }
        let by_plane = self.by_plane.get_or_init(|| {
            let mut by_plane: Vec<(u32, BodyFaceId)> = faces.map(|(place, face)| (face.plane.index(), place)).collect();
            by_plane.sort_unstable();
            by_plane
        });
        let place = by_plane.binary_search_by_key(&plane.index(), |entry| entry.0).ok()?;
        Some(by_plane[place].1)
    }
}

/// What a brush turned out to be.
#[derive(Debug, Clone)]
pub(crate) enum BrushBody {
    /// A bounded body; how many of its planes have no face.
    Bounded(Body, usize),
    /// No interior.
    Empty,
    /// Not bounded.
    Unbounded,
}

impl BrushBody {
    /// The bounded body, where it is one.
    pub(crate) fn bounded(self) -> Option<Body> {
        match self {
            Self::Bounded(body, _) => Some(body),
            Self::Empty | Self::Unbounded => None,
        }
    }
}
