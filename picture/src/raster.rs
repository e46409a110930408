//! A z-buffer: which face is nearest at each sample of a picture.
//!
//! Triangles that share an edge neither leave a gap along it nor overlap: both compute where it crosses a row from the
//! same end points in the same order. A picture is drawn in bands of rows, each with its triangles in the order of the
//! mesh, so the result does not depend on the number of threads.

use std::ops::Range;

use planecut_parallel::prelude::*;

use crate::view::lens::ScreenPoint;

/// Number of the face at samples that no triangle covers.
pub(crate) const NO_FACE: u32 = u32::MAX;

/// Triangles on a picture whose unit is the sample: sample `i` of a row lies at `x = i + 0.5`, likewise for rows.
#[derive(Clone, Copy)]
pub(crate) struct Triangles<'a> {
    /// Samples across and down.
    pub(crate) size: [usize; 2],
    pub(crate) points: &'a [ScreenPoint],
    pub(crate) corners: &'a [[u32; 3]],
    /// For each triangle the number to leave at its samples.
    pub(crate) faces: &'a [u32],
}

impl Triangles<'_> {
    /// For each band of `rows` rows, with `margin` more on both sides, the triangles that reach it, in order: all of them, or those
    /// that show their front.
    pub(crate) fn by_band(&self, rows: usize, margin: usize, sides: Sides) -> Vec<Vec<u32>> {
        let height = self.size[1];
        let mut bands = vec![Vec::new(); height.div_ceil(rows)];
        for triangle in 0..self.corners.len() as u32 {
            let corners = self.points_of(triangle);
            if sides == Sides::Front && !is_front(corners) {
                continue;
            }
            let [a, b, c] = corners.map(|corner| corner.y);
            let (first, end) = covered(a.min(b).min(c).into(), a.max(b).max(c).into(), 0..height);
            if first < end {
                let last = ((end - 1 + margin) / rows).min(bands.len() - 1);
                for band in &mut bands[first.saturating_sub(margin) / rows..=last] {
                    band.push(triangle);
                }
            }
        }
        bands
    }

    /// The corners of a triangle.
    pub(crate) fn points_of(&self, triangle: u32) -> [ScreenPoint; 3] {
        self.corners[triangle as usize].map(|corner| self.points[corner as usize])
    }
}

/// Which triangles are seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Sides {
    /// Those that run counter-clockwise on the picture.
    Front,
    /// All.
    Both,
}

/// Nearest face and its depth at each sample of some rows, row by row.
#[derive(Default)]
pub(crate) struct Raster {
    pub(crate) width: usize,
    /// The rows of the picture that are held.
    pub(crate) rows: Range<usize>,
    /// Nearness of the surface, larger is nearer; 0 where there is none.
    pub(crate) nearness: Vec<f32>,
    /// Number of the face, or [`NO_FACE`].
    pub(crate) faces: Vec<u32>,
}

impl Raster {
    /// Draws the whole picture; triangles that turn clockwise are left out.
    pub(crate) fn draw(triangles: Triangles<'_>) -> Self {
        const BAND_ROWS: usize = 64;
        let [width, height] = triangles.size;
        let draw_band = |(index, chosen): (usize, &Vec<u32>)| {
            let mut band = Self::default();
            let first = index * BAND_ROWS;
            band.draw_rows(triangles, first..(first + BAND_ROWS).min(height), chosen);
            band
        };
        let bands: Vec<Self> =
            triangles.by_band(BAND_ROWS, 0, Sides::Front).par_iter().enumerate().map(draw_band).collect();
        let mut whole = Self { width, rows: 0..height, nearness: Vec::new(), faces: Vec::new() };
        whole.nearness.reserve_exact(width * height);
        whole.faces.reserve_exact(width * height);
        for band in &bands {
            whole.nearness.extend_from_slice(&band.nearness);
            whole.faces.extend_from_slice(&band.faces);
        }
        whole
    }

    /// Draws the chosen triangles on some rows. What was held before is dropped, only the memory is used again.
    pub(crate) fn draw_rows(&mut self, triangles: Triangles<'_>, rows: Range<usize>, chosen: &[u32]) {
        self.width = triangles.size[0];
        let samples = self.width * rows.len();
        self.rows = rows;
        self.nearness.clear();
        self.nearness.resize(samples, 0.0);
        self.faces.clear();
        self.faces.resize(samples, NO_FACE);
        for &triangle in chosen {
            self.fill(triangles.points_of(triangle), triangles.faces[triangle as usize]);
        }
    }

    /// Nearness and face of the sample that contains a point of the picture, the nearest sample held if that one is not.
    pub(crate) fn at(&self, x: f32, y: f32) -> (f32, u32) {
        // The conversions saturate: negative numbers become 0.
        let column = (x as u32 as usize).min(self.width - 1);
        let row = (y as u32 as usize).clamp(self.rows.start, self.rows.end - 1);
        let index = (row - self.rows.start) * self.width + column;
        (self.nearness[index], self.faces[index])
    }

    /// Nearness and face of the four samples around a point, as [`Self::at`] gives them.
    pub(crate) fn around(&self, x: f32, y: f32) -> [(f32, u32); 4] {
        let (x, y) = (x - 0.5, y - 0.5);
        let column = (x as u32 as usize).min(self.width - 1);
        let row = (y as u32 as usize).clamp(self.rows.start, self.rows.end - 1);
        let right = usize::from(x >= 0.0 && column + 1 < self.width);
        let below = self.width * usize::from(y >= self.rows.start as f32 && row + 1 < self.rows.end);
        let index = (row - self.rows.start) * self.width + column;
        [0, right, below, below + right].map(|way| (self.nearness[index + way], self.faces[index + way]))
    }

    fn fill(&mut self, corners: [ScreenPoint; 3], face: u32) {
        let (rows, width) = (self.rows.clone(), self.width);
        each_span(corners, rows, width, |row, columns, (first, step)| {
            self.fill_span(row, columns, (first, step), face);
        });
    }

    fn fill_span(&mut self, row: usize, columns: Range<usize>, (first, step): (f32, f32), face: u32) {
        let start = (row - self.rows.start) * self.width;
        let span = start + columns.start..start + columns.end;
        let samples = self.nearness[span.clone()].iter_mut().zip(&mut self.faces[span]);
        for (i, (old, id)) in samples.enumerate() {
            let new = first + step * (i as i32 as f32);
            // A bit mask instead of a branch: the loop becomes vector code.
            let wins = u32::from(new > *old).wrapping_neg();
            *old = old.max(new);
            *id = (face & wins) | (*id & !wins);
        }
    }
}

/// Calls `fill` with each row of a triangle's samples: the row, its columns, and the nearness of the first of them with the step to
/// the next. Rows and columns are limited to `rows` and `width`.
#[inline(always)]
pub(crate) fn each_span(
    mut corners: [ScreenPoint; 3],
    rows: Range<usize>,
    width: usize,
    mut fill: impl FnMut(usize, Range<usize>, (f32, f32)),
) {
    let plane = Plane::through(corners);
    corners.sort_by(|a, b| a.y.total_cmp(&b.y));
    let [top, middle, bottom] = corners;
    let long = Side::new(top, bottom);
    for (upper, lower) in [(top, middle), (middle, bottom)] {
        let short = Side::new(upper, lower);
        let (start, end) = covered(upper.y.into(), lower.y.into(), rows.clone());
        for row in start..end {
            let y = row as f64 + 0.5;
            let (a, b) = (long.x_at(y), short.x_at(y));
            let (left, right) = covered(a.min(b), a.max(b), 0..width);
            if left < right {
                let nearness = plane.along(y, left as f64 + 0.5, right - left);
                fill(row, left..right, nearness);
            }
        }
    }
}

/// Whether a triangle on the picture shows its front.
pub(crate) fn is_front([a, b, c]: [ScreenPoint; 3]) -> bool {
    signed_area(a, b, c) > 0.0
}

/// Twice the area, positive for counter-clockwise corners as seen (the y axis points down).
pub(crate) fn signed_area(a: ScreenPoint, b: ScreenPoint, c: ScreenPoint) -> f64 {
    let [ax, ay, bx, by, cx, cy] = [a.x, a.y, b.x, b.y, c.x, c.y].map(f64::from);
    (by - ay) * (cx - ax) - (bx - ax) * (cy - ay)
}

/// The samples between two coordinates, those on the lower one included, limited to `held`.
fn covered(low: f64, high: f64, held: Range<usize>) -> (usize, usize) {
    // Rounds up; written out because the library call costs more than the rest of a short row.
    let index = |value: f64| {
        let shifted = value - 0.5;
        let whole = shifted as u32;
        (whole as usize + usize::from(f64::from(whole) < shifted)).clamp(held.start, held.end)
    };
    (index(low), index(high))
}

/// One side of a triangle, always computed from its upper end.
struct Side {
    x: f64,
    y: f64,
    slope: f64,
}

impl Side {
    fn new(upper: ScreenPoint, lower: ScreenPoint) -> Self {
        // Sides of equal height are ordered by x, so that both triangles at the side agree.
        let (a, b) = if (upper.y, upper.x) <= (lower.y, lower.x) { (upper, lower) } else { (lower, upper) };
        let (x, y) = (f64::from(a.x), f64::from(a.y));
        Self { x, y, slope: (f64::from(b.x) - x) / (f64::from(b.y) - y) }
    }

    /// Only asked for rows strictly between the ends or on the upper one, so never for a horizontal side.
    fn x_at(&self, y: f64) -> f64 {
        self.x + (y - self.y) * self.slope
    }
}

/// Nearness as a linear function on the picture, within the range of the triangle's corners.
struct Plane {
    origin: [f64; 3],
    slope: [f64; 2],
    range: [f64; 2],
}

impl Plane {
    fn through([a, b, c]: [ScreenPoint; 3]) -> Self {
        let from_a = |p: ScreenPoint| [p.x - a.x, p.y - a.y, p.w - a.w].map(f64::from);
        let ([ux, uy, uw], [vx, vy, vw]) = (from_a(b), from_a(c));
        let scale = 1.0 / (ux * vy - uy * vx);
        let slope = [(uw * vy - uy * vw) * scale, (ux * vw - uw * vx) * scale];
        let range = [a.w.min(b.w).min(c.w), a.w.max(b.w).max(c.w)].map(f64::from);
        Self { origin: [a.x, a.y, a.w].map(f64::from), slope, range }
    }

    /// Value at the first of `count` samples of a row, and the step to the next. Both ends are clamped to the corners'
    /// range: the slopes of slivers are not trustworthy.
    fn along(&self, y: f64, x: f64, count: usize) -> (f32, f32) {
        let at = |x: f64| {
            let value = self.origin[2] + (x - self.origin[0]) * self.slope[0] + (y - self.origin[1]) * self.slope[1];
            // Not `clamp`, which panics on a reversed range and keeps NaN.
            value.max(self.range[0]).min(self.range[1])
        };
        let (first, last) = (at(x), at(x + (count - 1) as f64));
        let step = if count > 1 { (last - first) / (count - 1) as f64 } else { 0.0 };
        (first as f32, step as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(x: f32, y: f32, w: f32) -> ScreenPoint {
        ScreenPoint { x, y, w }
    }

    /// A fan of random triangles around a point covers every sample of a square once: no gap, no overlap.
    #[test]
    fn shared_sides_leave_no_gap_and_no_overlap() {
        let mut state = 3_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 40) as f32 / (1 << 24) as f32
        };
        let size = 100.0;
        for round in 0..200 {
            let mut rim = Vec::new();
            for side in 0..4 {
                let mut along: Vec<f32> = (0..7).map(|_| random() * size).chain([0.0]).collect();
                along.sort_by(f32::total_cmp);
                // Counter-clockwise as seen: down the left side, right, up, left.
                rim.extend(along.iter().map(|&t| match side {
                    0 => point(0.0, t, 0.5),
                    1 => point(t, size, 0.5),
                    2 => point(size, size - t, 0.5),
                    _ => point(size - t, 0.0, 0.5),
                }));
            }
            let hub = point(random() * size, random() * size, 0.5);
            let points: Vec<_> = rim.iter().copied().chain([hub]).collect();
            let count = rim.len() as u32;
            let triangles: Vec<_> = (0..count).map(|i| [count, i, (i + 1) % count]).collect();
            let faces: Vec<_> = (0..count).collect();
            let draw = |corners: &[[u32; 3]], faces: &[u32]| {
                Raster::draw(Triangles { size: [100, 100], points: &points, corners, faces })
            };
            let whole = draw(&triangles, &faces);
            assert!(whole.faces.iter().all(|&face| face != NO_FACE), "a gap in round {round} of seed 3");
            let covered: usize = triangles
                .iter()
                .map(|&triangle| {
                    let alone = draw(&[triangle], &[0]);
                    alone.faces.iter().filter(|&&face| face == 0).count()
                })
                .sum();
            assert_eq!(covered, 100 * 100, "an overlap in round {round} of seed 3");
        }
    }

    #[test]
    fn the_nearer_front_wins_and_backs_are_not_drawn() {
        let square = |w: f32| [point(0.0, 0.0, w), point(0.0, 8.0, w), point(8.0, 8.0, w), point(8.0, 0.0, w)];
        let points = [square(0.5), square(0.75)].concat();
        let far = [[0, 1, 2], [0, 2, 3]];
        let near = [[4, 5, 6], [4, 6, 7]];
        let near_back = [[4, 6, 5], [4, 7, 6]];
        for (triangles, expected) in [([far, near], 1), ([near, far], 0), ([far, near_back], 0)] {
            let corners = triangles.as_flattened();
            let raster = Raster::draw(Triangles { size: [8, 8], points: &points, corners, faces: &[0, 0, 1, 1] });
            assert!(raster.faces.iter().all(|&face| face == expected));
        }
    }
}
