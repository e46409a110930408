//! From nodes to one tree.
//!
//! Nodes are listed before those within them. So what they inherit is handed down in the order of the list, and what they make
//! is handed up in the reverse order: when a node's turn comes, its children have had theirs. Linear extrusions, which take long, wait until no other node can be made: they are made by all threads.

use std::num::NonZeroU32;

use planecut_csg::{Model, Tree};
use planecut_parallel::prelude::*;
use planecut_shapes::Outline;

use super::error::Fault;
use super::frame::{Frame, Matrix};
use super::import::Imported;
use super::materials::Materials;
use super::problem::{Body, Geometry, Made, Problem};
use super::syntax::Node;
use super::turn::{Combination, Turn};
use super::{ScadImport, ScadOptions, extrusion, flat, import, leaf, polyhedron, solid, surface, text};
use crate::Warning;
use crate::lines::LineTable;
use crate::source::{at_most, planes_of};

/// Most planes of a tree, those included that later steps leave out: 8,388,608.
const MAX_PLANES: usize = 1 << 23;

/// Nodes that make new bodies.
const MAKERS: [&str; 10] = [
    "cube",
    "sphere",
    "cylinder",
    "polyhedron",
    "import",
    "surface",
    "hull",
    "minkowski",
    "linear_extrude",
    "rotate_extrude",
];

/// Nodes that make something of their children in a frame of its own, and put that in place.
const IN_PLACE_LATER: [&str; 6] = ["minkowski", "linear_extrude", "rotate_extrude", "projection", "offset", "resize"];

/// Number of linear extrusions that are made at the same time.
const EXTRUSIONS_AT_A_TIME: usize = 64;

/// What a node of some number gave.
type Numbered = (usize, Option<Geometry>);

/// What nodes gave, in the order of the text.
fn in_order(mut made: Vec<Numbered>) -> Vec<Option<Geometry>> {
    made.sort_unstable_by_key(|(number, _)| *number);
    made.into_iter().map(|(_, made)| made).collect()
}

/// Makes the model of a list of nodes.
pub(super) struct Evaluator<'s, 'a> {
    nodes: &'s [Node<'a>],
    lines: &'s LineTable,
    options: &'s ScadOptions,
    frames: Vec<Frame>,
    materials: Materials,
    fonts: text::Fonts,
    /// What the children of each node gave, each with its number.
    made: Vec<Vec<Numbered>>,
    /// What the outermost nodes gave.
    outermost: Vec<Numbered>,
    pub(super) warnings: Vec<Warning>,
    /// How many planes, convex bodies and corners of outlines were made.
    planes: usize,
    bodies: usize,
    corners: usize,
    /// The node that stands for all, where one is marked so.
    root: Option<usize>,
}

impl<'s, 'a> Evaluator<'s, 'a> {
    pub(super) fn new(nodes: &'s [Node<'a>], lines: &'s LineTable, options: &'s ScadOptions) -> Self {
        let root = nodes.iter().position(|node| node.modifiers.is_root && !node.modifiers.is_left_out);
        let mut made = Vec::new();
        made.resize_with(nodes.len(), Vec::new);
        Self {
            nodes,
            lines,
            options,
            frames: Vec::new(),
            materials: Materials::new(),
            fonts: text::Fonts::default(),
            made,
            outermost: Vec::new(),
            warnings: Vec::new(),
            planes: 0,
            bodies: 0,
            corners: 0,
            root,
        }
    }

    /// # Errors
    /// [`Fault`] of a node that cannot be made, where that is to end it.
    pub(super) fn run(mut self) -> Result<ScadImport, Fault> {
        self.hand_down();
        let mut left: Vec<usize> = (0..self.nodes.len()).rev().filter(|k| !self.frames[*k].is_left_out).collect();
        while !left.is_empty() {
            left = self.make_some(&left)?;
        }
        let outermost = in_order(std::mem::take(&mut self.outermost));
        let tree = self.outermost(outermost);
        // they were noticed from the end of the text to its begin
        self.warnings.sort_by_key(|warning| warning.line);
        Ok(ScadImport { model: Model { materials: self.materials.into_all(), tree }, warnings: self.warnings })
    }

    /// Makes of some nodes, last one first, all that do not wait for a linear extrusion, then these extrusions, several at a time. Gives the nodes that waited.
    fn make_some(&mut self, left: &[usize]) -> Result<Vec<usize>, Fault> {
        let (mut outlines, mut waiting) = (Vec::new(), Vec::new());
        let mut waits = vec![false; self.nodes.len()];
        for &number in left {
            let turn = self.turn(number);
            let is_extrusion = turn.node.name == "linear_extrude";
            if (waits[number] || is_extrusion)
                && let Some(parent) = self.parent(number)
            {
                waits[parent] = true;
            }
            if waits[number] {
                waiting.push(number);
                continue;
            }
            let children = in_order(std::mem::take(&mut self.made[number]));
            let operands = children.len();
            if is_extrusion {
                outlines.push((number, operands, self.flat_union(turn, children)));
            } else {
                let made = self.make(turn, children);
                self.hand_up(number, operands, made)?;
            }
        }
        let mut outlines = outlines.into_iter();
        while !outlines.as_slice().is_empty() {
            // they count towards the limits when all of a step are made
            let some: Vec<_> = outlines.by_ref().take(EXTRUSIONS_AT_A_TIME).collect();
            let (nodes, frames) = (self.nodes, &self.frames);
            let extrude = |(number, operands, outline): (usize, usize, Result<Outline, Problem>)| {
                let turn = Turn { node: &nodes[number], frame: frames[number] };
                let made = outline.and_then(|outline| extrusion::linear(turn, &outline));
                (number, operands, made.and_then(|made| turn.place(made)))
            };
            let made: Vec<(usize, usize, Made)> = some.into_par_iter().map(extrude).collect();
            for (number, operands, made) in made {
                self.hand_up(number, operands, made)?;
            }
        }
        Ok(waiting)
    }

    fn turn(&self, number: usize) -> Turn<'s, 'a> {
        Turn { node: &self.nodes[number], frame: self.frames[number] }
    }

    /// Works out what each node inherits.
    fn hand_down(&mut self) {
        self.frames.reserve(self.nodes.len());
        for (number, node) in self.nodes.iter().enumerate() {
            let mut frame = match self.parent(number) {
                Some(parent) => self.within(parent),
                None => Frame::outermost(),
            };
            let is_outside = self.root.is_some_and(|root| root != number) && node.parent.is_none();
            frame.is_left_out |= node.modifiers.is_left_out || is_outside;
            self.frames.push(frame);
        }
    }

    /// The node that a node is handed up to.
    fn parent(&self, number: usize) -> Option<usize> {
        self.nodes[number].parent.filter(|_| self.root != Some(number)).map(|parent| parent as usize)
    }

    /// What the children of a node inherit.
    fn within(&mut self, number: usize) -> Frame {
        let (node, frame) = (&self.nodes[number], self.frames[number]);
        match node.name {
            "multmatrix" => frame.within_matrix(&Matrix::of(node)),
            "color" => {
                let color = node.arguments.iter().find(|(name, _)| name.is_none_or(|name| name == "c"));
                let color = color.and_then(|(_, value)| value.color());
                frame.within_color(color, &mut self.materials)
            }
            name if IN_PLACE_LATER.contains(&name) => frame.unplaced(),
            _ => frame,
        }
    }

    /// What a node makes of what its children made; not asked of linear extrusions.
    fn make(&mut self, turn: Turn<'s, 'a>, children: Vec<Option<Geometry>>) -> Made {
        match turn.node.name {
            "multmatrix" => self.moved(turn, children),
            "group" | "union" | "render" | "color" => self.combine(turn, children, Combination::Union),
            "difference" => self.combine(turn, children, Combination::Difference),
            "intersection" => self.combine(turn, children, Combination::Intersection),
            "hull" => self.combine(turn, children, Combination::Hull),
            name if IN_PLACE_LATER.contains(&name) => self.unplaced(turn, children).and_then(|made| turn.place(made)),
            _ => self.leaf(turn).and_then(|made| turn.place(made)),
        }
    }

    /// Hands up what a node made of as many operands.
    fn hand_up(&mut self, number: usize, operands: usize, made: Made) -> Result<(), Fault> {
        let turn = self.turn(number);
        let mut made = made.or_else(|problem| self.fail(turn, problem))?;
        self.count(turn, operands, made.as_ref())?;
        if let Some(Geometry::Solid(body)) = &mut made
            && MAKERS.contains(&turn.node.name)
        {
            // each new brush is told on which line it was made
            let line = self.lines.line_of(turn.node.offset);
            body.tree = std::mem::take(&mut body.tree).with_source_line(NonZeroU32::new(line));
        }
        match self.parent(number) {
            Some(parent) => self.made[parent].push((number, made)),
            None => self.outermost.push((number, made)),
        }
        Ok(())
    }

    /// Counts what a node made of its operands; what is handed up as it is counts as little as it costs.
    fn count(&mut self, turn: Turn<'_, '_>, operands: usize, made: Option<&Geometry>) -> Result<(), Fault> {
        let refuse = |found: String, expected: String| Err(Fault::found(turn.node.offset, found, expected));
        match made {
            Some(Geometry::Solid(body)) if MAKERS.contains(&turn.node.name) => {
                self.bodies += body.tree.brushes().len();
                self.planes += planes_of(&body.tree);
            }
            Some(Geometry::Flat(outline)) if operands != 1 || turn.node.name == "offset" => {
                self.corners += outline.corner_count();
            }
            _ => {}
        }
        let limit = self.options.max_pieces;
        if self.bodies > limit {
            return refuse(format!("{} convex bodies in all", self.bodies), at_most(limit));
        }
        if self.corners > limit {
            return refuse(format!("outlines of {} corners in all, each step counted", self.corners), at_most(limit));
        }
        if self.planes > MAX_PLANES {
            return refuse(format!("more than {MAX_PLANES} planes"), "a smaller tree".to_owned());
        }
        Ok(())
    }

    /// What a node makes of its children in a frame of its own.
    fn unplaced(&mut self, turn: Turn<'s, 'a>, children: Vec<Option<Geometry>>) -> Made {
        match turn.node.name {
            "minkowski" => {
                let children = solid::of_cells(children)?;
                self.allow_sum(&children)?;
                self.combine(turn, children, Combination::Minkowski)
            }
            "resize" => solid::resized(turn.node, self.combine(turn, children, Combination::Union)?),
            "rotate_extrude" => {
                let flat = self.flat_union(turn, children)?;
                extrusion::rotational(self, turn, flat)
            }
            "offset" => flat::offset(turn.node, &self.flat_union(turn, children)?),
            _ => solid::projection(turn.node, &self.solid_union(turn, children)?),
        }
    }

    /// Refuses a sum of unions that has too many convex bodies: one for each choice of one of each operand.
    fn allow_sum(&self, children: &[Option<Geometry>]) -> Result<(), Problem> {
        let bodies = |child: &Geometry| match child {
            Geometry::Solid(body) if body.tree.is_union() => body.tree.brushes().len().max(1) as f64,
            _ => 1.0,
        };
        let sums: f64 = children.iter().flatten().map(bodies).product();
        if self.bodies as f64 + sums <= self.options.max_pieces as f64 {
            return Ok(());
        }
        let found = format!("{} convex bodies in all", self.bodies as f64 + sums);
        Err(Problem::new(found, at_most(self.options.max_pieces)))
    }

    fn leaf(&mut self, turn: Turn<'s, 'a>) -> Made {
        let (node, material) = (turn.node, turn.frame.material);
        match node.name {
            "cube" => made_solid(leaf::cube(node, material)),
            "sphere" => made_solid(leaf::sphere(node, material)),
            "cylinder" => made_solid(leaf::cylinder(node, material)),
            "square" => made_flat(leaf::square(node)),
            "circle" => made_flat(leaf::circle(node)),
            "polyhedron" => Ok(self.polyhedron(turn)),
            "import" => Ok(self.imported(turn, import::mesh(node, self.options, material)?)),
            "surface" => Ok(self.imported(turn, surface::solid(node, &self.options.folder, material)?)),
            "polygon" => {
                let (outline, message) = leaf::polygon(node)?;
                if let Some(message) = message {
                    // and so is what is made of it
                    self.warn_of_loss(turn, message);
                }
                Ok(Some(Geometry::Flat(outline)))
            }
            "text" => {
                let (outline, messages) = text::text(node, &mut self.fonts)?;
                messages.into_iter().for_each(|message| self.warn(turn, message));
                Ok(Some(Geometry::Flat(outline)))
            }
            _ => Err(Problem::new(
                format!("`{}`, which is not supported", node.name),
                "a node that is (with --keep-going others are left out)",
            )),
        }
    }

    /// What another file gives; like OpenSCAD, goes on without it where that is nothing.
    fn imported(&mut self, turn: Turn<'s, 'a>, imported: Imported) -> Option<Geometry> {
        match imported {
            Imported::Solid(tree, messages) => {
                messages.into_iter().for_each(|message| self.warn(turn, message));
                Some(tree.into())
            }
            Imported::LeftOut(why) => {
                let name = if turn.node.name == "import" { "an import" } else { "a surface" };
                self.warn_of_loss(turn, format!("{name} is left out: {why}"));
                Some(Tree::empty().into())
            }
        }
    }

    /// A solid of given faces; like OpenSCAD, goes on without it where it is none.
    fn polyhedron(&mut self, turn: Turn<'s, 'a>) -> Option<Geometry> {
        match polyhedron::body(turn.node, turn.frame.material) {
            Ok((body, messages)) => {
                messages.into_iter().for_each(|message| self.warn(turn, message));
                Some(Geometry::Solid(body))
            }
            Err(message) => {
                self.warn_of_loss(turn, format!("a polyhedron is left out: {message}"));
                Some(Tree::empty().into())
            }
        }
    }

    /// The union of the children; the matrix is already in them.
    fn moved(&mut self, turn: Turn<'s, 'a>, children: Vec<Option<Geometry>>) -> Made {
        let matrix = Matrix::of(turn.node);
        if !matrix.is_finite() {
            let message = "a matrix that is not finite: what it moves is left out";
            match children.iter().flatten().any(Geometry::is_some_solid) {
                true => self.warn_of_loss(turn, message),
                false => self.warn(turn, message),
            }
            return Ok(None);
        }
        let is_single = children.iter().flatten().count() == 1;
        let mut union = self.combine(turn, children, Combination::Union)?;
        match &mut union {
            Some(Geometry::Solid(body)) if matrix.flattens_solids() => {
                self.warn(turn, "a matrix that flattens solids: what it moves is left out");
                let flattened = if is_single { std::mem::take(&mut body.flattened) } else { Vec::new() };
                *body = Body { flattened, ..Body::default() };
            }
            Some(Geometry::Flat(outline)) if matrix.flattens_outlines() => {
                self.warn(turn, "a matrix that flattens outlines: what it moves is left out");
                *outline = Outline::empty();
            }
            _ => {}
        }
        Ok(union)
    }

    fn combine(&mut self, turn: Turn<'s, 'a>, children: Vec<Option<Geometry>>, how: Combination) -> Made {
        let first = children.iter().flatten().next();
        match first {
            None => Ok(None),
            Some(Geometry::Flat(_)) => {
                let operands = self.outlines(turn, children);
                Ok(Some(Geometry::Flat(flat::combine(how, operands)?)))
            }
            Some(Geometry::Solid(_)) => {
                let operands = self.bodies(turn, children);
                Ok(Some(Geometry::Solid(solid::combine(how, operands, turn.frame.material)?)))
            }
        }
    }

    fn flat_union(&mut self, turn: Turn<'s, 'a>, children: Vec<Option<Geometry>>) -> Result<Outline, Problem> {
        let operands = self.outlines(turn, children);
        flat::combine(Combination::Union, operands)
    }

    fn solid_union(&mut self, turn: Turn<'s, 'a>, children: Vec<Option<Geometry>>) -> Result<Tree, Problem> {
        let operands = self.bodies(turn, children);
        Ok(solid::combine(Combination::Union, operands, turn.frame.material)?.tree)
    }

    /// The regions among the children; `None` for what is not there and for solids.
    fn outlines(&mut self, turn: Turn<'s, 'a>, children: Vec<Option<Geometry>>) -> Vec<Option<Outline>> {
        let mut mixed = false;
        let outlines = children.into_iter().map(|child| match child {
            Some(Geometry::Flat(outline)) => Some(outline),
            Some(Geometry::Solid(body)) => {
                mixed |= !body.is_empty();
                None
            }
            None => None,
        });
        let outlines = outlines.collect();
        if mixed {
            self.warn_of_loss(turn, format!("`{}` of outlines: a solid among them is left out", turn.node.name));
        }
        outlines
    }

    /// The solids among the children; `None` for what is not there and for regions of the plane.
    fn bodies(&mut self, turn: Turn<'s, 'a>, children: Vec<Option<Geometry>>) -> Vec<Option<Body>> {
        let mut mixed = false;
        let bodies = children.into_iter().map(|child| match child {
            Some(Geometry::Solid(body)) => Some(body),
            Some(Geometry::Flat(outline)) => {
                mixed |= !outline.is_empty();
                None
            }
            None => None,
        });
        let mut bodies: Vec<Option<Body>> = bodies.collect();
        if mixed {
            self.warn(turn, format!("`{}` of solids: an outline among them is left out", turn.node.name));
        }
        if turn.node.name != "hull" && !self.options.keep_touching {
            self.leave_out_touching(turn, &mut bodies);
        }
        bodies
    }

    /// Leaves out solids that touch themselves where there are others to combine with, as OpenSCAD does.
    fn leave_out_touching(&mut self, turn: Turn<'_, '_>, bodies: &mut [Option<Body>]) {
        let (some, all) = (bodies.iter().flatten().filter(|body| !body.is_empty()).count(), bodies.len());
        let are_several = if matches!(turn.node.name, "difference" | "intersection") { all > 1 } else { some > 1 };
        for body in
            bodies.iter_mut().filter(|body| are_several && body.as_ref().is_some_and(|body| body.touches_itself))
        {
            *body = None;
            let message = "a solid whose surface touches itself in an edge or a corner is left out";
            self.warn_of_loss(turn, format!("`{}`: {message}, as in OpenSCAD 2021.01", turn.node.name));
        }
    }

    /// The union of the outermost nodes; only solids count.
    fn outermost(&mut self, made: Vec<Option<Geometry>>) -> Tree {
        let are_outlines =
            made.iter().flatten().any(|made| matches!(made, Geometry::Flat(outline) if !outline.is_empty()));
        if are_outlines {
            let message = "outlines that nothing extrudes are left out: the result is a solid".to_owned();
            self.warnings.push(Warning::note(0, message));
        }
        let bodies = made.into_iter().filter_map(|made| match made {
            Some(Geometry::Solid(body)) => Some(Some(body)),
            _ => None,
        });
        let mut bodies: Vec<Option<Body>> = bodies.collect();
        if let Some(node) = self.nodes.first().filter(|_| !self.options.keep_touching) {
            let whole = Node { name: "the whole", ..node.clone() };
            self.leave_out_touching(Turn { node: &whole, frame: Frame::outermost() }, &mut bodies);
        }
        Tree::union(bodies.into_iter().flatten().map(|body| body.tree))
    }

    pub(super) fn warn(&mut self, turn: Turn<'_, '_>, message: impl Into<String>) {
        let line = self.lines.line_of(turn.node.offset);
        self.warnings.push(Warning::note(line, message));
    }

    /// Says that a solid is left out.
    pub(super) fn warn_of_loss(&mut self, turn: Turn<'_, '_>, message: impl Into<String>) {
        let line = self.lines.line_of(turn.node.offset);
        self.warnings.push(Warning::loss(line, message, 1));
    }

    fn fail(&mut self, turn: Turn<'_, '_>, problem: Problem) -> Result<Option<Geometry>, Fault> {
        if !self.options.keep_going {
            return Err(Fault::found(turn.node.offset, problem.found, problem.expected));
        }
        self.warn_of_loss(
            turn,
            format!("`{}` is left out: found {}, expected {}", turn.node.name, problem.found, problem.expected),
        );
        Ok(None)
    }
}

fn made_solid(tree: Result<Tree, Problem>) -> Made {
    tree.map(|tree| Some(tree.into()))
}

fn made_flat(outline: Result<Outline, Problem>) -> Made {
    outline.map(|outline| Some(Geometry::Flat(outline)))
}
