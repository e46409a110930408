//! Where positions are stored: in single precision near an origin, or on a grid.

use std::borrow::Cow;

use glam::{DVec3, I16Vec3, Vec3};
use planecut_csg::Mesh;

use super::origin::choose_origin;
use crate::ExportOptions;
use crate::surface::without_lost_edges;

/// The farthest that a position of 16 bits reaches.
const REACH: f64 = i16::MAX as f64;

/// How the positions of a mesh are stored.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rounding {
    /// The point that they are relative to; exact in single precision.
    pub(super) origin: DVec3,
    /// Of the grid that they lie on, a power of two; none where they are in single precision.
    pub(super) step: Option<f64>,
    /// Of the grid that they are rounded to first, a power of two of which the origin is a multiple; none where they are not. Meshes that have this
    /// in common store what they share at one place.
    common: Option<f64>,
}

impl Rounding {
    pub(super) fn of(positions: &[DVec3], options: &ExportOptions) -> Self {
        let origin = choose_origin(positions);
        Self { origin, step: options.quantize.then(|| grid_step(positions, origin)), common: None }
    }

    /// Those of meshes in boxes, which meet: all on one grid, so that a position is stored at the same place in each. Its step is that of single
    /// precision, or of 16 bits, at the farthest corner of the largest box.
    pub(super) fn in_common(boxes: &[Option<[DVec3; 2]>], options: &ExportOptions) -> Vec<Self> {
        let origins: Vec<DVec3> =
            boxes.iter().map(|corners| choose_origin(corners.as_slice().as_flattened())).collect();
        let reach = |(corners, origin): (&Option<[DVec3; 2]>, &DVec3)| {
            let corners = corners.as_slice().as_flattened().iter();
            corners.map(|corner| (*corner - *origin).abs().max_element()).fold(0.0, f64::max)
        };
        let reach = boxes.iter().zip(&origins).map(reach).fold(0.0, f64::max);
        let step = exact_step_within(reach, options);
        // that of a small mesh may lie on a finer grid; adding zero turns -0 into 0
        let onto_grid = |origin: DVec3| (origin / step).round() * step + DVec3::ZERO;
        let of_origin = |origin: DVec3| Self {
            origin: onto_grid(origin),
            step: options.quantize.then_some(step),
            common: Some(step),
        };
        origins.into_iter().map(of_origin).collect()
    }

    /// The mesh without the edges whose ends are stored as one place.
    pub(super) fn reduced(self, mesh: &Mesh) -> Cow<'_, Mesh> {
        without_lost_edges(mesh, |position| self.stored(position))
    }

    /// In single precision, relative to the origin.
    pub(super) fn single(self, position: DVec3) -> Vec3 {
        self.relative(position).as_vec3()
    }

    /// On the grid.
    pub(super) fn grid(self, position: DVec3, step: f64) -> I16Vec3 {
        (self.relative(position) / step).round().as_i16vec3()
    }

    fn relative(self, position: DVec3) -> DVec3 {
        match self.common {
            Some(step) => (position / step).round() * step - self.origin,
            None => position - self.origin,
        }
    }

    /// Where readers find a position.
    pub(super) fn place(self, position: DVec3) -> DVec3 {
        self.stored(position).as_dvec3() * self.step.unwrap_or(1.0) + self.origin
    }

    fn stored(self, position: DVec3) -> Vec3 {
        match self.step {
            Some(step) => self.grid(position, step).as_vec3(),
            None => self.single(position),
        }
    }
}

/// The step of the finest grid of a power of two on which positions have 16 bits.
fn grid_step(positions: &[DVec3], origin: DVec3) -> f64 {
    let reach = positions.iter().map(|position| (*position - origin).abs().max_element()).fold(0.0, f64::max);
    let finest = reach / REACH;
    if finest.is_normal() && finest.is_finite() { finest.log2().ceil().exp2() } else { 1.0 }
}

/// A power of two whose multiples near these positions are stored without rounding.
///
/// The origin is a multiple of it as well, within 1/16 of half the extent from the middle, or within a step of single precision of that, whichever is
/// more; so the difference of both is a multiple of the step that has 24 bits, or 16 of a grid. Rounding may make the extent larger
/// by a step: a hundredth is room for that.
pub(super) fn exact_step(positions: &[DVec3], options: &ExportOptions) -> f64 {
    let Some(&first) = positions.first() else { return 1.0 };
    let (min, max) = positions.iter().fold((first, first), |(min, max), p| (min.min(*p), max.max(*p)));
    let (middle, half) = (min * 0.5 + max * 0.5, (max * 0.5 - min * 0.5).max_element());
    let origin = (half / 16.0).max(middle.abs().max_element() * f64::from(f32::EPSILON));
    exact_step_within(1.01 * half + origin, options)
}

/// The least power of two whose multiples are stored without rounding as far as this from an origin that is one of them.
fn exact_step_within(reach: f64, options: &ExportOptions) -> f64 {
    let finest = if options.quantize { reach / REACH } else { reach / (1u64 << 24) as f64 };
    if finest.is_normal() && finest.is_finite() {
        finest.log2().ceil().exp2().max(f64::from(f32::MIN_POSITIVE) * f64::from(f32::EPSILON))
    } else {
        1.0
    }
}
