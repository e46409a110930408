//! The meshes beside a document: OBJ files with vertices and triangles alone, which is what engines read of them.

use std::io::{self, Write};

use planecut_csg::Mesh;

use crate::decimal::{write_digits, write_point};

/// Writes a mesh, z up, its numbers the shortest decimals that read back the same.
pub(super) fn write_mesh(mesh: &Mesh, name: &str, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, concat!("# planecut ", env!("CARGO_PKG_VERSION"), ", Z up, metres\no {}"), name)?;
    // MuJoCo takes no mesh of fewer than four vertices: a triangle by itself is cut in three at its middle
    let middle = match mesh.positions.as_slice() {
        [a, b, c] => Some((*a + *b + *c) / 3.0),
        _ => None,
    };
    for position in mesh.positions.iter().chain(&middle) {
        out.write_all(b"v")?;
        write_point(*position, out)?;
        out.write_all(b"\n")?;
    }
    for corners @ [a, b, c] in &mesh.triangles {
        if middle.is_some() {
            [[*a, *b, 3], [*b, *c, 3], [*c, *a, 3]].into_iter().try_for_each(|corners| write_face(corners, out))?;
        } else {
            write_face(*corners, out)?;
        }
    }
    Ok(())
}

fn write_face(corners: [u32; 3], out: &mut dyn Write) -> io::Result<()> {
    out.write_all(b"f")?;
    for corner in corners {
        out.write_all(b" ")?;
        write_digits(u64::from(corner) + 1, out)?;
    }
    out.write_all(b"\n")
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use planecut_csg::{Material, MaterialId, MeshFace};

    use super::*;

    #[test]
    fn a_triangle_by_itself_has_four_vertices() {
        let mesh = Mesh {
            positions: vec![DVec3::ZERO, DVec3::X * 3.0, DVec3::Y * 3.0],
            triangles: vec![[0, 1, 2]],
            triangle_faces: vec![0],
            faces: vec![MeshFace { normal: DVec3::Z, material: MaterialId(0) }],
            materials: vec![Material::named("any")],
        };
        let mut text = Vec::new();
        write_mesh(&mesh, "m", &mut text).expect("written");
        let text = String::from_utf8(text).expect("ASCII");
        let (_, lines) = text.split_once("\n").expect("a comment");
        assert_eq!(lines, "o m\nv 0 0 0\nv 3 0 0\nv 0 3 0\nv 1 1 0\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
    }
}
