//! APNG: only what has changed since the last frame is stored.

use std::io::Write;

use png::{BitDepth, ColorType, DeflateCompression, Encoder, EncodingError, Filter, Writer};

use super::Area;
use crate::error::PictureError;
use crate::picture::Picture;

/// Writes frames into a PNG file.
pub(super) struct ApngWriter<W: Write> {
    size: [u32; 2],
    frames: u32,
    delay_ms: u16,
    is_transparent: bool,
    state: State<W>,
}

enum State<W: Write> {
    /// The colour type is open yet.
    Waiting(W),
    /// With the bytes of the last frame.
    Writing(Box<Writer<W>>, Vec<u8>),
    /// After an error.
    Failed,
}

impl<W: Write> ApngWriter<W> {
    pub(super) fn new(size: [u32; 2], frames: u32, delay_ms: u16, out: W) -> Self {
        Self { size, frames, delay_ms, is_transparent: false, state: State::Waiting(out) }
    }

    pub(super) fn learn(&mut self, sample: &Picture) {
        if matches!(self.state, State::Waiting(_)) {
            self.is_transparent |= !sample.is_opaque();
        }
    }

    /// In a file without an alpha channel, what is transparent in a later frame is drawn on black.
    pub(super) fn frame(&mut self, picture: &Picture) -> Result<(), PictureError> {
        self.learn(picture);
        let pixels = self.bytes_of(picture);
        match std::mem::replace(&mut self.state, State::Failed) {
            State::Waiting(out) => {
                let mut writer = self.start(out).map_err(problem)?;
                writer.write_image_data(&pixels).map_err(problem)?;
                self.state = State::Writing(Box::new(writer), pixels);
            }
            State::Writing(mut writer, old) => {
                let bytes = if self.is_transparent { 4 } else { 3 };
                let area = Area::of_change(&old, &pixels, self.size, bytes);
                let part: Vec<u8> = area.rows(&pixels, self.size[0], bytes).flatten().copied().collect();
                write_part(&mut writer, area, &part).map_err(problem)?;
                self.state = State::Writing(writer, pixels);
            }
            State::Failed => return Err(failed()),
        }
        Ok(())
    }

    pub(super) fn finish(self) -> Result<(), PictureError> {
        match self.state {
            State::Writing(writer, _) => writer.finish().map_err(problem),
            State::Waiting(_) | State::Failed => Err(failed()),
        }
    }

    fn start(&self, out: W) -> Result<Writer<W>, EncodingError> {
        let mut encoder = Encoder::new(out, self.size[0], self.size[1]);
        encoder.set_color(if self.is_transparent { ColorType::Rgba } else { ColorType::Rgb });
        encoder.set_depth(BitDepth::Eight);
        encoder.set_deflate_compression(DeflateCompression::Level(4));
        encoder.set_filter(Filter::Adaptive);
        encoder.set_animated(self.frames, 0)?;
        encoder.set_frame_delay(self.delay_ms, 1000)?;
        encoder.write_header()
    }

    fn bytes_of(&self, picture: &Picture) -> Vec<u8> {
        if self.is_transparent {
            picture.pixels.clone()
        } else if picture.is_opaque() {
            picture.rgb()
        } else {
            let mut ground = Picture::filled(picture.width, picture.height, [0, 0, 0, 255]);
            ground.paste(picture, 0, 0);
            ground.rgb()
        }
    }
}

/// Replaces an area of the last frame.
fn write_part<W: Write>(writer: &mut Writer<W>, area: Area, part: &[u8]) -> Result<(), EncodingError> {
    // The place must fit the size at every step.
    writer.set_frame_position(0, 0)?;
    writer.set_frame_dimension(area.width as u32, area.height as u32)?;
    writer.set_frame_position(area.left as u32, area.top as u32)?;
    writer.write_image_data(part)
}

fn problem(error: EncodingError) -> PictureError {
    match error {
        EncodingError::IoError(error) => PictureError::Io(error),
        other => PictureError::Encode { format: "APNG", message: other.to_string() },
    }
}

fn failed() -> PictureError {
    PictureError::Encode { format: "APNG", message: "an earlier frame could not be written".to_owned() }
}
