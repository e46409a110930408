//! Sections packed by `EXT_meshopt_compression`.
//!
//! Buffers of vertices are packed in the version that the extension knows, which is older than the library's own.
//!
//! <https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Vendor/EXT_meshopt_compression>

use super::geometry::Geometry;
use super::sections::{Kind, Section, Width};
use crate::ExportError;

/// The version of vertex coding that the extension knows.
const VERTEX_VERSION: i32 = 0;
/// How hard to try; it has no effect in this version.
const LEVEL: i32 = 2;

/// A packed section.
pub(super) struct Packed {
    pub(super) bytes: Vec<u8>,
    /// How it is packed, as the extension says it.
    pub(super) mode: &'static str,
}

impl Packed {
    /// Turns triangles so that their packed form, which keeps their order but not which corner is first, gives them as they are.
    pub(super) fn turn_triangles(meshes: &mut [Geometry]) -> Result<(), ExportError> {
        for width in [Width::U16, Width::U32] {
            let Some(section) = Section::of_kind(Kind::Indices(width), meshes, false) else { continue };
            let numbers = section.numbers(meshes);
            let packed = meshopt::encode_index_buffer(&numbers, span(&numbers)).map_err(|error| failed(&error))?;
            let turned: Vec<u32> =
                meshopt::decode_index_buffer(&packed, numbers.len()).map_err(|error| failed(&error))?;
            let mut rest = turned.as_slice();
            for mesh in meshes.iter_mut().filter(|mesh| Kind::indices(mesh) == section.kind) {
                let (own, after) = rest.split_at(mesh.vertices.corners.len());
                mesh.vertices.corners.copy_from_slice(own);
                rest = after;
            }
        }
        Ok(())
    }

    pub(super) fn of(section: &Section, meshes: &[Geometry]) -> Result<Self, ExportError> {
        let (bytes, mode) = match section.kind {
            kind if kind.is_attribute() => (attributes(section, meshes)?, "ATTRIBUTES"),
            Kind::Indices(_) => {
                let numbers = section.numbers(meshes);
                (meshopt::encode_index_buffer(&numbers, span(&numbers)).map_err(|error| failed(&error))?, "TRIANGLES")
            }
            _ => {
                let numbers = section.numbers(meshes);
                (meshopt::encode_index_sequence(&numbers, span(&numbers)).map_err(|error| failed(&error))?, "INDICES")
            }
        };
        Ok(Self { bytes, mode })
    }
}

/// More than the largest number.
fn span(numbers: &[u32]) -> usize {
    numbers.iter().max().map_or(0, |most| *most as usize + 1)
}

fn attributes(section: &Section, meshes: &[Geometry]) -> Result<Vec<u8>, ExportError> {
    let mut plain = Vec::with_capacity(section.bytes());
    section.write(meshes, &mut plain)?;
    match section.stride {
        4 => encoded::<4>(&plain),
        8 => encoded::<8>(&plain),
        12 => encoded::<12>(&plain),
        _ => encoded::<16>(&plain),
    }
}

fn encoded<const STRIDE: usize>(plain: &[u8]) -> Result<Vec<u8>, ExportError> {
    let (elements, _) = plain.as_chunks::<STRIDE>();
    meshopt::encode_vertex_buffer_level(elements, LEVEL, Some(VERTEX_VERSION)).map_err(|error| failed(&error))
}

fn failed(error: &meshopt::Error) -> ExportError {
    ExportError::Encode { format: "EXT_meshopt_compression", message: error.to_string() }
}
