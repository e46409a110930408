//! How places in view coordinates and places on the picture correspond.

use glam::{DVec3, Vec2, Vec3};

use crate::input::options::CameraKind;

/// View depth, of an orthographic picture, at which the nearness is 0. Models lie nearer: their middles are
/// [`ORTHOGRAPHIC_DISTANCE`] away, and they reach one radius around them.
const ORTHOGRAPHIC_END: f64 = 4.0;

/// View depth of a model's middle on an orthographic picture.
pub(crate) const ORTHOGRAPHIC_DISTANCE: f64 = 2.0;

/// A place on the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ScreenPoint {
    /// Pixels from the left edge.
    pub(crate) x: f32,
    /// Pixels from the top edge.
    pub(crate) y: f32,
    /// Nearness: positive, larger is nearer, and linear across the picture of a plane, as the depth itself is not with
    /// perspective. Lenses know what depth it stands for.
    pub(crate) w: f32,
}

impl ScreenPoint {
    /// The same point where a pixel is `factor` samples wide.
    pub(crate) fn magnified(self, factor: f32) -> Self {
        Self { x: self.x * factor, y: self.y * factor, w: self.w }
    }

    /// The place without its depth.
    pub(crate) fn place(self) -> Vec2 {
        Vec2::new(self.x, self.y)
    }
}

/// The projection of view coordinates (x right, y up, z away from the eye) onto the picture.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Lens {
    kind: CameraKind,
    /// Half the picture, in pixels.
    half_size: [f64; 2],
    /// View units that a pixel spans, at depth 1 of a perspective picture.
    pixel: f64,
}

impl Lens {
    pub(crate) fn new(kind: CameraKind, half_size: [f64; 2], pixel: f64) -> Self {
        Self { kind, half_size, pixel }
    }

    /// The same lens for a picture of cells, by the number of pixels that each is wide and high.
    pub(crate) fn with_cells_of(self, pixels: usize) -> Self {
        let pixels = pixels as f64;
        Self { half_size: self.half_size.map(|half| half / pixels), pixel: self.pixel * pixels, ..self }
    }

    /// Where a point is seen.
    pub(crate) fn project(&self, view: DVec3) -> ScreenPoint {
        let (shrink, w) = match self.kind {
            CameraKind::Perspective => (1.0 / view.z, 1.0 / view.z),
            CameraKind::Orthographic => (1.0, ORTHOGRAPHIC_END - view.z),
        };
        let x = self.half_size[0] + view.x * shrink / self.pixel;
        let y = self.half_size[1] - view.y * shrink / self.pixel;
        ScreenPoint { x: x as f32, y: y as f32, w: w as f32 }
    }

    /// The view depth of a nearness; infinite for 0, which stands for nothing at all.
    pub(crate) fn depth(&self, nearness: f32) -> f32 {
        match self.kind {
            CameraKind::Perspective => 1.0 / nearness,
            CameraKind::Orthographic if nearness == 0.0 => f32::INFINITY,
            CameraKind::Orthographic => ORTHOGRAPHIC_END as f32 - nearness,
        }
    }

    /// The point in view coordinates that is seen at a place of the picture, at a depth.
    pub(crate) fn point(&self, x: f32, y: f32, depth: f32) -> Vec3 {
        let [right, up] = self.offset(x, y);
        match self.kind {
            CameraKind::Perspective => Vec3::new(right * depth, up * depth, depth),
            CameraKind::Orthographic => Vec3::new(right, up, depth),
        }
    }

    /// Start and direction of the line of sight through a place of the picture.
    pub(crate) fn ray(&self, x: f32, y: f32) -> (Vec3, Vec3) {
        let [right, up] = self.offset(x, y);
        match self.kind {
            CameraKind::Perspective => (Vec3::ZERO, Vec3::new(right, up, 1.0)),
            CameraKind::Orthographic => (Vec3::new(right, up, 0.0), Vec3::Z),
        }
    }

    /// The direction, not of unit length, in which a point is seen.
    pub(crate) fn sight(&self, view: Vec3) -> Vec3 {
        match self.kind {
            CameraKind::Perspective => view,
            CameraKind::Orthographic => Vec3::Z,
        }
    }

    /// Pixels that a length of one view unit across the view spans at a depth.
    pub(crate) fn pixels_per_unit(&self, depth: f32) -> f32 {
        let at_one = (1.0 / self.pixel) as f32;
        match self.kind {
            CameraKind::Perspective => at_one / depth,
            CameraKind::Orthographic => at_one,
        }
    }

    fn offset(&self, x: f32, y: f32) -> [f32; 2] {
        let [half_width, half_height] = self.half_size.map(|half| half as f32);
        let pixel = self.pixel as f32;
        [(x - half_width) * pixel, (half_height - y) * pixel]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_found_again_from_the_picture() {
        for kind in [CameraKind::Perspective, CameraKind::Orthographic] {
            let lens = Lens::new(kind, [150.0, 100.0], 0.002);
            for view in [DVec3::new(0.2, -0.1, 1.5), DVec3::new(-0.3, 0.2, 3.0)] {
                let seen = lens.project(view);
                let depth = lens.depth(seen.w);
                assert!(lens.point(seen.x, seen.y, depth).distance(view.as_vec3()) < 1e-5, "{kind:?}");
                let (start, direction) = lens.ray(seen.x, seen.y);
                assert!((start + direction * depth).distance(view.as_vec3()) < 1e-5, "{kind:?}");
                // The same place where cells are three pixels wide.
                let cells = lens.with_cells_of(3);
                assert!(cells.point(seen.x / 3.0, seen.y / 3.0, depth).distance(view.as_vec3()) < 1e-5, "{kind:?}");
            }
        }
    }

    #[test]
    fn lengths_across_the_view_shrink_with_perspective_only() {
        let [perspective, orthographic] = [CameraKind::Perspective, CameraKind::Orthographic].map(|kind| {
            let lens = Lens::new(kind, [150.0, 100.0], 0.002);
            [1.0, 2.0].map(|depth| {
                let across = lens.project(DVec3::new(0.1, 0.0, depth)).x - lens.project(DVec3::new(0.0, 0.0, depth)).x;
                assert!((across - 0.1 * lens.pixels_per_unit(depth as f32)).abs() < 1e-3);
                across
            })
        });
        assert!((perspective[0] - 2.0 * perspective[1]).abs() < 1e-3);
        assert_eq!(orthographic[0], orthographic[1]);
    }
}
