//! A grid of capsules taken from a block: what an edit of one of them costs as the grid grows.

use std::time::{Duration, Instant};

use planecut_csg::{BrushId, EditError, LiveModel, Transform, evaluate};
use planecut_kernel::DVec3;
use planecut_kernel::sign::Counts;
use planecut_testkit::edited::capsule_grid;
use serde::Serialize;

use super::maps::{milliseconds, quantile};

const EDITS: u32 = 400;

/// A grid with a number of capsules a side.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct GridTimes {
    pub(crate) side: u32,
    pub(crate) capsules: usize,
    pub(crate) triangles: usize,
    /// The model built from scratch.
    pub(crate) fresh_ms: f64,
    /// The model made live.
    pub(crate) first_ms: f64,
    /// A capsule moved.
    pub(crate) median_ms: f64,
    pub(crate) p99_ms: f64,
    /// Signs that are asked for when one is moved: the mean.
    pub(crate) signs: f64,
}

pub(crate) fn measure(sides: &[u32]) -> Result<Vec<GridTimes>, String> {
    sides.iter().map(|side| grid(*side).map_err(|error| error.to_string())).collect()
}

fn grid(side: u32) -> Result<GridTimes, EditError> {
    let model = capsule_grid(side);
    let begin = Instant::now();
    let fresh = evaluate(&model)?;
    let fresh_ms = milliseconds(begin.elapsed());
    let capsules = model.tree.brushes().len() - 1;
    let begin = Instant::now();
    let mut live = LiveModel::from_model(model)?;
    let first_ms = milliseconds(begin.elapsed());
    assert_eq!(live.triangle_count(), fresh.mesh.triangles.len(), "a grid of {side}");
    let mut times: Vec<Duration> = Vec::new();
    for k in 0..EDITS {
        let begin = Instant::now();
        move_one(&mut live, side, k)?;
        times.push(begin.elapsed());
    }
    let signs = signs_of_edits(&mut live, side)?.total as f64 / f64::from(EDITS);
    Ok(GridTimes {
        side,
        capsules,
        triangles: live.triangle_count(),
        fresh_ms,
        first_ms,
        median_ms: milliseconds(quantile(&mut times, 0.5)),
        p99_ms: milliseconds(quantile(&mut times, 0.99)),
        signs,
    })
}

/// Edit `k`: capsules everywhere in the grid move to and fro.
fn move_one(live: &mut LiveModel, side: u32, k: u32) -> Result<(), EditError> {
    let moved = BrushId(1 + u64::from(k / 2 * 7919 % side.pow(3)));
    let by = if k.is_multiple_of(2) { DVec3::new(0.1, 0.05, 0.2) } else { DVec3::new(-0.1, -0.05, -0.2) };
    live.transform_brush(moved, &Transform::translation(by)?)?;
    Ok(())
}

/// The signs of the same edits, on the one thread that counts them.
fn signs_of_edits(live: &mut LiveModel, side: u32) -> Result<Counts, EditError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    pool.install(|| {
        let start = Counts::now();
        (0..EDITS).try_for_each(|k| move_one(live, side, k))?;
        Ok(Counts::since(start))
    })
}
