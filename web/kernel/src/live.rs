//! The live model: edits that cost what they touch.

use planecut::csg::{BrushId, Change, Edit, Edited, FaceId, LiveModel, Material, Role};
use planecut::expression::{EditMaterials, Node};
use planecut::import::edits::edit_of_keys;
use planecut::kernel::DVec3;
use planecut::session::Session;
use serde_json::{Map, Value};
use wasm_bindgen::prelude::*;

use crate::arguments::{number, settings, vector};
use crate::failure::{Failure, Outcome};
use crate::live_faces::{Buffers, Face, Preview};
use crate::mesh::Mesh;
use crate::solid::Solid;

/// A model that is edited. Edits and questions are JSON objects, as `planecut edit --serve` takes them, but for those that are about solids and arrays.
#[wasm_bindgen]
pub struct Live {
    session: Session,
    change: Change,
    /// What the step that is open has changed.
    open: Option<Change>,
}

/// An edit, and the materials that it names for the first time.
type Named = (Edit, Vec<Material>);

/// What a call of an edit has made.
#[wasm_bindgen(getter_with_clone)]
pub struct Made {
    /// The number of a brush that was added.
    pub brush: Option<f64>,
    /// The number of a plane that was added.
    pub plane: Option<f64>,
    /// The number of an operation that was added.
    pub node: Option<f64>,
    /// The numbers of copies.
    pub copies: Vec<f64>,
}

#[wasm_bindgen]
impl Live {
    /// A model of the bodies of a solid.
    ///
    /// # Errors
    /// A `PlanecutError` for a solid that reaches infinity.
    #[wasm_bindgen(constructor)]
    pub fn new(solid: &Solid) -> Result<Self, JsValue> {
        let model = solid.node().model().map_err(Failure::from)?;
        let live = LiveModel::from_model(model).map_err(Failure::from)?;
        Ok(Self { session: Session::new(live), change: Change::default(), open: None })
    }

    /// Begins a step: all calls until it is committed are one for `undo`.
    ///
    /// # Errors
    /// A `PlanecutError` where one is open.
    pub fn begin(&mut self) -> Result<(), JsValue> {
        self.refuse_while_open("edit")?;
        self.session.live_mut().begin_step().map_err(Failure::from)?;
        self.open = Some(Change::default());
        Ok(())
    }

    /// Completes the step.
    ///
    /// # Errors
    /// A `PlanecutError` where none is open.
    pub fn commit(&mut self) -> Result<(), JsValue> {
        self.session.live_mut().commit_step().map_err(Failure::from)?;
        self.change = self.open.take().unwrap_or_default();
        Ok(())
    }

    /// Takes the step back.
    ///
    /// # Errors
    /// A `PlanecutError` where none is open.
    pub fn cancel(&mut self) -> Result<(), JsValue> {
        self.open = None;
        self.session.live_mut().cancel_step().map_err(Failure::from)?;
        Ok(())
    }

    /// Undoes the last step.
    ///
    /// # Errors
    /// A `PlanecutError` where there is none, or one is open.
    pub fn undo(&mut self) -> Result<(), JsValue> {
        self.refuse_while_open("undo")?;
        self.change = self.session.live_mut().undo().map_err(Failure::from)?;
        Ok(())
    }

    /// Does the step again that was last undone.
    ///
    /// # Errors
    /// As of `undo`.
    pub fn redo(&mut self) -> Result<(), JsValue> {
        self.refuse_while_open("redo")?;
        self.change = self.session.live_mut().redo().map_err(Failure::from)?;
        Ok(())
    }

    /// How many steps can be undone, and how many done again.
    #[must_use]
    pub fn history(&self) -> Vec<u32> {
        let (undo, redo) = self.model().history_len();
        vec![undo as u32, redo as u32]
    }

    /// Does an edit, a JSON object with `op`, within the step that is open.
    ///
    /// # Errors
    /// A `PlanecutError` for an edit that is refused.
    pub fn apply(&mut self, edit: &str) -> Result<Made, JsValue> {
        let named = self.named(edit)?;
        Ok(self.applied(named)?)
    }

    /// Adds the only body of a solid as a brush.
    ///
    /// # Errors
    /// As of `apply`.
    #[wasm_bindgen(js_name = addBrush)]
    pub fn add_brush(&mut self, solid: &Solid, role: &str) -> Result<Made, JsValue> {
        let named = self.addition(solid, role)?;
        Ok(self.applied(named)?)
    }

    /// Puts the only body of a solid in the place of a brush.
    ///
    /// # Errors
    /// As of `apply`.
    #[wasm_bindgen(js_name = replaceBrush)]
    pub fn replace_brush(&mut self, brush: f64, solid: &Solid) -> Result<Made, JsValue> {
        let named = self.replaced(brush, solid)?;
        Ok(self.applied(named)?)
    }

    /// What an edit would change.
    ///
    /// # Errors
    /// As of `apply`.
    pub fn preview(&self, edit: &str) -> Result<Preview, JsValue> {
        Ok(self.previewed(self.named(edit)?)?)
    }

    /// What a new brush would change.
    ///
    /// # Errors
    /// As of `apply`.
    #[wasm_bindgen(js_name = previewAddBrush)]
    pub fn preview_add_brush(&self, solid: &Solid, role: &str) -> Result<Preview, JsValue> {
        Ok(self.previewed(self.addition(solid, role)?)?)
    }

    /// What another body of a brush would change.
    ///
    /// # Errors
    /// As of `apply`.
    #[wasm_bindgen(js_name = previewReplaceBrush)]
    pub fn preview_replace_brush(&self, brush: f64, solid: &Solid) -> Result<Preview, JsValue> {
        Ok(self.previewed(self.replaced(brush, solid)?)?)
    }

    /// The answer to a question, a JSON object with `query`, as JSON.
    ///
    /// # Errors
    /// A `PlanecutError` for a question that is refused.
    pub fn query(&mut self, question: &str) -> Result<String, JsValue> {
        let refuse = |_: &LiveModel, _: &std::path::Path| Err("found a file, expected none".to_owned());
        let Value::Object(answer) = self.session.answer(question.as_bytes(), refuse).message else {
            return Err(Failure::bug("found no answer").into());
        };
        match answer.get("error").and_then(Value::as_str) {
            Some(error) => Err(Failure::of(error).into()),
            None => Ok(Value::Object(answer).to_string()),
        }
    }

    /// The numbers of the faces that the last step has removed.
    #[must_use]
    pub fn removed(&self) -> Vec<u32> {
        numbers(&self.change.removed)
    }

    /// The numbers of the faces that the last step has added.
    #[must_use]
    pub fn added(&self) -> Vec<u32> {
        numbers(&self.change.added)
    }

    /// The numbers of the brushes that the last step has changed.
    #[must_use]
    pub fn changed(&self) -> Vec<f64> {
        self.change.brushes.iter().map(|brush| brush.0 as f64).collect()
    }

    /// The numbers of the brushes.
    #[must_use]
    pub fn brushes(&self) -> Vec<f64> {
        self.model().brushes().map(|brush| brush.0 as f64).collect()
    }

    /// The numbers of the faces.
    #[must_use]
    pub fn faces(&self) -> Vec<u32> {
        self.model().faces().map(|(face, _)| u32::from(face)).collect()
    }

    /// A face by its number.
    ///
    /// # Errors
    /// A `PlanecutError` for a face that is not there.
    pub fn face(&self, id: f64) -> Result<Face, JsValue> {
        Ok(Face::of(self.model(), self.known_face(id, "id")?))
    }

    /// Faces as a renderer takes them, relative to a centre.
    ///
    /// # Errors
    /// A `PlanecutError` for a face that is not there.
    pub fn buffers(&self, faces: &[f64], center: &[f64]) -> Result<Buffers, JsValue> {
        let center = vector(center, "center")?;
        let faces = faces.iter().map(|id| self.known_face(*id, "faces")).collect::<Outcome<Vec<FaceId>>>()?;
        Ok(Buffers::of(self.model(), &faces, center))
    }

    /// The number of the first face that a ray meets, and the distance; nothing where it meets none.
    ///
    /// # Errors
    /// A `PlanecutError` for a direction that is the zero vector.
    pub fn pick(&self, origin: &[f64], direction: &[f64]) -> Result<Vec<f64>, JsValue> {
        let (origin, direction) = (vector(origin, "origin")?, vector(direction, "direction")?);
        if direction == DVec3::ZERO {
            return Err(Failure::of("direction: found the zero vector, expected another").into());
        }
        // so that no square overflows or vanishes
        let direction = direction / direction.abs().max_element();
        let hit = self.model().pick(origin, direction);
        Ok(hit.map_or(Vec::new(), |(face, distance)| vec![f64::from(u32::from(face)), distance]))
    }

    /// The mesh of the solid, the same as that of a new model.
    ///
    /// # Errors
    /// An `InternalError`.
    pub fn mesh(&self) -> Result<Mesh, JsValue> {
        Ok(Mesh::of_core(self.model().mesh().map_err(Failure::from)?))
    }

    /// The model as it is now, as a solid.
    #[wasm_bindgen(js_name = toSolid)]
    #[must_use]
    pub fn to_solid(&self) -> Solid {
        Solid::of(Node::of_model(self.model().to_model()))
    }
}

impl Live {
    fn model(&self) -> &LiveModel {
        self.session.live()
    }

    fn refuse_while_open(&self, name: &str) -> Outcome<()> {
        match self.open {
            Some(_) => Err(Failure::of(format!("{name}: found an edit that is not complete, expected none"))),
            None => Ok(()),
        }
    }

    fn known_face(&self, id: f64, name: &str) -> Outcome<FaceId> {
        let number = number(id, name).ok().and_then(|id| u32::try_from(id).ok()).map(FaceId::from);
        number
            .filter(|face| self.model().face(*face).is_some())
            .ok_or_else(|| Failure::of(format!("{name}: found {id}, expected the number of a face that is there")))
    }

    fn named(&self, edit: &str) -> Outcome<Named> {
        let keys: Map<String, Value> = settings(edit)?;
        edit_of_keys(keys, self.model().materials()).map_err(Failure::of)
    }

    fn addition(&self, solid: &Solid, role: &str) -> Outcome<Named> {
        let role = match role {
            "add" => Role::Add,
            "subtract" => Role::Subtract,
            "intersect" => Role::Intersect,
            found => {
                return Err(Failure::of(format!(
                    "role: found {found:?}, expected \"add\", \"subtract\" or \"intersect\""
                )));
            }
        };
        let mut materials = EditMaterials::new(self.model().materials());
        let brush = materials.brush_of(solid.node())?;
        Ok((Edit::AddBrush { brush, role }, materials.into_new()))
    }

    fn replaced(&self, brush: f64, solid: &Solid) -> Outcome<Named> {
        let brush = BrushId(number(brush, "brush")?);
        let mut materials = EditMaterials::new(self.model().materials());
        let by = materials.brush_of(solid.node())?;
        Ok((Edit::ReplaceBrush { brush, by }, materials.into_new()))
    }

    fn applied(&mut self, (edit, materials): Named) -> Outcome<Made> {
        let Some(change) = &mut self.open else {
            return Err(Failure::of("found an edit that is over, expected calls within the function given to edit"));
        };
        let Edited { brush, plane, copies, node, change: done } =
            self.session.live_mut().apply_with(edit, materials)?;
        *change = std::mem::take(change).then(done);
        Ok(Made {
            brush: brush.map(|brush| brush.0 as f64),
            plane: plane.map(|plane| plane.0 as f64),
            node: node.map(|node| node.0 as f64),
            copies: copies.iter().map(|brush| brush.0 as f64).collect(),
        })
    }

    fn previewed(&self, (edit, new): Named) -> Outcome<Preview> {
        let names: Vec<String> =
            self.model().materials().iter().chain(&new).map(|material| material.name.clone()).collect();
        Ok(Preview::of(self.model().preview_with(edit, new)?, &names))
    }
}

fn numbers(faces: &[FaceId]) -> Vec<u32> {
    faces.iter().map(|face| u32::from(*face)).collect()
}
