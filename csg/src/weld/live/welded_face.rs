//! A face of a welded boundary, as it is seen from outside.

use planecut_kernel::DVec3;

use super::State;
use super::faces::Face;
use super::loops::Loop;
use super::numbers::Numbers;
use crate::base::sortable;
use crate::ids::{FaceId, HalfEdgeId, Id};
use crate::model::MaterialId;
use crate::plane_table::PlaneId;
use crate::weld::nest::Projection;

/// A planar, connected region of the boundary, with its triangles.
#[derive(Clone, Copy)]
pub(crate) struct WeldedFace<'a> {
    numbers: &'a Numbers,
    state: &'a State,
    face: &'a Face,
}

impl<'a> WeldedFace<'a> {
    pub(super) fn new(numbers: &'a Numbers, state: &'a State, number: FaceId) -> Option<Self> {
        Some(Self { numbers, state, face: state.faces.get(number)? })
    }

    /// What it is made of.
    pub(crate) fn material(&self) -> MaterialId {
        self.numbers.material(self.face.region)
    }

    /// Its plane, directed out of the solid.
    pub(crate) fn plane(&self) -> PlaneId {
        self.numbers.planes[self.face.region.index()]
    }

    pub(crate) fn triangle_count(&self) -> usize {
        self.face.triangulation.count()
    }

    /// Whether it may hold a place on its plane, seen in a projection, or pass it by no more than a margin.
    pub(crate) fn may_hold(&self, projection: Projection, place: DVec3, margin: f64) -> bool {
        self.state.faces.outer_loop(self.face).extent.is_near(projection.of(place), margin)
    }

    /// The edges around it, loop by loop: first around all of it, then around holes in the order of where they begin.
    pub(crate) fn edges(self) -> impl Iterator<Item = [DVec3; 2]> + use<'a> {
        let Self { numbers, state, face } = self;
        let ends = |piece: &HalfEdgeId| {
            let half_edge = &state.pieces.half_edges[piece.index()];
            [half_edge.from, half_edge.to].map(|point| numbers.position(point))
        };
        let mut loops: Vec<&Loop> = state.faces.loops_of(face).collect();
        loops[1..].sort_by_cached_key(|hole| ends(&hole.pieces[0]).map(|at| at.to_array().map(sortable)));
        loops.into_iter().flat_map(|members| &members.pieces).map(ends)
    }

    /// A triangle: for each corner the number of its vertex, and its position.
    pub(crate) fn triangle(&self, place: usize) -> [(u32, DVec3); 3] {
        let Self { numbers, state, face } = self;
        let corner = |piece: HalfEdgeId| {
            let position = numbers.position(state.pieces.half_edges[piece.index()].from);
            (state.vertices.at(piece).number(), position)
        };
        face.triangulation.triangle(place).map(corner)
    }
}
