//! glTF of pieces: each is described and its arrays are put aside in a temporary file before the next is read; then the description is written, and the arrays
//! behind it.

use std::fs::File;
use std::io::{self, BufReader, BufWriter, Seek, Write};

use super::document::Document;
use super::geometry::Geometry;
use super::group::Group;
use super::rounding::Rounding;
use super::{length_of, write_binary, write_text};
use crate::pieces::Pieces;
use crate::{ExportError, ExportOptions};

/// Bytes that are handed on at a time.
const BUFFER: usize = 1 << 16;

/// Writes pieces as binary glTF, a mesh node for each.
pub(crate) fn write_glb_pieces(
    pieces: &Pieces<'_>,
    options: &ExportOptions,
    out: &mut dyn Write,
) -> Result<(), ExportError> {
    let (document, mut arrays) = described(pieces, options, |bytes| length_of(0, bytes).map(|_| ()))?;
    write_binary(&document, &mut |out| copy(&mut arrays, out), out)
}

/// The same as glTF JSON with the buffer in a data URI.
pub(crate) fn write_gltf_pieces(
    pieces: &Pieces<'_>,
    options: &ExportOptions,
    out: &mut dyn Write,
) -> Result<(), ExportError> {
    let (document, mut arrays) = described(pieces, options, |_| Ok(()))?;
    write_text(&document, &mut |out| copy(&mut arrays, out), out)
}

/// The description of the pieces and a file with their arrays; `check` is told how long that is whenever it has grown, before it does.
fn described(
    pieces: &Pieces<'_>,
    options: &ExportOptions,
    check: impl Fn(usize) -> Result<(), ExportError>,
) -> Result<(Document, File), ExportError> {
    let boxes: Vec<_> = pieces.bounds().collect();
    let mut document = Document::new(options);
    let mut arrays = BufWriter::with_capacity(BUFFER, pieces.temporary_file()?);
    for (number, rounding) in Rounding::in_common(&boxes, options).into_iter().enumerate() {
        let piece = pieces.read(number)?;
        let mut group = Group::new(vec![Geometry::new(&piece.part(), rounding, options)?], options)?;
        let mesh = document.push_group(&mut group, &[&piece.name]).pop().flatten();
        document.push_node(&piece.name, mesh, rounding.origin, rounding.step);
        check(document.buffer_bytes())?;
        group.write(&mut arrays)?;
    }
    document.finish();
    Ok((document, arrays.into_inner().map_err(io::IntoInnerError::into_error)?))
}

/// Writes what is in a file.
fn copy(file: &mut File, out: &mut dyn Write) -> io::Result<()> {
    file.rewind()?;
    io::copy(&mut BufReader::with_capacity(BUFFER, file), out).map(|_| ())
}
