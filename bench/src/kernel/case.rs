//! What is timed: each case gives one sample after the other, so that cases of different libraries can be interleaved.

use crate::inputs::Plane;
use crate::library::Library;
use std::hint::black_box;
use std::time::{Duration, Instant};

/// The step from one plane to the next: a prime, so that all planes take part and neighbours do not follow each other.
const STRIDE: usize = 7919;

/// One line of the report.
pub(crate) struct Case {
    /// What is done, the same words for every library.
    pub(crate) operation: &'static str,
    /// Who does it.
    pub(crate) library: &'static str,
    /// The number of planes.
    pub(crate) planes: usize,
    /// Does a batch of operations and gives the mean time of one, in microseconds.
    pub(crate) sample: Box<dyn FnMut() -> f64>,
}

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

/// Removes one plane and adds it again, in place.
pub(crate) fn remove_and_add<L: Library + 'static>(planes: &[Plane], batch: usize) -> impl FnMut() -> f64 + 'static {
    let half_spaces: Vec<_> = planes.iter().map(L::half_space).collect();
    let mut polytope = L::build(&half_spaces);
    polytope.settle();
    let mut walk = Walk { count: planes.len(), at: 0 };
    move || {
        let start = Instant::now();
        for _ in 0..batch {
            let index = walk.step();
            polytope.remove(index);
            polytope.add_again(index, &half_spaces[index]);
        }
        black_box(&mut polytope);
        microseconds(start.elapsed(), batch)
    }
}

/// Clones the polytope and removes one plane from the clone; dropping the clone is not timed.
pub(crate) fn clone_and_remove<L: Library + 'static>(planes: &[Plane], batch: usize) -> impl FnMut() -> f64 + 'static {
    let half_spaces: Vec<_> = planes.iter().map(L::half_space).collect();
    let mut polytope = L::build(&half_spaces);
    polytope.settle();
    let mut walk = Walk { count: planes.len(), at: 0 };
    move || {
        let mut total = Duration::ZERO;
        for _ in 0..batch {
            let index = walk.step();
            let start = Instant::now();
            let mut clone = black_box(&polytope).clone();
            clone.remove(index);
            black_box(&mut clone);
            total += start.elapsed();
        }
        microseconds(total, batch)
    }
}

/// Removes plane 0 from a clone; neither cloning nor dropping is timed.
pub(crate) fn remove_first<L: Library + 'static>(planes: &[Plane], batch: usize) -> impl FnMut() -> f64 + 'static {
    let half_spaces: Vec<_> = planes.iter().map(L::half_space).collect();
    let mut polytope = L::build(&half_spaces);
    polytope.settle();
    move || {
        let mut total = Duration::ZERO;
        for _ in 0..batch {
            let mut clone = polytope.clone();
            let start = Instant::now();
            clone.remove(0);
            black_box(&mut clone);
            total += start.elapsed();
        }
        microseconds(total, batch)
    }
}

/// Builds the polytope from nothing, plane by plane; dropping it is not timed.
pub(crate) fn build<L: Library + 'static>(planes: &[Plane], batch: usize) -> impl FnMut() -> f64 + 'static {
    let half_spaces: Vec<_> = planes.iter().map(L::half_space).collect();
    move || {
        let mut total = Duration::ZERO;
        for _ in 0..batch {
            let start = Instant::now();
            let polytope = black_box(L::build(black_box(&half_spaces)));
            total += start.elapsed();
            drop(polytope);
        }
        microseconds(total, batch)
    }
}

fn microseconds(total: Duration, batch: usize) -> f64 {
    total.as_secs_f64() * 1e6 / batch as f64
}
