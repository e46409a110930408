//! Combinations of closed meshes.

use super::contact::Contacts;
use super::hidden::{Deciders, Hidden};
use super::input::Input;
use super::operand::Operand;
use super::winding::{NoWindings, Windings};
use super::{Arranged, Cutting, pairs};
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
    combine_leaves(&leaves, None, materials, is_solid, None)
}

/// The boundary of the union of closed meshes. The same as [`combine_meshes`] of all points that lie in any of them, and faster where many overlap:
/// what lies inside of others is left out early.
///
/// # Errors
/// None that the input can cause.
pub fn unite_meshes(meshes: &[MeshBody], materials: Vec<Material>) -> Result<CombinedMeshes, CombineError> {
    let leaves: Vec<Leaf<'_>> = meshes.iter().map(Leaf::Mesh).collect();
    let all = DecidingLeaves { leaves: vec![true; leaves.len()], value: true };
    combine_leaves(&leaves, None, materials, |inside| inside.all().next().is_some(), Some(&all))
}

/// Leaves that alone decide what is solid: inside of any of them the outcome is one and the same, whatever the others hold.
#[derive(Debug, Clone)]
pub(crate) struct DecidingLeaves {
    /// For each leaf whether it is one.
    pub(crate) leaves: Vec<bool>,
    /// Whether the inside of these is solid.
    pub(crate) value: bool,
}

/// Why an attempt failed.
enum Failure {
    /// Plain numbers do not tell what is decided.
    Uncertain,
    Defect(CombineError),
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

/// Operands from which on it is worth while to look for triangles that cannot be seen.
const MANY: usize = 3;

/// The boundary of a combination of leaves; `table` has the planes of those that are convex bodies. What lies inside of leaves that decide is left out early.
/// Otherwise as [`combine_meshes`].
pub(crate) fn combine_leaves(
    leaves: &[Leaf<'_>],
    table: Option<&PlaneTable>,
    materials: Vec<Material>,
    is_solid: impl Fn(&Inside<'_>) -> bool,
    deciding: Option<&DecidingLeaves>,
) -> Result<CombinedMeshes, CombineError> {
    let (operand_of, different) = without_copies(leaves);
    let input = Input::new(different.par_iter().map(|leaf| operand(*leaf, table)).collect(), table);
    let rules: Vec<WindingRule> = input.operands.iter().map(Operand::rule).collect();
    let value = |windings: &Windings| {
        !windings.is_empty() && is_solid(&Inside { windings, rules: &rules, operand_of: &operand_of })
    };
    let boundary = |cutting: Cutting, deciders: Option<&Deciders>| {
        let (contacts, faces) = pairs::contacts(&input, cutting);
        let hidden = deciders.map_or_else(Hidden::default, |them| Hidden::new(&input, &contacts, &faces, them));
        let contacts = Contacts::joined(&contacts, |triangle| !hidden.has(triangle));
        let arranged = Arranged::new(&input, (contacts, faces), cutting, &hidden).map_err(|error| match error {
            NoWindings::Uncertain => Failure::Uncertain,
            NoWindings::Contradiction => Failure::Defect(CombineError("winding numbers contradict one another")),
        })?;
        arranged.boundary(value).map_err(|flaw| {
            Failure::Defect(CombineError(match flaw {
                Flaw::Open => "the mesh is not closed",
                Flaw::Folded => "a triangle of the mesh faces the wrong way",
                Flaw::Measures => "the mesh has another volume or area than the solid",
            }))
        })
    };
    let mut is_decider = vec![false; different.len()];
    for (leaf, operand) in operand_of.iter().enumerate() {
        is_decider[*operand as usize] |= deciding.is_some_and(|deciding| deciding.leaves[leaf]);
    }
    let value_inside = deciding.is_some_and(|deciding| deciding.value);
    let deciders = Deciders { value: value_inside, is_decider };
    let is_worth_it = different.len() >= MANY && deciders.is_decider.contains(&true);
    // whatever goes wrong with less work, more work need not go wrong: triangles one by one need no joining
    let attempts =
        [(Cutting::Polygons, is_worth_it.then_some(&deciders)), (Cutting::Polygons, None), (Cutting::Triangles, None)];
    let mut error = CombineError("");
    for (cutting, deciders) in &attempts[usize::from(!is_worth_it)..] {
        match boundary(*cutting, *deciders) {
            Ok((mesh, solid, noise)) => {
                return Ok(CombinedMeshes { mesh: Mesh { materials, ..mesh }, solid, noise });
            }
            Err(Failure::Uncertain) => {}
            Err(Failure::Defect(defect)) => {
                debug_assert!(*cutting == Cutting::Triangles, "{defect}: cut as polygons");
                error = defect;
            }
        }
    }
    Err(error)
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
