//! What is not written, and what is told of it.

use std::cell::Cell;
use std::io;

use glam::DVec3;
use planecut_csg::Mesh;
use planecut_export::{ExportError, ExportOptions, Format, MeshPieces, write_pieces};
use planecut_testkit::meshes;

use super::super::full_disk::Full;
use super::support::{Held, blocks, encoded};

/// Boxes, of which one cannot be read from some reading on, or is another one then.
struct Unsteady {
    from: usize,
    is_other: bool,
    readings: Cell<usize>,
}

impl MeshPieces for Unsteady {
    fn count(&self) -> usize {
        3
    }

    fn piece(&self, number: usize) -> io::Result<Mesh> {
        if number == 1 {
            self.readings.set(self.readings.get() + 1);
            if self.readings.get() >= self.from {
                if !self.is_other {
                    return Err(io::ErrorKind::NotFound.into());
                }
                return Ok(meshes::cube_with_hole());
            }
        }
        let low = DVec3::splat(3.0 * number as f64);
        Ok(meshes::box_mesh(low, low + 1.0, "stone"))
    }
}

#[test]
fn pieces_that_cannot_be_read_or_change_are_named() {
    for format in [Format::Glb, Format::Obj, Format::Stl, Format::Ply] {
        for (from, is_other) in [(1, false), (2, false), (2, true)] {
            let pieces = Unsteady { from, is_other, readings: Cell::new(0) };
            let error = write_pieces(&pieces, format, &ExportOptions::default(), &mut Vec::new()).expect_err("refused");
            match (is_other, &error) {
                (false, ExportError::ReadPiece { piece: 1, .. }) | (true, ExportError::ChangedPiece { piece: 1 }) => {}
                _ => panic!("{format:?}, {from}, {is_other}: {error}"),
            }
        }
    }
}

#[test]
fn formats_options_and_meshes_that_do_not_go_are_refused() {
    let cube = meshes::box_mesh(DVec3::ZERO, DVec3::ONE, "stone");
    let refused = |mesh: &Mesh, format, options: &ExportOptions| {
        let mut out = Vec::new();
        let error = write_pieces(&Held(vec![mesh.clone()]), format, options, &mut out).expect_err("refused");
        assert!(out.is_empty());
        error
    };
    let error = refused(&cube, Format::ThreeMf, &ExportOptions::default());
    assert!(matches!(error, ExportError::NotInPieces { extension: "3mf" }));
    assert_eq!(error.to_string(), "no .3mf file is written in pieces, expected .glb, .gltf, .obj, .stl or .ply");
    let scale = ExportOptions { scale: -1.0, ..ExportOptions::default() };
    assert!(matches!(refused(&cube, Format::Obj, &scale), ExportError::Scale(_)));
    let mut broken = cube.clone();
    broken.triangles[3][1] = 99;
    let mut far = cube;
    far.positions.iter_mut().for_each(|at| *at *= 1e300);
    for format in [Format::Glb, Format::Obj, Format::Stl, Format::Ply] {
        let message = refused(&broken, format, &ExportOptions::default()).to_string();
        assert!(message.contains("piece 0") && message.contains("triangle 3 names vertex 99"), "{message}");
        if matches!(format, Format::Glb | Format::Stl) {
            let error = refused(&far, format, &ExportOptions::default());
            assert!(matches!(error, ExportError::CoordinateRange { .. }), "{error}");
        }
    }
}

#[test]
fn a_piece_that_is_missing_leaves_open_edges() {
    let (mut pieces, _) = blocks(0, 1.0, DVec3::ZERO);
    assert_eq!(encoded(&pieces, Format::Obj, &ExportOptions::default()).1.open_edges, 0);
    let gone = pieces.remove(3);
    let sides = |[a, b, c]: &[u32; 3]| [[*a, *b], [*b, *c], [*c, *a]];
    let edges: std::collections::BTreeSet<[u32; 2]> = gone.triangles.iter().flat_map(sides).collect();
    let open = edges.iter().filter(|[a, b]| !edges.contains(&[*b, *a])).count();
    assert!(open > 0);
    assert_eq!(encoded(&pieces, Format::Obj, &ExportOptions::default()).1.open_edges, open as u64);
}

#[test]
fn a_full_disk_is_told() {
    let (pieces, _) = blocks(0, 1.0, DVec3::ZERO);
    for format in [Format::Glb, Format::Gltf, Format::Obj, Format::Stl, Format::Ply] {
        let length = encoded(&pieces, format, &ExportOptions::default()).0.len();
        for room in [0, 100, length / 2, length - 1] {
            let written = write_pieces(&Held(pieces.clone()), format, &ExportOptions::default(), &mut Full(room));
            assert!(matches!(written, Err(ExportError::Io(_))), "{format:?}, {room} of {length}");
        }
    }
}
