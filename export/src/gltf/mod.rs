//! glTF 2.0, binary and as JSON.
//!
//! The scene is one root node, which turns Z-up into glTF's Y-up and carries the scale, with a mesh node for each part.
//! Every mesh node is translated to a point near the part's centre, so that single-precision positions are small. Parts that are alike share
//! a mesh.
//!
//! Way of a mesh through this folder: [`repeats`] finds parts that are alike, [`origin`] chooses the translation, [`rounding`] says where positions are stored, [`geometry`] splits vertices
//! and remembers which belong together, with [`tangents`] where they are asked for; [`sections`] lays out the arrays, [`packed`] compresses them,
//! [`document`] describes them in JSON. Arrays are written as they are made: the file is never in memory as a whole.

mod base64;
mod document;
mod geometry;
mod origin;
#[cfg_attr(not(feature = "meshopt"), path = "packed_missing.rs")]
mod packed;
mod repeats;
mod rounding;
mod sections;
mod tangents;

use std::borrow::Cow;
use std::io::Write;

use self::base64::Base64Writer;
use glam::DVec3;
use planecut_csg::Mesh;
use planecut_parallel::prelude::*;

use self::document::Document;
use self::geometry::has_three_corners;
use self::repeats::Repeats;
use self::rounding::Rounding;
use crate::{ExportError, ExportOptions, Part, Written};

/// What a GLB begins with, and its version.
const MAGIC: [u8; 4] = *b"glTF";
const VERSION: u32 = 2;
/// Stands for the buffer in JSON until that is written.
const BUFFER: &str = "planecut:buffer";

/// Writes the parts as binary glTF.
pub(crate) fn write_glb(parts: &[Part<'_>], options: &ExportOptions, out: &mut dyn Write) -> Result<(), ExportError> {
    let document = Document::build(parts, options)?;
    let mut json = document.to_json(None)?;
    json.resize(json.len().next_multiple_of(4), b' ');
    let bin = document.buffer_bytes();
    // 12 bytes of file header, 8 for each chunk
    let length = 12 + 8 + json.len() + if bin > 0 { 8 + bin } else { 0 };
    let length = u32::try_from(length)
        .map_err(|_| ExportError::TooLarge { what: format!("{bin} bytes of geometry in a GLB") })?;
    out.write_all(&MAGIC)?;
    out.write_all(&VERSION.to_le_bytes())?;
    out.write_all(&length.to_le_bytes())?;
    out.write_all(&(json.len() as u32).to_le_bytes())?;
    out.write_all(b"JSON")?;
    out.write_all(&json)?;
    if bin > 0 {
        out.write_all(&(bin as u32).to_le_bytes())?;
        out.write_all(b"BIN\0")?;
        document.write_buffer(out)?;
    }
    Ok(())
}

/// Writes the parts as glTF JSON with the buffer in a data URI.
pub(crate) fn write_gltf(parts: &[Part<'_>], options: &ExportOptions, out: &mut dyn Write) -> Result<(), ExportError> {
    let document = Document::build(parts, options)?;
    if document.buffer_bytes() == 0 {
        return Ok(out.write_all(&document.to_json(None)?)?);
    }
    let json = document.to_json(Some(BUFFER))?;
    // quotes in names are escaped, so these stand in the buffer's object alone
    let field = format!("\"uri\":\"{BUFFER}\"");
    let Some(place) = json.windows(field.len()).position(|bytes| bytes == field.as_bytes()) else {
        return Err(ExportError::Encode { format: "glTF", message: "no place for the buffer".to_owned() });
    };
    let (before, after) = (&json[..place], &json[place + field.len()..]);
    out.write_all(before)?;
    out.write_all(b"\"uri\":\"data:application/octet-stream;base64,")?;
    let mut base64 = Base64Writer::new(out);
    document.write_buffer(&mut base64)?;
    base64.finish()?;
    out.write_all(b"\"")?;
    Ok(out.write_all(after)?)
}

/// What a file of the parts holds.
pub(crate) fn written(parts: &[Part<'_>], options: &ExportOptions) -> Result<Written, ExportError> {
    let repeats = Repeats::of(parts, options);
    let reduced = |part: &usize| -> (Rounding, Cow<'_, Mesh>) {
        let mesh = parts[*part].mesh;
        let rounding = Rounding::of(&mesh.positions, options);
        (rounding, rounding.reduced(mesh))
    };
    let meshes: Vec<(Rounding, Cow<'_, Mesh>)> = repeats.firsts().par_iter().map(reduced).collect();
    let mut written = Written::default();
    for (part, repeat) in parts.iter().zip(repeats.iter()) {
        let (rounding, mesh) = &meshes[repeat.first];
        written.push(part, mesh, has_three_corners, |position| rounding.place(position) + repeat.moved)?;
    }
    Ok(written)
}

/// For each position of one mesh one near it that a file stores as it is.
pub(crate) fn stored_positions(positions: &[DVec3], options: &ExportOptions) -> Vec<DVec3> {
    let step = rounding::exact_step(positions, options);
    positions.iter().map(|position| (*position / step).round() * step).collect()
}
