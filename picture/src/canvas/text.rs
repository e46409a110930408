//! Letters as outlines, in the font that comes with the program.
//!
//! The same font everywhere makes the same picture everywhere. Glyphs follow one another by their widths: no kerning, no
//! ligatures, no right-to-left order; labels and file names do without.

use skrifa::charmap::Charmap;
use skrifa::instance::{LocationRef, Size};
use skrifa::metrics::GlyphMetrics;
use skrifa::outline::{
    DrawSettings, Engine, HintingInstance, HintingOptions, OutlineGlyphCollection, OutlinePen, SmoothMode, Target,
};
use skrifa::{FontRef, GlyphId, MetadataProvider};
use tiny_skia::{Path, PathBuilder};

/// DejaVu Sans Condensed 2.37, whole: titles are names of files, which may hold any letter. Its licence stands beside it.
static FONT: &[u8] = include_bytes!("../../assets/DejaVuSansCondensed.ttf");
/// Stands for what was left out of a text.
const ELLIPSIS: char = '…';
/// Share of the room for the end of a shortened text: the end of a file name says most.
const END_SHARE: f32 = 0.62;

/// Width of a text in pixels, for a size in pixels per em.
pub(crate) fn text_width(text: &str, size: f32) -> f32 {
    Face::new().map_or(0.0, |face| face.width(text)) * size
}

/// The text itself where it is not wider than `width` pixels, else its start and its end with an ellipsis between. Empty
/// where not even an ellipsis has room.
pub(crate) fn shortened(text: &str, width: f32, size: f32) -> String {
    let Some(face) = Face::new() else { return String::new() };
    let room = width / size;
    if face.width(text) <= room {
        return text.to_owned();
    }
    let room = room - face.advance(ELLIPSIS);
    // Also where the room is not a number.
    if room.is_nan() || room < 0.0 {
        return String::new();
    }
    let fits = |sum: &mut f32, c: char, room: f32| {
        *sum += face.advance(c);
        *sum <= room
    };
    let mut sum = 0.0;
    let count = text.chars().rev().take_while(|&c| fits(&mut sum, c, room * END_SHARE)).count();
    let end: String = text.chars().skip(text.chars().count() - count).collect();
    let mut sum = face.width(&end);
    let start: String = text.chars().take_while(|&c| fits(&mut sum, c, room)).collect();
    [start.trim_end(), end.trim_start()].join(ELLIPSIS.encode_utf8(&mut [0; 4]))
}

/// A font, ready to be asked.
pub(crate) struct Face<'a> {
    characters: Charmap<'a>,
    /// In the units of the font.
    metrics: GlyphMetrics<'a>,
    /// Ems of a unit of the font.
    unit: f32,
    outlines: OutlineGlyphCollection<'a>,
    cap_height: f32,
}

impl Face<'static> {
    /// The font. `None` never happens with the fonts that come along.
    pub(crate) fn new() -> Option<Self> {
        let font = FontRef::new(FONT).ok()?;
        let (size, location) = (Size::unscaled(), LocationRef::default());
        let whole = font.metrics(size, location);
        let unit = 1.0 / f32::from(whole.units_per_em.max(1));
        Some(Self {
            characters: font.charmap(),
            metrics: font.glyph_metrics(size, location),
            unit,
            outlines: font.outline_glyphs(),
            // What the fonts have, in case that they do not say so.
            cap_height: whole.cap_height.map_or(0.73, |height| height * unit),
        })
    }
}

impl Face<'_> {
    /// Height of capital letters for one pixel per em.
    pub(crate) fn cap_height(&self) -> f32 {
        self.cap_height
    }

    /// Width of a text for one pixel per em.
    pub(crate) fn width(&self, text: &str) -> f32 {
        text.chars().map(|c| self.advance(c)).sum()
    }

    /// Outlines of the glyphs of a text, side by side. The baseline starts at the origin, x points right and y down.
    ///
    /// `hinted` fits the letters to whole rows of pixels, for text that is not turned. `is_visible` is asked with the place
    /// and the width of each glyph: text may be far longer than a picture is wide.
    pub(crate) fn path(
        &self,
        text: &str,
        size: f32,
        hinted: bool,
        is_visible: impl Fn(f32, f32) -> bool,
    ) -> Option<Path> {
        let hinting = if hinted { self.hinting(size) } else { None };
        let mut pen = Pen::default();
        for c in text.chars() {
            let advance = self.advance(c) * size;
            if advance > 0.0 && !is_visible(pen.x, advance) {
                pen.x += advance;
                continue;
            }
            if let Some(glyph) = self.glyph(c).and_then(|id| self.outlines.get(id)) {
                let settings = match &hinting {
                    Some(hinting) => DrawSettings::hinted(hinting, false),
                    None => DrawSettings::unhinted(Size::new(size), LocationRef::default()),
                };
                // A glyph that cannot be read stays blank.
                let _ = glyph.draw(settings, &mut pen);
            }
            pen.x += advance;
        }
        pen.path.finish()
    }

    /// Fits letters to rows only: widths and places stay what they are.
    fn hinting(&self, size: f32) -> Option<HintingInstance> {
        let target =
            Target::Smooth { mode: SmoothMode::Light, symmetric_rendering: false, preserve_linear_metrics: true };
        let options = HintingOptions { engine: Engine::Auto(None), target };
        HintingInstance::new(&self.outlines, Size::new(size), LocationRef::default(), options).ok()
    }

    /// Width of a character for one pixel per em.
    fn advance(&self, c: char) -> f32 {
        self.glyph(c).and_then(|glyph| self.metrics.advance_width(glyph)).unwrap_or(0.0) * self.unit
    }

    /// The glyph of a character: the font's box where it has none, nothing for control characters.
    fn glyph(&self, c: char) -> Option<GlyphId> {
        (!c.is_control()).then(|| self.characters.map(c).unwrap_or(GlyphId::NOTDEF))
    }
}

/// Takes outlines with y up and puts them beside one another with y down.
#[derive(Default)]
struct Pen {
    path: PathBuilder,
    x: f32,
}

impl OutlinePen for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.path.move_to(self.x + x, -y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.path.line_to(self.x + x, -y);
    }

    fn quad_to(&mut self, cx: f32, cy: f32, x: f32, y: f32) {
        self.path.quad_to(self.x + cx, -cy, self.x + x, -y);
    }

    fn curve_to(&mut self, ax: f32, ay: f32, bx: f32, by: f32, x: f32, y: f32) {
        self.path.cubic_to(self.x + ax, -ay, self.x + bx, -by, self.x + x, -y);
    }

    fn close(&mut self) {
        self.path.close();
    }
}
