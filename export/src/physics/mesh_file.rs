//! The meshes beside a document: OBJ files with vertices and triangles alone, which is what engines read of them.

use std::io::{self, Write};

use planecut_csg::Mesh;

use crate::decimal::{write_digits, write_point};

/// Writes a mesh, z up, its numbers the shortest decimals that read back the same.
pub(super) fn write_mesh(mesh: &Mesh, name: &str, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, concat!("# planecut ", env!("CARGO_PKG_VERSION"), ", Z up, metres\no {}"), name)?;
    for position in &mesh.positions {
        out.write_all(b"v")?;
        write_point(*position, out)?;
        out.write_all(b"\n")?;
    }
    for corners in &mesh.triangles {
        out.write_all(b"f")?;
        for corner in corners {
            out.write_all(b" ")?;
            write_digits(u64::from(*corner) + 1, out)?;
        }
        out.write_all(b"\n")?;
    }
    Ok(())
}
