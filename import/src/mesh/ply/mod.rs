//! PLY: ASCII, and binary in either byte order.

mod body;
mod header;

use glam::DVec3;

use super::error::{Fault, Place};
use super::polygon::{MAX_CONCAVE_CORNERS, triangulate};
use super::{IndexedMesh, Precision};

use body::Body;
use header::{Element, Header, Property, Scalar};

/// Reads a PLY file: `x`, `y`, `z` of its element `vertex` and the list `vertex_indices` (or `vertex_index`) of its element
/// `face`. All else is passed over.
pub(super) fn read(bytes: &[u8]) -> Result<IndexedMesh, Fault> {
    let (header, mut body) = header::read(bytes)?;
    let mut positions = None;
    let mut triangles = None;
    for element in &header.elements {
        // Each record takes at least this number of bytes: a count that the file cannot hold is refused before anything is allocated.
        let least = element.least_size(header.encoding) as u128 * element.count as u128;
        if least > body.remaining() as u128 {
            let found =
                format!("{} bytes for {} records of element `{}`", body.remaining(), element.count, element.name);
            return Err(Fault::new(body.place(), found, format!("at least {least}")));
        }
        match element.name.as_str() {
            "vertex" if positions.is_none() => positions = Some(read_vertices(element, &mut body)?),
            "face" if triangles.is_none() => {
                let Some(positions) = &positions else {
                    return Err(Fault::new(body.place(), "element `face` first", "element `vertex` before it"));
                };
                triangles = Some(read_faces(element, positions, &mut body)?);
            }
            _ => skip(element, &mut body)?,
        }
    }
    let positions = positions.ok_or_else(|| Fault::whole("no element `vertex`", "one"))?;
    let (triangles, places) = triangles.ok_or_else(|| Fault::whole("no element `face`", "one"))?;
    Ok(IndexedMesh { places, ..IndexedMesh::plain(positions, triangles, precision(&header)) })
}

fn precision(header: &Header) -> Precision {
    let vertex = header.elements.iter().find(|e| e.name == "vertex");
    let is_single = |p: &&Property| p.list_length.is_none() && p.name == "x" && p.scalar == Scalar::F32;
    if vertex.is_some_and(|v| v.properties.iter().any(|p| is_single(&p))) {
        Precision::Single
    } else {
        Precision::Double
    }
}

fn read_vertices(element: &Element, body: &mut Body<'_>) -> Result<Vec<DVec3>, Fault> {
    let axis = |p: &Property| ["x", "y", "z"].iter().position(|&name| p.list_length.is_none() && p.name == name);
    let axes: Vec<Option<usize>> = element.properties.iter().map(axis).collect();
    if let Some(missing) = (0..3).find(|&k| !axes.contains(&Some(k))) {
        let name = ["x", "y", "z"][missing];
        return Err(Fault::whole(format!("no property `{name}` in element `vertex`"), "`x`, `y` and `z`"));
    }
    let mut positions = Vec::with_capacity(element.count);
    for _ in 0..element.count {
        let mut position = DVec3::ZERO;
        for (property, axis) in element.properties.iter().zip(&axes) {
            match axis {
                Some(axis) => position[*axis] = body.scalar(property.scalar)?,
                None => skip_property(property, body)?,
            }
        }
        if !position.is_finite() {
            return Err(Fault::new(body.place(), format!("the vertex {position}"), "finite coordinates"));
        }
        positions.push(position);
    }
    Ok(positions)
}

/// The triangles, and where the face of each begins.
fn read_faces(
    element: &Element,
    positions: &[DVec3],
    body: &mut Body<'_>,
) -> Result<(Vec<[u32; 3]>, Vec<Place>), Fault> {
    let is_indices =
        |p: &&Property| p.list_length.is_some() && ["vertex_indices", "vertex_index"].contains(&p.name.as_str());
    let Some(indices) = element.properties.iter().find(is_indices) else {
        return Err(Fault::whole("no list `vertex_indices` in element `face`", "one"));
    };
    let mut triangles = Vec::with_capacity(element.count);
    let mut places = Vec::with_capacity(element.count);
    let mut corners = Vec::new();
    for _ in 0..element.count {
        let before = body.place();
        for property in &element.properties {
            if !std::ptr::eq(property, indices) {
                skip_property(property, body)?;
                continue;
            }
            let length = list_length(property, body)?;
            corners.clear();
            for _ in 0..length {
                corners.push(vertex_index(body.scalar(property.scalar)?, positions.len(), body)?);
            }
        }
        let count = corners.len();
        if count < 3 {
            return Err(Fault::new(body.place(), format!("a face with {count} corners"), "at least 3"));
        }
        if !triangulate(&corners, positions, &mut triangles) {
            let expected = format!("at most {MAX_CONCAVE_CORNERS} where it is not convex");
            return Err(Fault::new(body.place(), format!("a face with {count} corners"), expected));
        }
        // of text the words are known once they are read
        let place = if matches!(body, Body::Ascii(_)) { body.place() } else { before };
        places.resize(triangles.len(), place);
    }
    Ok((triangles, places))
}

fn vertex_index(value: f64, count: usize, body: &Body<'_>) -> Result<u32, Fault> {
    let index = value as u32;
    if f64::from(index) == value && (index as usize) < count {
        return Ok(index);
    }
    Err(Fault::new(body.place(), format!("vertex index {value}"), format!("a whole number from 0, below {count}")))
}

/// Reads the length of a list. It may be too long for the file: the reading of its items finds that out.
fn list_length(property: &Property, body: &mut Body<'_>) -> Result<u64, Fault> {
    let Some(kind) = property.list_length else { return Ok(1) };
    let value = body.scalar(kind)?;
    let length = value as u64;
    if length as f64 == value {
        return Ok(length);
    }
    Err(Fault::new(body.place(), format!("list length {value}"), "a whole number from 0"))
}

fn skip(element: &Element, body: &mut Body<'_>) -> Result<(), Fault> {
    if element.properties.is_empty() {
        return Ok(());
    }
    (0..element.count).try_for_each(|_| element.properties.iter().try_for_each(|p| skip_property(p, body)))
}

fn skip_property(property: &Property, body: &mut Body<'_>) -> Result<(), Fault> {
    let length = list_length(property, body)?;
    (0..length).try_for_each(|_| body.scalar(property.scalar).map(drop))
}
