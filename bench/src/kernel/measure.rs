//! The rounds: every round visits every case, so that a slow moment of the machine falls on all of them.

use crate::plan::Case;
use crate::report::Line;
use std::time::{Duration, Instant};

/// How long a case is sampled in one round; one sample is always taken.
const SLICE: Duration = Duration::from_millis(10);

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
            // The first sample finds the caches full of other cases; where there is time for another it is not kept.
            let mut times = (case.sampler)()?;
            let mut keep = start.elapsed() >= SLICE;
            loop {
                if keep && round > 0 {
                    samples.iter_mut().zip(&times).for_each(|(samples, time)| samples.push(*time));
                }
                if keep && start.elapsed() >= SLICE {
                    break;
                }
                times = (case.sampler)()?;
                keep = true;
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
