//! Wavefront OBJ in full precision, and its materials (MTL).
//!
//! Coordinates are the shortest decimals that read back as the same `f64`. Vertices are written once each as they are
//! indexed in the mesh, never merged by coordinates, so the file has the mesh's own topology. Normals of flat faces are left out: `s off` asks for
//! flat shading.

use std::io::{self, Write};

use crate::decimal::{write_decimal, write_digits, write_point};
use crate::material::{Library, linear_to_srgb, material_color};
use crate::part::{ExportOptions, Shading};
use crate::pieces::{Numbers, Pieces};
use crate::surface::Vertices;
use crate::{ExportError, MeshPieces, Part};

/// Writes each part as an object (`o`) with a group (`g`) and `usemtl` for each of its materials, Z-up.
pub(crate) fn write_obj(parts: &[Part<'_>], options: &ExportOptions, out: &mut dyn Write) -> Result<(), ExportError> {
    write_header(options, out)?;
    let (library, places) = Library::of(parts, material_name);
    let (mut vertex, mut first) = (1, First::default());
    for (part, places) in parts.iter().zip(&places) {
        write_part(part, (&library, places), &Numbers::From(vertex), options, &mut first, out)?;
        vertex += part.mesh.positions.len() as u64;
    }
    Ok(())
}

/// Writes each piece as an object. Vertices that pieces share stand before the triangles of the first that has them.
pub(crate) fn write_obj_pieces(
    pieces: &Pieces<'_>,
    options: &ExportOptions,
    out: &mut dyn Write,
) -> Result<(), ExportError> {
    write_header(options, out)?;
    let (mut library, mut first) = (Library::default(), First::default());
    let mut numbering = pieces.numbering(1);
    for number in 0..pieces.count() {
        let piece = pieces.read(number)?;
        let places = library.add(&piece.mesh.materials, material_name);
        let numbers = numbering.of_piece(&piece);
        write_part(&piece.part(), (&library, &places), &numbers.as_numbers(), options, &mut first, out)?;
    }
    Ok(())
}

fn write_header(options: &ExportOptions, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, concat!("# planecut ", env!("CARGO_PKG_VERSION"), ", Z up"))?;
    if let Some(name) = &options.material_library {
        writeln!(out, "mtllib {}", token(name, "materials.mtl"))?;
    }
    Ok(())
}

/// Writes the materials of parts as the library (MTL) of the OBJ file that [`write_parts`](crate::write_parts) makes of them. Colours are as a screen
/// shows them (sRGB); `Pm` and `Pr` are metallic and roughness.
///
/// # Errors
/// [`ExportError::Io`] where the writer takes no more.
pub fn write_mtl(parts: &[Part<'_>], out: &mut dyn Write) -> Result<(), ExportError> {
    write_library(&Library::of(parts, material_name).0, out)
}

/// The same for the OBJ file that [`write_pieces`](crate::write_pieces) makes of pieces, each of which is read once.
///
/// # Errors
/// [`ExportError::ReadPiece`] where one cannot be read, and [`ExportError::Io`] where the writer takes no more.
pub fn write_mtl_of_pieces(pieces: &dyn MeshPieces, out: &mut dyn Write) -> Result<(), ExportError> {
    let mut library = Library::default();
    for piece in 0..pieces.count() {
        let mesh = pieces.piece(piece).map_err(|source| ExportError::ReadPiece { piece, source })?;
        library.add(&mesh.materials, material_name);
    }
    write_library(&library, out)
}

fn write_library(library: &Library, out: &mut dyn Write) -> Result<(), ExportError> {
    writeln!(out, concat!("# planecut ", env!("CARGO_PKG_VERSION")))?;
    for (name, material) in library.materials() {
        write!(out, "newmtl {name}\nKd")?;
        for channel in material_color(material) {
            write!(out, " {:.4}", linear_to_srgb(channel))?;
        }
        writeln!(out, "\nd 1")?;
        for (key, value) in [("Pm", material.metallic), ("Pr", material.roughness)] {
            if let Some(value) = value.filter(|value| value.is_finite()) {
                writeln!(out, "{key} {value:.4}")?;
            }
        }
    }
    Ok(())
}

fn material_name(name: &str) -> String {
    token(name, "material")
}

/// The numbers of the next part's first lines of each kind but vertices.
struct First {
    texture: u64,
    normal: u64,
}

impl Default for First {
    fn default() -> Self {
        Self { texture: 1, normal: 1 }
    }
}

fn write_part(
    part: &Part<'_>,
    (library, places): (&Library, &[u32]),
    numbers: &Numbers<'_>,
    options: &ExportOptions,
    first: &mut First,
    out: &mut dyn Write,
) -> Result<(), ExportError> {
    let Part { name, mesh, sources } = *part;
    writeln!(out, "o {}", token(name, "solid"))?;
    for vertex in numbers.own(mesh.positions.len()) {
        out.write_all(b"v")?;
        write_point(mesh.positions[vertex] * options.scale, out)?;
        out.write_all(b"\n")?;
    }
    let place = |triangle: &u32| {
        let face = mesh.triangle_faces[*triangle as usize];
        places[mesh.faces[face as usize].material.0 as usize]
    };
    let mut triangles: Vec<u32> = (0..mesh.triangles.len() as u32).collect();
    triangles.sort_by_key(place);
    let is_smooth = options.shading != Shading::Flat;
    let has_attributes = is_smooth || options.texture.is_some();
    let attributes = has_attributes.then(|| Vertices::of(mesh, sources, &triangles, is_smooth, options));
    if let Some(vertices) = &attributes {
        write_attributes(vertices, is_smooth, out)?;
    }
    writeln!(out, "s {}", if is_smooth { "1" } else { "off" })?;
    let mut place_in_list = 0;
    for group in triangles.chunk_by(|a, b| place(a) == place(b)) {
        let (name, _) = &library.materials()[place(&group[0]) as usize];
        writeln!(out, "g {name}\nusemtl {name}")?;
        for triangle in group {
            out.write_all(b"f")?;
            for corner in mesh.triangles[*triangle as usize] {
                out.write_all(b" ")?;
                write_digits(numbers.of(corner), out)?;
                if let Some(vertices) = &attributes {
                    let vertex = u64::from(vertices.corners[place_in_list]);
                    out.write_all(b"/")?;
                    if !vertices.texture.is_empty() {
                        write_digits(first.texture + vertex, out)?;
                    }
                    if is_smooth {
                        out.write_all(b"/")?;
                        write_digits(first.normal + vertex, out)?;
                    }
                }
                place_in_list += 1;
            }
            out.write_all(b"\n")?;
        }
    }
    if let Some(vertices) = &attributes {
        first.texture += vertices.texture.len() as u64;
        first.normal += if is_smooth { vertices.normals.len() as u64 } else { 0 };
    }
    Ok(())
}

fn write_attributes(vertices: &Vertices, has_normals: bool, out: &mut dyn Write) -> io::Result<()> {
    for [u, v] in &vertices.texture {
        out.write_all(b"vt ")?;
        write_decimal(f64::from(*u), out)?;
        out.write_all(b" ")?;
        // upward in this format
        write_decimal(1.0 - f64::from(*v), out)?;
        out.write_all(b"\n")?;
    }
    for normal in vertices.normals.iter().filter(|_| has_normals) {
        out.write_all(b"vn")?;
        write_point(glam::Vec3::from(*normal).as_dvec3(), out)?;
        out.write_all(b"\n")?;
    }
    Ok(())
}

/// `name` with white space and control characters replaced, or `fallback` for an empty one: words end at white space here.
fn token(name: &str, fallback: &str) -> String {
    let safe: String = name.chars().map(|c| if c.is_whitespace() || c.is_control() { '_' } else { c }).collect();
    if safe.is_empty() { fallback.to_owned() } else { safe }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_single_words() {
        let words = ["a b", "a\nb", "", "Wände"].map(|name| token(name, "material"));
        assert_eq!(words, ["a_b", "a_b", "material", "Wände"]);
    }
}
