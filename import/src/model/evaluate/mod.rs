//! From NODEs to one tree.
//!
//! What is to be done waits in a list, and results wait in another, as in a calculator of postfix formulas: no recursion.
//! On the way down maps, materials and names are handed on, so that each plane is moved once. Where a result is needed by
//! itself (copies, hulls, sums, sections) a node starts in a frame of its own, and its result is put in place afterwards.

mod outline;
mod plan;
mod spine;

pub(super) use spine::Spine;

use std::borrow::Cow;
use std::num::NonZeroU32;

use planecut_csg::{Brush, Material, MaterialId, Operation, Transform, Tree};
use planecut_shapes::outline::Outline;
use planecut_shapes::polyhedron::convex_tree;
use planecut_shapes::{ShapeError, shaping};
use rustc_hash::{FxHashMap, FxHashSet};

use crate::Warning;
use crate::lines::LineTable;
use crate::model::MAX_DEPTH;
use crate::model::body::Maker;
use crate::model::budget::{Budget, Size};
use crate::model::check::Use;
use crate::model::copies::{Places, count_of_copies, places};
use crate::model::error::{Checked, Fault};
use crate::model::form::kind_of;
use crate::model::inline_mesh::{count_of_triangles, inline_mesh};
use crate::model::json::Entry;
use crate::model::keys::{NODE_EXTRAS, NODE_KINDS};
use crate::model::materials::{NO_MATERIAL, set_missing_of};
use crate::model::meshes::Meshes;
use crate::model::names::Names;
use crate::model::parameters::{Definitions, Environment};

/// A node and what it inherits.
#[derive(Debug, Clone)]
struct Context {
    node: Entry,
    map: Transform,
    material: MaterialId,
    name: Option<Entry>,
    environment: Environment,
    depth: u32,
}

/// What is still to be done.
enum Task {
    Node(Context),
    /// Combine this number of trees, the last ones.
    Combine(Operation, usize),
    /// The hull of this number of trees, the last ones.
    Hull(Context, usize),
    /// The sum of the last two trees.
    Minkowski(Context),
    /// Copies of the last tree.
    Copies(Context, &'static str, Entry),
    /// Keep the last tree as that of a part, and put it in place.
    Keep(Context, u32),
    /// A body from the last outline.
    Extrude(Context, Entry),
    Revolve(Context, Entry),
    Outline(Entry, Environment, u32),
    /// Move the last outline.
    MoveOutline(Entry, Environment),
    /// Keep the last outline as that of a definition in this environment.
    KeepOutline(u32, u32),
    CombineOutlines(Operation, usize, Entry),
    Offset(Entry, Environment),
    /// An outline from the last tree.
    Slice(Entry, Environment),
    Project(Entry, Environment),
}

/// Evaluates the NODEs of a text that was checked.
pub(super) struct Evaluator<'v, 'a> {
    definitions: &'v Definitions<'v, 'a>,
    names: &'v Names,
    lines: &'v LineTable,
    /// How often each definition is used.
    uses: Vec<u32>,
    tasks: Vec<Task>,
    trees: Vec<Tree>,
    outlines: Vec<Outline>,
    /// Trees of parts that are used more than once, by part and environment.
    kept: FxHashMap<(u32, u32), Tree>,
    /// Outlines that are used more than once, by definition and environment.
    kept_outlines: FxHashMap<(u32, u32), Outline>,
    budget: Budget,
    /// How many environments there were.
    environments: u32,
    warnings: Vec<Warning>,
    /// The nodes, by environment, of which it was said that they are flat: a part may be evaluated as a tree and on the spine.
    flat: FxHashSet<(Entry, u32)>,
    meshes: Meshes<'v>,
}

/// What NODEs gave.
pub(super) struct Evaluated {
    pub(super) tree: Tree,
    /// Those of mesh files, which follow the materials of the model.
    pub(super) materials: Vec<Material>,
    pub(super) warnings: Vec<Warning>,
}

impl<'v, 'a> Evaluator<'v, 'a> {
    /// An evaluator with nothing to do; `uses` are those of parts and outlines, by the numbers of definitions, and `limit` is
    /// that of brushes and corners.
    pub(super) fn new(
        definitions: &'v Definitions<'v, 'a>,
        names: &'v Names,
        lines: &'v LineTable,
        uses: &[Use],
        limit: usize,
        meshes: Meshes<'v>,
    ) -> Self {
        let mut counts = vec![0; names.vertices()];
        for Use { used, .. } in uses {
            counts[*used] += 1;
        }
        Self {
            definitions,
            names,
            lines,
            uses: counts,
            tasks: Vec::new(),
            trees: Vec::new(),
            outlines: Vec::new(),
            kept: FxHashMap::default(),
            kept_outlines: FxHashMap::default(),
            budget: Budget::new(limit),
            environments: 0,
            warnings: Vec::new(),
            flat: FxHashSet::default(),
            meshes,
        }
    }

    /// The tree of a NODE.
    ///
    /// # Errors
    /// [`Fault`] of the first value that cannot be made.
    pub(super) fn run(mut self, node: Entry, environment: Environment) -> Checked<Evaluated> {
        let tree = self.tree_of(Context::frame(node, environment, 0))?;
        Ok(Evaluated { tree, materials: self.meshes.into_materials(), warnings: self.warnings })
    }

    /// The tree of one node, while there is nothing else to be done.
    fn tree_of(&mut self, context: Context) -> Checked<Tree> {
        self.tasks.push(Task::Node(context));
        while let Some(task) = self.tasks.pop() {
            self.carry_out(task)?;
        }
        Ok(self.trees.pop().unwrap_or_default())
    }

    fn carry_out(&mut self, task: Task) -> Checked<()> {
        match task {
            Task::Node(context) => self.node(context),
            Task::Combine(operation, count) => {
                let operands = self.last_trees(count);
                self.trees.push(Tree::combine(operation, operands));
                Ok(())
            }
            Task::Hull(context, count) => {
                let operands = self.used_up(count);
                let maker = |maker: Maker<'_, '_>| maker.accept(shaping::hull(&operands, maker.material));
                self.make(&context, maker)
            }
            Task::Minkowski(context) => {
                let mut operands = self.used_up(2);
                for operand in &mut operands {
                    let convex = convex_tree(operand).map_err(ShapeError::from);
                    let convex = self.maker(&context, context.node).accept(convex.map(Cow::into_owned))?;
                    *operand = convex;
                }
                let [a, b] = &operands[..] else { return Ok(()) };
                if a.is_union() && b.is_union() {
                    let pairs = Size { brushes: a.brushes().len(), planes: 0 };
                    self.budget.allow(context.node, pairs, b.brushes().len() as f64)?;
                }
                let maker = |maker: Maker<'_, '_>| maker.accept(shaping::minkowski(a, b, maker.material));
                self.make(&context, maker)
            }
            Task::Copies(context, kind, value) => self.copies(&context, kind, value),
            Task::Keep(context, part) => {
                let tree = self.trees.pop().unwrap_or_default();
                self.budget.allow(context.node, Size::of(&tree), 1.0)?;
                self.kept.insert((part, context.environment.number), tree.clone());
                let placed = self.put(&context, tree)?;
                self.trees.push(placed);
                Ok(())
            }
            Task::Extrude(context, value) => {
                let outline = self.outlines.pop().unwrap_or_default();
                self.make_from(&context, value, |maker| maker.extrude(&outline))
            }
            Task::Revolve(context, value) => {
                let outline = self.outlines.pop().unwrap_or_default();
                self.make_from(&context, value, |maker| maker.revolve(&outline))
            }
            Task::Outline(entry, environment, depth) => self.outline(entry, &environment, depth),
            Task::MoveOutline(matrix, environment) => self.move_outline(matrix, &environment),
            Task::KeepOutline(outline, environment) => {
                self.keep_outline(outline, environment);
                Ok(())
            }
            Task::CombineOutlines(operation, count, value) => {
                let operands = self.outlines.split_off(self.outlines.len().saturating_sub(count));
                let combined = Outline::combine(operation, &operands);
                let combined = combined.map_err(|error| Fault::new(value, error.to_string(), "other outlines"))?;
                self.made_outline(value, combined)
            }
            Task::Offset(value, environment) => {
                let outline = self.outlines.pop().unwrap_or_default();
                let maker = Maker { values: self.definitions.values(&environment), value, material: NO_MATERIAL };
                let grown = maker.offset(&outline)?;
                self.made_outline(value, grown)
            }
            Task::Slice(value, environment) => {
                let solid = self.used_up(1).pop().unwrap_or_default();
                let maker = Maker { values: self.definitions.values(&environment), value, material: NO_MATERIAL };
                let slice = maker.accept(shaping::slice(&solid, maker.number("z")?))?;
                self.made_outline(value, slice)
            }
            Task::Project(value, environment) => {
                let solid = self.used_up(1).pop().unwrap_or_default();
                let maker = Maker { values: self.definitions.values(&environment), value, material: NO_MATERIAL };
                let shadow = maker.accept(shaping::project(&solid))?;
                self.made_outline(value, shadow)
            }
        }
    }

    fn node(&mut self, mut context: Context) -> Checked<()> {
        let document = self.definitions.document;
        self.enter(context.node, context.depth)?;
        self.inherit(&mut context)?;
        let (field, value) = kind_of(document, context.node, NODE_KINDS, NODE_EXTRAS, "a NODE")?;
        match field.key {
            "union" => self.combine(&context, Operation::Union, value),
            "intersection" => self.combine(&context, Operation::Intersection, value),
            "difference" => self.combine(&context, Operation::Difference, value),
            "xor" => self.combine(&context, Operation::Xor, value),
            "complement" => {
                self.tasks.push(Task::Combine(Operation::Complement, 1));
                self.tasks.push(Task::Node(context.child(value)));
            }
            "hull" => {
                let operands: Vec<Task> =
                    document.items(value).map(|item| Task::Node(context.frame_of(item))).collect();
                self.tasks.push(Task::Hull(context, operands.len()));
                self.tasks.extend(operands.into_iter().rev());
            }
            "minkowski" => {
                let operands: Vec<Task> =
                    document.items(value).map(|item| Task::Node(context.frame_of(item))).collect();
                self.tasks.push(Task::Minkowski(context));
                self.tasks.extend(operands.into_iter().rev());
            }
            "use" => return self.use_of_part(&context, value),
            "instances" | "array" | "ring" => {
                let of = document.member(value, "of").unwrap_or(value);
                let frame = context.frame_of(of);
                self.tasks.push(Task::Copies(context, field.key, value));
                self.tasks.push(Task::Node(frame));
            }
            "extrude" | "revolve" => {
                let outline = document.member(value, "outline").unwrap_or(value);
                let task = Task::Outline(outline, context.environment.clone(), context.depth + 1);
                let make = if field.key == "extrude" { Task::Extrude } else { Task::Revolve };
                self.tasks.push(make(context, value));
                self.tasks.push(task);
            }
            "mesh" => return self.mesh(&context, value),
            key => return self.body(&context, key, value),
        }
        Ok(())
    }

    fn enter(&mut self, entry: Entry, depth: u32) -> Checked<()> {
        self.budget.step(entry)?;
        if depth <= MAX_DEPTH {
            return Ok(());
        }
        let found = format!("more than {MAX_DEPTH} nodes within one another, parts included");
        Err(Fault::new(entry, found, format!("at most {MAX_DEPTH}")))
    }

    /// The node's own attributes, on top of what it inherits.
    fn inherit(&self, context: &mut Context) -> Checked<()> {
        let document = self.definitions.document;
        let environment = context.environment.clone();
        let values = self.definitions.values(&environment);
        let own = |key| document.member(context.node, key);
        let (steps, matrix, material, name) = (own("transform"), own("matrix"), own("material"), own("name"));
        for (entry, map) in
            [(matrix, matrix.map(|matrix| values.matrix(matrix))), (steps, steps.map(|s| values.steps(s)))]
        {
            if let (Some(entry), Some(map)) = (entry, map) {
                context.map = values.accept(entry, map?.then(&context.map))?;
            }
        }
        if let Some(material) = material {
            context.material = MaterialId(self.names.number_of_material(&document.text(material)));
        }
        context.name = name.or(context.name);
        Ok(())
    }

    fn combine(&mut self, context: &Context, operation: Operation, value: Entry) {
        let document = self.definitions.document;
        let at = self.tasks.len();
        self.tasks.extend(document.items(value).map(|item| Task::Node(context.child(item))));
        let count = self.tasks.len() - at;
        self.tasks.push(Task::Combine(operation, count));
        // What comes first is on top, what combines them below.
        self.tasks[at..].reverse();
    }

    fn use_of_part(&mut self, context: &Context, value: Entry) -> Checked<()> {
        let (part, environment) = self.part_of(context, value)?;
        let entry = self.names.parts.entries[part as usize];
        if let Some(tree) = self.kept.get(&(part, environment.number)) {
            self.budget.add(context.node, tree)?;
            let placed = self.put(context, tree.clone())?;
            self.trees.push(placed);
            return Ok(());
        }
        if self.uses[self.names.part_vertex(part as usize)] > 1 {
            let depth = context.depth + 1;
            self.tasks.push(Task::Keep(Context { environment: environment.clone(), ..context.clone() }, part));
            self.tasks.push(Task::Node(Context::frame(entry, environment, depth)));
        } else {
            self.tasks.push(Task::Node(Context { environment, ..context.child(entry) }));
        }
        Ok(())
    }

    /// The number of a part that a node uses, and the values of parameters within.
    fn part_of(&mut self, context: &Context, value: Entry) -> Checked<(u32, Environment)> {
        let document = self.definitions.document;
        let part = self.names.parts.by_name.get(&*document.text(value)).copied().unwrap_or(0);
        let Some(with) = document.member(context.node, "with") else { return Ok((part, context.environment.clone())) };
        self.environments += 1;
        Ok((part, self.definitions.within(&context.environment, with, self.environments)?))
    }

    fn copies(&mut self, context: &Context, kind: &str, value: Entry) -> Checked<()> {
        let tree = self.used_up(1).pop().unwrap_or_default();
        let maker = Maker { values: self.definitions.values(&context.environment), value, material: context.material };
        let count = count_of_copies(&maker, kind)?;
        self.budget.allow(context.node, Size::of(&tree), count)?;
        if tree.brushes().is_empty() {
            // Nothing, or all of space, wherever it is put.
            self.trees.push(tree);
            return Ok(());
        }
        let places = places(&maker, kind)?;
        let place = |place| self.put(&self.place_of(context, value, &places, place)?, tree.clone());
        let copies = (0..places.count()).map(place).collect::<Checked<Vec<Tree>>>()?;
        let all = Tree::union(copies);
        self.budget.add(context.node, &all)?;
        self.trees.push(all);
        Ok(())
    }

    fn body(&mut self, context: &Context, key: &'static str, value: Entry) -> Checked<()> {
        let line = self.line(context.node);
        let planes = self.maker(context, value).planes(key)?;
        self.budget.allow(context.node, Size { brushes: 1, planes }, 1.0)?;
        let (document, names) = (self.definitions.document, self.names);
        let own = document.member(context.node, "materials");
        self.make_from(context, value, |maker| {
            let mut tree = maker.body(key)?.unwrap_or_default();
            if let Some(list) = own {
                let faces = tree.brushes_mut().iter_mut().flat_map(Brush::materials_mut);
                let materials = names.numbers_of_materials(document, list, maker.material);
                faces.zip(materials).for_each(|(face, material)| *face = material);
            }
            Ok(tree)
        })?;
        let is_flat = key == "points" && self.trees.last().is_some_and(|tree| tree.brushes().is_empty());
        if is_flat && self.flat.insert((context.node, context.environment.number)) {
            let message = "the hull of the points has no interior: they lie on a plane".to_owned();
            self.warnings.push(Warning::note(line, message));
        }
        Ok(())
    }

    fn mesh(&mut self, context: &Context, value: Entry) -> Checked<()> {
        if let Some(planes) = count_of_triangles(self.definitions.document, value) {
            self.budget.allow(context.node, Size { brushes: 1, planes }, 1.0)?;
            let names = self.names;
            return self.make_from(context, value, |maker| inline_mesh(&maker.values, names, value).map(Tree::from));
        }
        let line = self.line(context.node);
        let (tree, messages) = self.meshes.tree(&self.definitions.values(&context.environment), value)?;
        self.warnings.extend(messages.into_iter().map(|message| Warning::note(line, message)));
        self.make_from(context, value, |_| Ok(tree))
    }

    fn maker<'c>(&'c self, context: &'c Context, value: Entry) -> Maker<'c, 'a> {
        Maker { values: self.definitions.values(&context.environment), value, material: context.material }
    }

    /// Makes a tree from the value of the node's own key, and puts it in place.
    fn make(&mut self, context: &Context, make: impl FnOnce(Maker<'_, '_>) -> Checked<Tree>) -> Checked<()> {
        let document = self.definitions.document;
        let (_, value) = kind_of(document, context.node, NODE_KINDS, NODE_EXTRAS, "a NODE")?;
        self.make_from(context, value, make)
    }

    fn make_from(
        &mut self,
        context: &Context,
        value: Entry,
        make: impl FnOnce(Maker<'_, '_>) -> Checked<Tree>,
    ) -> Checked<()> {
        let line = self.line(context.node);
        let tree = make(self.maker(context, value))?.with_source_line(NonZeroU32::new(line));
        self.budget.add(context.node, &tree)?;
        let placed = self.put(context, tree)?;
        self.trees.push(placed);
        Ok(())
    }

    /// A tree where its node wants it: moved, and with material and name where it has none.
    fn put(&self, context: &Context, mut tree: Tree) -> Checked<Tree> {
        for brush in tree.brushes_mut() {
            *brush = self.put_brush(context, std::mem::take(brush))?;
        }
        Ok(tree)
    }

    /// The same for a brush.
    fn put_brush(&self, context: &Context, brush: Brush) -> Checked<Brush> {
        let moved = if context.map == Transform::identity() { Ok(brush) } else { brush.transformed(&context.map) };
        let mut brush =
            moved.map_err(|error| Fault::new(context.node, error.to_string(), "a body of less extreme coordinates"))?;
        if context.material != NO_MATERIAL {
            set_missing_of(&mut brush, context.material);
        }
        if let (Some(name), None) = (context.name, &brush.name) {
            brush.name = Some(self.definitions.document.text(name).into_owned());
        }
        Ok(brush)
    }

    /// What a copy inherits in one of its places.
    fn place_of(&self, context: &Context, value: Entry, places: &Places, place: u64) -> Checked<Context> {
        let values = self.definitions.values(&context.environment);
        let map = values.accept(value, places.at(&values, place)?.then(&context.map))?;
        Ok(Context { map, ..context.clone() })
    }

    fn line(&self, entry: Entry) -> u32 {
        self.lines.line_of(self.definitions.document.offset(entry))
    }

    fn last_trees(&mut self, count: usize) -> Vec<Tree> {
        self.trees.split_off(self.trees.len().saturating_sub(count))
    }

    /// The last trees, which count no longer.
    fn used_up(&mut self, count: usize) -> Vec<Tree> {
        let trees = self.last_trees(count);
        trees.iter().for_each(|tree| self.budget.remove(tree));
        trees
    }
}

impl Context {
    /// A node that starts in a frame of its own.
    fn frame(node: Entry, environment: Environment, depth: u32) -> Self {
        Self { node, map: Transform::identity(), material: NO_MATERIAL, name: None, environment, depth }
    }

    /// A node below this one that starts in a frame of its own.
    fn frame_of(&self, node: Entry) -> Self {
        Self::frame(node, self.environment.clone(), self.depth + 1)
    }

    /// A node below this one that inherits all it has.
    fn child(&self, node: Entry) -> Self {
        Self { node, depth: self.depth + 1, ..self.clone() }
    }
}
