//! A text of any length, of which a part is in memory.

use std::io::{self, Read};

use super::token::{COMMENTS, is_blank};
use crate::lines::LineTable;
use crate::source::{MAX_TEXT, without_byte_order_mark};

/// Least size of a window: all that decides about one byte is in it.
const LEAST: usize = 16;

/// The part of a text that is in memory, and what is known of the text before it.
pub(super) struct Window<R> {
    reader: R,
    text: Vec<u8>,
    /// What comes before this place in the window is done with.
    at: usize,
    /// How much text is there, unless one piece of it needs more.
    size: usize,
    /// Whether the end of the text is in the window.
    is_whole: bool,
    /// Whether what is done with ends within a comment.
    in_comment: bool,
    lines: LineTable,
    /// Lines that end before the window.
    lines_before: u64,
    /// Whether the last byte before the window is a CR.
    after_return: bool,
    /// The last line before the window that holds something, or 1.
    last_line: u32,
    /// How many bytes were read.
    read: u64,
    /// The most text that was there at once.
    #[cfg(test)]
    largest: usize,
}

impl<R: Read> Window<R> {
    /// A window of this size at the beginning of what `reader` gives, with nothing in it yet.
    pub(super) fn new(reader: R, size: usize) -> Self {
        Self {
            reader,
            text: Vec::new(),
            at: 0,
            size: size.max(LEAST),
            is_whole: false,
            in_comment: false,
            lines: LineTable::new(b""),
            lines_before: 0,
            after_return: false,
            last_line: 1,
            read: 0,
            #[cfg(test)]
            largest: 0,
        }
    }

    /// The text in the window that is not done with.
    pub(super) fn rest(&self) -> &[u8] {
        &self.text[self.at..]
    }

    /// Whether that is all that is left.
    pub(super) fn is_whole(&self) -> bool {
        self.is_whole
    }

    /// How many bytes were read.
    pub(super) fn bytes_read(&self) -> u64 {
        self.read
    }

    /// The most text that was in memory at once, and for how much there is room now.
    #[cfg(test)]
    pub(super) fn sizes(&self) -> (usize, usize) {
        (self.largest, self.text.capacity())
    }

    /// The line, in the whole text, of an offset in the [`rest`](Self::rest).
    pub(super) fn line_of(&self, offset: usize) -> u32 {
        self.line_at(self.at + offset)
    }

    /// The last line before the [`rest`](Self::rest) that holds something, or 1.
    pub(super) fn line_before(&self) -> u32 {
        match self.text[..self.at].trim_ascii_end().len() {
            0 => self.last_line,
            end => self.line_at(end - 1),
        }
    }

    fn line_at(&self, place: usize) -> u32 {
        let line = self.lines_before + u64::from(self.lines.line_of(place));
        u32::try_from(line).unwrap_or(u32::MAX)
    }

    /// So many bytes of the rest are done with.
    pub(super) fn advance(&mut self, length: usize) {
        self.at += length;
    }

    /// Is done with white space and comments, also with those that go on after the window.
    pub(super) fn skip_blank(&mut self) {
        loop {
            let rest = &self.text[self.at..];
            if self.in_comment {
                let end = rest.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
                self.at += end.unwrap_or(rest.len());
                self.in_comment = end.is_none();
                if self.in_comment {
                    return;
                }
            } else {
                let blanks = rest.iter().position(|byte| !is_blank(*byte)).unwrap_or(rest.len());
                self.in_comment = COMMENTS.iter().any(|mark| rest[blanks..].starts_with(mark));
                self.at += blanks;
                if !self.in_comment {
                    return;
                }
            }
        }
    }

    /// Lets go of what is done with, and reads on; what is not done with was not enough.
    ///
    /// # Errors
    /// What the reader says; [`io::ErrorKind::FileTooLarge`] where the rest is as long as a whole text may be.
    pub(super) fn fill(&mut self) -> io::Result<()> {
        self.let_go();
        let length = self.text.len();
        if length >= MAX_TEXT {
            return Err(io::ErrorKind::FileTooLarge.into());
        }
        // at least twice as much as was not enough, so that all of it is looked at a few times only
        let more = self.size.max(2 * length).min(MAX_TEXT) - length;
        self.text.try_reserve_exact(more)?;
        let result = (&mut self.reader).take(more as u64).read_to_end(&mut self.text);
        let (is_first, count) = (self.read == 0, self.text.len() - length);
        self.read += count as u64;
        self.is_whole = result? < more;
        if is_first {
            self.at = count - without_byte_order_mark(&self.text).len();
        }
        // a CR counted as the end of a line only to be followed by its LF
        if length == 0 && self.after_return && self.text.first() == Some(&b'\n') {
            self.lines_before -= 1;
        }
        #[cfg(test)]
        {
            self.largest = self.largest.max(self.text.len());
        }
        self.lines = LineTable::new(&self.text);
        Ok(())
    }

    fn let_go(&mut self) {
        self.last_line = self.line_before();
        self.lines_before += u64::from(self.lines.line_of(self.at)) - 1;
        if let Some(last) = self.at.checked_sub(1) {
            self.after_return = self.text[last] == b'\r';
        }
        self.text.drain(..self.at);
        self.at = 0;
        self.text.shrink_to(self.size.max(self.text.len()));
    }
}
