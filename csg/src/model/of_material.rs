//! The part of a model that is made of one material.

use super::{Brush, MaterialId, Model, Operation, Tree, TreeNode};

/// What is known of a result on the way.
struct Entry {
    solid: Tree,
    part: Part,
    /// The material of the first brush.
    first: Option<MaterialId>,
    /// Whether what is far away lies in the solid, as in a complement.
    holds_outside: bool,
}

/// The part of a solid that is made of the material.
enum Part {
    Nothing,
    All,
    Some(Tree),
}

impl Part {
    fn of(self, solid: &Tree) -> Tree {
        match self {
            Self::Nothing => Tree::empty(),
            Self::All => solid.clone(),
            Self::Some(part) => part,
        }
    }
}

impl Model {
    /// The part of the solid that is made of one material.
    ///
    /// A brush is made of the material of most of its faces, the first of these where several have as many. Where brushes of several materials overlap,
    /// what was added last is there: of a union and of an exclusive or the last operand that holds the place counts. What others are taken from, or intersected with, stays what it is made of: of
    /// a difference the first operand counts, of an intersection the first that does not reach infinity as a complement does. A complement is made of what its first brush is. So each place of the solid is of one material, and the parts of all
    /// materials make up the solid. Faces count for their brush alone: the wall of a hole may have another material than what the hole is in.
    ///
    /// The tree of the part has up to twice as many brushes for each level of nested operations of several materials.
    #[must_use]
    pub fn part_of_material(&self, material: MaterialId) -> Self {
        let mut brushes = self.tree.brushes().iter();
        let mut entries: Vec<Entry> = Vec::new();
        for node in self.tree.nodes() {
            let entry = match *node {
                TreeNode::Leaf => {
                    let brush = brushes.next().expect("a leaf is a brush");
                    let first = made_of(brush);
                    let part = if first == Some(material) { Part::All } else { Part::Nothing };
                    Entry { solid: brush.clone().into(), part, first, holds_outside: false }
                }
                TreeNode::Operation { operation, operands } => {
                    let operands = entries.split_off(entries.len() - operands as usize);
                    combined(operation, operands, material)
                }
            };
            entries.push(entry);
        }
        let tree = entries.pop().map_or_else(Tree::empty, |entry| entry.part.of(&entry.solid));
        Self { materials: self.materials.clone(), tree: tree.without_source_lines() }
    }
}

/// The material of most faces of a brush.
fn made_of(brush: &Brush) -> Option<MaterialId> {
    let mut counts: Vec<(MaterialId, usize)> = Vec::new();
    for material in brush.materials() {
        match counts.iter_mut().find(|(known, _)| *known == material) {
            Some((_, count)) => *count += 1,
            None => counts.push((material, 1)),
        }
    }
    // of several the first
    counts.iter().rev().max_by_key(|(_, count)| *count).map(|(material, _)| *material)
}

fn combined(operation: Operation, mut operands: Vec<Entry>, material: MaterialId) -> Entry {
    let outside: Vec<bool> = operands.iter().map(|operand| operand.holds_outside).collect();
    let holds_outside = operation.value(&outside);
    let first = operands.iter().find_map(|operand| operand.first);
    let are_all = |is: fn(&Part) -> bool| operands.iter().all(|operand| is(&operand.part));
    let part = match operation {
        // it is made of one material, as what it is the complement of begins
        Operation::Complement if first == Some(material) => Part::All,
        Operation::Complement => Part::Nothing,
        _ if are_all(|part| matches!(part, Part::Nothing)) => Part::Nothing,
        _ if are_all(|part| matches!(part, Part::All)) => Part::All,
        Operation::Union => Part::Some(added(&mut operands)),
        Operation::Xor => {
            let part = added(&mut operands);
            let solids = operands.iter().map(|operand| operand.solid.clone());
            Part::Some(Tree::intersection([part, Tree::combine(operation, solids)]))
        }
        Operation::Difference => what_is_left(operation, &mut operands, 0),
        Operation::Intersection => {
            let counts = operands.iter().position(|operand| !operand.holds_outside).unwrap_or(0);
            what_is_left(operation, &mut operands, counts)
        }
    };
    let solid = Tree::combine(operation, operands.into_iter().map(|operand| operand.solid));
    Entry { solid, part, first, holds_outside }
}

/// Where the last of some operands that holds a place is made of the material.
fn added(operands: &mut [Entry]) -> Tree {
    let mut sum: Option<Tree> = None;
    for Entry { solid, part, .. } in operands {
        let part = std::mem::replace(part, Part::Nothing);
        sum = match (sum, part) {
            (None, Part::Nothing) => None,
            (None, part) => Some(part.of(solid)),
            (Some(before), Part::Nothing) => Some(Tree::difference([before, solid.clone()])),
            (Some(before), Part::All) => Some(Tree::union([before, solid.clone()])),
            (Some(before), Part::Some(part)) => Some(Tree::union([Tree::difference([before, solid.clone()]), part])),
        };
    }
    sum.unwrap_or_else(Tree::empty)
}

/// What others leave of the part of one operand.
fn what_is_left(operation: Operation, operands: &mut [Entry], counts: usize) -> Part {
    let part = match std::mem::replace(&mut operands[counts].part, Part::Nothing) {
        Part::Some(part) => part,
        whole => return whole,
    };
    let others = operands.iter().enumerate().filter(|(place, _)| *place != counts);
    let others = others.map(|(_, operand)| operand.solid.clone());
    // for both operations it makes no difference in which order the others come
    Part::Some(Tree::combine(operation, std::iter::once(part).chain(others)))
}
