//! What is timed. Each function prepares one case and returns its sampler: a batch of operations, and the mean time of one
//! in microseconds. Samples of different libraries can so be interleaved.
//!
//! The clock is the processor time of the thread: on a machine that others use too, wall time mostly measures them, and long
//! operations are interrupted more often than short ones. It is read once for a batch, because reading it is slow.

use cpu_time::ThreadTime;
use planecut_bench::inputs::{Plane, along_path, apart};
use planecut_bench::library::Library;
use std::hint::black_box;
use std::time::Duration;

/// The step from one plane to the next: a prime, so that all planes take part and neighbours do not follow each other.
const STRIDE: usize = 7919;
/// How many sets of planes far from each other take turns.
const SETS: usize = 8;

/// Does a batch of operations and gives the mean time of one, in microseconds, for each operation of the case; or what
/// went wrong, and no time.
pub(crate) type Sampler = Box<dyn FnMut() -> Result<Vec<f64>, String>>;

/// Walks over all planes of an input again and again.
struct Walk {
    count: usize,
    at: usize,
}

impl Walk {
    fn step(&mut self) -> usize {
        self.at = (self.at + STRIDE) % self.count;
        self.at
    }
}

/// The planes in the library's own type.
pub(crate) fn half_spaces<L: Library>(planes: &[Plane]) -> Vec<L::HalfSpace> {
    planes.iter().map(L::half_space).collect()
}

/// Finding a plane far away again takes long among very many.
const MOST_SCATTERED: usize = 2000;

/// In which order the planes of one batch follow each other.
#[derive(Clone, Copy)]
pub(crate) enum Order {
    /// In a random order: each far from the one before.
    Scattered,
    /// Along a path: each near the one before.
    Path,
}

/// Removes planes without common neighbours, of each of `copies` polytopes, then adds them again in the reverse order: two
/// operations, timed apart. After each batch the vertices of the first copy must be as many as at the start.
pub(crate) fn remove_then_add<L: Library>(planes: &[Plane], copies: usize, order: Order) -> Sampler {
    let half_spaces = half_spaces::<L>(planes);
    let mut polytope = L::build(&half_spaces);
    polytope.settle();
    let vertices = polytope.vertex_count();
    let mut polytopes = vec![polytope; copies];
    let set = |seed| match order {
        Order::Scattered => {
            let mut set = apart(planes, seed);
            set.truncate(MOST_SCATTERED);
            set
        }
        Order::Path => along_path(planes, apart(planes, seed)),
    };
    let sets: Vec<_> = (0..SETS as u64).map(set).collect();
    let mut next = 0;
    Box::new(move || {
        let set = &sets[next % SETS];
        next += 1;
        let batch = copies * set.len();
        let start = ThreadTime::now();
        for polytope in &mut polytopes {
            for &index in set {
                polytope.remove(index);
            }
        }
        let removed = start.elapsed();
        black_box(&mut polytopes);
        let start = ThreadTime::now();
        for polytope in &mut polytopes {
            for &index in set.iter().rev() {
                polytope.add(&half_spaces[index]);
            }
        }
        let added = start.elapsed();
        if is_checked(vertices, next) {
            check_count::<L>(&polytopes[0], vertices)?;
        }
        Ok(vec![microseconds(removed, batch), microseconds(added, batch)])
    })
}

/// Removes one plane and adds it again, in place; after each batch the vertices must be as many as at the start.
pub(crate) fn remove_and_add<L: Library>(planes: &[Plane], batch: usize) -> Sampler {
    let half_spaces = half_spaces::<L>(planes);
    let mut polytope = L::build(&half_spaces);
    polytope.settle();
    let vertices = polytope.vertex_count();
    let mut walk = Walk { count: planes.len(), at: 0 };
    let mut next = 0;
    Box::new(move || {
        next += 1;
        let start = ThreadTime::now();
        for _ in 0..batch {
            let index = walk.step();
            polytope.remove(index);
            polytope.add(&half_spaces[index]);
        }
        black_box(&mut polytope);
        let time = start.elapsed();
        if is_checked(vertices, next) {
            check_count::<L>(&polytope, vertices)?;
        }
        Ok(vec![microseconds(time, batch)])
    })
}

/// Whether the vertices are counted after a batch: counting very many takes longer than the batch, and leaves the caches
/// full of the count.
fn is_checked(vertices: usize, batch: usize) -> bool {
    vertices < 1000 || batch.is_multiple_of(SETS)
}

fn check_count<L: Library>(polytope: &L, expected: usize) -> Result<(), String> {
    match polytope.vertex_count() {
        found if found == expected => Ok(()),
        found => Err(format!("{}: {found} vertices after in-place edits, {expected} before", L::NAME)),
    }
}

/// Clones the polytope and removes one plane from the clone; dropping the clone is not timed.
pub(crate) fn clone_and_remove<L: Library>(planes: &[Plane], batch: usize) -> Sampler {
    let mut polytope = L::build(&half_spaces::<L>(planes));
    polytope.settle();
    let mut walk = Walk { count: planes.len(), at: 0 };
    Box::new(move || {
        let mut clones = Vec::with_capacity(batch);
        let start = ThreadTime::now();
        for _ in 0..batch {
            let mut clone = black_box(&polytope).clone();
            clone.remove(walk.step());
            clones.push(clone);
        }
        let time = start.elapsed();
        drop(black_box(clones));
        Ok(vec![microseconds(time, batch)])
    })
}

/// Removes plane 0 from each of `batch` clones; neither cloning nor dropping is timed.
pub(crate) fn remove_first<L: Library>(planes: &[Plane], batch: usize) -> Sampler {
    let mut polytope = L::build(&half_spaces::<L>(planes));
    polytope.settle();
    Box::new(move || {
        let mut clones = vec![polytope.clone(); batch];
        let start = ThreadTime::now();
        for clone in &mut clones {
            clone.remove(0);
        }
        let time = start.elapsed();
        drop(black_box(clones));
        Ok(vec![microseconds(time, batch)])
    })
}

/// Builds the polytope from nothing, plane by plane; dropping it is not timed.
pub(crate) fn build<L: Library>(planes: &[Plane], batch: usize) -> Sampler {
    let half_spaces = half_spaces::<L>(planes);
    Box::new(move || {
        let mut built = Vec::with_capacity(batch);
        let start = ThreadTime::now();
        for _ in 0..batch {
            built.push(L::build(black_box(&half_spaces)));
        }
        let time = start.elapsed();
        drop(black_box(built));
        Ok(vec![microseconds(time, batch)])
    })
}

/// Time for each of `batch` operations.
pub(crate) fn microseconds(total: Duration, batch: usize) -> f64 {
    total.as_secs_f64() * 1e6 / batch as f64
}
