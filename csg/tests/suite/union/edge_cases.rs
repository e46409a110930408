//! What is easily forgotten: nothing, too little, too much, and bodies that only touch.

use glam::DVec3;
use planecut_check::check_topology;
use planecut_csg::{Brush, Evaluation, Model, UnboundedBrushes, contract_short_edges, evaluate_with, summarize};
use planecut_kernel::IncrementalPolytope;

use super::invariance::same;
use super::measure::{check_membership, check_volume};
use planecut_testkit::generate::{ball, turned_box};
use planecut_testkit::random::Rng;
use planecut_testkit::scene::{brush, cuboid, half_space, model};
use planecut_testkit::soundness::evaluate_soundly;

fn sound(model: &Model) -> Evaluation {
    let evaluation = evaluate_soundly(model).expect("a sound mesh");
    assert_eq!(summarize(model), evaluation.model);
    evaluation
}

fn unit_cube(x: f64, y: f64, z: f64) -> Brush {
    let at = DVec3::new(x, y, z);
    cuboid(at, at + 1.0)
}

fn with_planes(mut base: Brush, planes: impl IntoIterator<Item = (DVec3, f64)>) -> Brush {
    base.faces.extend(brush(planes.into_iter().map(|(n, d)| half_space(n, d))).faces);
    base
}

/// Surfaces and handles of a mesh.
fn components_and_genus(evaluation: &Evaluation) -> (usize, Option<i64>) {
    let report = check_topology(&evaluation.mesh.positions, &evaluation.mesh.triangles);
    (report.components, report.genus)
}

#[test]
fn nothing_gives_nothing() {
    for model in [Model::default(), model(vec![]), model(vec![Brush::default()])] {
        let evaluation = evaluate_with(&model, UnboundedBrushes::LeaveOut).expect("an empty mesh");
        assert!(evaluation.mesh.triangles.is_empty() && evaluation.mesh.positions.is_empty());
        assert_eq!(evaluation.solid, Default::default());
        // without planes a brush is all of space
        assert_eq!(evaluation.model.unbounded.len(), model.tree.brushes().len());
    }
}

#[test]
fn empty_and_unbounded_brushes_are_counted_and_left_out() {
    let cube = unit_cube(0.0, 0.0, 0.0);
    let contradiction = with_planes(cube.clone(), [(DVec3::X, -1.0)]);
    let flat = with_planes(cube.clone(), [(DVec3::X, 0.0)]);
    let wedge = with_planes(Brush::default(), [(DVec3::X, 2.0), (DVec3::Y, 2.0)]);
    let mut tube = cube.clone();
    tube.faces.truncate(4);
    let all = model(vec![wedge, cube.clone(), contradiction, flat, tube]);
    let evaluation = sound(&all);
    assert_eq!((&evaluation.model.empty[..], &evaluation.model.unbounded[..]), (&[2, 3][..], &[0, 4][..]));
    assert_eq!(evaluation.model.brushes, 5);
    same(&evaluation, &sound(&model(vec![cube])), "the cube alone").unwrap();
}

#[test]
fn redundant_planes_are_counted_and_change_nothing() {
    let cube = unit_cube(0.0, 0.0, 0.0);
    let more = [
        (DVec3::X, 1.0),                     // again
        (DVec3::new(3.0, 0.0, 0.0), 3.0),    // again, at another scale
        (DVec3::X, 5.0),                     // far outside
        (DVec3::new(1.0, 1.0, 0.0), 2.0),    // through an edge
        (DVec3::ONE, 3.0),                   // through a corner
        (DVec3::new(-1.0, -2.0, -3.0), 0.0), // through the opposite one
    ];
    for first in [false, true] {
        let mut padded = with_planes(cube.clone(), more);
        if first {
            padded.faces.rotate_left(cube.faces.len());
        }
        let evaluation = sound(&model(vec![padded]));
        assert_eq!(evaluation.model.redundant_planes, more.len());
        same(&evaluation, &sound(&model(vec![cube.clone()])), "the cube alone").unwrap();
    }
}

#[test]
fn a_single_body_is_its_own_boundary() {
    for planes in [4, 7, 50, 200] {
        let body = ball(&mut Rng::spread(planes as u64), DVec3::new(0.3, -2.0, 1.0), 1.5, planes);
        let mut polytope = IncrementalPolytope::with_epsilon(0.0);
        for face in &body.faces {
            polytope.add_plane(face.half_space);
        }
        let evaluation = sound(&model(vec![body]));
        assert_eq!(evaluation.mesh.faces.len(), polytope.faces().len());
        assert_eq!(evaluation.mesh.positions.len(), polytope.vertex_count());
        assert_eq!(components_and_genus(&evaluation), (1, Some(0)));
        let measures = polytope.measures().expect("a ball is bounded");
        assert!((evaluation.solid.volume - measures.volume).abs() < 1e-12 * measures.volume);
        assert!((evaluation.solid.area - measures.area).abs() < 1e-12 * measures.area);
        assert!(evaluation.solid.centroid.distance(measures.centroid) < 1e-12);
    }
}

#[test]
fn bodies_of_many_faces_meet() {
    let mut rng = Rng::spread(5);
    let balls = (0..4).map(|k| ball(&mut rng, DVec3::new(f64::from(k) * 0.7, 0.1, 0.0), 1.0, 200)).collect();
    let model = model(balls);
    let evaluation = sound(&model);
    check_volume(&model, &evaluation).unwrap();
    check_membership(&model, &evaluation, 300).unwrap();
    assert_eq!(components_and_genus(&evaluation), (1, Some(0)));
}

/// Boxes turned about a corner of their own, which is the same point for all.
#[test]
fn many_boxes_through_one_point() {
    for at in [DVec3::ZERO, DVec3::new(0.1, 0.2, -0.3)] {
        let mut rng = Rng::spread(11);
        let through = |rng: &mut Rng| {
            let rotation = rng.rotation();
            let planes = DVec3::AXES.into_iter().flat_map(|axis| {
                let normal = rotation * axis;
                let foot = normal.dot(at);
                [half_space(-normal, -foot), half_space(normal, foot + 1.0)]
            });
            brush(planes)
        };
        let model = model((0..60).map(|_| through(&mut rng)).collect());
        let evaluation = sound(&model);
        check_membership(&model, &evaluation, 40).unwrap();
    }
}

/// Integer slopes that share a line: wedges between half-planes of a pencil.
#[test]
fn many_boxes_through_one_edge() {
    let mut rng = Rng::spread(13);
    let wedge = |rng: &mut Rng| {
        let normal = loop {
            let n = rng.point(-9.0, 9.0).round();
            if n.x != 0.0 || n.y != 0.0 {
                break DVec3::new(n.x, n.y, 0.0);
            }
        };
        let across = DVec3::new(-normal.y, normal.x, 0.0);
        let low = rng.whole(-3, 3);
        let ends = [(DVec3::Z, low + rng.whole(1, 3)), (-DVec3::Z, -low)];
        let reach = normal.length_squared() * rng.whole(1, 3);
        let sides = [(-normal, 0.0), (-across, 0.0), (normal, reach), (across, reach)];
        with_planes(Brush::default(), sides.into_iter().chain(ends))
    };
    for count in [5, 50, 500] {
        let model = model((0..count).map(|_| wedge(&mut rng)).collect());
        let evaluation = sound(&model);
        check_membership(&model, &evaluation, 100).unwrap();
        if count == 5 {
            check_volume(&model, &evaluation).unwrap();
        }
    }
}

#[test]
fn bodies_that_touch_in_an_edge_or_a_point_stay_apart() {
    let cube = || unit_cube(0.0, 0.0, 0.0);
    let one = sound(&model(vec![cube()]));
    let tip = brush([
        half_space(-DVec3::ONE, -3.0),
        half_space(DVec3::X, 2.0),
        half_space(DVec3::Y, 2.0),
        half_space(DVec3::Z, 2.0),
    ]);
    let touching = [
        unit_cube(1.0, 1.0, 0.0), // a whole edge
        unit_cube(1.0, 1.0, 0.5), // half an edge
        unit_cube(1.0, 1.0, 1.0), // a corner
        unit_cube(1.0, 1.0, 2.0), // nothing
        tip,                      // a corner on a face
    ];
    for other in touching {
        let alone = sound(&model(vec![other.clone()]));
        let both = sound(&model(vec![cube(), other]));
        assert_eq!(components_and_genus(&both), (2, Some(0)));
        assert_eq!(both.mesh.faces.len(), one.mesh.faces.len() + alone.mesh.faces.len());
        assert!((both.solid.volume - one.solid.volume - alone.solid.volume).abs() < 1e-14);
        assert!((both.solid.area - one.solid.area - alone.solid.area).abs() < 1e-13);
    }
}

/// Even cells of a lattice: every inner edge has four faces, every inner corner is pinched.
#[test]
fn a_checkerboard_of_cubes_stays_apart() {
    for size in [2, 4, 6] {
        let cells = (0..size * size * size).map(|k| [k % size, k / size % size, k / size / size]);
        let even: Vec<Brush> = cells
            .filter(|[x, y, z]| (x + y + z) % 2 == 0)
            .map(|[x, y, z]| unit_cube(x.into(), y.into(), z.into()))
            .collect();
        let count = even.len();
        let one = sound(&model(even[..1].to_vec()));
        let all = sound(&model(even));
        assert_eq!(components_and_genus(&all), (count, Some(0)));
        assert_eq!(all.mesh.faces.len(), count * one.mesh.faces.len());
        assert_eq!(all.solid.volume, count as f64 * one.solid.volume);
        assert_eq!(all.solid.area, count as f64 * one.solid.area);
    }
}

#[test]
fn a_frame_has_a_handle_and_a_shell_has_an_inside() {
    let bar = |low: [f64; 3], high: [f64; 3]| cuboid(DVec3::from_array(low), DVec3::from_array(high));
    let frame = vec![
        bar([0.0, 0.0, 0.0], [3.0, 1.0, 1.0]),
        bar([0.0, 2.0, 0.0], [3.0, 3.0, 1.0]),
        bar([0.0, 0.0, 0.0], [1.0, 3.0, 1.0]),
        bar([2.0, 0.0, 0.0], [3.0, 3.0, 1.0]),
    ];
    let mut shell = frame.clone();
    let open = sound(&model(frame));
    assert_eq!(components_and_genus(&open), (1, Some(1)));
    assert_eq!(open.mesh.faces.len(), 10);
    shell.extend([bar([0.0, 0.0, 1.0], [3.0, 3.0, 2.0]), bar([0.0, 0.0, -1.0], [3.0, 3.0, 0.0])]);
    let closed = sound(&model(shell));
    assert_eq!(components_and_genus(&closed), (2, Some(0)));
    assert_eq!(closed.mesh.faces.len(), 12);
    assert_eq!(closed.solid.volume, 26.0);
}

#[test]
fn a_crowd_of_turned_boxes_is_sound() {
    let mut rng = Rng::spread(17);
    let boxes = (0..500).map(|_| {
        let (at, half) = (rng.point(-2.0, 2.0), rng.point(0.1, 0.6));
        turned_box(&mut rng, at, half)
    });
    let model = model(boxes.collect());
    let evaluation = sound(&model);
    check_membership(&model, &evaluation, 40).unwrap();
}

/// Unions of bodies with many corners, contracted by lengths up to their own size, whatever they look like then.
#[test]
fn contraction_keeps_meshes_closed() {
    for seed in 0..200 {
        let mut rng = Rng::new(seed);
        let bodies = (0..4).map(|_| {
            let at = rng.point(-1.0, 1.0);
            let planes = 6 + rng.below(30);
            ball(&mut rng, at, 1.0, planes)
        });
        let mut mesh = sound(&model(bodies.collect())).mesh;
        let length = rng.float(0.0, 0.5);
        let contracted = contract_short_edges(&mut mesh, length);
        let topology = check_topology(&mesh.positions, &mesh.triangles);
        assert!(topology.watertight && topology.manifold, "seed {seed}, length {length}: {contracted} edges");
    }
}
