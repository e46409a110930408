//! planecut: from brushes, whose bodies are there as the others' are or else are built within it, to a welded, triangulated mesh.
//! What is done one by one is done to a live model, whose mesh is in memory after each step, face by face.

use std::time::Instant;

use planecut_csg::{Brush, BrushId, BuiltBodies, LiveModel, Material, Model, Role, UnboundedBrushes, evaluate_built};
use planecut_kernel::DVec3;

use super::{Contestant, Outcome};
use crate::scene::{Action, Body, Plan, Scene};

pub(super) struct Planecut {
    task: Task,
    /// The bodies that are built before the clock starts.
    built: BuiltBodies,
}

enum Task {
    AtOnce(Model),
    Steps(Vec<(Brush, Role)>),
    /// A model, the brush that is moved, and its forms.
    Moves(Box<LiveModel>, BrushId, Vec<Brush>),
    /// The brushes of a model that is live before the clock starts, and those that are taken from it.
    Cuts(Vec<Brush>, Vec<Brush>),
}

fn materials() -> Vec<Material> {
    vec![Material::named("all")]
}

impl Planecut {
    /// With all bodies built before the clock starts.
    pub(super) fn with_bodies(scene: &Scene) -> Result<Self, String> {
        let mut planecut = Self::new(scene)?;
        planecut.built = match &planecut.task {
            Task::AtOnce(model) => BuiltBodies::of(model.tree.brushes()),
            Task::Steps(steps) => BuiltBodies::of(steps.iter().map(|(brush, _)| brush)),
            Task::Moves(_, _, forms) => BuiltBodies::of(forms),
            Task::Cuts(_, tools) => BuiltBodies::of(tools),
        };
        if let Task::Moves(live, _, _) = &mut planecut.task {
            live.set_built_bodies(planecut.built.clone());
        }
        Ok(planecut)
    }

    pub(super) fn new(scene: &Scene) -> Result<Self, String> {
        Ok(Self { task: Task::new(scene)?, built: BuiltBodies::default() })
    }
}

impl Task {
    fn new(scene: &Scene) -> Result<Self, String> {
        match &scene.plan {
            Plan::Tree(entries) => Ok(Self::AtOnce(Model { materials: materials(), tree: scene.tree(entries) })),
            Plan::Steps(steps) => {
                let step = |(action, body): &(Action, u32)| {
                    let role = match action {
                        Action::Add => Role::Add,
                        Action::Subtract => Role::Subtract,
                    };
                    (scene.bodies[*body as usize].brush(), role)
                };
                Ok(Self::Steps(steps.iter().map(step).collect()))
            }
            Plan::Moves(count) => {
                let (model, forms) = scene.bodies.split_at(*count as usize);
                let mut live = LiveModel::new(materials());
                let brushes = model.iter().map(|body| (body.brush(), Role::Add)).collect();
                let (ids, _) = live.add_brushes(brushes).map_err(|error| error.to_string())?;
                let first = *ids.first().ok_or("no brush to move")?;
                Ok(Self::Moves(Box::new(live), first, forms.iter().map(Body::brush).collect()))
            }
            Plan::Cuts(count) => {
                let (model, tools) = scene.bodies.split_at(*count as usize);
                let [model, tools] = [model, tools].map(|bodies| bodies.iter().map(Body::brush).collect());
                Ok(Self::Cuts(model, tools))
            }
        }
    }
}

impl Contestant for Planecut {
    fn run(&mut self) -> Result<Outcome, String> {
        match &mut self.task {
            Task::AtOnce(model) => {
                let begin = Instant::now();
                let evaluation =
                    evaluate_built(model, UnboundedBrushes::Keep, &self.built).map_err(|error| error.to_string())?;
                let seconds = begin.elapsed().as_secs_f64();
                Ok(Outcome {
                    seconds,
                    volume: evaluation.solid.volume,
                    area: evaluation.solid.area,
                    triangles: evaluation.mesh.triangles.len(),
                })
            }
            Task::Steps(steps) => {
                let steps = steps.clone();
                let begin = Instant::now();
                let mut live = LiveModel::new(materials());
                live.set_built_bodies(self.built.clone());
                for (brush, role) in steps {
                    live.add_brush(brush, role).map_err(|error| error.to_string())?;
                }
                Ok(outcome(&live, begin.elapsed().as_secs_f64()))
            }
            Task::Moves(live, moved, forms) => {
                let forms = forms.clone();
                let (before, _) = live.brush(*moved).map_err(|error| error.to_string())?;
                let before = before.clone();
                let begin = Instant::now();
                for form in forms {
                    live.replace_brush(*moved, form).map_err(|error| error.to_string())?;
                }
                let outcome = outcome(live, begin.elapsed().as_secs_f64());
                live.replace_brush(*moved, before).map_err(|error| error.to_string())?;
                Ok(outcome)
            }
            Task::Cuts(model, tools) => {
                let mut live = LiveModel::new(materials());
                let brushes = model.iter().map(|brush| (brush.clone(), Role::Add)).collect();
                live.add_brushes(brushes).map_err(|error| error.to_string())?;
                live.set_built_bodies(self.built.clone());
                let tools = tools.clone();
                let begin = Instant::now();
                for tool in tools {
                    live.add_brush(tool, Role::Subtract).map_err(|error| error.to_string())?;
                }
                Ok(outcome(&live, begin.elapsed().as_secs_f64()))
            }
        }
    }
}

fn outcome(live: &LiveModel, seconds: f64) -> Outcome {
    let (mut volume, mut area) = (0.0, 0.0);
    for triangle in live.faces().flat_map(|(_, face)| face.triangles()) {
        let [a, b, c]: [DVec3; 3] = triangle.map(|corner| corner.1);
        let normal = (b - a).cross(c - a);
        volume += a.dot(normal) / 6.0;
        area += 0.5 * normal.length();
    }
    Outcome { seconds, volume, area, triangles: live.triangle_count() }
}
