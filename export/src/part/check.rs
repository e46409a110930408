//! The one gate that every mesh passes before a writer trusts its indices.

use planecut_csg::Mesh;

use super::{ExportOptions, Part};
use crate::ExportError;

/// Checks options, meshes and their sources.
///
/// # Errors
/// The first defect.
pub(crate) fn check_parts(parts: &[Part<'_>], options: &ExportOptions) -> Result<(), ExportError> {
    options.check()?;
    parts.iter().try_for_each(|part| {
        check_mesh(part.mesh)?;
        check_sources(part)
    })
}

fn check_sources(part: &Part<'_>) -> Result<(), ExportError> {
    let (sources, materials) = (part.sources.len(), part.mesh.materials.len());
    if sources == 0 || sources == materials {
        return Ok(());
    }
    Err(ExportError::InvalidMesh(format!("{materials} materials but {sources} sources, expected as many")))
}

/// Checks that every index of `mesh` points at something and every number is finite.
///
/// # Errors
/// [`ExportError::InvalidMesh`] names the first defect.
pub(crate) fn check_mesh(mesh: &Mesh) -> Result<(), ExportError> {
    check_triangles(mesh)?;
    check_faces(mesh)?;
    match mesh.positions.iter().position(|p| !p.is_finite()) {
        Some(vertex) => invalid(format!("vertex {vertex} is {}, expected finite numbers", mesh.positions[vertex])),
        None => Ok(()),
    }
}

fn check_triangles(mesh: &Mesh) -> Result<(), ExportError> {
    let (triangles, owners) = (mesh.triangles.len(), mesh.triangle_faces.len());
    if triangles != owners {
        return invalid(format!("{triangles} triangles but {owners} face indices, expected as many"));
    }
    let vertices = mesh.positions.len();
    for (triangle, corners) in mesh.triangles.iter().enumerate() {
        if let Some(corner) = corners.iter().find(|&&corner| corner as usize >= vertices) {
            return invalid(format!("triangle {triangle} names vertex {corner}, expected less than {vertices}"));
        }
    }
    let faces = mesh.faces.len();
    match mesh.triangle_faces.iter().position(|&face| face as usize >= faces) {
        Some(triangle) => invalid(format!(
            "triangle {triangle} names face {}, expected less than {faces}",
            mesh.triangle_faces[triangle]
        )),
        None => Ok(()),
    }
}

fn check_faces(mesh: &Mesh) -> Result<(), ExportError> {
    let materials = mesh.materials.len();
    for (index, face) in mesh.faces.iter().enumerate() {
        if face.material.0 as usize >= materials {
            return invalid(format!("face {index} names material {}, expected less than {materials}", face.material.0));
        }
        let length = face.normal.length();
        if !(0.5..2.0).contains(&length) {
            return invalid(format!("face {index} has a normal of length {length}, expected 1"));
        }
    }
    Ok(())
}

fn invalid(what: String) -> Result<(), ExportError> {
    Err(ExportError::InvalidMesh(what))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use planecut_csg::{Material, MaterialId, MeshFace};

    use super::*;

    fn one_triangle() -> Mesh {
        Mesh {
            positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y],
            triangles: vec![[0, 1, 2]],
            triangle_faces: vec![0],
            faces: vec![MeshFace { normal: DVec3::Z, material: MaterialId(0) }],
            materials: vec![Material::named("m")],
        }
    }

    #[test]
    fn each_defect_is_named() {
        assert!(check_mesh(&one_triangle()).is_ok());
        type Spoil = fn(&mut Mesh);
        let defects: [(Spoil, &str); 6] = [
            (|m| m.triangles[0][1] = 3, "vertex 3"),
            (|m| m.triangle_faces[0] = 1, "face 1"),
            (|m| m.triangle_faces.clear(), "0 face indices"),
            (|m| m.faces[0].material = MaterialId(7), "material 7"),
            (|m| m.faces[0].normal = DVec3::NAN, "normal of length NaN"),
            (|m| m.positions[2].y = f64::INFINITY, "vertex 2"),
        ];
        for (spoil, words) in defects {
            let mut mesh = one_triangle();
            spoil(&mut mesh);
            let message = check_mesh(&mesh).expect_err(words).to_string();
            assert!(message.contains(words), "{message:?} does not mention {words:?}");
        }
    }
}
