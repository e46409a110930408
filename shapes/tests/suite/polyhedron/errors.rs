//! Surfaces that bound no solid.

use glam::DVec3;
use planecut_check::ContactKind;
use planecut_csg::MaterialId;
use planecut_shapes::polyhedron::{PolyhedronError, PolyhedronOptions, Precision, polyhedron};

use super::judge::{Given, cube};

fn error(given: &Given) -> PolyhedronError {
    given.cells(Precision::Double).expect_err("no solid")
}

fn unit() -> Given {
    cube(DVec3::ZERO, DVec3::ONE)
}

#[test]
fn open_surfaces_name_an_edge_and_its_facet() {
    let mut given = unit();
    given.facets.remove(1);
    let PolyhedronError::Open { facet, from, to, edges } = error(&given) else { panic!("found another error") };
    assert_eq!((edges, from.z, to.z), (4, 1.0, 1.0));
    assert!(given.facets[facet].iter().any(|v| given.points[*v as usize] == from));
}

#[test]
fn facets_that_are_turned_leave_edges_open() {
    let mut given = unit();
    given.facets[3].reverse();
    assert!(matches!(error(&given), PolyhedronError::Open { .. }));
}

/// A cube one of whose facets has a corner of its own, off by that much.
fn with_a_gap(off: f64) -> Given {
    let mut given = unit();
    given.points.push(DVec3::new(1.0, 1.0, 1.0 + off));
    given.facets[1] = vec![4, 5, 8, 6];
    given
}

#[test]
fn a_gap_of_roundings_is_closed_and_counted_and_a_wider_one_is_a_gap() {
    for off in [f64::EPSILON, 1e-12, 0.99e-9] {
        let given = with_a_gap(off);
        let solid = polyhedron(&given.points, &given.facets, &[MaterialId(0)], &PolyhedronOptions::default());
        let solid = solid.expect("a solid");
        assert_eq!((solid.joined_corners, solid.volume, solid.cells.len()), (1, 1.0, 1), "{off}");
    }
    for off in [1.1e-9, 1e-6] {
        assert!(matches!(error(&with_a_gap(off)), PolyhedronError::Open { edges: 4, .. }), "{off}");
    }
    // as coordinates of single precision are 1.2e-7 apart there
    let given = with_a_gap(f64::from(f32::EPSILON));
    let single = PolyhedronOptions { precision: Precision::Single };
    let solid = polyhedron(&given.points, &given.facets, &[MaterialId(0)], &single).expect("a solid");
    assert_eq!((solid.joined_corners, solid.volume), (1, 1.0));
}

#[test]
fn surfaces_that_cross_name_both_facets_and_a_place() {
    let given = unit().and(&cube(DVec3::splat(0.5), DVec3::splat(1.75)));
    let PolyhedronError::Crossing { facets, kind, position } = error(&given) else { panic!("found another error") };
    assert_eq!(kind, ContactKind::Crossing);
    assert!(facets[0] < 6 && facets[1] >= 6, "{facets:?}");
    assert!(position.cmpge(DVec3::ZERO).all() && position.cmple(DVec3::splat(1.75)).all(), "{position}");
}

#[test]
fn the_same_surface_twice_overlaps() {
    let given = unit().and(&unit());
    let found = error(&given);
    assert!(matches!(found, PolyhedronError::Crossing { kind: ContactKind::Overlap, .. }), "{found}");
}

#[test]
fn shells_on_the_wrong_side() {
    // a cavity that is wound like a body, a body beside another that is wound like a cavity
    let small = cube(DVec3::splat(0.25), DVec3::splat(0.75));
    assert!(matches!(error(&unit().and(&small)), PolyhedronError::Inconsistent { .. }));
    let beside = small.moved(|p| p + 5.0).turned();
    assert!(matches!(error(&unit().and(&beside)), PolyhedronError::Inconsistent { .. }));
}

#[test]
fn nothing_is_enclosed() {
    let square = Given { points: unit().points, facets: vec![vec![0, 1, 3, 2], vec![2, 3, 1, 0]] };
    assert_eq!(error(&square), PolyhedronError::NoVolume);
    assert_eq!(error(&Given::default()), PolyhedronError::NoVolume);
}

#[test]
fn numbers_that_cannot_be() {
    let mut given = unit();
    given.points[3].y = f64::NAN;
    assert!(matches!(error(&given), PolyhedronError::Point { point: 3, .. }));
    given.points[3].y = 1e300;
    assert!(matches!(error(&given), PolyhedronError::Point { point: 3, .. }));
    given = unit();
    given.facets[2][1] = 8;
    assert_eq!(error(&given), PolyhedronError::UnknownPoint { facet: 2, point: 8, points: 8 });
    let two = polyhedron(&unit().points, &unit().facets, &[MaterialId(0); 2], &PolyhedronOptions::default());
    assert_eq!(two.expect_err("one for each or one for all"), PolyhedronError::Materials { found: 2, facets: 6 });
}
