//! Several pictures one after another in one file, again and again.

mod apng;
mod frames;
mod palette;

use std::io::Write;
use std::path::Path;

use self::apng::ApngWriter;
use self::frames::GifWriter;
use crate::error::PictureError;
use crate::picture::{Picture, check_size};

/// A format that moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum AnimationFormat {
    /// Understood everywhere: 255 colours, each pixel transparent or not, times in hundredths of a second.
    Gif,
    /// A PNG file with more pictures in it: all colours and grades of transparency.
    Apng,
}

impl AnimationFormat {
    /// Every format.
    pub const ALL: [Self; 2] = [Self::Gif, Self::Apng];

    /// The ending of file names, without the dot.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Gif => "gif",
            Self::Apng => "apng",
        }
    }

    /// The format with this file name ending, given without the dot and in any case.
    ///
    /// # Errors
    /// [`PictureError::UnknownAnimationFormat`] for any other ending.
    pub fn from_extension(extension: &str) -> Result<Self, PictureError> {
        Self::ALL
            .into_iter()
            .find(|format| format.extension().eq_ignore_ascii_case(extension))
            .ok_or_else(|| PictureError::UnknownAnimationFormat { extension: extension.to_owned() })
    }

    /// The format that a file name asks for by its ending.
    ///
    /// # Errors
    /// [`PictureError::UnknownAnimationFormat`] when the name has no ending or another one.
    pub fn from_path(path: &Path) -> Result<Self, PictureError> {
        Self::from_extension(&path.extension().unwrap_or_default().to_string_lossy())
    }
}

/// Writes an animation frame by frame, so that only one or two frames need to be in memory.
///
/// The same frames give the same bytes. A writer that is dropped before [`Self::finish`] leaves an incomplete file.
pub struct AnimationWriter<W: Write> {
    size: [u32; 2],
    frames: u32,
    written: u32,
    writer: FormatWriter<W>,
}

enum FormatWriter<W: Write> {
    Gif(Box<GifWriter<W>>),
    Apng(Box<ApngWriter<W>>),
}

impl<W: Write> AnimationWriter<W> {
    /// A writer of `frames` pictures, each shown for `delay_ms` thousandths of a second (GIF: no less than 20).
    ///
    /// # Errors
    /// [`PictureError::ImageSize`], [`PictureError::FrameCount`] for no frames at all.
    pub fn new(
        format: AnimationFormat,
        width: u32,
        height: u32,
        frames: u32,
        delay_ms: u16,
        out: W,
    ) -> Result<Self, PictureError> {
        check_size([width, height])?;
        if frames == 0 {
            return Err(PictureError::FrameCount { found: 0, expected: 1 });
        }
        let size = [width, height];
        let writer = match format {
            AnimationFormat::Gif => FormatWriter::Gif(Box::new(GifWriter::new(size, delay_ms, out))),
            AnimationFormat::Apng => FormatWriter::Apng(Box::new(ApngWriter::new(size, frames, delay_ms, out))),
        };
        Ok(Self { size, frames, written: 0, writer })
    }

    /// Looks at a sample of what will come, of any size, before the first frame. Not required.
    ///
    /// A GIF gets colours that suit all samples and the first frame (frames that these do not suit get their own, which
    /// may be seen as a flicker); an APNG gets an alpha channel if any of them is transparent somewhere.
    pub fn learn(&mut self, sample: &Picture) {
        match &mut self.writer {
            FormatWriter::Gif(writer) => writer.learn(sample),
            FormatWriter::Apng(writer) => writer.learn(sample),
        }
    }

    /// Writes the next frame.
    ///
    /// # Errors
    /// [`PictureError::FrameSize`] for a picture of another size, [`PictureError::FrameCount`] for one too many,
    /// [`PictureError::Io`], [`PictureError::Encode`].
    pub fn frame(&mut self, picture: &Picture) -> Result<(), PictureError> {
        let Picture { width, height, .. } = *picture;
        if [width, height] != self.size || !picture.is_complete() {
            return Err(PictureError::FrameSize { found: [width, height], expected: self.size });
        }
        if self.written == self.frames {
            return Err(PictureError::FrameCount { found: self.written.saturating_add(1), expected: self.frames });
        }
        self.written += 1;
        match &mut self.writer {
            FormatWriter::Gif(writer) => writer.frame(picture),
            FormatWriter::Apng(writer) => writer.frame(picture),
        }
    }

    /// Writes the rest of the file.
    ///
    /// # Errors
    /// [`PictureError::FrameCount`] for too few frames, [`PictureError::Io`], [`PictureError::Encode`].
    pub fn finish(self) -> Result<(), PictureError> {
        if self.written != self.frames {
            return Err(PictureError::FrameCount { found: self.written, expected: self.frames });
        }
        match self.writer {
            FormatWriter::Gif(writer) => writer.finish(),
            FormatWriter::Apng(writer) => writer.finish(),
        }
    }
}

/// A rectangle of whole pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Area {
    left: usize,
    top: usize,
    width: usize,
    height: usize,
}

impl Area {
    /// All of a picture.
    fn whole([width, height]: [u32; 2]) -> Self {
        Self { left: 0, top: 0, width: width as usize, height: height as usize }
    }

    /// The least area that holds all pixels in which two pictures differ; the first pixel if there are none.
    fn of_change(old: &[u8], new: &[u8], size: [u32; 2], bytes_per_pixel: usize) -> Self {
        let row = size[0] as usize * bytes_per_pixel;
        let (mut left, mut right, mut top, mut bottom) = (row, 0, usize::MAX, 0);
        for (y, (old, new)) in old.chunks_exact(row).zip(new.chunks_exact(row)).enumerate() {
            let is_different = |(a, b): (&u8, &u8)| a != b;
            if let Some(first) = old.iter().zip(new).position(is_different) {
                let last = old.iter().zip(new).rposition(is_different).unwrap_or(first);
                (left, right) = (left.min(first), right.max(last));
                (top, bottom) = (top.min(y), y);
            }
        }
        if top == usize::MAX {
            return Self { left: 0, top: 0, width: 1, height: 1 };
        }
        let (left, right) = (left / bytes_per_pixel, right / bytes_per_pixel);
        Self { left, top, width: right - left + 1, height: bottom - top + 1 }
    }

    /// The rows of this area in a picture of some width.
    fn rows<'a>(&self, pixels: &'a [u8], width: u32, bytes_per_pixel: usize) -> impl Iterator<Item = &'a [u8]> {
        let columns = self.left * bytes_per_pixel..(self.left + self.width) * bytes_per_pixel;
        let rows = pixels.chunks_exact(width as usize * bytes_per_pixel);
        rows.skip(self.top).take(self.height).map(move |row| &row[columns.clone()])
    }
}

#[cfg(test)]
mod tests;
