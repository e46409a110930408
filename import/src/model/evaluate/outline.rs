//! OUTLINEs, which may need solids and be needed by them.

use planecut_csg::Operation;
use planecut_shapes::Outline;

use super::{Context, Evaluator, Task};
use crate::model::body::Maker;
use crate::model::error::{Checked, Fault};
use crate::model::form::kind_of;
use crate::model::json::Entry;
use crate::model::keys::{OUTLINE_EXTRAS, OUTLINE_KINDS};
use crate::model::materials::NO_MATERIAL;
use crate::model::parameters::Environment;

impl Evaluator<'_, '_> {
    /// Evaluates an OUTLINE, or leaves word of what is still to be done for it.
    ///
    /// # Errors
    /// [`Fault`] of the number that has no shape.
    pub(super) fn outline(&mut self, entry: Entry, environment: &Environment, depth: u32) -> Checked<()> {
        let document = self.definitions.document;
        self.enter(entry, depth)?;
        let (field, value) = kind_of(document, entry, OUTLINE_KINDS, OUTLINE_EXTRAS, "an OUTLINE")?;
        if let Some(matrix) = document.member(entry, "matrix") {
            self.tasks.push(Task::MoveOutline(matrix, environment.clone()));
        }
        let of = document.member(value, "of").unwrap_or(value);
        let within = |entry| Task::Outline(entry, environment.clone(), depth + 1);
        let solid = |entry| Task::Node(Context::frame(entry, environment.clone(), depth + 1));
        match field.key {
            "union" => self.combine_outlines(Operation::Union, value, within),
            "intersection" => self.combine_outlines(Operation::Intersection, value, within),
            "difference" => self.combine_outlines(Operation::Difference, value, within),
            "xor" => self.combine_outlines(Operation::Xor, value, within),
            "offset" => self.tasks.extend([Task::Offset(value, environment.clone()), within(of)]),
            "slice" => self.tasks.extend([Task::Slice(value, environment.clone()), solid(of)]),
            "project" => self.tasks.extend([Task::Project(value, environment.clone()), solid(value)]),
            "use" => self.use_of_outline(value, environment, within),
            key => {
                let maker = Maker { values: self.definitions.values(environment), value, material: NO_MATERIAL };
                let outline = maker.outline(key)?;
                self.made_outline(value, outline.unwrap_or_default())?;
            }
        }
        Ok(())
    }

    /// An outline by its name: the one that was made before, where there is one.
    fn use_of_outline(&mut self, name: Entry, environment: &Environment, within: impl Fn(Entry) -> Task) {
        let outline = self.names.outlines.by_name.get(&*self.definitions.document.text(name)).copied().unwrap_or(0);
        if let Some(made) = self.kept_outlines.get(&(outline, environment.number)) {
            self.outlines.push(made.clone());
            return;
        }
        if self.uses[self.names.outline_vertex(outline as usize)] > 1 {
            self.tasks.push(Task::KeepOutline(outline, environment.number));
        }
        self.tasks.push(within(self.names.outlines.entries[outline as usize]));
    }

    /// Keeps the last outline.
    pub(super) fn keep_outline(&mut self, outline: u32, environment: u32) {
        if let Some(made) = self.outlines.last() {
            self.kept_outlines.insert((outline, environment), made.clone());
        }
    }

    fn combine_outlines(&mut self, operation: Operation, value: Entry, within: impl Fn(Entry) -> Task) {
        let operands: Vec<Task> = self.definitions.document.items(value).map(within).collect();
        self.tasks.push(Task::CombineOutlines(operation, operands.len(), value));
        self.tasks.extend(operands.into_iter().rev());
    }

    /// Moves the last outline.
    ///
    /// # Errors
    /// [`Fault`] of a matrix that is flat.
    pub(super) fn move_outline(&mut self, matrix: Entry, environment: &Environment) -> Checked<()> {
        let outline = self.outlines.pop().unwrap_or_default();
        let (linear, translation) = self.definitions.values(environment).planar_matrix(matrix)?;
        let moved = outline.transformed(linear, translation);
        let moved = moved.map_err(|error| Fault::new(matrix, error.to_string(), "an invertible map"))?;
        self.made_outline(matrix, moved)
    }

    /// Puts an outline that was made from numbers, or from other outlines, where the next step finds it.
    ///
    /// # Errors
    /// [`Fault`] where there are too many corners by now.
    pub(super) fn made_outline(&mut self, entry: Entry, outline: Outline) -> Checked<()> {
        self.budget.add_corners(entry, outline.corner_count())?;
        self.outlines.push(outline);
        Ok(())
    }
}
