//! Surfaces that cross themselves, held against volumes by hand and against winding numbers counted along random rays.

use planecut_check::check_topology;
use planecut_csg::{Material, MaterialId, Model, Tree, evaluate};
use planecut_kernel::DVec3;
use planecut_shapes::polyhedron::{Polyhedron, PolyhedronError, PolyhedronOptions, polyhedron, polyhedron_by_winding};

/// A box, seen from outside counter-clockwise, or clockwise where it is turned.
fn add_box(points: &mut Vec<DVec3>, facets: &mut Vec<Vec<u32>>, min: DVec3, max: DVec3, is_turned: bool) {
    let first = points.len() as u32;
    let corner = |k: u32| DVec3::new(side(k, 0, min.x, max.x), side(k, 1, min.y, max.y), side(k, 2, min.z, max.z));
    points.extend((0..8).map(corner));
    for face in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
        let mut face: Vec<u32> = face.iter().map(|k| first + k).collect();
        if is_turned {
            face.reverse();
        }
        facets.push(face);
    }
}

/// One end of a side of a box, by the number of the corner.
fn side(corner: u32, axis: u32, min: f64, max: f64) -> f64 {
    if corner >> axis & 1 == 1 { max } else { min }
}

fn solid(points: &[DVec3], facets: &[Vec<u32>]) -> Polyhedron {
    let solid = polyhedron_by_winding(points, facets, &[MaterialId(0)], &PolyhedronOptions::default());
    solid.unwrap_or_else(|error| panic!("{error}"))
}

/// The volume of the cells' union, whose mesh must be closed.
fn volume_of(solid: &Polyhedron) -> f64 {
    let tree: Tree = solid.clone().into();
    let evaluation = evaluate(&Model { materials: vec![Material::default()], tree }).expect("a mesh");
    let topology = check_topology(&evaluation.mesh.positions, &evaluation.mesh.triangles);
    assert!(topology.watertight && topology.manifold);
    evaluation.solid.volume
}

#[test]
fn boxes_in_one_surface_are_united_or_taken_away_by_their_sense() {
    for (is_turned, expected) in [(false, 64.0 + 64.0 - 8.0), (true, 64.0 - 8.0)] {
        let (mut points, mut facets) = (Vec::new(), Vec::new());
        add_box(&mut points, &mut facets, DVec3::ZERO, DVec3::splat(4.0), false);
        add_box(&mut points, &mut facets, DVec3::splat(2.0), DVec3::splat(6.0), is_turned);
        add_box(&mut points, &mut facets, DVec3::new(20.0, 0.0, 0.0), DVec3::new(21.0, 1.0, 1.0), false);
        let crossing = polyhedron(&points, &facets, &[MaterialId(0)], &PolyhedronOptions::default());
        assert!(matches!(crossing, Err(PolyhedronError::Crossing { .. })), "{crossing:?}");
        let solid = solid(&points, &facets);
        assert!((solid.volume - (expected + 1.0)).abs() < 1e-9, "{}", solid.volume);
        assert!((volume_of(&solid) - (expected + 1.0)).abs() < 1e-9);
    }
}

#[test]
fn what_does_not_cross_itself_is_the_same_both_ways() {
    let (mut points, mut facets) = (Vec::new(), Vec::new());
    add_box(&mut points, &mut facets, DVec3::ZERO, DVec3::splat(4.0), false);
    add_box(&mut points, &mut facets, DVec3::ONE, DVec3::splat(2.0), true);
    let cut = polyhedron(&points, &facets, &[MaterialId(0)], &PolyhedronOptions::default()).expect("a solid");
    assert_eq!((cut.volume, solid(&points, &facets).volume), (63.0, 63.0));
}

/// A generator of numbers in 0 to 1.
fn random(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1_u64 << 53) as f64
}

/// How often a surface winds around a place, by the triangles that a ray along z meets.
fn winding(points: &[DVec3], facets: &[Vec<u32>], place: DVec3) -> i32 {
    let mut winding = 0;
    for facet in facets {
        for k in 1..facet.len() - 1 {
            let [a, b, c] = [facet[0], facet[k], facet[k + 1]].map(|v| points[v as usize] - place);
            let cross = |p: DVec3, q: DVec3| p.x * q.y - p.y * q.x;
            let shares = [cross(b, c), cross(c, a), cross(a, b)];
            let area: f64 = shares.iter().sum();
            let is_met = shares.iter().all(|share| *share > 0.0) || shares.iter().all(|share| *share < 0.0);
            let height = (shares[0] * a.z + shares[1] * b.z + shares[2] * c.z) / area;
            if is_met && height > 0.0 {
                winding += if area > 0.0 { 1 } else { -1 };
            }
        }
    }
    winding
}

/// Tetrahedra at random, some of them turned, as one surface: each of 30 with some thousand places.
#[test]
fn random_surfaces_hold_the_places_that_they_wind_around() {
    let mut state = 0x5eed_u64;
    let mut compared = 0;
    for round in 0..30 {
        let (mut points, mut facets) = (Vec::new(), Vec::new());
        for _ in 0..3 + round % 4 {
            let first = points.len() as u32;
            let corner = || 10.0 * DVec3::new(random(&mut state), random(&mut state), random(&mut state));
            points.extend(std::iter::repeat_with(corner).take(4));
            facets.extend([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]].map(|f| f.map(|k| first + k).to_vec()));
        }
        let enclosed: f64 = facets
            .iter()
            .map(|f| {
                let [a, b, c] = [f[0], f[1], f[2]].map(|v| points[v as usize]);
                a.dot(b.cross(c)) / 6.0
            })
            .sum();
        let sign = if enclosed < 0.0 { -1 } else { 1 };
        let solid = solid(&points, &facets);
        assert!((volume_of(&solid) - solid.volume).abs() < 1e-9 * solid.volume, "round {round}");
        for _ in 0..1000 {
            let place = 10.0 * DVec3::new(random(&mut state), random(&mut state), random(&mut state));
            let is_in = |brush: &planecut_csg::Brush| {
                brush.faces.iter().all(|face| face.half_space.normal().dot(place) <= face.half_space.offset())
            };
            let found = solid.cells.iter().any(is_in);
            assert_eq!(found, sign * winding(&points, &facets, place) > 0, "round {round}: {place}");
            compared += usize::from(found);
        }
    }
    assert!(compared > 100, "{compared}");
}
