//! From linear light to the bytes of a picture.

use glam::{Vec3, Vec4};

use crate::color::linear_to_srgb;

/// How a row rounds each channel, from 0 (down) to 1 (up).
///
/// Rows differ, so that the steps of a slow gradient leave no visible bands; within a row it is the same everywhere, so
/// that even colours stay even and compress well.
pub(crate) fn row_rounding(row: usize) -> [f32; 3] {
    // Multiples of the golden ratio, modulo one, spread evenly over any run of rows.
    [0, 1, 2].map(|channel| ((row * 3 + channel) as f32 * 0.618_034).fract())
}

/// Linear light to display bytes by table: the transfer function itself is too slow for every pixel.
pub(crate) struct DisplayTable(Vec<f32>);

impl DisplayTable {
    /// Number of the last entry: fine enough that two neighbouring ones differ by less than one byte value.
    const LAST: f32 = 16_383.0;

    pub(crate) fn new() -> Self {
        Self((0..=Self::LAST as u16).map(|step| linear_to_srgb(f32::from(step) / Self::LAST) * 255.0).collect())
    }

    /// Display bytes of a linear colour that is multiplied by its alpha; `rounding` is added before fractions are dropped.
    pub(crate) fn encode(&self, color: Vec4, rounding: [f32; 3]) -> [u8; 4] {
        let alpha = color.w;
        if alpha >= 1.0 {
            let [red, green, blue] = self.encode_opaque(color.truncate(), rounding);
            return [red, green, blue, 255];
        }
        let byte = (alpha * 255.0 + 0.5) as i32 as u8;
        if byte == 0 {
            return [0; 4];
        }
        let [red, green, blue] = self.encode_opaque(color.truncate() / alpha, rounding);
        [red, green, blue, byte]
    }

    fn encode_opaque(&self, color: Vec3, rounding: [f32; 3]) -> [u8; 3] {
        let entries = color.clamp(Vec3::ZERO, Vec3::ONE) * Self::LAST + 0.5;
        // Small enough for a signed conversion, which is the fast one.
        let byte = |entry: f32, rounding: f32| (self.0[entry as i32 as usize] + rounding) as i32 as u8;
        [byte(entries.x, rounding[0]), byte(entries.y, rounding[1]), byte(entries.z, rounding[2])]
    }
}
