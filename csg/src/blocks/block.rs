//! One block, evaluated on its own.

use std::num::NonZeroU32;

use glam::DVec3;
use planecut_kernel::sign::Counts;

use super::contents::BlockTree;
use super::grid::{BlockSides, add_walls};
use super::scatter::BlockOperation;
use super::seams::SeamEdges;
use crate::base::Bounds;
use crate::body::BuiltBodies;
use crate::evaluate::{EvaluateError, Evaluation, OtherBrushes, UnboundedBrushes, evaluate_among};
use crate::expression::Polarity;
use crate::ids::number32;
use crate::mesh::{Mesh, Noise, SolidMeasures};
use crate::model::{Brush, Material, MaterialId, Model};

/// The boundary of a solid within a box.
#[derive(Debug, Clone, PartialEq)]
pub struct Block {
    /// The corner of the box of smallest coordinates.
    pub min: DVec3,
    /// The corner of largest coordinates.
    pub max: DVec3,
    /// The part of the boundary in the box: closed but for edges on the walls to other blocks, where theirs go on.
    pub mesh: Mesh,
    /// The volume of the solid within the box.
    pub volume: f64,
    /// Measures of the solid within the box; the area is that of [`mesh`](Self::mesh), without the walls.
    pub solid: SolidMeasures,
    /// The edges in which the mesh ends on walls.
    pub seams: SeamEdges,
    /// What was removed from the mesh as rounding noise.
    pub noise: Noise,
    /// The signs that were asked for.
    pub signs: Counts,
}

/// A block on the way: what it was told goes in, in the order in which it was told.
///
/// What comes out depends on nothing else: any machine makes the same of it.
#[derive(Debug)]
pub struct BlockBuilder {
    tree: BlockTree,
    bounds: Bounds,
    wall: MaterialId,
}

impl BlockBuilder {
    /// A block of a box ([`BlockGrid::bounds`](super::BlockGrid::bounds)), in a model with this number of materials.
    #[must_use]
    pub fn new(bounds: Bounds, materials: usize) -> Self {
        Self { tree: BlockTree::default(), bounds, wall: MaterialId(number32(materials)) }
    }

    /// Adds a brush, with the sides over which it reaches and whether it adds to the solid of the whole model
    /// ([`SharedBrushes::polarity`](super::SharedBrushes::polarity)).
    pub fn leaf(&mut self, mut brush: Brush, line: Option<NonZeroU32>, sides: BlockSides, polarity: Polarity) {
        add_walls(&mut brush, sides, &self.bounds, self.wall);
        self.tree.leaf(brush, line, polarity);
    }

    /// Adds an operation on what came last; `None` where there is not so much.
    pub fn operation(&mut self, told: &BlockOperation) -> Option<()> {
        self.tree.operation(told)
    }

    /// Evaluates the block. `size` is that of the smallest brush of the whole model ([`BlockSurvey::size`](super::BlockSurvey::size)).
    ///
    /// # Errors
    /// [`EvaluateError`], as for a model that is evaluated at once.
    pub fn evaluate(self, mut materials: Vec<Material>, size: f64) -> Result<Block, EvaluateError> {
        let Self { tree, bounds, wall } = self;
        // the material of walls
        materials.push(Material::default());
        let (tree, polarities) = tree.finish();
        let model = Model { materials, tree };
        let others = OtherBrushes { size, polarities: Some(&polarities), walls: Some(wall) };
        let evaluation = evaluate_among(&model, UnboundedBrushes::Keep, &BuiltBodies::default(), others)?;
        let Evaluation { mut mesh, mut solid, noise, signs, .. } = evaluation;
        let triangles = mesh.triangles.len();
        let seams = SeamEdges::part(&mut mesh, wall, &bounds);
        mesh.materials = model.materials;
        mesh.materials.pop();
        if mesh.triangles.len() < triangles {
            solid.area = area_of(&mesh);
        }
        Ok(Block { min: bounds.min, max: bounds.max, mesh, volume: solid.volume, solid, seams, noise, signs })
    }
}

fn area_of(mesh: &Mesh) -> f64 {
    let corners = mesh.triangles.iter().map(|triangle| triangle.map(|vertex| mesh.positions[vertex as usize]));
    corners.map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).sum()
}
