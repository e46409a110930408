//! Packed arrays, put together from the specification of `EXT_meshopt_compression`.

use super::{cube_corners, cube_triangles, floats, shorts};

/// How the numbers of a cube are stored before they are packed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Positions {
    Floats,
    /// Mantissas of 24 bits with exponents of 8, which the filter `EXPONENTIAL` turns into floats.
    Exponential,
    /// Whole numbers of 16 bits, each element filled up to 8 bytes.
    Shorts,
}

fn zigzag(delta: u8) -> u8 {
    let delta = delta.cast_signed();
    (delta << 1 ^ delta >> 7).cast_unsigned()
}

/// At most 16 elements, version 0: each byte of all elements for itself, as differences from one element to the next, in full.
pub(crate) fn attributes(plain: &[u8], stride: usize) -> Vec<u8> {
    let elements: Vec<&[u8]> = plain.chunks(stride).collect();
    assert!(elements.len() <= 16);
    let mut bytes = vec![0xa0];
    for k in 0..stride {
        bytes.push(3);
        let mut last = elements[0][k];
        for group in 0..16 {
            let value = elements.get(group).map_or(last, |element| element[k]);
            bytes.push(zigzag(value.wrapping_sub(last)));
            last = value;
        }
    }
    // the end is the first element, and 32 bytes long at least
    bytes.resize(bytes.len() + 32usize.saturating_sub(stride), 0);
    bytes.extend(elements[0]);
    bytes
}

/// Differences from one index to the next, seven bits a byte; the lowest bit says to which of two last ones.
pub(crate) fn sequence(indices: &[u32]) -> Vec<u8> {
    let mut bytes = vec![0xd1];
    let mut last = 0;
    for &index in indices {
        let delta = index.wrapping_sub(last).cast_signed();
        let mut rest = (delta << 1 ^ delta >> 31).cast_unsigned() << 1;
        while rest >= 128 {
            bytes.push((rest & 127) as u8 | 128);
            rest >>= 7;
        }
        bytes.push(rest as u8);
        last = index;
    }
    bytes.extend([0; 4]);
    bytes
}

/// A unit cube, or one of 3 to a side with `Shorts`, with packed positions, and indices in this mode and width. The second buffer is a
/// fallback without bytes.
pub(crate) fn packed_cube(positions: Positions, mode: &str, width: usize) -> (String, Vec<u8>) {
    let corners = cube_corners();
    let (plain, stride, component, filter) = match positions {
        Positions::Floats => (floats(corners), 12, 5126, ""),
        // mantissa and exponent of 1 are 1 and 0
        Positions::Exponential => {
            let words = corners.iter().flatten().flat_map(|&x| u32::from(x > 0.0).to_le_bytes());
            (words.collect(), 12, 5126, r#", "filter": "EXPONENTIAL""#)
        }
        Positions::Shorts => {
            let elements = corners.iter().flat_map(|&[x, y, z]| [x, y, z, 0.0].map(|x| 3 * x as u16));
            (shorts(elements), 8, 5122, "")
        }
    };
    let mut buffer = attributes(&plain, stride);
    let at_indices = buffer.len();
    let indices: Vec<u32> = cube_triangles().into_iter().flatten().collect();
    buffer.extend(match mode {
        "TRIANGLES" => meshopt::encode_index_buffer(&indices, 8).expect("encoded"),
        _ => sequence(&indices),
    });
    let indices_length = buffer.len() - at_indices;
    let (index_type, plain_length, all_indices) = (if width == 2 { 5123 } else { 5125 }, 8 * stride, 36 * width);
    let json = format!(
        r#"{{"asset": {{"version": "2.0"}}, "extensionsRequired": ["EXT_meshopt_compression", "KHR_mesh_quantization"],
        "nodes": [{{"mesh": 0}}], "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 1}}]}}],
        "accessors": [{{"bufferView": 0, "componentType": {component}, "count": 8, "type": "VEC3"}},
                      {{"bufferView": 1, "componentType": {index_type}, "count": 36, "type": "SCALAR"}}],
        "bufferViews": [
          {{"buffer": 1, "byteLength": {plain_length}, "byteStride": {stride}, "extensions": {{"EXT_meshopt_compression":
            {{"buffer": 0, "byteLength": {at_indices}, "byteStride": {stride}, "count": 8, "mode": "ATTRIBUTES"{filter}}}}}}},
          {{"buffer": 1, "byteOffset": {plain_length}, "byteLength": {all_indices}, "extensions": {{"EXT_meshopt_compression":
            {{"buffer": 0, "byteOffset": {at_indices}, "byteLength": {indices_length}, "byteStride": {width}, "count": 36,
              "mode": "{mode}"}}}}}}],
        "buffers": [{{"byteLength": {}}},
                    {{"byteLength": {}, "extensions": {{"EXT_meshopt_compression": {{"fallback": true}}}}}}]}}"#,
        buffer.len(),
        plain_length + all_indices
    );
    (json, buffer)
}
