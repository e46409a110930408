//! The kernels that are timed. Each runs in a process of its own (see [`worker`]), so that one that aborts or never
//! ends takes nothing else with it, and so that its memory is its own.

mod boolmesh;
mod csgrs;
mod manifold_rust;
mod openscad;
mod planecut;
mod planecut_blocks;
mod planecut_meshes;
pub(crate) mod worker;

use std::path::Path;
use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::entrant::{PLANECUT, PLANECUT_BLOCKS, PLANECUT_PLANES};
use crate::scene::{Action, Entry, Plan, Scene};

/// What one run gave.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct Outcome {
    /// Time of the Booleans alone, bodies to mesh; where these are meshes, from their arrays.
    pub(crate) seconds: f64,
    /// Volume of the last result, worked out after the clock has stopped.
    pub(crate) volume: f64,
    /// Area of the last result.
    pub(crate) area: f64,
    /// Triangles of the last result.
    pub(crate) triangles: usize,
}

/// A kernel with the bodies of a scene in its own form. A plan that it cannot follow is an error of the run.
pub(crate) trait Contestant {
    /// Does what the plan says, once.
    fn run(&mut self) -> Result<Outcome, String>;
}

/// The kernels of this program, by name. Files that one needs go beside the scene's.
pub(crate) fn prepare(name: &str, scene: Scene, file: &Path) -> Result<Box<dyn Contestant>, String> {
    match name {
        PLANECUT if scene.is_of_meshes() => Ok(Box::new(planecut_meshes::PlanecutMeshes::new(&scene)?)),
        PLANECUT => Ok(Box::new(planecut::Planecut::with_bodies(&scene)?)),
        PLANECUT_PLANES => Ok(Box::new(planecut::Planecut::new(&scene)?)),
        PLANECUT_BLOCKS => Ok(Box::new(planecut_blocks::PlanecutBlocks::new(&scene)?)),
        "manifold-rust" => Ok(Box::new(manifold_rust::ManifoldRust::new(scene)?)),
        "boolmesh" => Ok(Box::new(boolmesh::Boolmesh::new(scene)?)),
        "csgrs" => Ok(Box::new(csgrs::Csgrs::new(scene)?)),
        "openscad" => Ok(Box::new(openscad::OpenScad::new(&scene, file)?)),
        other => Err(format!("no contestant is called {other:?}")),
    }
}

/// A plan and bodies with all that is there before the clock starts: where the first bodies are united, their union takes their place.
fn begun<T: Clone>(
    plan: Plan,
    bodies: Vec<T>,
    unite: impl FnOnce(&[T]) -> Result<T, String>,
) -> Result<(Plan, Vec<T>), String> {
    let Plan::Cuts(count) = plan else { return Ok((plan, bodies)) };
    let (model, tools) = bodies.split_at(count as usize);
    let bodies: Vec<T> = std::iter::once(unite(model)?).chain(tools.iter().cloned()).collect();
    let cuts = (1..bodies.len() as u32).map(|tool| (Action::Subtract, tool));
    Ok((Plan::Steps(std::iter::once((Action::Add, 0)).chain(cuts).collect()), bodies))
}

/// Folds a plan for kernels that combine two solids at a time.
///
/// A union of many is made of halves, so that both operands of each step are about equally large. A difference takes
/// away the union of all others.
fn fold<T: Clone>(
    plan: &Plan,
    bodies: &[T],
    empty: &T,
    combine: &impl Fn(&T, &T, Binary) -> Result<T, String>,
) -> Result<T, String> {
    match plan {
        Plan::Steps(steps) => steps.iter().try_fold(empty.clone(), |solid, (action, body)| {
            let operation = match action {
                Action::Add => Binary::Union,
                Action::Subtract => Binary::Difference,
            };
            combine(&solid, &bodies[*body as usize], operation)
        }),
        Plan::Moves(count) => {
            let unions = Scene::moves(bodies, *count).map(|bodies| {
                let bodies: Vec<T> = bodies.cloned().collect();
                halves(&bodies, empty, Binary::Union, combine)
            });
            unions.last().unwrap_or_else(|| Ok(empty.clone()))
        }
        Plan::Cuts(_) => unreachable!("its union was made before"),
        Plan::Tree(entries) => {
            let mut stack: Vec<T> = Vec::new();
            let mut leaves = bodies.iter();
            for entry in entries {
                let result = match entry {
                    Entry::Leaf => leaves.next().cloned().unwrap_or_else(|| empty.clone()),
                    Entry::Union(count) => {
                        let operands = stack.split_off(stack.len() - *count as usize);
                        halves(&operands, empty, Binary::Union, combine)?
                    }
                    Entry::Intersection(count) => {
                        let operands = stack.split_off(stack.len() - *count as usize);
                        halves(&operands, empty, Binary::Intersection, combine)?
                    }
                    Entry::Difference(count) => {
                        let operands = stack.split_off(stack.len() - *count as usize);
                        match operands.split_first() {
                            None => empty.clone(),
                            Some((first, [])) => first.clone(),
                            Some((first, rest)) => {
                                combine(first, &halves(rest, empty, Binary::Union, combine)?, Binary::Difference)?
                            }
                        }
                    }
                };
                stack.push(result);
            }
            Ok(stack.pop().unwrap_or_else(|| empty.clone()))
        }
    }
}

fn halves<T: Clone>(
    operands: &[T],
    empty: &T,
    operation: Binary,
    combine: &impl Fn(&T, &T, Binary) -> Result<T, String>,
) -> Result<T, String> {
    match operands {
        [] => Ok(empty.clone()),
        [one] => Ok(one.clone()),
        many => {
            let (a, b) = many.split_at(many.len() / 2);
            combine(&halves(a, empty, operation, combine)?, &halves(b, empty, operation, combine)?, operation)
        }
    }
}

/// An operation on two solids.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Binary {
    Union,
    Difference,
    Intersection,
}

/// Volume and area of a triangle mesh.
fn measures(triangles: impl Iterator<Item = [[f64; 3]; 3]>) -> (f64, f64) {
    use planecut_kernel::DVec3;
    let (mut six, mut twice) = (0.0, 0.0);
    let mut apex = None;
    for triangle in triangles {
        let [a, b, c] = triangle.map(DVec3::from_array);
        let apex = *apex.get_or_insert(a);
        six += (a - apex).cross(b - apex).dot(c - apex);
        twice += (b - a).cross(c - a).length();
    }
    (six / 6.0, 0.5 * twice)
}

fn outcome(time: Duration, triangles: &[[[f64; 3]; 3]]) -> Outcome {
    let (volume, area) = measures(triangles.iter().copied());
    Outcome { seconds: time.as_secs_f64(), volume, area, triangles: triangles.len() }
}
