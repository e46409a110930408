//! Ambient occlusion in screen space: how much of the sky a cell misses because of the surfaces around it.

use glam::Vec3;

use super::surface::Surface;

/// How far away surfaces still take light, in model radii.
const RADIUS: f32 = 0.22;

/// Largest reach on the picture, as a part of its shorter side.
const MAX_REACH: f32 = 0.16;

/// Surfaces must rise by this cosine above the tangent plane to count: less is noise of the depths.
const MIN_COSINE: f32 = 0.06;

/// Weight of what is taken: more than 1, because most taps meet open sky even in a corner.
const GAIN: f32 = 2.1;

/// Steps outwards, each in a direction turned by the golden angle from the one before.
const STEPS: usize = 8;

/// Cosine and sine of the golden angle.
const GOLDEN_TURN: [f32; 2] = [-0.737_368_9, 0.675_490_3];

/// The part of the ambient light that a cell gets, 0 to 1.
///
/// `point` and `normal` are the cell's own, in view coordinates; `turn` is a unit vector that turns the pattern, `shift` moves it
/// outwards by a part of a step.
pub(crate) fn openness(
    surface: &Surface,
    [column, row]: [usize; 2],
    (point, normal): (Vec3, Vec3),
    (turn, shift): ([f32; 2], f32),
) -> f32 {
    let largest = MAX_REACH * surface.width.min(surface.height) as f32;
    let reach = (RADIUS * surface.lens.pixels_per_unit(point.z)).min(largest);
    let [mut cosine, mut sine] = turn;
    let mut taken = 0.0;
    for step in 0..STEPS {
        let part = (step as f32 + shift) / STEPS as f32;
        // Squared: nearby surfaces matter most.
        let distance = 1.0 + reach * part * part;
        let x = column as f32 + 0.5 + cosine * distance;
        let y = row as f32 + 0.5 + sine * distance;
        [cosine, sine] =
            [cosine * GOLDEN_TURN[0] - sine * GOLDEN_TURN[1], cosine * GOLDEN_TURN[1] + sine * GOLDEN_TURN[0]];
        taken += taken_by(surface, [x, y], point, normal);
    }
    1.0 - taken / STEPS as f32
}

/// What the surface at one place of the picture takes from `point`.
fn taken_by(surface: &Surface, [x, y]: [f32; 2], point: Vec3, normal: Vec3) -> f32 {
    if x < 0.0 || y < 0.0 {
        return 0.0;
    }
    let (column, row) = (x as i32 as usize, y as i32 as usize);
    if column >= surface.width || row >= surface.height {
        return 0.0;
    }
    // The depth belongs to the middle of the cell. Where nothing is, it is infinite, and the tests below fail.
    let towards = surface.point([column, row]) - point;
    let (square, rise) = (towards.length_squared(), towards.dot(normal));
    if !(rise > 0.0 && square < RADIUS * RADIUS) {
        return 0.0;
    }
    let cosine = rise / square.max(1e-12).sqrt();
    let fade = 1.0 - square * (1.0 / (RADIUS * RADIUS));
    (cosine - MIN_COSINE).max(0.0) * fade * GAIN
}
