//! Whether a text has the form of a model: keys, types, names. Values are looked at where they are used.

mod surfaces;

use rustc_hash::FxHashMap;

use crate::model::MAX_DEPTH;
use crate::model::error::{Checked, Fault};
use crate::model::expression::{self, Expression};
use crate::model::form::{PlaceForm, find, kind_of, list, place_of, unknown_key};
use crate::model::json::{Document, Entry, Kind};
use crate::model::keys::{
    COMPANIONS, Field, MATERIAL, NODE_EXTRAS, NODE_KINDS, OUTLINE_EXTRAS, OUTLINE_KINDS, PLACE, STEP_KINDS, TURN, Want,
};
use crate::model::names::Names;
use crate::source::shorten;

/// What was learned from looking at every value once.
#[derive(Debug, Default)]
pub(in crate::model) struct Findings {
    /// The expressions, by the texts that hold them.
    pub(in crate::model) expressions: FxHashMap<Entry, Expression>,
    /// Who uses which part or outline.
    pub(in crate::model) uses: Vec<Use>,
    /// How many brushes each definition makes at least, without the parts that it uses.
    pub(in crate::model) brushes: Vec<f64>,
    /// The first node whose copies alone are too many.
    pub(in crate::model) too_many: Option<Entry>,
    /// Names of materials that the file does not define.
    pub(in crate::model) unknown_materials: Vec<Entry>,
    /// Whether there is a mesh in a file.
    pub(in crate::model) has_mesh_files: bool,
}

/// A use of a part or an outline; definitions have numbers, the model itself being 0.
#[derive(Debug, Clone, Copy)]
pub(in crate::model) struct Use {
    pub(in crate::model) user: usize,
    pub(in crate::model) used: usize,
    /// The name.
    pub(in crate::model) entry: Entry,
    /// How many copies the user makes of it at least; none where it is a hull or an outline that is made from it.
    pub(in crate::model) copies: f64,
}

/// A NODE or OUTLINE that is still to be looked at.
struct Task {
    entry: Entry,
    is_node: bool,
    depth: u32,
    /// How many copies of it there will be, at least.
    copies: f64,
}

/// Looks at values; NODEs and OUTLINEs within one another wait in a list, so that no depth is too deep for the stack.
pub(in crate::model) struct Checker<'d, 'a> {
    document: &'d Document<'a>,
    names: &'d Names,
    findings: Findings,
    tasks: Vec<Task>,
    /// The number of the definition that is being looked at.
    definition: usize,
    depth: u32,
    /// How many copies there will be of what is being looked at, and of what is below it.
    copies: f64,
    copies_below: f64,
    /// Most brushes.
    limit: usize,
}

impl<'d, 'a> Checker<'d, 'a> {
    /// A checker that has seen nothing yet.
    pub(in crate::model) fn new(document: &'d Document<'a>, names: &'d Names, limit: usize) -> Self {
        let findings = Findings { brushes: vec![0.0; names.vertices()], ..Findings::default() };
        Self {
            document,
            names,
            findings,
            tasks: Vec::new(),
            definition: 0,
            depth: 0,
            copies: 0.0,
            copies_below: 0.0,
            limit,
        }
    }

    /// Everything that the file defines, and its model.
    ///
    /// # Errors
    /// The first [`Fault`] of the materials, the parameters, the parts, the outlines, or the model.
    pub(in crate::model) fn run(mut self, model: Entry) -> Checked<Findings> {
        for material in &self.names.materials {
            if let Some(entry) = material.entry {
                self.object(entry, MATERIAL)?;
            }
        }
        for parameter in &self.names.parameters.entries {
            self.number(*parameter)?;
        }
        for (index, part) in self.names.parts.entries.iter().enumerate() {
            self.definition(*part, true, self.names.part_vertex(index))?;
        }
        for (index, outline) in self.names.outlines.entries.iter().enumerate() {
            self.definition(*outline, false, self.names.outline_vertex(index))?;
        }
        self.definition(model, true, 0)?;
        Ok(self.findings)
    }

    fn definition(&mut self, entry: Entry, is_node: bool, number: usize) -> Checked<()> {
        self.definition = number;
        self.tasks.push(Task { entry, is_node, depth: 0, copies: if is_node { 1.0 } else { 0.0 } });
        while let Some(task) = self.tasks.pop() {
            if task.depth > MAX_DEPTH {
                let found = format!("more than {MAX_DEPTH} nodes within one another");
                return Err(Fault::new(task.entry, found, format!("at most {MAX_DEPTH}")));
            }
            (self.depth, self.copies, self.copies_below) = (task.depth, task.copies, task.copies);
            let waiting = self.tasks.len();
            if task.is_node {
                self.node(task.entry)?;
            } else {
                self.outline(task.entry)?;
            }
            // The first in the text is to be looked at first.
            self.tasks[waiting..].reverse();
        }
        Ok(())
    }

    fn node(&mut self, entry: Entry) -> Checked<()> {
        let (kind, value) = kind_of(self.document, entry, NODE_KINDS, NODE_EXTRAS, "a NODE")?;
        self.count(entry, kind.key, value);
        for (key, value) in self.document.members(entry) {
            let name = self.document.text(key);
            let field = find(NODE_KINDS, &name).or_else(|| find(NODE_EXTRAS, &name));
            let field = field.map_or_else(|| companion(kind.key, &name, value), Ok)?;
            self.value(value, field.want)?;
        }
        if kind.key == "halfspaces" {
            self.a_material_for_each(entry, value, "half-spaces")?;
        }
        Ok(())
    }

    /// Counts what a node makes, as far as its text tells by itself.
    fn count(&mut self, node: Entry, kind: &str, value: Entry) {
        let document = self.document;
        match kind {
            "union" | "intersection" | "difference" | "xor" | "complement" | "use" => {}
            // What these take apart is not there in the end, and what they make has at least nothing.
            "hull" | "minkowski" | "extrude" | "revolve" => self.copies_below = 0.0,
            "instances" | "array" | "ring" => {
                let counts = document.member(value, "count").into_iter().flat_map(|count| document.numbers_of(count));
                let places = document.member(value, "at").map_or(1, |at| document.items(at).count());
                self.copies_below = self.copies * places as f64 * counts.product::<f64>().max(1.0);
                if self.copies_below > self.limit as f64 {
                    self.findings.too_many.get_or_insert(node);
                }
            }
            // Points may have no interior.
            "points" => {}
            _ => self.findings.brushes[self.definition] += self.copies,
        }
    }

    fn outline(&mut self, entry: Entry) -> Checked<()> {
        kind_of(self.document, entry, OUTLINE_KINDS, OUTLINE_EXTRAS, "an OUTLINE")?;
        for (key, value) in self.document.members(entry) {
            let name = self.document.text(key);
            match find(OUTLINE_KINDS, &name).or_else(|| find(OUTLINE_EXTRAS, &name)) {
                Some(field) => self.value(value, field.want)?,
                None => return Err(unknown_key(value, &name, OUTLINE_KINDS.iter().chain(OUTLINE_EXTRAS))),
            }
        }
        Ok(())
    }

    fn later(&mut self, entry: Entry, is_node: bool) {
        self.tasks.push(Task { entry, is_node, depth: self.depth + 1, copies: self.copies_below });
    }

    fn value(&mut self, entry: Entry, want: Want) -> Checked<()> {
        match want {
            Want::Number => self.number(entry),
            Want::Text => self.is(entry, self.document.kind(entry) == Kind::Text, "a text"),
            Want::Flag => self.is(entry, matches!(self.document.kind(entry), Kind::Bool(_)), "true or false"),
            Want::Choice(choices) => self.choice(entry, choices),
            Want::Vector(length) => self.vector(entry, length),
            Want::Scale(length) => self.scale(entry, length),
            Want::Rows(length) => self.rows(entry, length),
            Want::Matrix(columns) => self.matrix(entry, columns),
            Want::Loops => self.loops(entry),
            Want::Turn => self.turn(entry),
            Want::Mesh => self.mesh(entry),
            Want::Steps => self.steps(entry),
            Want::Places => self.places(entry),
            Want::Object(fields) => self.object(entry, fields),
            Want::Node => self.one(entry, true),
            Want::Outline => self.one(entry, false),
            Want::Nodes => self.several(entry, true, "a list of one or more nodes"),
            Want::Outlines => self.several(entry, false, "a list of one or more outlines"),
            Want::NodePair => {
                self.is(entry, self.length(entry) == Some(2), "a list of two nodes")?;
                self.several(entry, true, "")
            }
            Want::PartName => self.use_of(entry, true),
            Want::OutlineName => self.use_of(entry, false),
            Want::MaterialName => self.material(entry),
            Want::MaterialNames => self.material_names(entry),
            Want::With => self.with(entry),
        }
    }

    fn is(&self, entry: Entry, holds: bool, expected: &str) -> Checked<()> {
        if holds { Ok(()) } else { self.document.refuse(entry, expected) }
    }

    fn length(&self, entry: Entry) -> Option<usize> {
        (self.document.kind(entry) == Kind::List).then(|| self.document.items(entry).count())
    }

    fn number(&mut self, entry: Entry) -> Checked<()> {
        let text = match self.document.kind(entry) {
            Kind::Number(_) => return Ok(()),
            Kind::Text => self.document.text(entry),
            _ => return self.document.refuse(entry, "a number or an expression"),
        };
        let Some(formula) = text.strip_prefix('=') else {
            return self.document.refuse(entry, "a number, or an expression that begins with `=`");
        };
        match expression::parse(formula, &self.names.parameters.by_name) {
            Ok(expression) => self.findings.expressions.insert(entry, expression),
            Err(fault) => {
                let found = format!("{} in the expression \"{}\"", fault.found, shorten(&text));
                return Err(Fault::new(entry, found, fault.expected));
            }
        };
        Ok(())
    }

    fn choice(&self, entry: Entry, choices: &[&str]) -> Checked<()> {
        let holds = self.document.kind(entry) == Kind::Text && choices.contains(&&*self.document.text(entry));
        self.is(entry, holds, &format!("one of {}", choices.join(", ")))
    }

    fn vector(&mut self, entry: Entry, length: usize) -> Checked<()> {
        self.is(entry, self.length(entry) == Some(length), &format!("a list of {length} numbers"))?;
        let document = self.document;
        document.items(entry).try_for_each(|item| self.number(item))
    }

    fn scale(&mut self, entry: Entry, length: usize) -> Checked<()> {
        match self.document.kind(entry) {
            Kind::List => self.vector(entry, length),
            Kind::Number(_) | Kind::Text => self.number(entry),
            _ => self.document.refuse(entry, format!("a number or a list of {length}")),
        }
    }

    fn rows(&mut self, entry: Entry, length: usize) -> Checked<()> {
        let expected = format!("a list of one or more lists of {length} numbers");
        self.is(entry, self.length(entry).is_some_and(|count| count > 0), &expected)?;
        let document = self.document;
        document.items(entry).try_for_each(|row| self.vector(row, length))
    }

    fn matrix(&mut self, entry: Entry, columns: usize) -> Checked<()> {
        let rows = self.length(entry).is_some_and(|rows| rows == columns || rows + 1 == columns);
        self.is(entry, rows, &format!("{} or {columns} rows of {columns} numbers", columns - 1))?;
        self.rows(entry, columns)
    }

    fn loops(&mut self, entry: Entry) -> Checked<()> {
        let document = self.document;
        let first = document.items(entry).next();
        let is_nested = first.and_then(|first| document.items(first).next()).map(|inner| document.kind(inner));
        if is_nested != Some(Kind::List) {
            return self.points_of_loop(entry);
        }
        document.items(entry).try_for_each(|each| self.points_of_loop(each))
    }

    fn points_of_loop(&mut self, entry: Entry) -> Checked<()> {
        let enough = self.length(entry).is_some_and(|count| count >= 3);
        self.is(entry, enough, "a list of three or more points [x, y]")?;
        self.rows(entry, 2)
    }

    fn turn(&mut self, entry: Entry) -> Checked<()> {
        match self.document.kind(entry) {
            Kind::List => self.vector(entry, 3),
            Kind::Object => self.object(entry, TURN),
            _ => self.document.refuse(entry, "a list of 3 angles, or an object with axis and angle"),
        }
    }

    fn steps(&mut self, entry: Entry) -> Checked<()> {
        self.is(entry, self.length(entry).is_some(), "a list of transform steps")?;
        let document = self.document;
        document.items(entry).try_for_each(|step| {
            let (field, value) = kind_of(document, step, STEP_KINDS, &[], "a transform step")?;
            self.refuse_other_keys(step, STEP_KINDS)?;
            self.value(value, field.want)
        })
    }

    fn places(&mut self, entry: Entry) -> Checked<()> {
        self.is(entry, self.length(entry).is_some_and(|count| count > 0), "a list of one or more places")?;
        let document = self.document;
        document.items(entry).try_for_each(|place| match place_of(document, place) {
            Some(PlaceForm::Point) => self.vector(place, 3),
            Some(PlaceForm::Steps) => self.steps(place),
            Some(PlaceForm::Matrix) => self.object(place, PLACE),
            None => document.refuse(place, "a place: [x, y, z], a list of transform steps, or {\"matrix\": …}"),
        })
    }

    fn object(&mut self, entry: Entry, fields: &'static [Field]) -> Checked<()> {
        let keys = || list(fields.iter());
        self.is(entry, self.document.kind(entry) == Kind::Object, &format!("an object with the keys {}", keys()))?;
        self.refuse_other_keys(entry, fields)?;
        for field in fields {
            match self.document.member(entry, field.key) {
                Some(value) => self.value(value, field.want)?,
                None if field.required => {
                    return self.document.refuse(entry, format!("the key `{}` as well", field.key));
                }
                None => {}
            }
        }
        Ok(())
    }

    fn refuse_other_keys(&self, entry: Entry, fields: &'static [Field]) -> Checked<()> {
        let mut members = self.document.members(entry).map(|(key, value)| (self.document.text(key), value));
        match members.find(|(key, _)| find(fields, key).is_none()) {
            Some((key, value)) => Err(unknown_key(value, &key, fields.iter())),
            None => Ok(()),
        }
    }

    fn one(&mut self, entry: Entry, is_node: bool) -> Checked<()> {
        self.later(entry, is_node);
        Ok(())
    }

    fn several(&mut self, entry: Entry, is_node: bool, expected: &str) -> Checked<()> {
        self.is(entry, self.length(entry).is_some_and(|count| count > 0), expected)?;
        let document = self.document;
        document.items(entry).for_each(|item| self.later(item, is_node));
        Ok(())
    }

    fn use_of(&mut self, entry: Entry, is_part: bool) -> Checked<()> {
        let (table, what) = if is_part { (&self.names.parts, "part") } else { (&self.names.outlines, "outline") };
        self.is(entry, self.document.kind(entry) == Kind::Text, &format!("the name of a {what}"))?;
        let Some(index) = table.by_name.get(&*self.document.text(entry)).map(|index| *index as usize) else {
            let expected = format!("the name of a{} {what}: {}", if is_part { "" } else { "n" }, table.known());
            return self.document.refuse(entry, expected);
        };
        let used = if is_part { self.names.part_vertex(index) } else { self.names.outline_vertex(index) };
        self.findings.uses.push(Use { user: self.definition, used, entry, copies: self.copies });
        Ok(())
    }

    fn with(&mut self, entry: Entry) -> Checked<()> {
        self.is(entry, self.document.kind(entry) == Kind::Object, "an object of parameters and their numbers")?;
        let document = self.document;
        for (key, value) in document.members(entry) {
            let name = document.text(key);
            if !self.names.parameters.by_name.contains_key(&*name) {
                let found = format!("the key `{}`", shorten(&name));
                return Err(Fault::new(value, found, format!("a parameter: {}", self.names.parameters.known())));
            }
            self.number(value)?;
        }
        Ok(())
    }
}

/// The field of a key that a NODE may have beside the one that says what it is.
fn companion(kind: &str, key: &str, value: Entry) -> Checked<&'static Field> {
    match COMPANIONS.iter().find(|(_, field)| field.key == key) {
        Some((owner, field)) if *owner == kind => Ok(field),
        Some((owner, _)) => {
            Err(Fault::new(value, format!("the key `{key}` beside `{kind}`"), format!("it beside `{owner}` alone")))
        }
        None => {
            let companions = COMPANIONS.iter().map(|(_, field)| field);
            Err(unknown_key(value, key, NODE_KINDS.iter().chain(NODE_EXTRAS).chain(companions)))
        }
    }
}
