//! A grid of capsules taken from a block: what an edit of one of them costs as the grid grows.

use std::time::{Duration, Instant};

use planecut_csg::{Brush, BrushId, LiveModel, Material, MaterialId, Role, Transform};
use planecut_kernel::{DVec3, HalfSpace};
use serde::Serialize;

use super::maps::{milliseconds, quantile};

const EDITS: u32 = 400;

/// a grid with a number of capsules a side.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct GridTimes {
    pub(crate) side: u32,
    pub(crate) capsules: usize,
    pub(crate) triangles: usize,
    /// The whole grid as one edit.
    pub(crate) first_ms: f64,
    /// A capsule moved.
    pub(crate) median_ms: f64,
    pub(crate) p99_ms: f64,
}

pub(crate) fn measure(sides: &[u32]) -> Result<Vec<GridTimes>, String> {
    sides.iter().map(|side| grid(*side).map_err(|error| error.to_string())).collect()
}

fn grid(side: u32) -> Result<GridTimes, planecut_csg::EditError> {
    let places =
        (0..side.pow(3)).map(|k| DVec3::new((k % side).into(), (k / side % side).into(), (k / side.pow(2)).into()));
    let block = Brush::cuboid(DVec3::splat(-1.0), DVec3::splat(f64::from(side)), MaterialId(0));
    let brushes = std::iter::once((block, Role::Add)).chain(places.map(|at| (capsule(at), Role::Subtract)));
    let mut live = LiveModel::new(vec![Material::named("block")]);
    let begin = Instant::now();
    let (ids, _) = live.add_brushes(brushes.collect())?;
    let first_ms = milliseconds(begin.elapsed());
    let mut times: Vec<Duration> = Vec::new();
    for k in 0..EDITS {
        // everywhere in the grid, to and fro
        let BrushId(moved) = ids[1 + (k as usize / 2 * 7919) % (ids.len() - 1)];
        let by = if k % 2 == 0 { DVec3::new(0.1, 0.05, 0.2) } else { DVec3::new(-0.1, -0.05, -0.2) };
        let begin = Instant::now();
        live.transform_brush(BrushId(moved), &Transform::translation(by)?)?;
        times.push(begin.elapsed());
    }
    Ok(GridTimes {
        side,
        capsules: ids.len() - 1,
        triangles: live.triangle_count(),
        first_ms,
        median_ms: milliseconds(quantile(&mut times, 0.5)),
        p99_ms: milliseconds(quantile(&mut times, 0.99)),
    })
}

/// 60 planes around a segment.
fn capsule(at: DVec3) -> Brush {
    const COUNT: u32 = 60;
    let tangent = |k: u32| {
        let z = 1.0 - (2.0 * f64::from(k) + 1.0) / f64::from(COUNT);
        let (sine, cosine) = (f64::from(k) * std::f64::consts::PI * (3.0 - 5.0_f64.sqrt())).sin_cos();
        let normal = DVec3::new((1.0 - z * z).sqrt() * cosine, (1.0 - z * z).sqrt() * sine, z);
        let end = DVec3::new(0.0, 0.0, 0.25_f64.copysign(z));
        HalfSpace::new(normal, normal.dot(at + end) + 0.2).expect("a unit normal")
    };
    Brush::from_half_spaces((0..COUNT).map(tangent), MaterialId(0))
}
