//! What is asked of a live model between edits: which face a ray meets, measures, and what a renderer draws.

use std::hint::black_box;
use std::time::{Duration, Instant};

use planecut_csg::{BrushId, LiveModel, Model, SolidMeasures, Transform, UnboundedBrushes};
use planecut_kernel::DVec3;
use planecut_testkit::edited::{capsule_grid, plate, turned_far_away};
use rand::rngs::StdRng;
use rand::{Rng, SeedableRng};
use serde::Serialize;

use super::maps::{milliseconds, quantile};

const RAYS: usize = 2000;
const EDITS: usize = 200;

/// Median times, in microseconds but for the first.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct QuestionTimes {
    pub(crate) name: String,
    pub(crate) triangles: usize,
    /// Measures that are asked for the first time, in milliseconds.
    pub(crate) first_measures_ms: f64,
    /// Measures after an edit.
    pub(crate) measures_us: f64,
    /// Buffers of the faces that an edit added.
    pub(crate) buffers_us: f64,
    /// The first face that a ray meets: the median, and 99 % of all.
    pub(crate) pick_us: f64,
    pub(crate) pick_p99_us: f64,
    /// How many of the rays meet something.
    pub(crate) hits: usize,
}

/// Questions to plates, grids, and the maps that are given.
pub(crate) fn measure(is_quick: bool, maps: &[(String, Model)]) -> Result<Vec<QuestionTimes>, String> {
    let (plates, grids): (&[u32], &[u32]) = if is_quick { (&[12], &[6]) } else { (&[12, 24, 48], &[8, 16]) };
    let mut all = Vec::new();
    for side in plates {
        all.push(ask(format!("{side} × {side} holes"), &plate(*side))?);
        all.push(ask(format!("{side} × {side} holes, turned, far away"), &turned_far_away(&plate(*side)))?);
    }
    for side in grids {
        all.push(ask(format!("{side}³ capsules"), &capsule_grid(*side))?);
    }
    for (name, model) in maps {
        all.push(ask(format!("`{name}`"), model)?);
    }
    Ok(all)
}

fn ask(name: String, model: &Model) -> Result<QuestionTimes, String> {
    let live = LiveModel::from_model_with(model.clone(), UnboundedBrushes::LeaveOut);
    let mut live = live.map_err(|error| error.to_string())?;
    let mut random = StdRng::seed_from_u64(4);
    let begin = Instant::now();
    let solid = live.measures();
    let first_measures_ms = milliseconds(begin.elapsed());
    let (mut measures, mut buffers, mut picks) = (Vec::new(), Vec::new(), Vec::new());
    let brushes: Vec<BrushId> = live.brushes().collect();
    let size = (solid.max - solid.min).max_element();
    for _ in 0..EDITS {
        let brush = brushes[random.random_range(0..brushes.len())];
        let shift = Transform::translation(DVec3::new(1e-3, 2e-3, 3e-3) * size.min(10.0));
        let change = live.transform_brush(brush, &shift.map_err(|error| error.to_string())?);
        let change = change.map_err(|error| format!("{name}: {error}"))?;
        let begin = Instant::now();
        black_box(live.measures());
        measures.push(begin.elapsed());
        let begin = Instant::now();
        black_box(live.buffers(&change.added, solid.centroid));
        buffers.push(begin.elapsed());
        live.undo().map_err(|error| format!("{name}: {error}"))?;
    }
    let mut hits = 0;
    for _ in 0..RAYS {
        let (origin, direction) = ray(&solid, &mut random);
        let begin = Instant::now();
        hits += usize::from(black_box(live.pick(origin, direction)).is_some());
        picks.push(begin.elapsed());
    }
    let us = |times: &mut Vec<Duration>, share: f64| 1e6 * quantile(times, share).as_secs_f64();
    Ok(QuestionTimes {
        name,
        triangles: live.triangle_count(),
        first_measures_ms,
        measures_us: us(&mut measures, 0.5),
        buffers_us: us(&mut buffers, 0.5),
        pick_us: us(&mut picks, 0.5),
        pick_p99_us: us(&mut picks, 0.99),
        hits,
    })
}

/// From somewhere around a solid to somewhere in its box.
fn ray(solid: &SolidMeasures, random: &mut StdRng) -> (DVec3, DVec3) {
    let mut point = |reach: f64| {
        let share = DVec3::from_array(std::array::from_fn(|_| random.random_range(-reach..reach)));
        0.5 * (solid.min + solid.max) + share * (solid.max - solid.min).max_element()
    };
    let (origin, place) = (point(1.5), point(0.5));
    (origin, place.clamp(solid.min, solid.max) - origin)
}
