//! Combinations of closed meshes.

use super::Arranged;
use super::input::Input;
use super::operand::Operand;
use super::winding::Windings;
use crate::body::Body;
use crate::closed_mesh::WindingRule;
use crate::mesh::{Flaw, Mesh, Noise, SolidMeasures};
use crate::model::{Material, MeshBody};
use crate::plane_table::PlaneTable;
use planecut_parallel::prelude::*;

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
    let leaves: Vec<Leaf<'_>> = meshes.iter().map(Leaf::Mesh).collect();
    combine_leaves(&leaves, None, materials, is_solid)
}

/// A leaf of a tree.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Leaf<'a> {
    /// A closed mesh.
    Mesh(&'a MeshBody),
    /// A convex body whose planes are in a table.
    Body(&'a Body),
    /// Nothing.
    Empty,
}

/// The boundary of a combination of leaves; `table` has the planes of those that are convex bodies. Otherwise as [`combine_meshes`].
pub(crate) fn combine_leaves(
    leaves: &[Leaf<'_>],
    table: Option<&PlaneTable>,
    materials: Vec<Material>,
    is_solid: impl Fn(&Inside<'_>) -> bool,
) -> Result<CombinedMeshes, CombineError> {
    let input = Input::new(leaves.par_iter().map(|leaf| operand_of(*leaf, table)).collect(), table);
    let rules: Vec<WindingRule> = input.operands.iter().map(Operand::rule).collect();
    let arranged = Arranged::new(&input).map_err(|_| CombineError("winding numbers contradict one another"))?;
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

fn operand_of<'a>(leaf: Leaf<'a>, table: Option<&PlaneTable>) -> Operand<'a> {
    match (leaf, table) {
        (Leaf::Mesh(mesh), _) => Operand::of_mesh(mesh),
        (Leaf::Body(body), Some(table)) => Operand::of_body(table, body),
        (Leaf::Body(_), None) | (Leaf::Empty, _) => Operand::default(),
    }
}
