//! `text`: letters of a font as a region of the plane, with OpenSCAD's sizes, curves and places.
//!
//! OpenSCAD asks FreeType for glyphs of one fixed, large size and scales them afterwards. That size is not so large that hinting
//! and whole pixels would not show in the fifth digit, so glyphs are hinted here too: `skrifa` runs the font's own instructions
//! as FreeType does. `harfrust` is HarfBuzz, which OpenSCAD uses: it chooses glyphs, and says how far they are apart.
//!
//! Source: the OpenSCAD User Manual, "Text", and the behaviour of OpenSCAD 2021.01.

mod font;

use std::str::FromStr;

use harfrust::{Direction, GlyphInfo, GlyphPosition, Language, Script, ShaperData, UnicodeBuffer};
use planecut_kernel::DVec2;
use planecut_shapes::{Outline, ShapeError};
use skrifa::instance::{LocationRef, Size};
use skrifa::outline::{DrawSettings, HintingInstance, HintingOptions, OutlineGlyphCollection, OutlinePen};
use skrifa::{FontRef, GlyphId, MetadataProvider};
use thiserror::Error;

use super::arguments::Arguments;
use super::fragments::Fragments;
use super::problem::Problem;
use super::syntax::Node;
pub(super) use font::Fonts;

/// The size that is asked for, in 64ths of a point, at 100 dots per inch; a text of size 1 has this many units.
const UNITS: f64 = 1e5;
/// The same in 64ths of a dot: `UNITS · 100 / 72`, to a whole number.
const EM: f64 = 138_889.0;
/// 64ths of a dot.
const DOT: f64 = 64.0;
/// OpenSCAD divides shapes by a thousand, but distances between letters and heights to align them by 1024.
const PLACE: f64 = 1000.0 / 1024.0;

/// The arguments of a `text`.
struct Text<'a> {
    /// The letters.
    text: &'a str,
    /// The height of capital letters, about.
    size: f64,
    /// How much farther apart letters are than they want to be.
    spacing: f64,
    /// `Family:style=Style`; OpenSCAD's own where empty.
    font: &'a str,
    /// `ltr`, `rtl`, `ttb`, `btt`; what the script wants otherwise.
    direction: &'a str,
    /// A code of two letters.
    language: &'a str,
    /// A code of four letters; what the letters are otherwise.
    script: &'a str,
    /// `left`, `center`, `right`.
    halign: &'a str,
    /// `baseline`, `top`, `center`, `bottom`.
    valign: &'a str,
    /// The segments of a circle whose radius is the size.
    segments: u32,
}

/// What a node draws, and what OpenSCAD or its user should be told.
pub(super) fn text(node: &Node<'_>, fonts: &mut Fonts) -> Result<(Outline, Vec<String>), Problem> {
    let arguments = Arguments::of(node, &["text", "size", "font"]);
    let size = arguments.number_or("size", 10.0);
    let said = |name: &str, other| arguments.text(name).unwrap_or(other);
    let text = Text {
        text: said("text", ""),
        size,
        spacing: arguments.number_or("spacing", 1.0),
        font: said("font", ""),
        direction: said("direction", ""),
        language: said("language", "en"),
        script: said("script", ""),
        halign: said("halign", "left"),
        valign: said("valign", "baseline"),
        segments: Fragments::of(&arguments).around(size)?,
    };
    if text.text.is_empty() || !(size.is_finite() && text.spacing.is_finite()) {
        return Ok((Outline::empty(), Vec::new()));
    }
    outline(&text, fonts).map_err(|error| match error {
        TextError::Shape(error) => error.into(),
        other => Problem::new(other.to_string(), "a font of the system"),
    })
}

/// Why a text has no outline.
#[derive(Debug, Clone, PartialEq, Error)]
enum TextError {
    /// The system has no fonts at all.
    #[error("a text, and a system without fonts, even `{0}`")]
    NoFont(String),
    /// A font that is there but cannot be read.
    #[error("the font `{0}`, which has no outlines that can be read")]
    Unreadable(String),
    /// Letters too large or too small.
    #[error(transparent)]
    Shape(#[from] ShapeError),
}

/// The outline of a text, and what OpenSCAD or its user should be told.
///
/// # Errors
/// [`TextError`].
fn outline(text: &Text<'_>, fonts: &mut Fonts) -> Result<(Outline, Vec<String>), TextError> {
    let (font, warning) = fonts.find(text.font)?;
    let mut warnings: Vec<String> = warning.into_iter().collect();
    let unreadable = || TextError::Unreadable(text.font.to_owned());
    let face = FontRef::from_index(&font.data, font.index).map_err(|_| unreadable())?;
    let line = Line::shaped(text, &face);
    let drawn = line.drawn(&face).ok_or_else(unreadable)?;
    let start = line.start(text, &drawn, &mut warnings);
    let segments = (text.segments / 8 + 1).max(2);
    let mut loops: Vec<Vec<DVec2>> = Vec::new();
    let mut pen = start;
    for (glyph, drawing) in line.glyphs.iter().zip(&drawn) {
        let place = |p: DVec2| (pen + glyph.offset + p * (DOT / UNITS)) * text.size;
        loops.extend(drawing.loops(segments).into_iter().map(|c| c.into_iter().map(place).collect()));
        pen += glyph.advance * text.spacing;
    }
    loops.retain(|corners| corners.len() >= 3);
    Ok((Outline::from_wound_loops(&loops)?, warnings))
}

/// A glyph in its place; lengths for a text of size 1.
struct Glyph {
    id: GlyphId,
    offset: DVec2,
    advance: DVec2,
}

/// A line of glyphs.
struct Line {
    glyphs: Vec<Glyph>,
    is_vertical: bool,
}

impl Line {
    fn shaped(text: &Text<'_>, face: &FontRef<'_>) -> Self {
        let mut buffer = UnicodeBuffer::new();
        buffer.push_str(text.text);
        buffer.guess_segment_properties();
        // an empty name is that of a script without rules
        if let Some(script) = Script::from_str(text.script).ok().filter(|_| !text.script.is_empty()) {
            buffer.set_script(script);
        }
        if let Ok(direction) = Direction::from_str(text.direction) {
            buffer.set_direction(direction);
        }
        if let Ok(language) = Language::from_str(text.language) {
            buffer.set_language(language);
        }
        let direction = buffer.direction();
        let data = ShaperData::new(face);
        let shaper = data.shaper(face).build();
        let scale = EM / UNITS / f64::from(shaper.units_per_em()) * PLACE;
        let shaped = shaper.shape(buffer, &[]);
        let glyph = |(info, position): (&GlyphInfo, &GlyphPosition)| Glyph {
            id: GlyphId::new(info.glyph_id),
            offset: DVec2::new(f64::from(position.x_offset), f64::from(position.y_offset)) * scale,
            advance: DVec2::new(f64::from(position.x_advance), f64::from(position.y_advance)) * scale,
        };
        let glyphs = shaped.glyph_infos().iter().zip(shaped.glyph_positions()).map(glyph).collect();
        Self { glyphs, is_vertical: matches!(direction, Direction::TopToBottom | Direction::BottomToTop) }
    }

    /// The drawings of all glyphs; nothing where the font has no outlines.
    fn drawn(&self, face: &FontRef<'_>) -> Option<Vec<Drawing>> {
        let outlines = face.outline_glyphs();
        outlines.format()?;
        let size = Size::new((EM / DOT) as f32);
        let hinting = HintingInstance::new(&outlines, size, LocationRef::default(), HintingOptions::default()).ok();
        Some(self.glyphs.iter().map(|glyph| Drawing::of(&outlines, glyph.id, size, hinting.as_ref())).collect())
    }

    /// Where the first glyph begins.
    fn start(&self, text: &Text<'_>, drawn: &[Drawing], warnings: &mut Vec<String>) -> DVec2 {
        let advance = self.glyphs.iter().map(|glyph| glyph.advance * text.spacing).sum::<DVec2>();
        let most = |of: &dyn Fn(&Drawing) -> f64| drawn.iter().map(of).fold(0.0, f64::max);
        let (width, ascent, descent) = if self.is_vertical {
            (most(&|drawing| drawing.max.x - drawing.min.x) * PLACE, advance.y, 0.0)
        } else {
            (advance.x, most(&|drawing| drawing.max.y) * PLACE, most(&|drawing| -drawing.min.y) * PLACE)
        };
        let mut unknown = |name: &str, value: &str, expected: &str| {
            warnings.push(format!("unknown {name} `{value}`, expected {expected}"));
            0.0
        };
        let x = match text.halign {
            "left" => 0.0,
            "right" => -width,
            "center" => -width / 2.0,
            other => unknown("halign", other, "left, center or right"),
        };
        let y = match text.valign {
            "baseline" => 0.0,
            "top" => -ascent,
            "center" => descent / 2.0 - ascent / 2.0,
            "bottom" => descent,
            other => unknown("valign", other, "baseline, top, center or bottom"),
        };
        DVec2::new(x, y)
    }
}

/// A piece of the boundary of a glyph, in dots, of which whole numbers are exact.
enum Stroke {
    Move(DVec2),
    Line(DVec2),
    Curve([DVec2; 2]),
    Cubic([DVec2; 3]),
}

/// A glyph.
#[derive(Default)]
struct Drawing {
    strokes: Vec<Stroke>,
    /// The least box of whole dots around all points, those beside curves too, for a text of size 1.
    min: DVec2,
    max: DVec2,
}

impl Drawing {
    /// The glyph, hinted where that can be done; nothing where there is no such glyph.
    fn of(outlines: &OutlineGlyphCollection<'_>, id: GlyphId, size: Size, hinting: Option<&HintingInstance>) -> Self {
        let Some(glyph) = outlines.get(id) else { return Self::default() };
        let mut drawing = Self::default();
        let hinted = hinting.map(|hinting| glyph.draw(DrawSettings::hinted(hinting, false), &mut drawing));
        if !matches!(hinted, Some(Ok(_))) {
            drawing = Self::default();
            if glyph.draw(DrawSettings::unhinted(size, LocationRef::default()), &mut drawing).is_err() {
                return Self::default();
            }
        }
        drawing.measure();
        drawing
    }

    fn measure(&mut self) {
        let points = self.strokes.iter().flat_map(|stroke| match stroke {
            Stroke::Move(p) | Stroke::Line(p) => vec![*p],
            Stroke::Curve(points) => points.to_vec(),
            Stroke::Cubic(points) => points.to_vec(),
        });
        let bounds = points.fold(None, |bounds: Option<(DVec2, DVec2)>, p| {
            Some(bounds.map_or((p, p), |(min, max)| (min.min(p), max.max(p))))
        });
        let Some((min, max)) = bounds else { return };
        (self.min, self.max) = (min.floor() * (DOT / UNITS), max.ceil() * (DOT / UNITS));
    }

    /// The loops in dots, each curve cut into this number of segments of equal parameter.
    fn loops(&self, segments: u32) -> Vec<Vec<DVec2>> {
        let mut loops: Vec<Vec<DVec2>> = Vec::new();
        let mut pen = DVec2::ZERO;
        let parts = || (1..=segments).map(|k| f64::from(k) / f64::from(segments));
        for stroke in &self.strokes {
            let end = match stroke {
                Stroke::Move(to) => {
                    loops.push(vec![*to]);
                    *to
                }
                Stroke::Line(to) => {
                    loops.last_mut().into_iter().for_each(|corners| corners.push(*to));
                    *to
                }
                Stroke::Curve([over, to]) => {
                    let at = |t: f64| pen * (1.0 - t).powi(2) + *over * (2.0 * (1.0 - t) * t) + *to * t * t;
                    loops.last_mut().into_iter().for_each(|corners| corners.extend(parts().map(at)));
                    *to
                }
                Stroke::Cubic([first, second, to]) => {
                    let at = |t: f64| {
                        let rest = 1.0 - t;
                        pen * rest.powi(3)
                            + *first * (3.0 * rest * rest * t)
                            + *second * (3.0 * rest * t * t)
                            + *to * t.powi(3)
                    };
                    loops.last_mut().into_iter().for_each(|corners| corners.extend(parts().map(at)));
                    *to
                }
            };
            pen = end;
        }
        for corners in &mut loops {
            corners.dedup();
            while corners.len() > 1 && corners.first() == corners.last() {
                corners.pop();
            }
        }
        loops
    }
}

fn point(x: f32, y: f32) -> DVec2 {
    DVec2::new(f64::from(x), f64::from(y))
}

impl OutlinePen for Drawing {
    fn move_to(&mut self, x: f32, y: f32) {
        self.strokes.push(Stroke::Move(point(x, y)));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.strokes.push(Stroke::Line(point(x, y)));
    }

    fn quad_to(&mut self, over_x: f32, over_y: f32, x: f32, y: f32) {
        self.strokes.push(Stroke::Curve([point(over_x, over_y), point(x, y)]));
    }

    fn curve_to(&mut self, x0: f32, y0: f32, x1: f32, y1: f32, x: f32, y: f32) {
        self.strokes.push(Stroke::Cubic([point(x0, y0), point(x1, y1), point(x, y)]));
    }

    fn close(&mut self) {}
}

#[cfg(test)]
mod tests;
