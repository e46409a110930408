//! STL, binary and ASCII. Facet normals and attributes are passed over: the order of corners says which side is out.

use glam::DVec3;

use super::error::{Fault, Place, quoted};
use super::merge::PositionMerger;
use super::text::Words;
use super::{IndexedMesh, Precision, objects_from_starts};

/// Length of the binary header with the number of facets that follows it.
const HEADER: usize = 84;
/// Length of the binary header alone.
const COUNT_OFFSET: usize = 80;
/// Length of a binary facet: normal, three corners, two bytes of attributes.
const FACET: usize = 50;
/// Length of a facet's normal.
const NORMAL: usize = 12;

/// Reads an STL file: binary where its length is what the header says, otherwise ASCII where it begins with `solid`.
pub(super) fn read(bytes: &[u8]) -> Result<IndexedMesh, Fault> {
    let stated = stated_length(bytes);
    if stated == Some(bytes.len() as u64) {
        read_binary(bytes)
    } else if bytes.trim_ascii_start().get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid")) {
        read_ascii(bytes)
    } else {
        let expected = stated.map_or_else(
            || format!("a header of {HEADER} bytes, or `solid`"),
            |length| format!("{length} bytes for the number of facets in the header, or `solid`"),
        );
        Err(Fault::new(
            Place::Byte(COUNT_OFFSET.min(bytes.len())),
            format!("a file of {} bytes", bytes.len()),
            expected,
        ))
    }
}

/// The length that a binary file should have by its header.
fn stated_length(bytes: &[u8]) -> Option<u64> {
    let count = bytes.get(COUNT_OFFSET..HEADER)?.first_chunk().map(|b| u32::from_le_bytes(*b))?;
    Some(HEADER as u64 + u64::from(count) * FACET as u64)
}

fn read_binary(bytes: &[u8]) -> Result<IndexedMesh, Fault> {
    let facets = bytes[HEADER..].chunks_exact(FACET);
    let mut merger = PositionMerger::default();
    let mut triangles = Vec::with_capacity(facets.len());
    let places = (0..facets.len()).map(|number| Place::Byte(HEADER + FACET * number)).collect();
    for (number, facet) in facets.enumerate() {
        let mut triangle = [0; 3];
        for (k, corner) in triangle.iter_mut().enumerate() {
            let start = NORMAL + 12 * k;
            let [x, y, z] = [0, 4, 8].map(|i| single(facet, start + i));
            let place = || Place::Byte(HEADER + FACET * number + start);
            *corner = corner_index(&mut merger, DVec3::new(x, y, z), place)?;
        }
        triangles.push(triangle);
    }
    Ok(IndexedMesh { places, ..IndexedMesh::plain(merger.into_positions(), triangles, Precision::Single) })
}

/// The little-endian `f32` at an offset; NaN past the end.
fn single(bytes: &[u8], offset: usize) -> f64 {
    bytes.get(offset..).and_then(<[u8]>::first_chunk).map_or(f64::NAN, |b| f64::from(f32::from_le_bytes(*b)))
}

fn corner_index(merger: &mut PositionMerger, corner: DVec3, place: impl Fn() -> Place) -> Result<u32, Fault> {
    if !corner.is_finite() {
        return Err(Fault::new(place(), format!("the corner {corner}"), "finite coordinates"));
    }
    merger.index(corner).ok_or_else(|| Fault::new(place(), "more vertices", "at most 4294967295"))
}

fn read_ascii(bytes: &[u8]) -> Result<IndexedMesh, Fault> {
    let mut words = Words::new(bytes, 1);
    let mut merger = PositionMerger::default();
    let mut triangles = Vec::new();
    let (mut starts, mut places) = (Vec::new(), Vec::new());
    while let Some(word) = words.next() {
        if word.eq_ignore_ascii_case(b"solid") {
            let name = String::from_utf8_lossy(words.rest_of_line()).into_owned();
            starts.push((triangles.len(), (!name.is_empty()).then_some(name)));
        } else if word.eq_ignore_ascii_case(b"endsolid") {
            words.rest_of_line();
        } else if word.eq_ignore_ascii_case(b"facet") {
            places.push(words.place());
            triangles.push(read_facet(&mut words, &mut merger)?);
        } else {
            return Err(Fault::new(words.place(), quoted(word), "`facet`, `endsolid` or `solid`"));
        }
    }
    let objects = objects_from_starts(starts, triangles.len());
    let mesh = IndexedMesh::plain(merger.into_positions(), triangles, Precision::Single);
    Ok(IndexedMesh { objects, places, ..mesh })
}

/// A facet after its first word.
fn read_facet(words: &mut Words<'_>, merger: &mut PositionMerger) -> Result<[u32; 3], Fault> {
    expect(words, "normal")?;
    for _ in 0..3 {
        // Some writers give `nan` as the normal of a facet without area; it is passed over like any other.
        if words.next().is_none() {
            return Err(Fault::new(words.place(), "nothing", "a normal"));
        }
    }
    expect(words, "outer")?;
    expect(words, "loop")?;
    let mut triangle = [0; 3];
    for corner in &mut triangle {
        expect(words, "vertex")?;
        let position = DVec3::new(words.number()?, words.number()?, words.number()?);
        *corner = corner_index(merger, position, || words.place())?;
    }
    expect(words, "endloop")?;
    expect(words, "endfacet")?;
    Ok(triangle)
}

fn expect(words: &mut Words<'_>, expected: &str) -> Result<(), Fault> {
    let word = words.next().unwrap_or_default();
    if word.eq_ignore_ascii_case(expected.as_bytes()) {
        Ok(())
    } else {
        Err(Fault::new(words.place(), quoted(word), format!("`{expected}`")))
    }
}
