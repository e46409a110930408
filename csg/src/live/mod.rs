//! A model that takes edits, each for what it touches.
//!
//! Kept are the body of each brush, for each of its faces the boundary edges on it, and all that the weld makes of them. An
//! edit of a brush changes the boundary only within the old and the new extent of the brush: the faces that reach into these
//! are worked out again among the bodies near them, and of their edges those that are new or gone are handed to the weld.
//!
//! - [`brush_edits`], [`copies`]: what users do to brushes, [`edit`]: all that they do as values, [`step`]: several at once, [`history`]: undo and redo; [`error`]: why an edit is refused.
//! - [`preview`]: what an edit would change, [`removal`]: what a brush would gain without a plane, [`snap`]: where a plane may be meant to go. None of these changes anything.
//! - [`change`]: how a change of brushes goes through [`planes`], [`bodies`], [`boundary`] and weld; [`polytopes`] are kept to
//!   build bodies from, [`reach`] tells which faces are to be worked out again.
//! - [`in_place`]: a plane that moves so little that nothing but places changes.
//! - [`tree`]: how brushes are combined, [`order`]: all of it as a tree; [`operand`]: what is known of each brush.
//! - [`meshes`]: where a brush is a closed mesh, the boundary is [`evaluated`] as a whole by each edit; [`face`]: what users see of either,
//!   [`pick`]: which face a ray meets, [`measures`]: volume and area, [`buffers`]: what renderers take.

mod bodies;
mod boundary;
mod brush_edits;
mod buffers;
mod change;
mod copies;
mod edit;
mod error;
mod evaluated;
mod face;
mod history;
mod in_place;
mod measures;
mod meshes;
mod operand;
mod order;
mod pick;
mod planes;
mod polytopes;
mod preview;
mod reach;
mod removal;
mod snap;
mod step;
mod tree;

use crate::ids::number32;
use std::collections::{BTreeMap, BTreeSet};
use std::num::NonZeroU32;
use std::sync::{Arc, Mutex};

use planecut_kernel::PlaneIdx;
use rustc_hash::FxHashSet;

use crate::base::Bounds;
use crate::body::{Body, BuiltBodies, OuterBox, ShapeBuilder};
use crate::boundary::BoundaryEdge;
use crate::evaluate::{EvaluateError, UnboundedBrushes, check_materials, material_ranks};
pub use crate::ids::FaceId;
use crate::ids::{BodyFaceId, BodyId, Id, OperandFace, OperandId};
use crate::mesh::Mesh;
use crate::model::{Brush, Material, MaterialId, Model};
use crate::plane_table::PlaneTable;
use crate::weld::{LiveWeld, weld};
use bodies::Marks;
use boundary::EmitBuffers;
pub use buffers::{FaceBuffers, FaceRange, ModelBuffers};
pub use edit::{Edit, Edited};
pub use error::EditError;
use evaluated::EvaluatedBoundary;
pub use face::LiveFace;
use history::{History, States};
use measures::KeptMeasures;
pub use operand::Role;
use operand::{Operand, Places, State};
use planes::LivePlanes;
use polytopes::KeptPolytopes;
pub use preview::{Preview, PreviewFace};
pub use removal::{ConvexPiece, PlaneRemoval};
pub use snap::{Snap, SnapOptions, SnapTarget};
pub use tree::{LiveNode, NodeId, TreeOperand};
use tree::{LiveTree, Member, Read, read};

/// A brush of a [`LiveModel`]: brushes are numbered from 0 as they are added, and no number is given twice.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct BrushId(pub u64);

/// What an edit has changed: faces are planar, connected regions of one material.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Change {
    /// The brushes that came, went, or are of other planes, roles or places: those that were edited, and those of which a plane
    /// is nearly the same as one that came or went, and so taken for another than before.
    pub brushes: Vec<BrushId>,
    /// The faces that are no more.
    pub removed: Vec<FaceId>,
    /// Those that are new; their numbers may be those of faces that were removed.
    pub added: Vec<FaceId>,
}

impl Change {
    /// This change and one after it as one: faces that came and went again are in neither list.
    #[must_use]
    pub fn then(self, next: Self) -> Self {
        let brushes: BTreeSet<BrushId> = self.brushes.into_iter().chain(next.brushes).collect();
        let mut removed: BTreeSet<FaceId> = self.removed.into_iter().collect();
        let mut added: BTreeSet<FaceId> = self.added.into_iter().collect();
        for face in next.removed {
            // a number that stands for a face that is not new
            if !added.remove(&face) {
                removed.insert(face);
            }
        }
        added.extend(next.added);
        Self {
            brushes: brushes.into_iter().collect(),
            removed: removed.into_iter().collect(),
            added: added.into_iter().collect(),
        }
    }
}

/// Brushes in order, each with a [`Role`], and the boundary of the solid that they make.
///
/// The solid is what is left when one brush after another is added to it, taken from it or intersected with it. Brushes may be
/// unbounded or empty; the solid must be bounded, or the edit is refused.
///
/// Brushes may be closed meshes, too. As long as one is, each edit takes as long as [`evaluate`](crate::evaluate) of the whole model. The edit by
/// which the first mesh comes, or the last one goes, removes all faces and adds all of what is there then.
///
/// ```
/// use planecut_csg::{Brush, LiveModel, Material, MaterialId, Role};
/// use planecut_kernel::{DVec3, HalfSpace};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let cube = |min: f64, max: f64| Brush::cuboid(DVec3::splat(min), DVec3::splat(max), MaterialId(0));
/// let mut model = LiveModel::new(vec![Material::named("stone")]);
/// let (block, _) = model.add_brush(cube(0.0, 3.0), Role::Add)?;
/// let (hole, change) = model.add_brush(cube(1.0, 2.0), Role::Subtract)?;
/// assert_eq!((change.removed.len(), change.added.len()), (0, 6));
/// let (cut, _) = model.add_plane(block, HalfSpace::new(DVec3::X, 1.5)?, MaterialId(0))?;
/// model.remove_plane(block, cut)?;
/// model.undo()?;
/// model.undo()?;
/// assert_eq!(model.faces().count(), 12);
/// # Ok(())
/// # }
/// ```
pub struct LiveModel {
    materials: Vec<Material>,
    /// Orders materials by name.
    rank: Vec<u32>,
    planes: LivePlanes,
    outer: OuterBox,
    /// Indices of planes that no brush has any more, while points or lines are still known by them.
    waiting: FxHashSet<u32>,
    operands: Vec<Option<Operand>>,
    free: Vec<OperandId>,
    by_id: BTreeMap<BrushId, OperandId>,
    next_id: u64,
    /// Bodies that are built already.
    built: BuiltBodies,
    /// What becomes of brushes that are not bounded.
    unbounded: UnboundedBrushes,
    /// How brushes are combined.
    tree: LiveTree,
    places: Places,
    /// How many bodies have equal faces.
    marks: Marks,
    polytopes: KeptPolytopes,
    /// How many bodies have a face on each plane; 255 stands for more as well, until none has one any more.
    bodies_on_plane: Vec<u8>,
    welded: LiveWeld,
    /// How many brushes are closed meshes.
    meshes: usize,
    /// The boundary, where some are.
    evaluated: Option<EvaluatedBoundary>,
    history: History,
    measured: KeptMeasures,
    buffers: Buffers,
}

#[derive(Default)]
struct Buffers {
    builder: Option<ShapeBuilder>,
    /// The faces to be worked out again.
    faces: Vec<OperandFace>,
    /// The body of each brush among those near.
    place: Vec<BodyId>,
    /// The face on each plane of a body.
    face_on_plane: Vec<BodyFaceId>,
    /// What is around a change.
    surroundings: Vec<(Member, Bounds)>,
    /// What is near the faces of each body, and what is near any.
    near: [Vec<Member>; 2],
    /// One thread works with it; it is in a lock that is never taken, so that threads may share a model.
    emit: Mutex<Option<Box<EmitBuffers>>>,
}

impl LiveModel {
    /// A model without brushes, of faces of some materials.
    #[must_use]
    pub fn new(materials: Vec<Material>) -> Self {
        let mut table = PlaneTable::default();
        let outer = OuterBox::farthest(&mut table);
        Self {
            rank: material_ranks(&materials),
            materials,
            planes: LivePlanes::new(table),
            outer,
            waiting: FxHashSet::default(),
            operands: Vec::new(),
            free: Vec::new(),
            by_id: BTreeMap::new(),
            next_id: 0,
            built: BuiltBodies::default(),
            unbounded: UnboundedBrushes::Keep,
            tree: LiveTree::default(),
            places: Places::default(),
            marks: Marks::default(),
            polytopes: KeptPolytopes::default(),
            bodies_on_plane: Vec::new(),
            welded: LiveWeld::default(),
            meshes: 0,
            evaluated: None,
            history: History::default(),
            measured: KeptMeasures::default(),
            buffers: Buffers::default(),
        }
    }

    /// A model to begin with. Its brushes have their numbers. What its tree combines one after another has roles, brushes as well as operations that are nested; these are numbered in the
    /// order in which they begin when the tree is read from left to right. That cannot be undone as an edit.
    ///
    /// # Errors
    /// [`EditError::Evaluate`].
    pub fn from_model(model: Model) -> Result<Self, EditError> {
        Self::from_model_with(model, UnboundedBrushes::Keep)
    }

    /// The same, with a choice for unbounded brushes, those that become so later included.
    ///
    /// # Errors
    /// As [`LiveModel::from_model`].
    pub fn from_model_with(model: Model, unbounded: UnboundedBrushes) -> Result<Self, EditError> {
        let Model { materials, tree } = model;
        let mut live = Self { unbounded, ..Self::new(materials) };
        let Read { brushes: places, nodes } = read(tree.nodes());
        let lines: Vec<Option<NonZeroU32>> = tree.source_lines().collect();
        let brushes = tree.into_brushes().into_iter().zip(places).zip(lines);
        let states = brushes.map(|((brush, (place, role)), line)| State { line, place, ..State::new(brush, role) });
        let mut new =
            States { nodes: nodes.into_iter().map(|(id, node)| (id, Some(node))).collect(), ..States::default() };
        for (id, state) in (0..).map(BrushId).zip(states) {
            live.check_materials(&state.brush)?;
            new.brushes.insert(id, Some(Arc::new(state)));
        }
        live.next_id = new.brushes.len() as u64;
        live.change(new)?;
        Ok(live)
    }

    /// The same model as a tree, to be evaluated or kept. Brushes are renumbered, without those that were taken out of a
    /// sequence.
    #[must_use]
    pub fn to_model(&self) -> Model {
        self.model_after(&[])
    }

    /// The materials; faces name them by their places.
    #[must_use]
    pub fn materials(&self) -> &[Material] {
        &self.materials
    }

    /// Adds a material, for faces to come. That is no edit: it cannot be undone.
    pub fn add_material(&mut self, material: Material) -> MaterialId {
        if let Some(evaluated) = &mut self.evaluated {
            evaluated.add_material(material.clone());
        }
        self.materials.push(material);
        self.rank = material_ranks(&self.materials);
        MaterialId(number32(self.materials.len()) - 1)
    }

    /// Forgets all materials but the first ones, which no face names.
    fn keep_materials(&mut self, count: usize) {
        if let Some(evaluated) = &mut self.evaluated {
            evaluated.keep_materials(count);
        }
        self.materials.truncate(count);
        self.rank = material_ranks(&self.materials);
    }

    /// Gives bodies that are built already: brushes to come that have one of them are not built.
    pub fn set_built_bodies(&mut self, bodies: BuiltBodies) {
        self.built = bodies;
    }

    /// The brushes, in their order.
    pub fn brushes(&self) -> impl ExactSizeIterator<Item = BrushId> {
        self.by_id.keys().copied()
    }

    /// A brush and its role; the role says nothing for an operand of a nested operation.
    ///
    /// # Errors
    /// [`EditError::UnknownBrush`].
    pub fn brush(&self, id: BrushId) -> Result<(&Brush, Role), EditError> {
        self.state(id).map(|state| (&state.brush, state.role))
    }

    /// The handles of the planes of a brush, in the order of its faces: at first counted from 0; none is given twice.
    ///
    /// # Errors
    /// [`EditError::UnknownBrush`].
    pub fn planes(&self, id: BrushId) -> Result<&[PlaneIdx], EditError> {
        self.state(id).map(|state| state.planes.as_slice())
    }

    /// How many triangles the faces have.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        self.evaluated.as_ref().map_or_else(|| self.welded.triangle_count(), |all| all.mesh().triangles.len())
    }

    /// A face, where there is one of this number.
    #[must_use]
    pub fn face(&self, id: FaceId) -> Option<LiveFace<'_>> {
        match &self.evaluated {
            Some(evaluated) => evaluated.face(id),
            None => self.welded.face(id).map(LiveFace::welded),
        }
    }

    /// All faces.
    pub fn faces(&self) -> impl Iterator<Item = (FaceId, LiveFace<'_>)> {
        let evaluated = self.evaluated.iter();
        let of_evaluated = evaluated.flat_map(|all| all.ids().iter().filter_map(|id| Some((*id, all.face(*id)?))));
        let welded = self.welded.faces().filter(|_| self.evaluated.is_none());
        welded.map(|(id, face)| (id, LiveFace::welded(face))).chain(of_evaluated)
    }

    /// Whether the faces are those of the mesh. They are not where solids alternate around a line, so that faces cross
    /// in it: what an exclusive or of three half-spaces does.
    #[must_use]
    pub fn has_faces(&self) -> bool {
        self.evaluated.is_some() || !self.welded.has_crossings()
    }

    /// The mesh of the solid, equal to that of the same model built from scratch.
    ///
    /// # Errors
    /// [`EvaluateError::Weld`]: a bug in this crate.
    pub fn mesh(&self) -> Result<Mesh, EvaluateError> {
        if let Some(evaluated) = &self.evaluated {
            return Ok(evaluated.mesh().clone());
        }
        let operands = self.operands.iter().flatten();
        let edges: Vec<BoundaryEdge> =
            operands.flat_map(|operand| &operand.edges).flatten().map(|edge| edge.0).collect();
        Ok(weld(&self.planes.table, edges, &self.rank, &self.materials, None)?.mesh)
    }

    fn number(&self, id: BrushId) -> Result<OperandId, EditError> {
        self.by_id.get(&id).copied().ok_or(EditError::UnknownBrush(id))
    }

    fn state(&self, id: BrushId) -> Result<&Arc<State>, EditError> {
        let operand = self.operands[self.number(id)?.index()].as_ref();
        operand.map(|operand| &operand.state).ok_or(EditError::UnknownBrush(id))
    }

    /// A brush that is there, or was at the beginning of the edit.
    fn operand(&self, number: OperandId) -> &Operand {
        self.operands[number.index()].as_ref().expect("the number of a brush that is there")
    }

    /// The body of a brush that has one.
    fn body_at(&self, number: OperandId) -> &Body {
        self.operand(number).body.as_ref().expect("what has a place or faces has a body")
    }

    fn check_materials(&self, brush: &Brush) -> Result<(), EvaluateError> {
        check_materials(brush.materials(), self.materials.len())
    }
}
