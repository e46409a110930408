//! Combinations of closed meshes.

use super::input::Input;
use super::operand::Operand;
use super::winding::Windings;
use super::{Arranged, Cutting};
use crate::body::Body;
use crate::closed_mesh::WindingRule;
use crate::ids::number32;
use crate::mesh::{Flaw, Mesh, Noise, SolidMeasures};
use crate::model::{Material, MeshBody};
use crate::plane_table::PlaneTable;
use planecut_parallel::prelude::*;
use rustc_hash::FxHashMap;

/// In which of some meshes a point lies, given by their places in a list.
pub struct Inside<'a> {
    windings: &'a [(u32, i32)],
    rules: &'a [WindingRule],
    /// For each mesh its place among those that differ.
    operand_of: &'a [u32],
}

impl Inside<'_> {
    /// Whether it lies in a mesh.
    #[must_use]
    pub fn of(&self, mesh: usize) -> bool {
        let found = self.windings.binary_search_by_key(&self.operand_of[mesh], |(operand, _)| *operand);
        self.rules[self.operand_of[mesh] as usize].is_inside(found.map_or(0, |k| self.windings[k].1))
    }

    /// The meshes in which it lies, ascending.
    pub fn all(&self) -> impl Iterator<Item = usize> {
        let is_inside = |(operand, winding): &&(u32, i32)| self.rules[*operand as usize].is_inside(*winding);
        let inside: Vec<u32> = self.windings.iter().filter(is_inside).map(|(operand, _)| *operand).collect();
        let all: Vec<usize> = if self.rules.len() == self.operand_of.len() {
            inside.into_iter().map(|operand| operand as usize).collect()
        } else {
            let is_in = |mesh: &usize| inside.binary_search(&self.operand_of[*mesh]).is_ok();
            (0..self.operand_of.len()).filter(is_in).collect()
        };
        all.into_iter()
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
    let (operand_of, different) = without_copies(leaves);
    let input = Input::new(different.par_iter().map(|leaf| operand(*leaf, table)).collect(), table);
    let rules: Vec<WindingRule> = input.operands.iter().map(Operand::rule).collect();
    let value = |windings: &Windings| {
        !windings.is_empty() && is_solid(&Inside { windings, rules: &rules, operand_of: &operand_of })
    };
    let boundary = |cutting: Cutting| {
        let arranged =
            Arranged::new(&input, cutting).map_err(|_| CombineError("winding numbers contradict one another"))?;
        arranged.boundary(value).map_err(|flaw| {
            CombineError(match flaw {
                Flaw::Open => "the mesh is not closed",
                Flaw::Folded => "a triangle of the mesh faces the wrong way",
                Flaw::Measures => "the mesh has another volume or area than the solid",
            })
        })
    };
    // whatever goes wrong where cuts are joined, triangles one by one need no joining
    let (mesh, solid, noise) = boundary(Cutting::Polygons).or_else(|error| {
        debug_assert!(false, "{error}: cut as polygons");
        boundary(Cutting::Triangles)
    })?;
    Ok(CombinedMeshes { mesh: Mesh { materials, ..mesh }, solid, noise })
}

/// For each leaf its place among those that differ, and these. The same mesh in the same place is arranged once.
fn without_copies<'a>(leaves: &[Leaf<'a>]) -> (Vec<u32>, Vec<Leaf<'a>>) {
    let mut different: Vec<Leaf<'a>> = Vec::with_capacity(leaves.len());
    let mut alike: FxHashMap<[u64; 5], Vec<u32>> = FxHashMap::default();
    let mut number = |leaf: &Leaf<'a>| {
        let fresh = number32(different.len());
        if let Leaf::Mesh(mesh) = leaf {
            let known = alike.entry(looks(mesh)).or_default();
            let is_copy = |other: &&u32| matches!(different[**other as usize], Leaf::Mesh(other) if other == *mesh);
            if let Some(other) = known.iter().find(is_copy) {
                return *other;
            }
            known.push(fresh);
        }
        different.push(*leaf);
        fresh
    };
    let operand_of = leaves.iter().map(&mut number).collect();
    (operand_of, different)
}

/// Numbers that are the same for the same mesh in the same place.
fn looks(mesh: &MeshBody) -> [u64; 5] {
    let positions = mesh.mesh().positions();
    let first = positions.first().copied().unwrap_or_default().to_array().map(f64::to_bits);
    let shift = mesh.transform().offset().to_array().map(f64::to_bits);
    [
        positions.len() as u64,
        first[0] ^ first[1].rotate_left(16) ^ first[2].rotate_left(32),
        shift[0],
        shift[1],
        shift[2],
    ]
}

fn operand<'a>(leaf: Leaf<'a>, table: Option<&'a PlaneTable>) -> Operand<'a> {
    match (leaf, table) {
        (Leaf::Mesh(mesh), _) => Operand::of_mesh(mesh),
        (Leaf::Body(body), Some(table)) => Operand::of_body(table, body),
        (Leaf::Body(_), None) | (Leaf::Empty, _) => Operand::default(),
    }
}
