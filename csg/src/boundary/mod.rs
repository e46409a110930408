//! The boundary of a tree of bodies, as directed boundary edges of the kept regions; no cells, no fragments.
//!
//! A place on a face is boundary where the tree differs between just inside and just outside. On each face of each body
//! ([`face`]) other bodies cover convex polygons ([`section`]). What the weld needs are only the edges where the boundary
//! ends: pieces of the face's own edges, and pieces of the section edges, each clipped in one dimension. Mostly each body
//! alone decides what is inside or outside of its polygon, and intervals are subtracted; where several decide together,
//! [`sweep`] evaluates the tree along each edge. Only the part of the tree that reaches a face is ever looked at. Of coplanar
//! faces one owner emits ([`ownership`]); what most bodies do to a face is told without the others ([`role`]). Where bodies change near a part of a face,
//! the edges there are put among those known ([`splice`]); where one more body covers something, nothing but its own section is looked at ([`covered`]).

mod clip;
mod contact;
mod corner_sides;
mod covered;
mod face;
mod ownership;
mod role;
mod section;
mod signs;
mod splice;
mod sweep;

use std::borrow::Cow;

use planecut_kernel::sign::Counts;

use crate::base::{Boxes, Workers, concat_owned, map_chunks};
use crate::body::{Body, BodyFace, PolarDual};
use crate::expression::{Expression, OneLevel, Polarity};
use crate::ids::{BodyFaceId, BodyId, Id, LeafId};
use crate::model::MaterialId;
use crate::plane_table::{PlaneId, PlaneTable};
use contact::Facing;
pub(crate) use contact::misses;
pub(crate) use covered::can_cover;
pub(crate) use face::FaceWorker;
use ownership::{Round, Turn, material_of};
pub(crate) use splice::{EdgeChange, KnownEdge};

/// A piece of the boundary of the kept region of a plane: on the line of `face` and `edge`, directed along
/// `n_face × n_edge`, so that the region lies to the left.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct BoundaryEdge {
    /// The plane of the region, outward.
    pub(crate) face: PlaneId,
    /// The plane that ends the region, oriented away from it.
    pub(crate) edge: PlaneId,
    /// The plane that ends the piece at its start.
    pub(crate) start: PlaneId,
    /// The plane that ends the piece at its end.
    pub(crate) end: PlaneId,
    pub(crate) material: MaterialId,
}

impl BoundaryEdge {
    /// The edge of a region that lies left of `n_face × n_edge`, from `start` to `end` in that direction; `facing` tells
    /// whether the region faces as `face` does.
    fn left(face: &BodyFace, facing: Facing, edge: PlaneId, start: PlaneId, end: PlaneId) -> Self {
        let (plane, material) = (face.plane, material_of(face));
        match facing {
            Facing::Out => Self { face: plane, edge, start, end, material },
            // seen from the other side it runs back
            Facing::In => Self { face: plane.flipped(), edge, start: end, end: start, material },
        }
    }

    /// The same for a region to the right.
    fn right(face: &BodyFace, facing: Facing, edge: PlaneId, start: PlaneId, end: PlaneId) -> Self {
        Self::left(face, facing, edge.flipped(), end, start)
    }
}

/// Bodies, and the tree over them.
pub(crate) struct Scene<'a> {
    pub(crate) table: &'a PlaneTable,
    pub(crate) bodies: Vec<&'a Body>,
    /// The leaf of each body, ascending.
    pub(crate) leaf_of_body: &'a [LeafId],
    pub(crate) expression: &'a Expression,
    /// For each leaf the polarity of all that equal it, those that are left out among them.
    polarities: &'a [Polarity],
    /// Where the expression is of one level, what it does.
    one_level: Option<OneLevel>,
    /// How many bodies have a face on each plane; 255 stands for more as well.
    bodies_on_plane: Cow<'a, [u8]>,
    /// Orders materials: where coplanar faces overlap, the lower rank wins, so that the outcome does not depend on the
    /// order of the bodies.
    pub(crate) rank: &'a [u32],
}

impl<'a> Scene<'a> {
    pub(crate) fn new(
        table: &'a PlaneTable,
        bodies: &'a [Body],
        leaf_of_body: &'a [LeafId],
        (expression, polarities): (&'a Expression, &'a [Polarity]),
        rank: &'a [u32],
    ) -> Self {
        let mut bodies_on_plane = vec![0_u8; table.len()];
        for face in bodies.iter().flat_map(|body| &body.faces) {
            let count = &mut bodies_on_plane[face.plane.index() as usize];
            *count = count.saturating_add(1);
        }
        Self::of_some(table, bodies.iter().collect(), leaf_of_body, (expression, polarities), bodies_on_plane, rank)
    }

    /// Some of many bodies; how many of all have a face on each plane is known.
    pub(crate) fn of_some(
        table: &'a PlaneTable,
        bodies: Vec<&'a Body>,
        leaf_of_body: &'a [LeafId],
        (expression, polarities): (&'a Expression, &'a [Polarity]),
        bodies_on_plane: impl Into<Cow<'a, [u8]>>,
        rank: &'a [u32],
    ) -> Self {
        let (one_level, bodies_on_plane) = (expression.one_level(), bodies_on_plane.into());
        Self { table, bodies, leaf_of_body, expression, polarities, one_level, bodies_on_plane, rank }
    }

    fn body(&self, body: BodyId) -> &'a Body {
        self.bodies[body.index()]
    }

    fn polar_dual(&self, body: BodyId) -> Option<&'a PolarDual> {
        self.body(body).polar_dual(self.table)
    }

    /// Whether bodies other than the face's own may have a face on its plane.
    fn is_plane_shared(&self, face: &BodyFace) -> bool {
        self.bodies_on_plane[face.plane.index() as usize] > 1
    }

    /// Whether a body adds to the solid or takes from it.
    fn polarity(&self, body: BodyId) -> Polarity {
        self.expression.polarity(self.leaf_of_body[body.index()])
    }

    /// When a face of a body has its turn among those on its plane.
    fn turn(&self, body: BodyId, face: &BodyFace) -> Turn {
        let polarity = self.polarities[self.leaf_of_body[body.index()].index()];
        Turn { round: Round { polarity, material_rank: self.rank[face.material.0 as usize] }, body }
    }
}

/// The boundary edges of a tree of bodies, those on the faces of the bodies that are asked for.
pub(crate) fn boundary_edges(scene: &Scene<'_>, is_own: impl Fn(BodyId) -> bool) -> (Vec<BoundaryEdge>, Counts) {
    let bodies = &scene.bodies;
    let boxes = Boxes::new(bodies.iter().map(|body| body.bounds).collect());
    let body_of = |place: &u32| BodyId::from_index(*place as usize);
    // in the order of space, so that what is near is at hand
    let in_order: Vec<u32> = boxes.in_order().filter(|place| is_own(body_of(place))).collect();
    let workers = Workers::new(|| (FaceWorker::default(), Vec::new()));
    let (parts, counts) = map_chunks(&in_order, 1, |chunk| {
        let mut edges = Vec::new();
        workers.with(|(worker, found)| {
            for body in chunk.iter().map(body_of) {
                let solid = scene.body(body);
                boxes.find(|other| other.may_share_area(&solid.bounds), found);
                worker.begin(scene, body, found.iter().map(body_of));
                for face in BodyFaceId::all(solid.faces.len()) {
                    worker.emit(scene, face, &mut edges);
                }
            }
        });
        // room for more may be as much again
        edges.shrink_to_fit();
        edges
    });
    (concat_owned(parts), counts)
}

/// The boundary edges of the union of bodies.
pub(crate) fn boundary_of_union(table: &PlaneTable, bodies: &[Body], rank: &[u32]) -> (Vec<BoundaryEdge>, Counts) {
    let count = bodies.len();
    let leaves: Vec<LeafId> = LeafId::all(count).collect();
    let expression = Expression::union_of(count);
    boundary_edges(&Scene::new(table, bodies, &leaves, (&expression, &vec![Polarity::Adds; count]), rank), |_| true)
}
