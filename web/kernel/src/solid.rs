//! Solids: what they are made of, and what can be asked of them.

use std::sync::Arc;

use planecut::csg::polyhedron::convex_tree;
use planecut::csg::stages::Ray;
use planecut::csg::{Material, Operation, SolidMeasures, Transform, convex_union};
use planecut::export::{BrushFormat, ExportOptions, write_brushes, write_model};
use planecut::expression::{self, Evaluated, Node};
use planecut::import::Warning;
use planecut::kernel::DVec3;
use planecut::triangles::{one_body, said_of_surface};
use serde_json::{Value, json};
use wasm_bindgen::prelude::*;

use crate::arguments::{material, points, settings, transform, vector};
use crate::cell::{Cell, cells_of};
use crate::failure::{Failure, Outcome};
use crate::mesh::Mesh;

/// A solid that never changes; nothing is worked out until something is asked of its boundary.
#[wasm_bindgen]
pub struct Solid {
    node: Arc<Node>,
    /// What was noticed in the file that it was read from.
    warnings: Vec<Warning>,
}

/// Solids that are to be combined.
#[wasm_bindgen]
#[derive(Default)]
pub struct Operands(Vec<Arc<Node>>);

#[wasm_bindgen]
impl Operands {
    /// None yet.
    #[wasm_bindgen(constructor)]
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds one.
    pub fn push(&mut self, solid: &Solid) {
        self.0.push(Arc::clone(&solid.node));
    }

    /// All of them combined by an operation, by its name; of a difference the others are taken from the first.
    ///
    /// # Errors
    /// A `PlanecutError` for another name, and for an intersection or difference of nothing.
    pub fn combine(&self, operation: &str) -> Result<Solid, JsValue> {
        Ok(self.combined(operation)?)
    }
}

impl Operands {
    fn combined(&self, operation: &str) -> Outcome<Solid> {
        let operation = match operation {
            "union" => Operation::Union,
            "intersection" => Operation::Intersection,
            "difference" => Operation::Difference,
            "xor" => Operation::Xor,
            "complement" => Operation::Complement,
            found => return Err(Failure::of(format!("operation: found {found:?}, expected the name of one"))),
        };
        let needs_one = matches!(operation, Operation::Intersection | Operation::Difference);
        if needs_one && self.0.is_empty() {
            return Err(Failure::of("solids: found none, expected one solid at least"));
        }
        Ok(Solid::of(Node::operation(operation, self.0.clone())))
    }

    pub(crate) fn nodes(&self) -> &[Arc<Node>] {
        &self.0
    }
}

impl Solid {
    pub(crate) fn of(node: Arc<Node>) -> Self {
        Self { node, warnings: Vec::new() }
    }

    pub(crate) fn with_warnings(node: Arc<Node>, warnings: Vec<Warning>) -> Self {
        Self { node, warnings }
    }

    pub(crate) fn node(&self) -> &Arc<Node> {
        &self.node
    }

    fn moved(&self, transform: &Transform) -> Outcome<Self> {
        Ok(Self::of(self.node.moved(transform)?))
    }

    fn evaluated(&self) -> Outcome<Arc<Evaluated>> {
        Ok(self.node.evaluated()?)
    }

    /// The measures; nothing where the solid is empty.
    fn measures(&self) -> Outcome<Option<SolidMeasures>> {
        let evaluated = self.evaluated()?;
        let is_empty = evaluated.evaluation.mesh.triangles.is_empty();
        Ok((!is_empty).then_some(evaluated.evaluation.solid))
    }
}

#[wasm_bindgen]
impl Solid {
    /// The solid moved by a vector.
    ///
    /// # Errors
    /// A `PlanecutError` for what is no vector.
    pub fn translate(&self, offset: &[f64]) -> Result<Self, JsValue> {
        let by = Transform::translation(vector(offset, "offset")?).map_err(Failure::of)?;
        Ok(self.moved(&by)?)
    }

    /// The solid turned about an axis through the origin, counter-clockwise seen from the tip of the axis.
    ///
    /// # Errors
    /// A `PlanecutError` for the zero vector, and for an angle that is not finite.
    pub fn rotate(&self, axis: &[f64], degrees: f64) -> Result<Self, JsValue> {
        let by = Transform::rotation(vector(axis, "axis")?, degrees).map_err(Failure::of)?;
        Ok(self.moved(&by)?)
    }

    /// The solid scaled about the origin, by a factor for each axis.
    ///
    /// # Errors
    /// A `PlanecutError` for a factor of 0.
    pub fn scale(&self, factors: &[f64]) -> Result<Self, JsValue> {
        let by = Transform::scale(vector(factors, "factors")?).map_err(Failure::of)?;
        Ok(self.moved(&by)?)
    }

    /// The solid mirrored in the plane through the origin with a normal.
    ///
    /// # Errors
    /// A `PlanecutError` for the zero vector.
    pub fn mirror(&self, normal: &[f64]) -> Result<Self, JsValue> {
        let by = Transform::mirror(vector(normal, "normal")?).map_err(Failure::of)?;
        Ok(self.moved(&by)?)
    }

    /// The solid moved by an affine map, by three or four rows of four numbers.
    ///
    /// # Errors
    /// A `PlanecutError` for a matrix that is singular or not affine.
    pub fn transform(&self, matrix: &[f64]) -> Result<Self, JsValue> {
        Ok(self.moved(&transform(matrix, "matrix")?)?)
    }

    /// The same solid, all of one material, with a colour (linear red, green and blue) or without one of its own.
    ///
    /// # Errors
    /// A `PlanecutError` for a colour that is none.
    #[wasm_bindgen(js_name = withMaterial)]
    pub fn with_material(&self, name: String, color: Option<Vec<f64>>) -> Result<Self, JsValue> {
        let color = color.map(|color| vector(&color, "color")).transpose()?;
        if let Some(found) = color.filter(|color| !(color.min_element() >= 0.0 && color.max_element() <= 1.0)) {
            let found = found.to_array();
            return Err(Failure::of(format!("color: found {found:?}, expected numbers from 0 to 1")).into());
        }
        let color = color.map(|color| color.as_vec3().to_array());
        Ok(Self::of(self.node.of_material(Material { color, ..material(Some(name)) })))
    }

    /// The same solid as one body: its boundary as a closed mesh, its vertices rounded to doubles.
    ///
    /// # Errors
    /// A `PlanecutError` for a solid that reaches infinity.
    #[wasm_bindgen(js_name = asOneBody)]
    pub fn as_one_body(&self) -> Result<Self, JsValue> {
        let model =
            one_body(&self.evaluated()?.evaluation.mesh).map_err(|error| Failure::of(said_of_surface(&error)))?;
        Ok(Self::of(Node::of_model(model)))
    }

    /// The connected parts of the solid, each of disjoint convex bodies.
    ///
    /// # Errors
    /// A `PlanecutError` for closed meshes that fall into too many convex cells.
    pub fn components(&self) -> Result<Vec<Self>, JsValue> {
        let parts = expression::components_of(&self.node.model().map_err(Failure::from)?).map_err(Failure::from)?;
        Ok(parts.into_iter().map(|model| Self::of(Node::of_model(model))).collect())
    }

    /// The volume.
    ///
    /// # Errors
    /// A `PlanecutError` for a solid that reaches infinity, as of all that is asked of the boundary.
    pub fn volume(&self) -> Result<f64, JsValue> {
        Ok(self.measures()?.map_or(0.0, |measures| measures.volume))
    }

    /// The area of the boundary.
    ///
    /// # Errors
    /// As for the volume.
    pub fn area(&self) -> Result<f64, JsValue> {
        Ok(self.measures()?.map_or(0.0, |measures| measures.area))
    }

    /// The center of mass, NaN where the solid is empty.
    ///
    /// # Errors
    /// As for the volume.
    pub fn centroid(&self) -> Result<Vec<f64>, JsValue> {
        Ok(self.measures()?.map_or(DVec3::NAN, |measures| measures.centroid).to_array().to_vec())
    }

    /// The least and then the greatest coordinates, NaN where the solid is empty.
    ///
    /// # Errors
    /// As for the volume.
    pub fn bounds(&self) -> Result<Vec<f64>, JsValue> {
        let bounds = self.measures()?.map_or([DVec3::NAN; 2], |measures| [measures.min, measures.max]);
        Ok(bounds.iter().flat_map(DVec3::to_array).collect())
    }

    /// Whether there is nothing inside.
    ///
    /// # Errors
    /// A `PlanecutError` for a solid of too many bodies.
    #[wasm_bindgen(js_name = isEmpty)]
    pub fn is_empty(&self) -> Result<bool, JsValue> {
        match self.node.evaluated() {
            Ok(evaluated) => Ok(evaluated.evaluation.mesh.triangles.is_empty()),
            Err(error) if error.is_unbounded() => Ok(false),
            Err(error) => Err(Failure::from(error).into()),
        }
    }

    /// How many convex bodies and closed meshes it is made of, each as often as it is used.
    #[wasm_bindgen(js_name = bodyCount)]
    #[must_use]
    pub fn body_count(&self) -> f64 {
        self.node.pieces() as f64
    }

    /// What was repaired, left out or is doubtful in the file that it was read from, as a JSON array of objects of `line`, `message` and `leftOut`.
    #[must_use]
    pub fn warnings(&self) -> String {
        let warning =
            |warning: &Warning| json!({"line": warning.line, "message": warning.message, "leftOut": warning.left_out});
        self.warnings.iter().map(warning).collect::<Value>().to_string()
    }

    /// For each point 1 where the solid holds it, else 0; its boundary belongs to it.
    ///
    /// # Errors
    /// A `PlanecutError` for what are no points.
    pub fn contains(&self, points_: &[f64]) -> Result<Vec<u8>, JsValue> {
        let points = points(points_, "points")?;
        let held = expression::contains(&self.node, &points).map_err(Failure::from)?;
        Ok(held.into_iter().map(u8::from).collect())
    }

    /// For each ray the distance from its origin to where it first meets the boundary, infinite where it does not. One direction is for all.
    ///
    /// # Errors
    /// A `PlanecutError` for a direction that is the zero vector.
    #[wasm_bindgen(js_name = rayCast)]
    pub fn ray_cast(&self, origins: &[f64], directions: &[f64]) -> Result<Vec<f64>, JsValue> {
        let (origins, directions) = (points(origins, "origins")?, points(directions, "directions")?);
        if directions.len() != 1 && directions.len() != origins.len() {
            let (found, expected) = (directions.len(), origins.len());
            return Err(
                Failure::of(format!("directions: found {found}, expected 1, or {expected} as of origins")).into()
            );
        }
        let rays = self.evaluated()?.rays();
        let distance = |(number, (origin, direction)): (usize, (&DVec3, &DVec3))| -> Outcome<f64> {
            let zero = || Failure::of(format!("directions[{number}]: found the zero vector, expected another"));
            let ray = Ray::new(*origin, *direction).ok_or_else(zero)?;
            Ok(rays.first_hit(&ray).map_or(f64::INFINITY, |hit| hit.1))
        };
        Ok(origins.iter().zip(directions.iter().cycle()).enumerate().map(distance).collect::<Outcome<_>>()?)
    }

    /// The boundary as a watertight mesh.
    ///
    /// # Errors
    /// As for the volume.
    pub fn mesh(&self) -> Result<Mesh, JsValue> {
        Ok(Mesh::of_evaluated(self.evaluated()?))
    }

    /// The solid as disjoint convex cells.
    ///
    /// # Errors
    /// As for the volume.
    pub fn cells(&self) -> Result<Vec<Cell>, JsValue> {
        Ok(cells_of(&self.node)?)
    }

    /// The boundary as a file of a format, by the ending of such files, or for `map` and `csg` the convex bodies, for `json` what it is made of. `options` are those of the export library, as JSON.
    ///
    /// # Errors
    /// A `PlanecutError` for a format or options that there are not, and for a solid that the format cannot say.
    pub fn encode(&self, format: &str, options: &str) -> Result<Vec<u8>, JsValue> {
        if let Ok(format) = BrushFormat::from_extension(format) {
            return Ok(self.written_bodies(format, options)?);
        }
        if format == "json" {
            return Ok(self.written_model(options)?);
        }
        Ok(Mesh::of_evaluated(self.evaluated()?).encoded(format, options)?)
    }
}

impl Solid {
    fn written_model(&self, options: &str) -> Outcome<Vec<u8>> {
        let mut text = Vec::new();
        write_model(&self.node.model()?, scale_alone(options)?, &mut text).map_err(Failure::of)?;
        Ok(text)
    }

    fn written_bodies(&self, format: BrushFormat, options: &str) -> Outcome<Vec<u8>> {
        let scale = scale_alone(options)?;
        // an unbounded solid has no file
        self.evaluated()?;
        let model = self.node.model()?;
        let tree = convex_tree(&model.tree).map_err(Failure::of)?;
        let mut text = Vec::new();
        write_brushes(&convex_union(&tree), &model.materials, format, scale, &mut text).map_err(Failure::of)?;
        Ok(text)
    }
}

/// The scale of options that have nothing else.
fn scale_alone(options: &str) -> Outcome<f64> {
    let options: ExportOptions = settings(options)?;
    if (ExportOptions { scale: 1.0, ..options.clone() }) != ExportOptions::default() {
        return Err(Failure::of("options: found some for meshes, expected scale alone"));
    }
    Ok(options.scale)
}
