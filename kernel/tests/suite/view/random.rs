//! Random sequences by category: every view against every other after every operation.

use planecut_kernel::{IncrementalPolytope, PlaneIdx};
use planecut_oracle::random::Rng;
use planecut_oracle::settings::cases;

use super::consistency::{check, compare_with_facets};
use super::solids::half_space;

/// One step of a sequence.
#[derive(Debug, Clone, Copy)]
enum Op {
    /// Add `n·x ≤ d`.
    Add([f64; 4]),
    /// Remove one of the planes that are there, counted modulo their number.
    Remove(usize),
}

type Plane = fn(&mut Rng, &[Op]) -> [f64; 4];

/// Sequences per category, each with every tolerance, unless the environment says otherwise.
const SEQUENCES: usize = 12;
const OPERATIONS: usize = 40;
/// Lengths below which edges are contracted: never, by default, and so coarse that solids of size 1 begin to collapse.
const TOLERANCES: [f64; 4] = [0.0, 1e-7, 0.05, 0.6];

fn tangent(rng: &mut Rng, _: &[Op]) -> [f64; 4] {
    let [x, y, z] = rng.direction();
    [x, y, z, 1.0]
}

fn anywhere(rng: &mut Rng, _: &[Op]) -> [f64; 4] {
    let [x, y, z] = rng.direction();
    [x, y, z, rng.float(-0.2, 1.5)]
}

fn grid(rng: &mut Rng, _: &[Op]) -> [f64; 4] {
    let [x, y, z] = rng.lattice(1);
    [x, y, z, rng.whole(0, 2)]
}

fn finer_grid(rng: &mut Rng, _: &[Op]) -> [f64; 4] {
    let [x, y, z] = rng.lattice(3);
    [x, y, z, rng.whole(1, 6)]
}

fn prism(rng: &mut Rng, _: &[Op]) -> [f64; 4] {
    if rng.chance(0.04) {
        return [0.0, 0.0, rng.pick(&[-1.0, 1.0]), 1.0];
    }
    let [x, y, _] = rng.lattice(2);
    if (x, y) == (0.0, 0.0) { [1.0, 0.0, 0.0, 1.0] } else { [x, y, 0.0, rng.whole(0, 3)] }
}

fn through_one_point(rng: &mut Rng, _: &[Op]) -> [f64; 4] {
    let [x, y, z] = rng.lattice(2);
    [x, y, z, x + y + z + if rng.chance(0.2) { 2.0 } else { 0.0 }]
}

fn near_parallel(rng: &mut Rng, before: &[Op]) -> [f64; 4] {
    let known: Vec<[f64; 4]> =
        before.iter().filter_map(|op| if let Op::Add(c) = op { Some(*c) } else { None }).collect();
    if known.is_empty() || rng.chance(0.4) {
        return tangent(rng, before);
    }
    let size = 10f64.powi(-(rng.integer(2, 15) as i32));
    let sign = if rng.chance(0.2) { -1.0 } else { 1.0 };
    rng.pick(&known).map(|v| sign * v + size * rng.float(-1.0, 1.0))
}

fn small(rng: &mut Rng, _: &[Op]) -> [f64; 4] {
    let [x, y, z] = rng.direction();
    [x, y, z, 10f64.powi(rng.integer(-8, -5) as i32)]
}

fn thin(rng: &mut Rng, _: &[Op]) -> [f64; 4] {
    // needles and plates: nearly all normals close to two axes
    let [x, y, z] = rng.direction();
    let flatten = rng.pick(&[1.0, 1e-3, 1e-9]);
    [x * flatten, y, z, rng.pick(&[1e-8, 1e-3, 1.0])]
}

fn sequence(rng: &mut Rng, plane: Plane) -> Vec<Op> {
    let mut operations = Vec::new();
    for _ in 0..OPERATIONS {
        let op = if rng.chance(0.3) { Op::Remove(rng.below(1000)) } else { Op::Add(plane(rng, &operations)) };
        operations.push(op);
    }
    operations
}

fn replay(operations: &[Op], epsilon: f64) -> Result<(), String> {
    let mut polytope = IncrementalPolytope::with_epsilon(epsilon);
    let mut present: Vec<PlaneIdx> = Vec::new();
    for (step, op) in operations.iter().enumerate() {
        match *op {
            Op::Add([nx, ny, nz, d]) => present.push(polytope.add_plane(half_space(nx, ny, nz, d)).plane()),
            Op::Remove(_) if present.is_empty() => continue,
            Op::Remove(k) => {
                polytope.remove_plane(present.remove(k % present.len())).ok_or("a plane is lost")?;
            }
        }
        let checked = check(&polytope, epsilon);
        let compared = if epsilon == 0.0 { compare_with_facets(&polytope) } else { Ok(()) };
        checked.and(compared).map_err(|e| format!("step {step}: {e}"))?;
    }
    Ok(())
}

/// Leaves out operations while the sequence still fails.
fn shrink(mut operations: Vec<Op>, epsilon: f64) -> Vec<Op> {
    let mut k = 0;
    while k < operations.len() {
        let mut shorter = operations.clone();
        shorter.remove(k);
        if replay(&shorter, epsilon).is_err() {
            operations = shorter;
            k = 0;
        } else {
            k += 1;
        }
    }
    operations
}

fn run(seed: u64, plane: Plane) {
    for number in 0..cases(SEQUENCES) as u64 {
        let operations = sequence(&mut Rng::new(seed ^ (number << 32)), plane);
        for epsilon in TOLERANCES {
            if let Err(error) = replay(&operations, epsilon) {
                let minimal = shrink(operations, epsilon);
                let last = replay(&minimal, epsilon);
                panic!("seed {seed}, sequence {number}: {error}\nminimal, epsilon {epsilon:?}: {minimal:?}\n{last:?}");
            }
        }
    }
}

macro_rules! categories {
    ($($name:ident: $seed:literal;)*) => {
        mod views_agree {
            $(#[test]
            fn $name() {
                super::run($seed, super::$name);
            })*
        }
    };
}

categories! {
    tangent: 1;
    anywhere: 2;
    grid: 3;
    finer_grid: 4;
    prism: 5;
    through_one_point: 6;
    near_parallel: 7;
    small: 8;
    thin: 9;
}
