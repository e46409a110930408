//! The numbers after the header of a PLY file.

use super::super::error::{Fault, Place};
use super::super::text::Words;
use super::header::{Encoding, Scalar};

/// What is left of a body.
pub(super) enum Body<'a> {
    Ascii(Words<'a>),
    Binary { rest: &'a [u8], offset: usize, big_endian: bool },
}

impl<'a> Body<'a> {
    /// The body that starts at `offset` of a file, on the given line.
    pub(super) fn new(file: &'a [u8], offset: usize, line: usize, encoding: Encoding) -> Self {
        let rest = &file[offset..];
        match encoding {
            Encoding::Ascii => Self::Ascii(Words::new(rest, line)),
            Encoding::LittleEndian => Self::Binary { rest, offset, big_endian: false },
            Encoding::BigEndian => Self::Binary { rest, offset, big_endian: true },
        }
    }

    pub(super) fn place(&self) -> Place {
        match self {
            Self::Ascii(words) => words.place(),
            Self::Binary { offset, .. } => Place::Byte(*offset),
        }
    }

    /// Number of bytes that are left.
    pub(super) fn remaining(&self) -> usize {
        match self {
            Self::Ascii(words) => words.remaining(),
            Self::Binary { rest, .. } => rest.len(),
        }
    }

    /// The next number. Text is taken as it stands, whatever the range and precision of its type.
    pub(super) fn scalar(&mut self, scalar: Scalar) -> Result<f64, Fault> {
        match self {
            Self::Ascii(words) => words.number(),
            Self::Binary { rest, offset, big_endian } => {
                let Some((bytes, after)) = rest.split_at_checked(scalar.size()) else {
                    let found = format!("{} bytes", rest.len());
                    return Err(Fault::new(Place::Byte(*offset), found, format!("{} for a number", scalar.size())));
                };
                let value = decode(bytes, scalar, *big_endian);
                *rest = after;
                *offset += bytes.len();
                Ok(value)
            }
        }
    }
}

/// A number of the given type from as many bytes as it has.
fn decode(bytes: &[u8], scalar: Scalar, big_endian: bool) -> f64 {
    // The number's bytes as the low bytes of a word, most significant first.
    let mut word = [0u8; 8];
    for (k, byte) in bytes.iter().enumerate() {
        word[if big_endian { 8 - bytes.len() + k } else { 7 - k }] = *byte;
    }
    let word = u64::from_be_bytes(word);
    match scalar {
        Scalar::I8 => f64::from(word as u8 as i8),
        Scalar::U8 => f64::from(word as u8),
        Scalar::I16 => f64::from(word as u16 as i16),
        Scalar::U16 => f64::from(word as u16),
        Scalar::I32 => f64::from(word as u32 as i32),
        Scalar::U32 => f64::from(word as u32),
        Scalar::F32 => f64::from(f32::from_bits(word as u32)),
        Scalar::F64 => f64::from_bits(word),
    }
}
