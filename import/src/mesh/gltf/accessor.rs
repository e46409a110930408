//! Numbers from the buffers of a glTF document.

use std::borrow::Cow;
use std::cell::{Cell, OnceCell};

use glam::DVec3;

use super::super::error::{Fault, Place, quoted};
use super::document::{Accessor, BufferView, Document, PackedView, Sparse};
use super::packed;

/// The embedded buffers.
pub(super) struct Buffers<'a> {
    document: &'a Document,
    data: Vec<Cow<'a, [u8]>>,
    /// For each view its bytes, where they were packed and have been asked for.
    unpacked: Vec<OnceCell<Vec<u8>>>,
    /// How many packed bytes may still be unpacked: no more than there are, or a small file could have the same ones unpacked any number of times.
    budget: Cell<usize>,
}

impl<'a> Buffers<'a> {
    /// Takes the first buffer from the container's binary chunk where it has no address, the others from data addresses.
    pub(super) fn new(document: &'a Document, binary: Option<&'a [u8]>) -> Result<Self, Fault> {
        let load = |(number, buffer): (usize, &'a super::document::Buffer)| {
            let place = || Place::Json(format!("buffers/{number}"));
            if buffer.extensions.packed.as_ref().is_some_and(|packed| packed.fallback) {
                return Ok(Cow::Borrowed(&[][..]));
            }
            match (&buffer.uri, binary) {
                (None, Some(binary)) if number == 0 => Ok(Cow::Borrowed(binary)),
                (None, _) => Err(Fault::new(place(), "a buffer without data", "a data address or a binary chunk")),
                (Some(uri), _) => decode_data_uri(uri).map(Cow::Owned).ok_or_else(|| {
                    Fault::new(place(), quoted(uri.as_bytes()), "an embedded buffer, `data:…;base64,…`")
                }),
            }
        };
        let data = document.buffers.iter().enumerate().map(load).collect::<Result<Vec<_>, _>>()?;
        let unpacked = document.buffer_views.iter().map(|_| OnceCell::new()).collect();
        let budget = Cell::new(data.iter().map(|data| data.len()).sum());
        Ok(Self { document, data, unpacked, budget })
    }

    /// The vectors of an accessor of the type `VEC3`; all finite.
    pub(super) fn positions(&self, accessor: usize) -> Result<Vec<DVec3>, Fault> {
        let place = Place::Json(format!("accessors/{accessor}"));
        let values: Vec<DVec3> = self.read(accessor, "VEC3", DVec3::ZERO, |c, bytes, normalized| {
            DVec3::from_array([0, 1, 2].map(|k| c.number(&bytes[k * c.size()..], normalized)))
        })?;
        match values.iter().find(|p| !p.is_finite()) {
            Some(p) => Err(Fault::new(place, format!("the position {p}"), "finite coordinates")),
            None => Ok(values),
        }
    }

    /// The numbers of an accessor of the type `SCALAR` with whole, unsigned components.
    pub(super) fn indices(&self, accessor: usize) -> Result<Vec<u32>, Fault> {
        let values =
            self.read(accessor, "SCALAR", 0, |component, bytes, _| component.index(bytes).unwrap_or(u32::MAX))?;
        let kind = Component::from_code(self.document.accessors[accessor].component_type);
        if kind.is_some_and(Component::is_unsigned) {
            return Ok(values);
        }
        let found = format!("component type {}", self.document.accessors[accessor].component_type);
        Err(Fault::new(Place::Json(format!("accessors/{accessor}")), found, "5121, 5123 or 5125 for indices"))
    }

    fn read<T: Copy>(
        &self,
        number: usize,
        shape: &str,
        zero: T,
        decode: impl Fn(Component, &[u8], bool) -> T,
    ) -> Result<Vec<T>, Fault> {
        let place = Place::Json(format!("accessors/{number}"));
        let accessors = &self.document.accessors;
        let Some(accessor) = accessors.get(number) else {
            return Err(Fault::new(place, "no such accessor", format!("one of {}", accessors.len())));
        };
        if accessor.shape != shape {
            let found = format!("the type `{}`", accessor.shape.escape_debug());
            return Err(Fault::new(place, found, format!("`{shape}`")));
        }
        let component = component(accessor.component_type, &place)?;
        let width = component.size() * if shape == "VEC3" { 3 } else { 1 };
        let decode = |bytes: &[u8]| decode(component, bytes, accessor.normalized);
        let mut values = match accessor.buffer_view {
            Some(view) => {
                let items = self.items(view, accessor.byte_offset, accessor.count, width, &place)?;
                items.map(decode).collect()
            }
            None => vec![zero; self.checked_zeros(accessor, &place)?],
        };
        if let Some(sparse) = &accessor.sparse {
            let targets = self.sparse_targets(sparse, &place)?;
            let replacements =
                self.items(sparse.values.buffer_view, sparse.values.byte_offset, sparse.count, width, &place)?;
            for (target, replacement) in targets.into_iter().zip(replacements) {
                let Some(value) = values.get_mut(target as usize) else {
                    return Err(Fault::new(
                        place.clone(),
                        format!("sparse index {target}"),
                        format!("below {}", accessor.count),
                    ));
                };
                *value = decode(replacement);
            }
        }
        Ok(values)
    }

    /// The count of an accessor without a buffer view, all of whose values are zero before sparse ones replace them.
    fn checked_zeros(&self, accessor: &Accessor, place: &Place) -> Result<usize, Fault> {
        // No data vouches for the count; a file of this size could have had no more values of its own.
        let most = self.data.iter().map(|d| d.len()).sum();
        if accessor.count <= most {
            return Ok(accessor.count);
        }
        Err(Fault::new(
            place.clone(),
            format!("{} values without a buffer view", accessor.count),
            format!("at most {most}"),
        ))
    }

    fn sparse_targets(&self, sparse: &Sparse, place: &Place) -> Result<Vec<u32>, Fault> {
        let indices = &sparse.indices;
        let component = component(indices.component_type, place)?;
        let items = self.items(indices.buffer_view, indices.byte_offset, sparse.count, component.size(), place)?;
        let targets: Option<Vec<u32>> = items.map(|bytes| component.index(bytes)).collect();
        targets
            .ok_or_else(|| Fault::new(place.clone(), "sparse indices that may be negative or broken", "whole numbers"))
    }

    /// `count` items of `width` bytes each from a buffer view, all inside it.
    fn items(
        &self,
        view: usize,
        offset: usize,
        count: usize,
        width: usize,
        place: &Place,
    ) -> Result<impl Iterator<Item = &[u8]>, Fault> {
        let bytes = self.view(view, place)?;
        let stride = self.document.buffer_views[view].byte_stride.unwrap_or(width);
        let fault = |found: String, expected: String| Err(Fault::new(place.clone(), found, expected));
        if stride < width {
            return fault(format!("byte stride {stride}"), format!("at least {width}"));
        }
        let length = count.checked_sub(1).map_or(Some(0), |last| last.checked_mul(stride)?.checked_add(width));
        let end = length.and_then(|length| length.checked_add(offset));
        let Some(slice) = end.and_then(|end| bytes.get(offset..end)) else {
            return fault(
                format!("{count} values at byte {offset}"),
                format!("a range within the {} bytes", bytes.len()),
            );
        };
        Ok(slice.chunks(stride).take(count).map(move |chunk| &chunk[..width]))
    }

    fn view(&self, number: usize, place: &Place) -> Result<&[u8], Fault> {
        let views = &self.document.buffer_views;
        let Some(view) = views.get(number) else {
            return Err(Fault::new(place.clone(), format!("buffer view {number}"), format!("one of {}", views.len())));
        };
        let place = Place::Json(format!("bufferViews/{number}"));
        match (&view.extensions.packed, self.unpacked.get(number)) {
            (Some(packed), Some(unpacked)) => match unpacked.get() {
                Some(bytes) => Ok(bytes),
                None => {
                    let bytes = self.unpack(view, packed, number, place)?;
                    Ok(unpacked.get_or_init(|| bytes))
                }
            },
            _ => self.range(view.buffer, view.byte_offset, view.byte_length, place),
        }
    }

    /// Bytes of a buffer.
    fn range(&self, buffer: usize, offset: usize, length: usize, place: Place) -> Result<&[u8], Fault> {
        let data = self.data.get(buffer).map(|d| &d[..]).unwrap_or_default();
        let end = offset.checked_add(length);
        end.and_then(|end| data.get(offset..end)).ok_or_else(|| {
            let found = format!("{length} bytes from byte {offset} of buffer {buffer}");
            Fault::new(place, found, format!("a range within its {} bytes", data.len()))
        })
    }

    fn unpack(
        &self,
        view: &BufferView,
        packed: &PackedView,
        number: usize,
        view_place: Place,
    ) -> Result<Vec<u8>, Fault> {
        let (count, stride) = (packed.count, packed.byte_stride);
        if count.checked_mul(stride) != Some(view.byte_length) {
            let expected = format!("{count} packed elements of {stride}");
            return Err(Fault::new(view_place, format!("{} bytes", view.byte_length), expected));
        }
        if let Some(other) = view.byte_stride.filter(|other| *other != stride) {
            let expected = format!("{stride} as in its packed form");
            return Err(Fault::new(view_place, format!("byte stride {other}"), expected));
        }
        let place = Place::Json(format!("bufferViews/{number}/extensions/EXT_meshopt_compression"));
        let bytes = self.range(packed.buffer, packed.byte_offset, packed.byte_length, place.clone())?;
        let Some(rest) = self.budget.get().checked_sub(bytes.len()) else {
            return Err(Fault::new(place, "packed bytes that other views have", "bytes of its own"));
        };
        self.budget.set(rest);
        packed::unpack(packed, bytes, &place)
    }
}

fn component(code: u32, place: &Place) -> Result<Component, Fault> {
    let fault = || Fault::new(place.clone(), format!("component type {code}"), "5120 to 5123, 5125 or 5126");
    Component::from_code(code).ok_or_else(fault)
}

/// The type of a number.
#[derive(Clone, Copy)]
enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    fn from_code(code: u32) -> Option<Self> {
        Some(match code {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    fn is_unsigned(self) -> bool {
        matches!(self, Self::U8 | Self::U16 | Self::U32)
    }

    /// A whole, unsigned number from its bytes; `None` for other types and where bytes are missing.
    fn index(self, bytes: &[u8]) -> Option<u32> {
        match self {
            Self::U8 => bytes.first().map(|&b| u32::from(b)),
            Self::U16 => bytes.first_chunk().map(|b| u32::from(u16::from_le_bytes(*b))),
            Self::U32 => bytes.first_chunk().map(|b| u32::from_le_bytes(*b)),
            Self::I8 | Self::I16 | Self::F32 => None,
        }
    }

    /// A number from its bytes; normalized, whole numbers stand for fractions of the largest. NaN where bytes are missing.
    fn number(self, bytes: &[u8], normalized: bool) -> f64 {
        let fraction = |value: f64, largest: f64| if normalized { (value / largest).max(-1.0) } else { value };
        let two = || bytes.first_chunk::<2>().copied();
        let four = || bytes.first_chunk::<4>().copied();
        let value = match self {
            Self::I8 => bytes.first().map(|&b| fraction(f64::from(b.cast_signed()), 127.0)),
            Self::U8 => bytes.first().map(|&b| fraction(f64::from(b), 255.0)),
            Self::I16 => two().map(|b| fraction(f64::from(i16::from_le_bytes(b)), 32767.0)),
            Self::U16 => two().map(|b| fraction(f64::from(u16::from_le_bytes(b)), 65535.0)),
            Self::U32 => four().map(|b| f64::from(u32::from_le_bytes(b))),
            Self::F32 => four().map(|b| f64::from(f32::from_le_bytes(b))),
        };
        value.unwrap_or(f64::NAN)
    }
}

/// The bytes of an address such as `data:application/octet-stream;base64,AAAA`.
fn decode_data_uri(uri: &str) -> Option<Vec<u8>> {
    let (head, text) = uri.strip_prefix("data:")?.split_once(',')?;
    if !head.ends_with(";base64") {
        return None;
    }
    let text = text.trim_end_matches('=').as_bytes();
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3 + 2);
    for group in text.chunks(4) {
        if group.len() == 1 {
            return None;
        }
        let mut word = 0u32;
        for (k, &letter) in group.iter().enumerate() {
            word |= base64_digit(letter)? << (18 - 6 * k);
        }
        bytes.extend_from_slice(&word.to_be_bytes()[1..group.len()]);
    }
    Some(bytes)
}

fn base64_digit(letter: u8) -> Option<u32> {
    let digit = match letter {
        b'A'..=b'Z' => letter - b'A',
        b'a'..=b'z' => letter - b'a' + 26,
        b'0'..=b'9' => letter - b'0' + 52,
        b'+' | b'-' => 62,
        b'/' | b'_' => 63,
        _ => return None,
    };
    Some(u32::from(digit))
}
