//! Models for tests: building, random sweeps, shrinking, and printing as Rust.

use std::fmt::Write;
use std::panic::{AssertUnwindSafe, catch_unwind};

use glam::DVec3;
use planecut_csg::{Brush, BrushFace, Material, MaterialId, Model, Tree, summarize};
use planecut_kernel::HalfSpace;

use crate::random::Rng;

/// A plane of a test brush: normal, offset, material.
pub type Plane = ([f64; 3], f64, u32);

/// The half-space `normal·x ≤ offset`.
pub fn half_space(normal: DVec3, offset: f64) -> HalfSpace {
    HalfSpace::new(normal, offset).expect("a valid plane")
}

/// A brush of one material.
pub fn brush(half_spaces: impl IntoIterator<Item = HalfSpace>) -> Brush {
    let face = |half_space| BrushFace { half_space, material: MaterialId(0) };
    Brush { faces: half_spaces.into_iter().map(face).collect(), ..Brush::default() }
}

/// The axis-aligned box between two corners.
pub fn cuboid(low: DVec3, high: DVec3) -> Brush {
    brush((0..3).flat_map(|k| [half_space(DVec3::AXES[k], high[k]), half_space(-DVec3::AXES[k], -low[k])]))
}

/// A model of brushes and as many materials as they name. Names run backwards, so that their order is not that of the ids.
pub fn model(brushes: Vec<Brush>) -> Model {
    let used = brushes.iter().flat_map(|brush| &brush.faces).map(|face| face.material.0 + 1).max().unwrap_or(1);
    let material = |k| Material::named(format!("material {:03}", 999 - k));
    Model { materials: (0..used).map(material).collect(), tree: Tree::union_of(brushes) }
}

/// The model with another list of brushes.
pub fn with_brushes(model: &Model, change: impl FnOnce(&mut Vec<Brush>)) -> Model {
    let mut brushes = model.tree.brushes().to_vec();
    change(&mut brushes);
    Model { materials: model.materials.clone(), tree: Tree::union_of(brushes) }
}

/// A model from plain numbers, as failures are printed.
pub fn model_of(brushes: &[&[Plane]]) -> Model {
    let face = |(normal, offset, material): &Plane| BrushFace {
        half_space: half_space(DVec3::from_array(*normal), *offset),
        material: MaterialId(*material),
    };
    model(brushes.iter().map(|b| Brush { faces: b.iter().map(face).collect(), ..Brush::default() }).collect())
}

/// What a sweep draws at random.
pub trait Scene: Sized {
    /// What is evaluated.
    fn model(&self) -> Model;
    /// Smaller scenes to try when this one fails.
    fn smaller(&self) -> Vec<Self>;
    /// The scene as Rust, for a regression test.
    fn as_rust(&self) -> String {
        as_rust(&self.model())
    }
}

impl Scene for Model {
    fn model(&self) -> Model {
        self.clone()
    }

    /// One brush less; then one plane less, where no brush becomes unbounded by that.
    fn smaller(&self) -> Vec<Self> {
        let brushes = self.tree.brushes();
        let without_brush = (0..brushes.len()).map(|k| {
            with_brushes(self, |brushes| {
                brushes.remove(k);
            })
        });
        let planes = brushes.iter().enumerate().flat_map(|(b, brush)| (0..brush.faces.len()).map(move |f| (b, f)));
        let without_plane = planes.map(|(b, f)| {
            with_brushes(self, |brushes| {
                brushes[b].faces.remove(f);
            })
        });
        let unbounded = summarize(self).unbounded.len();
        let still_bounded = without_plane.filter(|smaller| summarize(smaller).unbounded.len() == unbounded);
        without_brush.chain(still_bounded).collect()
    }
}

/// How often a random test repeats: `count` times the factor `PLANECUT_SCENES`.
pub fn scaled(count: u64) -> u64 {
    let factor = std::env::var("PLANECUT_SCENES").ok().and_then(|v| v.parse().ok()).unwrap_or(1);
    count * factor
}

/// What went wrong, without the figures: a smaller scene must fail in the same way.
fn kind(message: &str) -> &str {
    message.split(|c: char| c.is_ascii_digit() || c == '-').next().unwrap_or_default()
}

/// Judges `count` random scenes; on failure shrinks the scene, prints it, and panics.
pub fn sweep<S: Scene>(count: u64, generate: impl Fn(&mut Rng) -> S, judge: impl Fn(&S) -> Result<(), String>) {
    let guarded = |scene: &S| {
        catch_unwind(AssertUnwindSafe(|| judge(scene))).unwrap_or_else(|cause| {
            let text = cause.downcast_ref::<String>().cloned();
            Err(text.unwrap_or_else(|| "panicked".to_owned()))
        })
    };
    for seed in 0..scaled(count) {
        let mut scene = generate(&mut Rng::spread(seed));
        let Err(first) = guarded(&scene) else { continue };
        let mut message = first.clone();
        let fails = |s: &S| guarded(s).err().filter(|m| kind(m) == kind(&first));
        while let Some((smaller, still)) = scene.smaller().into_iter().find_map(|s| Some((fails(&s)?, s))) {
            (message, scene) = (smaller, still);
        }
        panic!("seed {seed}: {first}\nsmallest failing scene: {message}\n{}", scene.as_rust());
    }
}

/// A model as an argument of [`model_of`].
pub fn as_rust(model: &Model) -> String {
    let mut text = String::from("let model = model_of(&[\n");
    for brush in model.tree.brushes() {
        text.push_str("    &[\n");
        for face in &brush.faces {
            let (normal, offset) = (face.half_space.normal().to_array(), face.half_space.offset());
            writeln!(text, "        ({normal:?}, {offset:?}, {}),", face.material.0).expect("writing to a string");
        }
        text.push_str("    ],\n");
    }
    text.push_str("]);");
    text
}

/// `Err` with a message where a condition does not hold.
#[macro_export]
macro_rules! ensure {
    ($condition:expr, $($message:tt)+) => {
        let holds: bool = $condition;
        if !holds {
            return Err(format!($($message)+));
        }
    };
}
/// `Err` with both values where they differ.
#[macro_export]
macro_rules! ensure_eq {
    ($left:expr, $right:expr, $what:expr) => {{
        let (left, right) = (&$left, &$right);
        if left != right {
            return Err(format!("{}: found {left:?}, expected {right:?}", $what));
        }
    }};
}
pub use crate::{ensure, ensure_eq};
