//! Packed sections in a build without the feature `meshopt`: an error.

use super::geometry::Geometry;
use super::sections::Section;
use crate::ExportError;

const MISSING: ExportError = ExportError::MissingFeature { what: "EXT_meshopt_compression", feature: "meshopt" };

/// A packed section; this build makes none.
pub(super) struct Packed {
    pub(super) bytes: Vec<u8>,
    pub(super) mode: &'static str,
}

impl Packed {
    pub(super) fn turn_triangles(_: &mut [Geometry]) -> Result<(), ExportError> {
        Err(MISSING)
    }

    pub(super) fn of(_: &Section, _: &[Geometry]) -> Result<Self, ExportError> {
        Err(MISSING)
    }
}
