//! From NODEs to the pieces of a tree, one after another.
//!
//! The spine of a model is its root and what can be reached from there through operations, copies and uses of parts. There each operation is sent as it
//! is met. What is copied, and parts that are used more than once, become [`Plan`]s, in which copies within are not made yet; plans are played to the
//! sink as often as they have places. Everything else is evaluated as a tree and taken to pieces.

use std::convert::Infallible;
use std::mem::take;
use std::num::NonZeroU32;
use std::rc::Rc;

use planecut_csg::{Brush, Material, MaterialId, Operation, TreeSink};
use rustc_hash::FxHashMap;

use super::plan::{Extent, Piece, Placed, Plan};
use super::{Context, Evaluator};
use crate::Warning;
use crate::model::body::Maker;
use crate::model::budget::{MAX_STEPS, Size};
use crate::model::copies::{count_of_copies, places};
use crate::model::error::{Checked, Fault, Stop};
use crate::model::form::kind_of;
use crate::model::json::Entry;
use crate::model::keys::{NODE_EXTRAS, NODE_KINDS};
use crate::model::materials::{number_of_default, set_missing_of};
use crate::model::parameters::Environment;
use crate::source::at_most;

/// Most operations that are sent for each brush that is accepted: a bound on work that leaves no brush behind.
const OPERATIONS: f64 = 64.0;

/// What is still to be done.
enum Step {
    Node(Context),
    /// The operation that began last is complete.
    End(Entry),
    /// The last plan is complete, and copied.
    Copies(Context, &'static str, Entry),
    /// The last plan is complete, and that of a part.
    Keep(Context, u32),
}

/// Sends the pieces of a tree.
pub(in crate::model) struct Spine<'s, 'v, 'a, S> {
    evaluator: Evaluator<'v, 'a>,
    sink: &'s mut S,
    steps: Vec<Step>,
    /// The plans that are being made, inner ones last; without any, pieces are sent.
    plans: Vec<Plan>,
    /// The plans of parts that are used more than once, by part and environment.
    kept: FxHashMap<(u32, u32), Rc<Plan>>,
    /// Most brushes that are sent.
    limit: u64,
    extent: Extent,
    brushes: u64,
    /// The material of faces that have none; not known while mesh files may bring more materials.
    default: Option<MaterialId>,
    uses_default: bool,
    /// Those of the model.
    materials: &'s [Material],
}

/// What was sent.
pub(in crate::model) struct Streamed {
    pub(in crate::model) brushes: u64,
    /// Those of mesh files, which follow the materials of the model.
    pub(in crate::model) materials: Vec<Material>,
    /// Whether a face has the default material for want of another.
    pub(in crate::model) uses_default: bool,
    pub(in crate::model) warnings: Vec<Warning>,
}

impl<'s, 'v, 'a, S: TreeSink> Spine<'s, 'v, 'a, S> {
    /// A spine of which nothing was sent; without a `default` material nothing is before all is evaluated. `materials` are those of the model.
    pub(in crate::model) fn new(
        evaluator: Evaluator<'v, 'a>,
        sink: &'s mut S,
        limit: u64,
        default: Option<MaterialId>,
        materials: &'s [Material],
    ) -> Self {
        Self {
            evaluator,
            sink,
            steps: Vec::new(),
            plans: Vec::new(),
            kept: FxHashMap::default(),
            limit,
            extent: Extent::default(),
            brushes: 0,
            default,
            uses_default: false,
            materials,
        }
    }

    /// Sends the tree of a NODE.
    ///
    /// # Errors
    /// [`Stop`] by the first value that cannot be made, or by the sink.
    pub(in crate::model) fn run(mut self, node: Entry, environment: Environment) -> Result<Streamed, Stop<S::Error>> {
        let context = Context::frame(node, environment, 0);
        if self.default.is_none() {
            self.plans.push(Plan::default());
        }
        self.steps.push(Step::Node(context.clone()));
        while let Some(step) = self.steps.pop() {
            match step {
                Step::Node(context) => self.node(context)?,
                Step::End(node) => self.emit(node, Piece::End)?,
                Step::Copies(context, kind, value) => self.copies(context, kind, value)?,
                Step::Keep(context, part) => {
                    let plan = Rc::new(self.plans.pop().unwrap_or_default());
                    self.kept.insert((part, context.environment.number), Rc::clone(&plan));
                    self.emit(context.node, Piece::Placed(Rc::new(Placed { plan, context, copies: None })))?;
                }
            }
        }
        if let Some(plan) = self.plans.pop() {
            let of_meshes = self.evaluator.meshes.materials();
            let all: Vec<Material> = self.materials.iter().chain(of_meshes).cloned().collect();
            self.default = Some(number_of_default(&all));
            self.emit(node, Piece::Placed(Rc::new(Placed { plan: Rc::new(plan), context, copies: None })))?;
        }
        Ok(Streamed {
            brushes: self.brushes,
            materials: self.evaluator.meshes.into_materials(),
            uses_default: self.uses_default,
            warnings: self.evaluator.warnings,
        })
    }

    fn node(&mut self, mut context: Context) -> Result<(), Stop<S::Error>> {
        let document = self.evaluator.definitions.document;
        let (field, value) = kind_of(document, context.node, NODE_KINDS, NODE_EXTRAS, "a NODE")?;
        if !self.is_on_spine(field.key, value)? {
            return self.tree(context);
        }
        self.evaluator.enter(context.node, context.depth)?;
        self.evaluator.inherit(&mut context)?;
        match (operation_of(field.key), field.key) {
            (Some(operation), _) => {
                self.emit(context.node, Piece::Begin(operation))?;
                self.steps.push(Step::End(context.node));
                let at = self.steps.len();
                if operation == Operation::Complement {
                    self.steps.push(Step::Node(context.child(value)));
                } else {
                    self.steps.extend(document.items(value).map(|item| Step::Node(context.child(item))));
                }
                // What comes first is on top.
                self.steps[at..].reverse();
            }
            (None, "use") => self.use_of_part(context, value)?,
            (None, key) => {
                let frame = context.frame_of(document.member(value, "of").unwrap_or(value));
                self.plans.push(Plan::default());
                self.steps.push(Step::Copies(context, key, value));
                self.steps.push(Step::Node(frame));
            }
        }
        Ok(())
    }

    /// Whether a node of this kind is more than one piece, or a use of one that is.
    fn is_on_spine(&self, kind: &str, value: Entry) -> Checked<bool> {
        if kind == "use" {
            let document = self.evaluator.definitions.document;
            let parts = &self.evaluator.names.parts;
            let part = parts.by_name.get(&*document.text(value)).copied().unwrap_or(0);
            let part = parts.entries[part as usize];
            let (field, _) = kind_of(document, part, NODE_KINDS, NODE_EXTRAS, "a NODE")?;
            return Ok(field.key == "use" || operation_of(field.key).is_some() || is_copies(field.key));
        }
        Ok(operation_of(kind).is_some() || is_copies(kind))
    }

    /// A node that is evaluated as a whole.
    fn tree(&mut self, context: Context) -> Result<(), Stop<S::Error>> {
        let node = context.node;
        let tree = self.evaluator.tree_of(context)?;
        match self.plans.last_mut() {
            Some(plan) => plan.held = plan.held.and(Size::of(&tree)),
            None => self.evaluator.budget.remove(&tree),
        }
        let mut pieces = Pieces(Vec::with_capacity(tree.nodes().len()));
        match tree.send(&mut pieces) {
            Ok(()) => pieces.0.into_iter().try_for_each(|piece| self.emit(node, piece)),
            Err(never) => match never {},
        }
    }

    fn use_of_part(&mut self, context: Context, value: Entry) -> Result<(), Stop<S::Error>> {
        let (part, environment) = self.evaluator.part_of(&context, value)?;
        let entry = self.evaluator.names.parts.entries[part as usize];
        if let Some(plan) = self.kept.get(&(part, environment.number)) {
            let placed = Placed { plan: Rc::clone(plan), context, copies: None };
            return self.emit(placed.context.node, Piece::Placed(Rc::new(placed)));
        }
        if self.evaluator.uses[self.evaluator.names.part_vertex(part as usize)] > 1 {
            let frame = Context::frame(entry, environment.clone(), context.depth + 1);
            self.plans.push(Plan::default());
            self.steps.push(Step::Keep(Context { environment, ..context }, part));
            self.steps.push(Step::Node(frame));
        } else {
            self.steps.push(Step::Node(Context { environment, ..context.child(entry) }));
        }
        Ok(())
    }

    fn copies(&mut self, context: Context, kind: &str, value: Entry) -> Result<(), Stop<S::Error>> {
        let mut plan = self.plans.pop().unwrap_or_default();
        let node = context.node;
        let values = self.evaluator.definitions.values(&context.environment);
        let maker = Maker { values, value, material: context.material };
        let count = count_of_copies(&maker, kind)?;
        if count > self.limit as f64 {
            return Err(self.too_many(node, count.max(count * plan.extent.brushes)).into());
        }
        if plan.extent.brushes == 0.0 {
            // Nothing, or all of space, wherever it is put.
            return take(&mut plan.pieces).into_iter().try_for_each(|piece| self.emit(node, piece));
        }
        let copies = Some((value, places(&maker, kind)?));
        let held = plan.held;
        if let Some(outer) = self.plans.last_mut() {
            outer.held = outer.held.and(held);
        }
        self.emit(node, Piece::Placed(Rc::new(Placed { plan: Rc::new(plan), context, copies })))?;
        if self.plans.is_empty() {
            self.evaluator.budget.release(held);
        }
        Ok(())
    }

    /// Adds a piece to the plan that is being made, or sends it.
    fn emit(&mut self, node: Entry, piece: Piece) -> Result<(), Stop<S::Error>> {
        let extent = self.plans.last_mut().map_or(&mut self.extent, |plan| &mut plan.extent);
        extent.add(piece.extent());
        let Extent { brushes, operations } = *extent;
        if brushes > self.limit as f64 {
            return Err(self.too_many(node, brushes).into());
        }
        let most = OPERATIONS * self.limit as f64 + MAX_STEPS as f64;
        if operations > most {
            let found = format!("{operations} operations in all");
            return Err(Fault::new(node, found, format!("at most {most} for this number of brushes")).into());
        }
        match (self.plans.last_mut(), piece) {
            (Some(plan), piece) => {
                plan.pieces.push(piece);
                Ok(())
            }
            (None, Piece::Begin(operation)) => self.sink.begin(operation).map_err(Stop::Sink),
            (None, Piece::End) => self.sink.end().map_err(Stop::Sink),
            (None, Piece::Leaf(brush, line)) => self.send(*brush, line),
            (None, Piece::Placed(placed)) => self.play(placed),
        }
    }

    fn too_many(&self, node: Entry, brushes: f64) -> Fault {
        Fault::new(node, format!("{brushes} brushes in all"), at_most(self.limit as usize))
    }

    fn send(&mut self, mut brush: Brush, line: Option<NonZeroU32>) -> Result<(), Stop<S::Error>> {
        if let Some(default) = self.default {
            self.uses_default |= set_missing_of(&mut brush, default);
        }
        self.brushes += 1;
        self.sink.leaf(brush, line).map_err(Stop::Sink)
    }

    /// Sends a plan in all its places.
    fn play(&mut self, placed: Rc<Placed>) -> Result<(), Stop<S::Error>> {
        let mut playing = Vec::new();
        self.begin_to_play(placed, &mut playing)?;
        while let Some(last) = playing.last_mut() {
            let placed = Rc::clone(&last.placed);
            if let Some(piece) = placed.plan.pieces.get(last.next) {
                last.next += 1;
                match piece {
                    Piece::Begin(operation) => self.sink.begin(*operation).map_err(Stop::Sink)?,
                    Piece::End => self.sink.end().map_err(Stop::Sink)?,
                    Piece::Placed(inner) => self.begin_to_play(Rc::clone(inner), &mut playing)?,
                    Piece::Leaf(brush, line) => {
                        let mut brush = Brush::clone(brush);
                        for outer in playing.iter().rev() {
                            brush = self.evaluator.put_brush(&outer.place, brush)?;
                        }
                        self.send(brush, *line)?;
                    }
                }
                continue;
            }
            match &placed.copies {
                Some((value, places)) if last.copy + 1 < places.count() => {
                    last.copy += 1;
                    last.next = 0;
                    last.place = self.evaluator.place_of(&placed.context, *value, places, last.copy)?;
                }
                Some(_) => {
                    playing.pop();
                    self.sink.end().map_err(Stop::Sink)?;
                }
                None => drop(playing.pop()),
            }
        }
        Ok(())
    }

    fn begin_to_play(&mut self, placed: Rc<Placed>, playing: &mut Vec<Playing>) -> Result<(), Stop<S::Error>> {
        let place = match &placed.copies {
            Some((value, places)) => {
                self.sink.begin(Operation::Union).map_err(Stop::Sink)?;
                self.evaluator.place_of(&placed.context, *value, places, 0)?
            }
            None => placed.context.clone(),
        };
        playing.push(Playing { placed, place, copy: 0, next: 0 });
        Ok(())
    }
}

/// A plan that is being played.
struct Playing {
    placed: Rc<Placed>,
    /// Where it is put now.
    place: Context,
    /// The number of this place.
    copy: u64,
    /// The piece that is next.
    next: usize,
}

/// Takes a tree to pieces.
struct Pieces(Vec<Piece>);

impl TreeSink for Pieces {
    type Error = Infallible;

    fn begin(&mut self, operation: Operation) -> Result<(), Infallible> {
        self.0.push(Piece::Begin(operation));
        Ok(())
    }

    fn leaf(&mut self, brush: Brush, line: Option<NonZeroU32>) -> Result<(), Infallible> {
        self.0.push(Piece::Leaf(Box::new(brush), line));
        Ok(())
    }

    fn end(&mut self) -> Result<(), Infallible> {
        self.0.push(Piece::End);
        Ok(())
    }
}

/// The operation on nodes that a key names.
fn operation_of(key: &str) -> Option<Operation> {
    Some(match key {
        "union" => Operation::Union,
        "intersection" => Operation::Intersection,
        "difference" => Operation::Difference,
        "xor" => Operation::Xor,
        "complement" => Operation::Complement,
        _ => return None,
    })
}

fn is_copies(key: &str) -> bool {
    matches!(key, "instances" | "array" | "ring")
}
