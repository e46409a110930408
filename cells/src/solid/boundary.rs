//! Meshes of a solid: its boundary, or its cells one by one.

use planecut_csg::stages::{Body, check_materials, material_ranks, mesh_of_union};
use planecut_csg::{EvaluateError, Material, MaterialId, Mesh, SolidMeasures, UsedMaterials};
use planecut_kernel::PlaneIdx;
use planecut_parallel::prelude::*;

use super::Solid;
use super::cell::Cell;

impl Solid {
    /// The boundary as a watertight mesh, and the measures taken from it. Walls between cells are dissolved, and so are gaps
    /// between them that are no wider than the rounding of coefficients.
    ///
    /// # Errors
    /// [`EvaluateError::Unbounded`], [`EvaluateError::UnknownMaterial`] where a face names a material that is not in the
    /// list, and [`EvaluateError::Weld`] where the boundary does not close: a bug in this crate.
    pub fn mesh(&self, materials: &[Material]) -> Result<(Mesh, SolidMeasures), EvaluateError> {
        self.check_materials(materials.len())?;
        self.boundary(materials, |plane| plane)
    }

    /// The area of the boundary: walls between cells do not count.
    ///
    /// # Errors
    /// [`EvaluateError::Unbounded`], and [`EvaluateError::Weld`] where the boundary does not close: a bug in this crate.
    pub fn area(&self) -> Result<f64, EvaluateError> {
        let one = [Material::default()];
        Ok(self.boundary(&one, |_| MaterialId(0))?.1.area)
    }

    /// One closed mesh for each cell, in their order.
    ///
    /// # Errors
    /// As [`Solid::mesh`].
    pub fn cell_meshes(&self, materials: &[Material]) -> Result<Vec<Mesh>, EvaluateError> {
        self.check_materials(materials.len())?;
        let rank = material_ranks(materials);
        let mesh = |cell: &Cell| {
            let body = self.body(cell, |material| material)?;
            Ok(mesh_of_union(&self.table, &[body], &rank, materials)?.0)
        };
        let cells: Vec<&Cell> = self.cells().collect();
        cells.into_par_iter().map(mesh).collect()
    }

    /// The same where each has the materials of its own faces alone, and which these are: with as many materials as faces, a list of all of them in each
    /// cell would fill memory.
    ///
    /// # Errors
    /// As [`Solid::mesh`].
    pub fn cell_meshes_with_used_materials(
        &self,
        materials: &[Material],
    ) -> Result<Vec<(Mesh, UsedMaterials)>, EvaluateError> {
        self.check_materials(materials.len())?;
        let mesh = |cell: &Cell| {
            let used = UsedMaterials::of(cell.planes().map(|(_, plane)| plane.material));
            let own = used.select(materials);
            let body = self.body(cell, |material| used.number(material))?;
            Ok((mesh_of_union(&self.table, &[body], &material_ranks(&own), &own)?.0, used))
        };
        let cells: Vec<&Cell> = self.cells().collect();
        cells.into_par_iter().map(mesh).collect()
    }

    fn boundary(
        &self,
        materials: &[Material],
        material: impl Fn(MaterialId) -> MaterialId + Sync,
    ) -> Result<(Mesh, SolidMeasures), EvaluateError> {
        let cells: Vec<&Cell> = self.cells().collect();
        let bodies: Vec<Body> =
            cells.into_par_iter().map(|cell| self.body(cell, &material)).collect::<Result<_, _>>()?;
        Ok(mesh_of_union(&self.table, &bodies, &material_ranks(materials), materials)?)
    }

    fn body(&self, cell: &Cell, material: impl Fn(MaterialId) -> MaterialId) -> Result<Body, EvaluateError> {
        let face = |handle: PlaneIdx| {
            let plane = cell.plane(handle).expect("each plane of the polytope is known");
            (plane.plane, material(plane.material))
        };
        Body::of_polytope(&self.table, cell.polytope(), face).ok_or(EvaluateError::Unbounded)
    }

    fn check_materials(&self, count: usize) -> Result<(), EvaluateError> {
        check_materials(self.cells().flat_map(Cell::planes).map(|(_, plane)| plane.material), count)
    }
}
