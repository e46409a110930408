//! Rays against the boundary.

use planecut_csg::stages::Bounds;
use planecut_kernel::{ClippedLine, DVec3, PlaneIdx};

use super::Solid;
use super::cell::{Cell, CellPlane};

/// Where a ray crosses the boundary of a solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RayHit {
    /// Distance from the origin of the ray.
    pub distance: f64,
    /// The place.
    pub point: DVec3,
    /// The unit outward normal of the solid there.
    pub normal: DVec3,
    /// Whether the ray enters the solid; else it leaves.
    pub entering: bool,
    /// The plane, oriented out of the solid, with the brush, its face and the material; where faces of several brushes lie on
    /// each other, the first that faces the same way.
    pub face: CellPlane,
}

/// The part of a ray in one cell.
type Span<'a> = (ClippedLine, &'a Cell);

impl Solid {
    /// The first place where the ray `origin + t·direction`, `t ≥ 0`, crosses the boundary; `None` where it does not, or where
    /// a number is not finite.
    ///
    /// The solid is closed, so a ray that begins on the boundary and goes inward begins inside, one that runs along a face runs
    /// inside, and a single point where it grazes an edge or a corner is no crossing. Walls between cells are none
    /// either: the parameter of a plane is rounded correctly and so the same for the cells on both sides.
    ///
    /// ```
    /// use planecut_cells::Solid;
    /// use planecut_csg::{Brush, MaterialId};
    /// use planecut_kernel::DVec3;
    ///
    /// let block = |min: f64, max: f64| {
    ///     Solid::from(Brush::cuboid(DVec3::splat(min), DVec3::splat(max), MaterialId(0)))
    /// };
    /// let shell = &block(0.0, 3.0) - &block(1.0, 2.0);
    /// let hit = shell.ray_cast(DVec3::splat(1.5), DVec3::X).expect("it begins in the hollow");
    /// assert_eq!((hit.distance, hit.normal, hit.entering), (0.5, -DVec3::X, true));
    /// // the hollow was the first face, at x = 2, of the brush that came second
    /// assert_eq!(hit.face.brush_face, Some((1, 0)));
    /// ```
    #[must_use]
    pub fn ray_cast(&self, origin: DVec3, direction: DVec3) -> Option<RayHit> {
        let spans = self.spans(origin, direction);
        let mut spans = spans.iter().peekable();
        let first = spans.peek()?;
        let hit = |t: f64, cell: &Cell, plane: Option<PlaneIdx>, entering: bool| {
            let point = origin + direction * t;
            let face = self.sources.locate(&self.table, *cell.plane(plane?)?, point);
            let normal = self.table.half_space(face.plane).normal().normalize();
            Some(RayHit { distance: t * direction.length(), point, normal, entering, face })
        };
        if first.0.from > 0.0 {
            return hit(first.0.from, first.1, first.0.entry, true);
        }
        let mut last = spans.next()?;
        while let Some(next) = spans.next_if(|next| next.0.from <= last.0.to) {
            if next.0.to > last.0.to {
                last = next;
            }
        }
        if last.0.to.is_finite() { hit(last.0.to, last.1, last.0.exit, false) } else { None }
    }

    /// The parts of a ray that lie in cells, by where they begin; single points are left out.
    fn spans(&self, origin: DVec3, direction: DVec3) -> Vec<Span<'_>> {
        let near = self.cells_where(|bounds| may_meet(bounds, origin, direction));
        let clipped = near.filter_map(|cell| Some((cell.polytope().clip_ray(origin, direction)?, cell)));
        let mut spans: Vec<Span> = clipped.filter(|(clip, _)| clip.from < clip.to).collect();
        spans.sort_by(|a, b| a.0.from.total_cmp(&b.0.from).then(b.0.to.total_cmp(&a.0.to)));
        spans
    }
}

/// Whether a ray may meet a box.
fn may_meet(bounds: &Bounds, origin: DVec3, direction: DVec3) -> bool {
    let (mut from, mut to) = (0.0, f64::INFINITY);
    for axis in 0..3 {
        let (low, high) = (bounds.min[axis] - origin[axis], bounds.max[axis] - origin[axis]);
        let slack = (low.abs().max(high.abs()) + origin[axis].abs()) * 1e-9;
        let (low, high) = (low - slack, high + slack);
        if direction[axis] == 0.0 {
            if low > 0.0 || high < 0.0 {
                return false;
            }
            continue;
        }
        let (a, b) = (low / direction[axis], high / direction[axis]);
        from = f64::max(from, a.min(b));
        to = f64::min(to, a.max(b));
    }
    // NaN may come of infinite boxes: such are asked
    from.is_nan() || to.is_nan() || from <= to
}
