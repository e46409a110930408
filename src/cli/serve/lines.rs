//! Lines of bounded length.

use std::io::{self, BufRead, Read};

/// Maximum number of bytes of a line, without its end.
pub(super) const LIMIT: usize = 1 << 26;

/// A line that was read.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Line {
    /// Its bytes, without the end of the line.
    Text(Vec<u8>),
    /// It has too many, and was passed over.
    TooLong,
}

/// The lines of an input; none of them takes more memory than the limit.
pub(super) struct Lines<R> {
    input: R,
    limit: usize,
}

impl<R: BufRead> Lines<R> {
    pub(super) fn new(input: R) -> Self {
        Self { input, limit: LIMIT }
    }

    fn read(&mut self) -> io::Result<Option<Line>> {
        let mut text = Vec::new();
        let most = self.limit as u64 + 1;
        self.input.by_ref().take(most).read_until(b'\n', &mut text)?;
        if text.is_empty() {
            return Ok(None);
        }
        if text.last() == Some(&b'\n') {
            text.pop();
        } else if text.len() > self.limit {
            self.pass_over()?;
            return Ok(Some(Line::TooLong));
        }
        Ok(Some(Line::Text(text)))
    }

    /// Reads what is left of a line.
    fn pass_over(&mut self) -> io::Result<()> {
        loop {
            let rest = self.input.fill_buf()?;
            let end = rest.iter().position(|byte| *byte == b'\n');
            let count = end.map_or(rest.len(), |end| end + 1);
            self.input.consume(count);
            if end.is_some() || count == 0 {
                return Ok(());
            }
        }
    }
}

impl<R: BufRead> Iterator for Lines<R> {
    type Item = io::Result<Line>;

    fn next(&mut self) -> Option<Self::Item> {
        self.read().transpose()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_end_with_the_input_and_long_ones_are_passed_over() {
        let text = b"ab\n\n1234\n12345\n1234567890\nc\xff\n12345678";
        let lines = Lines { input: io::BufReader::with_capacity(3, &text[..]), limit: 4 };
        let found: Vec<Line> = lines.map(|line| line.expect("it is in memory")).collect();
        let text = |bytes: &[u8]| Line::Text(bytes.to_vec());
        let expected =
            [text(b"ab"), text(b""), text(b"1234"), Line::TooLong, Line::TooLong, text(b"c\xff"), Line::TooLong];
        assert_eq!(found, expected);
    }
}
