//! glTF 2.0, binary and as JSON.
//!
//! The scene is one root node, which turns Z-up into glTF's Y-up and carries the scale, with a mesh node for each part.
//! Every mesh node is translated to a point near the part's centre, so that single-precision positions are small. Parts that are alike share
//! a mesh.
//!
//! Way of a mesh through this folder: [`repeats`] finds parts that are alike, [`origin`] chooses the translation, [`rounding`] says where positions are stored, [`geometry`] splits vertices
//! and remembers which belong together, with [`tangents`] where they are asked for; [`sections`] lays out the arrays, [`packed`] compresses them, [`group`] has both for meshes that lie together,
//! [`document`] describes them in JSON, with [`arrays`]. [`pieces`] does this for one mesh after another. Arrays are written as they are made: the file is never in memory as a whole.

mod arrays;
mod base64;
mod document;
mod geometry;
mod group;
mod origin;
#[cfg_attr(not(feature = "meshopt"), path = "packed_missing.rs")]
mod packed;
mod pieces;
mod repeats;
mod rounding;
mod sections;
mod tangents;

use std::borrow::Cow;
use std::io::{self, Write};

use self::base64::Base64Writer;
use glam::DVec3;
use planecut_csg::Mesh;
use planecut_parallel::prelude::*;

use self::document::Document;
use self::geometry::Geometry;
use self::group::Group;
use self::repeats::Repeats;
use self::rounding::Rounding;
use crate::surface::has_three_corners;
use crate::{ExportError, ExportOptions, Part, Written};

/// What a GLB begins with, and its version.
const MAGIC: [u8; 4] = *b"glTF";
const VERSION: u32 = 2;
/// Stands for the buffer in JSON until that is written.
const BUFFER: &str = "planecut:buffer";

pub(crate) use self::pieces::{write_glb_pieces, write_gltf_pieces};

/// Writes the parts as binary glTF.
pub(crate) fn write_glb(parts: &[Part<'_>], options: &ExportOptions, out: &mut dyn Write) -> Result<(), ExportError> {
    let (document, group) = described(parts, options)?;
    write_binary(&document, &mut |out| group.write(out), out)
}

/// Writes the parts as glTF JSON with the buffer in a data URI.
pub(crate) fn write_gltf(parts: &[Part<'_>], options: &ExportOptions, out: &mut dyn Write) -> Result<(), ExportError> {
    let (document, group) = described(parts, options)?;
    write_text(&document, &mut |out| group.write(out), out)
}

/// The parts and their description. One without triangles becomes a node without a mesh; those that are alike share a mesh.
fn described<'a>(parts: &[Part<'a>], options: &ExportOptions) -> Result<(Document, Group<'a>), ExportError> {
    let repeats = Repeats::of(parts, options);
    let firsts: Vec<&Part<'a>> = repeats.firsts().iter().map(|part| &parts[*part]).collect();
    let geometry = |part: &&Part<'a>| Geometry::new(part, Rounding::of(&part.mesh.positions, options), options);
    let meshes = firsts.par_iter().map(geometry).collect::<Result<_, _>>()?;
    let mut group = Group::new(meshes, options)?;
    let names: Vec<&str> = firsts.iter().map(|part| part.name).collect();
    let mut document = Document::new(options);
    let meshes = document.push_group(&mut group, &names);
    for (part, repeat) in parts.iter().zip(repeats.iter()) {
        let rounding = group.meshes[repeat.first].rounding;
        document.push_node(part.name, meshes[repeat.first], rounding.origin + repeat.moved, rounding.step);
    }
    document.finish();
    Ok((document, group))
}

/// Writes the buffer of a file.
type WriteBuffer<'a> = &'a mut dyn FnMut(&mut dyn Write) -> io::Result<()>;

fn write_binary(document: &Document, write_buffer: WriteBuffer<'_>, out: &mut dyn Write) -> Result<(), ExportError> {
    let mut json = document.to_json(None)?;
    json.resize(json.len().next_multiple_of(4), b' ');
    let bin = document.buffer_bytes();
    let length = length_of(json.len(), bin)?;
    out.write_all(&MAGIC)?;
    out.write_all(&VERSION.to_le_bytes())?;
    out.write_all(&length.to_le_bytes())?;
    out.write_all(&(json.len() as u32).to_le_bytes())?;
    out.write_all(b"JSON")?;
    out.write_all(&json)?;
    if bin > 0 {
        out.write_all(&(bin as u32).to_le_bytes())?;
        out.write_all(b"BIN\0")?;
        write_buffer(out)?;
    }
    Ok(())
}

fn write_text(document: &Document, write_buffer: WriteBuffer<'_>, out: &mut dyn Write) -> Result<(), ExportError> {
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
    write_buffer(&mut base64)?;
    base64.finish()?;
    out.write_all(b"\"")?;
    Ok(out.write_all(after)?)
}

/// The length that a file says of itself.
fn length_of(json: usize, bin: usize) -> Result<u32, ExportError> {
    // 12 bytes of file header, 8 for each chunk
    let length = 12 + 8 + json as u64 + if bin > 0 { 8 + bin as u64 } else { 0 };
    u32::try_from(length).map_err(|_| ExportError::TooLarge { what: format!("{bin} bytes of geometry in a GLB") })
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
