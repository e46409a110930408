//! PLY: ASCII, and binary in either byte order.

mod body;
mod header;

use glam::{DVec2, DVec3};

use super::colors::{Color, linear, mean};
use super::error::{Fault, Place};
use super::polygon::{MAX_CONCAVE_CORNERS, triangulate};
use super::{IndexedMesh, Precision, textures};

use body::Body;
use header::{Element, Header, Property, Scalar};

/// Reads a PLY file: `x`, `y`, `z` of its element `vertex` and the list `vertex_indices` (or `vertex_index`) of its element
/// `face`, and `red`, `green`, `blue` of either; those of faces come first. So do their texture coordinates, where these are asked for: the list
/// `texcoord` of faces, or two properties of vertices. All else is passed over.
pub(super) fn read(bytes: &[u8], has_textures: bool) -> Result<IndexedMesh, Fault> {
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
            "vertex" if positions.is_none() => positions = Some(read_vertices(element, &mut body, has_textures)?),
            "face" if triangles.is_none() => {
                let Some(positions) = &positions else {
                    return Err(Fault::new(body.place(), "element `face` first", "element `vertex` before it"));
                };
                triangles = Some(read_faces(element, &positions.positions, &mut body, has_textures)?);
            }
            _ => skip(element, &mut body)?,
        }
    }
    let Vertices { positions, colors: of_vertex, coordinates } =
        positions.ok_or_else(|| Fault::whole("no element `vertex`", "one"))?;
    let Faces { triangles, places, colors, textures } =
        triangles.ok_or_else(|| Fault::whole("no element `face`", "one"))?;
    let textures = if textures.is_empty() { textures::of_vertices(&triangles, &coordinates) } else { textures };
    let of_corners = |triangle: &[u32; 3]| mean(triangle.map(|corner| of_vertex.get(corner as usize).copied()));
    let colors = match (colors.is_empty(), of_vertex.is_empty()) {
        (false, _) => colors.into_iter().map(Some).collect(),
        (true, false) => triangles.iter().map(of_corners).collect(),
        (true, true) => Vec::new(),
    };
    Ok(IndexedMesh { places, colors, textures, ..IndexedMesh::plain(positions, triangles, precision(&header)) })
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

/// Records of `vertex`; colours and texture coordinates where they have them.
struct Vertices {
    positions: Vec<DVec3>,
    colors: Vec<Color>,
    coordinates: Vec<DVec2>,
}

/// Records of `face`, cut into triangles: where the face of each begins, and its colour and texture coordinates where they have some.
struct Faces {
    triangles: Vec<[u32; 3]>,
    places: Vec<Place>,
    colors: Vec<Color>,
    textures: Vec<Option<[DVec2; 3]>>,
}

/// Which of both texture coordinates each property is; none where one is missing.
fn texture_axes(element: &Element) -> Vec<Option<usize>> {
    const NAMES: [[&str; 2]; 3] = [["s", "t"], ["u", "v"], ["texture_u", "texture_v"]];
    let axes = |names: [&str; 2]| -> Vec<Option<usize>> {
        let axis = |p: &Property| names.iter().position(|&name| p.list_length.is_none() && p.name == name);
        element.properties.iter().map(axis).collect()
    };
    let is_whole = |axes: &Vec<Option<usize>>| (0..2).all(|axis| axes.contains(&Some(axis)));
    NAMES.into_iter().map(axes).find(is_whole).unwrap_or_else(|| vec![None; element.properties.len()])
}

/// Which channel of a colour each property is; none where a channel is missing.
fn channels(element: &Element) -> Vec<Option<usize>> {
    const NAMES: [&str; 3] = ["red", "green", "blue"];
    let channel = |p: &Property| NAMES.iter().position(|&name| p.list_length.is_none() && p.name == name);
    let channels: Vec<Option<usize>> = element.properties.iter().map(channel).collect();
    let is_there = (0..3).all(|channel| channels.contains(&Some(channel)));
    if is_there { channels } else { vec![None; element.properties.len()] }
}

/// A channel on the linear scale of light; whole numbers stand for fractions of the largest.
fn channel_value(value: f64, scalar: Scalar) -> f32 {
    linear(match scalar {
        Scalar::U8 | Scalar::I8 => value / 255.0,
        Scalar::U16 | Scalar::I16 => value / 65535.0,
        Scalar::U32 | Scalar::I32 => value / f64::from(u32::MAX),
        Scalar::F32 | Scalar::F64 => value,
    })
}

fn read_vertices(element: &Element, body: &mut Body<'_>, has_textures: bool) -> Result<Vertices, Fault> {
    let axis = |p: &Property| ["x", "y", "z"].iter().position(|&name| p.list_length.is_none() && p.name == name);
    let axes: Vec<Option<usize>> = element.properties.iter().map(axis).collect();
    if let Some(missing) = (0..3).find(|&k| !axes.contains(&Some(k))) {
        let name = ["x", "y", "z"][missing];
        return Err(Fault::whole(format!("no property `{name}` in element `vertex`"), "`x`, `y` and `z`"));
    }
    let channels = channels(element);
    let has_colors = channels.iter().any(Option::is_some);
    let of_texture = if has_textures { texture_axes(element) } else { vec![None; axes.len()] };
    let has_textures = of_texture.iter().any(Option::is_some);
    let mut positions = Vec::with_capacity(element.count);
    let (mut colors, mut coordinates) = (Vec::new(), Vec::new());
    for _ in 0..element.count {
        let (mut position, mut color, mut at) = (DVec3::ZERO, Color::default(), DVec2::ZERO);
        for (property, part) in element.properties.iter().zip(axes.iter().zip(&channels).zip(&of_texture)) {
            match part {
                ((Some(axis), _), _) => position[*axis] = body.scalar(property.scalar)?,
                ((_, Some(channel)), _) => {
                    color[*channel] = channel_value(body.scalar(property.scalar)?, property.scalar);
                }
                (_, Some(axis)) => at[*axis] = body.scalar(property.scalar)?,
                _ => skip_property(property, body)?,
            }
        }
        if has_colors {
            colors.push(color);
        }
        if has_textures {
            coordinates.push(finite_coordinates(at, body)?);
        }
        if !position.is_finite() {
            return Err(Fault::new(body.place(), format!("the vertex {position}"), "finite coordinates"));
        }
        positions.push(position);
    }
    Ok(Vertices { positions, colors, coordinates })
}

/// Texture coordinates of the file, `v` down.
fn finite_coordinates(at: DVec2, body: &Body<'_>) -> Result<DVec2, Fault> {
    if at.is_finite() {
        return Ok(DVec2::new(at.x, textures::turned(at.y)));
    }
    Err(Fault::new(body.place(), format!("the texture coordinates {at}"), "finite ones"))
}

fn read_faces(element: &Element, positions: &[DVec3], body: &mut Body<'_>, has_textures: bool) -> Result<Faces, Fault> {
    let is_indices =
        |p: &&Property| p.list_length.is_some() && ["vertex_indices", "vertex_index"].contains(&p.name.as_str());
    let Some(indices) = element.properties.iter().find(is_indices) else {
        return Err(Fault::whole("no list `vertex_indices` in element `face`", "one"));
    };
    let mut triangles = Vec::with_capacity(element.count);
    let mut places = Vec::with_capacity(element.count);
    let channels = channels(element);
    let has_colors = channels.iter().any(Option::is_some);
    let is_texture = |p: &&Property| p.list_length.is_some() && p.name == "texcoord";
    let texture = if has_textures { element.properties.iter().find(is_texture) } else { None };
    let (mut corners, mut colors) = (Vec::new(), Vec::new());
    let (mut numbers, mut textures) = (Vec::new(), Vec::new());
    for _ in 0..element.count {
        let before = body.place();
        let mut color = Color::default();
        for (property, channel) in element.properties.iter().zip(&channels) {
            if let Some(channel) = channel {
                color[*channel] = channel_value(body.scalar(property.scalar)?, property.scalar);
                continue;
            }
            if texture.is_some_and(|texture| std::ptr::eq(property, texture)) {
                let length = list_length(property, body)?;
                numbers.clear();
                for _ in 0..length {
                    numbers.push(body.scalar(property.scalar)?);
                }
                continue;
            }
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
        let Some(cut) = triangulate(&corners, positions) else {
            let expected = format!("at most {MAX_CONCAVE_CORNERS} where it is not convex");
            return Err(Fault::new(body.place(), format!("a face with {count} corners"), expected));
        };
        triangles.extend(cut.iter().map(|triangle| triangle.map(|k| corners[k])));
        if texture.is_some() {
            let of_face = coordinates_of_face(&numbers, count, body)?;
            let at = |k: usize| of_face.get(k).copied();
            textures.extend(cut.iter().map(|triangle| textures::of_corners(triangle.map(at))));
        }
        // of text the words are known once they are read
        let place = if matches!(body, Body::Ascii(_)) { body.place() } else { before };
        places.resize(triangles.len(), place);
        if has_colors {
            colors.resize(triangles.len(), color);
        }
    }
    Ok(Faces { triangles, places, colors, textures: textures::known(textures) })
}

/// The texture coordinates of a face's corners: two numbers for each, or none at all.
fn coordinates_of_face(numbers: &[f64], corners: usize, body: &Body<'_>) -> Result<Vec<DVec2>, Fault> {
    if !numbers.is_empty() && numbers.len() != 2 * corners {
        let found = format!("{} numbers of `texcoord`", numbers.len());
        return Err(Fault::new(body.place(), found, format!("{} for {corners} corners", 2 * corners)));
    }
    numbers.chunks_exact(2).map(|at| finite_coordinates(DVec2::new(at[0], at[1]), body)).collect()
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
