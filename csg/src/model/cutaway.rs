//! Models cut open, so that a picture shows what is inside.

use crate::base::Bounds;
use crate::ids::number32;
use glam::DVec3;
use planecut_kernel::{HalfSpace, IncrementalPolytope};
use rustc_hash::FxHashMap;

use super::{Brush, BrushFace, Material, MaterialId, Model, Tree};

/// The part of a model inside a half-space.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Cutaway {
    /// What is left. Brushes and their faces keep their numbers; each brush has one face more, the cut. Where a leaf is a closed mesh, there is
    /// one leaf more instead.
    pub model: Model,
    /// The materials of the faces that were cut: they follow those of the whole.
    pub cuts: Vec<CutMaterial>,
}

/// The material of cut faces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct CutMaterial {
    /// Its number among the materials of the model that was cut open.
    pub id: MaterialId,
    /// The material that was cut, whose looks it has; `None` for cuts through brushes of several materials.
    pub of: Option<MaterialId>,
}

/// What the names of cut materials end with, for people: behind the name of the material and a space, or alone.
const SUFFIX: &str = "(cut)";

impl Model {
    /// Cuts the model open along the plane of a half-space. Where it goes through a brush that is made of one material, the face of the cut has that
    /// material's own for cuts, of the same looks; brushes whose faces differ, as the textures of a map do, share one without a name.
    /// Faces that lie on the plane already stay what they are, but for those of closed meshes among leaves of several materials.
    ///
    /// ```
    /// use planecut_csg::{Brush, Material, MaterialId, Model, Tree, evaluate};
    /// use planecut_kernel::{DVec3, HalfSpace};
    ///
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let block = |low: f64, high: f64| Brush::cuboid(DVec3::splat(low), DVec3::splat(high), MaterialId(0));
    /// let tree = Tree::from(block(0.0, 4.0)) - block(1.0, 3.0).into();
    /// let cut = Model { materials: vec![Material::named("oak")], tree }.cut_open(&HalfSpace::new(DVec3::X, 2.0)?);
    /// assert_eq!(evaluate(&cut.model)?.solid.volume, 2.0 * 16.0 - 4.0);
    /// assert_eq!(cut.model.materials[cut.cuts[0].id.0 as usize].name, "oak (cut)");
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn cut_open(&self, half_space: &HalfSpace) -> Cutaway {
        let Self { mut materials, mut tree } = self.clone();
        let (mut cuts, mut known) = (Vec::new(), FxHashMap::default());
        let mut cut_of = |inside: Option<MaterialId>| {
            *known.entry(inside).or_insert_with(|| {
                let id = MaterialId(number32(materials.len()));
                let of = inside.filter(|id| (id.0 as usize) < self.materials.len());
                materials.push(cut_through(of.map(|id| &self.materials[id.0 as usize])));
                cuts.push(CutMaterial { id, of });
                id
            })
        };
        // Inside the half-space each convex brush is what it was, outside it is nothing: whatever the tree makes of the brushes, it makes the same of
        // them inside, and outside what it makes of nothing.
        if tree.has_meshes() {
            let rest = Brush::from_half_spaces(walls(&tree, half_space), cut_of(common_material(&tree)));
            tree = Tree::intersection([tree, rest.into()]);
            return Cutaway { model: Self { materials, tree }, cuts };
        }
        for brush in tree.brushes_mut() {
            brush.faces.push(BrushFace { half_space: *half_space, material: cut_of(inside_of(brush)) });
        }
        if tree.holds_outside() {
            let rest = Brush::from_half_spaces([*half_space], cut_of(None));
            tree = Tree::intersection([tree, rest.into()]);
        }
        Cutaway { model: Self { materials, tree }, cuts }
    }
}

/// The material that a brush is made of, if all its faces are of one.
fn inside_of(brush: &Brush) -> Option<MaterialId> {
    let material = brush.faces.first()?.material;
    brush.faces.iter().all(|face| face.material == material).then_some(material)
}

/// The material that all leaves of a tree are made of, if that is one.
fn common_material(tree: &Tree) -> Option<MaterialId> {
    let mut materials = tree.brushes().iter().flat_map(Brush::materials);
    let first = materials.next()?;
    materials.all(|material| material == first).then_some(first)
}

/// A half-space, with walls around all that is bounded: closed meshes are combined with bounded bodies alone.
fn walls(tree: &Tree, half_space: &HalfSpace) -> Vec<HalfSpace> {
    let of_meshes = tree.meshes().flat_map(|mesh| mesh.positions().into_owned());
    let of_bodies = tree.brushes().iter().filter(|brush| !brush.is_mesh()).flat_map(corners);
    let points = of_meshes.chain(of_bodies).map(|point| Bounds { min: point, max: point });
    let all = points.reduce(|all, point| all.union(&point)).unwrap_or(Bounds { min: DVec3::ZERO, max: DVec3::ZERO });
    // out of the way of all faces
    let margin = 1.0 + (all.max - all.min).max_element();
    let wall = |axis: DVec3, offset: f64| HalfSpace::new(axis, offset + margin);
    let walls =
        DVec3::AXES.into_iter().flat_map(|axis| [wall(axis, axis.dot(all.max)), wall(-axis, -axis.dot(all.min))]);
    std::iter::once(*half_space).chain(walls.flatten()).collect()
}

/// The corners of a convex brush that is bounded.
fn corners(brush: &Brush) -> Vec<DVec3> {
    let mut polytope = IncrementalPolytope::new();
    brush.half_spaces().for_each(|half_space| {
        polytope.add_plane(*half_space);
    });
    if polytope.is_empty() || !polytope.is_bounded() { Vec::new() } else { polytope.to_mesh().0 }
}

/// How the cut through a material is called, and what it looks like.
fn cut_through(material: Option<&Material>) -> Material {
    match material {
        Some(material) => Material { name: format!("{} {}", material.name, SUFFIX), ..material.clone() },
        None => Material::named(SUFFIX),
    }
}
