//! Edges that single precision cannot hold.
//!
//! Where both ends of an edge round to one place, its triangles would lose their area and readers that merge equal corners
//! would tear or pinch the surface. Such edges are contracted first, each only where the surface keeps its topology.

use std::borrow::Cow;

use glam::{DVec3, Vec3};
use planecut_csg::{Mesh, contract_edges};

/// The mesh without the edges whose ends `round` makes equal.
pub(crate) fn without_lost_edges(mesh: &Mesh, round: impl Fn(DVec3) -> Vec3) -> Cow<'_, Mesh> {
    let is_lost = |a: DVec3, b: DVec3| round(a) == round(b);
    let at = |corner: u32| mesh.positions[corner as usize];
    let any =
        mesh.triangles.iter().any(|&[a, b, c]| is_lost(at(a), at(b)) || is_lost(at(b), at(c)) || is_lost(at(c), at(a)));
    if !any {
        return Cow::Borrowed(mesh);
    }
    let mut reduced = mesh.clone();
    contract_edges(&mut reduced, is_lost);
    Cow::Owned(reduced)
}

#[cfg(test)]
mod tests {
    use super::*;
    use planecut_csg::{Material, MaterialId, MeshFace};

    /// An octahedron around the origin, its top split into two corners `gap` apart.
    fn split_octahedron(gap: f64) -> Mesh {
        let positions = vec![
            DVec3::X,
            DVec3::Y,
            -DVec3::X,
            -DVec3::Y,
            -DVec3::Z,
            DVec3::new(gap, 0.0, 1.0),
            DVec3::new(-gap, 0.0, 1.0),
        ];
        let triangles = vec![
            [0, 1, 5],
            [1, 2, 6],
            [2, 3, 6],
            [3, 0, 5],
            [1, 6, 5],
            [3, 5, 6],
            [1, 0, 4],
            [2, 1, 4],
            [3, 2, 4],
            [0, 3, 4],
        ];
        let faces = vec![MeshFace { normal: DVec3::Z, material: MaterialId(0) }; triangles.len()];
        let triangle_faces = (0..triangles.len() as u32).collect();
        Mesh { positions, triangles, triangle_faces, faces, materials: vec![Material::named("m")] }
    }

    #[test]
    fn an_edge_that_rounds_away_goes_and_others_stay() {
        let mesh = split_octahedron(1e-60);
        let shift = |p: DVec3| (p + DVec3::ONE).as_vec3();
        let reduced = without_lost_edges(&mesh, shift);
        assert_eq!((reduced.positions.len(), reduced.triangles.len()), (6, 8));
        let topology = planecut_check::check_topology(&reduced.positions, &reduced.triangles);
        assert!(topology.watertight && topology.manifold);
        assert!(matches!(without_lost_edges(&split_octahedron(0.25), shift), Cow::Borrowed(_)));
    }
}
