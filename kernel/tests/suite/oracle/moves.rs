//! What a move reports: a face that keeps its corners moves them, and nothing else; one that does not gets new ones.

use std::collections::BTreeMap;

use planecut_kernel::{DVec4, IncrementalPolytope, PlaneIdx, Vertex, VertexIdx};
use planecut_oracle::generators::{fibonacci, plane};
use planecut_oracle::kernel_calls::half_space;
use planecut_oracle::structure::Structure;

const FACES: usize = 40;

/// A ball of tangent planes in general position, none of them hidden.
fn ball() -> (IncrementalPolytope, Vec<PlaneIdx>) {
    let mut polytope = IncrementalPolytope::with_epsilon(0.0);
    let planes = (0..FACES).map(|k| polytope.add_plane(half_space(fibonacci(k, FACES))).plane()).collect();
    (polytope, planes)
}

fn vertices(polytope: &IncrementalPolytope) -> BTreeMap<VertexIdx, Vertex> {
    polytope.vertices().collect()
}

/// `n·x − d` at a finite vertex.
fn distance(position: DVec4, [x, y, z, d]: [f64; 4]) -> f64 {
    DVec4::new(x, y, z, -d).dot(position)
}

#[test]
fn a_face_that_keeps_its_corners_moves_them() {
    let (whole, planes) = ball();
    let before = vertices(&whole);
    let mut kept = 0;
    for (k, &handle) in planes.iter().enumerate() {
        let [x, y, z, d] = fibonacci(k, FACES);
        for shift in [1e-6, -1e-6] {
            let to = plane([x, y, z], d + shift);
            let mut polytope = whole.clone();
            let moved = polytope.move_plane(handle, half_space(to)).expect("a plane that is there");
            let mut reported = moved.moved_vertices.to_vec();
            assert!(moved.has_face, "plane {k}: {moved:?}");
            if reported.is_empty() {
                assert!(!moved.new_vertices.is_empty(), "plane {k}: {moved:?}");
                continue;
            }
            kept += 1;
            assert!(moved.removed_vertices.is_empty() && moved.new_vertices.is_empty(), "plane {k}: {moved:?}");
            reported.sort_unstable();
            let corners = before.iter().filter(|(_, vertex)| vertex.planes.contains(&handle)).map(|(idx, _)| *idx);
            assert_eq!(reported, corners.collect::<Vec<_>>(), "plane {k}");
            for (idx, vertex) in vertices(&polytope) {
                assert_eq!(vertex.planes, before[&idx].planes, "plane {k}");
                if reported.contains(&idx) {
                    assert!(distance(vertex.position, to).abs() < 1e-12, "plane {k}: {vertex:?}");
                } else {
                    assert_eq!(vertex.position, before[&idx].position, "plane {k}");
                }
            }
        }
    }
    // Planes that hide others are taken out and added; here these are the four at infinity, hidden by three planes each.
    assert!(kept >= 2 * (FACES - 12), "{kept} of {} moves", 2 * FACES);
}

#[test]
fn a_face_that_loses_or_gains_corners_gets_new_ones() {
    let (whole, planes) = ball();
    for (k, &handle) in planes.iter().enumerate() {
        let [x, y, z, _] = fibonacci(k, FACES);
        for offset in [0.7, 2.0] {
            let mut polytope = whole.clone();
            let moved =
                polytope.move_plane(handle, half_space(plane([x, y, z], offset))).expect("a plane that is there");
            assert!(moved.moved_vertices.is_empty() && !moved.removed_vertices.is_empty(), "plane {k}: {moved:?}");
            assert!(!moved.new_vertices.is_empty(), "plane {k}: {moved:?}");
            assert_eq!(moved.has_face, offset < 1.0, "plane {k}");
            assert_eq!(Structure::of(&polytope, &planes), Structure::of_fresh_build(&polytope, &planes), "plane {k}");
        }
    }
}

/// After a move the cached positions are those of the new planes: what is decided next is decided by them.
#[test]
fn what_follows_a_move_sees_the_moved_corners() {
    let (whole, planes) = ball();
    for (k, &handle) in planes.iter().enumerate() {
        let [x, y, z, d] = fibonacci(k, FACES);
        let mut polytope = whole.clone();
        assert!(polytope.move_plane(handle, half_space(plane([x, y, z], d + 1e-3))).is_some());
        // between the old and the new place of the face
        let between = polytope.add_plane(half_space(plane([x, y, z], d + 5e-4))).plane();
        assert!(!polytope.is_redundant(between), "plane {k}");
        let order: Vec<PlaneIdx> = planes.iter().copied().chain([between]).collect();
        assert_eq!(Structure::of(&polytope, &order), Structure::of_fresh_build(&polytope, &order), "plane {k}");
    }
}
