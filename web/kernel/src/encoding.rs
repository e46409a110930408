//! A model as a file.

use planecut::csg::convex_union;
use planecut::export::{BrushFormat, ExportOptions, Format, encode, write_brushes, write_model};
use wasm_bindgen::prelude::*;

use crate::editor::Editor;
use crate::failure::{Failure, Outcome};

#[wasm_bindgen]
impl Editor {
    /// The model as a file of a format, named by the ending of such files: the boundary as `glb`, `gltf`, `obj`, `stl`, `3mf` or `ply`, convex bodies as `map` or `csg`, the whole tree as `json`. `options` are those of
    /// the export library, as JSON.
    ///
    /// # Errors
    /// A `PlanecutError` for a format or options that there are not, and for a solid that the format cannot say.
    pub fn encode(&self, format: &str, options: &str) -> Result<Vec<u8>, JsValue> {
        Ok(self.encoded(format, options)?)
    }
}

impl Editor {
    fn encoded(&self, format: &str, options: &str) -> Outcome<Vec<u8>> {
        let options: ExportOptions =
            serde_json::from_str(options).map_err(|error| Failure::of(format!("options: {error}")))?;
        if format == "json" {
            let mut text = Vec::new();
            write_model(&self.live().to_model(), options.scale, &mut text).map_err(Failure::of)?;
            return Ok(text);
        }
        if let Ok(format) = BrushFormat::from_extension(format) {
            let model = self.live().to_model();
            let mut text = Vec::new();
            let bodies = convex_union(&model.tree);
            write_brushes(&bodies, &model.materials, format, options.scale, &mut text).map_err(Failure::of)?;
            return Ok(text);
        }
        let format = Format::from_extension(format).map_err(Failure::of)?;
        let mesh = self.live().mesh().map_err(Failure::of)?;
        encode(&mesh, format, &options).map_err(Failure::of)
    }
}
