//! Dragging: one plane, or one brush, goes to and fro as a user's hand moves it, in small steps and in jumps.

use std::collections::BTreeSet;
use std::f64::consts::TAU;
use std::time::{Duration, Instant};

use planecut_csg::{BrushId, Edit, LiveModel, Model, Transform, UnboundedBrushes};
use planecut_kernel::{DVec3, PlaneIdx};
use planecut_testkit::edited::{HOLE_END, PLATE, PLATE_SIDE, PLATE_TOP, plate, turned_far_away};
use rand::rngs::StdRng;
use rand::{Rng, SeedableRng};
use serde::Serialize;

use super::maps::{Times, build, compare, milliseconds, quantile};

/// Number of steps of a drag.
const STEPS: u32 = 300;
/// Number of meshes that are compared with fresh builds for each drag, where all would take too long.
const COMPARED: usize = 20;
/// A drag ends early where its edits take longer than this.
const LIMIT: Duration = Duration::from_secs(10);
/// How many of the faces of a map with the most triangles are dragged.
const FACES: usize = 3;

/// What is dragged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Handle {
    Plane(BrushId, PlaneIdx),
    Brush(BrushId),
}

/// A model of which something is dragged.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Dragged {
    pub(crate) name: String,
    pub(crate) triangles: usize,
    /// The model built from scratch: the median.
    pub(crate) fresh_ms: f64,
    pub(crate) drags: Vec<DragTimes>,
    /// Meshes that were compared with those of models built from scratch.
    pub(crate) compared: usize,
}

/// How long the edits of a drag took.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct DragTimes {
    pub(crate) name: String,
    /// To and fro in small steps.
    pub(crate) smooth: Times,
    /// From one place to any other.
    pub(crate) jumps: Times,
}

/// Drags in plates, by the number of holes a side, as they are and turned.
pub(crate) fn plates(sides: &[u32], verifies: bool) -> Result<Vec<Dragged>, String> {
    let mut all = Vec::new();
    for side in sides {
        let hole = BrushId(u64::from(1 + side / 2 * (side + 1)));
        let handles = [
            ("a side that no hole reaches", Handle::Plane(PLATE, PLATE_SIDE), 0.15),
            ("the top", Handle::Plane(PLATE, PLATE_TOP), 0.25),
            ("the end of a hole", Handle::Plane(hole, HOLE_END), 0.25),
            ("a hole", Handle::Brush(hole), 0.15),
        ];
        let handles = handles.map(|(name, handle, reach)| (name.to_owned(), handle, reach));
        for (what, model) in [("", plate(*side)), (", turned, far away", turned_far_away(&plate(*side)))] {
            let name = format!("{side} × {side} holes{what}");
            all.push(dragged(name, &model, &handles, verifies)?);
        }
    }
    Ok(all)
}

/// Drags in a map: the planes of its faces of the most triangles, the plane that is farthest from the origin, and one half as far.
pub(crate) fn map(name: &str, model: &Model, verifies: bool) -> Result<Dragged, String> {
    const REACH: f64 = 8.0;
    let live = made_live(model)?;
    let mut faces: Vec<(usize, BrushId, PlaneIdx)> = Vec::new();
    for (id, face) in live.faces() {
        faces.extend(live.source_of_face(id).map(|(brush, plane)| (face.triangles().len(), brush, plane)));
    }
    faces.sort_unstable_by_key(|(triangles, ..)| std::cmp::Reverse(*triangles));
    let mut seen = BTreeSet::new();
    let mut handles = Vec::new();
    for (triangles, brush, plane) in faces.iter().filter(|(_, brush, plane)| seen.insert((*brush, *plane))).take(FACES)
    {
        handles.push((format!("a face of {triangles} triangles"), Handle::Plane(*brush, *plane), REACH));
    }
    let mut by_distance: Vec<(f64, BrushId, PlaneIdx)> = Vec::new();
    for (_, brush, plane) in faces {
        by_distance.push((place_of(&live, brush, plane)?.1.abs(), brush, plane));
    }
    by_distance.sort_by(|a, b| a.0.total_cmp(&b.0));
    let farthest = by_distance.last().copied();
    let half_as_far = farthest.and_then(|(distance, ..)| by_distance.iter().find(|other| other.0 >= 0.5 * distance));
    for (name, plane) in [("the farthest plane", farthest.as_ref()), ("a plane half as far", half_as_far)] {
        handles.extend(plane.map(|(_, brush, plane)| (name.to_owned(), Handle::Plane(*brush, *plane), REACH)));
    }
    dragged(name.to_owned(), model, &handles, verifies)
}

fn dragged(name: String, model: &Model, handles: &[(String, Handle, f64)], verifies: bool) -> Result<Dragged, String> {
    let fresh: Result<Vec<_>, String> = (0..3).map(|_| Ok(build(model)?.0)).collect();
    let fresh_ms = milliseconds(quantile(&mut fresh?, 0.5));
    let mut live = made_live(model)?;
    let first = live.mesh().map_err(|error| error.to_string())?;
    let smooth: Vec<f64> = (1..=STEPS).map(|k| (TAU * f64::from(k) / f64::from(STEPS)).sin()).collect();
    let mut random = StdRng::seed_from_u64(3);
    // and back to where it was
    let jumps: Vec<f64> = (1..STEPS).map(|_| random.random_range(-1.0..1.0)).chain([0.0]).collect();
    let mut compared = 0;
    let mut drags = Vec::new();
    for (name, handle, reach) in handles {
        let mut times = |places: &[f64]| {
            // what is compared was not on the clock: building from scratch takes away what is at hand
            let times = drag(&mut live, *handle, *reach, places, fresh_ms, |_, _| Ok(()))?;
            if verifies {
                drag(&mut live, *handle, *reach, places, fresh_ms, |live, step| {
                    if !step.is_multiple_of(places.len() / COMPARED) {
                        return Ok(());
                    }
                    compared += 1;
                    compare(live, name)
                })?;
            }
            Ok::<_, String>(times)
        };
        drags.push(DragTimes { name: name.clone(), smooth: times(&smooth)?, jumps: times(&jumps)? });
    }
    Ok(Dragged { name, triangles: first.triangles.len(), fresh_ms, drags, compared })
}

fn made_live(model: &Model) -> Result<LiveModel, String> {
    LiveModel::from_model_with(model.clone(), UnboundedBrushes::LeaveOut).map_err(|error| error.to_string())
}

/// Drags something along x, or a plane along its normal, to one place after another, as shares of how far it goes.
fn drag(
    live: &mut LiveModel,
    handle: Handle,
    reach: f64,
    places: &[f64],
    fresh_ms: f64,
    mut look: impl FnMut(&LiveModel, usize) -> Result<(), String>,
) -> Result<Times, String> {
    let (mut times, mut before) = (Vec::with_capacity(places.len()), 0.0);
    let start = match handle {
        Handle::Plane(brush, plane) => place_of(live, brush, plane)?,
        Handle::Brush(_) => (0.0, 0.0),
    };
    // where there is no time for all places, the last one all the same: there the next drag begins
    let last = places.len().saturating_sub(1);
    for (step, place) in places.iter().enumerate() {
        if step < last && times.iter().sum::<Duration>() > LIMIT {
            continue;
        }
        let edit = match handle {
            Handle::Plane(brush, plane) => {
                Edit::MovePlane { brush, plane, offset: start.0 * (start.1 + reach * place) }
            }
            Handle::Brush(brush) => {
                let by = Transform::translation(DVec3::X * reach * (place - before));
                Edit::TransformBrush { brush, transform: by.map_err(|error| error.to_string())? }
            }
        };
        before = *place;
        let begin = Instant::now();
        live.apply(edit).map_err(|error| error.to_string())?;
        times.push(begin.elapsed());
        look(live, step)?;
    }
    Ok(Times::of("drag", times, fresh_ms))
}

/// The length of the normal of a plane, and its distance from the origin.
fn place_of(live: &LiveModel, brush: BrushId, plane: PlaneIdx) -> Result<(f64, f64), String> {
    let (body, planes) = (live.brush(brush), live.planes(brush));
    let (body, planes) = body.and_then(|body| Ok((body.0, planes?))).map_err(|error| error.to_string())?;
    let place = planes.iter().position(|other| *other == plane).ok_or("a plane that is there")?;
    let half_space = body.faces[place].half_space;
    let length = half_space.normal().length();
    Ok((length, half_space.offset() / length))
}
