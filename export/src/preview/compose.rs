//! The last step: samples, light and lines become pixels.

use glam::Vec3;
use rayon::prelude::*;

use super::edges::{InkBand, Line};
use super::light::Reaching;
use super::raster::{NO_FACE, Raster};
use super::scene::{Scene, Shade};
use super::style::Look;
use super::surface::{FLOOR, Surface};
use crate::color::linear_to_srgb;

/// Rows that are composed as one piece of work.
const BAND_ROWS: usize = 32;

/// Rows of samples beyond the band's own, which lines on its border are compared with.
const MARGIN: usize = 2;

/// Everything that a picture is made from.
pub(super) struct Layers<'a> {
    pub(super) scene: &'a Scene<'a>,
    /// Pixels across and down.
    pub(super) size: [usize; 2],
    /// Samples along a pixel.
    pub(super) factor: usize,
    pub(super) surface: &'a Surface,
    pub(super) light: &'a [Reaching],
    pub(super) lines: &'a [Line],
}

/// RGB bytes of a picture that shows the background alone.
pub(super) fn compose_background(look: &Look, [width, height]: [usize; 2]) -> Vec<u8> {
    let display = DisplayTable::new();
    let rows = (0..height).flat_map(|row| {
        let color = display.encode(background(look, row, height), row_rounding(row));
        std::iter::repeat_n(color, width)
    });
    rows.flatten().collect()
}

/// RGB bytes of the picture, row by row.
///
/// Samples live only while their band of rows is composed: those of the whole picture would not fit any cache.
pub(super) fn compose(layers: &Layers<'_>) -> Vec<u8> {
    let [width, height] = layers.size;
    let half_width = half_line_width(layers.scene.look.line_width, width.min(height));
    let lines = lines_by_band(layers.lines, half_width, height);
    let points: Vec<_> = layers.scene.screen.iter().map(|point| point.magnified(layers.factor as f32)).collect();
    let triangles = layers.scene.triangles([width * layers.factor, height * layers.factor], &points);
    let chosen = triangles.by_band(BAND_ROWS * layers.factor, MARGIN);
    let display = DisplayTable::new();
    let mut bytes = vec![0; 3 * width * height];
    let bands = bytes.par_chunks_mut(3 * width * BAND_ROWS).zip(lines.par_iter().zip(&chosen)).enumerate();
    bands.for_each_init(Raster::default, |samples, (band, (bytes, (lines, chosen)))| {
        let first_row = band * BAND_ROWS;
        let [first, end] = [first_row, first_row + bytes.len() / (3 * width)].map(|row| row * layers.factor);
        let rows = first.saturating_sub(MARGIN)..(end + MARGIN).min(triangles.size[1]);
        samples.draw_rows(triangles, rows, chosen);
        let mut ink = vec![0.0; bytes.len() / 3];
        let mut inked = InkBand { width, first_row, ink: &mut ink, half_width };
        for &line in lines {
            inked.draw(&layers.lines[line as usize], samples, layers.factor);
        }
        let band = Band { layers, samples };
        for (y, (bytes, ink)) in bytes.chunks_exact_mut(3 * width).zip(ink.chunks_exact(width)).enumerate() {
            band.compose_row(first_row + y, bytes, ink, &display);
        }
    });
    bytes
}

/// Half the width of lines in pixels, for a picture of this shorter side.
fn half_line_width(at_960: f32, side: usize) -> f32 {
    // Thinner lines than this would only look broken.
    (at_960 * side as f32 / 960.0).max(0.75) / 2.0
}

/// For each band the lines that may touch it, in their order.
fn lines_by_band(lines: &[Line], half_width: f32, height: usize) -> Vec<Vec<u32>> {
    let mut bands = vec![Vec::new(); height.div_ceil(BAND_ROWS)];
    for (index, line) in (0..).zip(lines) {
        let [first, last] = line.rows(half_width).map(|row| row.max(0.0) as usize / BAND_ROWS);
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
}

impl Band<'_> {
    fn compose_row(&self, row: usize, bytes: &mut [u8], ink: &[f32], display: &DisplayTable) {
        let look = &self.layers.scene.look;
        let (backdrop, rounding) = (background(look, row, self.layers.size[1]), row_rounding(row));
        for (column, (pixel, &ink)) in bytes.chunks_exact_mut(3).zip(ink).enumerate() {
            let color = self.color([column, row], backdrop);
            pixel.copy_from_slice(&display.encode(color.lerp(look.ink, ink), rounding));
        }
    }

    /// Linear colour of a pixel without lines: the mean of its samples.
    fn color(&self, at: [usize; 2], backdrop: Vec3) -> Vec3 {
        let (layers, factor) = (self.layers, self.layers.factor);
        let first = (at[1] * factor - self.samples.rows.start) * self.samples.width + at[0] * factor;
        let rows = (0..factor).map(|y| {
            let start = first + y * self.samples.width;
            &self.samples.faces[start..start + factor]
        });
        let one = self.samples.faces[first];
        if rows.clone().all(|row| row.iter().all(|&face| face == one)) {
            return match layers.scene.shades.get(one as usize) {
                Some(shade) => layers.lit(*shade, layers.light_at(at, one)),
                None => layers.shaded_floor(backdrop, layers.light_at(at, NO_FACE)),
            };
        }
        let (mut sum, mut empty, mut shown) = (Shade::default(), 0, one);
        for &face in rows.flatten() {
            match layers.scene.shades.get(face as usize) {
                Some(shade) => {
                    (sum.ambient, sum.direct) = (sum.ambient + shade.ambient, sum.direct + shade.direct);
                    shown = face;
                }
                None => empty += 1,
            }
        }
        let mut color = layers.lit(sum, layers.light_at(at, shown));
        if empty > 0 {
            color += layers.shaded_floor(backdrop, layers.light_at(at, NO_FACE)) * empty as f32;
        }
        color / (factor * factor) as f32
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

    /// The background, darkened where the model keeps light from the floor.
    fn shaded_floor(&self, backdrop: Vec3, light: Reaching) -> Vec3 {
        let missing = 0.6 * (1.0 - light.direct) + 0.9 * (1.0 - light.ambient);
        backdrop * (1.0 - self.scene.look.floor * missing.min(1.0))
    }
}

/// Linear background colour of a row.
fn background(look: &Look, row: usize, height: usize) -> Vec3 {
    look.background[0].lerp(look.background[1], (row as f32 + 0.5) / height as f32)
}

/// How a row rounds each channel, from 0 (down) to 1 (up).
///
/// Rows differ, so that the steps of a slow gradient leave no visible bands; within a row it is the same everywhere, so
/// that even colours stay even and compress well.
fn row_rounding(row: usize) -> [f32; 3] {
    // Multiples of the golden ratio, modulo one, spread evenly over any run of rows.
    [0, 1, 2].map(|channel| ((row * 3 + channel) as f32 * 0.618_034).fract())
}

/// Linear light to display bytes by table: the transfer function itself is too slow for every pixel.
struct DisplayTable(Vec<f32>);

impl DisplayTable {
    /// Number of the last entry: fine enough that two neighbouring ones differ by less than one byte value.
    const LAST: f32 = 16_383.0;

    fn new() -> Self {
        Self((0..=Self::LAST as u16).map(|step| linear_to_srgb(f32::from(step) / Self::LAST) * 255.0).collect())
    }

    /// Display bytes of a linear colour; `rounding` is added before fractions are dropped.
    fn encode(&self, color: Vec3, rounding: [f32; 3]) -> [u8; 3] {
        let entries = color.clamp(Vec3::ZERO, Vec3::ONE) * Self::LAST + 0.5;
        // Small enough for a signed conversion, which is the fast one.
        let byte = |entry: f32, rounding: f32| (self.0[entry as i32 as usize] + rounding) as i32 as u8;
        [byte(entries.x, rounding[0]), byte(entries.y, rounding[1]), byte(entries.z, rounding[2])]
    }
}
