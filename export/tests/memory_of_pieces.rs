//! How much memory a file of many pieces takes while it is written. A program of its own, apart from the suite: the peak that the system tells is that of
//! the whole process.
#![cfg(target_os = "linux")]

mod peak_memory;

use std::f64::consts::TAU;
use std::io;

use glam::DVec3;
use planecut_csg::{Material, MaterialId, Mesh, MeshFace};
use planecut_export::{ExportOptions, Format, MeshPieces, write_pieces};

use peak_memory::{Counter, peak};

/// Sides of the bar, and rows of squares on each side of a piece: 5,000 triangles.
const SIDES: u32 = 50;
const ROWS: u32 = 50;

/// A long bar in pieces that are made when they are asked for.
struct Bar {
    pieces: usize,
}

impl MeshPieces for Bar {
    fn count(&self) -> usize {
        self.pieces
    }

    fn piece(&self, number: usize) -> io::Result<Mesh> {
        let at = |row: u32, side: u32| {
            let (sin, cos) = (TAU * f64::from(side) / f64::from(SIDES)).sin_cos();
            DVec3::new(cos, sin, (number as u32 * ROWS + row) as f64 / f64::from(ROWS))
        };
        let mut mesh = Mesh { materials: vec![Material::named("steel")], ..Mesh::default() };
        mesh.positions = (0..=ROWS).flat_map(|row| (0..SIDES).map(move |side| at(row, side))).collect();
        let mut push = |face: u32, triangle: [u32; 3]| {
            mesh.triangles.push(triangle);
            mesh.triangle_faces.push(face);
        };
        for side in 0..SIDES {
            for row in 0..ROWS {
                let (low, next) = (row * SIDES, (side + 1) % SIDES);
                push(side, [low + side, low + next, low + SIDES + next]);
                push(side, [low + side, low + SIDES + next, low + SIDES + side]);
            }
        }
        let last = ROWS * SIDES;
        for side in 1..SIDES - 1 {
            if number == 0 {
                push(SIDES, [0, side + 1, side]);
            }
            if number + 1 == self.pieces {
                push(SIDES + 1, [last, last + side, last + side + 1]);
            }
        }
        let normal = |face: u32| match face {
            SIDES => -DVec3::Z,
            face if face > SIDES => DVec3::Z,
            side => {
                let (sin, cos) = (TAU * (f64::from(side) + 0.5) / f64::from(SIDES)).sin_cos();
                DVec3::new(cos, sin, 0.0)
            }
        };
        mesh.faces = (0..SIDES + 2).map(|face| MeshFace { normal: normal(face), material: MaterialId(0) }).collect();
        Ok(mesh)
    }
}

/// All triangles would take 240 MB as a mesh, and as much again in files.
#[test]
fn five_million_triangles_take_little_memory() {
    let pieces = Bar { pieces: 1000 };
    let Some(before) = peak() else {
        println!("skipped: this system does not tell");
        return;
    };
    for format in [Format::Stl, Format::Ply, Format::Obj, Format::Glb] {
        let mut out = Counter(0);
        let written = write_pieces(&pieces, format, &ExportOptions::default(), &mut out).expect("written");
        assert_eq!((written.open_edges, written.vertices), (0, 2_500_000 + 50), "{format:?}");
        assert_eq!(written.triangles, 5_000_000 + 96, "{format:?}");
        let more = peak().expect("told before") - before;
        println!("{format:?}: {} bytes, {more} bytes of memory", out.0);
        assert!(more < 40_000_000, "{format:?}: {more}");
    }
}
