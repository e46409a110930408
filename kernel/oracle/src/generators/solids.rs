//! The Platonic solids, and planes at the ends of the accepted range.

use super::{dot, plane};
use crate::exact::Coefficients;
use crate::random::Rng;

/// `(1 + √5) / 2`, rounded: faces that should meet in a corner miss it by a rounding.
const GOLDEN: f64 = 1.618_033_988_749_895;

/// A Platonic solid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Platonic {
    /// 4 faces.
    Tetrahedron,
    /// 6 faces.
    Cube,
    /// 8 faces.
    Octahedron,
    /// 12 faces.
    Dodecahedron,
    /// 20 faces.
    Icosahedron,
}

impl Platonic {
    /// All five, by number of faces.
    pub const ALL: [Self; 5] = [Self::Tetrahedron, Self::Cube, Self::Octahedron, Self::Dodecahedron, Self::Icosahedron];

    /// The normals of the faces, which are the corners of the dual; not of unit length.
    #[must_use]
    pub fn normals(self) -> Vec<[f64; 3]> {
        let signs = [1.0, -1.0];
        let cyclic = |a: f64, b: f64, c: f64| [[a, b, c], [c, a, b], [b, c, a]];
        match self {
            Self::Tetrahedron => vec![[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]],
            Self::Cube => signs.iter().flat_map(|s| cyclic(*s, 0.0, 0.0)).collect(),
            Self::Octahedron => octants().collect(),
            Self::Dodecahedron => {
                signs.iter().flat_map(|s| signs.iter().flat_map(move |t| cyclic(0.0, *s, t * GOLDEN))).collect()
            }
            Self::Icosahedron => {
                let others = signs.iter().flat_map(|s| signs.iter().map(move |t| (*s, *t)));
                octants().chain(others.flat_map(|(s, t)| cyclic(0.0, s / GOLDEN, t * GOLDEN))).collect()
            }
        }
    }

    /// The solid whose corners are this one's normals.
    #[must_use]
    pub fn dual(self) -> Self {
        match self {
            Self::Tetrahedron => Self::Tetrahedron,
            Self::Cube => Self::Octahedron,
            Self::Octahedron => Self::Cube,
            Self::Dodecahedron => Self::Icosahedron,
            Self::Icosahedron => Self::Dodecahedron,
        }
    }

    /// The faces, at offset `d` from the origin in units of the (not normalised) normals.
    #[must_use]
    pub fn planes(self, d: f64) -> Vec<Coefficients> {
        self.normals().into_iter().map(|n| plane(n, d)).collect()
    }

    /// The offset at which the faces of the dual touch the corners of this solid with offset 1; the normals of the
    /// tetrahedron serve its dual with opposite signs.
    #[must_use]
    pub fn touching_offset(self) -> f64 {
        let corner = self.dual().normals()[0];
        let reach = self.normals().into_iter().map(|n| dot(n, corner)).fold(0.0, f64::max);
        dot(corner, corner) / reach
    }
}

fn octants() -> impl Iterator<Item = [f64; 3]> {
    (0..8).map(|k: usize| [k & 1, k >> 1 & 1, k >> 2].map(|bit| if bit == 0 { 1.0 } else { -1.0 }))
}

/// Coefficients at the ends of the accepted range: normals of `2^±400`, components `2^200` times smaller than the
/// largest, offsets `2^±200` times the normal.
pub fn range_end(rng: &mut Rng) -> Coefficients {
    let scale = rng.pick(&[-400, -399, 0, 398]);
    let mut part = |exponents: &[i32]| {
        let mantissa = if rng.chance(0.5) { 1.0 } else { rng.float(1.0, 2.0) };
        rng.pick(&[1.0, -1.0]) * mantissa * 2f64.powi(rng.pick(exponents))
    };
    let mut n: [f64; 3] = std::array::from_fn(|_| part(&[0, 0, -1, -100, -198, -199]));
    let mut d = part(&[-198, -199, -100, 0, 0, 1, 100, 198]).abs();
    for component in &mut n {
        if rng.chance(0.25) {
            *component = 0.0;
        }
    }
    let largest = rng.below(3);
    n[largest] = rng.pick(&[1.0, -1.0]);
    if rng.chance(0.1) {
        d = rng.pick(&[0.0, -d]);
    }
    plane(n, d).map(|v| v * 2f64.powi(scale))
}

#[test]
fn platonic_solids_have_their_corners() {
    use crate::outline::Outline;
    for solid in [Platonic::Tetrahedron, Platonic::Cube, Platonic::Octahedron] {
        let outline = Outline::of(&solid.planes(1.0));
        let faces = solid.normals().len();
        assert_eq!((outline.faces, outline.vertices.len()), (faces, solid.dual().normals().len()), "{solid:?}");
    }
    for solid in Platonic::ALL {
        assert_eq!(Outline::of(&solid.planes(1.0)).faces, solid.normals().len(), "{solid:?}");
    }
}
