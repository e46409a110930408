//! planecut block by block: each block's mesh is measured and dropped, as one that is written to a file would be.

use std::time::Instant;

use planecut_csg::{Block, BlockOptions, Material, Model, evaluate_in_blocks};

use super::{Contestant, Outcome};
use crate::scene::{Plan, Scene};

pub(super) struct PlanecutBlocks {
    model: Model,
}

impl PlanecutBlocks {
    pub(super) fn new(scene: &Scene) -> Result<Self, String> {
        let Plan::Tree(entries) = &scene.plan else { return Err("it knows no steps".to_owned()) };
        Ok(Self { model: Model { materials: vec![Material::named("all")], tree: scene.tree(entries) } })
    }
}

impl Contestant for PlanecutBlocks {
    fn run(&mut self) -> Result<Outcome, String> {
        let begin = Instant::now();
        let mut area = 0.0;
        let take = |Block { mesh, .. }: Block| {
            let corners = mesh.triangles.iter().map(|triangle| triangle.map(|vertex| mesh.positions[vertex as usize]));
            area += corners.map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).sum::<f64>();
            Ok::<(), String>(())
        };
        let all = evaluate_in_blocks(&self.model, BlockOptions::default(), take).map_err(|error| error.to_string())?;
        let seconds = begin.elapsed().as_secs_f64();
        if all.open_edges > 0 {
            return Err(format!("{} edges on walls are open", all.open_edges));
        }
        Ok(Outcome { seconds, volume: all.volume, area, triangles: all.triangles })
    }
}
