//! Meshes of a solid: its boundary, or its cells one by one.

use planecut_kernel::PlaneIdx;
use rayon::prelude::*;

use super::Solid;
use super::cell::Cell;
use crate::body::{Body, Shape};
use crate::brush::{Material, MaterialId};
use crate::evaluate::{EvaluateError, SolidMeasures, check_materials, material_ranks};
use crate::mesh::Mesh;
use crate::skin::skin_of_union;
use crate::weld::{Welded, weld};

impl Solid {
    /// The boundary as a watertight mesh, and the measures taken from it. Walls between cells are dissolved, and so are gaps
    /// between them that are no wider than the rounding of coefficients.
    ///
    /// # Errors
    /// [`EvaluateError::Unbounded`], [`EvaluateError::UnknownMaterial`] where a face names a material that is not in the
    /// list, and [`EvaluateError::Weld`] where the boundary does not close: a bug in this crate.
    pub fn mesh(&self, materials: &[Material]) -> Result<(Mesh, SolidMeasures), EvaluateError> {
        self.check_materials(materials.len())?;
        self.skin(materials, |plane| plane)
    }

    /// The area of the boundary: walls between cells do not count.
    ///
    /// # Errors
    /// [`EvaluateError::Unbounded`], and [`EvaluateError::Weld`] where the boundary does not close: a bug in this crate.
    pub fn area(&self) -> Result<f64, EvaluateError> {
        let one = [Material::default()];
        Ok(self.skin(&one, |_| MaterialId(0))?.1.area)
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
            let (edges, _) = skin_of_union(&self.table, &[body], &rank);
            Ok(weld(&self.table, &edges, &rank, materials)?.mesh)
        };
        let cells: Vec<&Cell> = self.cells().collect();
        cells.into_par_iter().map(mesh).collect()
    }

    fn skin(
        &self,
        materials: &[Material],
        material: impl Fn(MaterialId) -> MaterialId + Sync,
    ) -> Result<(Mesh, SolidMeasures), EvaluateError> {
        let cells: Vec<&Cell> = self.cells().collect();
        let bodies: Vec<Body> =
            cells.into_par_iter().map(|cell| self.body(cell, &material)).collect::<Result<_, _>>()?;
        let rank = material_ranks(materials);
        let (edges, _) = skin_of_union(&self.table, &bodies, &rank);
        let Welded { mesh, solid, .. } = weld(&self.table, &edges, &rank, materials)?;
        Ok((mesh, solid))
    }

    fn body(&self, cell: &Cell, material: impl Fn(MaterialId) -> MaterialId) -> Result<Body, EvaluateError> {
        if !cell.polytope().is_bounded() {
            return Err(EvaluateError::Unbounded);
        }
        let face = |handle: PlaneIdx| {
            let plane = cell.plane(handle).expect("each plane of the polytope is known");
            (plane.plane, material(plane.material))
        };
        let plane = |handle: PlaneIdx| {
            let id = face(handle).0;
            (self.table.row(id), self.table.half_space(id))
        };
        let shape = Shape::of(cell.polytope(), plane).ok_or(EvaluateError::Unbounded)?;
        Ok(Body::new(&shape, face))
    }

    fn check_materials(&self, count: usize) -> Result<(), EvaluateError> {
        check_materials(self.cells().flat_map(Cell::planes).map(|(_, plane)| plane.material), count)
    }
}
