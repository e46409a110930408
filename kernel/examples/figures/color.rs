//! The colours of all figures, one for each role.

use planecut_kernel::DVec3;

/// Lines and words.
pub(crate) const INK: &str = "#1f2630";

/// A colour of a face, in sRGB.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Color([f64; 3]);

impl Color {
    /// A face that takes no part.
    pub(crate) const PLAIN: Self = Self([222.0, 227.0, 234.0]);
    /// A face of the ring.
    pub(crate) const RING: Self = Self([150.0, 190.0, 232.0]);
    /// A face that is removed.
    pub(crate) const GONE: Self = Self([244.0, 159.0, 92.0]);
    /// What is there after the removal and was not before.
    pub(crate) const NEW: Self = Self([142.0, 208.0, 158.0]);
    /// A plane that is hidden or was.
    pub(crate) const HIDDEN: Self = Self([196.0, 170.0, 230.0]);
    /// The inside, seen through a hole.
    pub(crate) const INSIDE: Self = Self([152.0, 160.0, 172.0]);

    /// The colour of a face by its normal, the light coming from the left and above.
    pub(crate) fn shaded(self, normal: DVec3) -> String {
        let light = DVec3::new(-0.45, -0.55, 0.9).normalize().dot(normal.normalize());
        self.darkened(0.80 + 0.20 * light.max(-0.6))
    }

    /// The colour as it is.
    pub(crate) fn flat(self) -> String {
        self.darkened(1.0)
    }

    /// A darker one, for lines and words of the same role.
    pub(crate) fn deep(self) -> String {
        self.darkened(0.62)
    }

    fn darkened(self, factor: f64) -> String {
        let [red, green, blue] = self.0.map(|v| (v * factor).round().clamp(0.0, 255.0) as u8);
        format!("#{red:02x}{green:02x}{blue:02x}")
    }
}
