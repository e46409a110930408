//! A convex cell: its polytope, and which plane of the table and which face of which brush each of its planes is.

use planecut_csg::stages::Bounds;
use planecut_csg::{MaterialId, PlaneId, PlaneTable};
use planecut_kernel::sign::{Homogeneous, Sign};
use planecut_kernel::{AddPlaneResult, DVec3, IncrementalPolytope, PlaneIdx};

/// A box without bounds.
const EVERYWHERE: Bounds = Bounds { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY };

/// Widens coordinates that were rounded once.
const COORDINATE_BOUND: f64 = 4.0 * f64::EPSILON;

/// From this number of planes on a polytope is rebuilt where it has this many times as many places for planes as planes.
const MANY_PLANES: usize = 64;
const COMPACTED: usize = 4;

/// A plane of a [`Cell`], and where it comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct CellPlane {
    /// The plane, its normal pointing out of the cell.
    pub plane: PlaneId,
    /// The numbers of the brush and of its face; `None` for a plane with which the user cut the solid. Of a plane of a cell on
    /// which faces of several brushes lie, one of them; a [`RayHit`](crate::RayHit) names the one at the place.
    pub brush_face: Option<(u32, u32)>,
    /// What the face is made of.
    pub material: MaterialId,
}

impl CellPlane {
    pub(super) fn flipped(self) -> Self {
        Self { plane: self.plane.flipped(), ..self }
    }

    /// The same with the plane and the brush renumbered.
    pub(super) fn moved(&self, id: impl Fn(PlaneId) -> PlaneId, first_brush: u32) -> Self {
        let brush_face = self.brush_face.map(|(brush, face)| (brush + first_brush, face));
        Self { plane: id(self.plane), brush_face, ..*self }
    }
}

/// What adding a plane did to a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Cut {
    /// It has a face now.
    Face,
    /// The cell lies inside the plane.
    Nothing,
    /// Nothing is left.
    Empty,
}

/// A convex part of a [`Solid`](crate::Solid).
#[derive(Debug, Clone)]
pub struct Cell {
    pub(super) polytope: IncrementalPolytope,
    /// By the number of the handle.
    planes: Vec<Option<CellPlane>>,
    bounds: Bounds,
}

/// A corner: three planes with right-handed normals, and where they meet.
pub(super) type Corner = ([PlaneId; 3], Homogeneous);

impl Cell {
    /// All of space.
    pub(super) fn everything() -> Self {
        Self { polytope: IncrementalPolytope::with_epsilon(0.0), planes: Vec::new(), bounds: EVERYWHERE }
    }

    /// The polytope: its handles name planes for [`Cell::plane`].
    #[must_use]
    pub fn polytope(&self) -> &IncrementalPolytope {
        &self.polytope
    }

    /// The plane behind a handle of the polytope.
    #[must_use]
    pub fn plane(&self, handle: PlaneIdx) -> Option<&CellPlane> {
        self.planes.get(handle.0)?.as_ref()
    }

    /// The planes, by handle: those that carry a face, and those that were cut along and still touch the cell.
    pub fn planes(&self) -> impl Iterator<Item = (PlaneIdx, &CellPlane)> {
        self.planes.iter().enumerate().filter_map(|(k, plane)| Some((PlaneIdx(k), plane.as_ref()?)))
    }

    /// A box that surely holds the cell, infinite where the cell is.
    pub(super) fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    /// The handle of a plane of the table.
    pub(super) fn handle(&self, plane: PlaneId) -> Option<PlaneIdx> {
        self.planes().find(|(_, known)| known.plane == plane).map(|(handle, _)| handle)
    }

    /// Cuts the cell, in place, and leaves its box as it was. A plane that is there already is not added again.
    pub(super) fn add(&mut self, table: &PlaneTable, plane: CellPlane) -> Cut {
        if self.handle(plane.plane).is_some() {
            return Cut::Nothing;
        }
        self.add_again(table, plane).1
    }

    /// The same, whether or not the plane is there already, so that it can be removed.
    pub(super) fn add_again(&mut self, table: &PlaneTable, plane: CellPlane) -> (PlaneIdx, Cut) {
        let (handle, cut) = match self.polytope.add_plane(*table.half_space(plane.plane)) {
            AddPlaneResult::Added { plane, .. } => (plane, Cut::Face),
            AddPlaneResult::Redundant { plane } => (plane, Cut::Nothing),
            AddPlaneResult::Empty { plane } => (plane, Cut::Empty),
        };
        if self.planes.len() <= handle.0 {
            self.planes.resize(handle.0 + 1, None);
        }
        self.planes[handle.0] = Some(plane);
        (handle, cut)
    }

    /// Takes a plane back, and leaves the box as it was.
    pub(super) fn remove(&mut self, handle: PlaneIdx) {
        self.polytope.remove_plane(handle);
        if let Some(plane) = self.planes.get_mut(handle.0) {
            *plane = None;
        }
    }

    /// The finite corners of the perturbed structure; several can coincide.
    pub(super) fn corners(&self, table: &PlaneTable) -> Vec<Corner> {
        let finite = self.polytope.simple_vertices().filter_map(|[a, b, c]| Some([a?, b?, c?]));
        let triples = finite.filter_map(|[a, b, c]| Some([self.plane(a)?, self.plane(b)?, self.plane(c)?]));
        triples.map(|triple| triple.map(|plane| plane.plane)).map(|ids| (ids, table.homogeneous(ids))).collect()
    }

    /// The planes that have a face with an area.
    pub(super) fn facets(&self) -> Vec<CellPlane> {
        self.polytope.facets().iter().filter_map(|(handle, _)| self.plane(*handle).copied()).collect()
    }

    /// Makes the cell ready after cuts: its box is computed again, and planes without a face that no longer touch it are
    /// dropped.
    ///
    /// Those that touch it in a corner or an edge stay. They hide nothing now, but when coefficients are rounded (a turned
    /// solid), a cell that keeps the planes along which it was cut is still the part of space on these sides of them.
    pub(super) fn settle(&mut self, table: &PlaneTable) {
        let corners = self.corners(table);
        let touches = |plane: PlaneId| corners.iter().any(|(ids, point)| table.side(*ids, point, plane) == Sign::Zero);
        let idle =
            |(handle, plane): &(PlaneIdx, &CellPlane)| self.polytope.is_redundant(*handle) && !touches(plane.plane);
        let dropped: Vec<PlaneIdx> = self.planes().filter(idle).map(|(handle, _)| handle).collect();
        for handle in dropped {
            self.remove(handle);
        }
        self.bounds = self.bounds_of(&corners);
        self.compact(table);
    }

    /// Rebuilds the polytope where most of its memory is that of planes which are no longer there: a piece cut off a body of thousands of planes may have ten.
    fn compact(&mut self, table: &PlaneTable) {
        let count = self.planes().count();
        if self.planes.len() < MANY_PLANES || self.planes.len() < COMPACTED * count {
            return;
        }
        let mut compact = Self { bounds: self.bounds, ..Self::everything() };
        for (_, plane) in self.planes() {
            compact.add(table, *plane);
        }
        *self = compact;
    }

    fn bounds_of(&self, corners: &[Corner]) -> Bounds {
        if self.polytope.is_bounded() {
            return corners.iter().fold(Bounds::EMPTY, |bounds, (_, point)| bounds.with_point(point));
        }
        let Some(bounds) = self.polytope.bounding_box() else { return Bounds::EMPTY };
        let margin = |v: DVec3| v.abs() * COORDINATE_BOUND;
        Bounds { min: bounds.min - margin(bounds.min), max: bounds.max + margin(bounds.max) }
    }

    /// Whether nothing is left of it.
    pub(super) fn is_empty(&self) -> bool {
        self.polytope.is_empty()
    }

    /// The cell of the same planes in another table: `ids` gives the new id of each plane, `exactly` tells where that is the
    /// same plane. `None` where nothing is left.
    pub(super) fn renumbered(
        &self,
        table: &PlaneTable,
        ids: impl Fn(PlaneId) -> PlaneId,
        exactly: impl Fn(PlaneId) -> bool,
        first_brush: u32,
    ) -> Option<Self> {
        let moved = |plane: &CellPlane| plane.moved(&ids, first_brush);
        if self.planes().all(|(_, plane)| exactly(plane.plane)) {
            let planes = self.planes.iter().map(|plane| plane.as_ref().map(moved)).collect();
            return Some(Self { polytope: self.polytope.clone(), planes, bounds: self.bounds });
        }
        let mut cell = Self::everything();
        for (_, plane) in self.planes() {
            if cell.add(table, moved(plane)) == Cut::Empty {
                return None;
            }
        }
        cell.settle(table);
        Some(cell)
    }

    /// Splits the cell along a plane that crosses it: this keeps what is inside, the other is returned.
    pub(super) fn split_off(&mut self, table: &PlaneTable, plane: CellPlane) -> Self {
        let mut outside = self.clone();
        outside.add(table, plane.flipped());
        self.add(table, plane);
        outside
    }
}
