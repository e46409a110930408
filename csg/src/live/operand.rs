//! The brushes of a live model: their bodies, where these are, and which edges of the boundary their faces make.

use std::num::NonZeroU32;
use std::sync::Arc;

use planecut_kernel::{DVec3, PlaneIdx};
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree, SelectionFunction};

use super::BrushId;
use super::planes::PlaneUse;
use super::tree::{OrderKey, Place};
use crate::base::{Bounds, IN_BOX, Ray};
use crate::body::Body;
use crate::boundary::BoundaryEdge;
use crate::ids::{EdgeId, OperandId};
use crate::model::{Brush, BrushFace};

/// What a brush of a live model does to what the brushes before it have made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub enum Role {
    /// It is added.
    #[default]
    Add,
    /// It is taken away.
    Subtract,
    /// What lies outside of it is taken away.
    Intersect,
}

impl Role {
    /// The name by which files and programs call it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Add => "add",
            Self::Subtract => "subtract",
            Self::Intersect => "intersect",
        }
    }
}

/// All that the user has said of a brush.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct State {
    pub(super) brush: Brush,
    /// The handles of its planes, ascending.
    pub(super) planes: Vec<PlaneIdx>,
    /// The number in the handle of the next plane.
    pub(super) next_plane: usize,
    pub(super) role: Role,
    /// Where it is in the tree.
    pub(super) place: Place,
    /// Where the input has it, until another brush takes its place.
    pub(super) line: Option<NonZeroU32>,
}

impl State {
    /// A brush whose planes are numbered from 0, without a place of its own yet.
    pub(super) fn new(brush: Brush, role: Role) -> Self {
        let next_plane = brush.faces.len();
        let place = Place { parent: None, key: OrderKey::FIRST };
        Self { brush, planes: (0..next_plane).map(PlaneIdx).collect(), next_plane, role, place, line: None }
    }

    /// Whether all that the user has said is the same; handles of planes that were given in between do not count.
    pub(super) fn is_same(&self, other: &Self) -> bool {
        let Self { brush, planes, next_plane: _, role, place, line } = self;
        (brush, planes) == (&other.brush, &other.planes)
            && (role, place, line) == (&other.role, &other.place, &other.line)
    }

    /// The place of a plane among the faces of the brush.
    pub(super) fn place_of(&self, plane: PlaneIdx) -> Option<usize> {
        self.planes.binary_search(&plane).ok()
    }

    /// For each plane its place in another state of the brush, where it has the same handle and half-space there.
    pub(super) fn places_in(&self, other: &Self) -> Vec<Option<usize>> {
        let mut at = 0;
        let place = |(number, face): (&PlaneIdx, &BrushFace)| {
            at += other.planes[at..].iter().take_while(|other| *other < number).count();
            let is_same = other.planes.get(at) == Some(number) && other.brush.faces[at].half_space == face.half_space;
            is_same.then_some(at)
        };
        self.planes.iter().zip(&self.brush.faces).map(place).collect()
    }
}

/// A brush of a live model, and what is worked out from it.
#[derive(Debug, Clone)]
pub(super) struct Operand {
    pub(super) id: BrushId,
    /// Whether it is still part of the model: what is not is forgotten at the end of the edit.
    pub(super) is_there: bool,
    pub(super) state: Arc<State>,
    /// The size of the body that its planes bound, where it counts.
    pub(super) size: Option<f64>,
    /// Its planes, in their order.
    pub(super) uses: Vec<PlaneUse>,
    /// Nothing where the brush is empty.
    pub(super) body: Option<Body>,
    /// The mark of the body's faces.
    pub(super) mark: u64,
    /// For each face of the body the edges of the boundary on it, sorted.
    pub(super) edges: Vec<Vec<(BoundaryEdge, EdgeId)>>,
}

type Entry = GeomWithData<Rectangle<[f64; 3]>, OperandId>;

/// Where the bodies are, by number.
#[derive(Debug, Clone, Default)]
pub(super) struct Places {
    tree: RTree<Entry>,
    /// Boxes that are not finite, beside the tree.
    infinite: Vec<(Bounds, OperandId)>,
}

impl Places {
    pub(super) fn insert(&mut self, bounds: &Bounds, number: OperandId) {
        match entry(bounds, number) {
            Some(entry) => self.tree.insert(entry),
            None => self.infinite.push((*bounds, number)),
        }
    }

    pub(super) fn remove(&mut self, bounds: &Bounds, number: OperandId) {
        match entry(bounds, number) {
            Some(entry) => {
                self.tree.remove(&entry);
            }
            None => self.infinite.retain(|(_, other)| *other != number),
        }
    }

    /// The bodies whose closed boxes have a point in common with a box; none is told where some are not finite.
    pub(super) fn touching(&self, bounds: &Bounds) -> Option<impl Iterator<Item = OperandId>> {
        let envelope = AABB::from_corners(bounds.min.to_array(), bounds.max.to_array());
        let all = self.tree.locate_in_envelope_intersecting(envelope).map(|entry| entry.data);
        self.infinite.is_empty().then_some(all)
    }

    /// The bodies whose boxes may share an area with a box, and their boxes.
    pub(super) fn near(&self, bounds: &Bounds) -> impl Iterator<Item = (OperandId, Bounds)> {
        let envelope = AABB::from_corners(bounds.min.to_array(), bounds.max.to_array());
        let with_box = |entry: &Entry| {
            let box_of = entry.geom();
            let other = Bounds { min: DVec3::from(box_of.lower()), max: DVec3::from(box_of.upper()) };
            (entry.data, other)
        };
        let finite = self.tree.locate_in_envelope_intersecting(envelope).map(with_box);
        let infinite = self.infinite.iter().map(|(other, number)| (*number, *other));
        finite.chain(infinite).filter(|(_, other)| other.may_share_area(bounds))
    }

    /// The bodies whose boxes a ray may meet.
    pub(super) fn along(&self, ray: &Ray) -> impl Iterator<Item = OperandId> {
        let finite = self.tree.locate_with_selection_function(Along(*ray)).map(|entry| entry.data);
        let infinite = self.infinite.iter().filter(|(bounds, _)| ray.distance_to_box(bounds, IN_BOX).is_some());
        finite.chain(infinite.map(|(_, number)| *number))
    }
}

/// What a ray meets.
struct Along(Ray);

impl SelectionFunction<Entry> for Along {
    fn should_unpack_parent(&self, envelope: &AABB<[f64; 3]>) -> bool {
        let bounds = Bounds { min: DVec3::from(envelope.lower()), max: DVec3::from(envelope.upper()) };
        self.0.distance_to_box(&bounds, IN_BOX).is_some()
    }
}

fn entry(bounds: &Bounds, number: OperandId) -> Option<Entry> {
    let is_finite = bounds.min.is_finite() && bounds.max.is_finite();
    is_finite.then(|| GeomWithData::new(Rectangle::from_corners(bounds.min.to_array(), bounds.max.to_array()), number))
}
