//! Models cut open, so that a picture shows what is inside.

use crate::ids::number32;
use planecut_kernel::HalfSpace;
use rustc_hash::FxHashMap;

use super::{Brush, BrushFace, Material, MaterialId, Model, Tree};

/// The part of a model inside a half-space.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Cutaway {
    /// What is left. Brushes and their faces keep their numbers; each brush has one face more, the cut.
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
    /// Faces that lie on the plane already stay what they are.
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
        // Inside the half-space each brush is what it was, outside it is nothing: whatever the tree makes of the brushes, it makes the same of
        // them inside, and outside what it makes of nothing.
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

/// How the cut through a material is called, and what it looks like.
fn cut_through(material: Option<&Material>) -> Material {
    match material {
        Some(material) => Material { name: format!("{} {}", material.name, SUFFIX), ..material.clone() },
        None => Material::named(SUFFIX),
    }
}
