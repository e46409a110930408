//! From a model to its solid's mesh, stage by stage, with what each stage counted.

use std::time::{Duration, Instant};

use glam::DVec3;
use planecut_kernel::sign::Counts;

use crate::body::{Body, BrushBody, build_bodies};
use crate::brush::Model;
use crate::mesh::Mesh;
use crate::skin::skin_of_union;
use crate::weld::{WeldError, Welded, weld};

/// What a model holds.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ModelSummary {
    /// Brushes, all of them.
    pub brushes: usize,
    /// Different planes, both sides counting once.
    pub planes: usize,
    /// Numbers of the brushes without interior.
    pub empty: Vec<usize>,
    /// Numbers of the brushes that are not bounded; they are left out.
    pub unbounded: Vec<usize>,
    /// Planes of bounded brushes that have no face.
    pub redundant_planes: usize,
    /// Different planes replaced by one that was nearly the same.
    pub snapped_planes: usize,
    /// The sum of the volumes of the brushes.
    pub brush_volume_sum: f64,
}

/// Measures of a solid, taken from its boundary before triangulation; lengths in the input's units.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SolidMeasures {
    /// Volume.
    pub volume: f64,
    /// Area of the boundary.
    pub area: f64,
    /// Centroid; the origin for an empty solid.
    pub centroid: DVec3,
    /// Smallest coordinates; the origin for an empty solid.
    pub min: DVec3,
    /// Largest coordinates; the origin for an empty solid.
    pub max: DVec3,
}

/// How long each stage took.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct StageTimes {
    /// Plane table, bodies and skin.
    pub evaluate: Duration,
    /// From boundary edges to closed, paired loops.
    pub weld: Duration,
    /// From loops to triangles.
    pub triangulate: Duration,
}

/// The solid of a model.
#[derive(Debug, Clone, PartialEq)]
pub struct Evaluation {
    /// Its boundary.
    pub mesh: Mesh,
    /// Its measures.
    pub solid: SolidMeasures,
    /// What the model held.
    pub model: ModelSummary,
    /// The signs that were asked for.
    pub signs: Counts,
    /// Where the time went.
    pub times: StageTimes,
}

/// Counts planes and brushes and finds empty and unbounded ones, without evaluating the union.
#[must_use]
pub fn summarize(model: &Model) -> ModelSummary {
    let (table, bodies, _) = build_bodies(model);
    split_bodies(table.len(), table.snapped(), bodies).0
}

/// The union of a model's brushes as a watertight mesh. Unbounded and empty brushes are left out and counted.
///
/// Runs on rayon's current thread pool; the outcome does not depend on the number of threads, nor, where materials of
/// overlapping coplanar faces agree, on the order of the brushes.
///
/// # Errors
/// [`WeldError`] where the boundary does not close: a bug in this crate, never the user's mistake.
pub fn evaluate(model: &Model) -> Result<Evaluation, WeldError> {
    let begin = Instant::now();
    let (table, bodies, mut signs) = build_bodies(model);
    let (summary, bodies) = split_bodies(table.len(), table.snapped(), bodies);
    let rank = material_ranks(model);
    let (edges, counted) = skin_of_union(&table, &bodies, &rank);
    signs += counted;
    let evaluated = Instant::now();
    let Welded { mesh, solid, signs: counted, triangulation } = weld(&table, &edges, &rank, &model.materials)?;
    signs += counted;
    let times = StageTimes {
        evaluate: evaluated - begin,
        weld: evaluated.elapsed().saturating_sub(triangulation),
        triangulate: triangulation,
    };
    Ok(Evaluation { mesh, solid, model: summary, signs, times })
}

fn split_bodies(planes: usize, snapped_planes: usize, brushes: Vec<BrushBody>) -> (ModelSummary, Vec<Body>) {
    let mut summary = ModelSummary { brushes: brushes.len(), planes, snapped_planes, ..ModelSummary::default() };
    let mut bodies = Vec::with_capacity(brushes.len());
    for (number, brush) in brushes.into_iter().enumerate() {
        match brush {
            BrushBody::Bounded(body, redundant) => {
                summary.redundant_planes += redundant;
                summary.brush_volume_sum += body.volume;
                bodies.push(body);
            }
            BrushBody::Empty => summary.empty.push(number),
            BrushBody::Unbounded => summary.unbounded.push(number),
        }
    }
    (summary, bodies)
}

/// The place of each material by name: an order that does not depend on that of the brushes.
fn material_ranks(model: &Model) -> Vec<u32> {
    let mut order: Vec<usize> = (0..model.materials.len()).collect();
    order.sort_by(|a, b| model.materials[*a].name.cmp(&model.materials[*b].name));
    let mut rank = vec![0; order.len()];
    for (place, material) in order.into_iter().enumerate() {
        rank[material] = place as u32;
    }
    rank
}
