//! Solids of parameters, points, outlines, meshes and files.

use std::collections::BTreeMap;
use std::sync::Arc;

use planecut::csg::polyhedron::convex_tree;
use planecut::csg::primitives::{self, Extrusion};
use planecut::csg::{Brush, MaterialId, Model, ShapeError, Tree, shaping};
use planecut::expression::Node;
use planecut::import::mesh::{SolidOptions, WindingRule};
use planecut::kernel::DVec2;
use planecut::reading::{ENDINGS, FileKind, ReadOptions, read};
use planecut::triangles::said_of_surface;
use serde::Deserialize;
use wasm_bindgen::prelude::*;

use crate::arguments::{half_spaces, material, outline, points, settings, vector};
use crate::failure::{Failure, Outcome};
use crate::mesh::Mesh;
use crate::solid::{Operands, Solid};

/// All planes of shapes have the only material there is.
const OWN: MaterialId = MaterialId(0);

/// How a file or a mesh is taken, as JSON says it.
#[derive(Debug, Deserialize)]
#[serde(default, rename_all = "camelCase", deny_unknown_fields)]
struct Taking {
    parameters: BTreeMap<String, f64>,
    allow_loss: bool,
    winding: Winding,
    close: f64,
}

#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Winding {
    Positive,
    Nonzero,
    Odd,
}

impl Default for Taking {
    fn default() -> Self {
        Self { parameters: BTreeMap::new(), allow_loss: false, winding: Winding::Positive, close: 0.0 }
    }
}

impl Taking {
    fn solid(&self) -> Outcome<SolidOptions> {
        let rule = match self.winding {
            Winding::Positive => WindingRule::Positive,
            Winding::Nonzero => WindingRule::NonZero,
            Winding::Odd => WindingRule::Odd,
        };
        if self.close < 0.0 {
            return Err(Failure::of(format!("close: found {}, expected a number that is not negative", self.close)));
        }
        Ok(SolidOptions { rule, close: self.close, textures: false })
    }
}

/// A shape all of one material.
fn made<T: Into<Tree>>(shape: Result<T, ShapeError>, name: Option<String>) -> Result<Solid, JsValue> {
    let shape = shape.map_err(Failure::of)?;
    Ok(Solid::of(Node::of_tree(shape, material(name))))
}

#[wasm_bindgen]
impl Solid {
    /// A box between two corners.
    ///
    /// # Errors
    /// A `PlanecutError` for parameters that have no shape, as of all shapes.
    pub fn cuboid(min: &[f64], max: &[f64], material: Option<String>) -> Result<Self, JsValue> {
        made(primitives::cuboid(vector(min, "min")?, vector(max, "max")?, OWN), material)
    }

    /// A cylinder, cone or frustum along z from 0.
    ///
    /// # Errors
    /// As for a box.
    pub fn cylinder(
        height: f64,
        radius: f64,
        top_radius: f64,
        segments: u32,
        material: Option<String>,
    ) -> Result<Self, JsValue> {
        made(primitives::cylinder(height, radius, top_radius, segments, OWN), material)
    }

    /// A prism over a regular polygon.
    ///
    /// # Errors
    /// As for a box.
    pub fn prism(height: f64, radius: f64, sides: u32, material: Option<String>) -> Result<Self, JsValue> {
        made(primitives::prism(height, radius, sides, OWN), material)
    }

    /// A capsule along z.
    ///
    /// # Errors
    /// As for a box.
    pub fn capsule(height: f64, radius: f64, segments: u32, material: Option<String>) -> Result<Self, JsValue> {
        made(primitives::capsule(height, radius, segments, OWN), material)
    }

    /// A sphere around the origin.
    ///
    /// # Errors
    /// As for a box.
    pub fn sphere(radius: f64, segments: u32, material: Option<String>) -> Result<Self, JsValue> {
        made(primitives::sphere(radius, segments, OWN), material)
    }

    /// A torus around the z axis.
    ///
    /// # Errors
    /// As for a box.
    pub fn torus(
        radius: f64,
        tube: f64,
        segments: u32,
        tube_segments: u32,
        material: Option<String>,
    ) -> Result<Self, JsValue> {
        made(primitives::torus(radius, tube, segments, tube_segments, OWN), material)
    }

    /// The convex body of half-spaces; all of space without any.
    ///
    /// # Errors
    /// As for a box.
    pub fn halfspaces(planes: &[f64], material: Option<String>) -> Result<Self, JsValue> {
        let half_spaces = half_spaces(planes, "planes")?;
        let tree = match half_spaces.is_empty() {
            true => Tree::everything(),
            false => Brush::from_half_spaces(half_spaces, OWN).into(),
        };
        made(Ok(tree), material)
    }

    /// The convex hull of points.
    ///
    /// # Errors
    /// As for a box.
    #[wasm_bindgen(js_name = hullOfPoints)]
    pub fn hull_of_points(values: &[f64], material: Option<String>) -> Result<Self, JsValue> {
        made(primitives::hull_of_points(&points(values, "points")?, OWN), material)
    }

    /// The convex hull of solids together.
    ///
    /// # Errors
    /// As for a box.
    #[wasm_bindgen(js_name = hullOfSolids)]
    pub fn hull_of_solids(solids: &Operands, material: Option<String>) -> Result<Self, JsValue> {
        made(shaping::hull(&convex_trees(solids.nodes())?, OWN), material)
    }

    /// The Minkowski sum of two solids.
    ///
    /// # Errors
    /// As for a box.
    pub fn minkowski(a: &Self, b: &Self, material: Option<String>) -> Result<Self, JsValue> {
        let trees = convex_trees(&[Arc::clone(a.node()), Arc::clone(b.node())])?;
        made(shaping::minkowski(&trees[0], &trees[1], OWN), material)
    }

    /// An outline extruded along z from 0: the corners of all loops, and how many each loop has. Without `slices` there is one for each 5 degrees of twist.
    ///
    /// # Errors
    /// As for a box.
    // JavaScript sees them as one object of settings, which the package spreads
    #[allow(clippy::too_many_arguments)]
    pub fn extrude(
        corners: &[f64],
        lengths: &[u32],
        height: f64,
        twist: f64,
        scale_x: f64,
        scale_y: f64,
        slices: Option<u32>,
        material: Option<String>,
    ) -> Result<Self, JsValue> {
        let scale = DVec2::new(scale_x, scale_y);
        let extrusion = Extrusion { twist, scale, slices, ..Extrusion::straight(height) };
        made(primitives::extrude(&outline(corners, lengths)?, &extrusion, OWN), material)
    }

    /// An outline revolved about the z axis.
    ///
    /// # Errors
    /// As for a box.
    pub fn revolve(
        corners: &[f64],
        lengths: &[u32],
        angle: f64,
        segments: u32,
        material: Option<String>,
    ) -> Result<Self, JsValue> {
        made(primitives::revolve(&outline(corners, lengths)?, angle, segments, OWN), material)
    }

    /// The solid that a closed mesh bounds. `options` is a JSON object of `winding` and `close`.
    ///
    /// # Errors
    /// A `PlanecutError` that says which edge is open, and where, if the mesh is not closed.
    #[wasm_bindgen(js_name = fromMesh)]
    pub fn from_mesh(mesh: &Mesh, options: &str) -> Result<Self, JsValue> {
        let options = settings::<Taking>(options)?.solid()?;
        let import = mesh.triangles_of().solid(&options).map_err(|error| Failure::of(said_of_surface(&error)))?;
        Ok(Self::with_warnings(Node::of_model(import.model), import.warnings))
    }

    /// A solid of a file; `name` tells of which kind it is, `options` is a JSON object of `parameters`, `allowLoss`, `winding` and `close`.
    ///
    /// # Errors
    /// A `PlanecutError` that names the file, and the line where there is one.
    pub fn load(bytes: &[u8], name: &str, options: &str) -> Result<Self, JsValue> {
        Ok(loaded(bytes, name, options)?)
    }
}

/// The trees of solids, closed meshes among them taken apart into convex cells.
fn convex_trees(nodes: &[Arc<Node>]) -> Outcome<Vec<Tree>> {
    let tree = |node: &Arc<Node>| {
        let tree = node.model()?.tree.with_material(OWN);
        Ok(convex_tree(&tree).map_err(Failure::of)?.into_owned())
    };
    nodes.iter().map(tree).collect()
}

fn loaded(bytes: &[u8], name: &str, options: &str) -> Outcome<Solid> {
    let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending);
    let Some(kind) = FileKind::from_extension(ending) else {
        return Err(Failure::of(format!("{name}: found a file of another kind, expected {ENDINGS}")));
    };
    let taking: Taking = settings(options)?;
    let solid = taking.solid()?;
    let options = ReadOptions { parameters: taking.parameters.into_iter().collect(), solid, ..ReadOptions::default() };
    let (Model { materials, tree }, warnings) = read(bytes, kind, name, &options)?;
    if let Some(lost) = warnings.iter().find(|warning| warning.left_out > 0 && !taking.allow_loss) {
        return Err(Failure::of_line(name, lost.line, &format!("{} (allowLoss goes on without it)", lost.message)));
    }
    Ok(Solid::with_warnings(Node::of_model(Model { materials, tree }), warnings))
}
