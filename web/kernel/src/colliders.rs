//! Few convex cells around the solid.

use planecut::cells::coarsen::{CoarsenOptions, Side, Writing, written_meshes};
use planecut::csg::Mesh;
use planecut::enclosing::enclosed;
use planecut::kernel::DVec3;
use serde::Deserialize;
use wasm_bindgen::prelude::*;

use crate::editor::Editor;
use crate::failure::{Failure, Outcome};
use crate::pieces::Pieces;

/// How a solid is coarsened, as JSON says it.
#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase", deny_unknown_fields)]
pub(crate) struct Settings {
    max_cells: Option<usize>,
    max_excess: Option<f64>,
    max_vertices: Option<usize>,
    max_faces: Option<usize>,
    clear_radius: Option<f64>,
    max_gap: Option<f64>,
    min_thickness: Option<f64>,
    overlap_weight: Option<f64>,
    by_material: bool,
    inner: bool,
}

impl Settings {
    pub(crate) fn options(&self) -> CoarsenOptions {
        CoarsenOptions {
            max_cells: self.max_cells,
            max_excess: self.max_excess,
            max_faces: self.max_faces,
            max_vertices: self.max_vertices,
            keep_clear: None,
            clear_radius: self.clear_radius,
            by_material: self.by_material,
            min_thickness: self.min_thickness,
            side: if self.inner { Side::Inner } else { Side::Outer },
            overlap_weight: self.overlap_weight,
            max_gap: self.max_gap,
        }
    }
}

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
        let settings: Settings =
            serde_json::from_str(options).map_err(|error| Failure::of(format!("options: {error}")))?;
        let model = self.live().to_model();
        let boundary = self.live().mesh().map_err(Failure::of)?;
        let (outcome, _) = enclosed(&model.tree, &boundary, &[], &settings.options()).map_err(Failure::of)?;
        let writing = Writing {
            scale: 1.0,
            max_vertices: settings.max_vertices.unwrap_or(usize::MAX),
            encloses: !settings.inner,
            is_separated: false,
            stored: &<[DVec3]>::to_vec,
        };
        let meshes: Vec<Mesh> = written_meshes(&outcome.cells, &model.materials, &writing).map_err(Failure::of)?;
        let pieces = Pieces::of(&meshes, self.relative_to());
        Ok(Colliders { pieces, volume: outcome.volume_in, excess: outcome.excess() })
    }
}
