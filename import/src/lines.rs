//! From byte offsets to line numbers.

/// Where each line of a text begins. Lines end with LF, CR LF, or a CR alone.
pub(crate) struct LineTable {
    /// Offset of the first byte of each line, ascending; the first entry is 0.
    starts: Vec<usize>,
}

impl LineTable {
    /// The table of `text`.
    pub(crate) fn new(text: &[u8]) -> Self {
        let ends_line = |i: usize| text[i] == b'\n' || (text[i] == b'\r' && text.get(i + 1) != Some(&b'\n'));
        let starts = std::iter::once(0).chain((0..text.len()).filter(|&i| ends_line(i)).map(|i| i + 1)).collect();
        Self { starts }
    }

    /// The line of the byte at `offset`, counted from 1.
    pub(crate) fn line_of(&self, offset: usize) -> u32 {
        let line = self.starts.partition_point(|&start| start <= offset);
        u32::try_from(line).unwrap_or(u32::MAX)
    }
}

#[cfg(test)]
mod tests {
    use super::LineTable;

    #[test]
    fn every_kind_of_line_end_counts_once() {
        let text = b"a\nb\r\nc\rd\n\ne";
        let table = LineTable::new(text);
        let line_of = |byte: u8| table.line_of(text.iter().position(|&b| b == byte).expect("in the text"));
        assert_eq!([b'a', b'b', b'c', b'd', b'e'].map(line_of), [1, 2, 3, 4, 6]);
        assert_eq!(table.line_of(text.len()), 6);
    }

    #[test]
    fn empty_text_has_one_line() {
        assert_eq!(LineTable::new(b"").line_of(0), 1);
    }
}
