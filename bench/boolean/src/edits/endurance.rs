//! Very many edits of one model: what they cost and hold at the end is what they did at the beginning.

use std::time::{Duration, Instant};

use planecut_csg::{Brush, Edit, EditError, EvaluateError, LiveModel, Material, MaterialId, Model, Tree};
use planecut_kernel::DVec3;
use serde::Serialize;

use super::draw::{Draw, Kind};
use super::maps::{milliseconds, quantile};

/// How things stand after a number of edits.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Stand {
    pub(crate) edits: usize,
    /// Resident memory.
    pub(crate) megabytes: f64,
    /// The median since the last stand.
    pub(crate) median_ms: f64,
    pub(crate) brushes: usize,
    pub(crate) triangles: usize,
}

/// A number of edits of a block with 216 holes.
pub(crate) fn measure(edits: usize) -> Result<Vec<Stand>, String> {
    const SIDE: u32 = 6;
    let holes = (0..SIDE.pow(3)).map(|k| {
        let at = DVec3::new((k % SIDE).into(), (k / SIDE % SIDE).into(), (k / SIDE.pow(2)).into());
        Tree::from(Brush::cuboid(at, at + DVec3::splat(0.6), MaterialId(0)))
    });
    let block = Brush::cuboid(DVec3::splat(-0.2), DVec3::splat(5.8), MaterialId(0));
    let tree = Tree::difference(std::iter::once(block.into()).chain(holes));
    let model = Model { materials: vec![Material::named("block")], tree };
    let mut draw = Draw::new(&model, 2);
    let mut live = LiveModel::from_model(model).map_err(|error| error.to_string())?;
    let mut times: Vec<Duration> = Vec::new();
    let mut stands = Vec::new();
    for k in 0..edits {
        let kind = Kind::ALL[k / 2 % Kind::ALL.len()];
        // each second one takes the one before back, so that the model stays about as it is
        let edit = if k % 2 == 1 { Edit::Undo } else { draw.edit(kind, &live) };
        let begin = Instant::now();
        match live.apply(edit) {
            // the block without one of its sides
            Ok(_) | Err(EditError::Evaluate(EvaluateError::Unbounded) | EditError::NothingToUndo) => {}
            Err(error) => return Err(error.to_string()),
        }
        times.push(begin.elapsed());
        if (k + 1) * 10 % edits == 0 {
            stands.push(Stand {
                edits: k + 1,
                megabytes: resident().unwrap_or(f64::NAN),
                median_ms: milliseconds(quantile(&mut times, 0.5)),
                brushes: live.brushes().len(),
                triangles: live.triangle_count(),
            });
            times.clear();
        }
    }
    Ok(stands)
}

fn resident() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    Some(line.trim().strip_suffix("kB")?.trim().parse::<f64>().ok()? / 1024.0)
}
