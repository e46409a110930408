//! The header of a PLY file.

use super::super::error::{Fault, Place, quoted};
use super::super::text::Words;
use super::body::Body;

/// How the body is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// The type of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn from_name(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    /// Length in bytes.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

/// One value, or list of values, of each record.
#[derive(Debug)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) scalar: Scalar,
    /// The type of the length, where this is a list.
    pub(super) list_length: Option<Scalar>,
}

/// A table of records.
#[derive(Debug)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: usize,
    pub(super) properties: Vec<Property>,
}

impl Element {
    /// Least number of bytes that a record takes; in text one digit per number.
    pub(super) fn least_size(&self, encoding: Encoding) -> usize {
        let size = |p: &Property| match encoding {
            Encoding::Ascii => 1,
            Encoding::LittleEndian | Encoding::BigEndian => p.list_length.unwrap_or(p.scalar).size(),
        };
        self.properties.iter().map(size).sum()
    }
}

/// What the header says.
#[derive(Debug)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
}

/// Reads the header; the body starts after it.
pub(super) fn read(bytes: &[u8]) -> Result<(Header, Body<'_>), Fault> {
    let mut lines = Lines { bytes, offset: 0, number: 0 };
    if lines.next() != Some(b"ply") {
        return Err(Fault::new(Place::Line(1), quoted(&bytes[..bytes.len().min(3)]), "`ply`"));
    }
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    loop {
        let Some(line) = lines.next() else {
            return Err(Fault::new(Place::Line(lines.number), "the end of the file", "`end_header`"));
        };
        let place = || Place::Line(lines.number);
        let mut words = Words::new(line, lines.number);
        match words.next() {
            Some(b"format") => encoding = Some(read_encoding(words.next().unwrap_or_default(), place())?),
            Some(b"element") => elements.push(read_element(&mut words, place())?),
            Some(b"property") => {
                let property = read_property(&mut words, &place())?;
                let element = elements.last_mut();
                let no_element = || Fault::new(place(), "`property` first", "`element` before it");
                element.ok_or_else(no_element)?.properties.push(property);
            }
            Some(b"end_header") => break,
            Some(b"comment" | b"obj_info") | None => {}
            Some(word) => {
                return Err(Fault::new(place(), quoted(word), "`element`, `property`, `comment` or `end_header`"));
            }
        }
    }
    let encoding = encoding.ok_or_else(|| Fault::whole("no `format` in the header", "one"))?;
    Ok((Header { encoding, elements }, Body::new(bytes, lines.offset, lines.number + 1, encoding)))
}

/// The lines of the header: a binary body after it need not be text.
struct Lines<'a> {
    bytes: &'a [u8],
    /// Where the next line starts.
    offset: usize,
    /// The number of the last line.
    number: usize,
}

impl<'a> Lines<'a> {
    fn next(&mut self) -> Option<&'a [u8]> {
        let rest = &self.bytes[self.offset..];
        let end = rest.iter().position(|&b| b == b'\n')?;
        self.offset += end + 1;
        self.number += 1;
        Some(rest[..end].trim_ascii_end())
    }
}

fn read_encoding(word: &[u8], place: Place) -> Result<Encoding, Fault> {
    match word {
        b"ascii" => Ok(Encoding::Ascii),
        b"binary_little_endian" => Ok(Encoding::LittleEndian),
        b"binary_big_endian" => Ok(Encoding::BigEndian),
        _ => Err(Fault::new(place, quoted(word), "`ascii`, `binary_little_endian` or `binary_big_endian`")),
    }
}

fn read_element(words: &mut Words<'_>, place: Place) -> Result<Element, Fault> {
    let name = name(words);
    let word = words.next().unwrap_or_default();
    let count = std::str::from_utf8(word).ok().and_then(|text| text.parse().ok());
    let count = count.ok_or_else(|| Fault::new(place, quoted(word), "the number of records"))?;
    Ok(Element { name, count, properties: Vec::new() })
}

fn read_property(words: &mut Words<'_>, place: &Place) -> Result<Property, Fault> {
    let scalar = |word: Option<&[u8]>| {
        let word = word.unwrap_or_default();
        Scalar::from_name(word).ok_or_else(|| Fault::new(place.clone(), quoted(word), "a number type such as `float`"))
    };
    let first = words.next();
    if first == Some(b"list") {
        let list_length = Some(scalar(words.next())?);
        let scalar = scalar(words.next())?;
        return Ok(Property { name: name(words), scalar, list_length });
    }
    let scalar = scalar(first)?;
    Ok(Property { name: name(words), scalar, list_length: None })
}

fn name(words: &mut Words<'_>) -> String {
    String::from_utf8_lossy(words.next().unwrap_or_default()).into_owned()
}
