//! Faces have the materials of their facets.

use glam::DVec3;
use planecut_csg::MaterialId;
use planecut_shapes::polyhedron::{PolyhedronOptions, polyhedron};

use super::judge::{Given, cube, evaluated, prism};

fn with_own_materials(given: &Given) -> Vec<planecut_csg::Brush> {
    let materials: Vec<MaterialId> = (0..given.facets.len() as u32).map(MaterialId).collect();
    let solid = polyhedron(&given.points, &given.facets, &materials, &PolyhedronOptions::default());
    solid.expect("a closed surface").cells
}

/// Each face of the skin lies on a facet of its material.
fn judge(given: &Given) {
    let evaluation = evaluated(&with_own_materials(given));
    let mesh = &evaluation.mesh;
    for (triangle, face) in mesh.triangles.iter().zip(&mesh.triangle_faces) {
        let [a, b, c] = triangle.map(|v| mesh.positions[v as usize]);
        let facet = &given.facets[mesh.faces[*face as usize].material.0 as usize];
        let [p, q, r] = [0, 1, 2].map(|k| given.points[facet[k] as usize]);
        let (normal, own) = ((q - p).cross(r - p).normalize(), (b - a).cross(c - a).normalize());
        assert!(normal.dot(own) > 0.99, "{facet:?}");
        assert!([a, b, c].iter().all(|v| normal.dot(v - p).abs() < 1e-9), "{facet:?}");
    }
}

#[test]
fn of_convex_bodies() {
    judge(&cube(DVec3::ZERO, DVec3::new(1.0, 2.0, 3.0)));
}

#[test]
fn of_bodies_that_are_cut() {
    judge(&prism(&[[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.5], [1.0, 3.0], [0.0, 3.0]], 2.0));
}

#[test]
fn of_bodies_with_cavities() {
    judge(&cube(DVec3::ZERO, DVec3::splat(5.0)).and(&cube(DVec3::ONE, DVec3::splat(4.0)).turned()));
}
