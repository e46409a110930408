//! Where light comes from, and how much of it a face gives off.

use glam::Vec3;

use super::Shade;
use super::look::Look;

/// Where light comes from, as unit vectors in view coordinates.
pub(super) struct Lights {
    pub(super) up: Vec3,
    pub(super) key: Vec3,
    rim: Vec3,
}

impl Lights {
    /// The key light stands behind the camera's left shoulder, high up, whatever side the model is seen from; the rim light behind
    /// the model, to the right.
    pub(super) fn new(up: Vec3) -> Self {
        let towards_eye = Vec3::NEG_Z;
        let horizontal = (towards_eye - up * towards_eye.dot(up)).normalize_or_zero();
        let key = (up * 1.0 + Vec3::NEG_X * 0.62 + horizontal * 0.42).normalize();
        let rim = (up * 0.35 + Vec3::X * 0.75 - horizontal * 0.65).normalize();
        Self { up, key, rim }
    }

    pub(super) fn shade(&self, look: &Look, color: Vec3, normal: Vec3) -> Shade {
        let sky_part = 0.5 + 0.5 * normal.dot(self.up);
        // The fill light comes from the right, where the key light does not reach.
        let fill_part = 0.5 + 0.5 * normal.dot(Vec3::X);
        let rim_part = normal.dot(self.rim).max(0.0);
        let ambient =
            look.bounce.lerp(look.sky, sky_part) + look.fill_light * fill_part + look.rim * rim_part * rim_part;
        let direct = look.key * normal.dot(self.key).max(0.0);
        Shade { ambient: color * ambient, direct: color * direct }
    }
}
