//! Wavefront OBJ in full precision.
//!
//! Coordinates are the shortest decimals that read back as the same `f64`. Vertices are written once each as they are
//! indexed in the mesh, never merged by coordinates, so the file has the mesh's own topology. Normals are left out: faces
//! are planar and `s off` asks for flat shading.

use std::io::Write;

use glam::DVec3;
use planecut_csg::{Material, Mesh};
use rustc_hash::FxHashSet;

use crate::{ExportOptions, Part};

/// Encodes each part as an object (`o`) with a group (`g`) and `usemtl` for each of its materials, Z-up.
pub(crate) fn encode_obj(parts: &[Part<'_>], options: &ExportOptions) -> Vec<u8> {
    let size: usize = parts.iter().map(|part| 48 * part.mesh.positions.len() + 24 * part.mesh.triangles.len()).sum();
    let mut text = Vec::with_capacity(size + 256);
    text.extend_from_slice(concat!("# planecut ", env!("CARGO_PKG_VERSION"), ", Z up\n").as_bytes());
    let mut first_vertex = 1;
    for part in parts {
        push_part(&mut text, part, first_vertex, options.scale);
        first_vertex += part.mesh.positions.len() as u64;
    }
    text
}

fn push_part(text: &mut Vec<u8>, part: &Part<'_>, first_vertex: u64, scale: f64) {
    push_words(text, &["o ", &token(part.name, "solid")]);
    for &position in &part.mesh.positions {
        push_position(text, position * scale);
    }
    push_words(text, &["s off"]);
    let names = material_names(&part.mesh.materials);
    for (material, triangles) in triangles_by_material(part.mesh) {
        push_words(text, &["g ", &names[material]]);
        push_words(text, &["usemtl ", &names[material]]);
        for triangle in triangles {
            text.push(b'f');
            for corner in part.mesh.triangles[triangle as usize] {
                push_integer(text, first_vertex + u64::from(corner));
            }
            text.push(b'\n');
        }
    }
}

/// The triangles of each used material in the order of the mesh; materials in the order of their numbers.
fn triangles_by_material(mesh: &Mesh) -> impl Iterator<Item = (usize, Vec<u32>)> {
    let mut groups = vec![Vec::new(); mesh.materials.len()];
    for (triangle, &face) in (0..).zip(&mesh.triangle_faces) {
        groups[mesh.faces[face as usize].material.0 as usize].push(triangle);
    }
    groups.into_iter().enumerate().filter(|(_, triangles)| !triangles.is_empty())
}

/// A name for each material that survives the format's rule that words end at white space, each one once.
fn material_names(materials: &[Material]) -> Vec<String> {
    let mut taken = FxHashSet::default();
    let mut unique = |wanted: String| {
        let mut name = wanted.clone();
        let mut copy = 2;
        while !taken.insert(name.clone()) {
            name = format!("{wanted}_{copy}");
            copy += 1;
        }
        name
    };
    materials.iter().map(|material| unique(token(&material.name, "material"))).collect()
}

/// `name` with white space and control characters replaced, or `fallback` for an empty one.
fn token(name: &str, fallback: &str) -> String {
    let safe: String = name.chars().map(|c| if c.is_whitespace() || c.is_control() { '_' } else { c }).collect();
    if safe.is_empty() { fallback.to_owned() } else { safe }
}

fn push_words(text: &mut Vec<u8>, words: &[&str]) {
    for word in words {
        text.extend_from_slice(word.as_bytes());
    }
    text.push(b'\n');
}

fn push_position(text: &mut Vec<u8>, position: DVec3) {
    text.push(b'v');
    for value in position.to_array() {
        text.push(b' ');
        push_decimal(text, value);
    }
    text.push(b'\n');
}

/// The shortest decimal that reads back as `value`.
fn push_decimal(text: &mut Vec<u8>, value: f64) {
    const WRITES: &str = "a byte vector takes every write";
    // Grid coordinates are the common case, and an integer is several times faster to print.
    if value.fract() == 0.0 && value.abs() < 1e15 {
        let magnitude = value.abs() as u64;
        if value < 0.0 {
            text.push(b'-');
        }
        push_digits(text, magnitude);
    } else if (1e-5..1e17).contains(&value.abs()) {
        write!(text, "{value}").expect(WRITES);
    } else {
        write!(text, "{value:e}").expect(WRITES);
    }
}

fn push_integer(text: &mut Vec<u8>, value: u64) {
    text.push(b' ');
    push_digits(text, value);
}

fn push_digits(text: &mut Vec<u8>, mut value: u64) {
    let mut digits = [b'0'; 20];
    let mut start = digits.len();
    loop {
        start -= 1;
        digits[start] = b'0' + (value % 10) as u8;
        value /= 10;
        if value == 0 {
            break;
        }
    }
    text.extend_from_slice(&digits[start..]);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimals_read_back_as_the_same_number() {
        let mut state = 0x9e37_79b9_7f4a_7c15_u64;
        let random = std::iter::repeat_with(|| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            f64::from_bits(state ^ (state >> 29))
        });
        let chosen = [0.0, 1.0, -1.0, 0.1, -2.5, 1e15, -1e15, 999_999_999_999_999.0, 1e17, 1e-5, 5e-324, f64::MAX];
        for value in chosen.into_iter().chain(random.take(10_000)).filter(|v| v.is_finite()) {
            let mut text = Vec::new();
            push_decimal(&mut text, value);
            let text = String::from_utf8(text).expect("ASCII");
            assert_eq!(text.parse::<f64>().expect("a number").to_bits(), value.to_bits(), "{text}");
        }
    }

    #[test]
    fn material_names_are_single_words_and_distinct() {
        let names = material_names(&["a b", "a_b", "a\nb", "", "a_b_2"].map(Material::named));
        assert_eq!(names, ["a_b", "a_b_2", "a_b_3", "material", "a_b_2_2"]);
    }
}
