//! planecut: brushes to a welded, triangulated mesh, the building of the brushes' bodies included. What is done one by one is
//! done to a live model, whose mesh is in memory after each step, face by face.

use std::time::Instant;

use planecut_csg::{Brush, LiveModel, Material, Model, Role, evaluate};
use planecut_kernel::DVec3;

use super::{Contestant, Outcome};
use crate::scene::{Action, Plan, Scene};

pub(super) enum Planecut {
    AtOnce(Model),
    Steps(Vec<(Brush, Role)>),
}

fn materials() -> Vec<Material> {
    vec![Material::named("all")]
}

impl Planecut {
    pub(super) fn new(scene: &Scene) -> Self {
        match &scene.plan {
            Plan::Tree(entries) => Self::AtOnce(Model { materials: materials(), tree: scene.tree(entries) }),
            Plan::Steps(steps) => {
                let step = |(action, body): &(Action, u32)| {
                    let role = match action {
                        Action::Add => Role::Add,
                        Action::Subtract => Role::Subtract,
                    };
                    (scene.bodies[*body as usize].brush(), role)
                };
                Self::Steps(steps.iter().map(step).collect())
            }
        }
    }
}

impl Contestant for Planecut {
    fn run(&mut self) -> Result<Outcome, String> {
        match self {
            Self::AtOnce(model) => {
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
            Self::Steps(steps) => {
                let steps = steps.clone();
                let begin = Instant::now();
                let mut live = LiveModel::new(materials());
                for (brush, role) in steps {
                    live.add_brush(brush, role).map_err(|error| error.to_string())?;
                }
                let seconds = begin.elapsed().as_secs_f64();
                let (mut volume, mut area) = (0.0, 0.0);
                for [a, b, c] in live.faces().flat_map(|(_, face)| face.triangles()).map(|t| t.map(|corner| corner.1)) {
                    let (a, normal): (DVec3, DVec3) = (a, (b - a).cross(c - a));
                    volume += a.dot(normal) / 6.0;
                    area += 0.5 * normal.length();
                }
                Ok(Outcome { seconds, volume, area, triangles: live.triangle_count() })
            }
        }
    }
}
