//! Planes that are dragged: by so little that nothing but places changes, through other bodies, and in faces of many corners, whose triangulations change with
//! them.

use std::f64::consts::TAU;

use planecut_csg::{BrushId, LiveModel, Model, Role, evaluate};
use planecut_kernel::{DVec3, HalfSpace, PlaneIdx};
use planecut_testkit::edited::{HOLE_END, PLATE, PLATE_SIDE, PLATE_TOP, plate, turned_far_away};
use planecut_testkit::random::Rng;

use super::edits::{Edit, Faces, Plane, Planes, Tally, Viewer, check, triangles_of};

/// Drags a plane there and back, by small steps and by jumps, with other edits in between; after each the model is that of a fresh
/// build, faces and all. Gives how many faces changed in all.
fn drag(model: &Model, brush: BrushId, plane: PlaneIdx, reach: f64) -> usize {
    let mut live = LiveModel::from_model(model.clone()).expect("bounded");
    let mut viewer = Viewer::default();
    live.faces().for_each(|(id, face)| viewer.add(id, face));
    let place =
        live.planes(brush).expect("it is there").iter().position(|other| *other == plane).expect("one of its planes");
    let start = live.brush(brush).expect("it is there").0.faces[place].half_space;
    let mut changed = 0;
    for step in 0..24_u32 {
        let share = if step % 6 == 5 { f64::from(step * 7 % 13) / 13.0 } else { (f64::from(step) * 0.09).sin() };
        let offset = start.offset() + share * reach * start.normal().length();
        let last = live.brushes().last().expect("there are brushes");
        let change = match step % 8 {
            3 => live.undo().expect("there was an edit"),
            6 => live.remove_brush(last).expect("it is there"),
            7 => live.undo().expect("there was an edit"),
            _ => {
                let to = HalfSpace::new(start.normal(), offset).expect("a valid plane");
                live.move_plane(brush, plane, to).expect("bounded")
            }
        };
        changed += change.added.len();
        viewer.follow(&live, &change).expect("what is removed was there");
        let fresh = evaluate(&live.to_model()).expect("bounded").mesh;
        assert!(live.mesh().as_ref() == Ok(&fresh), "step {step}: the mesh is not that of a fresh build");
        assert!(viewer.is_closed(&live), "step {step}: the faces are not closed");
        assert!(viewer.triangles() == triangles_of(&fresh), "step {step}: the faces have other triangles");
    }
    changed
}

#[test]
fn a_plate_of_many_holes_is_dragged_by_its_side_its_top_and_the_end_of_a_hole() {
    let flat = plate(4);
    for model in [&flat, &turned_far_away(&flat)] {
        // without touching a hole, and into the holes
        drag(model, PLATE, PLATE_SIDE, 0.15);
        drag(model, PLATE, PLATE_SIDE, -0.5);
        assert!(drag(model, PLATE, PLATE_TOP, 0.3) > 10 * 16 * 24, "all sides of all holes change");
        drag(model, PLATE, PLATE_TOP, -0.8);
        drag(model, BrushId(6), HOLE_END, 0.3);
        drag(model, BrushId(6), PlaneIdx(3), 0.25);
    }
}

/// A prism around a place, along z, by its number of sides.
fn prism(sides: u32, [x, y]: [f64; 2], radius: f64, [low, high]: [f64; 2]) -> Planes {
    let side = |k: u32| {
        let (sine, cosine) = (TAU * f64::from(k) / f64::from(sides)).sin_cos();
        let normal = DVec3::new(cosine, sine, 0.0);
        (normal.to_array(), normal.dot(DVec3::new(x, y, 0.0)) + radius)
    };
    (0..sides).map(side).chain([([0.0, 0.0, 1.0], high), ([0.0, 0.0, -1.0], -low)]).collect()
}

pub(super) fn cuboid(low: [f64; 3], high: [f64; 3]) -> Planes {
    let sides = |axis: usize| -> [Plane; 2] {
        let normal = |sign: f64| [0, 1, 2].map(|k| if k == axis { sign } else { 0.0 });
        [(normal(1.0), high[axis]), (normal(-1.0), -low[axis])]
    };
    (0..3).flat_map(sides).collect()
}

/// Edits of a plate in which holes come and go, and slots that part it, rings of slots that leave islands, bosses on it; planes are moved on by little.
fn edits_of_a_plate(random: &mut Rng, length: usize) -> Vec<Edit> {
    let mut edits = vec![Edit::Add(cuboid([0.0; 3], [8.0, 8.0, 1.0]), 0, Role::Add)];
    for k in 0..12 {
        edits.push(Edit::Add(
            prism(24, [1.0 + f64::from(k % 4) * 2.0, 1.0 + f64::from(k / 4) * 2.0], 0.5, [-1.0, 2.0]),
            0,
            Role::Subtract,
        ));
    }
    for _ in 0..length {
        let place = [0.5 * random.whole(0, 16), 0.5 * random.whole(0, 16)];
        let (at, plane) = (random.below(1000), random.below(1000));
        let [x, y] = place;
        match random.below(20) {
            0..3 => {
                let sides = [8, 24, 40][random.below(3)];
                let radius = [0.25, 0.5, 0.75][random.below(3)];
                edits.push(Edit::Add(prism(sides, place, radius, [random.whole(-1, 0) + 0.5, 2.0]), 0, Role::Subtract));
            }
            3 => edits.push(Edit::Add(cuboid([x, -1.0, -1.0], [x + 0.25, 9.0, 2.0]), 0, Role::Subtract)),
            4 => {
                // a ring: what is within it is a face of its own
                let (low, high) = (1.0, 1.25);
                for [from, to] in [
                    [[-high, -high], [high, -low]],
                    [[-high, low], [high, high]],
                    [[-high, -low], [-low, low]],
                    [[low, -low], [high, low]],
                ] {
                    edits.push(Edit::Add(
                        cuboid([x + from[0], y + from[1], 0.5], [x + to[0], y + to[1], 2.0]),
                        1,
                        Role::Subtract,
                    ));
                }
            }
            5 => edits.push(Edit::Add(prism(24, place, 0.75, [0.5, 1.5]), 1, Role::Add)),
            6..8 => edits.push(Edit::Remove(1 + at)),
            8..16 => {
                let by = [0.0625, -0.0625, 0.001, -0.25, 0.5][random.below(5)];
                // the plate one time in three
                edits.push(Edit::Nudge(if random.chance(0.3) { 0 } else { at }, plane, by));
            }
            16 => edits.push(Edit::SetRole(at, if random.chance(0.5) { Role::Add } else { Role::Subtract })),
            17 => edits.push(Edit::Redo),
            _ => edits.push(Edit::Undo),
        }
    }
    edits
}

#[test]
fn random_edits_of_a_plate_whose_faces_have_many_corners() {
    let seeds = planecut_testkit::scene::scaled(6);
    let sequence = |seed| edits_of_a_plate(&mut Rng::spread(seed), 40);
    let tally: Tally = (0..seeds).map(|seed| check(seed, &sequence(seed), Faces::Same)).sum();
    assert!(tally.equal * 10 > tally.compared * 9 && tally.triangles > 1000 * tally.compared, "{tally:?}");
}

#[test]
fn planes_of_turned_bodies_are_moved_on_by_little() {
    let seeds = planecut_testkit::scene::scaled(12);
    let sequence = |seed| {
        let mut random = Rng::spread(seed);
        let mut edits: Vec<Edit> = Vec::new();
        for k in 0..80 {
            let (at, plane) = (random.below(1000), random.below(1000));
            edits.push(match random.below(10) {
                _ if k < 12 => {
                    let role = if random.chance(0.6) { Role::Add } else { Role::Subtract };
                    Edit::Add(super::random::turned(&mut random), random.below(2) as u32, role)
                }
                0 => Edit::Undo,
                1 => Edit::Remove(at),
                2 => Edit::Add(super::random::turned(&mut random), 0, Role::Subtract),
                _ => Edit::Nudge(at, plane, [1e-3, -1e-3, 0.02, -0.02, 0.2][random.below(5)]),
            });
        }
        edits
    };
    let tally: Tally = (0..seeds).map(|seed| check(seed, &sequence(seed), Faces::Same)).sum();
    assert!(tally.equal * 10 > tally.compared * 9 && tally.triangles > 60 * tally.compared, "{tally:?}");
}
