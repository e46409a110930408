//! Combinations of closed meshes.

use super::Arranged;
use super::operand::{Operand, surface, trees};
use super::triangle_tree::TriangleTree;
use super::winding::Windings;
use crate::closed_mesh::WindingRule;
use crate::mesh::{Flaw, Mesh, Noise, SolidMeasures};
use crate::model::{Material, MeshBody};

/// In which of some meshes a point lies, given by their places in a list.
pub struct Inside<'a> {
    windings: &'a [(u32, i32)],
    rules: &'a [WindingRule],
}

impl Inside<'_> {
    /// Whether it lies in a mesh.
    #[must_use]
    pub fn of(&self, mesh: usize) -> bool {
        let found = self.windings.binary_search_by_key(&mesh, |(operand, _)| *operand as usize);
        self.rules[mesh].is_inside(found.map_or(0, |k| self.windings[k].1))
    }

    /// The meshes in which it lies, ascending.
    pub fn all(&self) -> impl Iterator<Item = usize> {
        let is_inside = |(operand, winding): &&(u32, i32)| self.rules[*operand as usize].is_inside(*winding);
        self.windings.iter().filter(is_inside).map(|(operand, _)| *operand as usize)
    }
}

/// The boundary of a combination of meshes.
#[derive(Debug, Clone, Default)]
pub struct CombinedMeshes {
    /// A closed mesh. Triangles that no other touches are those of the input.
    pub mesh: Mesh,
    /// Volume, area, centroid and extent of the solid.
    pub solid: SolidMeasures,
    /// What was removed from the mesh because rounding had left no room for it.
    pub noise: Noise,
}

/// Why a combination failed: a defect of this crate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("internal error: {0}; please report these meshes")]
pub struct CombineError(&'static str);

/// The boundary of a combination of closed meshes: of all points for which `is_solid` holds, asked in which of the meshes they lie. Points
/// that lie in none are taken to be outside.
///
/// Exact: vertices are those of the input and points in which edges and planes of the input meet, correctly rounded; every decision
/// before that is the sign of a polynomial in the coordinates.
///
/// # Errors
/// None that the input can cause.
pub fn combine_meshes(
    meshes: &[MeshBody],
    materials: Vec<Material>,
    is_solid: impl Fn(&Inside<'_>) -> bool,
) -> Result<CombinedMeshes, CombineError> {
    let operands: Vec<Operand> = meshes.iter().map(Operand::new).collect();
    let rules: Vec<WindingRule> = operands.iter().map(|operand| operand.rule).collect();
    let operands: Vec<&Operand> = operands.iter().collect();
    let (all, is_flat) = surface(&operands);
    let trees = trees(&operands);
    let trees: Vec<&TriangleTree> = trees.iter().collect();
    let arranged = Arranged::new(all, &trees, &vec![false; meshes.len()], is_flat)
        .map_err(|_| CombineError("winding numbers contradict one another"))?;
    let value = |windings: &Windings| !windings.is_empty() && is_solid(&Inside { windings, rules: &rules });
    let (mesh, solid, noise) = arranged.boundary(value).map_err(|flaw| {
        CombineError(match flaw {
            Flaw::Open => "the mesh is not closed",
            Flaw::Folded => "a triangle of the mesh faces the wrong way",
            Flaw::Measures => "the mesh has another volume or area than the solid",
        })
    })?;
    Ok(CombinedMeshes { mesh: Mesh { materials, ..mesh }, solid, noise })
}
