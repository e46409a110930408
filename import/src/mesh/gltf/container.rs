//! The binary container (GLB) around a glTF document.
//!
//! The crate `gltf` reads it, too, but panics on a length below that of the header, and refuses chunks of unknown types, which the specification says to
//! pass over.

use super::super::error::{Fault, Place, quoted};

/// First bytes of the container.
const MAGIC: &[u8] = b"glTF";
/// The container's version; the document's own is 2.0 as well.
const VERSION: u32 = 2;
/// Magic, version, length of the file.
const HEADER: usize = 12;
/// Length and type of a chunk.
const CHUNK_HEADER: usize = 8;
/// Type of the chunk with the document, `JSON`.
const JSON: u32 = 0x4e4f_534a;
/// Type of the chunk with the buffer, `BIN`.
const BIN: u32 = 0x004e_4942;

/// The JSON document and the binary chunk, if there is one. Bytes without the container's magic are taken as JSON.
pub(super) fn split(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), Fault> {
    if !bytes.starts_with(MAGIC) {
        return Ok((bytes, None));
    }
    let version = word(bytes, 4)?;
    if version != VERSION {
        return Err(Fault::new(Place::Byte(4), format!("container version {version}"), format!("{VERSION}")));
    }
    let length = word(bytes, 8)? as usize;
    if length > bytes.len() || length < HEADER {
        return Err(Fault::new(Place::Byte(8), format!("a file of {} bytes", bytes.len()), format!("{length}")));
    }
    let (json, after) = chunk(&bytes[..length], HEADER)?;
    let Some(json) = json.of_kind(JSON) else {
        let found = quoted(&bytes[HEADER + 4..HEADER + CHUNK_HEADER]);
        return Err(Fault::new(Place::Byte(HEADER + 4), found, "the type `JSON` of the first chunk"));
    };
    let binary = if after < length { chunk(&bytes[..length], after)?.0.of_kind(BIN) } else { None };
    Ok((json, binary))
}

struct Chunk<'a> {
    kind: u32,
    data: &'a [u8],
}

impl<'a> Chunk<'a> {
    fn of_kind(self, kind: u32) -> Option<&'a [u8]> {
        (self.kind == kind).then_some(self.data)
    }
}

/// The chunk at an offset, and where the next one starts.
fn chunk(bytes: &[u8], offset: usize) -> Result<(Chunk<'_>, usize), Fault> {
    let length = word(bytes, offset)? as usize;
    let kind = word(bytes, offset + 4)?;
    let rest = &bytes[offset + CHUNK_HEADER..];
    let data = rest.get(..length).ok_or_else(|| {
        Fault::new(Place::Byte(offset), format!("a chunk of {length} bytes"), format!("at most {}", rest.len()))
    })?;
    Ok((Chunk { kind, data }, offset + CHUNK_HEADER + length))
}

/// The little-endian number at an offset.
fn word(bytes: &[u8], offset: usize) -> Result<u32, Fault> {
    let here = bytes.get(offset..).and_then(<[u8]>::first_chunk).map(|b| u32::from_le_bytes(*b));
    here.ok_or_else(|| Fault::new(Place::Byte(bytes.len()), "the end of the file", "four bytes more"))
}
