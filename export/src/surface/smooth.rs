//! Normals that faces share, by crease angle.

use glam::DVec3;
use planecut_csg::Mesh;
use planecut_csg::stages::{DisjointSets, HalfEdges, NO_TWIN, next};

/// Room for rounding in the cosine of the crease angle: faces that meet at exactly this angle share.
const NORMAL_ROUNDING: f64 = 1e-9;

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
        // half-edges and corners have the same numbers: each begins at its corner
        let mut sets = DisjointSets::new(3 * mesh.triangles.len());
        let least = crease.to_radians().cos() - NORMAL_ROUNDING;
        let normal = |triangle: u32| mesh.faces[mesh.triangle_faces[triangle as usize] as usize].normal.normalize();
        let twins = HalfEdges::new(mesh.positions.len(), &mesh.triangles).twins();
        for (a, b) in (0..).zip(twins) {
            if b != NO_TWIN && a < b && normal(a / 3).dot(normal(b / 3)) >= least {
                sets.join(a, next(b));
                sets.join(next(a), b);
            }
        }
        let standing: Vec<u32> = (0..3 * mesh.triangles.len() as u32).map(|corner| sets.root(corner)).collect();
        let mut normals = vec![DVec3::ZERO; standing.len()];
        for triangle in 0..mesh.triangles.len() as u32 {
            let points = mesh.triangles[triangle as usize].map(|corner| mesh.positions[corner as usize]);
            for k in 0..3 {
                let sides = [1, 2].map(|step| (points[(k + step) % 3] - points[k]).normalize_or_zero());
                let angle = sides[0].dot(sides[1]).clamp(-1.0, 1.0).acos();
                normals[standing[3 * triangle as usize + k] as usize] += angle * normal(triangle);
            }
        }
        for corner in 0..normals.len() as u32 {
            // of opposite faces nothing is left: then each its own would be as good
            if standing[corner as usize] == corner && normals[corner as usize].length() < NORMAL_ROUNDING {
                normals[corner as usize] = normal(corner / 3);
            }
        }
        Self { standing, normals }
    }

    /// What stands for the normal at a corner of a triangle.
    pub(super) fn shared_by(&self, triangle: u32, corner: usize) -> u32 {
        self.standing[3 * triangle as usize + corner]
    }

    /// The normal, not of unit length.
    pub(super) fn normal(&self, shared: u32) -> DVec3 {
        self.normals[shared as usize]
    }
}
