//! Rays against live models: the face that they meet first is the one that each triangle, asked by itself, says.

use planecut_csg::{BrushId, FaceId, LiveModel, Material, MaterialId, Model, Operation, Role, Transform, Tree};
use planecut_kernel::DVec3;
use planecut_testkit::edited::{PLATE, PLATE_TOP, plate, turned_far_away};
use planecut_testkit::random::Rng;
use planecut_testkit::scene::{Scene, brush, cuboid, half_space};

use crate::tree::random::{Kind, bounded, random_leaf, random_shape};

/// How near to an edge, or to the origin, a ray may meet a triangle for that to be left open, as a share of the size of all.
const OPEN: f64 = 1e-8;

/// A triangle that a ray meets, or passes by no farther than what is left open.
#[derive(Debug, Clone, Copy)]
struct Meeting {
    face: FaceId,
    distance: f64,
    is_clear: bool,
}

/// By the plane of each triangle, and the sides of its edges within the plane.
fn meetings(live: &LiveModel, origin: DVec3, direction: DVec3) -> Vec<Meeting> {
    let direction = direction.normalize();
    let mut all = Vec::new();
    for (id, face) in live.faces() {
        for corners in face.triangles() {
            let corners = corners.map(|corner| corner.1);
            let size =
                corners.iter().fold(origin.abs().max_element(), |size, corner| size.max(corner.abs().max_element()));
            let open = OPEN * size;
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            let Some(normal) = normal.try_normalize() else { continue };
            let (rise, height) = (normal.dot(direction), normal.dot(corners[0] - origin));
            if rise.abs() < OPEN {
                // along the plane: only where it lies in it may it meet the triangle's edges
                if height.abs() <= 8.0 * open {
                    all.push(Meeting { face: id, distance: f64::NAN, is_clear: false });
                }
                continue;
            }
            let distance = height / rise;
            let place = origin + distance * direction;
            let within = |k: usize| {
                let along = (corners[(k + 1) % 3] - corners[k]).normalize_or_zero();
                normal.cross(along).dot(place - corners[k])
            };
            let inside = (0..3).map(within).fold(f64::INFINITY, f64::min);
            let open = open / rise.abs();
            if inside > -open && distance > -open {
                all.push(Meeting { face: id, distance, is_clear: inside > open && distance > open });
            }
        }
    }
    all
}

/// How many rays were compared, how many of them clearly meet something, and how many are left open.
#[derive(Debug, Default)]
struct Tally {
    rays: usize,
    met: usize,
    open: usize,
}

impl Tally {
    fn compare(&mut self, live: &LiveModel, origin: DVec3, direction: DVec3, case: &str) {
        let picked = live.pick(origin, direction);
        let all = meetings(live, origin, direction);
        let case = format!("{case}: from {origin:?} to {direction:?}, picked {picked:?} of {all:?}");
        let first =
            all.iter().filter(|meeting| meeting.is_clear).map(|meeting| meeting.distance).fold(f64::INFINITY, f64::min);
        let size = all.iter().fold(origin.abs().max_element() + 1.0, |size, meeting| size.max(meeting.distance.abs()));
        let near = OPEN * size;
        // what is no farther than the first that is clear
        let candidates: Vec<&Meeting> =
            all.iter().filter(|meeting| meeting.distance.is_nan() || meeting.distance <= first + near).collect();
        self.rays += 1;
        self.met += usize::from(first.is_finite());
        if candidates.iter().all(|meeting| meeting.is_clear) {
            let nearest = candidates.iter().min_by(|a, b| a.distance.total_cmp(&b.distance));
            assert_eq!(picked.map(|picked| picked.0), nearest.map(|meeting| meeting.face), "{case}");
            if let Some((_, distance)) = picked {
                assert!((distance - first).abs() < 1e-10 * size, "{case}");
            }
            return;
        }
        self.open += 1;
        match picked {
            Some((face, distance)) => {
                let is_it = |meeting: &&&Meeting| {
                    meeting.face == face && (meeting.distance.is_nan() || (meeting.distance - distance).abs() <= near)
                };
                assert!(distance >= 0.0 && candidates.iter().any(|meeting| is_it(&meeting)), "{case}");
            }
            None => assert!(first.is_infinite(), "{case}"),
        }
    }

    /// Rays of all kinds: from and to anywhere, through corners and edges, in faces, along axes, from corners, faces and the inside.
    fn sweep(&mut self, live: &LiveModel, rng: &mut Rng, rays: usize, case: &str) {
        let triangles: Vec<[DVec3; 3]> =
            live.faces().flat_map(|(_, face)| face.triangles()).map(|corners| corners.map(|c| c.1)).collect();
        if triangles.is_empty() {
            self.compare(live, rng.point(-9.0, 9.0), rng.unit(), case);
            return;
        }
        let extent =
            |farther: fn(DVec3, DVec3) -> DVec3| triangles.iter().flatten().copied().reduce(farther).expect("a corner");
        let (min, max) = (extent(DVec3::min), extent(DVec3::max));
        let size = (max - min).max_element();
        for k in 0..rays {
            let [a, b, c] = triangles[rng.below(triangles.len())];
            let anywhere = |rng: &mut Rng| min + (max - min) * rng.point(-0.5, 1.5);
            let weights = rng.point(0.1, 1.0);
            let within = (weights.x * a + weights.y * b + weights.z * c) / weights.element_sum();
            let (from, aside) = (anywhere(rng), rng.unit());
            let axis = rng.pick(&DVec3::AXES) * if rng.chance(0.5) { 1.0 } else { -1.0 };
            let (origin, direction) = match k % 12 {
                0 | 1 => (from, anywhere(rng) - from),
                2 | 3 => (from, within - from),
                4 => (from, a - from),
                5 => (from, 0.5 * (a + b) - from),
                6 => (within - 2.0 * size * axis, axis),
                7 => (a - 2.0 * size * axis, axis),
                8 => ((a + b) * 0.5 - 2.0 * size * (b - a), b - a),
                9 => (within - 2.0 * (c - a), c - a),
                10 => (rng.pick(&[a, within, 0.5 * (b + c)]), rng.pick(&[axis, aside, c - a])),
                _ => ((a.floor() + 0.5).min(max), axis),
            };
            if direction != DVec3::ZERO {
                self.compare(live, origin, direction, case);
            }
        }
    }
}

fn live_of(model: Model) -> LiveModel {
    LiveModel::from_model(model).expect("a bounded solid")
}

#[test]
fn rays_meet_what_each_triangle_says_in_trees_of_any_operations() {
    let mut tally = Tally::default();
    for (kind, count) in [(Kind::Lattice, 120), (Kind::Turned, 60), (Kind::Mixed, 60)] {
        for seed in 0..count {
            let rng = &mut Rng::spread(seed);
            let leaves = 2 + rng.below(8);
            let shape = bounded(random_shape(rng, kind, leaves), rng);
            tally.sweep(&live_of(shape.model()), rng, 60, &format!("{kind:?} {seed}"));
        }
    }
    assert!(tally.rays > 10_000 && tally.met > 4000 && tally.open < tally.rays / 2, "{tally:?}");
}

#[test]
fn rays_meet_what_each_triangle_says_after_each_edit() {
    let mut tally = Tally::default();
    for (kind, count) in [(Kind::Lattice, 30), (Kind::Turned, 20)] {
        for seed in 0..count {
            let rng = &mut Rng::spread(1000 + seed);
            let mut live = LiveModel::new(vec![Material::named("a"), Material::named("b")]);
            for step in 0..20 {
                let brushes: Vec<BrushId> = live.brushes().collect();
                let at = rng.pick(&brushes.iter().copied().chain([BrushId(0)]).collect::<Vec<_>>());
                let roles = [Role::Add, Role::Add, Role::Subtract, Role::Subtract, Role::Intersect];
                let role = roles[if rng.chance(0.05) { 4 } else { rng.below(4) }];
                let outcome = match rng.below(8) {
                    0..4 => {
                        let mut leaf = random_leaf(rng, kind);
                        let material = MaterialId(rng.below(2) as u32);
                        leaf.materials_mut().for_each(|own| *own = material);
                        live.add_brush(leaf, role).map(|added| added.1)
                    }
                    4 => live.transform_brush(at, &Transform::translation(rng.lattice(1)).expect("a shift")),
                    5 => live.set_role(at, role),
                    6 => live.remove_brush(at),
                    _ => live.undo(),
                };
                // what is refused leaves all as it was
                let _ = outcome;
                tally.sweep(&live, rng, 16, &format!("{kind:?} {seed}, edit {step}"));
            }
        }
    }
    assert!(tally.rays > 9000 && tally.met > 4000 && tally.open < tally.rays / 2, "{tally:?}");
}

#[test]
fn rays_meet_one_of_many_faces_of_one_plane_and_one_face_of_many_triangles() {
    let rng = &mut Rng::spread(5);
    let mut tally = Tally::default();
    // bars across a plate leave strips of its top
    let bars =
        (0..6).map(|k| cuboid(DVec3::new(f64::from(k) + 0.25, -1.0, 0.8), DVec3::new(f64::from(k) + 0.5, 7.0, 2.0)));
    let mut in_strips = plate(6);
    in_strips.tree = Tree::difference(std::iter::once(in_strips.tree).chain(bars.map(Tree::from)));
    for model in [plate(6), turned_far_away(&plate(6)), in_strips.clone(), turned_far_away(&in_strips)] {
        tally.sweep(&live_of(model), rng, 400, "plate");
    }
    assert!(tally.met > 800, "{tally:?}");
    let mut live = live_of(plate(6));
    let down = |live: &LiveModel| live.pick(DVec3::new(0.05, 0.05, 9.0), -DVec3::Z).expect("it meets the top");
    let (top, distance) = down(&live);
    assert_eq!((live.source_of_face(top), distance), (Some((PLATE, PLATE_TOP)), 8.0));
    live.move_plane(PLATE, PLATE_TOP, half_space(DVec3::Z, 1.5)).unwrap();
    assert_eq!(down(&live).1, 7.5);
}

#[test]
fn a_ray_begins_somewhere_and_goes_somewhere() {
    let mut live = LiveModel::new(vec![Material::named("stone")]);
    live.add_brush(cuboid(DVec3::ZERO, DVec3::splat(2.0)), Role::Add).unwrap();
    let inside = DVec3::new(0.5, 0.75, 1.0);
    let (face, distance) = live.pick(inside, DVec3::new(3e-200, 0.0, 0.0)).unwrap();
    assert_eq!((live.face(face).unwrap().normal(), distance), (DVec3::X, 1.5));
    // from the boundary: at once
    assert_eq!(live.pick(DVec3::new(0.5, 0.75, 2.0), DVec3::Z).map(|met| met.1), Some(0.0));
    for (origin, direction) in [
        (inside, DVec3::ZERO),
        (inside, DVec3::new(f64::NAN, 0.0, 1.0)),
        (inside, DVec3::new(f64::INFINITY, 0.0, 1.0)),
        (DVec3::new(f64::NEG_INFINITY, 0.0, 0.0), DVec3::X),
        (DVec3::splat(3.0), DVec3::ONE),
    ] {
        assert_eq!(live.pick(origin, direction), None, "{origin} {direction}");
    }
}

#[test]
fn what_is_far_off_takes_part_in_what_a_ray_meets() {
    // a half-space that is cut off by an intersecting brush, which rays outside of it miss
    let ground = brush([half_space(DVec3::Z, 0.0)]);
    let window = cuboid(DVec3::new(0.0, 0.0, -4.0), DVec3::new(2.0, 2.0, 4.0));
    let tower = cuboid(DVec3::new(5.0, 0.0, 0.0), DVec3::new(6.0, 1.0, 3.0));
    let mut live = LiveModel::new(vec![Material::named("stone")]);
    live.add_brushes(vec![(ground, Role::Add), (window, Role::Intersect), (tower, Role::Add)]).unwrap();
    let down = |x: f64| live.pick(DVec3::new(x, 0.5, 9.0), -DVec3::Z).map(|met| met.1);
    assert_eq!([down(0.5), down(3.5), down(5.5)], [Some(9.0), None, Some(6.0)]);
    let mut tally = Tally::default();
    tally.sweep(&live, &mut Rng::spread(8), 300, "ground");
    assert!(tally.met > 100, "{tally:?}");
}

#[test]
fn rays_follow_closed_meshes_from_edit_to_edit() {
    let rng = &mut Rng::spread(21);
    let mesh = planecut_testkit::meshes::box_mesh(DVec3::splat(-1.0), DVec3::splat(3.0), "stone");
    let closed = planecut_csg::ClosedMesh::new(&mesh.positions, &mesh.triangles, |_| 0).expect("a box is closed");
    let body = planecut_csg::Brush::of_mesh(planecut_csg::MeshBody::new(closed, vec![MaterialId(0)]));
    let mut live = live_of(plate(3));
    let (id, _) = live.add_brush(body, Role::Add).unwrap();
    let mut tally = Tally::default();
    for _ in 0..4 {
        tally.sweep(&live, rng, 60, "a mesh in a plate");
        live.transform_brush(id, &Transform::translation([0.25, 0.0, -0.125]).expect("a shift")).unwrap();
    }
    live.remove_brush(id).unwrap();
    tally.sweep(&live, rng, 60, "without the mesh");
    assert!(tally.met > 100, "{tally:?}");
}

#[test]
fn planes_that_all_brushes_share_are_told_apart_by_what_is_solid() {
    // a chessboard of boxes: each ray along an axis goes through the walls between them
    let boxes = (0..64_u32).filter(|k| (k % 4 + k / 4 % 4 + k / 16) % 2 == 0).map(|k| {
        let low = DVec3::new(f64::from(k % 4), f64::from(k / 4 % 4), f64::from(k / 16));
        Tree::from(cuboid(low, low + 1.0))
    });
    let model = Model { materials: vec![Material::named("stone")], tree: Tree::combine(Operation::Union, boxes) };
    let mut tally = Tally::default();
    tally.sweep(&live_of(model), &mut Rng::spread(3), 600, "chessboard");
    assert!(tally.met > 200, "{tally:?}");
}
