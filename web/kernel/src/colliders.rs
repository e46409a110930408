//! Few convex cells around the model that is edited.

use planecut::coarsening::{Subject, WrittenCells};
use planecut::expression::Node;
use wasm_bindgen::prelude::*;

use crate::coarsened::written;
use crate::editor::Editor;
use crate::failure::Outcome;
use crate::pieces::Pieces;
use crate::solid::Operands;

/// Convex cells around a solid.
#[wasm_bindgen(getter_with_clone)]
pub struct Colliders {
    /// Their meshes.
    pub pieces: Pieces,
    /// Volume of the solid.
    pub volume: f64,
    /// Volume that the union of the cells adds, relative to it.
    pub excess: f64,
}

#[wasm_bindgen]
impl Editor {
    /// Few convex cells that hold the solid, as `planecut coarsen` finds them; `options` are a JSON object with the names of its options in camel case.
    ///
    /// # Errors
    /// A `PlanecutError` for options that cannot be met, and for a solid that is empty or reaches infinity.
    pub fn coarsen(&self, options: &str) -> Result<Colliders, JsValue> {
        Ok(self.coarsened(options)?)
    }
}

impl Editor {
    fn coarsened(&self, options: &str) -> Outcome<Colliders> {
        let node = Node::of_model(self.live().to_model());
        let (WrittenCells { meshes, outcome, .. }, _) = written(Subject::Solid(&node), options, &Operands::default())?;
        let pieces = Pieces::of(&meshes, self.relative_to());
        Ok(Colliders { pieces, volume: outcome.volume_in, excess: outcome.excess() })
    }
}
