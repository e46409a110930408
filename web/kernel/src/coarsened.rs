//! Few convex cells around solids, meshes and hulls.

use std::sync::Arc;

use planecut::cells::coarsen::{Bounded, CoarsenOptions, Side};
use planecut::coarsening::{Subject, Taken, WrittenCells, coarsened};
use planecut::csg::polyhedron::convex_tree;
use planecut::csg::{Model, Operation, Tree};
use planecut::export::{Engine, ExportOptions, Format, Part, encode_parts};
use planecut::expression::Node;
use planecut::kernel::DVec3;
use serde::Deserialize;
use wasm_bindgen::prelude::*;

use crate::arguments::{points, settings};
use crate::cell::Cell;
use crate::failure::{Failure, Outcome};
use crate::mesh::Mesh;
use crate::solid::{Operands, Solid};

/// How something is coarsened, as JSON says it.
#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase", deny_unknown_fields)]
struct Settings {
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
    surface: Surface,
    engine: Option<String>,
}

#[derive(Debug, Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Surface {
    #[default]
    Auto,
    Shell,
    Filled,
}

impl Settings {
    fn options(&self, keep_clear: &Operands) -> Outcome<CoarsenOptions> {
        let clear = |nodes: &[Arc<Node>]| -> Outcome<Tree> {
            let tree = Node::operation(Operation::Union, nodes.to_vec()).model()?.tree;
            Ok(convex_tree(&tree).map_err(|error| Failure::of(format!("keepClear: {error}")))?.into_owned())
        };
        let clear = Some(keep_clear.nodes()).filter(|nodes| !nodes.is_empty()).map(clear);
        let limits =
            self.engine.as_deref().map(Engine::from_name).transpose().map_err(Failure::of)?.map(Engine::limits);
        Ok(CoarsenOptions {
            max_cells: self.max_cells,
            max_excess: self.max_excess,
            max_faces: self.max_faces.or_else(|| limits?.max_faces),
            max_vertices: self.max_vertices.or_else(|| limits?.max_vertices),
            keep_clear: clear.transpose()?,
            clear_radius: self.clear_radius,
            by_material: self.by_material,
            min_thickness: self.min_thickness,
            side: if self.inner { Side::Inner } else { Side::Outer },
            overlap_weight: self.overlap_weight,
            max_gap: self.max_gap,
        })
    }
}

/// Few convex cells, and what they add.
#[wasm_bindgen]
pub struct Coarsened {
    written: WrittenCells,
    encloses: bool,
}

fn made(subject: Subject<'_>, options: &str, keep_clear: &Operands) -> Outcome<Coarsened> {
    let (written, encloses) = written(subject, options, keep_clear)?;
    Ok(Coarsened { written, encloses })
}

/// Cells of a subject, and whether they hold it; as [`Coarsened::of_solid`].
pub(crate) fn written(subject: Subject<'_>, options: &str, keep_clear: &Operands) -> Outcome<(WrittenCells, bool)> {
    let settings: Settings = settings(options)?;
    let taken = match settings.surface {
        Surface::Auto => Taken::Auto,
        Surface::Shell => Taken::Shell,
        Surface::Filled => Taken::Filled,
    };
    Ok((coarsened(subject, taken, &settings.options(keep_clear)?)?, !settings.inner))
}

#[wasm_bindgen]
impl Coarsened {
    /// Cells around a solid, or within it; `options` is a JSON object. No cell grows into what is to be kept clear.
    ///
    /// # Errors
    /// A `PlanecutError` for options that cannot be met, and for a solid that is empty or reaches infinity.
    #[wasm_bindgen(js_name = ofSolid)]
    pub fn of_solid(solid: &Solid, options: &str, keep_clear: &Operands) -> Result<Self, JsValue> {
        Ok(made(Subject::Solid(solid.node()), options, keep_clear)?)
    }

    /// The same for a mesh, closed or not.
    ///
    /// # Errors
    /// As for a solid.
    #[wasm_bindgen(js_name = ofMesh)]
    pub fn of_mesh(mesh: &Mesh, options: &str, keep_clear: &Operands) -> Result<Self, JsValue> {
        Ok(made(Subject::Mesh(mesh.core()), options, keep_clear)?)
    }

    /// The same for the hulls of points: the coordinates of all, and how many points each hull has.
    ///
    /// # Errors
    /// As for a solid.
    #[wasm_bindgen(js_name = ofHulls)]
    pub fn of_hulls(
        coordinates: &[f64],
        lengths: &[u32],
        options: &str,
        keep_clear: &Operands,
    ) -> Result<Self, JsValue> {
        let all = points(coordinates, "hulls")?;
        let (mut hulls, mut rest): (Vec<Vec<DVec3>>, &[DVec3]) = (Vec::new(), &all);
        for &length in lengths {
            let Some((own, others)) = rest.split_at_checked(length as usize) else {
                return Err(Failure::of(format!("hulls: found {} points, expected those of all", all.len())).into());
            };
            hulls.push(own.to_vec());
            rest = others;
        }
        Ok(made(Subject::Hulls(&hulls), options, keep_clear)?)
    }

    /// The cells. They may overlap.
    #[must_use]
    pub fn cells(&self) -> Vec<Cell> {
        self.written.cells.iter().map(|cell| Cell::of_piece(&cell.piece, cell.material.name.clone())).collect()
    }

    /// The volume that the union of the cells adds, relative to that of the solid.
    #[must_use]
    pub fn excess(&self) -> f64 {
        self.written.outcome.excess()
    }

    /// The same for the sum of the volumes of the cells.
    #[wasm_bindgen(js_name = sumExcess)]
    #[must_use]
    pub fn sum_excess(&self) -> f64 {
        self.written.outcome.sum_excess()
    }

    /// Whether the cells hold all of the solid, proven by how they were made.
    #[must_use]
    pub fn encloses(&self) -> bool {
        self.encloses
    }

    /// The volume of the solid.
    #[wasm_bindgen(js_name = volumeIn)]
    #[must_use]
    pub fn volume_in(&self) -> f64 {
        self.written.outcome.volume_in
    }

    /// The volume of the union of the cells.
    #[wasm_bindgen(js_name = volumeOut)]
    #[must_use]
    pub fn volume_out(&self) -> f64 {
        self.written.outcome.volume_out
    }

    /// What was enclosed: `solid`, `filled` or `shell`.
    #[must_use]
    pub fn enclosed(&self) -> String {
        match self.written.bounded {
            None | Some(Bounded::Solid) => "solid",
            Some(Bounded::Filled) => "filled",
            Some(Bounded::Shell { .. }) => "shell",
        }
        .to_owned()
    }

    /// The thickness of a shell.
    #[must_use]
    pub fn thickness(&self) -> Option<f64> {
        match self.written.bounded {
            Some(Bounded::Shell { thickness }) => Some(thickness),
            _ => None,
        }
    }

    /// Where a radius was to be kept clear: by how much less than it a ball keeps clear.
    #[wasm_bindgen(js_name = clearTolerance)]
    #[must_use]
    pub fn clear_tolerance(&self) -> Option<f64> {
        self.written.outcome.clear_tolerance
    }

    /// How triangles were taken, where that may not be what was meant.
    #[must_use]
    pub fn note(&self) -> Option<String> {
        self.written.note.clone()
    }

    /// The union of the cells.
    #[wasm_bindgen(js_name = toSolid)]
    #[must_use]
    pub fn to_solid(&self) -> Solid {
        let WrittenCells { outcome, materials, .. } = &self.written;
        let tree = Tree::union_of(outcome.cells.clone());
        Solid::of(Node::of_model(Model { materials: materials.clone(), tree }))
    }

    /// The cells as a file of a format, by the ending of such files: each as a mesh of its own. `options` are those of the export library, as JSON.
    ///
    /// # Errors
    /// A `PlanecutError` for a format or options that there are not.
    pub fn encode(&self, format: &str, options: &str) -> Result<Vec<u8>, JsValue> {
        Ok(self.encoded(format, options)?)
    }
}

impl Coarsened {
    fn encoded(&self, format: &str, options: &str) -> Outcome<Vec<u8>> {
        let format = Format::from_extension(format).map_err(Failure::of)?;
        let options = ExportOptions { convex_colliders: true, ..settings(options)? };
        let meshes = &self.written.meshes;
        let names: Vec<String> = (0..meshes.len()).map(|number| format!("cell {number}")).collect();
        let parts: Vec<Part<'_>> = names.iter().zip(meshes).map(|(name, mesh)| Part::new(name, mesh)).collect();
        encode_parts(&parts, format, &options).map_err(Failure::of)
    }
}
