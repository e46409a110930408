//! STL: a flat list of triangles in single precision, binary or as text.
//!
//! Corners are repeated for every triangle, so readers merge equal ones. Vertices that the weld has split on purpose fall
//! together there: use glTF or OBJ where topology matters. Edges too short for single precision are contracted.

use std::borrow::Cow;
use std::io::{self, Write};

use glam::DVec3;
use planecut_csg::Mesh;

use crate::pieces::Pieces;
use crate::surface::without_lost_edges;
use crate::{ExportError, ExportOptions, Part, Written};

const HEADER_BYTES: usize = 80;

/// Writes the triangles of all parts, Z-up, in the order of the meshes.
pub(crate) fn write_stl(parts: &[Part<'_>], options: &ExportOptions, out: &mut dyn Write) -> Result<(), ExportError> {
    let meshes = reduced(parts, options);
    meshes.iter().try_for_each(|mesh| check_range(&mesh.positions, options.scale))?;
    if options.text {
        write_text(parts, &meshes, options.scale, out)
    } else {
        write_binary(&meshes, options.scale, out)
    }
}

/// Writes the triangles of all pieces, as text in one solid. All pieces are read twice, after the survey: to count triangles, then to write them.
///
/// Equal corners are equal once rounded, so what neighbours share still fits. The edges that go may end at a seam, but not lie on it.
pub(crate) fn write_stl_pieces(
    pieces: &Pieces<'_>,
    options: &ExportOptions,
    out: &mut dyn Write,
) -> Result<(), ExportError> {
    let mut triangles = 0;
    for number in 0..pieces.count() {
        let piece = pieces.read(number)?;
        let mesh = reduced_mesh(&piece.mesh, options);
        check_range(&mesh.positions, options.scale)?;
        triangles += mesh.triangles.len() as u64;
    }
    let name = "planecut";
    if options.text {
        writeln!(out, "solid {name}")?;
    } else {
        write_header(triangles, out)?;
    }
    for number in 0..pieces.count() {
        let piece = pieces.read(number)?;
        let mesh = reduced_mesh(&piece.mesh, options);
        match options.text {
            true => write_text_triangles(&mesh, options.scale, out)?,
            false => write_binary_triangles(&mesh, options.scale, out)?,
        }
    }
    if options.text {
        writeln!(out, "endsolid {name}")?;
    }
    Ok(())
}

/// A mesh without the edges whose ends are stored as one place.
fn reduced_mesh<'a>(mesh: &'a Mesh, options: &ExportOptions) -> Cow<'a, Mesh> {
    without_lost_edges(mesh, |position| (position * options.scale).as_vec3())
}

/// The meshes of all parts without the edges whose ends are stored as one place.
fn reduced<'a>(parts: &[Part<'a>], options: &ExportOptions) -> Vec<Cow<'a, Mesh>> {
    parts.iter().map(|part| reduced_mesh(part.mesh, options)).collect()
}

/// What a file of the parts holds.
pub(crate) fn written(parts: &[Part<'_>], options: &ExportOptions) -> Result<Written, ExportError> {
    let mut written = Written::default();
    for (part, mesh) in parts.iter().zip(reduced(parts, options)) {
        let place = |position: DVec3| (position * options.scale).as_vec3().as_dvec3() / options.scale;
        written.push(part, &mesh, |_| true, place)?;
    }
    Ok(written)
}

fn write_binary(meshes: &[Cow<'_, Mesh>], scale: f64, out: &mut dyn Write) -> Result<(), ExportError> {
    let triangles: usize = meshes.iter().map(|mesh| mesh.triangles.len()).sum();
    write_header(triangles as u64, out)?;
    Ok(meshes.iter().try_for_each(|mesh| write_binary_triangles(mesh, scale, out))?)
}

fn write_header(triangles: u64, out: &mut dyn Write) -> Result<(), ExportError> {
    let count =
        u32::try_from(triangles).map_err(|_| ExportError::TooLarge { what: format!("{triangles} triangles") })?;
    // Must not begin with "solid": readers would take the file for a text one.
    let title = concat!("binary STL, planecut ", env!("CARGO_PKG_VERSION"), ", Z up").as_bytes();
    out.write_all(title)?;
    out.write_all(&[0; HEADER_BYTES][title.len()..])?;
    Ok(out.write_all(&count.to_le_bytes())?)
}

fn write_binary_triangles(mesh: &Mesh, scale: f64, out: &mut dyn Write) -> io::Result<()> {
    for triangle in 0..mesh.triangles.len() {
        for vector in vectors(mesh, triangle, scale) {
            vector.iter().try_for_each(|value| out.write_all(&value.to_le_bytes()))?;
        }
        out.write_all(&[0, 0])?;
    }
    Ok(())
}

fn write_text(
    parts: &[Part<'_>],
    meshes: &[Cow<'_, Mesh>],
    scale: f64,
    out: &mut dyn Write,
) -> Result<(), ExportError> {
    for (part, mesh) in parts.iter().zip(meshes) {
        // a name ends with its line
        let name: String = part.name.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        writeln!(out, "solid {name}")?;
        write_text_triangles(mesh, scale, out)?;
        writeln!(out, "endsolid {name}")?;
    }
    Ok(())
}

fn write_text_triangles(mesh: &Mesh, scale: f64, out: &mut dyn Write) -> io::Result<()> {
    for triangle in 0..mesh.triangles.len() {
        let [normal, a, b, c] = vectors(mesh, triangle, scale);
        write_line("facet normal", normal, out)?;
        out.write_all(b"outer loop\n")?;
        [a, b, c].into_iter().try_for_each(|corner| write_line("vertex", corner, out))?;
        out.write_all(b"endloop\nendfacet\n")?;
    }
    Ok(())
}

fn write_line(word: &str, [x, y, z]: [f32; 3], out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "{word} {x} {y} {z}")
}

/// The normal and the corners of a triangle.
fn vectors(mesh: &Mesh, triangle: usize, scale: f64) -> [[f32; 3]; 4] {
    let normal = mesh.faces[mesh.triangle_faces[triangle] as usize].normal.normalize();
    let [a, b, c] = mesh.triangles[triangle].map(|corner| mesh.positions[corner as usize] * scale);
    // Adding zero turns -0 into 0: some readers compare corners by their bits.
    [normal, a, b, c].map(|vector| (vector.as_vec3() + glam::Vec3::ZERO).to_array())
}

fn check_range(positions: &[DVec3], scale: f64) -> Result<(), ExportError> {
    match positions.iter().position(|position| !(*position * scale).as_vec3().is_finite()) {
        Some(vertex) => {
            let scaled = positions[vertex] * scale;
            Err(ExportError::CoordinateRange { vertex, value: scaled[scaled.abs().max_position()] })
        }
        None => Ok(()),
    }
}
