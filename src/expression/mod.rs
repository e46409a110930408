//! Solids as expressions: operations on solids that share their parts, until somebody asks for a mesh. The packages for Python and JavaScript are made of them.
//!
//! - [`Node`] is a solid, of which [`Node::evaluated`] gives the boundary; [`contains`] asks for points, [`cells_of`] for convex cells.
//! - [`EditMaterials`] takes such solids into a live model.

mod cells;
mod error;
mod materials;
mod membership;

use std::collections::HashMap;
use std::mem;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use planecut_csg::stages::RayCaster;
use planecut_csg::{Brush, Evaluation, Material, MaterialId, Model, Operation, Transform, Tree, evaluate};

pub use cells::{cells_of, components_of, piece_of_planes};
pub use error::ExpressionError;
pub use materials::EditMaterials;
pub use membership::contains;

/// The name of what nobody has given a material.
pub const DEFAULT_MATERIAL: &str = "default";

/// Most convex bodies and meshes of a solid, each counted as often as it is used.
const MAX_PIECES: u64 = planecut_import::model::MAX_BRUSHES as u64;
/// Solids of fewer planes than this, and of no mesh, are evaluated in a few milliseconds.
const FEW_PLANES: u64 = 1500;

/// A solid that nothing changes any more.
///
/// ```
/// use planecut::csg::{Brush, Material, MaterialId, Operation, Transform};
/// use planecut::expression::Node;
/// use planecut::kernel::DVec3;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let cube = Node::of_tree(Brush::cuboid(DVec3::ZERO, DVec3::splat(2.0), MaterialId(0)), Material::named("oak"));
/// let moved = cube.moved(&Transform::translation([1.0, 1.0, 1.0])?)?;
/// let both = Node::operation(Operation::Union, vec![cube, moved]);
/// assert_eq!(both.evaluated()?.evaluation.solid.volume, 15.0);
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Node {
    kind: Kind,
    /// How many bodies it has, each as often as it is used.
    pieces: u64,
    planes: u64,
    has_meshes: bool,
    /// The material of most of it, about, where one is stated: what cuts it and has none takes it.
    material: Option<Material>,
    evaluated: Mutex<Option<Arc<Evaluated>>>,
}

#[derive(Debug)]
enum Kind {
    Model(Model),
    Operation(Operation, Vec<Arc<Node>>),
    Moved(Arc<Node>, Transform),
    OfMaterial(Arc<Node>, Material),
}

/// The boundary of a solid, and what is known of it.
#[derive(Debug)]
pub struct Evaluated {
    /// The boundary.
    pub evaluation: Evaluation,
    rays: Mutex<Option<Arc<RayCaster>>>,
}

impl Evaluated {
    /// The boundary ready for rays.
    #[must_use]
    pub fn rays(&self) -> Arc<RayCaster> {
        let known = lock(&self.rays).clone();
        known.unwrap_or_else(|| {
            let mesh = &self.evaluation.mesh;
            let corners = |triangle: &[u32; 3]| triangle.map(|corner| mesh.positions[corner as usize]);
            let rays = Arc::new(RayCaster::new(mesh.triangles.iter().map(corners).collect()));
            Arc::clone(lock(&self.rays).insert(rays))
        })
    }
}

/// What a mutex holds. A panic while it was locked cannot have left it half-done: only whole values are put in.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Node {
    fn new(kind: Kind) -> Arc<Self> {
        let (pieces, planes, has_meshes) = match &kind {
            Kind::Model(model) => {
                let brushes = model.tree.brushes();
                let planes = brushes.iter().map(|brush| brush.faces.len() as u64).sum();
                (brushes.len() as u64, planes, model.tree.has_meshes())
            }
            Kind::Operation(_, operands) => {
                operands.iter().fold((0, 0, false), |(pieces, planes, has_meshes): (u64, u64, bool), node| {
                    (
                        pieces.saturating_add(node.pieces),
                        planes.saturating_add(node.planes),
                        has_meshes || node.has_meshes,
                    )
                })
            }
            Kind::Moved(node, _) | Kind::OfMaterial(node, _) => (node.pieces, node.planes, node.has_meshes),
        };
        let material = match &kind {
            Kind::Model(model) => {
                let first = model.tree.brushes().first().and_then(|brush| brush.materials().next());
                first.and_then(|first| model.materials.get(first.0 as usize)).filter(|own| is_stated(own)).cloned()
            }
            Kind::Operation(_, operands) => operands.iter().find_map(|operand| operand.material.clone()),
            Kind::Moved(node, _) => node.material.clone(),
            Kind::OfMaterial(_, own) => Some(own.clone()),
        };
        Arc::new(Self { kind, pieces, planes, has_meshes, material, evaluated: Mutex::new(None) })
    }

    /// A tree with its materials.
    #[must_use]
    pub fn of_model(model: Model) -> Arc<Self> {
        Self::new(Kind::Model(model))
    }

    /// A tree all of one material.
    #[must_use]
    pub fn of_tree(tree: impl Into<Tree>, material: Material) -> Arc<Self> {
        Self::of_model(Model { materials: vec![material], tree: tree.into() })
    }

    /// An operation on others.
    #[must_use]
    pub fn operation(operation: Operation, operands: Vec<Arc<Self>>) -> Arc<Self> {
        Self::new(Kind::Operation(operation, operands))
    }

    /// The same moved by an affine map.
    ///
    /// # Errors
    /// [`ExpressionError::Transform`].
    pub fn moved(self: &Arc<Self>, transform: &Transform) -> Result<Arc<Self>, ExpressionError> {
        // one after another is one: a long chain of moves is no deep tree
        if let Kind::Moved(node, first) = &self.kind {
            let both = first.then(transform)?;
            return Ok(Self::new(Kind::Moved(Arc::clone(node), both)));
        }
        Ok(Self::new(Kind::Moved(Arc::clone(self), *transform)))
    }

    /// The same, all of one material.
    #[must_use]
    pub fn of_material(self: &Arc<Self>, material: Material) -> Arc<Self> {
        Self::new(Kind::OfMaterial(Arc::clone(self), material))
    }

    /// How many convex bodies and meshes it has, each as often as it is used.
    #[must_use]
    pub fn pieces(&self) -> u64 {
        self.pieces
    }

    /// Whether a part is a closed mesh.
    #[must_use]
    pub fn has_meshes(&self) -> bool {
        self.has_meshes
    }

    /// Whether it is evaluated in far less time than anybody waits.
    #[must_use]
    pub fn is_small(&self) -> bool {
        self.planes < FEW_PLANES && !self.has_meshes
    }

    /// The boundary, where it is known.
    #[must_use]
    pub fn known(&self) -> Option<Arc<Evaluated>> {
        lock(&self.evaluated).clone()
    }

    /// The boundary. Of threads that ask for it at the same time each may work it out; nobody waits for another.
    ///
    /// # Errors
    /// [`ExpressionError`], as where the solid is unbounded.
    pub fn evaluated(&self) -> Result<Arc<Evaluated>, ExpressionError> {
        if let Some(known) = self.known() {
            return Ok(known);
        }
        let evaluation = evaluate(&self.model()?)?;
        let evaluated = Arc::new(Evaluated { evaluation, rays: Mutex::new(None) });
        Ok(Arc::clone(lock(&self.evaluated).get_or_insert(evaluated)))
    }

    /// All of it as one tree, with the materials that it uses.
    ///
    /// # Errors
    /// [`ExpressionError`], as for too many bodies.
    pub fn model(&self) -> Result<Model, ExpressionError> {
        if self.pieces > MAX_PIECES {
            return Err(ExpressionError::TooMany { found: self.pieces });
        }
        let mut materials = Materials::default();
        let mut values: Vec<Tree> = Vec::new();
        let mut steps = vec![Step::Enter(self, None, Paint::default())];
        while let Some(step) = steps.pop() {
            match step {
                Step::Enter(node, transform, paint) => match &node.kind {
                    Kind::Model(model) => values.push(leaf(model, transform.as_ref(), paint, &mut materials)?),
                    Kind::Operation(operation, operands) => {
                        steps.push(Step::Combine(*operation, operands.len()));
                        let is_cut = matches!(operation, Operation::Difference | Operation::Intersection);
                        let first = operands.first().and_then(|first| first.material.as_ref()).filter(|_| is_cut);
                        let cutter = Paint { unstated: first.or(paint.unstated), ..paint };
                        let enter =
                            |(place, node)| Step::Enter(node, transform, if place == 0 { paint } else { cutter });
                        let places = operands.iter().enumerate().rev();
                        steps.extend(places.map(|(place, node)| (place, &**node)).map(enter));
                    }
                    Kind::Moved(node, own) => {
                        let both = transform.map_or(Ok(*own), |outer| own.then(&outer))?;
                        steps.push(Step::Enter(node, Some(both), paint));
                    }
                    Kind::OfMaterial(node, own) => {
                        steps.push(Step::Enter(node, transform, Paint { all: paint.all.or(Some(own)), ..paint }));
                    }
                },
                Step::Combine(Operation::Complement, _) => {
                    let tree = values.pop().unwrap_or_default();
                    values.push(tree.complement());
                }
                Step::Combine(operation, count) => {
                    let operands = values.split_off(values.len() - count);
                    values.push(Tree::combine(operation, operands));
                }
            }
        }
        let tree = values.pop().unwrap_or_default();
        Ok(Model { materials: materials.list, tree })
    }
}

/// Deep trees are taken apart without deep calls.
impl Drop for Node {
    fn drop(&mut self) {
        let mut waiting = operands(&mut self.kind);
        while let Some(node) = waiting.pop() {
            if let Some(mut node) = Arc::into_inner(node) {
                waiting.append(&mut operands(&mut node.kind));
            }
        }
    }
}

fn operands(kind: &mut Kind) -> Vec<Arc<Node>> {
    match mem::replace(kind, Kind::Operation(Operation::Union, Vec::new())) {
        Kind::Model(_) => Vec::new(),
        Kind::Operation(_, operands) => operands,
        Kind::Moved(node, _) | Kind::OfMaterial(node, _) => vec![node],
    }
}

/// What is left to be done on the way to a tree.
enum Step<'a> {
    /// A node, how it is moved, and the material that it gets.
    Enter(&'a Node, Option<Transform>, Paint<'a>),
    /// The last trees are combined.
    Combine(Operation, usize),
}

/// The materials that what is below a node gets.
#[derive(Clone, Copy, Default)]
struct Paint<'a> {
    /// Of all faces.
    all: Option<&'a Material>,
    /// Of faces for which none was stated.
    unstated: Option<&'a Material>,
}

/// Whether somebody has said that this is the material.
fn is_stated(material: &Material) -> bool {
    *material != Material::named(DEFAULT_MATERIAL)
}

fn leaf(
    model: &Model,
    transform: Option<&Transform>,
    paint: Paint<'_>,
    materials: &mut Materials,
) -> Result<Tree, ExpressionError> {
    let mut tree = model.tree.clone().without_source_lines();
    if let Some(transform) = transform {
        tree = tree.transformed(transform)?;
    }
    if let Some(material) = paint.all {
        let number = materials.number(material);
        return Ok(tree.with_material(number));
    }
    let own = |material| if is_stated(material) { material } else { paint.unstated.unwrap_or(material) };
    let numbers: Vec<MaterialId> = model.materials.iter().map(|material| materials.number(own(material))).collect();
    for own in tree.brushes_mut().iter_mut().flat_map(Brush::materials_mut) {
        let number = numbers.get(own.0 as usize).copied();
        *own = number.ok_or(ExpressionError::Material { found: own.0, count: numbers.len() })?;
    }
    Ok(tree)
}

/// Different materials, numbered as they come.
#[derive(Default)]
struct Materials {
    list: Vec<Material>,
    by_name: HashMap<String, Vec<MaterialId>>,
}

impl Materials {
    fn number(&mut self, material: &Material) -> MaterialId {
        let known = self.by_name.get(&material.name);
        let same = known.and_then(|known| known.iter().find(|number| self.list[number.0 as usize] == *material));
        if let Some(number) = same {
            return *number;
        }
        let number = MaterialId(self.list.len() as u32);
        self.list.push(material.clone());
        self.by_name.entry(material.name.clone()).or_default().push(number);
        number
    }
}
