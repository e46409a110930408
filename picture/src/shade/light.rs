//! The light that reaches each cell: shadow and occlusion, taken with few taps and then smoothed.

use glam::Vec3;
use planecut_parallel::prelude::*;

use super::occlusion::openness;
use super::shadow::ShadowMap;
use super::surface::{FLOOR, Surface};
use crate::raster::NO_FACE;
use crate::scene::Scene;

/// The patterns of taps repeat after this many cells each way; smoothing over as many evens them out.
const TILE: usize = 4;

/// Cells whose depths differ by more than this part do not smooth each other.
const DEPTH_TOLERANCE: f32 = 0.02;

/// Nor do those whose normals differ by more than this cosine.
const NORMAL_TOLERANCE: f32 = 0.95;

/// The parts of the ambient and of the direct light that reach a cell, 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Reaching {
    pub(crate) ambient: f32,
    pub(crate) direct: f32,
}

/// All the light there is.
pub(crate) const OPEN: Reaching = Reaching { ambient: 1.0, direct: 1.0 };

/// Light for each cell of the surface, row by row.
pub(crate) fn reaching_light(scene: &Scene<'_>, surface: &Surface) -> Vec<Reaching> {
    let shadows = ShadowMap::new(scene);
    let mut raw = vec![OPEN; surface.width * surface.height];
    let patterns = tap_patterns();
    raw.par_chunks_mut(surface.width).enumerate().for_each(|(row, cells)| {
        for (column, cell) in cells.iter_mut().enumerate() {
            if surface.faces[row * surface.width + column] != NO_FACE {
                let pattern = patterns[row % TILE * TILE + column % TILE];
                *cell = at_cell(scene, surface, &shadows, [column, row], pattern);
            }
        }
    });
    let across = smooth(scene, surface, &raw, 1);
    smooth(scene, surface, &across, surface.width)
}

/// Unit normal of a face or of the floor; cells without either have none.
fn normal_of(scene: &Scene<'_>, face: u32) -> Vec3 {
    match (face, scene.floor) {
        (FLOOR, Some(floor)) => floor.normal,
        _ => scene.normals.get(face as usize).copied().unwrap_or(Vec3::ZERO),
    }
}

fn at_cell(
    scene: &Scene<'_>,
    surface: &Surface,
    shadows: &ShadowMap,
    at: [usize; 2],
    (turn, shift): Pattern,
) -> Reaching {
    let index = at[1] * surface.width + at[0];
    let face = surface.faces[index];
    let point = surface.point(at);
    let normal = normal_of(scene, face);
    let ambient = openness(surface, at, (point, normal), (turn, shift));
    let faces_light = normal.dot(scene.light) > 0.0;
    let direct = if faces_light { shadows.lit(point, normal, turn) } else { 1.0 };
    match scene.floor {
        Some(floor) if face == FLOOR => {
            let fade = floor.fade(point);
            Reaching { ambient: 1.0 - fade * (1.0 - ambient), direct: 1.0 - fade * (1.0 - direct) }
        }
        _ => Reaching { ambient, direct },
    }
}

/// How the taps of a cell are turned, as cosine and sine, and shifted outwards, as a part of a step.
type Pattern = ([f32; 2], f32);

/// A pattern of its own for each cell of a tile.
fn tap_patterns() -> [Pattern; TILE * TILE] {
    // Neighbours get numbers far apart.
    const ORDER: [u8; TILE * TILE] = [0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5];
    ORDER.map(|number| {
        let part = f32::from(number) / (TILE * TILE) as f32;
        let (sine, cosine) = libm::sincosf(part * std::f32::consts::TAU);
        ([cosine, sine], part)
    })
}

/// A running mean over `TILE` cells along one direction, `stride` places apart, within the same surface.
fn smooth(scene: &Scene<'_>, surface: &Surface, light: &[Reaching], stride: usize) -> Vec<Reaching> {
    let mut result = vec![OPEN; light.len()];
    result.par_chunks_mut(surface.width).enumerate().for_each(|(row, cells)| {
        for (column, cell) in cells.iter_mut().enumerate() {
            let center = row * surface.width + column;
            if surface.faces[center] == NO_FACE {
                continue;
            }
            let (position, length) = if stride == 1 { (column, surface.width) } else { (row, surface.height) };
            let (mut sum, mut weight) = ([0.0; 2], 0.0);
            for place in position.saturating_sub(TILE / 2)..(position + TILE / 2 + 1).min(length) {
                let other = center - position * stride + place * stride;
                if belongs(scene, surface, center, other) {
                    // Half weight at the ends, so that the width is that of a tile.
                    let part = if place.abs_diff(position) == TILE / 2 { 0.5 } else { 1.0 };
                    sum = [sum[0] + part * light[other].ambient, sum[1] + part * light[other].direct];
                    weight += part;
                }
            }
            // The cell itself always counts.
            *cell = Reaching { ambient: sum[0] / weight, direct: sum[1] / weight };
        }
    });
    result
}

/// Whether two nearby cells show the same or a smoothly continuing surface.
fn belongs(scene: &Scene<'_>, surface: &Surface, a: usize, b: usize) -> bool {
    let (face_a, face_b) = (surface.faces[a], surface.faces[b]);
    if face_a == face_b {
        return true;
    }
    let (depth_a, depth_b) = (surface.depth[a], surface.depth[b]);
    (depth_a - depth_b).abs() < DEPTH_TOLERANCE * depth_a
        && normal_of(scene, face_a).dot(normal_of(scene, face_b)) > NORMAL_TOLERANCE
}
