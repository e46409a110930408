//! From a model to its solid's mesh, stage by stage, with what each stage counted.

mod convex;
mod deciding;
mod meshes;
mod scattered;
mod totals;

use crate::ids::number32;
use std::time::Duration;

use planecut_kernel::sign::Counts;
use planecut_parallel::drop_beside;
use planecut_parallel::prelude::*;
use rustc_hash::FxHashMap;
use thiserror::Error;

use crate::arrangement::CombineError;
use crate::base::{Clock, map_chunks};
use crate::body::{
    Body, BrushBodies, BrushBody, BuiltBodies, OuterBox, build_bodies, build_other_bodies, kinds, mark_of,
};
use crate::boundary::{BoundaryEdge, Scene, boundary_edges, boundary_of_union};
use crate::expression::{Expression, Polarity};
use crate::ids::{Id, LeafId};
use crate::mesh::{Mesh, Noise, SolidMeasures};
use crate::model::{Brush, Material, MaterialId, Model, Operation, Tree, TreeNode};
use crate::plane_table::{PlaneTable, smallest_size};
use crate::weld::{WeldError, Welded, weld};

/// What a model holds.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ModelSummary {
    /// Brushes, all of them.
    pub brushes: usize,
    /// Different planes, both sides counting once.
    pub planes: usize,
    /// Numbers of the brushes without interior.
    pub empty: Vec<usize>,
    /// Numbers of the brushes that are not bounded.
    pub unbounded: Vec<usize>,
    /// Planes of bounded brushes that have no face.
    pub redundant_planes: usize,
    /// Different planes replaced by one that was nearly the same.
    pub snapped_planes: usize,
    /// The sum of the volumes of the bounded brushes.
    pub brush_volume_sum: f64,
}

/// How long each stage took.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct StageTimes {
    /// Plane table, bodies and boundary edges.
    pub evaluate: Duration,
    /// From boundary edges to closed, paired loops.
    pub weld: Duration,
    /// From loops to triangles.
    pub triangulate: Duration,
}

/// The solid of a model.
#[derive(Debug, Clone, PartialEq)]
pub struct Evaluation {
    /// Its boundary.
    pub mesh: Mesh,
    /// Its measures.
    pub solid: SolidMeasures,
    /// What was removed from the mesh as rounding noise.
    pub noise: Noise,
    /// What the model held.
    pub model: ModelSummary,
    /// The signs that were asked for.
    pub signs: Counts,
    /// Where the time went.
    pub times: StageTimes,
}

/// What becomes of brushes that are not bounded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum UnboundedBrushes {
    /// They are operands like others.
    #[default]
    Keep,
    /// They are taken for nothing.
    LeaveOut,
}

/// Why there is no mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum EvaluateError {
    /// The solid is unbounded.
    #[error("found a solid that reaches infinity, expected one that is bounded")]
    Unbounded,
    /// A face names a material that is not in the list.
    #[error("found a face of material number {}, expected a number below {count}", .material.0)]
    UnknownMaterial {
        /// The material.
        material: MaterialId,
        /// How many there are.
        count: usize,
    },
    /// The boundary does not close.
    #[error(transparent)]
    Weld(#[from] WeldError),
    /// The boundary of meshes does not close, or contradicts itself.
    #[error(transparent)]
    Combine(#[from] CombineError),
}

/// Counts planes and brushes and finds empty and unbounded ones, without evaluating the tree. Closed meshes count as brushes; planes and
/// volumes are those of convex bodies.
#[must_use]
pub fn summarize(model: &Model) -> ModelSummary {
    if model.tree.has_meshes() {
        return meshes::summarize(model.tree.brushes());
    }
    let BrushBodies { table, bodies, .. } = build_bodies(model.tree.brushes());
    summary_of(&table, &bodies)
}

/// The solid of a model's tree as a watertight mesh. Empty brushes are counted; they take part as nothing. Unbounded brushes
/// are operands like others; the solid itself must be bounded.
///
/// With feature `parallel` it runs on rayon's current thread pool, whose threads [begin on processors of their own](planecut_parallel::in_pool) after a pause; the outcome does not depend on the number of threads, nor,
/// where materials of overlapping coplanar faces agree, on the order of the brushes in a union. Of 65,536 brushes and more those that are
/// apart from one another are evaluated apart, in bounded memory: vertices and faces then come group by group.
///
/// # Errors
/// [`EvaluateError::Unbounded`], [`EvaluateError::UnknownMaterial`], and [`EvaluateError::Weld`] where the boundary does not
/// close: a bug in this crate, never the user's mistake.
pub fn evaluate(model: &Model) -> Result<Evaluation, EvaluateError> {
    evaluate_with(model, UnboundedBrushes::Keep)
}

/// The solid of a tree, whatever its materials.
///
/// # Errors
/// As [`evaluate`].
pub fn evaluate_shape(tree: Tree) -> Result<Evaluation, EvaluateError> {
    evaluate(&Model { materials: vec![Material::named("any")], tree: tree.with_material(MaterialId(0)) })
}

/// The same as [`evaluate`], with a choice for unbounded brushes.
///
/// # Errors
/// As [`evaluate`].
pub fn evaluate_with(model: &Model, unbounded: UnboundedBrushes) -> Result<Evaluation, EvaluateError> {
    evaluate_built(model, unbounded, &BuiltBodies::default())
}

/// The same, where bodies of some brushes are built already.
///
/// # Errors
/// As [`evaluate`].
pub fn evaluate_built(
    model: &Model,
    unbounded: UnboundedBrushes,
    built: &BuiltBodies,
) -> Result<Evaluation, EvaluateError> {
    in_pool_where_large(model, || {
        let size = smallest_size_of_convex(model.tree.brushes());
        evaluate_here(model, unbounded, built, OtherBrushes::alone(size))
    })
}

/// The [`smallest_size`] of brushes that are not meshes.
fn smallest_size_of_convex(brushes: &[Brush]) -> f64 {
    let (sizes, _) = map_chunks(brushes, BRUSHES_OF_CHUNK, |chunk| {
        smallest_size(chunk.iter().filter(|brush| !brush.is_mesh()).map(Brush::half_spaces))
    });
    // where a chunk has no body, its size is 0
    sizes.into_iter().filter(|size| *size > 0.0).reduce(f64::min).unwrap_or(0.0)
}

/// What the evaluation of some brushes of a model follows from the others, which are not there.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OtherBrushes<'a> {
    /// The size of the smallest brush of all: planes are nearly the same here where they are there.
    pub(crate) size: f64,
    /// For each leaf the polarity of all that equal it, also of those that are not there; where nothing is given, all are there.
    pub(crate) polarities: Option<&'a [Polarity]>,
    /// The material of the walls between these brushes and the others.
    pub(crate) walls: Option<MaterialId>,
}

impl OtherBrushes<'_> {
    /// There are none, and the smallest brush has this size.
    fn alone(size: f64) -> Self {
        Self { size, polarities: None, walls: None }
    }

    /// Kinds of leaves, of which those are no longer equal that are told apart by others.
    fn kinds(&self, mut kinds: Vec<LeafId>) -> Vec<LeafId> {
        let Some(polarities) = self.polarities else { return kinds };
        let mut first: FxHashMap<(LeafId, Polarity), LeafId> = FxHashMap::default();
        for (leaf, kind) in kinds.iter_mut().enumerate() {
            *kind = *first.entry((*kind, polarities[leaf])).or_insert(LeafId::from_index(leaf));
        }
        kinds
    }

    /// For each leaf the polarity of all that equal it.
    fn polarities(&self, expression: &Expression, kinds: &[LeafId]) -> Vec<Polarity> {
        self.polarities.map_or_else(|| expression.common_polarities(kinds), <[Polarity]>::to_vec)
    }
}

/// Least number of brushes that a thread looks at in a row.
const BRUSHES_OF_CHUNK: usize = 32;

/// Number of planes from which a model is worth waiting for a thread of the pool.
const MANY_PLANES: usize = 256;

/// The same among other brushes.
pub(crate) fn evaluate_among(
    model: &Model,
    unbounded: UnboundedBrushes,
    built: &BuiltBodies,
    others: OtherBrushes<'_>,
) -> Result<Evaluation, EvaluateError> {
    in_pool_where_large(model, || evaluate_here(model, unbounded, built, others))
}

/// Does some work with a model by the threads of the pool, where it is worth waiting for these.
fn in_pool_where_large<R: Send>(model: &Model, work: impl FnOnce() -> R + Send) -> R {
    let brushes = model.tree.brushes();
    let is_large = brushes.iter().any(Brush::is_mesh)
        || brushes.len() >= MANY_PLANES
        || brushes.iter().map(|brush| brush.faces.len()).sum::<usize>() >= MANY_PLANES;
    if is_large { planecut_parallel::in_pool(work) } else { work() }
}

/// The same on the calling thread, and others where there are more parts.
fn evaluate_here(
    model: &Model,
    unbounded: UnboundedBrushes,
    built: &BuiltBodies,
    others: OtherBrushes<'_>,
) -> Result<Evaluation, EvaluateError> {
    let begin = Clock::start();
    check_materials(model.tree.brushes().iter().flat_map(Brush::materials), model.materials.len())?;
    if model.tree.has_meshes() {
        return meshes::evaluate_meshes(model, unbounded, built, others.size);
    }
    if model.tree.brushes().len() >= scattered::LEAST
        && let Some(evaluation) = scattered::evaluate_scattered(model, unbounded, built, others)?
    {
        return Ok(evaluation);
    }
    let BrushBodies { mut table, planes, bodies, mut signs } =
        build_other_bodies(model.tree.brushes(), built, others.size);
    let summary = summary_of(&table, &bodies);
    let expression = Expression::new(model.tree.nodes());
    let keeps = unbounded == UnboundedBrushes::Keep && !summary.unbounded.is_empty();
    let outer = (keeps || expression.base()).then(|| OuterBox::new(&mut table));
    let bounded = |(leaf, body): (usize, BrushBody)| match (body, outer) {
        (BrushBody::Unbounded, Some(outer)) if keeps => {
            let materials: Vec<MaterialId> =
                model.tree.brushes()[leaf].faces.iter().map(|face| face.material).collect();
            outer.cut(&table, planes.of(leaf), &materials).bounded()
        }
        (body, _) => body.bounded(),
    };
    let bodies: Vec<Option<Body>> = bodies.into_iter().enumerate().map(bounded).collect();
    let faces = |leaf: LeafId| bodies[leaf.index()].iter().flat_map(Body::planes_and_materials);
    let mark = |leaf: usize| mark_of(faces(LeafId::from_index(leaf)));
    let marks: Vec<u64> = (0..bodies.len()).into_par_iter().with_min_len(BRUSHES_OF_CHUNK).map(mark).collect();
    let kinds = others.kinds(kinds(bodies.len(), faces, |leaf| marks[leaf.index()]));
    let repeated = expression.repeated_leaves(&kinds);
    let polarities = others.polarities(&expression, &kinds);
    let takes_part = |leaf: &LeafId| bodies[leaf.index()].is_some() && !repeated[leaf.index()];
    let leaf_of_body = LeafId::all(bodies.len()).filter(takes_part).collect();
    let bodies = bodies.into_iter().zip(&repeated).filter_map(|(body, repeated)| body.filter(|_| !repeated));
    let mut leaves = Leaves { bodies: bodies.collect(), leaf_of_body };
    let rank = ranks(model);
    let (edges, counted) = match outer {
        None => leaves.boundary_edges(&table, (&expression, &polarities), &rank),
        Some(outer) => leaves.boundary_within(&table, &outer, (model.tree.nodes(), polarities), &rank)?,
    };
    signs += counted;
    let (evaluated, welding) = (begin.elapsed(), Clock::start());
    // to free as many lists as there are bodies takes a while
    let Welded { mesh, solid, noise, signs: counted, triangulation } =
        drop_beside((leaves, planes), || weld(&table, edges, &rank, &model.materials, others.walls))?;
    signs += counted;
    let times = StageTimes {
        evaluate: evaluated,
        weld: welding.elapsed().saturating_sub(triangulation),
        triangulate: triangulation,
    };
    Ok(Evaluation { mesh, solid, noise, model: summary, signs, times })
}

/// The places of the materials of a model by name, one at least.
fn ranks(model: &Model) -> Vec<u32> {
    let mut rank = material_ranks(&model.materials);
    if rank.is_empty() {
        // The outer box is of the first material.
        rank.push(0);
    }
    rank
}

/// The boundary of the union of bodies as a watertight mesh, and the measures taken from it; `ranks` are the [`material_ranks`].
///
/// # Errors
/// [`WeldError`] where the boundary does not close: a bug in this crate.
pub fn mesh_of_union(
    table: &PlaneTable,
    bodies: &[Body],
    ranks: &[u32],
    materials: &[Material],
) -> Result<(Mesh, SolidMeasures), WeldError> {
    let (edges, _) = boundary_of_union(table, bodies, ranks);
    let Welded { mesh, solid, .. } = weld(table, edges, ranks, materials, None)?;
    Ok((mesh, solid))
}

/// Refuses materials that are not among the first `count`.
///
/// # Errors
/// [`EvaluateError::UnknownMaterial`].
pub fn check_materials(mut used: impl Iterator<Item = MaterialId>, count: usize) -> Result<(), EvaluateError> {
    match used.find(|material| material.0 as usize >= count) {
        Some(material) => Err(EvaluateError::UnknownMaterial { material, count }),
        None => Ok(()),
    }
}

/// The bodies that take part, and the leaf of each.
#[derive(Default)]
struct Leaves {
    bodies: Vec<Body>,
    leaf_of_body: Vec<LeafId>,
}

impl Leaves {
    fn push(&mut self, leaf: usize, body: Body) {
        self.bodies.push(body);
        self.leaf_of_body.push(LeafId::from_index(leaf));
    }

    /// Their boundary in a tree; for each leaf of that there is the polarity of all that equal it.
    fn boundary_edges(
        &self,
        table: &PlaneTable,
        tree: (&Expression, &[Polarity]),
        rank: &[u32],
    ) -> (Vec<BoundaryEdge>, Counts) {
        self.boundary_edges_of(table, tree, rank, |_| true)
    }

    /// The same of some of them, where all are here that these touch.
    fn boundary_edges_of(
        &self,
        table: &PlaneTable,
        tree: (&Expression, &[Polarity]),
        rank: &[u32],
        is_own: impl Fn(LeafId) -> bool,
    ) -> (Vec<BoundaryEdge>, Counts) {
        let scene = Scene::new(table, &self.bodies, &self.leaf_of_body, tree, rank);
        boundary_edges(&scene, |body| is_own(self.leaf_of_body[body.index()]))
    }

    /// The boundary of the tree cut by the outer box, which it must not reach; the box is one of the bodies afterwards.
    fn boundary_within(
        &mut self,
        table: &PlaneTable,
        outer: &OuterBox,
        (nodes, mut polarities): (&[TreeNode], Vec<Polarity>),
        rank: &[u32],
    ) -> Result<(Vec<BoundaryEdge>, Counts), EvaluateError> {
        // Where the tree holds what no leaf holds, the box is a body of its own, so that it ends somewhere.
        let count = nodes.iter().filter(|node| **node == TreeNode::Leaf).count();
        let mut nodes = nodes.to_vec();
        nodes.push(TreeNode::Leaf);
        nodes.push(TreeNode::Operation { operation: Operation::Intersection, operands: 2 });
        if let BrushBody::Bounded(body, _) = outer.cut(table, &[], &[]) {
            self.push(count, body);
        }
        polarities.push(Polarity::Adds);
        let (edges, counted) = self.boundary_edges(table, (&Expression::new(&nodes), &polarities), rank);
        let reaches =
            |edge: &BoundaryEdge| [edge.face, edge.edge, edge.start, edge.end].iter().any(|p| outer.holds(*p));
        if edges.iter().any(reaches) { Err(EvaluateError::Unbounded) } else { Ok((edges, counted)) }
    }
}

fn summary_of(table: &PlaneTable, brushes: &[BrushBody]) -> ModelSummary {
    let mut summary = ModelSummary {
        brushes: brushes.len(),
        planes: table.len(),
        snapped_planes: table.snapped(),
        ..ModelSummary::default()
    };
    for (number, brush) in brushes.iter().enumerate() {
        match brush {
            BrushBody::Bounded(body, redundant) => {
                summary.redundant_planes += redundant;
                summary.brush_volume_sum += body.volume;
            }
            BrushBody::Empty => summary.empty.push(number),
            BrushBody::Unbounded => summary.unbounded.push(number),
        }
    }
    summary
}

/// The place of each material by name: an order that does not depend on that of the brushes.
#[must_use]
pub fn material_ranks(materials: &[Material]) -> Vec<u32> {
    let mut order: Vec<usize> = (0..materials.len()).collect();
    order.sort_by(|a, b| materials[*a].name.cmp(&materials[*b].name));
    let mut rank = vec![0; order.len()];
    for (place, material) in order.into_iter().enumerate() {
        rank[material] = number32(place);
    }
    rank
}
