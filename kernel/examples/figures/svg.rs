//! A picture in SVG, written as plain text: coordinates to a tenth of a pixel, so that the same figure is the same bytes.

use std::fmt::Write;

use planecut_kernel::DVec2;

use super::color::{Color, INK};

/// How a line is drawn.
#[derive(Debug, Clone)]
pub(crate) struct Stroke {
    color: String,
    width: f64,
    dashes: &'static str,
}

impl Stroke {
    /// An edge that matters no more than others.
    pub(crate) fn edge() -> Self {
        Self { color: INK.to_owned(), width: 1.3, dashes: "" }
    }

    /// A thick line in the dark shade of a role's colour.
    pub(crate) fn strong(color: Color) -> Self {
        Self { color: color.deep(), width: 2.8, dashes: "" }
    }

    /// A dashed line in the dark shade of a role's colour: what was there before.
    pub(crate) fn dashed(color: Color) -> Self {
        Self { color: color.deep(), width: 1.6, dashes: "5 4" }
    }
}

/// How a word is set, always around its place.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Word {
    /// The name of a plane, vertex or face, in italics.
    Name,
    /// A remark.
    Remark,
    /// The heading of a panel.
    Heading,
}

/// The picture so far.
#[derive(Debug)]
pub(crate) struct Svg {
    size: DVec2,
    body: String,
}

impl Svg {
    pub(crate) fn new(width: f64, height: f64) -> Self {
        Self { size: DVec2::new(width, height), body: String::new() }
    }

    pub(crate) fn line(&mut self, from: DVec2, to: DVec2, stroke: &Stroke) {
        // from left to right, whichever end came first
        let (from, to) = if (to.x, to.y) < (from.x, from.y) { (to, from) } else { (from, to) };
        self.path(&format!("M{} L{}", pair(from), pair(to)), "none", 1.0, Some(stroke));
    }

    pub(crate) fn arrow(&mut self, from: DVec2, to: DVec2, stroke: &Stroke) {
        let along = (to - from).normalize_or_zero();
        let head = |side: f64| to - along * 11.0 + along.perp() * side;
        self.line(from, to - along * 9.0, stroke);
        let path = format!("M{} L{} L{} Z", pair(to), pair(head(4.4)), pair(head(-4.4)));
        self.path(&path, &stroke.color, 1.0, None);
    }

    pub(crate) fn polygon(&mut self, corners: &[DVec2], fill: &str, opacity: f64, stroke: Option<&Stroke>) {
        // from the same corner on, wherever the ring began
        let key = |at: &usize| (corners[*at].x, corners[*at].y);
        let first = (0..corners.len()).min_by(|a, b| key(a).partial_cmp(&key(b)).expect("no NaN")).unwrap_or(0);
        let (before, after) = corners.split_at(first);
        let path: Vec<String> = after.iter().chain(before).map(|corner| pair(*corner)).collect();
        self.path(&format!("M{} Z", path.join(" L")), fill, opacity, stroke);
    }

    /// A point: a filled disc, or an open one for a point at infinity.
    pub(crate) fn dot(&mut self, at: DVec2, color: &str, is_open: bool) {
        let fill = if is_open { "#ffffff" } else { color };
        let place = format!("cx=\"{}\" cy=\"{}\"", number(at.x), number(at.y));
        self.push(&format!("<circle {place} r=\"4.4\" fill=\"{fill}\" stroke=\"{color}\" stroke-width=\"1.8\"/>"));
    }

    /// A point with its number.
    pub(crate) fn badge(&mut self, at: DVec2, color: &str, number: &str) {
        let place = format!("cx=\"{}\" cy=\"{}\"", self::number(at.x), self::number(at.y));
        self.push(&format!("<circle {place} r=\"9\" fill=\"{color}\" stroke=\"#ffffff\" stroke-width=\"1.5\"/>"));
        let place = format!("x=\"{}\" y=\"{}\"", self::number(at.x), self::number(at.y + 4.5));
        self.push(&format!("<text {place} class=\"badge\" fill=\"#ffffff\">{number}</text>"));
    }

    /// A word around a place; what follows a `_` is set as an index.
    pub(crate) fn word(&mut self, at: DVec2, text: &str, word: Word) {
        self.colored_word(at, text, word, INK);
    }

    /// The same in a colour.
    pub(crate) fn colored_word(&mut self, at: DVec2, text: &str, word: Word, color: &str) {
        let class = match word {
            Word::Name => "name",
            Word::Remark => "remark",
            Word::Heading => "heading",
        };
        let text = match text.split_once('_') {
            Some((name, index)) => format!("{name}<tspan dy=\"4\" font-size=\"13\">{index}</tspan>"),
            None => text.to_owned(),
        };
        let place = format!("x=\"{}\" y=\"{}\"", number(at.x), number(at.y + 6.0));
        if matches!(word, Word::Name) {
            // a rim, so that lines under a name do not touch it
            self.push(&format!("<text {place} class=\"{class} rim\">{text}</text>"));
        }
        self.push(&format!("<text {place} class=\"{class}\" fill=\"{color}\">{text}</text>"));
    }

    /// The file, on a light ground of its own, so that it reads on any page.
    pub(crate) fn finish(&self, title: &str) -> String {
        let DVec2 { x, y } = self.size;
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {x} {y}\" width=\"{x}\" height=\"{y}\">\n\
             <title>{title}</title>\n\
             <style>text {{ font-family: Helvetica, Arial, 'Liberation Sans', sans-serif; text-anchor: middle }} \
             .name {{ font-family: Georgia, 'Times New Roman', 'Liberation Serif', serif; font-style: italic; \
             font-size: 20px }} .rim {{ fill: none; stroke: #ffffff; stroke-width: 3.5; stroke-opacity: 0.75 }} \
             .remark {{ font-size: 14px }} .heading {{ font-size: 15px; font-weight: bold }} \
             .badge {{ font-size: 12px; font-weight: bold }}</style>\n\
             <rect x=\"0.5\" y=\"0.5\" width=\"{}\" height=\"{}\" rx=\"10\" fill=\"#ffffff\" stroke=\"#d3d9e1\"/>\n\
             {}</svg>\n",
            x - 1.0,
            y - 1.0,
            self.body
        )
    }

    fn path(&mut self, path: &str, fill: &str, opacity: f64, stroke: Option<&Stroke>) {
        let mut text = format!("<path d=\"{path}\" fill=\"{fill}\"");
        if opacity < 1.0 {
            text += &format!(" fill-opacity=\"{opacity}\"");
        }
        if let Some(Stroke { color, width, dashes }) = stroke {
            text += &format!(" stroke=\"{color}\" stroke-width=\"{width}\" stroke-linejoin=\"round\"");
            text += if dashes.is_empty() { " stroke-linecap=\"round\"" } else { "" };
            if !dashes.is_empty() {
                text += &format!(" stroke-dasharray=\"{dashes}\"");
            }
        }
        self.push(&(text + "/>"));
    }

    fn push(&mut self, element: &str) {
        writeln!(self.body, "{element}").expect("writing to a string does not fail");
    }
}

fn pair(point: DVec2) -> String {
    format!("{} {}", number(point.x), number(point.y))
}

fn number(v: f64) -> String {
    // `+ 0.0` after rounding: no minus sign before a zero
    format!("{}", (v * 10.0).round() / 10.0 + 0.0)
}
