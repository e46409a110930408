//! Edits of maps: a number of each kind, each undone before the next.

use std::path::Path;
use std::time::{Duration, Instant};

use planecut_csg::{Edit, LiveModel, Mesh, Model, UnboundedBrushes, evaluate_with};
use planecut_import::map::{MapOptions, read_map};
use serde::Serialize;

use super::draw::{Draw, Kind};

/// How long edits took, in milliseconds.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Times {
    pub(crate) name: &'static str,
    pub(crate) edits: usize,
    pub(crate) median_ms: f64,
    pub(crate) p99_ms: f64,
    pub(crate) max_ms: f64,
    /// How often the median goes into the time of a model that is built from scratch.
    pub(crate) fresh_ratio: f64,
}

impl Times {
    pub(crate) fn of(name: &'static str, mut times: Vec<Duration>, fresh_ms: f64) -> Self {
        let [median_ms, p99_ms, max_ms] = [0.5, 0.99, 1.0].map(|share| milliseconds(quantile(&mut times, share)));
        Self { name, edits: times.len(), median_ms, p99_ms, max_ms, fresh_ratio: fresh_ms / median_ms }
    }
}

/// A map that was edited.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct MapTimes {
    pub(crate) name: String,
    pub(crate) brushes: usize,
    pub(crate) triangles: usize,
    /// The model built from scratch: the median.
    pub(crate) fresh_ms: f64,
    /// The first build of the live model.
    pub(crate) first_ms: f64,
    pub(crate) kinds: Vec<Times>,
    /// Meshes that were compared with those of models built from scratch.
    pub(crate) compared: usize,
}

/// The name of a map and what is in its file.
pub(crate) fn read(file: &Path) -> Result<(String, Model), String> {
    let name = file.file_stem().map_or(String::new(), |name| name.to_string_lossy().into_owned());
    let text = std::fs::read(file).map_err(|error| format!("{}: {error}", file.display()))?;
    let model = read_map(&text, &name, &MapOptions::default()).map_err(|error| error.to_string())?.model;
    Ok((name, model))
}

pub(crate) fn measure(file: &Path, edits: usize, verifies: bool) -> Result<MapTimes, String> {
    let (name, model) = read(file)?;
    let brushes = model.tree.brushes().len();
    let begin = Instant::now();
    let mut live = LiveModel::from_model_with(model.clone(), UnboundedBrushes::LeaveOut).map_err(|e| e.to_string())?;
    let first_ms = milliseconds(begin.elapsed());
    let first = live.mesh().map_err(|error| error.to_string())?;
    let mut fresh: Vec<Duration> = Vec::new();
    let mut of_kind: Vec<(&'static str, Vec<Duration>)> = Vec::new();
    let mut undone: Vec<Duration> = Vec::new();
    let mut draw = Draw::new(&model, 1);
    for kind in Kind::ALL {
        let [done, back] = edit(&mut live, &mut draw, kind, edits, |_, _| Ok(()))?;
        of_kind.push((kind.name(), done));
        undone.extend(back);
        fresh.push(build(&live.to_model())?.0);
        if live.mesh().map_err(|error| error.to_string())? != first {
            return Err(format!("{name}: after {} and undo the mesh is another", kind.name()));
        }
    }
    of_kind.push(("undo", undone));
    let mut compared = 0;
    if verifies {
        // the same edits again: building from scratch in between would take away what is at hand
        let mut draw = Draw::new(&model, 1);
        for kind in Kind::ALL {
            edit(&mut live, &mut draw, kind, edits, |live, shown| {
                compared += 1;
                compare(live, shown)
            })?;
        }
    }
    let fresh_ms = milliseconds(quantile(&mut fresh, 0.5));
    let kinds = of_kind.into_iter().map(|(name, times)| Times::of(name, times, fresh_ms)).collect();
    Ok(MapTimes { name, brushes, triangles: first.triangles.len(), fresh_ms, first_ms, kinds, compared })
}

/// Does edits of a kind, each undone before the next; how long each took, and each undo. `look` sees the model after each.
fn edit(
    live: &mut LiveModel,
    draw: &mut Draw,
    kind: Kind,
    edits: usize,
    mut look: impl FnMut(&LiveModel, &str) -> Result<(), String>,
) -> Result<[Vec<Duration>; 2], String> {
    let (mut done, mut undone) = (Vec::with_capacity(edits), Vec::with_capacity(edits));
    for _ in 0..edits {
        let mut edit = draw.edit(kind, live);
        // what is taken out was put in just before
        let cut = if kind == Kind::RemovePlane { Some(draw.edit(Kind::AddPlane, live)) } else { None };
        let has_cut = cut.is_some();
        if let Some(cut) = cut {
            let cut = live.apply(cut).map_err(|error| error.to_string())?;
            if let (Some(plane), Some(brush)) = (cut.plane, cut.change.brushes.first()) {
                edit = Edit::RemovePlane { brush: *brush, plane };
            }
        }
        let shown = format!("{edit:?}");
        let begin = Instant::now();
        live.apply(edit).map_err(|error| format!("{shown}: {error}"))?;
        done.push(begin.elapsed());
        look(live, &shown)?;
        let begin = Instant::now();
        live.undo().map_err(|error| format!("{shown}, undone: {error}"))?;
        undone.push(begin.elapsed());
        if has_cut {
            live.undo().map_err(|error| format!("{shown}, undone: {error}"))?;
        }
    }
    Ok([done, undone])
}

/// A model built from scratch, and how long that takes.
pub(crate) fn build(model: &Model) -> Result<(Duration, Mesh), String> {
    let begin = Instant::now();
    let evaluation = evaluate_with(model, UnboundedBrushes::LeaveOut).map_err(|error| error.to_string())?;
    Ok((begin.elapsed(), evaluation.mesh))
}

pub(crate) fn compare(live: &LiveModel, edit: &str) -> Result<(), String> {
    let (_, fresh) = build(&live.to_model())?;
    let mesh = live.mesh().map_err(|error| error.to_string())?;
    if mesh == fresh {
        Ok(())
    } else {
        Err(format!("after {edit} the mesh is not that of the model built from scratch"))
    }
}

/// The smallest time that such a share of all does not exceed.
pub(crate) fn quantile(times: &mut [Duration], share: f64) -> Duration {
    times.sort_unstable();
    let place = (share * times.len() as f64).ceil() as usize;
    times.get(place.saturating_sub(1)).copied().unwrap_or_default()
}

pub(crate) fn milliseconds(duration: Duration) -> f64 {
    1e3 * duration.as_secs_f64()
}
