//! Convex pieces as typed arrays.

use js_sys::{Float32Array, Uint32Array};
use planecut::csg::{Mesh, Solid};
use planecut::kernel::DVec3;
use wasm_bindgen::prelude::*;

use crate::editor::Editor;
use crate::failure::{Failure, Outcome};

/// Meshes one after another, relative to a centre.
#[wasm_bindgen(getter_with_clone)]
#[derive(Clone)]
pub struct Pieces {
    /// For each piece how many vertices and triangles it has.
    pub counts: Uint32Array,
    /// x, y and z of each vertex, piece by piece.
    pub positions: Float32Array,
    /// Three vertices of each triangle, counted within the piece.
    pub triangles: Uint32Array,
    /// The number of the material of each triangle.
    pub materials: Uint32Array,
}

impl Pieces {
    pub(crate) fn of(meshes: &[Mesh], center: DVec3) -> Self {
        let (mut counts, mut positions) = (Vec::new(), Vec::new());
        let (mut triangles, mut materials) = (Vec::new(), Vec::new());
        for mesh in meshes {
            counts.extend([mesh.positions.len() as u32, mesh.triangles.len() as u32]);
            positions.extend(mesh.positions.iter().flat_map(|at| (at - center).as_vec3().to_array()));
            triangles.extend(mesh.triangles.iter().flatten());
            materials.extend(mesh.triangle_faces.iter().map(|face| mesh.faces[*face as usize].material.0));
        }
        Self {
            counts: Uint32Array::from(&counts[..]),
            positions: Float32Array::from(&positions[..]),
            triangles: Uint32Array::from(&triangles[..]),
            materials: Uint32Array::from(&materials[..]),
        }
    }
}

#[wasm_bindgen]
impl Editor {
    /// The disjoint convex cells of the solid.
    ///
    /// # Errors
    /// A `PlanecutError` for a solid that reaches infinity.
    pub fn cells(&self) -> Result<Pieces, JsValue> {
        Ok(self.cells_of()?)
    }
}

impl Editor {
    fn cells_of(&self) -> Outcome<Pieces> {
        let model = self.live().to_model();
        let mut cells = Solid::from_tree(&model.tree).cell_meshes(&model.materials).map_err(Failure::of)?;
        // slivers between planes that differ by mere rounding
        cells.retain(|mesh| !mesh.triangles.is_empty());
        Ok(Pieces::of(&cells, self.relative_to()))
    }
}
