//! The five regular polyhedra.

use planecut_csg::{Brush, MaterialId};
use planecut_kernel::DVec3;

use super::simple::brush;
use crate::parameter::{ShapeError, positive};

/// A regular polyhedron about the origin.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum RegularSolid {
    /// Four triangles; corners along `(1, 1, 1)`, `(1, −1, −1)`, `(−1, 1, −1)` and `(−1, −1, 1)`.
    Tetrahedron,
    /// Six squares, across the axes.
    Cube,
    /// Eight triangles; corners on the axes.
    Octahedron,
    /// Twelve pentagons; eight of the corners along `(±1, ±1, ±1)`, two edges along x at `y = 0`.
    Dodecahedron,
    /// Twenty triangles; corners along `(0, ±1, ±φ)` and its cyclic shifts.
    Icosahedron,
}

impl RegularSolid {
    /// The solid with this name, in small letters.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "tetrahedron" => Some(Self::Tetrahedron),
            "cube" => Some(Self::Cube),
            "octahedron" => Some(Self::Octahedron),
            "dodecahedron" => Some(Self::Dodecahedron),
            "icosahedron" => Some(Self::Icosahedron),
            _ => None,
        }
    }
}

/// A regular polyhedron whose corners have this distance from the origin.
///
/// # Errors
/// [`ShapeError::Parameter`] where the radius is not above 0.
pub fn regular(solid: RegularSolid, radius: f64, material: MaterialId) -> Result<Brush, ShapeError> {
    let radius = positive("radius", radius)?;
    let golden = 0.5 * (1.0 + 5f64.sqrt());
    // distances from the origin along normals that are not of unit length
    let third = radius / 3f64.sqrt();
    match solid {
        RegularSolid::Tetrahedron => brush(octants().filter(|n| n.x * n.y * n.z < 0.0).map(|n| (n, third)), material),
        RegularSolid::Cube => brush(DVec3::AXES.into_iter().flat_map(|n| [(n, third), (-n, third)]), material),
        RegularSolid::Octahedron => brush(octants().map(|n| (n, radius)), material),
        RegularSolid::Dodecahedron => {
            let distance = radius * (golden + 1.0) / 3f64.sqrt();
            brush(cyclic(1.0, golden).map(|n| (n, distance)), material)
        }
        RegularSolid::Icosahedron => {
            let distance = radius * (golden + 1.0) / (golden + 2.0).sqrt();
            brush(octants().chain(cyclic(golden - 1.0, golden)).map(|n| (n, distance)), material)
        }
    }
}

/// `(±1, ±1, ±1)`.
fn octants() -> impl Iterator<Item = DVec3> {
    (0..8).map(|k| DVec3::from_array([0, 1, 2].map(|axis| if k >> axis & 1 == 0 { 1.0 } else { -1.0 })))
}

/// `(±a, 0, ±b)` and its cyclic shifts.
fn cyclic(a: f64, b: f64) -> impl Iterator<Item = DVec3> {
    (0..12).map(move |k| {
        let (a, b) = (if k & 1 == 0 { a } else { -a }, if k & 2 == 0 { b } else { -b });
        match k >> 2 {
            0 => DVec3::new(a, 0.0, b),
            1 => DVec3::new(b, a, 0.0),
            _ => DVec3::new(0.0, b, a),
        }
    })
}
