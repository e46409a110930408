//! What is timed. Each function prepares one case and returns its sampler: a batch of operations, and the mean time of one
//! in microseconds. Samples of different libraries can so be interleaved.
//!
//! The clock is the processor time of the thread: on a machine that others use too, wall time mostly measures them, and long
//! operations are interrupted more often than short ones. It is read once for a batch, because reading it is slow.

use crate::inputs::Plane;
use crate::library::Library;
use cpu_time::ThreadTime;
use std::hint::black_box;
use std::time::Duration;

/// The step from one plane to the next: a prime, so that all planes take part and neighbours do not follow each other.
const STRIDE: usize = 7919;

/// Does a batch of operations and gives the mean time of one, in microseconds; or what went wrong, and no time.
pub(crate) type Sampler = Box<dyn FnMut() -> Result<f64, String>>;

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

/// Removes one plane and adds it again, in place; after each batch the vertices must be as many as at the start.
pub(crate) fn remove_and_add<L: Library + 'static>(planes: &[Plane], batch: usize) -> Sampler {
    let half_spaces: Vec<_> = planes.iter().map(L::half_space).collect();
    let mut polytope = L::build(&half_spaces);
    polytope.settle();
    let vertices = polytope.vertex_count();
    let mut walk = Walk { count: planes.len(), at: 0 };
    Box::new(move || {
        let start = ThreadTime::now();
        for _ in 0..batch {
            let index = walk.step();
            polytope.remove(index);
            polytope.add_again(&half_spaces[index]);
        }
        black_box(&mut polytope);
        let time = start.elapsed();
        match polytope.vertex_count() {
            found if found == vertices => Ok(microseconds(time, batch)),
            found => Err(format!("{}: {found} vertices after in-place edits, {vertices} before", L::NAME)),
        }
    })
}

/// Clones the polytope and removes one plane from the clone; dropping the clone is not timed.
pub(crate) fn clone_and_remove<L: Library + 'static>(planes: &[Plane], batch: usize) -> Sampler {
    let half_spaces: Vec<_> = planes.iter().map(L::half_space).collect();
    let mut polytope = L::build(&half_spaces);
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
        Ok(microseconds(time, batch))
    })
}

/// Removes plane 0 from a clone; neither cloning nor dropping is timed.
pub(crate) fn remove_first<L: Library + 'static>(planes: &[Plane]) -> Sampler {
    let half_spaces: Vec<_> = planes.iter().map(L::half_space).collect();
    let mut polytope = L::build(&half_spaces);
    polytope.settle();
    Box::new(move || {
        let mut clone = polytope.clone();
        let start = ThreadTime::now();
        clone.remove(0);
        let time = start.elapsed();
        drop(black_box(clone));
        Ok(microseconds(time, 1))
    })
}

/// Builds the polytope from nothing, plane by plane; dropping it is not timed.
pub(crate) fn build<L: Library + 'static>(planes: &[Plane], batch: usize) -> Sampler {
    let half_spaces: Vec<_> = planes.iter().map(L::half_space).collect();
    Box::new(move || {
        let mut built = Vec::with_capacity(batch);
        let start = ThreadTime::now();
        for _ in 0..batch {
            built.push(L::build(black_box(&half_spaces)));
        }
        let time = start.elapsed();
        drop(black_box(built));
        Ok(microseconds(time, batch))
    })
}

fn microseconds(total: Duration, batch: usize) -> f64 {
    total.as_secs_f64() * 1e6 / batch as f64
}
