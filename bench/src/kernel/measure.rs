//! The rounds: every round visits every case, so that a slow moment of the machine falls on all of them.

use crate::plan::Case;
use crate::report::Line;
use std::time::{Duration, Instant};

/// How long a case is sampled in one round; one sample is always taken.
const SLICE: Duration = Duration::from_millis(10);

/// Samples of polytopes with this many planes fill a large part of the caches: they are taken after a while.
const LARGE: usize = 10_000;
const WARM_UP: Duration = Duration::from_millis(30);

/// All samples of all cases.
///
/// # Errors
/// The first result that went wrong while it was timed.
pub(crate) fn run(mut cases: Vec<Case>, rounds: usize) -> Result<Vec<Line>, String> {
    let mut samples: Vec<Vec<Vec<f64>>> = cases.iter().map(|case| vec![Vec::new(); case.operations.len()]).collect();
    // The first round warms caches and buffers up and is not kept.
    for round in 0..=rounds {
        for (case, samples) in cases.iter_mut().zip(&mut samples) {
            let start = Instant::now();
            let warm_up = if case.size < LARGE { Duration::ZERO } else { WARM_UP };
            // The first samples find the caches full of other cases; where there is time for another they are not kept.
            let mut times = (case.sampler)()?;
            let mut keep = start.elapsed() >= warm_up + SLICE;
            loop {
                if keep && round > 0 {
                    samples.iter_mut().zip(&times).for_each(|(samples, time)| samples.push(*time));
                }
                if keep && start.elapsed() >= warm_up + SLICE {
                    break;
                }
                keep = start.elapsed() >= warm_up;
                times = (case.sampler)()?;
            }
        }
    }
    let mut lines = Vec::new();
    for (case, samples) in cases.into_iter().zip(samples) {
        for (operation, samples) in case.operations.into_iter().zip(samples) {
            lines.push(Line { operation, size: case.size, library: case.library, samples });
        }
    }
    Ok(lines)
}
