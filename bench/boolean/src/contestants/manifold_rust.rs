//! manifold-rust: the port of Manifold, its trees of many operands where there is one, else its binary operations.

use std::time::Instant;

use manifold_rust::csg_tree::{CsgLeafNode, CsgNode};
use manifold_rust::manifold::Manifold;
use manifold_rust::types::{Error, MeshGL64, OpType};

use super::{Contestant, Outcome, begun};
use crate::scene::{Action, Body, Entry, Plan, Scene};

pub(super) struct ManifoldRust {
    bodies: Vec<Manifold>,
    /// The same bodies, shared and not copied.
    leaves: Vec<CsgLeafNode>,
    plan: Plan,
}

impl ManifoldRust {
    pub(super) fn new(scene: Scene) -> Result<Self, String> {
        let bodies: Vec<Manifold> = scene.bodies.iter().map(manifold).collect::<Result<_, _>>()?;
        let leaf = |body: &Manifold| CsgLeafNode::new(body.as_impl().clone());
        let unite = |model: &[Manifold]| Ok(union_of(model.iter().map(leaf)));
        let (plan, bodies) = begun(scene.plan, bodies, unite)?;
        let leaves = bodies.iter().map(leaf).collect();
        Ok(Self { bodies, leaves, plan })
    }

    fn result(&self) -> Manifold {
        match &self.plan {
            Plan::Tree(entries) => self.tree(entries),
            Plan::Steps(steps) => steps.iter().fold(Manifold::empty(), |solid, (action, body)| {
                let body = &self.bodies[*body as usize];
                match action {
                    Action::Add => solid.boolean(body, OpType::Add),
                    Action::Subtract => solid.boolean(body, OpType::Subtract),
                }
            }),
            Plan::Moves(count) => {
                let unions = Scene::moves(&self.leaves, *count).map(|leaves| union_of(leaves.cloned()));
                unions.last().unwrap_or_else(Manifold::empty)
            }
            Plan::Cuts(_) => unreachable!("its union was made before"),
        }
    }

    fn tree(&self, entries: &[Entry]) -> Manifold {
        let mut stack: Vec<CsgNode> = Vec::new();
        let mut leaves = self.leaves.iter();
        for entry in entries {
            let (operation, count) = match entry {
                Entry::Leaf => {
                    stack.extend(leaves.next().cloned().map(CsgNode::leaf_node));
                    continue;
                }
                Entry::Union(count) => (OpType::Add, count),
                Entry::Difference(count) => (OpType::Subtract, count),
                Entry::Intersection(count) => (OpType::Intersect, count),
            };
            let operands = stack.split_off(stack.len() - *count as usize);
            stack.push(CsgNode::op_n(operation, operands));
        }
        let Some(root) = stack.pop() else { return Manifold::empty() };
        Manifold::from_impl(root.evaluate())
    }
}

fn union_of(leaves: impl Iterator<Item = CsgLeafNode>) -> Manifold {
    Manifold::from_impl(CsgNode::op_n(OpType::Add, leaves.map(CsgNode::leaf_node).collect()).evaluate())
}

fn manifold(body: &Body) -> Result<Manifold, String> {
    let mesh = MeshGL64 {
        num_prop: 3,
        vert_properties: body.positions.iter().flatten().copied().collect(),
        tri_verts: body.triangles.iter().flatten().map(|corner| u64::from(*corner)).collect(),
        ..MeshGL64::default()
    };
    let manifold = Manifold::from_mesh_gl64(&mesh);
    if manifold.status() == Error::NoError { Ok(manifold) } else { Err(format!("{:?}", manifold.status())) }
}

impl Contestant for ManifoldRust {
    fn run(&mut self) -> Result<Outcome, String> {
        let begin = Instant::now();
        let result = self.result();
        let triangles = result.num_tri();
        let seconds = begin.elapsed().as_secs_f64();
        if result.status() != Error::NoError {
            return Err(format!("{:?}", result.status()));
        }
        Ok(Outcome { seconds, volume: result.volume(), area: result.surface_area(), triangles })
    }
}
