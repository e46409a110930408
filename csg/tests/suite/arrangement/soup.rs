//! Random closed meshes of few triangles with corners on a small grid, so that most of them coincide somewhere.

use glam::DVec3;
use planecut_csg::{ClosedMesh, MaterialId, MeshBody};
use planecut_testkit::random::Rng;

/// Triangles of a closed mesh, perhaps one that crosses itself.
#[derive(Debug, Clone, Default)]
pub(crate) struct Soup {
    pub(crate) positions: Vec<DVec3>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

impl Soup {
    /// A few tetrahedra and boxes with corners at whole numbers below `size`; some flat, some inside out.
    pub(crate) fn random(rng: &mut Rng, size: usize) -> Self {
        let mut soup = Self::default();
        for _ in 0..=rng.below(3) {
            if rng.chance(0.3) { soup.push_box(rng, size) } else { soup.push_tetrahedron(rng, size) }
        }
        soup
    }

    /// Triangles of this one and another.
    pub(crate) fn push(&mut self, other: &Self) {
        let first = u32::try_from(self.positions.len()).expect("few vertices");
        self.positions.extend(&other.positions);
        self.triangles.extend(other.triangles.iter().map(|triangle| triangle.map(|vertex| vertex + first)));
    }

    pub(crate) fn mesh(&self) -> MeshBody {
        let mesh = ClosedMesh::new(&self.positions, &self.triangles, |_| 0).expect("the mesh is closed");
        MeshBody::new(mesh, vec![MaterialId(0)])
    }

    fn push_tetrahedron(&mut self, rng: &mut Rng, size: usize) {
        let mut corner = || DVec3::from_array([0; 3].map(|_| rng.below(size) as f64));
        let positions = vec![corner(), corner(), corner(), corner()];
        let mut triangles = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        let [a, b, c, d] = positions[..] else { unreachable!("there are four") };
        let is_inside_out = (b - a).dot((c - a).cross(d - a)) < 0.0;
        if is_inside_out != rng.chance(0.08) {
            triangles.iter_mut().for_each(|triangle| triangle.swap(0, 1));
        }
        self.push(&Self { positions, triangles });
    }

    /// A box whose faces are cut along either diagonal, or into four triangles with a corner on an edge.
    fn push_box(&mut self, rng: &mut Rng, size: usize) {
        let low = DVec3::from_array([0; 3].map(|_| rng.below(size) as f64));
        let extent = DVec3::from_array([0; 3].map(|_| 1.0 + rng.below(2) as f64));
        let corner = |k: u32| low + extent * DVec3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2));
        let mut soup = Self { positions: (0..8).map(corner).collect(), triangles: Vec::new() };
        for face in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
            let turn = rng.below(2);
            let [a, b, c, d] = [0, 1, 2, 3].map(|k| face[(k + turn) % 4]);
            soup.triangles.extend([[a, b, c], [a, c, d]]);
        }
        self.push(&soup);
    }
}
