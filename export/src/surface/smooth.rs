//! Normals that faces share, by crease angle.

use glam::DVec3;
use planecut_csg::Mesh;

/// Room for rounding in the cosine of the crease angle: faces that meet at exactly this angle share.
const ROUNDING: f64 = 1e-9;

/// The normals at the corners of triangles. Corners at one vertex share theirs where a way from one to the other crosses no edge that is
/// sharper than the crease angle.
pub(super) struct SharedNormals {
    /// Of each corner, three for each triangle, the corner that stands for all that share its normal.
    standing: Vec<u32>,
    normals: Vec<DVec3>,
}

impl SharedNormals {
    /// Those of a mesh; `crease` in degrees. Each face counts by the angle that it has at the vertex (Thürmer and Wüthrich 1998), so that
    /// triangulation does not matter.
    pub(super) fn of(mesh: &Mesh, crease: f64) -> Self {
        let mut shared = Self { standing: (0..3 * mesh.triangles.len() as u32).collect(), normals: Vec::new() };
        let least = crease.to_radians().cos() - ROUNDING;
        let normal = |triangle: u32| mesh.faces[mesh.triangle_faces[triangle as usize] as usize].normal.normalize();
        for [a, b] in opposite_edges(mesh) {
            let [one, other] = [a / 3, b / 3];
            if normal(one).dot(normal(other)) >= least {
                // edge k runs from corner k to the next one, its opposite the other way
                shared.join(a, next(b));
                shared.join(next(a), b);
            }
        }
        let mut normals = vec![DVec3::ZERO; shared.standing.len()];
        for triangle in 0..mesh.triangles.len() as u32 {
            let points = mesh.triangles[triangle as usize].map(|corner| mesh.positions[corner as usize]);
            for k in 0..3 {
                let sides = [1, 2].map(|step| (points[(k + step) % 3] - points[k]).normalize_or_zero());
                let angle = sides[0].dot(sides[1]).clamp(-1.0, 1.0).acos();
                let standing = shared.find(3 * triangle + k as u32);
                normals[standing as usize] += angle * normal(triangle);
            }
        }
        for corner in 0..normals.len() as u32 {
            let standing = shared.find(corner);
            shared.standing[corner as usize] = standing;
            // of opposite faces nothing is left: then each its own would be as good
            if standing == corner && normals[corner as usize].length() < ROUNDING {
                normals[corner as usize] = normal(corner / 3);
            }
        }
        shared.normals = normals;
        shared
    }

    /// What stands for the normal at a corner of a triangle.
    pub(super) fn shared_by(&self, triangle: u32, corner: usize) -> u32 {
        self.standing[3 * triangle as usize + corner]
    }

    /// The normal, not of unit length.
    pub(super) fn normal(&self, shared: u32) -> DVec3 {
        self.normals[shared as usize]
    }

    fn find(&mut self, mut corner: u32) -> u32 {
        while self.standing[corner as usize] != corner {
            let above = self.standing[self.standing[corner as usize] as usize];
            self.standing[corner as usize] = above;
            corner = above;
        }
        corner
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.find(a), self.find(b));
        self.standing[a.max(b) as usize] = a.min(b);
    }
}

/// The next corner of the same triangle.
fn next(corner: u32) -> u32 {
    if corner % 3 == 2 { corner - 2 } else { corner + 1 }
}

/// Pairs of edges that run between the same vertices in opposite directions, each by the corner that it begins at; where more than two
/// meet, none.
fn opposite_edges(mesh: &Mesh) -> Vec<[u32; 2]> {
    let corners: Vec<u32> = mesh.triangles.iter().flatten().copied().collect();
    let ends = |corner: u32| (corners[corner as usize], corners[next(corner) as usize]);
    let undirected = |corner: &u32| {
        let (a, b) = ends(*corner);
        (a.min(b), a.max(b))
    };
    let mut edges: Vec<u32> = (0..corners.len() as u32).collect();
    edges.sort_by_cached_key(undirected);
    let pairs = edges.chunk_by(|a, b| undirected(a) == undirected(b)).filter_map(|edges| match *edges {
        [a, b] if ends(a) != ends(b) => Some([a, b]),
        _ => None,
    });
    pairs.collect()
}
