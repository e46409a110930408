//! What must hold for every mesh, whatever the model.

use std::collections::HashSet;

use glam::DVec3;
use planecut_check::check_topology;
use planecut_csg::{Evaluation, Mesh, Model, SolidMeasures, UnboundedBrushes, evaluate_with};

use crate::scene::{ensure, ensure_eq};

/// Evaluates a model without its unbounded brushes and checks what holds for every solid.
pub fn evaluate_soundly(model: &Model) -> Result<Evaluation, String> {
    evaluate_soundly_with(model, UnboundedBrushes::LeaveOut)
}

/// Evaluates a model and checks what holds for every solid.
pub fn evaluate_soundly_with(model: &Model, unbounded: UnboundedBrushes) -> Result<Evaluation, String> {
    let evaluation = evaluate_with(model, unbounded).map_err(|error| error.to_string())?;
    check(&evaluation)?;
    ensure_eq!(evaluation.mesh.materials, model.materials, "materials");
    Ok(evaluation)
}

fn check(evaluation: &Evaluation) -> Result<(), String> {
    let (mesh, solid) = (&evaluation.mesh, &evaluation.solid);
    check_indices(mesh)?;
    if mesh.triangles.is_empty() {
        ensure!(mesh.positions.is_empty() && mesh.faces.is_empty(), "an empty mesh with positions or faces");
        ensure_eq!((solid.volume, solid.area), (0.0, 0.0), "measures of nothing");
        return Ok(());
    }
    let report = check_topology(&mesh.positions, &mesh.triangles);
    ensure!(report.watertight && report.manifold, "not a manifold: {:?}", report.first_defect);
    ensure_eq!(report.unused_vertices, 0, "vertices without a triangle");
    let genus = report.genus.ok_or("no genus")?;
    ensure!(genus >= 0, "genus {genus}");
    ensure_eq!(2 * report.components as i64 - report.euler_characteristic, 2 * genus, "Euler characteristic");
    let slack = contraction(&evaluation.solid);
    // Only a needle thinner than rounding, which contraction takes out of the mesh, reaches beyond the mesh's box: it
    // is counted as noise, and volume and area below show that nothing of any thickness is missing.
    let [min, max] = [report.measures.min, report.measures.max].map(DVec3::from);
    let boxes = || format!("box of solid {:?}, of the mesh {:?}", (solid.min, solid.max), (min, max));
    let reach = DVec3::splat(slack);
    ensure!(min.cmpge(solid.min - reach).all() && max.cmple(solid.max + reach).all(), "{}", boxes());
    let equal = min.distance(solid.min) <= slack && max.distance(solid.max) <= slack;
    ensure!(equal || evaluation.noise.collapsed > 0, "{}", boxes());

    // Every corner may have moved, and sums over triangles round as the cube of their size.
    let (size, count) = ((solid.max - solid.min).length(), mesh.triangles.len() as f64);
    let tolerance = slack * solid.area + f64::EPSILON * count * size.powi(3);
    let (volume, area) = (volume_of(mesh), area_of(mesh));
    ensure!(
        (volume - solid.volume).abs() <= tolerance,
        "volume of the mesh {volume:e}, of the solid {:e}",
        solid.volume
    );
    let tolerance = slack * size * count + f64::EPSILON * count * size.powi(2);
    ensure!((area - solid.area).abs() <= tolerance, "area of the mesh {area}, of the solid {}", solid.area);
    Ok(())
}

/// How far rounding and the contraction of noise edges may move a vertex of the mesh: 1e-12 of the largest coordinate,
/// several times where short edges follow one another.
pub fn contraction(solid: &SolidMeasures) -> f64 {
    4e-12 * solid.min.abs().max(solid.max.abs()).max_element()
}

/// Every directed edge once, its opposite once; faces in order, none empty, normals of unit length.
fn check_indices(mesh: &Mesh) -> Result<(), String> {
    ensure_eq!(mesh.triangle_faces.len(), mesh.triangles.len(), "length of triangle_faces");
    let mut directed = HashSet::new();
    for triangle in &mesh.triangles {
        for k in 0..3 {
            let edge = (triangle[k], triangle[(k + 1) % 3]);
            ensure!(edge.0 != edge.1, "triangle {triangle:?} names a vertex twice");
            ensure!(directed.insert(edge), "directed edge {edge:?} occurs twice");
        }
    }
    let open = directed.iter().find(|(a, b)| !directed.contains(&(*b, *a)));
    ensure!(open.is_none(), "edge {open:?} has no opposite");
    ensure!(mesh.triangle_faces.is_sorted(), "triangles of a face do not follow one another");
    let mut used = mesh.triangle_faces.clone();
    used.dedup();
    ensure!(used.iter().copied().eq(0..mesh.faces.len() as u32), "a face without triangles");
    let unit = |normal: DVec3| (normal.length() - 1.0).abs() < 1e-15;
    ensure!(mesh.faces.iter().all(|face| unit(face.normal)), "a normal that is not of unit length");
    let known = |id: u32| (id as usize) < mesh.materials.len();
    ensure!(mesh.faces.iter().all(|face| known(face.material.0)), "an unknown material");
    Ok(())
}

/// Volume from the triangles, relative to a vertex.
fn volume_of(mesh: &Mesh) -> f64 {
    let origin = mesh.positions[0];
    mesh.triangles
        .iter()
        .map(|triangle| triangle.map(|v| mesh.positions[v as usize] - origin))
        .map(|[a, b, c]| a.dot(b.cross(c)) / 6.0)
        .sum()
}

/// Area of a triangle.
pub fn triangle_area(mesh: &Mesh, triangle: usize) -> f64 {
    let [a, b, c] = mesh.triangles[triangle].map(|v| mesh.positions[v as usize]);
    0.5 * (b - a).cross(c - a).length()
}

fn area_of(mesh: &Mesh) -> f64 {
    (0..mesh.triangles.len()).map(|t| triangle_area(mesh, t)).sum()
}

/// Area of each material.
pub fn area_by_material(mesh: &Mesh) -> Vec<f64> {
    let mut area = vec![0.0; mesh.materials.len()];
    for (t, face) in mesh.triangle_faces.iter().enumerate() {
        area[mesh.faces[*face as usize].material.0 as usize] += triangle_area(mesh, t);
    }
    area
}
