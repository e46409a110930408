//! Convex bodies with corners at whole numbers: a brush and a mesh of each that are the same solid exactly.

use glam::DVec3;
use planecut_csg::{Brush, ClosedMesh, MaterialId, MeshBody};
use planecut_testkit::random::Rng;
use planecut_testkit::scene::{brush, half_space};

/// Corners at whole numbers, and the corners of each face, counter-clockwise seen from outside.
#[derive(Debug, Clone)]
pub(super) struct Convex {
    pub(super) corners: Vec<DVec3>,
    pub(super) faces: Vec<Vec<u32>>,
}

/// Turns by exact angles, times five; the first is none.
const TURNS: [[[i32; 3]; 3]; 4] = [
    [[5, 0, 0], [0, 5, 0], [0, 0, 5]],
    [[3, 4, 0], [-4, 3, 0], [0, 0, 5]],
    [[5, 0, 0], [0, 3, 4], [0, -4, 3]],
    [[4, 0, -3], [0, 5, 0], [3, 0, 4]],
];

impl Convex {
    /// A box between corners below `size`, five units to one step where it may be `turned`; else one.
    pub(super) fn random(rng: &mut Rng, size: usize, turned: bool) -> Self {
        let low = DVec3::from_array([0; 3].map(|_| rng.below(size) as f64));
        let body = if rng.chance(0.7) {
            Self::cuboid(low, low + DVec3::from_array([0; 3].map(|_| 1.0 + rng.below(2) as f64)))
        } else {
            Self::tetrahedron(rng, low)
        };
        if !turned {
            return body;
        }
        let turn = TURNS[rng.below(4)].map(|row| DVec3::from_array(row.map(f64::from)));
        let by = |p: &DVec3| turn[0] * p.x + turn[1] * p.y + turn[2] * p.z;
        Self { corners: body.corners.iter().map(by).collect(), ..body }
    }

    pub(super) fn cuboid(low: DVec3, high: DVec3) -> Self {
        let corner = |k: u32| DVec3::select(glam::BVec3::new(k & 1 == 1, k >> 1 & 1 == 1, k >> 2 == 1), high, low);
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        Self { corners: (0..8).map(corner).collect(), faces: faces.map(|face| face.to_vec()).to_vec() }
    }

    /// One corner at a place, the others near it, with a volume.
    fn tetrahedron(rng: &mut Rng, low: DVec3) -> Self {
        loop {
            let corners: Vec<DVec3> =
                (0..4).map(|_| low + DVec3::from_array([0; 3].map(|_| rng.below(4) as f64))).collect();
            let [a, b, c, d] = corners[..] else { unreachable!("there are four") };
            let volume = (b - a).dot((c - a).cross(d - a));
            let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
            let turned = |[a, b, c]: [u32; 3]| if volume > 0.0 { vec![a, b, c] } else { vec![b, a, c] };
            if volume != 0.0 {
                return Self { corners, faces: faces.map(turned).to_vec() };
            }
        }
    }

    /// The brush: through three corners of each face a plane of whole numbers.
    pub(super) fn brush(&self) -> Brush {
        brush(self.faces.iter().map(|face| {
            let [a, b, c] = [0, 1, 2].map(|k| self.corners[face[k] as usize]);
            let normal = (b - a).cross(c - a);
            half_space(normal, normal.dot(a))
        }))
    }

    /// Each face as a fan around any of its corners, or around a further one in its middle.
    pub(super) fn mesh(&self, rng: &mut Rng) -> MeshBody {
        let (mut corners, mut triangles) = (self.corners.clone(), Vec::new());
        for face in &self.faces {
            let count = face.len();
            if count == 4 && rng.chance(0.2) {
                let middle = u32::try_from(corners.len()).expect("few corners");
                corners.push((self.corners[face[0] as usize] + self.corners[face[2] as usize]) / 2.0);
                triangles.extend((0..count).map(|k| [middle, face[k], face[(k + 1) % count]]));
                continue;
            }
            let first = rng.below(count);
            let at = |k: usize| face[(first + k) % count];
            triangles.extend((1..count - 1).map(|k| [at(0), at(k), at(k + 1)]));
        }
        let mesh = ClosedMesh::new(&corners, &triangles, |_| 0).expect("the boundary of a convex body is closed");
        MeshBody::new(mesh, vec![MaterialId(0)])
    }
}
