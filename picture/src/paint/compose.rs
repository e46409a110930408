//! The last step: samples, light and lines become pixels.

use glam::{Vec3, Vec4};
use planecut_parallel::prelude::*;

use super::display::{DisplayTable, row_rounding};
use super::hatch::Hatching;
use super::veil::{Veil, VeilFaces};
use crate::lines::edges::Line;
use crate::lines::ink::{DashLengths, InkBand};
use crate::raster::{NO_FACE, Raster, Sides};
use crate::scene::look::{Fill, Look};
use crate::scene::{Scene, Shade};
use crate::shade::light::Reaching;
use crate::shade::surface::{FLOOR, Surface};

/// Rows that are composed as one piece of work.
const BAND_ROWS: usize = 32;

/// Rows of samples beyond the band's own, which lines on its border are compared with.
const MARGIN: usize = 2;

/// Opacity of hatching.
const HATCH_OPACITY: f32 = 0.6;

/// Everything that a picture is made from.
pub(crate) struct Layers<'a> {
    pub(crate) scene: &'a Scene<'a>,
    /// Pixels across and down.
    pub(crate) size: [usize; 2],
    /// How large the picture is, compared with the one that widths of lines are stated for.
    pub(crate) scale: f32,
    /// Samples along a pixel.
    pub(crate) factor: usize,
    pub(crate) surface: &'a Surface,
    pub(crate) light: &'a [Reaching],
    pub(crate) lines: &'a [Line],
}

/// RGBA bytes of a picture that shows the background alone.
pub(crate) fn compose_background(look: &Look, [width, height]: [usize; 2]) -> Vec<u8> {
    let display = DisplayTable::new();
    let rows = (0..height).flat_map(|row| {
        let color = display.encode(background(look, row, height), row_rounding(row));
        std::iter::repeat_n(color, width)
    });
    rows.flatten().collect()
}

/// RGBA bytes of the picture, row by row.
///
/// Samples live only while their band of rows is composed: those of the whole picture would not fit any cache.
pub(crate) fn compose(layers: &Layers<'_>) -> Vec<u8> {
    let ([width, height], factor, scene) = (layers.size, layers.factor, layers.scene);
    let lines = lines_by_band(layers.lines, height);
    let points: Vec<_> = scene.screen.iter().map(|point| point.magnified(factor as f32)).collect();
    let triangles = scene.triangles([width * factor, height * factor], &points);
    let chosen = triangles.by_band(BAND_ROWS * factor, MARGIN, Sides::Front);
    let veiled = (scene.look.fill == Fill::Translucent)
        .then(|| (VeilFaces::new(scene, layers.surface), triangles.by_band(BAND_ROWS * factor, 0, Sides::Both)));
    let display = DisplayTable::new();
    let dashes = DashLengths { dash: (9.0 * layers.scale).max(3.0), gap: (6.0 * layers.scale).max(2.5) };
    let mut bytes = vec![0; 4 * width * height];
    let bands = bytes.par_chunks_mut(4 * width * BAND_ROWS).zip(lines.par_iter().zip(&chosen)).enumerate();
    bands.for_each_init(<(Raster, Veil)>::default, |(samples, veil), (number, (bytes, (lines, chosen)))| {
        let first_row = number * BAND_ROWS;
        let [first, end] = [first_row, first_row + bytes.len() / (4 * width)].map(|row| row * factor);
        let rows = first.saturating_sub(MARGIN)..(end + MARGIN).min(triangles.size[1]);
        samples.draw_rows(triangles, rows, chosen);
        if let Some((faces, chosen)) = &veiled {
            veil.draw_rows(triangles, first..end, &chosen[number], faces);
        }
        let mut ink = vec![0.0; bytes.len() / 4];
        let mut inked = InkBand { width, first_row, ink: &mut ink, dashes };
        for &line in lines {
            inked.draw(&layers.lines[line as usize], samples, factor);
        }
        let band = Band { layers, samples, veil, hatching: Hatching::new(layers.scale) };
        for (y, (bytes, ink)) in bytes.chunks_exact_mut(4 * width).zip(ink.chunks_exact(width)).enumerate() {
            band.compose_row(first_row + y, bytes, ink, &display);
        }
    });
    bytes
}

/// For each band the lines that may touch it, in their order.
fn lines_by_band(lines: &[Line], height: usize) -> Vec<Vec<u32>> {
    let mut bands = vec![Vec::new(); height.div_ceil(BAND_ROWS)];
    for (index, line) in (0..).zip(lines) {
        let [first, last] = line.rows().map(|row| row.max(0.0) as usize / BAND_ROWS);
        let last = last.min(bands.len() - 1);
        for band in bands.iter_mut().take(last + 1).skip(first) {
            band.push(index);
        }
    }
    bands
}

/// A band of the picture with its samples.
struct Band<'a> {
    layers: &'a Layers<'a>,
    samples: &'a Raster,
    veil: &'a Veil,
    hatching: Hatching,
}

impl Band<'_> {
    fn compose_row(&self, row: usize, bytes: &mut [u8], ink: &[f32], display: &DisplayTable) {
        let look = &self.layers.scene.look;
        let (backdrop, rounding) = (background(look, row, self.layers.size[1]), row_rounding(row));
        let black = look.lines.ink.extend(1.0);
        for (column, (pixel, &ink)) in bytes.chunks_exact_mut(4).zip(ink).enumerate() {
            let (color, hatched) = match look.fill {
                Fill::Opaque => self.color([column, row], backdrop),
                Fill::Nothing => (backdrop, 0.0),
                Fill::Translucent => {
                    let seen = self.veil.pixel([column, row], self.layers.factor);
                    (seen + backdrop * (1.0 - seen.w), 0.0)
                }
            };
            let ink = if hatched > ink { hatched } else { ink };
            pixel.copy_from_slice(&display.encode(color.lerp(black, ink), rounding));
        }
    }

    /// Colour of a pixel without lines: the mean of its samples, linear and multiplied by its alpha. And the opacity of its hatching.
    fn color(&self, at: [usize; 2], backdrop: Vec4) -> (Vec4, f32) {
        let (layers, factor) = (self.layers, self.layers.factor);
        let first = (at[1] * factor - self.samples.rows.start) * self.samples.width + at[0] * factor;
        let rows = (0..factor).map(|y| {
            let start = first + y * self.samples.width;
            &self.samples.faces[start..start + factor]
        });
        let one = self.samples.faces[first];
        if rows.clone().all(|row| row.iter().all(|&face| face == one)) {
            return match layers.scene.shades.get(one as usize) {
                Some(shade) => (layers.lit(*shade, layers.light_at(at, one)).extend(1.0), self.hatch(at, one)),
                None => (layers.shaded_floor(backdrop, layers.light_at(at, NO_FACE)), 0.0),
            };
        }
        let (mut sum, mut empty, mut shown, mut hatched) = (Shade::default(), 0, one, 0.0);
        for &face in rows.flatten() {
            match layers.scene.shades.get(face as usize) {
                Some(shade) => {
                    (sum.ambient, sum.direct) = (sum.ambient + shade.ambient, sum.direct + shade.direct);
                    shown = face;
                    hatched += self.hatch(at, face);
                }
                None => empty += 1,
            }
        }
        let samples = factor * factor;
        let mut color = layers.lit(sum, layers.light_at(at, shown)).extend((samples - empty) as f32);
        if empty > 0 {
            color += layers.shaded_floor(backdrop, layers.light_at(at, NO_FACE)) * empty as f32;
        }
        (color / samples as f32, hatched / samples as f32)
    }

    fn hatch(&self, at: [usize; 2], face: u32) -> f32 {
        let hatch = self.layers.scene.hatch(face);
        hatch.map_or(0.0, |number| HATCH_OPACITY * self.hatching.coverage(at, number))
    }
}

impl Layers<'_> {
    /// The light at a pixel of a face (or of the backdrop, for [`NO_FACE`]), from the cells around it that show the same.
    fn light_at(&self, at: [usize; 2], face: u32) -> Reaching {
        /// Weight of other cells: counts only when there is none of the same face.
        const FOREIGN: f32 = 1e-4;
        let surface = self.surface;
        let corner = at.map(|index| (index as i32 as f32 + 0.5) * (1.0 / surface.cell as f32) - 0.5);
        let (x, y) = (corner[0].max(0.0), corner[1].max(0.0));
        // Signed conversions are the fast ones.
        let (column, row) = (x as i32, y as i32);
        let (right, below) = (x - column as f32, y - row as f32);
        let (column, row) = (column as usize, row as usize);
        let (mut ambient, mut direct, mut weight) = (0.0, 0.0, 0.0);
        for (row, down) in [(row, 1.0 - below), (row + 1, below)] {
            for (column, across) in [(column, 1.0 - right), (column + 1, right)] {
                let index = row.min(surface.height - 1) * surface.width + column.min(surface.width - 1);
                let shown = surface.faces[index];
                let same = shown == face || (face == NO_FACE && shown == FLOOR);
                let part = down * across * if same { 1.0 } else { FOREIGN };
                let light = self.light[index];
                (ambient, direct) = (ambient + part * light.ambient, direct + part * light.direct);
                weight += part;
            }
        }
        let scale = 1.0 / weight;
        Reaching { ambient: ambient * scale, direct: direct * scale }
    }

    fn lit(&self, shade: Shade, light: Reaching) -> Vec3 {
        let open = 1.0 - self.scene.look.occlusion * (1.0 - light.ambient);
        shade.ambient * open + shade.direct * light.direct
    }

    /// The background, darkened where the model keeps light from the floor. What is transparent gets black there.
    fn shaded_floor(&self, backdrop: Vec4, light: Reaching) -> Vec4 {
        let missing = 0.6 * (1.0 - light.direct) + 0.9 * (1.0 - light.ambient);
        let dark = self.scene.look.floor * missing.min(1.0);
        backdrop * (1.0 - dark) + Vec4::W * dark
    }
}

/// Linear background colour of a row, multiplied by its alpha.
fn background(look: &Look, row: usize, height: usize) -> Vec4 {
    match look.background {
        Some([top, bottom]) => top.lerp(bottom, (row as f32 + 0.5) / height as f32).extend(1.0),
        None => Vec4::ZERO,
    }
}
