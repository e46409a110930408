//! A live model that messages and calls drive.

use std::collections::BTreeMap;

use js_sys::Uint32Array;
use planecut::csg::polyhedron::convex_tree;
use planecut::csg::{BrushId, FaceId, LiveModel, Model, UnboundedBrushes};
use planecut::export::{MassProperties, material_color};
use planecut::import::Warning;
use planecut::kernel::DVec3;
use planecut::reading::{ENDINGS, FileKind, ReadOptions, read};
use planecut::session::Session;
use serde_json::{Value, json};
use wasm_bindgen::prelude::*;

use crate::faces::{Edited, Faces};
use crate::failure::{Failure, Outcome};

/// A model that is edited: what was read of a file, or an empty one.
#[wasm_bindgen]
pub struct Editor {
    session: Session,
    warnings: Vec<Warning>,
    /// What positions for renderers are relative to.
    center: DVec3,
}

#[wasm_bindgen]
impl Editor {
    /// Reads a file; `name` tells of which kind it is, `parameters` is a JSON object of values for parameters of a model file.
    ///
    /// # Errors
    /// A `PlanecutError` that names the file, and the line where there is one.
    #[wasm_bindgen(constructor)]
    pub fn new(bytes: &[u8], name: &str, parameters: &str) -> Result<Self, JsValue> {
        Ok(Self::open(bytes, name, parameters)?)
    }

    /// What was repaired, left out or is doubtful, as a JSON array of objects of `line`, `message` and `leftOut`.
    #[must_use]
    pub fn warnings(&self) -> String {
        let warning =
            |warning: &Warning| json!({"line": warning.line, "message": warning.message, "leftOut": warning.left_out});
        self.warnings.iter().map(warning).collect::<Value>().to_string()
    }

    /// The answer to a message, as `planecut edit --serve` gives it.
    #[must_use]
    pub fn answer(&mut self, message: &str) -> String {
        self.answer_of(message).to_string()
    }

    /// The same for an edit, with the faces that it has changed in the place of their numbers.
    #[must_use]
    pub fn edit(&mut self, message: &str) -> Edited {
        let mut answer = self.answer_of(message);
        let mut faces = |name: &str| -> Vec<u32> {
            let numbers = answer.as_object_mut().and_then(|keys| keys.remove(name));
            let numbers = numbers.iter().filter_map(Value::as_array).flatten();
            numbers.filter_map(|number| u32::try_from(number.as_u64()?).ok()).collect()
        };
        let removed = Uint32Array::from(&faces("removed")[..]);
        let added: Vec<FaceId> = faces("added").into_iter().map(FaceId::from).collect();
        let added = Faces::of(self.session.live(), &added, self.center);
        Edited { removed, added, answer: answer.to_string() }
    }

    /// All faces.
    #[must_use]
    pub fn faces(&self) -> Faces {
        let live = self.session.live();
        let all: Vec<FaceId> = live.faces().map(|(face, _)| face).collect();
        Faces::of(live, &all, self.center)
    }

    /// The brushes in the order of their numbers, as a JSON array of objects of `brush`, `name` and `material`, which is that of the first face.
    #[must_use]
    pub fn brushes(&self) -> String {
        let live = self.session.live();
        let entry = |id: BrushId| {
            let (brush, _) = live.brush(id).ok()?;
            let material = brush.faces.first().map(|face| &live.materials()[face.material.0 as usize].name);
            Some(json!({"brush": id.0, "name": brush.name, "material": material}))
        };
        live.brushes().filter_map(entry).collect::<Value>().to_string()
    }

    /// Mass, centre of mass and inertia about it of the solid at a density, as a JSON object of `mass`, `center` and `inertia` (xx, yy, zz, xy, xz, yz); `null` of an empty solid.
    ///
    /// # Errors
    /// A `PlanecutError` for a density that is not positive.
    pub fn mass(&self, density: f64) -> Result<String, JsValue> {
        let is_density = density.is_finite() && density > 0.0;
        if !is_density {
            return Err(Failure::of(format!("density: found {density}, expected a number above zero")).into());
        }
        let mesh = self.session.live().mesh().map_err(Failure::of)?;
        let properties = MassProperties::of_triangles(&mesh.positions, &mesh.triangles, density);
        Ok(properties.map_or(Value::Null, |it| json!({"mass": it.mass, "center": it.center.to_array(), "inertia": [it.moments.x, it.moments.y, it.moments.z, it.products.x, it.products.y, it.products.z]})).to_string())
    }

    /// What positions of faces are relative to: x, y and z.
    #[must_use]
    pub fn center(&self) -> Vec<f64> {
        self.center.to_array().to_vec()
    }

    /// The colour of each material, linear red, green and blue.
    #[must_use]
    pub fn colors(&self) -> Vec<f32> {
        self.session.live().materials().iter().flat_map(material_color).collect()
    }
}

impl Editor {
    fn open(bytes: &[u8], name: &str, parameters: &str) -> Outcome<Self> {
        let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending);
        let Some(kind) = FileKind::from_extension(ending) else {
            return Err(Failure::of(format!("{name}: found a file of another kind, expected {ENDINGS}")));
        };
        let parameters: BTreeMap<String, f64> =
            serde_json::from_str(parameters).map_err(|error| Failure::of(format!("parameters: {error}")))?;
        let options = ReadOptions { parameters: parameters.into_iter().collect(), ..ReadOptions::default() };
        let (Model { materials, tree }, warnings) = read(bytes, kind, name, &options)?;
        let failed = |error: &dyn std::fmt::Display| Failure::of(format!("{name}: {error}"));
        // edits are of convex bodies
        let tree = convex_tree(&tree).map_err(|error| failed(&error))?.into_owned();
        let model = Model { materials, tree };
        let live = LiveModel::from_model_with(model, UnboundedBrushes::Keep).map_err(|error| failed(&error))?;
        let mut session = Session::new(live);
        let measures = session.live_mut().measures();
        let center = 0.5 * (measures.min + measures.max);
        let center = if center.is_finite() { center.as_vec3().as_dvec3() } else { DVec3::ZERO };
        Ok(Self { session, warnings, center })
    }

    fn answer_of(&mut self, message: &str) -> Value {
        let refuse = |_: &LiveModel, _: &std::path::Path| {
            Err("found a file, expected a call of encode: there are none here".to_owned())
        };
        self.session.answer(message.as_bytes(), refuse).message
    }

    pub(crate) fn live(&self) -> &LiveModel {
        self.session.live()
    }

    pub(crate) fn relative_to(&self) -> DVec3 {
        self.center
    }
}
