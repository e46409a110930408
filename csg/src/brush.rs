//! What a model is made of: convex bodies with a material on each face.

use glam::DVec3;
use planecut_kernel::HalfSpace;

use crate::body::{Built, build_ahead};
use crate::tree::Tree;

/// Index into [`Model::materials`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct MaterialId(pub u32);

/// A named material; faces refer to it by [`MaterialId`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Material {
    /// The name, in a Quake map that of the texture.
    pub name: String,
    /// Linear RGB base colour where the input states one; otherwise the exporter derives a colour from the name.
    pub color: Option<[f32; 3]>,
    /// How metallic it is, from 0 to 1, where the input states it.
    pub metallic: Option<f32>,
    /// How rough it is, from 0 to 1, where the input states it.
    pub roughness: Option<f32>,
}

impl Material {
    /// A material of which nothing is known but its name.
    #[must_use]
    pub fn named(name: impl Into<String>) -> Self {
        Self { name: name.into(), ..Self::default() }
    }
}

/// One bounding plane of a [`Brush`] and what its face is made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BrushFace {
    /// The body lies inside this half-space.
    pub half_space: HalfSpace,
    /// The material of the face.
    pub material: MaterialId,
}

/// A convex body: the intersection of the half-spaces of its faces.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Brush {
    /// The bounding planes, in the input's order.
    pub faces: Vec<BrushFace>,
    /// A name, where the input gives one.
    pub name: Option<String>,
    /// Line of the input on which the brush begins, counted from 1; 0 where there is none.
    pub line: u32,
    /// Its body, where that was built before: see [`Model::build_bodies`].
    pub built: Built,
}

impl Brush {
    /// The body of all points within every half-space; may be unbounded or empty.
    #[must_use]
    pub fn from_half_spaces(half_spaces: impl IntoIterator<Item = HalfSpace>, material: MaterialId) -> Self {
        let faces = half_spaces.into_iter().map(|half_space| BrushFace { half_space, material }).collect();
        Self { faces, ..Self::default() }
    }

    /// The box between two corners; empty where a minimum is not below its maximum.
    ///
    /// # Panics
    /// Where a coordinate is not finite or beyond `±2^200`.
    #[must_use]
    pub fn cuboid(min: DVec3, max: DVec3, material: MaterialId) -> Self {
        let sides = DVec3::AXES.into_iter().flat_map(|axis| [(axis, axis.dot(max)), (-axis, -axis.dot(min))]);
        let half_spaces =
            sides.map(|(normal, offset)| HalfSpace::new(normal, offset).expect("finite corners, not too far away"));
        Self::from_half_spaces(half_spaces, material)
    }
}

/// A tree of brushes, and the materials that their faces name.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Model {
    /// The materials, each name once.
    pub materials: Vec<Material>,
    /// The brushes, in the input's order, and how they are combined.
    pub tree: Tree,
}

impl Model {
    /// Builds the bodies of all brushes now, in parallel, so that evaluations of this model need not, nor those of models and
    /// live models that take clones of its brushes. Outcomes are the same with and without; the bodies take memory, some
    /// 150 bytes for each face.
    ///
    /// ```
    /// use planecut_csg::{Brush, Material, MaterialId, Model, Tree, evaluate};
    /// use planecut_kernel::DVec3;
    ///
    /// # fn main() -> Result<(), planecut_csg::EvaluateError> {
    /// let block = Brush::cuboid(DVec3::ZERO, DVec3::splat(2.0), MaterialId(0));
    /// let tool = Brush::cuboid(DVec3::ONE, DVec3::splat(3.0), MaterialId(0));
    /// let mut stock = Model { materials: vec![Material::named("steel")], tree: Tree::from(block) | tool.into() };
    /// stock.build_bodies();
    /// let [block, tool] = [0, 1].map(|k| Tree::from(stock.tree.brushes()[k].clone()));
    /// let cut = Model { materials: stock.materials.clone(), tree: block - tool };
    /// assert_eq!(evaluate(&cut)?.solid.volume, 7.0);
    /// # Ok(())
    /// # }
    /// ```
    pub fn build_bodies(&mut self) {
        build_ahead(self.tree.brushes_mut());
    }
}
