//! A parallel projection.

use planecut_kernel::{DVec2, DVec3};

/// Where a point of space falls on the picture.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Camera {
    right: DVec3,
    up: DVec3,
    toward: DVec3,
    target: DVec3,
    origin: DVec2,
    scale: f64,
}

impl Camera {
    /// Looks at `target`, which falls on `origin`, from the direction `toward`; `scale` is pixels to one unit.
    pub(crate) fn new(toward: DVec3, target: DVec3, origin: DVec2, scale: f64) -> Self {
        let toward = toward.normalize();
        let above = if toward.z.abs() > 0.999 { DVec3::Y } else { DVec3::Z };
        let right = above.cross(toward).normalize();
        Self { right, up: toward.cross(right), toward, target, origin, scale }
    }

    pub(crate) fn project(&self, point: DVec3) -> DVec2 {
        let from_target = point - self.target;
        self.origin + DVec2::new(self.right.dot(from_target), -self.up.dot(from_target)) * self.scale
    }

    pub(crate) fn sees(&self, normal: DVec3) -> bool {
        normal.dot(self.toward) > 0.0
    }
}
