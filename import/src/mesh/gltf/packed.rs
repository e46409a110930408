//! Buffer views packed by `EXT_meshopt_compression`.
//!
//! The library that unpacks them takes any bytes, but it trusts counts and strides: those are checked here, and what is set aside for a view
//! is never more than its packed bytes can fill.
//!
//! <https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Vendor/EXT_meshopt_compression>

use super::super::error::{Fault, Place};
use super::document::PackedView;

/// Maximum size of a block of packed elements, in bytes and in elements.
const BLOCK_BYTES: usize = 8192;
const BLOCK_ELEMENTS: usize = 256;
/// Elements of a block, bytes of which are packed together.
const GROUP: usize = 16;
/// Strides that the format of attributes has.
const STRIDE_UNIT: usize = 4;
const MAX_STRIDE: usize = 256;

/// Unpacks a number of elements; `None` where the bytes are damaged.
type Unpack = fn(&[u8], usize) -> Option<Vec<u8>>;

/// The function for each stride of attributes, 4, 8, 12, …
const ATTRIBUTES: [Unpack; MAX_STRIDE / STRIDE_UNIT] = {
    macro_rules! for_strides {
        ($($units:literal)*) => { [$(attributes::<{ STRIDE_UNIT * $units }>),*] };
    }
    for_strides!(
        1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31 32
        33 34 35 36 37 38 39 40 41 42 43 44 45 46 47 48 49 50 51 52 53 54 55 56 57 58 59 60 61 62 63 64
    )
};

/// The bytes of a view from its packed ones.
pub(super) fn unpack(view: &PackedView, packed: &[u8], place: &Place) -> Result<Vec<u8>, Fault> {
    let fault = |found: String, expected: &str| Err(Fault::new(place.clone(), found, expected));
    let PackedView { count, byte_stride: stride, .. } = *view;
    let filter = view.filter.as_deref().unwrap_or("NONE");
    let is_attribute = view.mode == "ATTRIBUTES";
    let unpack: Unpack = match (view.mode.as_str(), stride) {
        ("ATTRIBUTES", _) => match ATTRIBUTES.get((stride / STRIDE_UNIT).wrapping_sub(1)) {
            Some(unpack) if stride % STRIDE_UNIT == 0 => *unpack,
            _ => return fault(format!("byte stride {stride}"), "a multiple of 4 from 4 to 256"),
        },
        // the library counts on whole triangles
        ("TRIANGLES", _) if !count.is_multiple_of(3) => return fault(format!("{count} indices"), "a multiple of 3"),
        ("TRIANGLES", 2) => |packed, count| Some(narrow(&meshopt::decode_index_buffer(packed, count).ok()?)),
        ("TRIANGLES", 4) => |packed, count| Some(wide(&meshopt::decode_index_buffer(packed, count).ok()?)),
        ("INDICES", 2) => |packed, count| Some(narrow(&meshopt::decode_index_sequence(packed, count).ok()?)),
        ("INDICES", 4) => |packed, count| Some(wide(&meshopt::decode_index_sequence(packed, count).ok()?)),
        ("TRIANGLES" | "INDICES", _) => return fault(format!("byte stride {stride}"), "2 or 4"),
        (mode, _) => {
            return fault(format!("the mode `{}`", mode.escape_debug()), "`ATTRIBUTES`, `TRIANGLES` or `INDICES`");
        }
    };
    let filter: fn(&mut [u8]) = match (filter, stride) {
        ("NONE", _) => |_| (),
        (filter, _) if !is_attribute => {
            return fault(format!("the filter `{}` of indices", filter.escape_debug()), "`NONE`");
        }
        ("EXPONENTIAL", _) => exponential,
        ("OCTAHEDRAL", 4) => octahedral_bytes,
        ("OCTAHEDRAL", 8) => octahedral_shorts,
        ("QUATERNION", 8) => quaternions,
        ("OCTAHEDRAL", _) => return fault(format!("byte stride {stride}"), "4 or 8 for the filter `OCTAHEDRAL`"),
        ("QUATERNION", _) => return fault(format!("byte stride {stride}"), "8 for the filter `QUATERNION`"),
        (filter, _) => {
            let known = "`NONE`, `OCTAHEDRAL`, `QUATERNION` or `EXPONENTIAL`";
            return fault(format!("the filter `{}`", filter.escape_debug()), known);
        }
    };
    let least = match view.mode.as_str() {
        "ATTRIBUTES" => least_attributes(packed, count, stride),
        "TRIANGLES" => Some((count / 3).saturating_add(17)),
        _ => Some(count.saturating_add(5)),
    };
    match least {
        None => return fault("packed bytes without a known head".to_owned(), "attributes of version 0 or 1"),
        Some(least) if packed.len() < least => {
            return fault(format!("{count} elements in {} bytes", packed.len()), &format!("at least {least} bytes"));
        }
        Some(_) => {}
    }
    let Some(mut bytes) = unpack(packed, count) else {
        return fault("packed bytes that are damaged".to_owned(), &format!("{count} elements of {stride} bytes"));
    };
    filter(&mut bytes);
    Ok(bytes)
}

/// The least number of bytes that `count` elements can be packed in; `None` for versions that the library does not know.
fn least_attributes(packed: &[u8], count: usize, stride: usize) -> Option<usize> {
    let in_block = (BLOCK_BYTES / stride / GROUP * GROUP).min(BLOCK_ELEMENTS);
    let (block, tail) = match meshopt::decode_vertex_version(packed)? {
        // two bits for each group of each byte of an element, and the first element
        0 => (stride * (in_block / GROUP).div_ceil(4), stride.max(32)),
        // two bits for each byte of an element
        1 => (stride / 4, (stride + stride / 4).max(24)),
        _ => return None,
    };
    // what the last block lacks to a whole one may have none
    Some((count / in_block).saturating_mul(block).saturating_add(1 + tail))
}

/// One element.
#[derive(Clone)]
#[repr(transparent)]
struct Element<const STRIDE: usize>([u8; STRIDE]);

impl<const STRIDE: usize> Default for Element<STRIDE> {
    fn default() -> Self {
        Self([0; STRIDE])
    }
}

fn attributes<const STRIDE: usize>(packed: &[u8], count: usize) -> Option<Vec<u8>> {
    let elements: Vec<Element<STRIDE>> = meshopt::decode_vertex_buffer(packed, count).ok()?;
    Some(elements.iter().flat_map(|element| element.0).collect())
}

fn narrow(numbers: &[u16]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

fn wide(numbers: &[u32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

/// Floats from exponents of 8 bits and mantissas of 24.
fn exponential(bytes: &mut [u8]) {
    let (words, _) = bytes.as_chunks_mut::<4>();
    let mut numbers: Vec<[u32; 1]> = words.iter().map(|word| [u32::from_le_bytes(*word)]).collect();
    meshopt::decode_filter_exp(&mut numbers);
    words.iter_mut().zip(numbers).for_each(|(word, [number])| *word = number.to_le_bytes());
}

/// Directions on an octahedron.
fn octahedral_bytes(bytes: &mut [u8]) {
    let (elements, _) = bytes.as_chunks_mut::<4>();
    let mut vectors: Vec<[i8; 4]> = elements.iter().map(|element| element.map(u8::cast_signed)).collect();
    meshopt::decode_filter_oct(&mut vectors);
    elements.iter_mut().zip(vectors).for_each(|(element, vector)| *element = vector.map(i8::cast_unsigned));
}

fn octahedral_shorts(bytes: &mut [u8]) {
    of_shorts(bytes, meshopt::decode_filter_oct);
}

fn quaternions(bytes: &mut [u8]) {
    of_shorts(bytes, meshopt::decode_filter_quat);
}

/// A filter of elements that are four numbers of 16 bits.
fn of_shorts(bytes: &mut [u8], filter: impl FnOnce(&mut [[i16; 4]])) {
    let (shorts, _) = bytes.as_chunks_mut::<2>();
    let numbers: Vec<i16> = shorts.iter().map(|short| i16::from_le_bytes(*short)).collect();
    let (elements, _) = numbers.as_chunks::<4>();
    let mut elements = elements.to_vec();
    filter(&mut elements);
    shorts.iter_mut().zip(elements.iter().flatten()).for_each(|(short, number)| *short = number.to_le_bytes());
}
