//! PLY (Stanford polygon format) in full precision, binary or as text: one list of vertices and triangles, with the colour of each triangle.

use std::io::Write;

use planecut_csg::Mesh;

use crate::decimal::{write_decimal, write_digits};
use crate::material::{linear_to_srgb, material_color};
use crate::part::{ExportOptions, Shading};
use crate::pieces::{Numbers, Piece, Pieces};
use crate::surface::Vertices;
use crate::{ExportError, Part};

/// Writes the triangles of all parts, Z-up. Vertices are those of the mesh, unless they have normals or texture coordinates: then they are split
/// where these differ.
pub(crate) fn write_ply(parts: &[Part<'_>], options: &ExportOptions, out: &mut dyn Write) -> Result<(), ExportError> {
    let split: Vec<Option<Vertices>> = parts.iter().map(|part| split_vertices(part, options)).collect();
    let vertices =
        |part: usize| split[part].as_ref().map_or(parts[part].mesh.positions.len(), |split| split.origins.len());
    let count: usize = (0..parts.len()).map(vertices).sum();
    let triangles: usize = parts.iter().map(|part| part.mesh.triangles.len()).sum();
    write_header(count as u64, triangles as u64, options, out)?;
    for (part, split) in parts.iter().zip(&split) {
        write_vertices(part.mesh, split.as_ref(), &Numbers::From(0), options, out)?;
    }
    let mut first = 0;
    for (number, part) in parts.iter().enumerate() {
        write_triangles(part.mesh, split[number].as_ref(), &Numbers::From(first), options.text, out)?;
        first += vertices(number) as u64;
    }
    Ok(())
}

/// Writes the triangles of all pieces. Those that are neighbours share vertices, unless these are split. All pieces are read twice, after the
/// survey: for vertices, then for triangles.
pub(crate) fn write_ply_pieces(
    pieces: &Pieces<'_>,
    options: &ExportOptions,
    out: &mut dyn Write,
) -> Result<(), ExportError> {
    let mut split_count = 0;
    if is_split(options) {
        each(pieces, options, |_, split, _| {
            split_count += split.map_or(0, |split| split.origins.len() as u64);
            Ok(())
        })?;
    }
    let count = if is_split(options) { split_count } else { pieces.vertices() };
    write_header(count, pieces.triangles(), options, out)?;
    each(pieces, options, |piece, split, numbers| write_vertices(&piece.mesh, split, numbers, options, out))?;
    each(pieces, options, |piece, split, numbers| write_triangles(&piece.mesh, split, numbers, options.text, out))
}

/// Hands on each piece, with its vertices where they are split, and their numbers.
fn each(
    pieces: &Pieces<'_>,
    options: &ExportOptions,
    mut take: impl FnMut(&Piece, Option<&Vertices>, &Numbers<'_>) -> Result<(), ExportError>,
) -> Result<(), ExportError> {
    let (mut numbering, mut first) = (pieces.numbering(0), 0);
    for number in 0..pieces.count() {
        let piece = pieces.read(number)?;
        match split_vertices(&piece.part(), options) {
            Some(split) => {
                take(&piece, Some(&split), &Numbers::From(first))?;
                first += split.origins.len() as u64;
            }
            None => take(&piece, None, &numbering.of_piece(&piece).as_numbers())?,
        }
    }
    Ok(())
}

fn has_normals(options: &ExportOptions) -> bool {
    options.shading != Shading::Flat
}

fn is_split(options: &ExportOptions) -> bool {
    has_normals(options) || options.texture.is_some()
}

/// The vertices of a part where they are not those of its mesh.
fn split_vertices(part: &Part<'_>, options: &ExportOptions) -> Option<Vertices> {
    let triangles: Vec<u32> = (0..part.mesh.triangles.len() as u32).collect();
    is_split(options).then(|| Vertices::of(part.mesh, part.sources, &triangles, has_normals(options), options))
}

fn write_header(
    vertices: u64,
    triangles: u64,
    options: &ExportOptions,
    out: &mut dyn Write,
) -> Result<(), ExportError> {
    // readers take numbers of vertices for signed
    if i32::try_from(vertices).is_err() {
        return Err(ExportError::TooLarge { what: format!("{vertices} vertices in a PLY file") });
    }
    let format = if options.text { "ascii" } else { "binary_little_endian" };
    writeln!(out, "ply\nformat {format} 1.0\ncomment planecut {}, Z up", env!("CARGO_PKG_VERSION"))?;
    writeln!(out, "element vertex {vertices}\nproperty double x\nproperty double y\nproperty double z")?;
    if has_normals(options) {
        writeln!(out, "property float nx\nproperty float ny\nproperty float nz")?;
    }
    if options.texture.is_some() {
        writeln!(out, "property float s\nproperty float t")?;
    }
    writeln!(out, "element face {triangles}\nproperty list uchar int vertex_indices")?;
    writeln!(out, "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header")?;
    Ok(())
}

fn write_vertices(
    mesh: &Mesh,
    split: Option<&Vertices>,
    numbers: &Numbers<'_>,
    options: &ExportOptions,
    out: &mut dyn Write,
) -> Result<(), ExportError> {
    let has_normals = has_normals(options);
    for vertex in numbers.own(split.map_or(mesh.positions.len(), |split| split.origins.len())) {
        let origin = split.map_or(vertex, |split| split.origins[vertex] as usize);
        let position = (mesh.positions[origin] * options.scale).to_array();
        let mut floats = Vec::new();
        if let Some(split) = split {
            floats.extend(split.normals[vertex].iter().filter(|_| has_normals));
            // upward in this format
            floats.extend(split.texture.get(vertex).iter().flat_map(|[u, v]| [*u, 1.0 - v]));
        }
        if options.text {
            for (place, value) in position.into_iter().chain(floats.into_iter().map(f64::from)).enumerate() {
                out.write_all(if place > 0 { b" " } else { b"" })?;
                write_decimal(value, out)?;
            }
            out.write_all(b"\n")?;
        } else {
            position.iter().try_for_each(|value| out.write_all(&value.to_le_bytes()))?;
            floats.iter().try_for_each(|value| out.write_all(&value.to_le_bytes()))?;
        }
    }
    Ok(())
}

fn write_triangles(
    mesh: &Mesh,
    split: Option<&Vertices>,
    numbers: &Numbers<'_>,
    is_text: bool,
    out: &mut dyn Write,
) -> Result<(), ExportError> {
    let byte = |share: f32| (linear_to_srgb(share) * f32::from(u8::MAX)).round() as u8;
    let colors: Vec<[u8; 3]> = mesh.materials.iter().map(|material| material_color(material).map(byte)).collect();
    for (triangle, face) in mesh.triangle_faces.iter().enumerate() {
        let corners = match split {
            Some(split) => std::array::from_fn(|k| split.corners[3 * triangle + k]),
            None => mesh.triangles[triangle],
        };
        let corners: [u32; 3] = corners.map(|corner| numbers.of(corner) as u32);
        let color = colors[mesh.faces[*face as usize].material.0 as usize];
        if is_text {
            out.write_all(b"3")?;
            for value in corners.into_iter().chain(color.map(u32::from)) {
                out.write_all(b" ")?;
                write_digits(u64::from(value), out)?;
            }
            out.write_all(b"\n")?;
        } else {
            out.write_all(&[3])?;
            corners.iter().try_for_each(|corner| out.write_all(&corner.to_le_bytes()))?;
            out.write_all(&color)?;
        }
    }
    Ok(())
}
