//! Dimensions and scale bars.

use glam::Vec2;

use super::overlay::{Align, Color, Overlay, TextStyle};
use super::text::text_width;
use crate::error::PictureError;
use crate::input::bounds::box_corners;

use crate::input::mesh::PaintedMesh;
use crate::input::options::{Background, PreviewOptions};
use crate::picture::Picture;
use crate::view::camera::Camera;

/// Sizes in a picture whose shorter side is 960 pixels, in pixels: of text, lines, arrow heads, and what stands off the model.
const TEXT: f32 = 25.0;
const LINE: f32 = 1.5;
const ARROW: [f32; 2] = [15.0, 4.5];
const GAP: f32 = 9.0;
const DISTANCE: f32 = 44.0;
const BEYOND: f32 = 9.0;

/// The scale bar: about this part of the width, and this thick.
const BAR_PART: f64 = 0.2;
const BAR: f32 = 7.0;

/// Colours of what is written.
struct Inks {
    ink: Color,
    halo: Color,
}

/// Writes onto a picture what the options ask for.
///
/// # Errors
/// [`PictureError::ImageSize`]; never expected.
pub(crate) fn draw_labels(
    picture: &mut Picture,
    mesh: &PaintedMesh<'_>,
    camera: &Camera,
    options: &PreviewOptions,
) -> Result<(), PictureError> {
    if !options.has_labels() {
        return Ok(());
    }
    let inks = match options.background {
        Background::Light | Background::Transparent => Inks { ink: [28, 34, 46, 255], halo: [255, 255, 255, 215] },
        Background::Dark => Inks { ink: [226, 232, 240, 255], halo: [16, 18, 24, 215] },
    };
    let overlay = Overlay::new(options.width, options.height)?;
    let mut labels = Labels { overlay, inks, scale: options.scale().max(0.4), unit: options.unit };
    if options.dimensions {
        labels.dimensions(mesh, camera);
    }
    if options.scale_bar {
        labels.scale_bar(camera, options);
    }
    labels.overlay.draw_onto(picture);
    Ok(())
}

struct Labels {
    overlay: Overlay,
    inks: Inks,
    /// How large the picture is, compared with the one that sizes are stated for.
    scale: f32,
    unit: Option<&'static str>,
}

impl Labels {
    /// The extents of the model along the axes, each at an edge of its box that stands out on the picture.
    fn dimensions(&mut self, mesh: &PaintedMesh<'_>, camera: &Camera) {
        let Some(bounds) = mesh.bounds() else { return };
        let corners = box_corners(bounds);
        let extent = bounds[1] - bounds[0];
        let seen = corners.map(|corner| camera.see(corner).place());
        let middle = seen.iter().sum::<Vec2>() / 8.0;
        for axis in 0..3 {
            if extent[axis] <= 0.0 {
                continue;
            }
            // The edges along the axis start at the corners whose number lacks its bit.
            let edges = (0..8).filter(|number| number >> axis & 1 == 0).map(|number| [number, number | 1 << axis]);
            let place = |edge: &[usize; 2]| (seen[edge[0]] + seen[edge[1]]) / 2.0 - middle;
            // Outermost: at the bottom for what lies, at the left for what stands.
            let outward = |edge: &[usize; 2]| if axis == 2 { -place(edge).x } else { place(edge).y };
            let best = edges.max_by(|a, b| outward(a).total_cmp(&outward(b)));
            if let Some([from, to]) = best {
                let length = self.length(extent[axis]);
                self.dimension([seen[from], seen[to]], middle, &length);
            }
        }
    }

    /// A dimension beside an edge: extension lines, a line with arrows, and the length along it.
    fn dimension(&mut self, [a, b]: [Vec2; 2], middle: Vec2, length: &str) {
        let along = (b - a).normalize_or_zero();
        // Seen from its end an axis has no length that could be shown.
        if (b - a).length() < 4.0 * self.scale {
            return;
        }
        let mut away = along.perp();
        if away.dot((a + b) / 2.0 - middle) < 0.0 {
            away = -away;
        }
        let [gap, distance, beyond] = [GAP, DISTANCE, BEYOND].map(|length| away * length * self.scale);
        for end in [a, b] {
            self.line(end + gap, end + distance + beyond, 0.75);
        }
        let (from, to) = (a + distance, b + distance);
        let [arrow, half] = ARROW.map(|length| length * self.scale);
        // Where there is no room for arrows within, they come from outside.
        let is_short = (to - from).length() < 2.6 * arrow;
        for (end, inwards) in [(from, along), (to, -along)] {
            let inwards = if is_short { -inwards } else { inwards };
            let (base, side) = (end + inwards * arrow, inwards.perp() * half);
            self.overlay.polygon(&[end, base + side, base - side].map(|point| point.to_array()), self.inks.ink);
            if is_short {
                self.line(end, end + inwards * arrow * 1.8, 1.0);
            }
        }
        let style = self.style(TEXT);
        let text = (from + to) / 2.0;
        let wide = text_width(length, style.size);
        // The line makes room for the text, as far as there is room for both.
        if wide + style.size < (to - from).length() {
            let half = along * (wide + 0.6 * style.size) / 2.0;
            self.line(from, text - half, 1.0);
            self.line(text + half, to, 1.0);
            self.overlay.text_along(length, text.to_array(), along.to_array(), Align::Center, &style);
        } else {
            self.line(from, to, 1.0);
            let beside = text + away.normalize_or_zero() * style.size * 1.1;
            let align = if away.x < -0.5 {
                Align::Right
            } else if away.x > 0.5 {
                Align::Left
            } else {
                Align::Center
            };
            self.overlay.text(length, beside.to_array(), align, &style);
        }
    }

    /// A bar of a round length at the lower left.
    fn scale_bar(&mut self, camera: &Camera, options: &PreviewOptions) {
        let per_unit = camera.pixels_per_world_unit();
        let wanted = f64::from(options.width) * BAR_PART / per_unit;
        if !(wanted.is_normal() && per_unit.is_normal()) {
            return;
        }
        let length = round_length(wanted);
        let margin = 32.0 * self.scale;
        let (left, bottom) = (margin, options.height as f32 - margin);
        let right = left + (length * per_unit) as f32;
        let height = BAR * self.scale;
        let rim = 1.2 * self.scale;
        // Alternating parts, as on maps: half of the bar is filled.
        self.overlay.rectangle([left, bottom - height - 2.0 * rim], [right, bottom], 0.0, self.inks.ink);
        let middle = (left + right) / 2.0;
        self.overlay.rectangle([middle, bottom - height - rim], [right - rim, bottom - rim], 0.0, self.inks.halo);
        let style = self.style(TEXT * 0.9);
        let text = bottom - height - style.size * 0.75;
        self.overlay.text(&self.length(length), [left, text], Align::Left, &style);
    }

    fn line(&mut self, from: Vec2, to: Vec2, strength: f32) {
        let width = (LINE * strength * self.scale).max(1.0);
        self.overlay.line(from.to_array(), to.to_array(), width, self.inks.ink);
    }

    fn style(&self, size: f32) -> TextStyle {
        let size = (size * self.scale).max(11.0);
        TextStyle { size, color: self.inks.ink, halo: Some((size * 0.2, self.inks.halo)) }
    }

    /// A length with its unit.
    fn length(&self, length: f64) -> String {
        let number = four_digits(length);
        match self.unit {
            Some(unit) => format!("{number} {unit}"),
            None => number,
        }
    }
}

/// The largest of 1, 2 and 5 times a power of ten that is no more than `wanted`, which is positive.
fn round_length(wanted: f64) -> f64 {
    let power = 10.0_f64.powi(wanted.log10().floor() as i32);
    let part = wanted / power;
    let digit = if part >= 5.0 {
        5.0
    } else if part >= 2.0 {
        2.0
    } else {
        1.0
    };
    digit * power
}

/// A positive number to four digits, without zeros at its end.
fn four_digits(value: f64) -> String {
    let digits = value.log10().floor() as i32;
    if !(-4..7).contains(&digits) {
        return format!("{value:.3e}");
    }
    let text = format!("{value:.*}", (3 - digits).max(0) as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_have_four_digits_and_no_idle_zeros() {
        let cases = [
            (1.0, "1"),
            (12.5, "12.5"),
            (0.1 + 0.2, "0.3"),
            (1234.56, "1235"),
            (98765.4, "98765"),
            (1e-3 / 3.0, "0.0003333"),
        ];
        for (value, text) in cases {
            assert_eq!(four_digits(value), text);
        }
        assert_eq!((four_digits(1.5e9).as_str(), four_digits(2e-7).as_str()), ("1.500e9", "2.000e-7"));
    }

    #[test]
    fn bars_have_round_lengths() {
        for (wanted, length) in [(1.0, 1.0), (1.99, 1.0), (4.9, 2.0), (73.0, 50.0), (0.3, 0.2)] {
            assert!((round_length(wanted) - length).abs() < 1e-12 * length, "{wanted}");
        }
    }
}
