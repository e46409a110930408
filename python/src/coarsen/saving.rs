//! Cells as files.

use std::path::Path;

use glam::DVec3;
use planecut::cells::coarsen::{Writing, written_meshes};
use planecut::csg::{Mesh as CoreMesh, evaluate};
use planecut::export::{
    Collider, ExportOptions, Format, MassProperties, Part, PhysicsFormat, RigidBody, encode_parts, physics_files,
    write_atomic,
};
use serde::Deserialize;

use super::coarsened::Data;
use crate::errors::{Failure, Outcome};
use crate::files::{at, said, settings};

fn names_of(meshes: &[CoreMesh]) -> Vec<String> {
    (0..meshes.len()).map(|number| format!("cell {number}")).collect()
}

/// Writes each cell as a mesh of its own.
pub(super) fn save_meshes(meshes: &[CoreMesh], path: &Path, options: &str) -> Outcome<()> {
    let format = Format::from_path(path).map_err(|error| at(path, error))?;
    let names = names_of(meshes);
    let parts: Vec<Part<'_>> = names.iter().zip(meshes).map(|(name, mesh)| Part::new(name, mesh)).collect();
    let options = ExportOptions { convex_colliders: true, ..settings(options)? };
    let bytes = encode_parts(&parts, format, &options).map_err(|error| at(path, error))?;
    write_atomic(path, &bytes).map_err(|error| said(path, error))
}

/// Settings of a rigid body.
#[derive(Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct BodySettings {
    /// Kilograms for each cubic metre.
    density: f64,
    /// Metres for each unit of length.
    scale: f64,
}

impl Default for BodySettings {
    fn default() -> Self {
        Self { density: 1000.0, scale: 1.0 }
    }
}

/// Writes a rigid body: what was enclosed, and the cells in single precision, which hold it all the same.
pub(super) fn save_rigid_body(data: &Data, path: &Path, format: PhysicsFormat, body: &BodySettings) -> Outcome<()> {
    let BodySettings { density, scale } = *body;
    for (name, value) in [("density", density), ("scale", scale)] {
        if !(1e-12..=1e12).contains(&value) {
            return Err(Failure::of(format!("{name}: found {value}, expected a number between 1e-12 and 1e12")));
        }
    }
    let moved = |mesh: &CoreMesh| -> Vec<DVec3> { mesh.positions.iter().map(|position| *position * scale).collect() };
    let visual = CoreMesh { positions: moved(&data.visual), ..data.visual.clone() };
    let of_visual = || MassProperties::of_triangles(&visual.positions, &visual.triangles, density);
    let mass = match data.is_closed.then(of_visual).flatten() {
        Some(mass) => mass,
        None => {
            let union = evaluate(&data.model)?.mesh;
            let mass = MassProperties::of_triangles(&moved(&union), &union.triangles, density);
            mass.ok_or_else(|| Failure::of("found cells without mass, expected some"))?
        }
    };
    let stored = |positions: &[DVec3]| positions.iter().map(|position| position.as_vec3().as_dvec3()).collect();
    let writing = Writing {
        scale,
        max_vertices: data.max_vertices.unwrap_or(usize::MAX),
        encloses: data.encloses,
        is_separated: true,
        stored: &stored,
    };
    let meshes = written_meshes(data.model.tree.brushes(), &data.model.materials, &writing)?;
    let names = names_of(&meshes);
    let pairs = names.iter().zip(&meshes).filter(|(_, mesh)| !mesh.triangles.is_empty());
    let colliders: Vec<Collider<'_>> = pairs.map(|(name, mesh)| Collider::new(name, mesh)).collect();
    let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let body = RigidBody { name: &stem, visual: &visual, colliders: &colliders, mass };
    let folder = path.parent().unwrap_or_else(|| Path::new(""));
    for file in physics_files(&body, format, &stem).map_err(Failure::of)? {
        let place = if file.path().is_empty() { path.to_owned() } else { folder.join(file.path()) };
        if let Some(folder) = place.parent().filter(|_| !file.path().is_empty()) {
            std::fs::create_dir_all(folder).map_err(|error| Failure::of(format!("{}: {error}", folder.display())))?;
        }
        let mut bytes = Vec::new();
        file.write(&mut bytes).map_err(Failure::of)?;
        write_atomic(&place, &bytes).map_err(Failure::of)?;
    }
    Ok(())
}
