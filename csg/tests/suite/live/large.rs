//! Random edits of brushes of many planes, whose polytopes are kept: planes that are equal, redundant, hide others and reveal
//! them, empty a brush or leave it unbounded.
//!
//! `PLANECUT_SCENES` multiplies the number of sequences, for long runs.

use planecut_csg::Role;
use planecut_kernel::DVec3;

use super::edits::{Edit, Faces, Plane, Planes, Tally, check, run};
use super::random::any_plane;
use planecut_testkit::random::Rng;
use planecut_testkit::scene::scaled;

/// A plane of small integers: many pass through the same points, and some are equal.
fn lattice_plane(random: &mut Rng) -> Plane {
    loop {
        let normal = [0; 3].map(|_| random.whole(-2, 2));
        if normal != [0.0; 3] {
            // most of them near a ball
            let length = normal.iter().map(|n: &f64| n * n).sum::<f64>().sqrt();
            let offset = (3.0 * length).round() + random.whole(-1, 1);
            return (normal, if random.chance(0.1) { offset + 3.0 } else { offset });
        }
    }
}

/// Up to 150 planes of small integers, most of them without a face.
fn lattice(random: &mut Rng) -> Planes {
    let mut planes: Planes = [0, 1, 2]
        .iter()
        .flat_map(|axis| {
            [1.0, -1.0].map(|sign| {
                let mut normal = [0.0; 3];
                normal[*axis] = sign;
                (normal, random.whole(2, 4))
            })
        })
        .collect();
    let count = random.integer(10, 144);
    planes.extend((0..count).map(|_| lattice_plane(random)));
    planes
}

/// The same without an upper end, one time in two.
fn open(random: &mut Rng) -> Planes {
    let is_open = random.chance(0.5);
    let below = |([x, y, z], offset): Plane| ([x, y, if is_open { -z.abs() } else { z }], offset);
    lattice(random).into_iter().map(below).filter(|plane| plane.0 != [0.0; 3]).collect()
}

/// Hundreds of planes around a ball.
fn ball(random: &mut Rng) -> Planes {
    let center = random.point(0.0, 1.5);
    let count = random.integer(100, 700);
    let tangent = |_| {
        let normal = random.unit();
        (normal.to_array(), normal.dot(center) + random.float(0.95, 1.0))
    };
    (0..count).map(tangent).collect()
}

/// Pyramids and prisms over polygons of many sides: all sides pass through one point, or none meet above.
fn over_polygon(random: &mut Rng) -> Planes {
    let count = random.integer(20, 200) as i32;
    let slope = random.pick(&[0.0, 1.0, 2.0]);
    let side = |k: i32| {
        let (sine, cosine) = (f64::from(k) * std::f64::consts::TAU / f64::from(count)).sin_cos();
        // the same offset for all, exactly: the apex is a point of all of them
        ([(cosine * 1024.0).round(), (sine * 1024.0).round(), 1024.0 * slope], 2048.0)
    };
    let ends = [([0.0, 0.0, -1.0], random.whole(0, 1)), ([0.0, 0.0, 1.0], random.whole(1, 3))];
    (0..count).map(side).chain(ends).collect()
}

/// A plane that leaves nothing of most brushes, or little.
fn emptying(random: &mut Rng) -> Plane {
    let normal = random.pick(&[DVec3::X, DVec3::NEG_Y, DVec3::new(1.0, 2.0, -1.0)]);
    (normal.to_array(), -6.0 + 3.0 * random.whole(0, 2))
}

fn sequence(
    random: &mut Rng,
    length: usize,
    first: fn(&mut Rng) -> Planes,
    shape: fn(&mut Rng) -> Planes,
) -> Vec<Edit> {
    let brushes = 1 + random.below(3);
    let mut edits: Vec<Edit> = vec![Edit::Add(first(random), 0, Role::Add)];
    for _ in 1..brushes {
        let role = random.pick(&[Role::Add, Role::Subtract, Role::Subtract, Role::Intersect]);
        edits.push(Edit::Add(shape(random), random.below(2) as u32, role));
    }
    let copied = edits[random.below(brushes)].clone();
    if let Edit::Add(planes, material, _) = copied
        && random.chance(0.3)
    {
        edits.push(Edit::Add(planes, material, Role::Add));
    }
    let edit = |_| {
        let (at, plane) = (random.below(1000), random.below(1000));
        match random.below(40) {
            0..9 => Edit::AddPlane(at, any_plane(random, shape), random.below(2) as u32),
            9..11 => Edit::AddPlane(at, emptying(random), random.below(2) as u32),
            11..20 => Edit::RemovePlane(at, plane),
            20..22 => Edit::MovePlane(at, plane, emptying(random).1),
            22..28 => Edit::MovePlane(at, plane, any_plane(random, shape).1),
            28..34 => Edit::Undo,
            34..37 => Edit::Redo,
            37 => {
                let by = [0; 3].map(|_| random.whole(-1, 1));
                // not turned: the rounding of a turn leaves edges that the mesh is freed of, and the faces are not
                Edit::Move(at, [0.0, 0.0, 1.0], 0.0, by)
            }
            38 => Edit::SetRole(at, random.pick(&[Role::Add, Role::Subtract])),
            _ => Edit::Replace(at, shape(random)),
        }
    };
    edits.extend((0..length).map(edit));
    edits
}

/// Runs sequences of edits, from seed 0 on.
fn sweep(seeds: u64, length: usize, first: fn(&mut Rng) -> Planes, shape: fn(&mut Rng) -> Planes) -> Tally {
    let seeds = scaled(seeds);
    let tally =
        (0..seeds).map(|seed| check(seed, &sequence(&mut Rng::spread(seed), length, first, shape), Faces::Same)).sum();
    println!("{seeds} sequences of {length} edits: {tally:?}");
    tally
}

#[test]
fn random_edits_of_many_planes_on_a_grid() {
    let tally = sweep(8, 40, lattice, lattice);
    assert!(tally.compared > 150 && tally.triangles > 20 * tally.compared, "{tally:?}");
}

#[test]
fn random_edits_of_many_planes_without_an_end() {
    let tally = sweep(8, 40, lattice, open);
    assert!(tally.compared > 150 && tally.triangles > 20 * tally.compared, "{tally:?}");
}

#[test]
fn random_edits_of_hundreds_of_planes() {
    let tally = sweep(3, 30, ball, ball);
    assert!(tally.compared > 50 && tally.triangles > 100 * tally.compared, "{tally:?}");
}

#[test]
fn random_edits_of_pyramids_and_prisms() {
    let tally = sweep(6, 40, over_polygon, over_polygon);
    assert!(tally.compared > 100 && tally.triangles > 20 * tally.compared, "{tally:?}");
}

/// Seed 199 of the test of brushes without an end: a point stayed known by a plane that met in it no more, and did not move with the one that did.
#[test]
fn points_are_known_by_planes_that_still_meet_in_them() {
    let planes: Planes = vec![
        ([1.0, 0.0, 0.0], 3.0),
        ([-1.0, 0.0, 0.0], 4.0),
        ([0.0, 1.0, 0.0], 3.0),
        ([0.0, -1.0, 0.0], 4.0),
        ([0.0, 0.0, 1.0], 3.0),
        ([0.0, 0.0, -1.0], 3.0),
        ([1.0, 2.0, 0.0], 11.0),
        ([1.0, 1.0, 2.0], 7.0),
        ([-1.0, -2.0, -1.0], 6.0),
        ([-2.0, 1.0, -1.0], 8.0),
        ([2.0, 1.0, -1.0], 9.0),
        ([-1.0, 0.0, 2.0], 8.0),
        ([1.0, 1.0, 0.0], 3.0),
        ([-1.0, 2.0, 0.0], 7.0),
        ([-2.0, -1.0, 0.0], 6.0),
        ([0.0, 0.0, -2.0], 6.0),
        ([-1.0, 2.0, 1.0], 7.0),
        ([2.0, 2.0, 2.0], 9.0),
        ([1.0, -2.0, 2.0], 8.0),
        ([0.0, 1.0, -2.0], 7.0),
        ([-1.0, 0.0, 0.0], 4.0),
        ([-2.0, 2.0, 0.0], 8.0),
        ([1.0, 2.0, 2.0], 8.0),
        ([2.0, -1.0, 1.0], 7.0),
    ];
    let tally = run(
        &[
            Edit::Add(planes.clone(), 0, Role::Add),
            Edit::Add(planes.clone(), 0, Role::Add),
            Edit::Undo,
            Edit::RemovePlane(644, 538),
            Edit::RemovePlane(813, 961),
            Edit::RemovePlane(588, 799),
            Edit::AddPlane(163, ([1.0, -1.0, -1.0], 8.0), 1),
            Edit::RemovePlane(655, 545),
            Edit::RemovePlane(982, 384),
            Edit::MovePlane(100, 429, 9.0),
            Edit::RemovePlane(553, 645),
            Edit::RemovePlane(983, 519),
            Edit::Undo,
            Edit::AddPlane(155, ([-1.0, 2.0, 1.0], 6.0), 0),
            Edit::Undo,
            Edit::MovePlane(0, 200, 9.0),
            Edit::RemovePlane(157, 909),
            Edit::MovePlane(347, 534, 8.0),
        ],
        Faces::Same,
    );
    assert!(tally.as_ref().is_ok_and(|tally| tally.compared == 18), "{tally:?}");
}
