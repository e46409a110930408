//! Edges worth drawing, and their antialiased lines with hidden parts left out.

use planecut_csg::Mesh;
use rayon::prelude::*;

use super::camera::ScreenPoint;
use super::raster::{Raster, is_front};
use super::scene::Scene;

/// Faces that meet at less than this cosine's angle (one degree) look like one.
const SMOOTH_COSINE: f64 = 0.999_847_7;

/// Cosine of the angle (40 degrees) from which on creases are drawn at full strength.
const SHARP_COSINE: f64 = 0.766;

/// Strength of the faintest crease, relative to a sharp one.
const FAINT: f32 = 0.3;

/// A surface hides an edge only when nearer by more than this part.
const DEPTH_TOLERANCE: f32 = 2e-4;

/// A line on the picture.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    pub(super) ends: [ScreenPoint; 2],
    /// Faces on both sides; the same twice at the rim of an open mesh.
    faces: [u32; 2],
    /// 0 to 1.
    opacity: f32,
}

/// The visible creases, outlines and rims of the scene's mesh.
pub(super) fn feature_lines(scene: &Scene<'_>) -> Vec<Line> {
    let fronts: Vec<bool> = scene
        .mesh
        .triangles
        .iter()
        .map(|triangle| is_front(triangle.map(|corner| scene.screen[corner as usize])))
        .collect();
    let halves = sorted_half_edges(scene.mesh, &fronts);
    let around_edges = halves.chunk_by(|a, b| a.edge == b.edge);
    around_edges.filter_map(|around| line_along(scene, around)).collect()
}

/// One triangle's side.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct HalfEdge {
    /// The two vertices, the smaller number in the upper half.
    edge: u64,
    face: u32,
    front: bool,
}

/// Sides that belong to one edge follow one another; within an edge the order is that of the faces.
fn sorted_half_edges(mesh: &Mesh, fronts: &[bool]) -> Vec<HalfEdge> {
    let mut halves = Vec::with_capacity(3 * mesh.triangles.len());
    for ((&[a, b, c], &face), &front) in mesh.triangles.iter().zip(&mesh.triangle_faces).zip(fronts) {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let edge = u64::from(from.min(to)) << 32 | u64::from(from.max(to));
            halves.push(HalfEdge { edge, face, front });
        }
    }
    halves.par_sort_unstable();
    halves
}

fn line_along(scene: &Scene<'_>, around: &[HalfEdge]) -> Option<Line> {
    let look = &scene.look;
    let (first, last) = (around.first()?, around.last()?);
    let fronts = around.iter().filter(|half| half.front).count();
    if fronts == 0 {
        return None;
    }
    let is_outline = fronts < around.len() || around.len() == 1;
    let cosine = scene.mesh.faces[first.face as usize].normal.dot(scene.mesh.faces[last.face as usize].normal);
    let opacity = if is_outline {
        look.outline
    } else if cosine > SMOOTH_COSINE {
        return None;
    } else {
        let part = ((SMOOTH_COSINE - cosine) / (SMOOTH_COSINE - SHARP_COSINE)).min(1.0) as f32;
        look.crease * (FAINT + (1.0 - FAINT) * part)
    };
    let ends = [first.edge >> 32, first.edge & 0xffff_ffff].map(|vertex| scene.screen[vertex as usize]);
    Some(Line { ends, faces: [first.face, last.face], opacity })
}

impl Line {
    /// Lowest and highest row that a line of this half width can touch.
    pub(super) fn rows(&self, half_width: f32) -> [f32; 2] {
        let [a, b] = self.ends.map(|end| end.y);
        [a.min(b) - half_width - 1.0, a.max(b) + half_width + 1.0]
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

/// A few rows of the picture, with the opacity of the ink on each pixel.
pub(super) struct InkBand<'a> {
    pub(super) width: usize,
    pub(super) first_row: usize,
    /// As many as pixels in the band.
    pub(super) ink: &'a mut [f32],
    pub(super) half_width: f32,
}

impl InkBand<'_> {
    /// Draws the part of a line that is in the band and not hidden. `factor` is the number of samples along a pixel.
    pub(super) fn draw(&mut self, line: &Line, samples: &Raster, factor: usize) {
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
        for step in low..high {
            let pixel = step as f32;
            // Part of this step that the line covers: less than all at its ends.
            let covered = (end.min(pixel + 1.0) - start.max(pixel)).max(0.0);
            let part_at = |t: f32| if length == 0.0 { 0.5 } else { ((t - along(a)) / length).clamp(0.0, 1.0) };
            let visible = [0.25, 0.75].map(|offset| {
                let clipped = (pixel + offset).clamp(start, end);
                u8::from(line.is_visible(samples, factor as f32, line.at(part_at(clipped))))
            });
            let strength = line.opacity * covered * f32::from(visible[0] + visible[1]) / 2.0;
            if strength > 0.0 {
                let middle = line.at(part_at(pixel + 0.5));
                let across = if steep { middle.x } else { middle.y };
                self.stroke(steep, step, across, narrowing, strength);
            }
        }
    }

    /// The steps along the line that can touch the band.
    fn steps(&self, steep: bool, slope: f32, line: &Line, [start, end]: [f32; 2]) -> [usize; 2] {
        let rows = [self.first_row as f32, (self.first_row + self.ink.len() / self.width) as f32];
        let [mut low, mut high] = [start, end];
        if steep {
            (low, high) = (low.max(rows[0]), high.min(rows[1]));
        } else if slope != 0.0 {
            let reach = self.half_width * 2.0 + 2.0;
            let from_row = |row: f32| line.ends[0].x + (row - line.ends[0].y) / slope;
            let [a, b] = [from_row(rows[0] - reach), from_row(rows[1] + reach)];
            (low, high) = (low.max(a.min(b) - 1.0), high.min(a.max(b) + 1.0));
        }
        let limit = if steep { rows[1] } else { self.width as f32 };
        [low.floor().clamp(0.0, limit) as usize, high.ceil().clamp(0.0, limit) as usize]
    }

    /// Inks the pixels across the line at one step.
    fn stroke(&mut self, steep: bool, step: usize, across: f32, narrowing: f32, strength: f32) {
        let reach = (self.half_width + 0.5) / narrowing;
        let first = (across - reach - 0.5).ceil().max(0.0) as usize;
        let last = (across + reach - 0.5).floor();
        if last < 0.0 {
            return;
        }
        for place in first..=last as usize {
            let (column, row) = if steep { (place, step) } else { (step, place) };
            if column >= self.width || row < self.first_row {
                continue;
            }
            let Some(ink) = self.ink.get_mut((row - self.first_row) * self.width + column) else { continue };
            let distance = (place as f32 + 0.5 - across).abs() * narrowing;
            let coverage = (self.half_width + 0.5 - distance).clamp(0.0, 1.0);
            // The larger one of two lines, not both: joints would be darker.
            *ink = ink.max(coverage * strength);
        }
    }
}
