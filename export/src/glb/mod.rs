//! glTF 2.0, binary and as JSON.
//!
//! The scene is one root node, which turns Z-up into glTF's Y-up and carries the scale, with a mesh node for each part.
//! Every mesh node is translated to a point near the part's centre, so that single-precision positions are small.
//!
//! Way of a mesh through this folder: [`origin`] chooses the translation, [`geometry`] splits vertices for flat normals and
//! remembers which belong together, [`buffer`] packs the arrays, [`document`] describes them in JSON.

mod base64;
mod buffer;
mod document;
mod geometry;
mod origin;

use std::borrow::Cow;

use gltf::binary::{Glb, Header};

use self::document::Document;
use crate::{ExportError, ExportOptions, Part};

/// Encodes the parts as binary glTF.
pub(crate) fn encode_glb(parts: &[Part<'_>], options: &ExportOptions) -> Result<Vec<u8>, ExportError> {
    let (document, bin) = Document::build(parts)?;
    let json = document.to_json(options, None)?;
    // 12 bytes of file header, 8 for each chunk, up to 3 of padding after each.
    let length = u32::try_from(json.len() + bin.len() + 34)
        .map_err(|_| ExportError::TooLarge { what: format!("{} bytes of geometry in a GLB", bin.len()) })?;
    let glb = Glb {
        // The library computes the length that it writes; this one is only required to be there.
        header: Header { magic: *b"glTF", version: 2, length },
        json: Cow::Owned(json),
        bin: (!bin.is_empty()).then_some(Cow::Owned(bin)),
    };
    glb.to_vec().map_err(|error| ExportError::Encode { format: "GLB", message: error.to_string() })
}

/// Encodes the parts as glTF JSON with the buffer in a data URI.
pub(crate) fn encode_gltf(parts: &[Part<'_>], options: &ExportOptions) -> Result<Vec<u8>, ExportError> {
    let (document, bin) = Document::build(parts)?;
    let uri = (!bin.is_empty()).then(|| base64::data_uri(&bin));
    document.to_json(options, uri)
}
