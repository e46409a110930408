//! Edits of one brush of many planes: what a kept polytope takes beside one that is built from all planes.

use std::time::{Duration, Instant};

use planecut_csg::{Brush, BrushId, EditError, LiveModel, Material, MaterialId, Role};
use planecut_kernel::{DVec3, HalfSpace, IncrementalPolytope};
use serde::Serialize;

use super::maps::quantile;

/// Numbers of planes around a ball.
const PLANES: [u32; 7] = [6, 12, 30, 100, 500, 2000, 5000];

/// Median times in microseconds.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct BodyTimes {
    pub(crate) planes: u32,
    /// The polytope alone: cleared, and all planes added.
    pub(crate) rebuild_us: f64,
    /// The polytope alone: one plane added, moved, removed.
    pub(crate) kernel_us: [f64; 3],
    /// All facets of the polytope listed.
    pub(crate) facets_us: f64,
    /// The whole edit of a live model: a plane added, moved, removed.
    pub(crate) edit_us: [f64; 3],
    /// The brush replaced by one with one plane more, whose body is built from all planes.
    pub(crate) replace_us: f64,
}

/// Edits of one brush of each number of planes.
pub(crate) fn measure(is_quick: bool) -> Result<Vec<BodyTimes>, String> {
    let planes = if is_quick { &PLANES[..5] } else { &PLANES };
    planes.iter().map(|planes| body(*planes).map_err(|error| error.to_string())).collect()
}

fn body(planes: u32) -> Result<BodyTimes, EditError> {
    let half_spaces: Vec<HalfSpace> = (0..planes).map(|k| tangent(k, planes)).collect();
    let rounds = (200_000 / planes).clamp(40, 1000);
    let mut polytope = IncrementalPolytope::with_epsilon(0.0);
    let (mut rebuild, mut facets) = (Vec::new(), Vec::new());
    let mut kernel = [const { Vec::new() }; 3];
    for _ in 0..rounds {
        time(&mut rebuild, || {
            polytope.clear();
            for half_space in &half_spaces {
                polytope.add_plane(*half_space);
            }
        });
    }
    for k in 0..rounds {
        let [cut, moved] = cuts(k, planes);
        let plane = time(&mut kernel[0], || polytope.add_plane(cut).plane());
        time(&mut kernel[1], || polytope.move_plane(plane, moved).is_some());
        time(&mut facets, || polytope.for_each_facet(|_, edges| _ = std::hint::black_box(edges.len())));
        time(&mut kernel[2], || polytope.remove_plane(plane).is_some());
    }
    let mut live = LiveModel::new(vec![Material::default()]);
    let brush = |planes: &[HalfSpace]| Brush::from_half_spaces(planes.iter().copied(), MaterialId(0));
    let (id, _) = live.add_brush(brush(&half_spaces), Role::Add)?;
    let (mut edit, mut replace) = ([const { Vec::new() }; 3], Vec::new());
    for k in 0..rounds {
        edit_once(&mut live, id, cuts(k, planes), &mut edit)?;
    }
    for k in 0..rounds.min(100) {
        let with_cut = brush(&[&half_spaces[..], &cuts(k, planes)[..1]].concat());
        time(&mut replace, || live.replace_brush(id, with_cut))?;
    }
    let median = |times: &mut Vec<Duration>| 1e6 * quantile(times, 0.5).as_secs_f64();
    Ok(BodyTimes {
        planes,
        rebuild_us: median(&mut rebuild),
        kernel_us: kernel.each_mut().map(median),
        facets_us: median(&mut facets),
        edit_us: edit.each_mut().map(median),
        replace_us: median(&mut replace),
    })
}

/// Adds a plane to a brush, moves and removes it.
fn edit_once(
    live: &mut LiveModel,
    brush: BrushId,
    [cut, moved]: [HalfSpace; 2],
    times: &mut [Vec<Duration>; 3],
) -> Result<(), EditError> {
    let (plane, _) = time(&mut times[0], || live.add_plane(brush, cut, MaterialId(0)))?;
    time(&mut times[1], || live.move_plane(brush, plane, moved))?;
    time(&mut times[2], || live.remove_plane(brush, plane))?;
    Ok(())
}

fn time<T>(times: &mut Vec<Duration>, work: impl FnOnce() -> T) -> T {
    let begin = Instant::now();
    let outcome = work();
    times.push(begin.elapsed());
    outcome
}

/// Plane `k` of some around a ball of radius 1, on a spiral.
fn tangent(k: u32, count: u32) -> HalfSpace {
    let height = 1.0 - (2.0 * f64::from(k) + 1.0) / f64::from(count);
    around(height, f64::from(k) * std::f64::consts::PI * (3.0 - 5.0_f64.sqrt()), 1.0)
}

/// A plane that cuts off a few vertices of such a body, and the same a little deeper.
fn cuts(k: u32, count: u32) -> [HalfSpace; 2] {
    let height = 1.0 - 2.0 * (0.618 * f64::from(k)).fract();
    [0.1, 0.08].map(|above| around(height, 2.7 * f64::from(k), 1.0 + above / f64::from(count)))
}

fn around(height: f64, angle: f64, offset: f64) -> HalfSpace {
    let (sine, cosine) = angle.sin_cos();
    let radius = (1.0 - height * height).sqrt();
    HalfSpace::new(DVec3::new(radius * cosine, radius * sine, height), offset).expect("a unit normal")
}
