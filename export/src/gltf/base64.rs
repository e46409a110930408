//! Base64 (RFC 4648, with padding), for embedded buffers.

use std::io::{self, Write};

const ALPHABET: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Writes what it is given as Base64.
pub(super) struct Base64Writer<'a> {
    out: &'a mut dyn Write,
    /// What is waiting for a third byte.
    waiting: [u8; 3],
    count: usize,
}

impl<'a> Base64Writer<'a> {
    pub(super) fn new(out: &'a mut dyn Write) -> Self {
        Self { out, waiting: [0; 3], count: 0 }
    }

    /// Writes what is left.
    pub(super) fn finish(mut self) -> io::Result<()> {
        if self.count == 0 { Ok(()) } else { self.write_waiting() }
    }

    fn write_waiting(&mut self) -> io::Result<()> {
        let [a, b, c] = self.waiting.map(u32::from);
        let bits = a << 16 | b << 8 | c;
        // n bytes fill n + 1 digits; the rest is padding
        let digit = |place: usize| match place <= self.count {
            true => ALPHABET[(bits >> (18 - 6 * place)) as usize & 63],
            false => b'=',
        };
        self.out.write_all(&[0, 1, 2, 3].map(digit))?;
        (self.waiting, self.count) = ([0; 3], 0);
        Ok(())
    }
}

impl Write for Base64Writer<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        for byte in bytes {
            self.waiting[self.count] = *byte;
            self.count += 1;
            if self.count == 3 {
                self.write_waiting()?;
            }
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_vectors_of_rfc_4648() {
        let vectors =
            [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foob", "Zm9vYg=="), ("fooba", "Zm9vYmE=")];
        for (plain, coded) in vectors {
            for pieces in [1, 2, 5] {
                let mut text = Vec::new();
                let mut writer = Base64Writer::new(&mut text);
                plain.as_bytes().chunks(pieces).try_for_each(|piece| writer.write_all(piece)).expect("written");
                writer.finish().expect("written");
                assert_eq!(String::from_utf8(text).expect("ASCII"), coded);
            }
        }
    }
}
