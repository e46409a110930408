//! Trees some of whose leaves are closed meshes: no leaf is cut into convex cells.

use std::cell::RefCell;

use planecut_kernel::sign::Counts;

use super::deciding::deciding_leaves;
use super::{EvaluateError, Evaluation, ModelSummary, StageTimes, UnboundedBrushes, summary_of};
use crate::arrangement::{CombinedMeshes, Inside, Leaf, combine_leaves};
use crate::base::Clock;
use crate::body::{Body, BrushBodies, BrushBody, BuiltBodies, OuterBox, build_bodies, build_other_bodies};
use crate::expression::{Expression, Restriction};
use crate::ids::{Id, KeptLeafId, LeafId};
use crate::mesh::Mesh;
use crate::model::{Brush, MaterialId, Model};
use crate::plane_table::PlaneTable;

/// The solid of a tree some of whose leaves are closed meshes.
pub(super) fn evaluate_meshes(
    model: &Model,
    unbounded: UnboundedBrushes,
    built: &BuiltBodies,
    size: f64,
) -> Result<Evaluation, EvaluateError> {
    let begin = Clock::start();
    let brushes = model.tree.brushes();
    let (convex, places) = convex_ones(brushes);
    let BrushBodies { mut table, planes, bodies, signs } = build_other_bodies(&convex, built, size);
    let summary = summary_among(&table, &bodies, brushes, &places);
    let expression = Expression::new(model.tree.nodes());
    let keeps = unbounded == UnboundedBrushes::Keep && !summary.unbounded.is_empty();
    let outer = (keeps || expression.base()).then(|| OuterBox::new(&mut table));
    let bodies: Vec<Option<Body>> = bodies
        .into_iter()
        .enumerate()
        .map(|(k, body)| match (body, &outer) {
            (BrushBody::Unbounded, Some(outer)) if keeps => {
                let materials: Vec<MaterialId> = convex[k].materials().collect();
                outer.cut(&table, planes.of(k), &materials).bounded()
            }
            (body, _) => body.bounded(),
        })
        .collect();
    let mut leaves = vec![Leaf::Empty; brushes.len()];
    for (k, brush) in brushes.iter().enumerate() {
        if let Some(mesh) = &brush.mesh {
            leaves[k] = Leaf::Mesh(mesh);
        }
    }
    for (place, body) in places.iter().zip(&bodies) {
        if let Some(body) = body {
            leaves[*place] = Leaf::Body(body);
        }
    }
    // where the tree holds what no leaf holds, the box is a leaf of its own, so that it ends somewhere
    let everything = outer.filter(|_| expression.base()).and_then(|outer| outer.cut(&table, &[], &[]).bounded());
    leaves.extend(everything.as_ref().map(Leaf::Body));
    let is_boxed = everything.is_some();
    let deciding = if is_boxed { None } else { deciding_leaves(model.tree.nodes()) };
    let restriction = RefCell::new(Restriction::default());
    let count = brushes.len();
    let holds = |inside: &Inside<'_>| {
        (!is_boxed || inside.of(count)) && holds(&mut restriction.borrow_mut(), &expression, inside, count)
    };
    let combined = combine_leaves(&leaves, Some(&table), model.materials.clone(), holds, deciding.as_ref())?;
    let CombinedMeshes { mesh, solid, noise } = combined;
    if outer.is_some_and(|outer| reaches(&mesh, &table, &outer)) {
        return Err(EvaluateError::Unbounded);
    }
    let times = StageTimes { evaluate: begin.elapsed(), ..StageTimes::default() };
    let signs: Counts = signs;
    Ok(Evaluation { mesh, solid, noise, model: summary, signs, times })
}

/// What leaves hold, some of which are closed meshes.
pub(super) fn summarize(brushes: &[Brush]) -> ModelSummary {
    let (convex, places) = convex_ones(brushes);
    let BrushBodies { table, bodies, .. } = build_bodies(&convex);
    summary_among(&table, &bodies, brushes, &places)
}

/// The leaves that are convex bodies, and their places.
fn convex_ones(brushes: &[Brush]) -> (Vec<Brush>, Vec<usize>) {
    let convex = brushes.iter().zip(0..).filter(|(brush, _)| !brush.is_mesh());
    convex.map(|(brush, place)| (brush.clone(), place)).unzip()
}

/// What a model holds, brushes numbered among all leaves.
fn summary_among(table: &PlaneTable, bodies: &[BrushBody], brushes: &[Brush], places: &[usize]) -> ModelSummary {
    let mut summary = summary_of(table, bodies);
    summary.brushes = brushes.len();
    for numbers in [&mut summary.empty, &mut summary.unbounded] {
        numbers.iter_mut().for_each(|number| *number = places[*number]);
    }
    summary
}

/// Whether the tree holds the points that lie in some of the first `count` leaves, which are its own.
fn holds(restriction: &mut Restriction, expression: &Expression, inside: &Inside<'_>, count: usize) -> bool {
    let leaves: Vec<LeafId> = inside.all().filter(|leaf| *leaf < count).map(LeafId::from_index).collect();
    if leaves.is_empty() {
        return expression.base();
    }
    restriction.restrict(expression, &leaves);
    for leaf in KeptLeafId::all(leaves.len()) {
        restriction.set(expression, leaf, 0, true);
    }
    restriction.root(0)
}

/// Whether a mesh reaches the box that stands for infinity.
fn reaches(mesh: &Mesh, table: &PlaneTable, outer: &OuterBox) -> bool {
    let far = table.half_space(outer.planes()[0]).offset();
    mesh.positions.iter().any(|position| position.abs().max_element() >= far)
}
