//! Every table of the paper (§3.7, §5.3 to §5.5) under its own benchmark name, for both libraries:
//! `cargo bench --manifest-path bench/Cargo.toml`. Inputs and plane numbers are those of the published benchmarks.
//!
//! What an operation returns is dropped outside the timed part.

use divan::{Bencher, black_box};
use planecut_bench::cubic;
use planecut_bench::inputs::{Plane, cube_with_touched_corner, fibonacci_sphere, pyramid, two_cubes, voronoi_proxy};
use planecut_bench::library::{Library, Planecut, PolySurge};

fn main() {
    divan::main();
}

/// Clones the polytope of `planes` and removes one plane of the clone.
fn clone_and_remove<L: Library>(bencher: Bencher, planes: &[Plane], index: usize) {
    let mut polytope = build::<L>(planes);
    polytope.settle();
    bencher.bench_local(|| {
        let mut clone = black_box(&polytope).clone();
        clone.remove(black_box(index));
        clone
    });
}

fn build<L: Library>(planes: &[Plane]) -> L {
    L::build(&half_spaces::<L>(planes))
}

fn half_spaces<L: Library>(planes: &[Plane]) -> Vec<L::HalfSpace> {
    planes.iter().map(L::half_space).collect()
}

/// §5.3: clone and remove.
#[divan::bench(types = [Planecut, PolySurge], args = [30, 50, 80, 100, 150, 200], max_time = 1)]
fn remove_vs_rebuild_topology<L: Library>(bencher: Bencher, planes: usize) {
    clone_and_remove::<L>(bencher, &fibonacci_sphere(planes), 5);
}

/// §5.3: build from the planes that are left.
#[divan::bench(types = [Planecut, PolySurge], args = [30, 50, 80, 100, 150, 200], max_time = 1)]
fn remove_vs_rebuild_full<L: Library>(bencher: Bencher, planes: usize) {
    let mut planes = fibonacci_sphere(planes);
    planes.remove(5);
    let half_spaces = half_spaces::<L>(&planes);
    bencher.bench_local(|| L::build(black_box(&half_spaces)));
}

/// §5.2 and §5.3: all triples of adjacent planes, for the new vertices alone; the same code for both libraries.
#[divan::bench(args = [30, 50, 80, 100], max_time = 1)]
fn reconstruct_old_cubic_approach(bencher: Bencher, planes: usize) {
    let planes = fibonacci_sphere(planes);
    let vertices = build::<Planecut>(&planes).mesh().0;
    let adjacent = cubic::adjacent(&planes, &vertices, 5);
    bencher.bench_local(|| cubic::reconstruct(black_box(&planes), black_box(&adjacent), 5));
}

/// §5.4: a cell with 14 neighbours loses one.
#[divan::bench(types = [Planecut, PolySurge], max_time = 1)]
fn realworld_voronoi_cell_removal<L: Library>(bencher: Bencher) {
    clone_and_remove::<L>(bencher, &voronoi_proxy(), 7);
}

/// §5.4: the intersection of two cubes loses a face.
#[divan::bench(types = [Planecut, PolySurge], max_time = 1)]
fn realworld_csg_cube_intersection<L: Library>(bencher: Bencher) {
    clone_and_remove::<L>(bencher, &two_cubes(), 3);
}

/// §5.5: clone and remove, more planes.
#[divan::bench(types = [Planecut, PolySurge], args = [50, 100, 150, 200, 300], max_time = 1)]
fn scalability_removal<L: Library>(bencher: Bencher, planes: usize) {
    clone_and_remove::<L>(bencher, &fibonacci_sphere(planes), planes / 2);
}

/// Not in the paper: a face whose ring has all other planes.
#[divan::bench(types = [Planecut, PolySurge], args = [50, 100, 200], sample_count = 20, max_time = 2)]
fn pyramid_base_removal<L: Library>(bencher: Bencher, sides: usize) {
    clone_and_remove::<L>(bencher, &pyramid(sides), 0);
}

/// §3.7.1: remove every plane of 30 and count the results that pass Euler's check.
#[divan::bench(types = [Planecut, PolySurge], args = [1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10], max_time = 1)]
fn epsilon_sensitivity_analysis<L: Library>(bencher: Bencher, epsilon: f64) {
    let half_spaces = half_spaces::<L>(&fibonacci_sphere(30));
    let mut polytope = L::with_epsilon(epsilon);
    polytope.add_all(&half_spaces);
    let run = || euler_passes(&polytope, half_spaces.len());
    report_passes::<L>("epsilon_sensitivity_analysis", &format!("epsilon {epsilon:e}"), run(), half_spaces.len());
    bencher.bench_local(run);
}

/// §3.7: a cube and a plane that touches its corner.
#[divan::bench(types = [Planecut, PolySurge], max_time = 1)]
fn degenerate_cube_corner_incremental<L: Library>(bencher: Bencher) {
    let half_spaces = half_spaces::<L>(&cube_with_touched_corner());
    assert_eq!(L::build(&half_spaces).vertex_count(), 8, "{}", L::NAME);
    bencher.bench_local(|| L::build(black_box(&half_spaces)));
}

/// §3.7: 140 removals, each checked by Euler's formula; 100 iterations are the paper's 14,000.
#[divan::bench(types = [Planecut, PolySurge], sample_count = 100, sample_size = 1)]
fn validation_stress_test<L: Library>(bencher: Bencher) {
    let polytopes = [20, 30, 40, 50].map(|planes| (build::<L>(&fibonacci_sphere(planes)), planes));
    let run = || polytopes.iter().map(|(polytope, planes)| euler_passes(polytope, *planes)).sum::<usize>();
    report_passes::<L>("validation_stress_test", "140 removals", run(), 140);
    bencher.bench_local(run);
}

/// How many of the removals of one plane each leave a polytope with `V − E + F = 2`.
fn euler_passes<L: Library>(polytope: &L, planes: usize) -> usize {
    let passes = |index: &usize| {
        let mut clone = polytope.clone();
        clone.remove(*index);
        clone.is_bounded() && clone.euler_characteristic() == 2
    };
    (0..planes).filter(passes).count()
}

fn report_passes<L: Library>(benchmark: &str, what: &str, passes: usize, of: usize) {
    if passes != of {
        eprintln!("{benchmark}, {}, {what}: only {passes} of {of} pass Euler's check", L::NAME);
    }
}
