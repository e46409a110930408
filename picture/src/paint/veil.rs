//! Surfaces that are seen through: weighted sums that need no order (McGuire and Bavoil, Weighted Blended Order-Independent
//! Transparency, JCGT 2013), added up in the order of the mesh, so that the same mesh gives the same bytes.

use std::ops::Range;

use glam::{Vec3, Vec4};

use crate::raster::{Triangles, each_span, signed_area};
use crate::scene::{Scene, Shade};
use crate::shade::surface::Surface;

/// The light that is to come through all surfaces where the model has as many of them as on the mean.
const MEAN_LIGHT: f32 = 0.16;

/// Bounds of the opacity of a surface that is seen at a right angle.
const OPACITY: [f32; 2] = [0.012, 0.42];

/// How much more opaque a surface is that is seen along itself, as glass is.
const GRAZING: f32 = 1.6;

/// Weight of the farthest surface, relative to the nearest.
const FAR_WEIGHT: f32 = 0.06;

/// What each face adds to the picture.
pub(crate) struct VeilFaces {
    /// Linear RGB and opacity.
    layers: Vec<Vec4>,
    /// The nearness of the farthest vertex, and the reciprocal of what is between it and the nearest one.
    far: f32,
    per_range: f32,
}

impl VeilFaces {
    pub(crate) fn new(scene: &Scene<'_>, surface: &Surface) -> Self {
        let points = |corners: &[u32; 3]| corners.map(|corner| scene.screen[corner as usize]);
        let area = |corners: &[u32; 3]| {
            let [a, b, c] = points(corners);
            (signed_area(a, b, c).abs() / 2.0) as f32
        };
        let drawn: f32 = scene.mesh.triangles.iter().map(area).sum();
        let shown = surface.faces.iter().filter(|&&face| (face as usize) < scene.shades.len()).count();
        let covered = (shown * surface.cell * surface.cell).max(1) as f32;
        let surfaces = (drawn / covered).max(1.0);
        let opacity = (1.0 - libm::powf(MEAN_LIGHT, 1.0 / surfaces)).clamp(OPACITY[0], OPACITY[1]);
        let nearness = scene.screen.iter().map(|point| point.w);
        let (far, near) = nearness.fold((f32::INFINITY, 0.0_f32), |(low, high), w| (low.min(w), high.max(w)));
        let layer = |(shade, normal): (&Shade, &Vec3)| {
            let grazing = 1.0 - normal.z.abs();
            let opacity = (opacity * (1.0 + GRAZING * grazing * grazing)).min(0.9);
            (shade.ambient + shade.direct).min(Vec3::ONE).extend(opacity)
        };
        let layers = scene.shades.iter().zip(&scene.normals).map(layer).collect();
        Self { layers, far, per_range: 1.0 / (near - far).max(f32::MIN_POSITIVE) }
    }

    fn weight(&self, nearness: f32) -> f32 {
        let part = ((nearness - self.far) * self.per_range).clamp(0.0, 1.0);
        FAR_WEIGHT + (1.0 - FAR_WEIGHT) * part * part
    }
}

/// Some rows of samples with all that is on them.
#[derive(Default)]
pub(crate) struct Veil {
    width: usize,
    rows: Range<usize>,
    /// Sums of colours and of weights.
    sums: Vec<Vec4>,
    /// The light that comes through.
    through: Vec<f32>,
}

impl Veil {
    /// Draws the chosen triangles, whichever side they show. What was held before is dropped, only the memory is used again.
    pub(crate) fn draw_rows(
        &mut self,
        triangles: Triangles<'_>,
        rows: Range<usize>,
        chosen: &[u32],
        faces: &VeilFaces,
    ) {
        self.width = triangles.size[0];
        let samples = self.width * rows.len();
        self.rows = rows;
        self.sums.clear();
        self.sums.resize(samples, Vec4::ZERO);
        self.through.clear();
        self.through.resize(samples, 1.0);
        for &triangle in chosen {
            let layer = faces.layers[triangles.faces[triangle as usize] as usize];
            let (opacity, color) = (layer.w, layer.truncate().extend(1.0));
            each_span(triangles.points_of(triangle), self.rows.clone(), self.width, |row, columns, (first, step)| {
                let start = (row - self.rows.start) * self.width;
                let span = start + columns.start..start + columns.end;
                for (i, (sum, through)) in self.sums[span.clone()].iter_mut().zip(&mut self.through[span]).enumerate() {
                    let weight = opacity * faces.weight(first + step * (i as i32 as f32));
                    *sum += color * weight;
                    *through *= 1.0 - opacity;
                }
            });
        }
    }

    /// The mean of the samples of a pixel, as a linear colour that is multiplied by its alpha.
    pub(crate) fn pixel(&self, [column, row]: [usize; 2], factor: usize) -> Vec4 {
        let mut mean = Vec4::ZERO;
        for y in row * factor..(row + 1) * factor {
            let start = (y - self.rows.start) * self.width + column * factor;
            for index in start..start + factor {
                let (sum, alpha) = (self.sums[index], 1.0 - self.through[index]);
                if sum.w > 0.0 {
                    mean += (sum.truncate() / sum.w * alpha).extend(alpha);
                }
            }
        }
        mean / (factor * factor) as f32
    }
}
