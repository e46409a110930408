//! Hatching of cut faces, as in drawings (ISO 128-50): parallel fine lines, in another direction for each material.

use std::f32::consts::FRAC_1_SQRT_2;

/// Distance between the lines and their width in a picture whose shorter side is 960 pixels, in pixels.
const SPACING: f32 = 12.0;
const WIDTH: f32 = 1.1;

/// Unit normals of the lines: 45 degrees one way and the other, then steeper and flatter ones.
const NORMALS: [[f32; 2]; 6] = [
    [FRAC_1_SQRT_2, FRAC_1_SQRT_2],
    [FRAC_1_SQRT_2, -FRAC_1_SQRT_2],
    [0.5, 0.866_025],
    [0.5, -0.866_025],
    [0.866_025, 0.5],
    [0.866_025, -0.5],
];

/// Hatching of a picture.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Hatching {
    spacing: f32,
    half_width: f32,
}

impl Hatching {
    /// For a picture that is `scale` times as large as the one that lengths are stated for.
    pub(crate) fn new(scale: f32) -> Self {
        Self { spacing: (SPACING * scale).max(4.0), half_width: (WIDTH * scale).max(0.8) / 2.0 }
    }

    /// The part of a pixel that lines cover, for a hatching of this number.
    pub(crate) fn coverage(self, [column, row]: [usize; 2], number: u32) -> f32 {
        let [a, b] = NORMALS[number as usize % NORMALS.len()];
        // Materials beyond the number of directions have lines farther apart, as far as that helps.
        let spacing = self.spacing * (1.0 + 0.35 * (number as usize / NORMALS.len() % 3) as f32);
        let along = (column as f32 + 0.5) * a + (row as f32 + 0.5) * b;
        let distance = (along.rem_euclid(spacing) - spacing / 2.0).abs();
        (self.half_width + 0.5 - distance).clamp(0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lines cover as much as their width and distance say, in every direction.
    #[test]
    fn lines_cover_their_share() {
        for scale in [0.5, 1.0, 2.0] {
            let hatching = Hatching::new(scale);
            for number in 0..NORMALS.len() as u32 {
                let sum: f32 = (0..400 * 400).map(|i| hatching.coverage([i % 400, i / 400], number)).sum();
                let share = sum / 160_000.0;
                let expected = 2.0 * hatching.half_width / hatching.spacing;
                assert!((share - expected).abs() < 0.15 * expected, "{scale} {number}: {share}, {expected}");
            }
        }
    }
}
