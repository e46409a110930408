//! Trees some of whose leaves are closed meshes: no leaf is cut into convex cells.

use super::{EvaluateError, Evaluation, ModelSummary, StageTimes, UnboundedBrushes, evaluate_among};
use crate::arrangement::{CombinedMeshes, Inside, combine_meshes};
use crate::base::Clock;
use crate::body::BuiltBodies;
use crate::closed_mesh::ClosedMesh;
use crate::model::{Brush, MeshBody, Model, Operation, Tree, TreeNode};
use planecut_kernel::sign::Counts;

/// The solid of a tree some of whose leaves are closed meshes.
pub(super) fn evaluate_meshes(
    model: &Model,
    unbounded: UnboundedBrushes,
    built: &BuiltBodies,
    size: f64,
) -> Result<Evaluation, EvaluateError> {
    let begin = Clock::start();
    let mut meshes = Vec::new();
    for brush in model.tree.brushes() {
        meshes.push(match &brush.mesh {
            Some(mesh) => mesh.clone(),
            None => of_brush(model, brush, unbounded, built, size)?,
        });
    }
    let holds = |inside: &Inside<'_>| holds(model.tree.nodes(), |leaf| inside.of(leaf));
    let CombinedMeshes { mesh, solid, noise } = combine_meshes(&meshes, model.materials.clone(), holds)?;
    let summary = ModelSummary { brushes: meshes.len(), ..ModelSummary::default() };
    let times = StageTimes { evaluate: begin.elapsed(), ..StageTimes::default() };
    Ok(Evaluation { mesh, solid, noise, model: summary, signs: Counts::default(), times })
}

fn of_brush(
    model: &Model,
    brush: &Brush,
    unbounded: UnboundedBrushes,
    built: &BuiltBodies,
    size: f64,
) -> Result<MeshBody, EvaluateError> {
    let model = Model { materials: model.materials.clone(), tree: Tree::from(brush.clone()) };
    let mesh = evaluate_among(&model, unbounded, built, size)?.mesh;
    let closed =
        ClosedMesh::new(&mesh.positions, &mesh.triangles, |t| mesh.faces[mesh.triangle_faces[t] as usize].material.0);
    let materials = (0..).map(crate::model::MaterialId).take(model.materials.len()).collect();
    Ok(MeshBody::new(closed.expect("the boundary of a body is closed"), materials))
}

/// Whether a tree holds a point that lies in some of its leaves.
fn holds(nodes: &[TreeNode], is_in: impl Fn(usize) -> bool) -> bool {
    let mut values: Vec<bool> = Vec::new();
    let mut leaf = 0;
    for node in nodes {
        let TreeNode::Operation { operation, operands } = node else {
            values.push(is_in(leaf));
            leaf += 1;
            continue;
        };
        let operands = values.split_off(values.len() - *operands as usize);
        values.push(match operation {
            Operation::Union => operands.contains(&true),
            Operation::Intersection => !operands.contains(&false),
            Operation::Difference => {
                operands.split_first().is_some_and(|(first, others)| *first && !others.contains(&true))
            }
            Operation::Xor => operands.iter().filter(|value| **value).count() % 2 == 1,
            Operation::Complement => !operands.contains(&true),
        });
    }
    values.pop().expect("a root")
}
