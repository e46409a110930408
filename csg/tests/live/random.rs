//! Random edits: after each the model equals one built anew, and a copy that follows the changes has its faces.

use planecut_csg::Role;
use planecut_kernel::DVec3;

use crate::edits::{Edit, Planes, Tally, check};
use crate::rng::Rng;

/// Boxes and cut boxes on a small grid: everything touches.
fn on_grid(random: &mut Rng) -> Planes {
    let mut planes = Vec::new();
    let mut middle = [0.0; 3];
    for axis in 0..3 {
        let low = f64::from(random.integer(0, 4));
        let high = low + f64::from(random.integer(1, 3));
        middle[axis] = 0.5 * (low + high);
        for (sign, at) in [(1.0, high), (-1.0, -low)] {
            let mut normal = [0.0; 3];
            normal[axis] = sign;
            planes.push((normal, at));
        }
    }
    if random.chance(0.3) {
        let normal = [0; 3].map(|_| f64::from(random.integer(-1, 1)));
        if normal != [0.0; 3] {
            let through: f64 = normal.iter().zip(middle).map(|(n, m)| n * m).sum();
            planes.push((normal, through + 0.5 * f64::from(random.integer(0, 2))));
        }
    }
    planes
}

/// Wedges around a few lines: three planes in a line, faces that cross.
fn around_lines(random: &mut Rng) -> Planes {
    let normals = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [1.0, -1.0, 0.0]];
    let mut planes = vec![([0.0, 0.0, 1.0], 1.0), ([0.0, 0.0, -1.0], f64::from(random.integer(0, 1)))];
    planes.extend([[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0]].map(|normal| (normal, 3.0)));
    for _ in 0..2 {
        let normal = normals[random.below(4)];
        let sign = if random.chance(0.5) { 1.0 } else { -1.0 };
        planes.push((normal.map(|v: f64| v * sign), 0.0));
    }
    planes
}

/// Turned bodies of up to 26 planes in general position.
fn turned(random: &mut Rng) -> Planes {
    let mut place = || DVec3::new(random.real(0.0, 1.0), random.real(0.0, 1.0), random.real(0.0, 1.0));
    let center = 3.0 * place();
    let count = 6 + (place().x * 20.0) as usize;
    let plane = |k: usize| {
        let axis = [DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y, DVec3::Z, -DVec3::Z][k % 6];
        let normal = (axis + 0.9 * (place() - 0.5)).normalize();
        (normal.to_array(), normal.dot(center) + 0.4 + 0.4 * place().x)
    };
    (0..count).map(plane).collect()
}

fn sequence(random: &mut Rng, length: usize, shape: fn(&mut Rng) -> Planes) -> Vec<Edit> {
    let edit = |_| {
        let role = match random.below(12) {
            0..7 => Role::Add,
            7..11 => Role::Subtract,
            _ => Role::Intersect,
        };
        let at = random.below(1000);
        match random.below(6) {
            0..3 => Edit::Add(shape(random), random.below(2) as u32, role),
            3 => Edit::Remove(at),
            4 => Edit::Replace(at, shape(random)),
            _ => Edit::SetRole(at, role),
        }
    };
    (0..length).map(edit).collect()
}

fn sweep(seeds: u64, length: usize, shape: fn(&mut Rng) -> Planes) -> Tally {
    (0..seeds).fold(Tally::default(), |sum, seed| {
        let tally = check(seed, &sequence(&mut Rng::new(seed), length, shape));
        Tally {
            compared: sum.compared + tally.compared,
            equal: sum.equal + tally.equal,
            triangles: sum.triangles + tally.triangles,
        }
    })
}

#[test]
fn random_edits_on_a_grid() {
    let tally = sweep(60, 60, on_grid);
    assert!(tally.equal * 10 > tally.compared * 9 && tally.triangles > 40 * tally.compared, "{tally:?}");
}

#[test]
fn random_edits_around_lines() {
    let tally = sweep(60, 30, around_lines);
    assert!(tally.compared > 500, "{tally:?}");
}

#[test]
fn random_edits_in_general_position() {
    let tally = sweep(25, 60, turned);
    assert!(tally.equal * 10 > tally.compared * 9 && tally.triangles > 200 * tally.compared, "{tally:?}");
}
