//! Structures broken on purpose: every check must be able to fail, and the rebuild to repair.

use glam::DVec3;

use super::super::store::{BEFORE, Link, NEXT, PlaneState};
use super::super::{IncrementalPolytope, PlaneIdx, VertexIdx, external, infinity};
use super::{InvariantError, TopologyError, Validation, ValidationError};
use crate::half_space::HalfSpace;
use crate::sign::Row;

/// Planes in general position.
const PLANES: [[f64; 4]; 8] = [
    [1.0, 0.1, 0.2, 1.0],
    [-0.3, 1.0, 0.1, 1.1],
    [0.2, -0.4, 1.0, 1.2],
    [-0.7, -0.5, -0.6, 1.3],
    [0.9, 0.8, -0.3, 1.4],
    [-0.8, 0.7, 0.4, 1.5],
    [0.1, -0.9, -0.5, 1.6],
    [0.4, 0.3, -1.0, 1.7],
];

/// A tetrahedron on four planes: which three meet at each vertex, in the order of the links.
const TETRAHEDRON: [[u32; 3]; 4] = [[1, 3, 2], [0, 2, 3], [0, 3, 1], [0, 1, 2]];

fn half_space([nx, ny, nz, d]: [f64; 4]) -> HalfSpace {
    HalfSpace::new(DVec3::new(nx, ny, nz), d).expect("an accepted plane")
}

fn polytope(planes: &[[f64; 4]]) -> IncrementalPolytope {
    let mut polytope = IncrementalPolytope::new();
    for plane in planes {
        polytope.add_plane(half_space(*plane));
    }
    polytope
}

fn cube() -> IncrementalPolytope {
    polytope(&[
        [1.0, 0.0, 0.0, 1.0],
        [-1.0, 0.0, 0.0, 1.0],
        [0.0, 1.0, 0.0, 1.0],
        [0.0, -1.0, 0.0, 1.0],
        [0.0, 0.0, 1.0, 1.0],
        [0.0, 0.0, -1.0, 1.0],
        [1.0, 1.0, 1.0, 9.0],
    ])
}

/// Any structure at all, given by the planes of its vertices: two half-edges on the same two planes, in opposite order,
/// become one edge; of several, the first is joined to the last.
fn assemble(planes: &[[f64; 4]], vertices: &[[u32; 3]]) -> IncrementalPolytope {
    let mut polytope = IncrementalPolytope::new();
    for plane in planes {
        polytope.planes.insert(half_space(*plane), Row::new(&half_space(*plane)));
    }
    polytope.vertices.clear();
    for plane in 0..infinity::COUNT {
        polytope.planes.set_without_face(plane, PlaneState::Uncertified);
    }
    let mut open: Vec<(Link, [u32; 2])> = Vec::new();
    for planes in vertices.iter().map(|planes| planes.map(|plane| plane + infinity::COUNT)) {
        let point = polytope.meeting_point(planes);
        let slot = polytope.vertices.insert(planes, point);
        polytope.vertices.take_fresh(slot);
        for (k, plane) in planes.into_iter().enumerate() {
            polytope.planes.set_face(plane, slot);
            open.push((Link::new(slot, k), [planes[NEXT[k]], planes[BEFORE[k]]]));
        }
    }
    while !open.is_empty() {
        let (edge, [p, q]) = open.remove(0);
        let twin = open.iter().rposition(|(_, planes)| *planes == [q, p]).expect("each edge has two ends");
        polytope.vertices.join(edge, open.remove(twin).0);
    }
    polytope
}

/// Puts other planes in the place of a vertex, links kept.
fn replace_planes(polytope: &mut IncrementalPolytope, slot: u32, planes: [u32; 3]) {
    let links = polytope.vertices.links(slot);
    let point = *polytope.vertices.point(slot);
    polytope.vertices.remove(slot);
    assert_eq!(polytope.vertices.insert(planes, point), slot);
    polytope.vertices.take_fresh(slot);
    for (k, link) in links.into_iter().enumerate() {
        polytope.vertices.join(Link::new(slot, k), link);
    }
}

/// What a function of planes and stamps must not change.
fn structure(polytope: &IncrementalPolytope) -> Vec<[Option<PlaneIdx>; 3]> {
    let turned = |mut planes: [Option<PlaneIdx>; 3]| {
        let first = (0..3).min_by_key(|k| planes[*k]).expect("three planes");
        planes.rotate_left(first);
        planes
    };
    let mut vertices: Vec<_> = polytope.simple_vertices().map(turned).collect();
    vertices.sort_unstable();
    vertices
}

/// The fallback finds the error and makes the polytope what `intact` is.
fn repairs(mut broken: IncrementalPolytope, intact: &IncrementalPolytope) -> ValidationError {
    let Validation::Rebuilt(error) = broken.validate_or_rebuild() else { panic!("nothing was found") };
    assert_eq!(broken.rebuild_count(), 1);
    assert_eq!(structure(&broken), structure(intact));
    for (plane, half_space) in intact.planes() {
        assert_eq!((broken.plane(plane), broken.stamp(plane)), (Some(half_space), intact.stamp(plane)));
        assert_eq!(broken.is_redundant(plane), intact.is_redundant(plane));
    }
    assert_eq!(broken.validate_or_rebuild(), Validation::Sound);
    assert_eq!(broken.rebuild_count(), 1);
    // the record of changes starts afresh: nothing that stays counts as made by the next operation
    let handle = broken.planes().next().expect("a plane").0;
    let removed = broken.remove_plane(handle).expect("it is there");
    assert_eq!(removed.had_face, !removed.removed_vertices.is_empty());
    error
}

#[test]
fn a_sound_structure_is_left_alone() {
    let mut polytope = cube();
    assert_eq!(polytope.validate_or_rebuild(), Validation::Sound);
    assert_eq!(polytope.rebuild_count(), 0);
}

#[test]
fn euler() {
    let both: Vec<[u32; 3]> = TETRAHEDRON.into_iter().chain(TETRAHEDRON.map(|v| v.map(|p| p + 4))).collect();
    let broken = assemble(&PLANES, &both);
    let expected = TopologyError::Euler { vertices: 8, edges: 12, faces: 8, expected: 2 };
    assert_eq!(broken.validate_topology(), Err(expected));
    assert_eq!(broken.check_invariants(), Err(InvariantError::Euler { vertices: 8, faces: 8 }));
    assert_eq!(repairs(broken, &polytope(&PLANES)), InvariantError::Euler { vertices: 8, faces: 8 }.into());
}

#[test]
fn vertex_degree() {
    let mut broken = cube();
    let slot = broken.vertices.slots().next().expect("a vertex");
    let [a, b, _] = broken.vertices.planes(slot);
    replace_planes(&mut broken, slot, [a, a, b]);
    let expected = TopologyError::VertexDegree { vertex: VertexIdx(slot), planes: 2 };
    assert_eq!(broken.validate_topology(), Err(expected));
    assert!(matches!(repairs(broken, &cube()), ValidationError::Invariant(InvariantError::Link { .. })));
}

#[test]
fn ideal_degree() {
    let octant = polytope(&PLANES[..3]);
    let mut broken = octant.clone();
    let is_end =
        |slot: &u32| broken.vertices.planes(*slot).into_iter().filter(|p| infinity::is_infinity(*p)).count() == 1;
    let slot = broken.vertices.slots().find(is_end).expect("the end of a ray");
    let mut planes = broken.vertices.planes(slot);
    let k = planes.iter().position(|plane| infinity::is_infinity(*plane)).expect("an infinity plane");
    planes[NEXT[k]] = planes[BEFORE[k]];
    replace_planes(&mut broken, slot, planes);
    let expected = TopologyError::IdealDegree { vertex: VertexIdx(slot), planes: 1 };
    assert_eq!(broken.validate_topology(), Err(expected));
    repairs(broken, &octant);
}

#[test]
fn edge_validity() {
    let mut broken = cube();
    let slot = broken.vertices.slots().next().expect("a vertex");
    broken.vertices.remove(slot);
    let Err(TopologyError::EdgeValidity { edge, vertex }) = broken.validate_topology() else { panic!("not found") };
    assert_eq!(vertex, VertexIdx(slot));
    assert!(cube().vertices.neighbours(slot).contains(&(edge.0 >> 2)));
    assert!(matches!(repairs(broken, &cube()), ValidationError::Invariant(InvariantError::Link { .. })));
}

#[test]
fn face_size() {
    // two vertices joined by three edges: all faces have two corners
    let broken = assemble(&PLANES[..3], &[[0, 1, 2], [0, 2, 1]]);
    assert_eq!(broken.validate_topology(), Err(TopologyError::FaceSize { plane: PlaneIdx(0), vertices: 2 }));
    repairs(broken, &polytope(&PLANES[..3]));
    // an orphan: it is said to have a face, and has none
    let mut broken = cube();
    let orphan = infinity::COUNT + 6;
    broken.forget_certificate(orphan);
    broken.planes.set_face(orphan, 0);
    assert_eq!(broken.validate_topology(), Err(TopologyError::FaceSize { plane: PlaneIdx(6), vertices: 0 }));
    assert_eq!(repairs(broken, &cube()), InvariantError::Euler { vertices: 8, faces: 7 }.into());
}

#[test]
fn edge_uniqueness() {
    // between planes 0 and 1 twice two triangles side by side
    let lens = |a: u32, b: u32| [[0, 1, a], [0, a, b], [1, b, a], [1, 0, b]];
    let broken = assemble(&PLANES[..6], &[lens(2, 3), lens(4, 5)].concat());
    let Err(TopologyError::EdgeUniqueness { planes, edges }) = broken.validate_topology() else { panic!("not found") };
    assert_eq!(planes, (PlaneIdx(0), PlaneIdx(1)));
    for edge in [edges.0, edges.1] {
        assert_eq!(broken.edge(edge).map(|edge| edge.planes), Some(planes));
    }
    repairs(broken, &polytope(&PLANES[..6]));
}

#[test]
fn links() {
    let mut broken = cube();
    let slot = broken.vertices.slots().next().expect("a vertex");
    let [a, b, _] = broken.vertices.links(slot);
    broken.vertices.join(Link::new(slot, 0), b);
    broken.vertices.join(Link::new(slot, 1), a);
    assert!(matches!(broken.check_invariants(), Err(InvariantError::Link { vertex, .. }) if vertex == slot));
    repairs(broken, &cube());
}

#[test]
fn orientation() {
    let tetrahedron = polytope(&PLANES[..4]);
    let mirrored = TETRAHEDRON.map(|[a, b, c]| [a, c, b]);
    let [turned, straight] = [mirrored, TETRAHEDRON].map(|vertices| assemble(&PLANES[..4], &vertices));
    let broken = if straight.check_invariants().is_ok() { turned } else { straight };
    assert!(matches!(repairs(broken, &tetrahedron), ValidationError::Invariant(InvariantError::Orientation { .. })));
}

#[test]
fn convexity() {
    // a tetrahedron turned inside out: its last plane on the far side of the apex
    let mut planes = [[-1.0, 0.0, 0.0, 0.0], [0.0, -1.0, 0.0, 0.0], [0.0, 0.0, -1.0, 0.0], [1.0, 1.0, 1.0, 1.0]];
    let is_sound = |vertices: &[[u32; 3]]| assemble(&planes, vertices).check_invariants().is_ok();
    let mirrored = TETRAHEDRON.map(|[a, b, c]| [a, c, b]);
    let vertices = if is_sound(&mirrored) { mirrored } else { TETRAHEDRON };
    assert!(is_sound(&vertices));
    planes[3][3] = -1.0;
    let broken = assemble(&planes, &vertices);
    assert!(matches!(broken.check_invariants(), Err(InvariantError::Convexity { .. })));
    let empty = polytope(&planes);
    assert!(empty.is_empty());
    let mut repaired = broken;
    assert!(matches!(repaired.validate_or_rebuild(), Validation::Rebuilt(_)));
    assert!(repaired.is_empty());
}

#[test]
fn face_vertices() {
    let mut broken = cube();
    let plane = infinity::COUNT;
    let away = broken.vertices.slots().find(|slot| !broken.vertices.planes(*slot).contains(&plane)).expect("a far one");
    broken.planes.set_face(plane, away);
    assert_eq!(broken.validate_topology(), Err(TopologyError::FaceSize { plane: PlaneIdx(0), vertices: 0 }));
    assert_eq!(repairs(broken, &cube()), InvariantError::FaceVertex { plane }.into());
}

#[test]
fn certificates() {
    let mut broken = cube();
    let hidden = infinity::COUNT + 6;
    assert_eq!(external(hidden), PlaneIdx(6));
    let cut = half_space([1.0, 1.0, 1.0, 2.0]);
    broken.planes.replace(hidden, cut, Row::new(&cut));
    assert_eq!(broken.check_invariants(), Err(InvariantError::Certificate { plane: hidden }));
    let mut intact = cube();
    intact.move_plane(PlaneIdx(6), cut);
    assert_eq!(repairs(broken, &intact), InvariantError::Certificate { plane: hidden }.into());
}
