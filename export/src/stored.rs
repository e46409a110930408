//! Positions that a file stores as they are.

use glam::DVec3;

use crate::{ExportOptions, Format, gltf};

/// For each of some positions of one mesh one near it that a file of a format stores as it is: a mesh of these is written without any rounding, also if
/// some of them are left out.
///
/// They are in the units of the file, but of glTF in those of its meshes: apart from glTF, where the scale stands in a node, the mesh is to be written with a scale of 1.
/// Formats in double precision store everything.
#[must_use]
pub fn stored_positions(positions: &[DVec3], format: Format, options: &ExportOptions) -> Vec<DVec3> {
    match format {
        Format::Obj | Format::ThreeMf | Format::Ply => positions.to_vec(),
        Format::Stl => positions.iter().map(|position| position.as_vec3().as_dvec3()).collect(),
        Format::Glb | Format::Gltf => gltf::stored_positions(positions, options),
    }
}

#[cfg(test)]
mod tests {
    use planecut_csg::{Material, MaterialId, Mesh, MeshFace};
    use planecut_testkit::random::Rng;

    use super::*;
    use crate::{Part, written};

    /// Random triangles near and far, large and small: what is written of them is what was said to be stored, bit for bit.
    #[test]
    fn stored_positions_are_written_without_rounding() {
        let mut rng = Rng::new(11);
        for round in 0..4000 {
            let (far, size) = (10_f64.powi(round % 9), 10_f64.powi(round % 13 - 6));
            let mut random = || rng.integer(-1 << 40, 1 << 40) as f64 / (1_u64 << 40) as f64;
            let shift = DVec3::new(random(), random(), random()) * if round % 2 == 0 { 0.0 } else { far };
            let positions: Vec<DVec3> =
                (0..12).map(|_| shift + DVec3::new(random(), random(), random()) * size).collect();
            for (format, quantize) in [(Format::Glb, false), (Format::Glb, true), (Format::Stl, false)] {
                let options = ExportOptions { quantize, ..ExportOptions::default() };
                let stored = stored_positions(&positions, format, &options);
                for kept in [12, 3] {
                    let mesh = triangles(&stored[..kept]);
                    let Some(held) = written(&[Part::new("", &mesh)], format, &options).expect("written") else {
                        panic!("rounded")
                    };
                    if held.is_reduced {
                        continue; // two corners at one place
                    }
                    assert_eq!(held.positions, mesh.positions, "seed 11, round {round}, {format:?}, {quantize}");
                }
            }
        }
    }

    fn triangles(positions: &[DVec3]) -> Mesh {
        let count = positions.len() as u32 / 3;
        Mesh {
            positions: positions.to_vec(),
            triangles: (0..count).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect(),
            triangle_faces: vec![0; count as usize],
            faces: vec![MeshFace { normal: DVec3::Z, material: MaterialId(0) }],
            materials: vec![Material::named("any")],
        }
    }
}
