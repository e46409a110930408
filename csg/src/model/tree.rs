//! Trees of set operations over brushes.

use std::num::NonZeroU32;
use std::ops::{BitAnd, BitOr, BitXor, Not, Sub};

use super::{Brush, MaterialId, MeshBody, Transform, TransformError};

/// A regularised set operation: what is left of a result without interior is nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Operation {
    /// What lies in any operand; nothing where there is none.
    Union,
    /// What lies in all operands; all of space where there is none.
    Intersection,
    /// What lies in the first operand and in no other; nothing where there is none.
    Difference,
    /// What lies in an odd number of operands.
    Xor,
    /// What lies in no operand.
    Complement,
}

impl Operation {
    /// The name by which files and programs call it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Union => "union",
            Self::Intersection => "intersection",
            Self::Difference => "difference",
            Self::Xor => "xor",
            Self::Complement => "complement",
        }
    }

    /// The value for operands of some values.
    pub(crate) fn value(self, operands: &[bool]) -> bool {
        match self {
            Self::Union => operands.contains(&true),
            Self::Intersection => !operands.contains(&false),
            Self::Difference => operands.split_first().is_some_and(|(first, others)| *first && !others.contains(&true)),
            Self::Xor => operands.iter().filter(|value| **value).count() % 2 == 1,
            Self::Complement => !operands.contains(&true),
        }
    }
}

/// One entry of a [`Tree`] in postfix order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub enum TreeNode {
    /// The next brush.
    Leaf,
    /// An operation on the results of the last entries that no other operation has taken.
    Operation {
        /// What to do with them.
        operation: Operation,
        /// How many of them.
        operands: u32,
    },
}

/// A solid as set operations over convex brushes, nested to any depth.
///
/// The tree is kept in postfix order, leaf `k` being brush `k`: a deep tree needs no deep stack, and `a | b` costs what `b`
/// is long. Nothing is evaluated until [`evaluate`](crate::evaluate) is asked for a mesh, or
/// `Solid::from_tree` of the crate of cells for these.
///
/// ```
/// use planecut_csg::{Brush, MaterialId, Tree};
/// use planecut_kernel::DVec3;
///
/// let block = |min: f64, max: f64| Tree::from(Brush::cuboid(DVec3::splat(min), DVec3::splat(max), MaterialId(0)));
/// let frame = block(0.0, 3.0) - block(1.0, 2.0) | block(5.0, 6.0);
/// assert_eq!((frame.brushes().len(), frame.nodes().len()), (3, 5));
/// ```
///
/// # Guarantees
/// The nodes are well formed: every operation finds its operands, one result is left, and there are as many leaves as
/// brushes.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "super::saved::SavedTree"))]
pub struct Tree {
    pub(super) brushes: Vec<Brush>,
    pub(super) nodes: Vec<TreeNode>,
    /// The source line of each brush; empty where no brush has one, so that trees without a source pay nothing for them, and equal
    /// ones compare as equal.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub(super) lines: Vec<Option<NonZeroU32>>,
}

impl Default for Tree {
    /// Nothing.
    fn default() -> Self {
        Self::empty()
    }
}

impl From<MeshBody> for Tree {
    fn from(mesh: MeshBody) -> Self {
        Brush::of_mesh(mesh).into()
    }
}

impl From<Brush> for Tree {
    fn from(brush: Brush) -> Self {
        Self::of_parts(vec![brush], vec![TreeNode::Leaf])
    }
}

impl Tree {
    /// Nothing: the union of no operands.
    #[must_use]
    pub fn empty() -> Self {
        Self::union_of(Vec::new())
    }

    /// All of space: the intersection of no operands.
    #[must_use]
    pub fn everything() -> Self {
        Self::of_parts(Vec::new(), vec![operation(Operation::Intersection, 0)])
    }

    /// The union of brushes.
    #[must_use]
    pub fn union_of(brushes: Vec<Brush>) -> Self {
        let mut nodes = vec![TreeNode::Leaf; brushes.len()];
        nodes.push(operation(Operation::Union, brushes.len()));
        Self::of_parts(brushes, nodes)
    }

    /// A tree of brushes and well-formed nodes over as many leaves, without source lines.
    pub(crate) fn of_parts(brushes: Vec<Brush>, nodes: Vec<TreeNode>) -> Self {
        Self { brushes, nodes, lines: Vec::new() }
    }

    /// What lies in any operand.
    #[must_use]
    pub fn union(operands: impl IntoIterator<Item = Self>) -> Self {
        Self::combine(Operation::Union, operands)
    }

    /// What lies in all operands; all of space where there is none.
    #[must_use]
    pub fn intersection(operands: impl IntoIterator<Item = Self>) -> Self {
        Self::combine(Operation::Intersection, operands)
    }

    /// What lies in the first operand and in no other.
    #[must_use]
    pub fn difference(operands: impl IntoIterator<Item = Self>) -> Self {
        Self::combine(Operation::Difference, operands)
    }

    /// What lies in an odd number of operands.
    #[must_use]
    pub fn xor(operands: impl IntoIterator<Item = Self>) -> Self {
        Self::combine(Operation::Xor, operands)
    }

    /// What does not lie in this.
    #[must_use]
    pub fn complement(mut self) -> Self {
        self.nodes.push(operation(Operation::Complement, 1));
        self
    }

    /// The operation on the operands, in their order. Where the first operand is itself the same operation, the others join
    /// it, so that a chain of operators makes a flat tree; [`Operation::Complement`] is that of the union.
    #[must_use]
    pub fn combine(kind: Operation, operands: impl IntoIterator<Item = Self>) -> Self {
        let mut operands = operands.into_iter();
        let Some(mut tree) = operands.next() else {
            return Self::of_parts(Vec::new(), vec![operation(kind, 0)]);
        };
        let mut count = match tree.nodes.last() {
            Some(TreeNode::Operation { operation, operands }) if *operation == kind && joins(kind) && *operands > 0 => {
                let count = *operands as usize;
                tree.nodes.pop();
                count
            }
            _ => 1,
        };
        for operand in operands {
            tree.append_lines(operand.lines, operand.brushes.len());
            tree.brushes.extend(operand.brushes);
            tree.nodes.extend(operand.nodes);
            count += 1;
        }
        tree.nodes.push(operation(kind, count));
        tree
    }

    /// Whether a leaf is a closed mesh.
    #[must_use]
    pub fn has_meshes(&self) -> bool {
        self.brushes.iter().any(Brush::is_mesh)
    }

    /// The brushes, in the order of the leaves; some may be closed meshes.
    #[must_use]
    pub fn brushes(&self) -> &[Brush] {
        &self.brushes
    }

    /// The brushes, to be changed one by one.
    pub fn brushes_mut(&mut self) -> &mut [Brush] {
        &mut self.brushes
    }

    /// The line of the input on which a brush begins, counted from 1; `None` where it comes from no line of an input. Lines are
    /// those of the file that was read: messages name them, geometry knows nothing of them. Brushes keep theirs wherever trees
    /// are combined or moved.
    ///
    /// ```
    /// use std::num::NonZeroU32;
    ///
    /// use planecut_csg::{Brush, MaterialId, Tree};
    /// use planecut_kernel::DVec3;
    ///
    /// let block = |at: f64| Tree::from(Brush::cuboid(DVec3::splat(at), DVec3::splat(at + 2.0), MaterialId(0)));
    /// let tree = block(0.0) | block(1.0).with_source_line(NonZeroU32::new(7));
    /// assert_eq!((tree.source_line(0), tree.source_line(1)), (None, NonZeroU32::new(7)));
    /// ```
    #[must_use]
    pub fn source_line(&self, brush: usize) -> Option<NonZeroU32> {
        self.lines.get(brush).copied().flatten()
    }

    /// The [`source_line`](Self::source_line) of each brush.
    pub fn source_lines(&self) -> impl ExactSizeIterator<Item = Option<NonZeroU32>> {
        (0..self.brushes.len()).map(|brush| self.source_line(brush))
    }

    /// The tree with a source line for each brush that has none.
    #[must_use]
    pub fn with_source_line(mut self, line: Option<NonZeroU32>) -> Self {
        if line.is_some() {
            self.lines.resize(self.brushes.len(), None);
            self.lines.iter_mut().filter(|own| own.is_none()).for_each(|own| *own = line);
        }
        self
    }

    /// The tree with source lines in place of those that it has.
    ///
    /// # Panics
    /// Where there are not as many as brushes.
    #[must_use]
    pub fn with_source_lines(mut self, lines: Vec<Option<NonZeroU32>>) -> Self {
        assert_eq!(lines.len(), self.brushes.len(), "a line for each brush");
        self.lines = known_lines(lines);
        self
    }

    /// The tree without source lines, for one that becomes part of what is made of another input.
    #[must_use]
    pub fn without_source_lines(mut self) -> Self {
        self.lines.clear();
        self
    }

    /// Appends the source lines of brushes that follow those that are there.
    fn append_lines(&mut self, lines: Vec<Option<NonZeroU32>>, brushes: usize) {
        if self.lines.is_empty() && lines.is_empty() {
            return;
        }
        self.lines.resize(self.brushes.len(), None);
        self.lines.extend(lines);
        self.lines.resize(self.brushes.len() + brushes, None);
    }

    /// The brushes alone.
    #[must_use]
    pub fn into_brushes(self) -> Vec<Brush> {
        self.brushes
    }

    /// Whether it is the union of its brushes.
    #[must_use]
    pub fn is_union(&self) -> bool {
        self.nodes.iter().all(|node| match node {
            TreeNode::Leaf => true,
            TreeNode::Operation { operation: Operation::Union, .. } => true,
            TreeNode::Operation { operation: Operation::Complement, .. } => false,
            TreeNode::Operation { operands, .. } => *operands == 1,
        })
    }

    /// Whether it holds what none of its brushes holds, as a complement does: then it is not bounded.
    #[must_use]
    pub fn holds_outside(&self) -> bool {
        holds_outside(&self.nodes)
    }

    /// The entries in postfix order; the last one is the root.
    #[must_use]
    pub fn nodes(&self) -> &[TreeNode] {
        &self.nodes
    }

    /// The tree moved by an affine map.
    ///
    /// # Errors
    /// [`TransformError::OutOfRange`] where a plane leaves the accepted range.
    pub fn transformed(mut self, transform: &Transform) -> Result<Self, TransformError> {
        for brush in &mut self.brushes {
            *brush = std::mem::take(brush).transformed(transform)?;
        }
        Ok(self)
    }

    /// The tree with all faces of one material.
    #[must_use]
    pub fn with_material(mut self, material: MaterialId) -> Self {
        self.brushes.iter_mut().flat_map(Brush::materials_mut).for_each(|own| *own = material);
        self
    }

    /// The tree with a name on each brush that has none.
    #[must_use]
    pub fn with_name(mut self, name: &str) -> Self {
        for brush in self.brushes.iter_mut().filter(|brush| brush.name.is_none()) {
            brush.name = Some(name.to_owned());
        }
        self
    }
}

/// Whether what well-formed nodes make of leaves holds what no leaf holds.
pub(crate) fn holds_outside(nodes: &[TreeNode]) -> bool {
    let mut values: Vec<bool> = Vec::new();
    for node in nodes {
        let TreeNode::Operation { operation, operands } = node else {
            values.push(false);
            continue;
        };
        let operands = values.split_off(values.len() - *operands as usize);
        values.push(operation.value(&operands));
    }
    values.pop().expect("a root")
}

/// Lines of brushes as a tree keeps them.
pub(super) fn known_lines(lines: Vec<Option<NonZeroU32>>) -> Vec<Option<NonZeroU32>> {
    if lines.iter().any(Option::is_some) { lines } else { Vec::new() }
}

fn operation(operation: Operation, operands: usize) -> TreeNode {
    let operands = u32::try_from(operands).expect("fewer than 2^32 operands");
    TreeNode::Operation { operation, operands }
}

/// Whether `(a ∘ b) ∘ c` is `a ∘ b ∘ c`.
fn joins(kind: Operation) -> bool {
    match kind {
        Operation::Union | Operation::Intersection | Operation::Difference | Operation::Xor => true,
        Operation::Complement => false,
    }
}

impl BitOr for Tree {
    type Output = Self;
    fn bitor(self, other: Self) -> Self {
        Self::union([self, other])
    }
}

impl BitAnd for Tree {
    type Output = Self;
    fn bitand(self, other: Self) -> Self {
        Self::intersection([self, other])
    }
}

impl BitXor for Tree {
    type Output = Self;
    fn bitxor(self, other: Self) -> Self {
        Self::xor([self, other])
    }
}

impl Sub for Tree {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::difference([self, other])
    }
}

impl Not for Tree {
    type Output = Self;
    fn not(self) -> Self {
        self.complement()
    }
}
