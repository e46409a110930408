//! Several planes at once: `remove_planes` against single removals and against building the rest from scratch.

use crate::case::{Sampler, half_spaces, microseconds};
use crate::plan::Case;
use cpu_time::ThreadTime;
use planecut_bench::inputs::{fibonacci_sphere, patch, shuffled};
use planecut_bench::library::{Library, Planecut};
use planecut_kernel::{HalfSpace, IncrementalPolytope, PlaneIdx};
use std::hint::black_box;

/// How the planes lie that are removed together.
pub(crate) const ARRANGEMENTS: [&str; 2] = ["scattered", "patch"];
/// The ways that are compared, in the order of the sampler's times.
pub(crate) const WAYS: [&str; 3] = ["remove_planes", "single removals", "rebuild"];
/// About how many planes are removed for one sample: enough that reading the clock does not count.
const PLANES_FOR_A_SAMPLE: usize = 60;

/// The name of one way in the report.
pub(crate) fn operation(arrangement: &str, way: &str, removed: usize) -> String {
    format!("{way}, {removed} {arrangement}")
}

/// The numbers of planes, and for each the numbers removed together.
pub(crate) fn sizes(quick: bool) -> Vec<(usize, Vec<usize>)> {
    if quick {
        return vec![(200, vec![2, 20, 100])];
    }
    vec![
        (200, vec![1, 2, 5, 10, 20, 50, 80, 100]),
        (1000, vec![1, 2, 10, 50, 200, 400, 500]),
        (10_000, vec![1, 10, 100, 1000, 4000, 5000]),
    ]
}

/// All cases, each with one operation for each way.
///
/// # Errors
/// Numbers of vertices that differ between the ways.
pub(crate) fn cases(quick: bool) -> Result<Vec<Case>, String> {
    let mut cases = Vec::new();
    for (size, counts) in sizes(quick) {
        for count in counts {
            for arrangement in ARRANGEMENTS {
                let operations = WAYS.map(|way| operation(arrangement, way, count)).to_vec();
                let sampler = sampler(size, arrangement, count)?;
                cases.push(Case { operations, size, library: Planecut::NAME, sampler });
            }
        }
    }
    Ok(cases)
}

/// The planes that one sample removes.
fn chosen(size: usize, arrangement: &str, count: usize, seed: u64) -> Vec<usize> {
    if arrangement == ARRANGEMENTS[0] {
        return shuffled(size, seed).into_iter().take(count).collect();
    }
    patch(&fibonacci_sphere(size), count, seed)
}

/// Times the whole operation, not one plane of it; clones are made and dropped outside.
fn sampler(size: usize, arrangement: &'static str, count: usize) -> Result<Sampler, String> {
    let half_spaces = half_spaces::<Planecut>(&fibonacci_sphere(size));
    let polytope = Planecut::build(&half_spaces).0;
    let sets: Vec<Vec<PlaneIdx>> =
        (0..5).map(|seed| chosen(size, arrangement, count, seed).into_iter().map(PlaneIdx).collect()).collect();
    for set in &sets {
        let rest = rest(&half_spaces, set);
        let found = [at_once(polytope.clone(), set), one_by_one(polytope.clone(), set), Planecut::build(&rest).0]
            .map(|p| p.vertex_count());
        if found != [found[0]; 3] {
            return Err(format!("{count} of {size} planes, {arrangement}: {found:?} vertices by {WAYS:?}"));
        }
    }
    let rests: Vec<Vec<HalfSpace>> = sets.iter().map(|set| rest(&half_spaces, set)).collect();
    let repeat = (PLANES_FOR_A_SAMPLE / count).max(1);
    let mut next = 0;
    Ok(Box::new(move || {
        next = (next + 1) % sets.len();
        let (set, rest) = (&sets[next], &rests[next]);
        let timed = |way: fn(IncrementalPolytope, &[PlaneIdx]) -> IncrementalPolytope| {
            let clones = vec![polytope.clone(); repeat];
            let mut results = Vec::with_capacity(repeat);
            let start = ThreadTime::now();
            for clone in clones {
                results.push(way(clone, black_box(set)));
            }
            let time = start.elapsed();
            drop(black_box(results));
            microseconds(time, repeat)
        };
        // Each goes first in every other sample.
        let (together, single) = if next % 2 == 0 {
            let together = timed(at_once);
            (together, timed(one_by_one))
        } else {
            let single = timed(one_by_one);
            (timed(at_once), single)
        };
        let start = ThreadTime::now();
        let rebuilt = Planecut::build(black_box(rest));
        let time = start.elapsed();
        drop(black_box(rebuilt));
        Ok(vec![together, single, microseconds(time, 1)])
    }))
}

fn rest(half_spaces: &[HalfSpace], set: &[PlaneIdx]) -> Vec<HalfSpace> {
    let mut stays = vec![true; half_spaces.len()];
    set.iter().for_each(|plane| stays[plane.0] = false);
    half_spaces.iter().zip(stays).filter(|(_, stays)| *stays).map(|(half_space, _)| *half_space).collect()
}

fn at_once(mut polytope: IncrementalPolytope, set: &[PlaneIdx]) -> IncrementalPolytope {
    polytope.remove_planes(set);
    polytope
}

fn one_by_one(mut polytope: IncrementalPolytope, set: &[PlaneIdx]) -> IncrementalPolytope {
    for &plane in set {
        polytope.remove_plane(plane);
    }
    polytope
}
