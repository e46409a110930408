//! OpenSCAD's evaluated trees.
//!
//! Each body is `hull() { polyhedron(…); }`, the polyhedron being the exact hull of the rounded corners, cut into triangles: what is
//! looked at is right with and without the `hull()`, whoever reads it. OpenSCAD itself rounds corners to a grid of `2^-20` before it
//! combines bodies. There a thin polyhedron may fold onto itself, and then the whole union fails, with nothing shown at all. What
//! comes from a `hull()` OpenSCAD knows to be convex: it takes the hull of the rounded corners, and drops it where that is flat.
//! Triangles stay planar wherever their corners are moved to; faces of more corners, rounded, are not planar to begin with.
//!
//! Source: OpenSCAD 2021.01, `cgalutils.cc`, and its behaviour.

use std::io::Write;

use glam::DVec3;
use planecut_csg::{Material, MaterialId};
use planecut_kernel::hull_triangles;
use rustc_hash::FxHashMap;

use super::Source;
use super::body::Body;
use crate::ExportError;
use crate::decimal::{push_decimal, push_digits};
use crate::material::{linear_to_srgb, material_color};

/// Writes a union of bodies; those that follow one another in one colour are in one `color` node.
pub(super) fn write(source: &Source<'_>, out: &mut dyn Write) -> Result<(), ExportError> {
    let numbers: Vec<usize> = (0..source.brushes.len()).collect();
    let mut open: Option<MaterialId> = None;
    writeln!(out, "group() {{")?;
    source.for_each(
        &numbers,
        |body| Some((body.material(), encode(body)?)),
        |encoded| {
            // a body that rounding leaves nothing of
            let Some((material, text)) = encoded else { return Ok(()) };
            if open != Some(material) {
                if open.is_some() {
                    writeln!(out, "\t}}")?;
                }
                out.write_all(&color(&source.materials[material.0 as usize]))?;
                open = Some(material);
            }
            Ok(out.write_all(&text)?)
        },
    )?;
    if open.is_some() {
        writeln!(out, "\t}}")?;
    }
    Ok(writeln!(out, "}}")?)
}

/// The opening of a `color` node, after a comment with the material's name.
fn color(material: &Material) -> Vec<u8> {
    let mut text = Vec::new();
    if !material.name.is_empty() {
        let name = material.name.chars().map(|c| if c.is_control() || c == '\u{2028}' { ' ' } else { c });
        text.extend_from_slice(format!("\t// {}\n", name.collect::<String>().trim()).as_bytes());
    }
    text.extend_from_slice(b"\tcolor([");
    for channel in material_color(material).map(linear_to_srgb) {
        // four digits are more than screens show
        push_decimal(&mut text, (f64::from(channel) * 1e4).round() / 1e4);
        text.extend_from_slice(b", ");
    }
    text.extend_from_slice(b"1]) {\n");
    text
}

/// A body is left out if its corners are this near to one line: on OpenSCAD's grid of `2^-20` they may all be on it, and the hull of
/// such points ends OpenSCAD. Rounding and merging moves each by less than two steps.
const NEEDLE: f64 = 4.0 / (1u64 << 20) as f64;

/// One line with a body; `None` where its corners, rounded, span no space.
fn encode(body: &Body) -> Option<Vec<u8>> {
    let mut points: Vec<DVec3> = Vec::new();
    let mut known = FxHashMap::default();
    for corner in body.faces.iter().flat_map(|face| &face.corners) {
        known.entry((*corner + 0.0).to_array().map(f64::to_bits)).or_insert_with(|| points.push(*corner));
    }
    if is_needle(&points) {
        return None;
    }
    let triangles = hull_triangles(&points).ok()?;
    let mut text = Vec::with_capacity(64 * points.len() + 16 * triangles.len());
    text.extend_from_slice(b"\t\thull() { polyhedron(points = [");
    let mut numbers = vec![None; points.len()];
    let mut count = 0;
    for corner in triangles.as_flattened() {
        let number = &mut numbers[*corner as usize];
        if number.is_none() {
            push_list(&mut text, count == 0, points[*corner as usize].to_array(), push_decimal);
            *number = Some(count);
            count += 1;
        }
    }
    text.extend_from_slice(b"], faces = [");
    for (place, [a, b, c]) in triangles.iter().enumerate() {
        // clockwise seen from outside
        let corners = [c, b, a].map(|corner| numbers[*corner as usize].unwrap_or_default());
        push_list(&mut text, place == 0, corners, push_digits);
    }
    text.extend_from_slice(b"], convexity = 1); }\n");
    Some(text)
}

/// Whether points are all near to a line through two that are about as far apart as any.
fn is_needle(points: &[DVec3]) -> bool {
    let farthest = |from: DVec3| {
        let distance = |point: &&DVec3| point.distance_squared(from);
        points.iter().max_by(|a, b| distance(a).total_cmp(&distance(b))).copied().unwrap_or(from)
    };
    let start = farthest(points[0]);
    let along = (farthest(start) - start).normalize_or_zero();
    points.iter().all(|point| (point - start).reject_from_normalized(along).length() <= NEEDLE)
}

fn push_list<T>(text: &mut Vec<u8>, is_first: bool, values: [T; 3], push: impl Fn(&mut Vec<u8>, T)) {
    text.extend_from_slice(if is_first { b"[" } else { b", [" });
    for (place, value) in values.into_iter().enumerate() {
        if place > 0 {
            text.extend_from_slice(b", ");
        }
        push(text, value);
    }
    text.push(b']');
}
