//! GIF: frames of 255 colours, of which only what has changed is stored.

use std::borrow::Cow;
use std::io::Write;

use gif::{DisposalMethod, Encoder, EncodingError, Frame, Repeat};

use super::Area;
use super::palette::{Histogram, Palette};
use crate::error::PictureError;
use crate::picture::Picture;

/// Shortest time of a frame in hundredths of a second: viewers take less for a mistake and show frames for a tenth.
const LEAST_DELAY: u64 = 2;

/// Writes frames into a GIF file.
///
/// One palette serves as long as it suits, so that colours that stay do not flicker. A frame is held back until the next
/// one is known: how it gives way depends on whether that one has transparent pixels.
pub(super) struct GifWriter<W: Write> {
    size: [u32; 2],
    delay_ms: u16,
    /// How many frames have been taken.
    count: u64,
    /// Colours of all that was seen.
    histogram: Histogram,
    palette: Option<Palette>,
    /// How many palettes there were before.
    palette_number: usize,
    /// Not yet written.
    held: Option<Held>,
    /// Palette number and indices of what a viewer shows before the frame that is held; `None` for nothing.
    shown: Option<(usize, Vec<u8>)>,
    /// Whether the first frame has transparent pixels: the last gives way to it.
    begins_clear: bool,
    out: Out<W>,
}

enum Out<W: Write> {
    /// The palette is open yet.
    Waiting(W),
    Writing(Encoder<W>),
    /// After an error.
    Failed,
}

/// A frame with its colours.
struct Held {
    indices: Vec<u8>,
    delay: u16,
    palette_number: usize,
    /// The colours, where they are not those of the file.
    colors: Option<Vec<u8>>,
    /// The index of transparent pixels.
    clear: u8,
}

impl<W: Write> GifWriter<W> {
    pub(super) fn new(size: [u32; 2], delay_ms: u16, out: W) -> Self {
        Self {
            size,
            delay_ms,
            count: 0,
            histogram: Histogram::default(),
            palette: None,
            palette_number: 0,
            held: None,
            shown: None,
            begins_clear: false,
            out: Out::Waiting(out),
        }
    }

    pub(super) fn learn(&mut self, sample: &Picture) {
        if self.palette.is_none() {
            self.histogram.add(sample);
        }
    }

    pub(super) fn frame(&mut self, picture: &Picture) -> Result<(), PictureError> {
        self.histogram.add(picture);
        let histogram = &self.histogram;
        let palette = self.palette.get_or_insert_with(|| histogram.palette());
        if let Out::Waiting(_) = self.out
            && let Out::Waiting(out) = std::mem::replace(&mut self.out, Out::Failed)
        {
            self.out = Out::Writing(start(out, self.size, palette.colors()).map_err(problem)?);
        }
        let mut matched = palette.matched(picture);
        if !matched.suits {
            *palette = histogram.palette();
            self.palette_number += 1;
            matched = palette.matched(picture);
        }
        let clear = palette.clear();
        let held = Held {
            indices: matched.indices,
            delay: delay(self.count, self.delay_ms),
            palette_number: self.palette_number,
            colors: (self.palette_number > 0).then(|| palette.colors().to_vec()),
            clear,
        };
        let is_clear = held.indices.contains(&clear);
        if self.count == 0 {
            self.begins_clear = is_clear;
        }
        self.count += 1;
        self.write_held(is_clear)?;
        self.held = Some(held);
        Ok(())
    }

    pub(super) fn finish(mut self) -> Result<(), PictureError> {
        self.write_held(self.begins_clear)?;
        let Out::Writing(encoder) = self.out else { return Err(failed()) };
        let mut out = encoder.into_inner().map_err(problem)?;
        out.flush()?;
        Ok(())
    }

    /// Writes the frame that is held, to be wiped away before the next one if that has transparent pixels.
    fn write_held(&mut self, gives_way: bool) -> Result<(), PictureError> {
        let Some(held) = self.held.take() else { return Ok(()) };
        let (mut area, mut buffer) = (Area::whole(self.size), Cow::Borrowed(&held.indices));
        // A frame with transparent pixels starts from nothing: the one before it gave way.
        if let Some((number, shown)) = &self.shown
            && *number == held.palette_number
        {
            if !gives_way {
                // Only its own area of a frame is wiped away, so one that gives way must cover all.
                area = Area::of_change(shown, &held.indices, self.size, 1);
            }
            // Long runs of "as before" are short in the file.
            let (old, new) = (area.rows(shown, self.size[0], 1), area.rows(&held.indices, self.size[0], 1));
            let pixels = old.flatten().zip(new.flatten());
            buffer = Cow::Owned(pixels.map(|(old, new)| if old == new { held.clear } else { *new }).collect());
        }
        let frame = Frame {
            delay: held.delay,
            dispose: if gives_way { DisposalMethod::Background } else { DisposalMethod::Keep },
            transparent: Some(held.clear),
            left: area.left as u16,
            top: area.top as u16,
            width: area.width as u16,
            height: area.height as u16,
            palette: held.colors.clone(),
            buffer: Cow::Borrowed(&buffer),
            ..Frame::default()
        };
        let Out::Writing(encoder) = &mut self.out else { return Err(failed()) };
        if let Err(error) = encoder.write_frame(&frame) {
            self.out = Out::Failed;
            return Err(problem(error));
        }
        self.shown = (!gives_way).then_some((held.palette_number, held.indices));
        Ok(())
    }
}

fn start<W: Write>(out: W, [width, height]: [u32; 2], colors: &[u8]) -> Result<Encoder<W>, EncodingError> {
    // Sides are checked to be less than 2¹⁶.
    let mut encoder = Encoder::new(out, width as u16, height as u16, colors)?;
    encoder.set_repeat(Repeat::Infinite)?;
    Ok(encoder)
}

/// Hundredths of a second for a frame. Rounding errors do not add up: a frame ends where it should, to half a step.
fn delay(frame: u64, delay_ms: u16) -> u16 {
    let end = |frames: u64| (frames * u64::from(delay_ms) + 5) / 10;
    (end(frame + 1) - end(frame)).max(LEAST_DELAY) as u16
}

fn problem(error: EncodingError) -> PictureError {
    match error {
        EncodingError::Io(error) => PictureError::Io(error),
        other => PictureError::Encode { format: "GIF", message: other.to_string() },
    }
}

fn failed() -> PictureError {
    PictureError::Encode { format: "GIF", message: "an earlier frame could not be written".to_owned() }
}
