//! What tests of several readers measure.

use planecut_csg::{MaterialId, Model, evaluate};

/// The area of one material on the boundary of a model's solid.
#[track_caller]
pub(crate) fn area_of(model: &Model, material: MaterialId) -> f64 {
    let mesh = evaluate(model).unwrap_or_else(|error| panic!("{error}")).mesh;
    let triangles = mesh.triangles.iter().zip(&mesh.triangle_faces);
    let of_material = triangles.filter(|(_, face)| mesh.faces[**face as usize].material == material);
    let area = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|corner| mesh.positions[corner as usize]);
        0.5 * (b - a).cross(c - a).length()
    };
    of_material.map(|(corners, _)| area(corners)).sum()
}
