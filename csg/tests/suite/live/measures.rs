//! Measures of live models: against inclusion and exclusion, against triangles, and bit for bit against new models.

use planecut_csg::{BrushId, LiveModel, Material, MaterialId, Model, Role, SolidMeasures, Transform, Tree, evaluate};
use planecut_kernel::DVec3;
use planecut_testkit::edited::{HOLE_END, PLATE, PLATE_SIDE, PLATE_TOP, plate, turned_far_away};
use planecut_testkit::random::Rng;
use planecut_testkit::scene::{Scene, cuboid, half_space};

use crate::tree::random::{Kind, bounded, random_leaf, random_shape};
use crate::tree::volume::check_volume;

fn live_of(model: Model) -> LiveModel {
    LiveModel::from_model(model).expect("a bounded solid")
}

/// All measures as bits.
fn bits(live: &mut LiveModel) -> Vec<u64> {
    let SolidMeasures { volume, area, centroid, min, max } = live.measures();
    let vectors = [centroid, min, max].into_iter().flat_map(|v| v.to_array());
    let areas = live.areas_of_materials();
    [volume, area].into_iter().chain(vectors).chain(areas).map(|v| (v + 0.0).to_bits()).collect()
}

/// Measures by the triangles of the faces, around the middle of all.
fn of_triangles(live: &LiveModel) -> (SolidMeasures, Vec<f64>) {
    let mut areas = vec![0.0; live.materials().len()];
    let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let corners = || {
        live.faces().flat_map(|(_, face)| face.triangles().map(move |corners| (face.material(), corners.map(|c| c.1))))
    };
    for at in corners().flat_map(|(_, corners)| corners) {
        (min, max) = (min.min(at), max.max(at));
    }
    if !min.is_finite() {
        return (SolidMeasures::default(), areas);
    }
    let middle = 0.5 * (min + max);
    let (mut volume, mut moment) = (0.0, DVec3::ZERO);
    for (material, corners) in corners() {
        let [a, b, c] = corners.map(|at| at - middle);
        let pyramid = a.dot(b.cross(c)) / 6.0;
        volume += pyramid;
        moment += pyramid * (a + b + c) / 4.0;
        areas[material.0 as usize] += 0.5 * (b - a).cross(c - a).length();
    }
    let centroid = middle + moment / volume;
    (SolidMeasures { volume, area: areas.iter().sum(), centroid, min, max }, areas)
}

fn check_by_triangles(live: &mut LiveModel, case: &str) {
    let (expected, areas) = of_triangles(live);
    let found = live.measures();
    let size = (expected.max - expected.min).length();
    let far = expected.max.abs().max(expected.min.abs()).max_element() * f64::EPSILON;
    let near = |found: f64, expected: f64, room: f64| (found - expected).abs() <= room;
    assert_eq!((found.min, found.max), (expected.min, expected.max), "{case}");
    let room = (1e-13 * size + 64.0 * far) * expected.area;
    assert!(near(found.volume, expected.volume, room), "{case}: volume {} of {}", found.volume, expected.volume);
    assert!(near(found.area, expected.area, 1e-12 * expected.area + 64.0 * far * size), "{case}: area");
    let room = (room * size) / expected.volume.max(f64::MIN_POSITIVE) + far;
    assert!(
        (found.centroid - expected.centroid).length() <= room,
        "{case}: {} of {}",
        found.centroid,
        expected.centroid
    );
    for (found, expected) in live.areas_of_materials().into_iter().zip(areas) {
        assert!(near(found, expected, 1e-12 * expected + 64.0 * far * size), "{case}: {found} of {expected}");
    }
}

#[test]
fn volumes_of_trees_are_sums_over_intersections() {
    for (kind, count) in [(Kind::Lattice, 150), (Kind::Turned, 80), (Kind::Mixed, 80)] {
        for seed in 0..count {
            let rng = &mut Rng::spread(seed);
            let leaves = 2 + rng.below(5);
            let shape = bounded(random_shape(rng, kind, leaves), rng);
            let case = format!("{kind:?} {seed}");
            let mut evaluation = evaluate(&shape.model()).expect("a bounded solid");
            let mut live = live_of(shape.model());
            evaluation.solid = live.measures();
            check_volume(&shape, &evaluation).unwrap_or_else(|text| panic!("{case}: {text}"));
            check_by_triangles(&mut live, &case);
        }
    }
}

#[test]
fn after_any_edits_measures_are_bit_for_bit_those_of_a_new_model() {
    let (mut compared, mut volumes) = (0, 0.0);
    for (kind, count) in [(Kind::Lattice, 40), (Kind::Turned, 25), (Kind::Mixed, 25)] {
        for seed in 0..count {
            let rng = &mut Rng::spread(500 + seed);
            let mut live = LiveModel::new(vec![Material::named("a"), Material::named("b")]);
            for step in 0..40 {
                let brushes: Vec<BrushId> = live.brushes().chain([BrushId(0)]).collect();
                let at = rng.pick(&brushes);
                let role = rng.pick(&[Role::Add, Role::Add, Role::Subtract]);
                let outcome = match rng.below(10) {
                    0..4 => {
                        let mut leaf = random_leaf(rng, kind);
                        leaf.materials_mut().for_each(|own| *own = MaterialId(rng.below(2) as u32));
                        live.add_brush(leaf, role).map(|added| added.1)
                    }
                    4 => live.transform_brush(at, &Transform::translation(rng.lattice(1)).expect("a shift")),
                    5 => live.set_role(at, role),
                    6 => live.remove_brush(at),
                    7 | 8 => live.undo(),
                    _ => live.redo(),
                };
                // what is refused leaves all as it was; not after each edit is anything asked
                if outcome.is_err() || rng.chance(0.4) {
                    continue;
                }
                let case = format!("{kind:?} {seed}, edit {step}");
                let mut fresh = live_of(live.to_model());
                assert_eq!(bits(&mut live), bits(&mut fresh), "{case}");
                check_by_triangles(&mut live, &case);
                compared += 1;
                volumes += live.measures().volume;
            }
        }
    }
    assert!(compared > 1000 && volumes > 1000.0, "{compared} {volumes}");
}

#[test]
fn a_plate_that_is_dragged_and_comes_back_has_the_measures_that_it_had() {
    for model in [plate(4), turned_far_away(&plate(4))] {
        let mut live = live_of(model.clone());
        let planes = [(PLATE, PLATE_SIDE), (PLATE, PLATE_TOP), (BrushId(7), HOLE_END)];
        let start = bits(&mut live);
        for (brush, plane) in planes {
            let place = live.planes(brush).unwrap().iter().position(|other| *other == plane).unwrap();
            let before = live.brush(brush).unwrap().0.faces[place].half_space;
            for step in 1..20 {
                let by = 0.1 * f64::from(step).sin();
                live.move_plane(brush, plane, half_space(before.normal(), before.offset() + by)).unwrap();
                if step % 3 == 0 {
                    assert_eq!(bits(&mut live), bits(&mut live_of(live.to_model())));
                }
            }
            check_by_triangles(&mut live, "dragged");
            live.move_plane(brush, plane, before).unwrap();
            assert_eq!(bits(&mut live), start);
        }
        // a plate minus prisms of 24 sides
        let prism = 12.0 * 0.09 * 2.0 * (std::f64::consts::PI / 24.0).tan() * 0.6;
        let volume = 16.0 - 16.0 * prism;
        assert!((live.measures().volume - volume).abs() < 1e-10, "{} of {volume}", live.measures().volume);
    }
}

#[test]
fn a_small_solid_far_from_the_origin_is_measured_as_well_as_its_vertices_say() {
    let (low, size) = (DVec3::new(3e9, -5e8, 7e7), DVec3::new(0.5, 0.25, 0.125));
    let mut live = LiveModel::new(vec![Material::named("stone")]);
    live.add_brush(cuboid(low, low + size), Role::Add).unwrap();
    let found = live.measures();
    assert_eq!((found.volume, found.area), (1.0 / 64.0, 2.0 * (0.125 + 0.0625 + 0.03125)));
    assert_eq!((found.centroid, found.min, found.max), (low + 0.5 * size, low, low + size));
}

#[test]
fn nothing_and_closed_meshes_have_measures_too() {
    let mut live = LiveModel::new(vec![Material::named("stone"), Material::named("brass")]);
    assert_eq!((live.measures(), live.areas_of_materials()), (SolidMeasures::default(), vec![0.0, 0.0]));
    let mesh = planecut_testkit::meshes::box_mesh(DVec3::splat(-1.0), DVec3::splat(1.0), "brass");
    let closed = planecut_csg::ClosedMesh::new(&mesh.positions, &mesh.triangles, |_| 0).expect("a box is closed");
    let body = planecut_csg::Brush::of_mesh(planecut_csg::MeshBody::new(closed, vec![MaterialId(1)]));
    let (id, _) = live.add_brush(body, Role::Add).unwrap();
    assert_eq!((live.measures().volume, live.areas_of_materials()), (8.0, vec![0.0, 24.0]));
    live.add_brush(cuboid(DVec3::ZERO, DVec3::splat(2.0)), Role::Add).unwrap();
    assert_eq!((live.measures().volume, live.areas_of_materials()), (15.0, vec![21.0, 21.0]));
    live.transform_brush(id, &Transform::translation([9.0, 0.0, 0.0]).unwrap()).unwrap();
    assert_eq!((live.measures().volume, live.measures().max.x), (16.0, 10.0));
    live.remove_brush(id).unwrap();
    assert_eq!((live.measures().volume, live.areas_of_materials()), (8.0, vec![24.0, 0.0]));
    live.undo().unwrap();
    assert_eq!(live.measures().volume, 16.0);
}

#[test]
fn faces_that_cross_in_a_line_bound_what_they_bound() {
    // three half-spaces through a line, of which an odd number holds, in a box
    let normals = [DVec3::X, DVec3::Y, DVec3::new(1.0, 1.0, 0.0)];
    let odd = Tree::xor(normals.map(|normal| Tree::from(planecut_testkit::scene::brush([half_space(normal, 0.0)]))));
    let tree = odd & cuboid(DVec3::splat(-1.0), DVec3::splat(1.0)).into();
    let mut live = live_of(Model { materials: vec![Material::named("stone")], tree });
    assert!(!live.has_faces());
    assert_eq!(live.measures().volume, evaluate(&live.to_model()).unwrap().solid.volume);
}
