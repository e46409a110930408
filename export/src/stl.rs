//! Binary STL: a flat list of triangles in single precision.
//!
//! Corners are repeated for every triangle, so readers merge equal ones. Vertices that the weld has split on purpose fall
//! together there: use glTF or OBJ where topology matters. Edges too short for single precision are contracted.

use std::borrow::Cow;

use glam::DVec3;
use planecut_csg::Mesh;

use crate::single_precision::without_lost_edges;
use crate::{ExportError, ExportOptions, Part};

const HEADER_BYTES: usize = 80;
const TRIANGLE_BYTES: usize = 50;

/// Encodes the triangles of all parts, Z-up, in the order of the meshes.
pub(crate) fn encode_stl(parts: &[Part<'_>], options: &ExportOptions) -> Result<Vec<u8>, ExportError> {
    let meshes: Vec<Cow<'_, Mesh>> = parts
        .iter()
        .map(|part| without_lost_edges(part.mesh, |position| (position * options.scale).as_vec3()))
        .collect();
    let triangles: usize = meshes.iter().map(|mesh| mesh.triangles.len()).sum();
    let count =
        u32::try_from(triangles).map_err(|_| ExportError::TooLarge { what: format!("{triangles} triangles") })?;
    let mut bytes = Vec::with_capacity(HEADER_BYTES + 4 + TRIANGLE_BYTES * triangles);
    // Must not begin with "solid": readers would take the file for a text one.
    bytes.extend_from_slice(concat!("binary STL, planecut ", env!("CARGO_PKG_VERSION"), ", Z up").as_bytes());
    bytes.resize(HEADER_BYTES, 0);
    bytes.extend_from_slice(&count.to_le_bytes());
    for mesh in &meshes {
        push_triangles(&mut bytes, mesh, options.scale)?;
    }
    Ok(bytes)
}

fn push_triangles(bytes: &mut Vec<u8>, mesh: &Mesh, scale: f64) -> Result<(), ExportError> {
    let points = single_precision(&mesh.positions, scale)?;
    for (corners, &face) in mesh.triangles.iter().zip(&mesh.triangle_faces) {
        push_vector(bytes, mesh.faces[face as usize].normal.normalize().as_vec3().to_array());
        for &corner in corners {
            push_vector(bytes, points[corner as usize]);
        }
        bytes.extend_from_slice(&[0, 0]);
    }
    Ok(())
}

fn push_vector(bytes: &mut Vec<u8>, vector: [f32; 3]) {
    for value in vector {
        // Adding zero turns -0 into 0: some readers compare corners by their bits.
        bytes.extend_from_slice(&(value + 0.0).to_le_bytes());
    }
}

fn single_precision(positions: &[DVec3], scale: f64) -> Result<Vec<[f32; 3]>, ExportError> {
    let convert = |(vertex, &position): (usize, &DVec3)| {
        let scaled = position * scale;
        let single = scaled.as_vec3();
        if single.is_finite() {
            return Ok(single.to_array());
        }
        let value = scaled[scaled.abs().max_position()];
        Err(ExportError::CoordinateRange { vertex, value })
    };
    positions.iter().enumerate().map(convert).collect()
}
