//! Whether brushes add to the solid or take from it, of the whole model.
//!
//! Where faces lie on one plane, that decides with the materials which of them the boundary gets (`docs/weld.md`, "Coplanar faces: who owns
//! the boundary"). A brush has the polarity of all that equal it, wherever these are; blocks that each looked for themselves would not agree on the
//! walls between them.

use planecut_kernel::sign::Row;
use rustc_hash::FxHashSet;

use crate::body::mark_of_faces;
use crate::expression::Polarity;
use crate::model::{Brush, Operation};
use crate::plane_table::{first_side, key};

/// Follows a tree that goes by, and says of each brush whether it adds to the solid.
#[derive(Debug, Default)]
pub struct PolarityStack {
    /// The operations that have begun: polarity, and whether an operand has come.
    open: Vec<(Operation, Polarity, bool)>,
}

impl PolarityStack {
    /// An operation begins.
    pub fn begin(&mut self, operation: Operation) {
        let polarity = self.leaf();
        self.open.push((operation, polarity, false));
    }

    /// A brush comes: gives its polarity in the tree.
    pub fn leaf(&mut self) -> Polarity {
        match self.open.last_mut() {
            None => Polarity::Adds,
            Some((operation, polarity, has_operand)) => {
                let is_first = !std::mem::replace(has_operand, true);
                polarity.below(*operation, is_first)
            }
        }
    }

    /// An operation ends.
    pub fn end(&mut self) {
        self.open.pop();
    }
}

/// A number that equal brushes share: those with the same faces of the same materials. `redundant` are the numbers of planes that have no face.
#[must_use]
pub fn brush_mark(brush: &Brush, redundant: &[u32]) -> u64 {
    let faces = (0..).zip(&brush.faces).filter(|(number, _)| !redundant.contains(number));
    mark_of_faces(faces.map(|(_, face)| {
        let (row, is_reversed) = first_side(&Row::new(&face.half_space));
        (key(&row), is_reversed, face.material)
    }))
}

/// The brushes that are equal to others of another polarity: in memory as far as there are such.
#[derive(Debug, Default)]
pub struct SharedBrushes {
    marks: FxHashSet<u64>,
    last: Option<(u64, Polarity)>,
}

impl SharedBrushes {
    /// Adds the mark of a brush and its polarity; all of a model come in ascending order.
    pub fn push(&mut self, mark: u64, polarity: Polarity) {
        if let Some((last, other)) = self.last.replace((mark, polarity))
            && last == mark
            && other != polarity
        {
            self.marks.insert(mark);
        }
    }

    /// The polarity of all brushes that equal one.
    #[must_use]
    pub fn polarity(&self, mark: u64, own: Polarity) -> Polarity {
        if self.marks.contains(&mark) { Polarity::Both } else { own }
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.marks.is_empty()
    }
}
