//! Numbers from the buffers of a glTF document.

use std::borrow::Cow;
use std::cell::{Cell, OnceCell};

use glam::{DVec2, DVec3};
use gltf::accessor::Item;
use gltf::accessor::util::{ItemIter, SparseIndicesIter};
use gltf::json::accessor::sparse::Sparse;
use gltf::json::accessor::{Accessor, ComponentType, IndexComponentType, Type};
use gltf::json::validation::{Checked, USize64};
use serde_json::Value;

use super::super::error::{Fault, Place, quoted};
use super::document::{Buffer, BufferView, Document, PackedView};
use super::packed;

/// The embedded buffers.
pub(super) struct Buffers<'a> {
    document: &'a Document,
    /// The document as the file has it.
    json: &'a [u8],
    data: Vec<Cow<'a, [u8]>>,
    /// For each view its bytes, where they were packed and have been asked for.
    unpacked: Vec<OnceCell<Vec<u8>>>,
    /// How many packed bytes may still be unpacked: no more than there are, or a small file could have the same ones unpacked any number of times.
    budget: Cell<usize>,
}

impl<'a> Buffers<'a> {
    /// Takes the first buffer from the container's binary chunk where it has no address, the others from data addresses.
    pub(super) fn new(document: &'a Document, json: &'a [u8], binary: Option<&'a [u8]>) -> Result<Self, Fault> {
        let load = |(number, buffer): (usize, &'a Buffer)| {
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
        Ok(Self { document, json, data, unpacked, budget })
    }

    /// The vectors of an accessor of the type `VEC3`; all finite.
    pub(super) fn positions(&self, accessor: usize) -> Result<Vec<DVec3>, Fault> {
        let place = Place::Json(format!("accessors/{accessor}"));
        let (stated, component) = self.accessor(accessor, Type::Vec3, "VEC3")?;
        let values = match component {
            ComponentType::I8 => self.vectors::<i8>(stated, &place, 127.0),
            ComponentType::U8 => self.vectors::<u8>(stated, &place, 255.0),
            ComponentType::I16 => self.vectors::<i16>(stated, &place, 32767.0),
            ComponentType::U16 => self.vectors::<u16>(stated, &place, 65535.0),
            // The format has no fractions of these.
            ComponentType::U32 => self.vectors::<u32>(stated, &place, 1.0),
            ComponentType::F32 => self.vectors::<f32>(stated, &place, 1.0),
        }?;
        match values.iter().find(|p| !p.is_finite()) {
            Some(p) => Err(Fault::new(place, format!("the position {p}"), "finite coordinates")),
            None => Ok(values),
        }
    }

    /// The texture coordinates of an accessor of the type `VEC2`; all finite.
    pub(super) fn coordinates(&self, accessor: usize) -> Result<Vec<DVec2>, Fault> {
        let place = Place::Json(format!("accessors/{accessor}"));
        let (stated, component) = self.accessor(accessor, Type::Vec2, "VEC2")?;
        let values: Vec<[f64; 2]> = match component {
            ComponentType::I8 => self.numbers::<i8, 2>(stated, &place, 127.0),
            ComponentType::U8 => self.numbers::<u8, 2>(stated, &place, 255.0),
            ComponentType::I16 => self.numbers::<i16, 2>(stated, &place, 32767.0),
            ComponentType::U16 => self.numbers::<u16, 2>(stated, &place, 65535.0),
            ComponentType::U32 => self.numbers::<u32, 2>(stated, &place, 1.0),
            ComponentType::F32 => self.numbers::<f32, 2>(stated, &place, 1.0),
        }?;
        match values.iter().flatten().find(|value| !value.is_finite()) {
            Some(value) => Err(Fault::new(place, format!("the texture coordinate {value}"), "finite ones")),
            None => Ok(values.into_iter().map(DVec2::from_array).collect()),
        }
    }

    /// The colours of an accessor of the type `VEC3` or `VEC4`, linear; opacity is passed over.
    pub(super) fn colors(&self, accessor: usize) -> Result<Vec<[f32; 3]>, Fault> {
        let place = Place::Json(format!("accessors/{accessor}"));
        let has_opacity = self.document.accessors.get(accessor).is_some_and(|a| a.type_ == Checked::Valid(Type::Vec4));
        let shape = if has_opacity { (Type::Vec4, "VEC4") } else { (Type::Vec3, "VEC3") };
        let (stated, component) = self.accessor(accessor, shape.0, shape.1)?;
        match component {
            ComponentType::U8 => self.channels::<u8>(stated, &place, 255.0, has_opacity),
            ComponentType::U16 => self.channels::<u16>(stated, &place, 65535.0, has_opacity),
            ComponentType::F32 => self.channels::<f32>(stated, &place, 1.0, has_opacity),
            ComponentType::I8 | ComponentType::I16 | ComponentType::U32 => {
                let found = format!("component type {}", component.as_gl_enum());
                Err(Fault::new(place, found, "5121, 5123 or 5126 for colours"))
            }
        }
    }

    fn channels<T: Item + Copy + Into<f32>>(
        &self,
        accessor: &Accessor,
        place: &Place,
        largest: f32,
        has_opacity: bool,
    ) -> Result<Vec<[f32; 3]>, Fault> {
        let color = |channels: [T; 3]| channels.map(|channel| channel.into() / largest);
        if has_opacity {
            let values = self.values::<[T; 4]>(accessor, place)?;
            return Ok(values.into_iter().map(|[r, g, b, _]| color([r, g, b])).collect());
        }
        Ok(self.values::<[T; 3]>(accessor, place)?.into_iter().map(color).collect())
    }

    /// Vectors of numbers.
    fn vectors<T: Item + Copy + Into<f64>>(
        &self,
        accessor: &Accessor,
        place: &Place,
        largest: f64,
    ) -> Result<Vec<DVec3>, Fault>
    where
        [T; 3]: Item,
    {
        Ok(self.numbers::<T, 3>(accessor, place, largest)?.into_iter().map(DVec3::from_array).collect())
    }

    /// Some numbers at a time; normalized, whole ones stand for fractions of the largest. The crate's own reader of positions knows `f32` alone.
    fn numbers<T: Item + Copy + Into<f64>, const N: usize>(
        &self,
        accessor: &Accessor,
        place: &Place,
        largest: f64,
    ) -> Result<Vec<[f64; N]>, Fault>
    where
        [T; N]: Item,
    {
        let is_fraction = accessor.normalized && largest > 1.0;
        let number = |value: T| if is_fraction { (value.into() / largest).max(-1.0) } else { value.into() };
        Ok(self.values::<[T; N]>(accessor, place)?.into_iter().map(|vector| vector.map(number)).collect())
    }

    /// The numbers of an accessor of the type `SCALAR` with whole, unsigned components.
    pub(super) fn indices(&self, accessor: usize) -> Result<Vec<u32>, Fault> {
        let place = Place::Json(format!("accessors/{accessor}"));
        let (stated, component) = self.accessor(accessor, Type::Scalar, "SCALAR")?;
        match component {
            ComponentType::U8 => Ok(self.values::<u8>(stated, &place)?.into_iter().map(u32::from).collect()),
            ComponentType::U16 => Ok(self.values::<u16>(stated, &place)?.into_iter().map(u32::from).collect()),
            ComponentType::U32 => self.values(stated, &place),
            ComponentType::I8 | ComponentType::I16 | ComponentType::F32 => {
                let found = format!("component type {}", component.as_gl_enum());
                Err(Fault::new(place, found, "5121, 5123 or 5125 for indices"))
            }
        }
    }

    /// The accessor of a number, which must be of this type.
    fn accessor(&self, number: usize, shape: Type, shape_name: &str) -> Result<(&Accessor, ComponentType), Fault> {
        let place = || Place::Json(format!("accessors/{number}"));
        let accessors = &self.document.accessors;
        let Some(accessor) = accessors.get(number) else {
            return Err(Fault::new(place(), "no such accessor", format!("one of {}", accessors.len())));
        };
        if accessor.type_ != Checked::Valid(shape) {
            let found = format!("the type {}", self.stated(number, "type"));
            return Err(Fault::new(place(), found, format!("`{shape_name}`")));
        }
        match accessor.component_type {
            Checked::Valid(component) => Ok((accessor, component.0)),
            Checked::Invalid => {
                let found = format!("component type {}", self.stated(number, "componentType"));
                Err(Fault::new(place(), found, "5120 to 5123, 5125 or 5126"))
            }
        }
    }

    /// What the file states as a property of an accessor, for an error: the crate keeps no values that it does not know.
    fn stated(&self, accessor: usize, property: &str) -> String {
        let file: Value = serde_json::from_slice(self.json).unwrap_or_default();
        match &file["accessors"][accessor][property] {
            Value::String(text) => format!("`{}`", text.escape_debug()),
            other => other.to_string(),
        }
    }

    /// The items of an accessor, sparse ones replaced. The crate's own iterator over an accessor counts on a checked document and on views
    /// that are not packed.
    fn values<T: Item + Copy>(&self, accessor: &Accessor, place: &Place) -> Result<Vec<T>, Fault> {
        let offset = size(accessor.byte_offset.unwrap_or_default());
        let count = size(accessor.count);
        let mut values = match accessor.buffer_view {
            Some(view) => self.items(view.value(), offset, count, place)?.collect(),
            None => vec![T::zero(); self.checked_zeros(count, place)?],
        };
        let Some(sparse) = &accessor.sparse else { return Ok(values) };
        let replacements =
            self.items(sparse.values.buffer_view.value(), size(sparse.values.byte_offset), size(sparse.count), place)?;
        for (target, replacement) in self.sparse_targets(sparse, place)?.zip(replacements) {
            let Some(value) = values.get_mut(target as usize) else {
                return Err(Fault::new(place.clone(), format!("sparse index {target}"), format!("below {count}")));
            };
            *value = replacement;
        }
        Ok(values)
    }

    fn sparse_targets(&self, sparse: &Sparse, place: &Place) -> Result<SparseIndicesIter<'_>, Fault> {
        let indices = &sparse.indices;
        let (view, offset, count) = (indices.buffer_view.value(), size(indices.byte_offset), size(sparse.count));
        match indices.component_type {
            Checked::Valid(IndexComponentType(ComponentType::U8)) => {
                Ok(SparseIndicesIter::U8(self.items(view, offset, count, place)?))
            }
            Checked::Valid(IndexComponentType(ComponentType::U16)) => {
                Ok(SparseIndicesIter::U16(self.items(view, offset, count, place)?))
            }
            Checked::Valid(IndexComponentType(ComponentType::U32)) => {
                Ok(SparseIndicesIter::U32(self.items(view, offset, count, place)?))
            }
            _ => Err(Fault::new(place.clone(), "sparse indices of another component type", "5121, 5123 or 5125")),
        }
    }

    /// The count of an accessor without a buffer view, all of whose values are zero before sparse ones replace them.
    fn checked_zeros(&self, count: usize, place: &Place) -> Result<usize, Fault> {
        // No data vouches for the count; a file of this size could have had no more values of its own.
        let most = self.data.iter().map(|d| d.len()).sum();
        if count <= most {
            return Ok(count);
        }
        Err(Fault::new(place.clone(), format!("{count} values without a buffer view"), format!("at most {most}")))
    }

    /// `count` items from a buffer view, all inside it.
    fn items<T: Item>(
        &self,
        view: usize,
        offset: usize,
        count: usize,
        place: &Place,
    ) -> Result<ItemIter<'_, T>, Fault> {
        let bytes = self.view(view, place)?;
        let width = size_of::<T>();
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
        Ok(ItemIter::new(slice, stride))
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

/// A size or offset; one that no memory has is beyond the end of every buffer.
fn size(stated: USize64) -> usize {
    usize::try_from(stated.0).unwrap_or(usize::MAX)
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
