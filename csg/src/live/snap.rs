//! Where a plane that is moved may be meant to go: onto a grid, onto the plane of another face, through a corner.

use planecut_kernel::sign::Row;
use planecut_kernel::{DVec3, HalfSpace, PlaneIdx};

use super::{BrushId, EditError, LiveModel};
use crate::plane_table::unit;
use crate::tolerances::{ON_FACE, SNAP_TOLERANCE};

/// What a plane may snap to.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SnapOptions {
    /// The step of a grid: distances from the origin are multiples of it. It has an effect where nothing else is near.
    pub grid: Option<f64>,
    /// Maximum distance from parallel planes of faces of other brushes.
    pub planes: Option<f64>,
    /// Maximum distance from corners of the solid.
    pub vertices: Option<f64>,
}

/// What a plane snaps to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Snap {
    /// Where the plane goes.
    pub half_space: HalfSpace,
    /// What is there.
    pub to: SnapTarget,
    /// How far it is from where the plane was to go.
    pub distance: f64,
}

/// Something that a plane snaps to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SnapTarget {
    /// The plane of another brush, exactly: the faces are coplanar.
    Plane {
        /// The other brush.
        brush: BrushId,
        /// Its plane.
        plane: PlaneIdx,
    },
    /// A corner of the solid, up to the rounding of the offset.
    Vertex(DVec3),
    /// A multiple of the step of the grid.
    Grid,
}

impl LiveModel {
    /// What a plane of a brush snaps to that is about to go to `to`, which [`move_plane`](Self::move_plane) takes; `None` where nothing is near enough. Of planes and corners it is the nearest, of equally near ones a plane; the grid where there is none of either. The
    /// plane of another brush is taken as it is, so that both are one plane exactly; planes count as parallel where they do for the model itself
    /// ([`SNAP_TOLERANCE`]). Corners in the plane as it is now do not count. A step of the grid that is not above zero has no effect.
    ///
    /// ```
    /// use planecut_csg::{Brush, LiveModel, Material, MaterialId, Role, SnapOptions, SnapTarget};
    /// use planecut_kernel::{DVec3, HalfSpace, PlaneIdx};
    ///
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let mut model = LiveModel::new(vec![Material::named("stone")]);
    /// let cube = |at: f64| Brush::cuboid(DVec3::splat(at), DVec3::splat(at + 1.1), MaterialId(0));
    /// let (one, _) = model.add_brush(cube(0.0), Role::Add)?;
    /// let (other, _) = model.add_brush(cube(2.2), Role::Add)?;
    /// let options = SnapOptions { planes: Some(0.25), ..SnapOptions::default() };
    /// let snap = model.snap_plane(one, PlaneIdx(0), &HalfSpace::new(DVec3::X, 2.1)?, &options)?.expect("a face is near");
    /// assert_eq!(snap.half_space, HalfSpace::new(DVec3::X, 2.2)?);
    /// assert_eq!(snap.to, SnapTarget::Plane { brush: other, plane: PlaneIdx(1) });
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// [`EditError::UnknownBrush`], [`EditError::Mesh`], [`EditError::UnknownPlane`].
    pub fn snap_plane(
        &self,
        brush: BrushId,
        plane: PlaneIdx,
        to: &HalfSpace,
        options: &SnapOptions,
    ) -> Result<Option<Snap>, EditError> {
        let state = self.convex_state(brush)?;
        let place = state.place_of(plane).ok_or(EditError::UnknownPlane { brush, plane })?;
        let now = state.brush.faces[place].half_space;
        let plane = options.planes.and_then(|limit| self.nearest_plane(brush, to, limit));
        let vertex = options.vertices.and_then(|limit| self.nearest_vertex(&now, to, limit));
        let nearest = match (plane, vertex) {
            (Some(plane), Some(vertex)) if vertex.distance < plane.distance => Some(vertex),
            (plane, vertex) => plane.or(vertex),
        };
        Ok(nearest.or_else(|| options.grid.and_then(|step| on_grid(to, step))))
    }

    fn nearest_plane(&self, own: BrushId, to: &HalfSpace, limit: f64) -> Option<Snap> {
        let goal = unit(&Row::new(to));
        let mut nearest: Option<Snap> = None;
        for (id, number) in self.by_id.iter().filter(|(id, _)| **id != own) {
            let operand = self.operand(*number);
            let Some(body) = &operand.body else { continue };
            let faces = operand.state.planes.iter().zip(&operand.state.brush.faces).zip(&operand.uses);
            for ((plane, face), used) in faces {
                let Some((half_space, distance)) = aligned(&face.half_space, &goal) else { continue };
                let is_nearer = nearest.is_none_or(|nearest| distance < nearest.distance);
                if distance <= limit && is_nearer && body.face_on(self.planes.id(*used)).is_some() {
                    let to = SnapTarget::Plane { brush: *id, plane: *plane };
                    nearest = Some(Snap { half_space, to, distance });
                }
            }
        }
        nearest
    }

    fn nearest_vertex(&self, now: &HalfSpace, to: &HalfSpace, limit: f64) -> Option<Snap> {
        let (normal, length) = (to.normal(), to.normal().length());
        let is_elsewhere = |place: &DVec3| {
            now.signed_distance(*place).abs() > ON_FACE * place.abs().max_element().max(f64::MIN_POSITIVE)
        };
        let distance = |place: DVec3| (normal.dot(place) - to.offset()).abs() / length;
        let corners = self.faces().flat_map(|(_, face)| face.triangles()).flatten().map(|corner| corner.1);
        let near = corners.filter(is_elsewhere).map(|place| (distance(place), place));
        // whatever the order of the faces
        let key = |place: DVec3| place.to_array();
        let (distance, place) = near.filter(|near| near.0 <= limit).min_by(|a, b| {
            let by_place = || key(a.1).partial_cmp(&key(b.1)).unwrap_or(std::cmp::Ordering::Equal);
            a.0.total_cmp(&b.0).then_with(by_place)
        })?;
        let half_space = HalfSpace::new(normal, normal.dot(place)).ok()?;
        Some(Snap { half_space, to: SnapTarget::Vertex(place), distance })
    }
}

/// A plane turned to the side of one of a unit normal that is parallel to it, and how far it is from that.
fn aligned(half_space: &HalfSpace, goal: &[f64; 4]) -> Option<(HalfSpace, f64)> {
    [*half_space, half_space.flipped()].into_iter().find_map(|side| {
        let unit = unit(&Row::new(&side));
        let is_parallel = (0..3).all(|axis| (unit[axis] - goal[axis]).abs() <= SNAP_TOLERANCE);
        is_parallel.then(|| (side, (unit[3] - goal[3]).abs()))
    })
}

fn on_grid(to: &HalfSpace, step: f64) -> Option<Snap> {
    let length = to.normal().length();
    let from_origin = to.offset() / length;
    let on_grid = (from_origin / step).round() * step;
    let half_space = HalfSpace::new(to.normal(), on_grid * length).ok().filter(|_| step > 0.0)?;
    Some(Snap { half_space, to: SnapTarget::Grid, distance: (on_grid - from_origin).abs() })
}
