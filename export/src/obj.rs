//! Wavefront OBJ in full precision.
//!
//! Coordinates are the shortest decimals that read back as the same `f64`. Vertices are written once each as they are
//! indexed in the mesh, never merged by coordinates, so the file has the mesh's own topology. Normals are left out: faces
//! are planar and `s off` asks for flat shading.

use glam::DVec3;
use planecut_csg::{Material, Mesh};

use crate::text::{push_decimal, push_digits, unique_names};
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
    unique_names(materials, |name| token(name, "material"))
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

fn push_integer(text: &mut Vec<u8>, value: u64) {
    text.push(b' ');
    push_digits(text, value);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn material_names_are_single_words_and_distinct() {
        let names = material_names(&["a b", "a_b", "a\nb", "", "a_b_2"].map(Material::named));
        assert_eq!(names, ["a_b", "a_b_2", "a_b_3", "material", "a_b_2_2"]);
    }
}
