//! Wavefront OBJ: `v` with colours, `vt` where it is asked for, `f`, `o`, `g` and `usemtl`; all other statements are passed over.

use std::borrow::Cow;

use glam::{DVec2, DVec3};
use planecut_csg::Material;

use super::colors::{Color, linear, mean};
use super::decimals::Decimals;
use super::error::{Fault, Place, quoted};
use super::polygon::{MAX_CONCAVE_CORNERS, triangulate};
use super::text::finite;
use super::{IndexedMesh, no_triangles, objects_from_starts, textures};

/// Reads an OBJ file. Faces may name vertices that are defined before them, by position from either end.
pub(super) fn read(bytes: &[u8], has_textures: bool) -> Result<IndexedMesh, Fault> {
    let mut reader = ObjReader { has_textures, ..ObjReader::default() };
    for (line, statement) in (Statements { rest: bytes, line: 1 }) {
        reader.statement(&statement, line)?;
    }
    let colors = reader.triangle_colors();
    let textures = textures::known(std::mem::take(&mut reader.textures));
    let ObjReader { positions, decimals, triangles, places, materials, material_of, objects, groups, .. } = reader;
    let starts = if objects.is_empty() { groups } else { objects };
    if triangles.is_empty() && starts.is_empty() {
        return Err(no_triangles());
    }
    let objects = objects_from_starts(starts, triangles.len());
    let precision = decimals.precision();
    let material_of = if materials.is_empty() { Vec::new() } else { material_of };
    Ok(IndexedMesh { positions, triangles, objects, precision, materials, material_of, colors, textures, places })
}

/// The statements with the line on which each begins: lines, of which those that end in a backslash are joined with the next.
struct Statements<'a> {
    rest: &'a [u8],
    line: usize,
}

impl<'a> Iterator for Statements<'a> {
    type Item = (usize, Cow<'a, [u8]>);

    fn next(&mut self) -> Option<Self::Item> {
        if self.rest.is_empty() {
            return None;
        }
        let begin = self.line;
        let mut statement = Cow::Borrowed(self.take_line());
        while let Some(kept) = statement.strip_suffix(b"\\") {
            let mut joined = kept.to_vec();
            joined.push(b' ');
            joined.extend_from_slice(self.take_line());
            statement = Cow::Owned(joined);
            if self.rest.is_empty() {
                break;
            }
        }
        Some((begin, statement))
    }
}

impl<'a> Statements<'a> {
    /// The next line without its end (`\n` or `\r\n`); empty at the end.
    fn take_line(&mut self) -> &'a [u8] {
        let end = self.rest.iter().position(|&b| b == b'\n');
        let (line, rest) = end.map_or((self.rest, &[][..]), |end| (&self.rest[..end], &self.rest[end + 1..]));
        self.rest = rest;
        self.line += 1;
        line.strip_suffix(b"\r").unwrap_or(line)
    }
}

#[derive(Default)]
struct ObjReader {
    positions: Vec<DVec3>,
    decimals: Decimals,
    /// What follows the coordinates of each vertex, where that is a colour; nothing where no vertex has one.
    colors: Vec<Option<[f64; 3]>>,
    triangles: Vec<[u32; 3]>,
    /// The line of each triangle's face.
    places: Vec<Place>,
    /// Those that `usemtl` names, and the number of each triangle's.
    materials: Vec<Material>,
    material_of: Vec<Option<u32>>,
    material: Option<u32>,
    /// First triangle and name of each `o`, and of each `g`.
    objects: Vec<(usize, Option<String>)>,
    groups: Vec<(usize, Option<String>)>,
    /// Whether texture coordinates are asked for; if so those that `vt` defines, `v` down, and those of triangles.
    has_textures: bool,
    coordinates: Vec<DVec2>,
    textures: Vec<Option<[DVec2; 3]>>,
    /// The corners of the current face, and the places of their texture coordinates; kept for their allocations.
    corners: Vec<u32>,
    texture_corners: Vec<Option<u32>>,
}

impl ObjReader {
    fn statement(&mut self, statement: &[u8], line: usize) -> Result<(), Fault> {
        let text = statement.split(|&b| b == b'#').next().unwrap_or_default();
        let mut words = text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        match words.next() {
            Some(b"v") => self.vertex(words, line),
            Some(b"vt") if self.has_textures => self.texture_vertex(words, line),
            Some(b"f") => self.face(words, line),
            Some(b"o") => {
                self.objects.push((self.triangles.len(), name_after(text, b"o")));
                Ok(())
            }
            Some(b"g") => {
                self.groups.push((self.triangles.len(), name_after(text, b"g")));
                Ok(())
            }
            Some(b"usemtl") => {
                self.use_material(name_after(text, b"usemtl"));
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn use_material(&mut self, name: Option<String>) {
        self.material = name.map(|name| {
            let known = self.materials.iter().position(|material| material.name == name);
            known.unwrap_or_else(|| {
                self.materials.push(Material::named(name));
                self.materials.len() - 1
            }) as u32
        });
    }

    /// `v x y z`, and `r g b` after it; a weight alone is passed over.
    fn vertex<'w>(&mut self, mut words: impl Iterator<Item = &'w [u8]>, line: usize) -> Result<(), Fault> {
        let mut coordinate = || {
            let word = words.next().unwrap_or_default();
            self.decimals.add(word);
            finite(word, Place::Line(line))
        };
        self.positions.push(DVec3::new(coordinate()?, coordinate()?, coordinate()?));
        let mut channel = || words.next().and_then(|word| finite(word, Place::Line(line)).ok());
        if let Some(red) = channel()
            && let (Some(green), Some(blue)) = (channel(), channel())
        {
            self.colors.resize(self.positions.len() - 1, None);
            self.colors.push(Some([red, green, blue]));
        }
        Ok(())
    }

    /// `vt u v`, of which `v` may be missing; a third coordinate is that of a solid texture, and passed over.
    fn texture_vertex<'w>(&mut self, mut words: impl Iterator<Item = &'w [u8]>, line: usize) -> Result<(), Fault> {
        let u = finite(words.next().unwrap_or_default(), Place::Line(line))?;
        let v = words.next().map_or(Ok(0.0), |word| finite(word, Place::Line(line)))?;
        self.coordinates.push(DVec2::new(u, textures::turned(v)));
        Ok(())
    }

    /// The colours of triangles without a material. Channels go from 0 to 1, or to 255 where one is larger than 1.
    fn triangle_colors(&self) -> Vec<Option<Color>> {
        if self.colors.is_empty() {
            return Vec::new();
        }
        let largest = self.colors.iter().flatten().flatten().copied().fold(0.0, f64::max);
        let scale = if largest > 1.0 { 255.0 } else { 1.0 };
        let of_vertex = |vertex: u32| {
            let color = self.colors.get(vertex as usize).copied().flatten()?;
            Some(color.map(|channel| linear(channel / scale)))
        };
        let colored = self.triangles.iter().zip(&self.material_of);
        colored
            .map(|(triangle, material)| if material.is_some() { None } else { mean(triangle.map(of_vertex)) })
            .collect()
    }

    fn face<'w>(&mut self, words: impl Iterator<Item = &'w [u8]>, line: usize) -> Result<(), Fault> {
        self.corners.clear();
        self.texture_corners.clear();
        for word in words {
            let corner = vertex_index(word, self.positions.len()).ok_or_else(|| {
                let count = self.positions.len();
                Fault::new(Place::Line(line), quoted(word), format!("one of the {count} vertices defined so far"))
            })?;
            self.corners.push(corner);
            if self.has_textures {
                let count = self.coordinates.len();
                let place = texture_index(word, count).map_err(|()| {
                    let expected = format!("one of the {count} texture coordinates defined so far");
                    Fault::new(Place::Line(line), quoted(word), expected)
                })?;
                self.texture_corners.push(place);
            }
        }
        let count = self.corners.len();
        if count < 3 {
            return Err(Fault::new(Place::Line(line), format!("a face with {count} corners"), "at least 3"));
        }
        let Some(cut) = triangulate(&self.corners, &self.positions) else {
            let expected = format!("at most {MAX_CONCAVE_CORNERS} where it is not convex");
            return Err(Fault::new(Place::Line(line), format!("a face with {count} corners"), expected));
        };
        self.triangles.extend(cut.iter().map(|triangle| triangle.map(|k| self.corners[k])));
        if self.has_textures {
            let at = |k: usize| Some(self.coordinates[self.texture_corners[k]? as usize]);
            self.textures.extend(cut.iter().map(|triangle| textures::of_corners(triangle.map(at))));
        }
        self.places.resize(self.triangles.len(), Place::Line(line));
        self.material_of.resize(self.triangles.len(), self.material);
        Ok(())
    }
}

/// The vertex of a face corner `v`, `v/vt`, `v//vn` or `v/vt/vn`: counted from 1, or backwards from -1.
fn vertex_index(word: &[u8], count: usize) -> Option<u32> {
    index(word.split(|&b| b == b'/').next()?, count)
}

/// The texture coordinates of such a corner, where it has some.
///
/// # Errors
/// Where there are none of this number.
fn texture_index(word: &[u8], count: usize) -> Result<Option<u32>, ()> {
    match word.split(|&b| b == b'/').nth(1) {
        None | Some([]) => Ok(None),
        Some(number) => index(number, count).map(Some).ok_or(()),
    }
}

/// The zero-based index that an OBJ index means in a list with `count` entries so far; a negative one counts back from the end.
fn index(number: &[u8], count: usize) -> Option<u32> {
    let number: i64 = std::str::from_utf8(number).ok()?.parse().ok()?;
    let count = i64::try_from(count).ok()?;
    let index = if number > 0 { number - 1 } else { count.checked_add(number)? };
    ((0..count).contains(&index) && number != 0).then(|| u32::try_from(index).ok())?
}

/// What follows the keyword, if anything.
fn name_after(statement: &[u8], keyword: &[u8]) -> Option<String> {
    let name = String::from_utf8_lossy(&statement.trim_ascii()[keyword.len()..]).trim().to_owned();
    (!name.is_empty()).then_some(name)
}
