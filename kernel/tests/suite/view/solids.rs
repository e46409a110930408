//! Solids whose vertices, edges and faces are known.

use planecut_kernel::{DEFAULT_EPSILON, DVec3, EdgeIdx, EdgeKind, HalfSpace, IncrementalPolytope, PlaneIdx, VertexIdx};

use super::consistency::{check, compare_with_facets};

pub(crate) fn half_space(nx: f64, ny: f64, nz: f64, d: f64) -> HalfSpace {
    HalfSpace::new(DVec3::new(nx, ny, nz), d).expect("an accepted plane")
}

pub(crate) fn polytope(planes: &[[f64; 4]]) -> IncrementalPolytope {
    let mut polytope = IncrementalPolytope::new();
    for [nx, ny, nz, d] in planes {
        polytope.add_plane(half_space(*nx, *ny, *nz, *d));
    }
    polytope
}

const CUBE: [[f64; 4]; 6] = [
    [1.0, 0.0, 0.0, 1.0],
    [-1.0, 0.0, 0.0, 1.0],
    [0.0, 1.0, 0.0, 1.0],
    [0.0, -1.0, 0.0, 1.0],
    [0.0, 0.0, 1.0, 1.0],
    [0.0, 0.0, -1.0, 1.0],
];

/// Finite and ideal vertices; segments, rays and lines; bounded and unbounded faces.
fn census(polytope: &IncrementalPolytope) -> ([usize; 2], [usize; 3], [usize; 2]) {
    check(polytope, DEFAULT_EPSILON).unwrap_or_else(|e| panic!("{e}"));
    compare_with_facets(polytope).unwrap_or_else(|e| panic!("{e}"));
    let finite = polytope.vertices().filter(|(_, vertex)| vertex.is_finite()).count();
    let kinds = [EdgeKind::Segment, EdgeKind::Ray, EdgeKind::Line]
        .map(|kind| polytope.edges().filter(|(_, edge)| edge.kind == kind).count());
    let bounded = polytope.faces().iter().filter(|face| face.is_bounded).count();
    ([finite, polytope.vertex_count() - finite], kinds, [bounded, polytope.faces().len() - bounded])
}

#[test]
fn bounded_solids() {
    let tetrahedron =
        polytope(&[[-1.0, 0.0, 0.0, 0.0], [0.0, -1.0, 0.0, 0.0], [0.0, 0.0, -1.0, 0.0], [1.0, 1.0, 1.0, 1.0]]);
    assert_eq!(census(&tetrahedron), ([4, 0], [6, 0, 0], [4, 0]));
    assert_eq!(census(&polytope(&CUBE)), ([8, 0], [12, 0, 0], [6, 0]));
}

#[test]
fn an_apex_of_many_planes_is_one_vertex() {
    for sides in [4, 5, 8, 33] {
        let mut pyramid = IncrementalPolytope::new();
        for k in 0..sides {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / f64::from(sides)).sin_cos();
            pyramid.add_plane(half_space(cos, sin, 1.0, 1.0));
        }
        let sides = sides as usize;
        assert_eq!(census(&pyramid), ([1, sides], [0, sides, 0], [0, sides]));
        pyramid.add_plane(half_space(0.0, 0.0, -1.0, 0.0));
        // touches the apex only
        pyramid.add_plane(half_space(0.0, 0.0, 1.0, 1.0));
        assert_eq!(census(&pyramid), ([sides + 1, 0], [2 * sides, 0, 0], [sides + 1, 0]));
        let (_, apex) = pyramid.vertices().find(|(_, v)| v.position.z > 0.5).expect("the apex");
        assert_eq!((apex.to_euclidean(), apex.direction()), (Some(DVec3::Z), None));
        assert_eq!((apex.planes.len(), apex.edges.len()), (sides, sides));
    }
}

#[test]
fn all_of_space_and_a_half_space_and_a_slab_have_no_edges() {
    assert_eq!(census(&IncrementalPolytope::new()), ([0, 0], [0, 0, 0], [0, 0]));
    assert_eq!(census(&polytope(&CUBE[..1])), ([0, 0], [0, 0, 0], [0, 1]));
    assert_eq!(census(&polytope(&CUBE[..2])), ([0, 0], [0, 0, 0], [0, 2]));
}

#[test]
fn a_wedge_has_one_line() {
    let wedge = polytope(&[[1.0, 0.0, 0.0, 1.0], [0.0, 3.0, 0.0, 2.0]]);
    assert_eq!(census(&wedge), ([0, 2], [0, 0, 1], [0, 2]));
    let (_, line) = wedge.edges().next().expect("the line");
    assert_eq!(line.planes, (PlaneIdx(0), PlaneIdx(1)));
    assert_eq!(line.direction, DVec3::Z);
    let end = wedge.vertex(line.vertices.1).expect("its end");
    assert_eq!((end.direction(), end.to_euclidean()), (Some(DVec3::Z), None));
    // planes that touch the line from outside, older and younger, change nothing
    let touched = polytope(&[[1.0, 3.0, 0.0, 3.0], [1.0, 0.0, 0.0, 1.0], [0.0, 3.0, 0.0, 2.0], [2.0, 3.0, 0.0, 4.0]]);
    assert_eq!(census(&touched), ([0, 2], [0, 0, 1], [0, 2]));
}

#[test]
fn an_octant_has_rays() {
    let octant = polytope(&[[-1.0, 0.0, 0.0, 0.0], [0.0, -1.0, 0.0, 0.0], [0.0, 0.0, -1.0, 0.0]]);
    assert_eq!(census(&octant), ([1, 3], [0, 3, 0], [0, 3]));
    let directions: Vec<DVec3> = octant.vertices().filter_map(|(_, vertex)| vertex.direction()).collect();
    assert!(DVec3::AXES.iter().all(|axis| directions.contains(axis)), "{directions:?}");
}

#[test]
fn an_infinite_prism_has_lines() {
    for sides in [3, 4, 7] {
        let mut prism = IncrementalPolytope::new();
        for k in 0..sides {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / f64::from(sides)).sin_cos();
            prism.add_plane(half_space(cos, sin, 0.0, 1.0));
        }
        let sides = sides as usize;
        assert_eq!(census(&prism), ([0, 2 * sides], [0, 0, sides], [0, sides]));
        prism.add_plane(half_space(0.25, 0.0, 1.0, 0.0));
        assert_eq!(census(&prism), ([sides, sides], [sides, sides, 0], [1, sides]));
    }
}

#[test]
fn boxes_with_open_sides() {
    assert_eq!(census(&polytope(&CUBE[..5])), ([4, 4], [4, 4, 0], [1, 4]));
    assert_eq!(census(&polytope(&CUBE[..4])), ([0, 8], [0, 0, 4], [0, 4]));
    assert_eq!(census(&polytope(&CUBE[..3])), ([0, 4], [0, 0, 2], [0, 3]));
}

#[test]
fn a_line_into_the_corner_of_two_infinity_planes_is_seen_once() {
    // (92, 3, 0) is perpendicular to the difference of two of the infinity planes' normals, and the line meets the origin
    let mut planes = vec![[3.0, -92.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
    assert_eq!(census(&polytope(&planes)), ([0, 2], [0, 0, 1], [0, 2]));
    for touching in [[3.0, -92.0, 1.0, 0.0], [6.0, -184.0, 1.0, 0.0], [3.0, -92.0, 5.0, 0.0]] {
        planes.insert(0, touching);
        assert_eq!(census(&polytope(&planes)), ([0, 2], [0, 0, 1], [0, 2]), "{planes:?}");
    }
    planes.push([-92.0, -3.0, 0.0, 0.0]);
    assert_eq!(census(&polytope(&planes)), ([1, 3], [0, 3, 0], [0, 3]));
}

#[test]
fn handles_that_are_not_there_give_nothing() {
    let cube = polytope(&CUBE);
    assert_eq!(cube.vertex(VertexIdx(u32::MAX)), None);
    assert_eq!(cube.edge(EdgeIdx(u32::MAX)), None);
    assert_eq!(cube.edge(EdgeIdx(3)), None);
    assert_eq!(cube.edge_by_planes(PlaneIdx(0), PlaneIdx(1)), None);
    assert_eq!(cube.edge_by_planes(PlaneIdx(0), PlaneIdx(0)), None);
    assert_eq!(cube.edge_by_planes(PlaneIdx(0), PlaneIdx(6)), None);
    let (name, edge) = cube.edges().next().expect("an edge");
    let far = cube.vertices().map(|(v, _)| v).find(|v| edge.other_vertex(*v).is_none());
    assert!(far.is_some() && cube.edge(name).as_ref() == Some(&edge));
    let mut empty = cube.clone();
    let handle = empty.vertices().next().expect("a corner").0;
    empty.add_plane(half_space(1.0, 0.0, 0.0, -1.0));
    assert_eq!((empty.vertex(handle), empty.edge(name), empty.vertex_count()), (None, None, 0));
    assert_eq!(census(&empty), ([0, 0], [0, 0, 0], [0, 0]));
}

#[test]
fn new_vertices_of_an_addition_are_found() {
    let mut cube = polytope(&CUBE);
    let created = match cube.add_plane(half_space(1.0, 1.0, 1.0, 2.0)) {
        planecut_kernel::AddPlaneResult::Added { new_vertices, .. } => new_vertices.to_vec(),
        other => panic!("{other:?}"),
    };
    assert_eq!(created.len(), 3);
    for idx in created {
        assert!(cube.vertex(idx).is_some_and(|vertex| vertex.planes.contains(&PlaneIdx(6))));
    }
}

#[test]
fn clipped_meshes() {
    let (low, high) = (DVec3::splat(-2.0), DVec3::splat(2.0));
    let cube = polytope(&CUBE);
    assert_eq!(cube.to_mesh_clipped(low, high), cube.to_mesh());
    let space = IncrementalPolytope::new();
    let (points, faces) = space.to_mesh_clipped(low, high);
    assert_eq!((points.len(), faces.len()), (8, 6));
    assert!(points.iter().all(|p| p.abs() == high));
    let octant = polytope(&[[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]);
    let (points, faces) = octant.to_mesh_clipped(low, high);
    assert_eq!((points.len(), faces.len()), (8, 6));
    assert!(points.iter().all(|p| p.max_element() <= 0.0 && p.min_element() >= -2.0));
    // outside, without interior, turned around, not a number
    let nothing = (Vec::new(), Vec::new());
    assert_eq!(octant.to_mesh_clipped(DVec3::splat(1.0), high), nothing);
    assert_eq!(octant.to_mesh_clipped(low, low.with_x(1.0)), nothing);
    assert_eq!(octant.to_mesh_clipped(high, low), nothing);
    assert_eq!(octant.to_mesh_clipped(low, DVec3::NAN), nothing);
    assert_eq!(space.to_mesh_clipped(DVec3::NEG_INFINITY, DVec3::INFINITY).0.len(), 8);
    // an unbounded set has only its bounded faces in the mesh
    assert_eq!(octant.to_mesh(), (vec![DVec3::ZERO], Vec::new()));
}

#[test]
fn the_tolerance_contracts_short_edges() {
    let mut cube = IncrementalPolytope::with_epsilon(1e-3);
    for [nx, ny, nz, d] in CUBE {
        cube.add_plane(half_space(nx, ny, nz, d));
    }
    // a corner and an edge cut off by less than the tolerance
    cube.add_plane(half_space(1.0, 1.0, 1.0, 3.0 - 1e-4));
    cube.add_plane(half_space(-1.0, -1.0, 0.0, 2.0 - 1e-4));
    check(&cube, 1e-3).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!((cube.vertex_count(), cube.edge_count(), cube.faces().len()), (8, 12, 6));
    assert!(cube.edge_by_planes(PlaneIdx(1), PlaneIdx(3)).is_some(), "the outer planes of the flattened edge");
}

#[test]
fn needles_plates_and_specks_below_the_tolerance_keep_their_shape() {
    for [x, y, z] in [[1e-9, 1e-9, 1e-9], [1e-9, 1e-9, 1.0], [1e-9, 1.0, 1.0], [1.0, 1.0, 1.0]] {
        let brick = polytope(&[
            [1.0, 0.0, 0.0, x],
            [-1.0, 0.0, 0.0, x],
            [0.0, 1.0, 0.0, y],
            [0.0, -1.0, 0.0, y],
            [0.0, 0.0, 1.0, z],
            [0.0, 0.0, -1.0, z],
        ]);
        assert_eq!(census(&brick), ([8, 0], [12, 0, 0], [6, 0]));
    }
}
