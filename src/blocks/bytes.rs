//! Numbers in the files of a plan: little-endian, one after another.

use std::io::{self, Read};

use planecut_kernel::DVec3;

/// Bytes that grow.
#[derive(Debug, Default)]
pub(super) struct Bytes(pub(super) Vec<u8>);

impl Bytes {
    pub(super) fn u8(&mut self, value: u8) {
        self.0.push(value);
    }

    pub(super) fn u32(&mut self, value: u32) {
        self.0.extend(value.to_le_bytes());
    }

    pub(super) fn f64(&mut self, value: f64) {
        self.0.extend(value.to_le_bytes());
    }

    pub(super) fn point(&mut self, point: DVec3) {
        point.to_array().into_iter().for_each(|value| self.f64(value));
    }

    /// A text, its length before it.
    pub(super) fn text(&mut self, text: &[u8]) {
        self.u32(u32::try_from(text.len()).expect("a short text"));
        self.0.extend(text);
    }
}

fn array<const N: usize>(from: &mut impl Read) -> io::Result<[u8; N]> {
    let mut bytes = [0; N];
    from.read_exact(&mut bytes)?;
    Ok(bytes)
}

pub(super) fn u8(from: &mut impl Read) -> io::Result<u8> {
    Ok(array::<1>(from)?[0])
}

pub(super) fn u32(from: &mut impl Read) -> io::Result<u32> {
    array(from).map(u32::from_le_bytes)
}

pub(super) fn u64(from: &mut impl Read) -> io::Result<u64> {
    array(from).map(u64::from_le_bytes)
}

pub(super) fn f64(from: &mut impl Read) -> io::Result<f64> {
    array(from).map(f64::from_le_bytes)
}

pub(super) fn point(from: &mut impl Read) -> io::Result<DVec3> {
    Ok(DVec3::new(f64(from)?, f64(from)?, f64(from)?))
}

/// Most bytes of a text.
const MAX_TEXT: u32 = 1 << 28;

pub(super) fn text(from: &mut impl Read) -> io::Result<Vec<u8>> {
    let length = u32(from)?;
    if length > MAX_TEXT {
        return Err(damaged());
    }
    let mut text = Vec::new();
    from.take(u64::from(length)).read_to_end(&mut text)?;
    if text.len() < length as usize { Err(io::ErrorKind::UnexpectedEof.into()) } else { Ok(text) }
}

/// The error of bytes that say nothing.
pub(super) fn damaged() -> io::Error {
    io::ErrorKind::InvalidData.into()
}
