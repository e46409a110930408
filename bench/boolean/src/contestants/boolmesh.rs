//! boolmesh: two solids at a time.

use std::time::Instant;

use boolmesh::compute_boolean;
use boolmesh::prelude::{Manifold, OpType};

use super::{Binary, Contestant, Outcome, begun, fold, halves, outcome};
use crate::scene::{Body, Plan, Scene};

pub(super) struct Boolmesh {
    bodies: Vec<Option<Manifold>>,
    plan: Plan,
}

impl Boolmesh {
    pub(super) fn new(scene: Scene) -> Result<Self, String> {
        let bodies = scene.bodies.iter().map(|body| manifold(body).map(Some)).collect::<Result<_, _>>()?;
        let (plan, bodies) = begun(scene.plan, bodies, |model| halves(model, &None, Binary::Union, &combine))?;
        Ok(Self { bodies, plan })
    }
}

fn manifold(body: &Body) -> Result<Manifold, String> {
    let positions: Vec<f64> = body.positions.iter().flatten().copied().collect();
    let corners: Vec<usize> = body.triangles.iter().flatten().map(|corner| *corner as usize).collect();
    Manifold::new(&positions, &corners)
}

/// It has no empty solid: `None` stands for that.
fn combine(a: &Option<Manifold>, b: &Option<Manifold>, operation: Binary) -> Result<Option<Manifold>, String> {
    let (Some(p), Some(q)) = (a, b) else {
        return Ok(match operation {
            Binary::Union => a.clone().or_else(|| b.clone()),
            Binary::Difference => a.clone(),
            Binary::Intersection => None,
        });
    };
    let operation = match operation {
        Binary::Union => OpType::Add,
        Binary::Difference => OpType::Subtract,
        Binary::Intersection => OpType::Intersect,
    };
    let result = compute_boolean(p, q, operation)?;
    Ok(if result.nf == 0 { None } else { Some(result) })
}

impl Contestant for Boolmesh {
    fn run(&mut self) -> Result<Outcome, String> {
        let begin = Instant::now();
        let result = fold(&self.plan, &self.bodies, &None, &combine)?;
        let time = begin.elapsed();
        let corner = |mesh: &Manifold, half: usize| {
            let position = mesh.ps[mesh.hs[half].tail];
            [position.x, position.y, position.z]
        };
        let triangles = result.iter().flat_map(|mesh| {
            (0..mesh.hs.len() / 3)
                .map(move |face| [3 * face, 3 * face + 1, 3 * face + 2].map(|half| corner(mesh, half)))
        });
        Ok(outcome(time, &triangles.collect::<Vec<_>>()))
    }
}
