//! Whoever has no glam, or another version of it, gives and takes arrays, tuples or (feature `mint`) the vectors of `mint`.

use planecut_kernel::sign::Row;
use planecut_kernel::{
    ClosestFeature, HalfSpace, HalfSpaceError, IncrementalPolytope, InteriorPoint, Location, Support, hull,
    hull_triangles, meet,
};

/// The cube `[0, 1]³`, its planes given as four numbers each.
fn cube() -> IncrementalPolytope {
    let mut cube = IncrementalPolytope::new();
    for axis in 0..3 {
        for (side, offset) in [(1.0, 1.0), (-1.0, 0.0)] {
            let mut plane = [0.0, 0.0, 0.0, offset];
            plane[axis] = side;
            cube.add_plane(HalfSpace::from_array(plane).expect("a unit normal is accepted"));
        }
    }
    cube
}

#[test]
fn half_spaces_are_made_of_arrays_and_tuples_and_give_arrays() {
    let half_space = HalfSpace::new([1.0, 2.0, 3.0], 4.0).expect("it is accepted");
    assert_eq!(Ok(half_space), HalfSpace::new((1.0, 2.0, 3.0), 4.0));
    assert_eq!(Ok(half_space), HalfSpace::from_array([1.0, 2.0, 3.0, 4.0]));
    assert_eq!(Ok(half_space), HalfSpace::try_from([1.0, 2.0, 3.0, 4.0]));
    assert_eq!(half_space.to_array(), [1.0, 2.0, 3.0, 4.0]);
    assert_eq!(<[f64; 4]>::from(half_space.flipped()), [-1.0, -2.0, -3.0, -4.0]);
    assert_eq!(half_space.normal().to_array(), [1.0, 2.0, 3.0]);
    assert_eq!(half_space.signed_distance([1.0, 2.0, 3.0]), 10.0 / 14f64.sqrt());
    assert_eq!(HalfSpace::from_array([0.0, 0.0, 0.0, 1.0]), Err(HalfSpaceError::ZeroNormal));
}

#[test]
fn queries_take_arrays_and_tuples_and_give_arrays() {
    let cube = cube();
    assert!(cube.contains([0.5, 0.5, 1.0]) && !cube.contains((0.5, 0.5, 1.5)));
    assert_eq!(cube.classify([0.5, 0.5, 1.0]), Location::On);
    assert_eq!(cube.distance((0.5, 0.5, 3.0)), 2.0);
    let closest = cube.closest_point([2.0, 0.5, 0.5]).expect("it is not empty");
    assert_eq!(closest.point.to_array(), [1.0, 0.5, 0.5]);
    assert!(matches!(closest.feature, ClosestFeature::Face(_)));
    let Some(Support::Vertex { vertex, position }) = cube.support([1.0, 1.0, 1.0]) else { panic!("a cube is bounded") };
    assert_eq!(position.to_array(), [1.0; 3]);
    assert_eq!(cube.support_from((1.0, 1.0, 1.0), vertex), cube.support([1.0, 1.0, 1.0]));
    let ray = cube.clip_ray([-1.0, 0.5, 0.5], (1.0, 0.0, 0.0)).expect("it meets the cube");
    let segment = cube.clip_segment((-1.0, 0.5, 0.5), [3.0, 0.5, 0.5]).expect("it meets the cube");
    assert_eq!((ray.from, ray.to, segment.from, segment.to), (1.0, 2.0, 0.25, 0.5));
    let InteriorPoint::Point(inside) = cube.interior_point() else { panic!("a cube is not thin") };
    assert_eq!(cube.classify(inside.to_array()), Location::Inside);
    let bounds = cube.bounding_box().expect("it is not empty");
    assert_eq!((bounds.min.to_array(), bounds.max.to_array()), ([0.0; 3], [1.0; 3]));
    let measures = cube.measures().expect("it is bounded");
    assert_eq!((measures.centroid.to_array(), measures.inertia.to_cols_array()[0]), ([0.5; 3], 1.0 / 6.0));
}

#[test]
fn meshes_are_clipped_to_arrays_and_give_arrays() {
    let (positions, faces) = IncrementalPolytope::new().to_mesh_clipped([0.0; 3], (1.0, 2.0, 3.0));
    assert_eq!((positions.len(), faces.len()), (8, 6));
    assert!(positions.into_iter().any(|p| p.to_array() == [1.0, 2.0, 3.0]));
}

#[test]
fn hulls_are_made_of_arrays_and_tuples() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let tuples: Vec<(f64, f64, f64)> = corners.map(|[x, y, z]| (x, y, z)).to_vec();
    let tetrahedron = hull(&corners).expect("it has an interior");
    assert_eq!(tetrahedron.to_mesh(), hull(&tuples).expect("it has an interior").to_mesh());
    assert_eq!(hull_triangles(&tuples).expect("it has an interior").len(), 4);
}

#[test]
fn meeting_points_give_arrays() {
    let planes = [[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 2.0], [0.0, 0.0, 2.0, 3.0]];
    let [a, b, c] = planes.map(|plane| Row::new(&HalfSpace::from_array(plane).expect("it is accepted")));
    assert_eq!(meet(&a, &b, &c).map(|point| point.to_array()), Some([1.0, 2.0, 1.5]));
}

#[cfg(feature = "mint")]
#[test]
fn vectors_and_points_of_mint_are_taken_and_given() {
    let cube = cube();
    let half_space = HalfSpace::new(mint::Vector3::from([0.0, 0.0, 1.0]), 1.0).expect("it is accepted");
    assert_eq!(half_space.to_array(), [0.0, 0.0, 1.0, 1.0]);
    assert!(cube.contains(mint::Point3::from([0.5, 0.5, 0.5])));
    let points: Vec<mint::Point3<f64>> = cube.to_mesh().0.into_iter().map(mint::Point3::from).collect();
    assert_eq!(hull(&points).expect("it has an interior").vertex_count(), 8);
}
