//! planecut: brushes to a welded, triangulated mesh, the building of the brushes' bodies included.

use std::time::Instant;

use planecut_csg::{Material, Model, evaluate};

use super::{Contestant, Outcome};
use crate::scene::{Plan, Scene};

pub(super) struct Planecut {
    model: Option<Model>,
}

impl Planecut {
    pub(super) fn new(scene: &Scene) -> Self {
        let materials = vec![Material::named("all")];
        match &scene.plan {
            Plan::Tree(entries) => Self { model: Some(Model { materials, tree: scene.tree(entries) }) },
            Plan::Steps(_) => Self { model: None },
        }
    }
}

impl Contestant for Planecut {
    fn run(&mut self) -> Result<Outcome, String> {
        let model = self.model.as_ref().ok_or("not yet")?;
        let begin = Instant::now();
        let evaluation = evaluate(model).map_err(|error| error.to_string())?;
        let seconds = begin.elapsed().as_secs_f64();
        Ok(Outcome {
            seconds,
            volume: evaluation.solid.volume,
            area: evaluation.solid.area,
            triangles: evaluation.mesh.triangles.len(),
        })
    }
}
