//! Lines, areas and text to be put on top of a picture.

use tiny_skia::{FillRule, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, Rect, Stroke, Transform};

use super::text::Face;
use crate::error::PictureError;
use crate::picture::{MAX_IMAGE_SIDE, Picture, check_size};

/// Red, green, blue and alpha (sRGB, alpha not premultiplied).
pub(crate) type Color = [u8; 4];

/// Coordinates farther from the origin than this are not drawn: far beyond any picture, and still exact enough.
const FARTHEST: f32 = 1e6;
/// Least size of text in pixels per em: less is a grey line.
const LEAST_TEXT: f32 = 1.0;

/// Which part of a text stands at the place that is given for it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Align {
    /// Its start.
    Left,
    /// Its middle.
    Center,
    /// Its end.
    Right,
}

/// How text looks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TextStyle {
    /// Pixels per em; capital letters are about 0.73 times as high.
    pub(crate) size: f32,
    pub(crate) color: Color,
    /// Width in pixels and colour of a rim around the letters, which keeps them legible on any ground.
    pub(crate) halo: Option<(f32, Color)>,
}

/// A drawing as large as a picture, transparent where nothing is drawn.
///
/// Coordinates are pixels from the upper left corner, x to the right and y down; the middle of the first pixel is at
/// (0.5, 0.5). What lies outside is cut off, and shapes with coordinates that are not finite or absurdly far are left out.
pub(crate) struct Overlay {
    pixmap: Pixmap,
    /// The columns and rows outside of which nothing is drawn: first and end.
    touched: [[u32; 2]; 2],
}

impl Overlay {
    /// A drawing without anything.
    ///
    /// # Errors
    /// [`PictureError::ImageSize`].
    pub(crate) fn new(width: u32, height: u32) -> Result<Self, PictureError> {
        check_size([width, height])?;
        let pixmap = Pixmap::new(width, height).ok_or(PictureError::ImageSize { width, height })?;
        Ok(Self { pixmap, touched: [[u32::MAX, 0]; 2] })
    }

    /// A line with square ends that do not reach beyond its end points.
    pub(crate) fn line(&mut self, from: [f32; 2], to: [f32; 2], width: f32, color: Color) {
        if !(width > 0.0 && within_reach(&[from, to, [width, width]])) {
            return;
        }
        let mut path = PathBuilder::new();
        path.move_to(from[0], from[1]);
        path.line_to(to[0], to[1]);
        if let Some(path) = path.finish() {
            let stroke = Stroke { width, line_cap: LineCap::Butt, ..Stroke::default() };
            self.stroke(&path, &stroke, Transform::identity(), color);
        }
    }

    /// The inside of a polygon.
    pub(crate) fn polygon(&mut self, corners: &[[f32; 2]], color: Color) {
        let [first, others @ ..] = corners else { return };
        if !within_reach(corners) {
            return;
        }
        let mut path = PathBuilder::new();
        path.move_to(first[0], first[1]);
        for corner in others {
            path.line_to(corner[0], corner[1]);
        }
        path.close();
        if let Some(path) = path.finish() {
            self.fill(&path, Transform::identity(), color);
        }
    }

    /// A rectangle between two opposite corners, the lesser coordinates first, with rounded corners where `radius` is not 0.
    pub(crate) fn rectangle(&mut self, min: [f32; 2], max: [f32; 2], radius: f32, color: Color) {
        let [left, top] = min;
        let [right, bottom] = max;
        if !within_reach(&[min, max]) || left >= right || top >= bottom {
            return;
        }
        let radius = radius.max(0.0).min((right - left) / 2.0).min((bottom - top) / 2.0);
        // Distance of the control points from the corner that make a cubic curve a quarter of a circle, almost.
        let near = radius * (1.0 - 0.552_285);
        let mut path = PathBuilder::new();
        if radius > 0.0 {
            path.move_to(left + radius, top);
            path.line_to(right - radius, top);
            path.cubic_to(right - near, top, right, top + near, right, top + radius);
            path.line_to(right, bottom - radius);
            path.cubic_to(right, bottom - near, right - near, bottom, right - radius, bottom);
            path.line_to(left + radius, bottom);
            path.cubic_to(left + near, bottom, left, bottom - near, left, bottom - radius);
            path.line_to(left, top + radius);
            path.cubic_to(left, top + near, left + near, top, left + radius, top);
            path.close();
        } else if let Some(rectangle) = Rect::from_ltrb(left, top, right, bottom) {
            path.push_rect(rectangle);
        }
        if let Some(path) = path.finish() {
            self.fill(&path, Transform::identity(), color);
        }
    }

    /// A line of text. `at` is halfway up the capital letters.
    pub(crate) fn text(&mut self, text: &str, at: [f32; 2], align: Align, style: &TextStyle) {
        self.text_along(text, at, [1.0, 0.0], align, style);
    }

    /// A line of text that runs along a direction; `at` is halfway up the capital letters.
    ///
    /// A direction that would put the text upside down is read the other way round, so the text is still in the same
    /// place; a vertical one is read upwards. `align` is meant along the direction as given.
    pub(crate) fn text_along(
        &mut self,
        text: &str,
        at: [f32; 2],
        direction: [f32; 2],
        align: Align,
        style: &TextStyle,
    ) {
        let TextStyle { size, color, halo } = *style;
        let length = direction[0].hypot(direction[1]);
        let is_size = (LEAST_TEXT..=MAX_IMAGE_SIDE as f32).contains(&size);
        let (true, true, Some(face)) = (length.is_normal() && is_size, within_reach(&[at]), Face::new()) else {
            return;
        };
        let [cos, sin] = direction.map(|part| part / length);
        // A hair's breadth, so that text along a line that is drawn upright does not depend on the last digit.
        let is_turned = cos < -1e-3 || (cos < 1e-3 && sin > 0.0);
        let (cos, sin) = if is_turned { (-cos, -sin) } else { (cos, sin) };
        let width = face.width(text) * size;
        let before = match (align, is_turned) {
            (Align::Left, false) | (Align::Right, true) => 0.0,
            (Align::Center, _) => width / 2.0,
            (Align::Right, false) | (Align::Left, true) => width,
        };
        let is_level = sin == 0.0;
        let below = face.cap_height() * size / 2.0;
        let mut start = [at[0] - before * cos - below * sin, at[1] - before * sin + below * cos];
        if is_level {
            // Letters are fitted to whole rows.
            start[1] = start[1].round();
        }
        let halo = halo.filter(|&(rim, _)| rim > 0.0 && rim <= size);
        let [right, bottom] = [self.pixmap.width(), self.pixmap.height()].map(|side| side as f32);
        let is_visible = |x: f32, advance: f32| {
            let radius = advance / 2.0 + 3.0 * size;
            let middle = [start[0] + (x + advance / 2.0) * cos, start[1] + (x + advance / 2.0) * sin];
            let is_near = |place: f32, side: f32| (-radius..=side + radius).contains(&place);
            is_near(middle[0], right) && is_near(middle[1], bottom)
        };
        let Some(path) = face.path(text, size, is_level, is_visible) else { return };
        let placed = Transform::from_row(cos, sin, -sin, cos, start[0], start[1]);
        if let Some((rim, color)) = halo {
            let stroke = Stroke { width: 2.0 * rim, line_join: LineJoin::Round, ..Stroke::default() };
            self.stroke(&path, &stroke, placed, color);
        }
        self.fill(&path, placed, color);
    }

    /// Puts the drawing on top of a picture of the same size; on any other nothing is put.
    pub(crate) fn draw_onto(&self, picture: &mut Picture) {
        let width = self.pixmap.width();
        let [[left, right], [top, bottom]] = self.touched.map(|ends| ends.map(|end| end as usize));
        if !picture.is_complete() || [picture.width, picture.height] != [width, self.pixmap.height()] || left >= right {
            return;
        }
        let row = 4 * width as usize;
        let rows = self.pixmap.data().chunks_exact(row).zip(picture.pixels.chunks_exact_mut(row));
        for (drawn, old) in rows.take(bottom).skip(top) {
            let drawn = &drawn.as_chunks::<4>().0[left..right];
            let old = &mut old.as_chunks_mut::<4>().0[left..right];
            for (&drawn, old) in drawn.iter().zip(old) {
                if drawn[3] != 0 {
                    *old = premultiplied_over(drawn, *old);
                }
            }
        }
    }

    fn fill(&mut self, path: &Path, placed: Transform, color: Color) {
        self.touch(path, placed, 1.0);
        self.pixmap.fill_path(path, &paint(color), FillRule::Winding, placed, None);
    }

    fn stroke(&mut self, path: &Path, stroke: &Stroke, placed: Transform, color: Color) {
        self.touch(path, placed, stroke.width + 1.0);
        self.pixmap.stroke_path(path, &paint(color), stroke, placed, None);
    }

    /// Notes that a path is drawn, with `margin` pixels around it.
    fn touch(&mut self, path: &Path, placed: Transform, margin: f32) {
        let Some(bounds) = path.bounds().transform(placed) else { return };
        let ends = [[bounds.left(), bounds.right()], [bounds.top(), bounds.bottom()]];
        let sides = [self.pixmap.width(), self.pixmap.height()];
        for ((touched, [low, high]), side) in self.touched.iter_mut().zip(ends).zip(sides) {
            // The conversions saturate: negative numbers become 0.
            touched[0] = touched[0].min((low - margin).floor() as u32);
            touched[1] = touched[1].max(((high + margin).ceil() as u32).min(side));
        }
    }
}

fn paint(color: Color) -> Paint<'static> {
    let mut paint = Paint::default();
    let [r, g, b, a] = color;
    paint.set_color_rgba8(r, g, b, a);
    paint
}

fn within_reach(points: &[[f32; 2]]) -> bool {
    points.as_flattened().iter().all(|value| value.abs() <= FARTHEST)
}

/// A premultiplied colour on top of one that is not.
fn premultiplied_over(top: [u8; 4], bottom: [u8; 4]) -> [u8; 4] {
    let through = 255 - u32::from(top[3]);
    // Weight of the lower colour and of the result, 255² for an opaque pixel.
    let lower = u32::from(bottom[3]) * through;
    let whole = u32::from(top[3]) * 255 + lower;
    let mixed = |i: usize| {
        let sum = u32::from(top[i]) * 255 * 255 + u32::from(bottom[i]) * lower;
        // Rounding of the premultiplied colour may exceed what is possible by a step.
        ((sum + whole / 2) / whole).min(255) as u8
    };
    [mixed(0), mixed(1), mixed(2), ((whole + 127) / 255) as u8]
}

#[cfg(all(test, feature = "text"))]
mod tests;
