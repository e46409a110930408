//! Antialiased lines, their hidden parts left out, faint or dashed.

use super::edges::Line;
use crate::raster::Raster;
use crate::view::lens::ScreenPoint;

/// A surface hides an edge only when nearer by more than this part.
const DEPTH_TOLERANCE: f32 = 2e-4;

/// Pixels that lines go on beyond their ends: where one ends and the next begins within a pixel, neither would cover it.
const REACH: f32 = 0.5;

impl Line {
    /// Lowest and highest row that the line can touch.
    pub(crate) fn rows(&self) -> [f32; 2] {
        let [a, b] = self.ends.map(|end| end.y);
        [a.min(b) - self.half_width - 1.0, a.max(b) + self.half_width + 1.0]
    }

    /// Whether the surface seen at a point of the line, or right beside it, is one of the line's own faces or lies
    /// behind it.
    fn is_visible(&self, samples: &Raster, factor: f32, at: ScreenPoint) -> bool {
        let behind = at.w * (1.0 - DEPTH_TOLERANCE);
        let around = samples.around(at.x * factor, at.y * factor);
        around.into_iter().any(|(nearness, face)| self.faces.contains(&face) || nearness < behind)
    }

    fn at(&self, part: f32) -> ScreenPoint {
        let [a, b] = self.ends;
        ScreenPoint { x: a.x + (b.x - a.x) * part, y: a.y + (b.y - a.y) * part, w: a.w + (b.w - a.w) * part }
    }
}

/// Lengths of dashes and of the gaps between them, in pixels.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DashLengths {
    pub(crate) dash: f32,
    pub(crate) gap: f32,
}

impl DashLengths {
    /// The part of a pixel that a dash covers, at a distance from the beginning of the dashes.
    fn coverage(self, distance: f32) -> f32 {
        let within = distance.rem_euclid(self.dash + self.gap);
        let half = self.dash / 2.0;
        (half + 0.5 - (within - half).abs()).clamp(0.0, 1.0)
    }
}

/// A few rows of the picture, with the opacity of the ink on each pixel.
pub(crate) struct InkBand<'a> {
    pub(crate) width: usize,
    pub(crate) first_row: usize,
    /// As many as pixels in the band.
    pub(crate) ink: &'a mut [f32],
    pub(crate) dashes: DashLengths,
}

/// The part of a line within one step along it.
struct Step {
    /// Number of the column, of steep lines of the row.
    place: usize,
    /// Where the line is across.
    across: f32,
    opacity: f32,
}

impl InkBand<'_> {
    /// Draws the part of a line that is in the band. `factor` is the number of samples along a pixel.
    pub(crate) fn draw(&mut self, line: &Line, samples: &Raster, factor: usize) {
        let [a, b] = line.ends;
        let (dx, dy) = (b.x - a.x, b.y - a.y);
        let steep = dy.abs() > dx.abs();
        // Along: the axis that the line mostly follows. Across: the other.
        let along = |p: ScreenPoint| if steep { p.y } else { p.x };
        let (start, end) = (along(a).min(along(b)), along(a).max(along(b)));
        let length = if steep { dy } else { dx };
        let slope = if length == 0.0 { 0.0 } else { (if steep { dx } else { dy }) / length };
        let narrowing = 1.0 / (1.0 + slope * slope).sqrt();
        let [low, high] = self.steps(steep, slope, line, [start, end]);
        for place in low..high {
            let pixel = place as f32;
            // Part of this step that the line covers: less than all at its ends.
            let covered = ((end + REACH).min(pixel + 1.0) - (start - REACH).max(pixel)).clamp(0.0, 1.0);
            let part_at = |t: f32| if length == 0.0 { 0.5 } else { ((t - along(a)) / length).clamp(0.0, 1.0) };
            let visible = [0.25, 0.75].map(|offset| {
                let clipped = (pixel + offset).clamp(start, end);
                u8::from(line.is_visible(samples, factor as f32, line.at(part_at(clipped))))
            });
            let visible = f32::from(visible[0] + visible[1]) / 2.0;
            let part = part_at(pixel + 0.5);
            let mut hidden = line.hidden * (1.0 - visible);
            if let Some(run) = line.dashes
                && hidden > 0.0
            {
                hidden *= self.dashes.coverage(run.at(part * length.abs() / narrowing));
            }
            let opacity = (line.opacity * visible + hidden) * covered;
            if opacity > 0.0 {
                let middle = line.at(part);
                let across = if steep { middle.x } else { middle.y };
                self.stroke(steep, &Step { place, across, opacity }, narrowing, line.half_width);
            }
        }
    }

    /// The steps along the line that can touch the band.
    fn steps(&self, steep: bool, slope: f32, line: &Line, [start, end]: [f32; 2]) -> [usize; 2] {
        let rows = [self.first_row as f32, (self.first_row + self.ink.len() / self.width) as f32];
        let [mut low, mut high] = [start - REACH, end + REACH];
        if steep {
            (low, high) = (low.max(rows[0]), high.min(rows[1]));
        } else if slope != 0.0 {
            let reach = line.half_width * 2.0 + 2.0;
            let from_row = |row: f32| line.ends[0].x + (row - line.ends[0].y) / slope;
            let [a, b] = [from_row(rows[0] - reach), from_row(rows[1] + reach)];
            (low, high) = (low.max(a.min(b) - 1.0), high.min(a.max(b) + 1.0));
        }
        let limit = if steep { rows[1] } else { self.width as f32 };
        [low.floor().clamp(0.0, limit) as usize, high.ceil().clamp(0.0, limit) as usize]
    }

    /// Inks the pixels across the line at one step.
    fn stroke(&mut self, steep: bool, step: &Step, narrowing: f32, half_width: f32) {
        let across = step.across;
        let reach = (half_width + 0.5) / narrowing;
        let first = (across - reach - 0.5).ceil().max(0.0) as usize;
        let last = (across + reach - 0.5).floor();
        if last < 0.0 {
            return;
        }
        for place in first..=last as usize {
            let (column, row) = if steep { (place, step.place) } else { (step.place, place) };
            if column >= self.width || row < self.first_row {
                continue;
            }
            let Some(ink) = self.ink.get_mut((row - self.first_row) * self.width + column) else { continue };
            let distance = (place as f32 + 0.5 - across).abs() * narrowing;
            let coverage = (half_width + 0.5 - distance).clamp(0.0, 1.0);
            // The larger one of two lines, not both: joints would be darker.
            *ink = ink.max(coverage * step.opacity);
        }
    }
}
