//! The one gate that every mesh passes before its indices are trusted.

use super::mesh::PaintedMesh;
use crate::error::PictureError;

/// Checks that every index of `mesh` points at something and every number is finite.
///
/// # Errors
/// [`PictureError::InvalidMesh`] names the first defect.
pub(crate) fn check_mesh(mesh: &PaintedMesh<'_>) -> Result<(), PictureError> {
    check_triangles(mesh)?;
    check_faces(mesh)?;
    match mesh.positions.iter().position(|p| !p.is_finite()) {
        Some(vertex) => invalid(format!("vertex {vertex} is {}, expected finite numbers", mesh.positions[vertex])),
        None => Ok(()),
    }
}

fn check_triangles(mesh: &PaintedMesh<'_>) -> Result<(), PictureError> {
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

fn check_faces(mesh: &PaintedMesh<'_>) -> Result<(), PictureError> {
    let paints = mesh.paints.len();
    for (index, face) in mesh.faces.iter().enumerate() {
        if face.paint as usize >= paints {
            return invalid(format!("face {index} names paint {}, expected less than {paints}", face.paint));
        }
        let length = glam::DVec3::from(face.normal).length();
        if !(0.5..2.0).contains(&length) {
            return invalid(format!("face {index} has a normal of length {length}, expected 1"));
        }
    }
    Ok(())
}

fn invalid(what: String) -> Result<(), PictureError> {
    Err(PictureError::InvalidMesh(what))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::input::mesh::{Face, Paint};

    fn one_triangle() -> PaintedMesh<'static> {
        PaintedMesh::new(
            [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            vec![[0, 1, 2]],
            vec![0],
            vec![Face { normal: [0.0, 0.0, 1.0], paint: 0 }],
            vec![Paint::default()],
        )
    }

    #[test]
    fn each_defect_is_named() {
        assert!(check_mesh(&one_triangle()).is_ok());
        type Spoil = fn(&mut PaintedMesh<'static>);
        let defects: [(Spoil, &str); 6] = [
            (|m| m.triangles.to_mut()[0][1] = 3, "vertex 3"),
            (|m| m.triangle_faces.to_mut()[0] = 1, "face 1"),
            (|m| m.triangle_faces.to_mut().clear(), "0 face indices"),
            (|m| m.faces[0].paint = 7, "paint 7"),
            (|m| m.faces[0].normal = DVec3::NAN.to_array(), "normal of length NaN"),
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
