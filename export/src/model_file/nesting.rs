//! A tree in postfix order as nodes within nodes.

use planecut_csg::{Brush, Operation, Tree, TreeNode};

/// Nothing, without a brush: what is left of an outline without itself, drawn out. The format has no empty lists of operands.
pub(super) const NOTHING: &str = r#"{"extrude": {"outline": {"difference": [{"rectangle": {"min": [0, 0], "max": [1, 1]}}, {"rectangle": {"min": [0, 0], "max": [1, 1]}}]}, "height": 1}}"#;
/// How many nodes and outlines are within one another in it, itself not counted.
pub(super) const NOTHING_DEPTH: usize = 2;

/// What is written, one after another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Piece {
    /// An operation begins: what follows are its operands.
    Open(Operation),
    /// The brush of this number.
    Leaf(usize),
    /// Nothing, and no brush.
    Nothing,
    /// The operation that began last, of those that are open, ends.
    Close,
}

/// What becomes of an entry of the tree.
#[derive(Debug, Clone, Copy)]
struct Plan {
    /// The entry with which its operands begin; its own where it has none.
    start: usize,
    /// How many operands it has in the end, those of operations that are joined with it included; of a leaf 1, or 0 where it is nothing.
    operands: usize,
    /// Whether its operands become those of the operation that it is itself an operand of.
    is_joined: bool,
    /// The next of the operations whose operands begin with the same entry, from the outermost to the innermost.
    inner: Option<usize>,
}

/// All of space, without a brush: what is not in nothing.
const EVERYTHING: [Piece; 3] = [Piece::Open(Operation::Complement), Piece::Nothing, Piece::Close];

/// The pieces of a tree, flattened where that says the same. No recursion: depth costs no stack.
pub(super) fn pieces(tree: &Tree) -> Vec<Piece> {
    let (nodes, mut brushes) = (tree.nodes(), tree.brushes().iter().enumerate());
    let mut plans = plans(tree);
    let outermost = link(&mut plans);
    let mut pieces = Vec::with_capacity(2 * nodes.len());
    for (place, node) in nodes.iter().enumerate() {
        open(outermost[place], nodes, &plans, &mut pieces);
        let Plan { operands, is_joined, .. } = plans[place];
        // next also where the leaf is left out
        let leaf = if *node == TreeNode::Leaf { brushes.next() } else { None };
        match (*node, leaf) {
            _ if is_joined => {}
            (TreeNode::Leaf, Some((_, brush))) if is_everything(brush) => pieces.extend(EVERYTHING),
            (TreeNode::Leaf, Some((number, _))) if operands > 0 => pieces.push(Piece::Leaf(number)),
            (TreeNode::Leaf, _) => pieces.push(Piece::Nothing),
            (TreeNode::Operation { operation, .. }, _) if operands == 0 => {
                pieces.extend_from_slice(if holds_nothing(operation) { &[Piece::Nothing] } else { &EVERYTHING });
            }
            (TreeNode::Operation { .. }, _) => {
                pieces.push(Piece::Close);
                pieces.extend(is_of_several(*node).then_some(Piece::Close));
            }
        }
    }
    pieces
}

/// Opens the operations whose operands begin here, from the outermost on.
fn open(mut next: Option<usize>, nodes: &[TreeNode], plans: &[Plan], pieces: &mut Vec<Piece>) {
    while let Some(place) = next {
        let Plan { operands, is_joined, inner, .. } = plans[place];
        if let (TreeNode::Operation { operation, .. }, false, 1..) = (nodes[place], is_joined, operands) {
            pieces.push(Piece::Open(operation));
            // of several nodes the format has no complement
            pieces.extend(is_of_several(nodes[place]).then_some(Piece::Open(Operation::Union)));
        }
        next = inner;
    }
}

fn plans(tree: &Tree) -> Vec<Plan> {
    let nodes = tree.nodes();
    let mut brushes = tree.brushes().iter();
    let mut plans: Vec<Plan> = Vec::with_capacity(nodes.len());
    // the entries that no operation has taken yet
    let mut waiting: Vec<usize> = Vec::new();
    for (place, node) in nodes.iter().enumerate() {
        let mut plan = Plan { start: place, operands: 0, is_joined: false, inner: None };
        match node {
            TreeNode::Leaf => plan.operands = brushes.next().map_or(0, |brush| usize::from(!is_nothing(brush))),
            TreeNode::Operation { operation, operands } => {
                // what lies in none of several operands is what is not in their union
                let operation = if is_of_several(*node) { Operation::Union } else { *operation };
                let taken = waiting.split_off(waiting.len().saturating_sub(*operands as usize));
                plan.start = taken.first().map_or(place, |first| plans[*first].start);
                for (number, operand) in taken.into_iter().enumerate() {
                    let inner: &mut Plan = &mut plans[operand];
                    inner.is_joined = joins(operation, number, nodes[operand], inner.operands);
                    plan.operands += if inner.is_joined { inner.operands } else { 1 };
                }
            }
        }
        plans.push(plan);
        waiting.push(place);
    }
    plans
}

/// For each entry the outermost of the operations whose operands begin with it; the others are linked to that.
fn link(plans: &mut [Plan]) -> Vec<Option<usize>> {
    let mut outermost = vec![None; plans.len()];
    for (place, plan) in plans.iter_mut().enumerate() {
        if plan.start < place {
            // an operation comes after those within it
            plan.inner = outermost[plan.start].replace(place);
        }
    }
    outermost
}

/// Whether the operands of an operand may stand in its place: where it is nothing, that it may be left out.
fn joins(outer: Operation, number: usize, operand: TreeNode, operands: usize) -> bool {
    let TreeNode::Operation { operation, .. } = operand else {
        return operands == 0 && may_lack_nothing(outer, number);
    };
    if operands == 0 && holds_nothing(operation) && may_lack_nothing(outer, number) {
        return true;
    }
    operation == outer
        && match outer {
            Operation::Union | Operation::Intersection | Operation::Xor => true,
            // nothing without something is nothing: without operands it must stay the first
            Operation::Difference => number == 0 && operands > 0,
            Operation::Complement => false,
        }
}

/// Whether an operand that is nothing changes nothing.
fn may_lack_nothing(outer: Operation, number: usize) -> bool {
    match outer {
        Operation::Union | Operation::Xor => true,
        Operation::Difference => number > 0,
        Operation::Intersection | Operation::Complement => false,
    }
}

/// Whether it is what lies in none of several operands.
fn is_of_several(node: TreeNode) -> bool {
    matches!(node, TreeNode::Operation { operation: Operation::Complement, operands: 2.. })
}

/// Whether an operation without operands holds nothing; otherwise it holds all of space.
fn holds_nothing(operation: Operation) -> bool {
    match operation {
        Operation::Union | Operation::Difference | Operation::Xor => true,
        Operation::Intersection | Operation::Complement => false,
    }
}

/// Whether a brush is all of space, which no list of half-spaces of the format says.
fn is_everything(brush: &Brush) -> bool {
    brush.mesh.is_none() && brush.faces.is_empty()
}

/// Whether a brush is a mesh without triangles, which no list of triangles of the format says.
fn is_nothing(brush: &Brush) -> bool {
    brush.mesh.as_ref().is_some_and(|mesh| mesh.mesh().triangles().is_empty())
}

#[cfg(test)]
mod tests {
    use planecut_csg::{ClosedMesh, MaterialId, MeshBody};
    use planecut_kernel::DVec3;

    use super::*;

    fn leaf() -> Tree {
        Tree::from(Brush::cuboid(DVec3::ZERO, DVec3::ONE, MaterialId(0)))
    }

    /// The pieces of a tree, an operation by its first letter.
    fn shown(tree: &Tree) -> String {
        let shown = |piece: &Piece| match piece {
            Piece::Open(operation) => format!("{}(", &operation.name()[..1]),
            Piece::Leaf(number) => format!("{number} "),
            Piece::Nothing => "- ".to_owned(),
            Piece::Close => ")".to_owned(),
        };
        pieces(tree).iter().map(shown).collect()
    }

    #[test]
    fn operations_are_flattened_where_that_says_the_same() {
        let right = |kind| Tree::combine(kind, [leaf(), Tree::combine(kind, [leaf(), leaf()])]);
        assert_eq!(shown(&right(Operation::Union)), "u(0 1 2 )");
        assert_eq!(shown(&right(Operation::Intersection)), "i(0 1 2 )");
        assert_eq!(shown(&right(Operation::Xor)), "x(0 1 2 )");
        assert_eq!(shown(&right(Operation::Difference)), "d(0 d(1 2 ))");
        assert_eq!(shown(&((leaf() - leaf()) - leaf())), "d(0 1 2 )");
        assert_eq!(shown(&(leaf() | (leaf() & leaf()) | leaf())), "u(0 i(1 2 )3 )");
        assert_eq!(shown(&!!leaf()), "c(c(0 ))");
    }

    #[test]
    fn operations_without_operands_are_nothing_or_everything() {
        let of_none = |kind| Tree::combine(kind, []);
        for kind in [Operation::Union, Operation::Difference, Operation::Xor] {
            assert_eq!(shown(&of_none(kind)), "- ", "{kind:?}");
        }
        for kind in [Operation::Intersection, Operation::Complement] {
            assert_eq!(shown(&of_none(kind)), "c(- )", "{kind:?}");
        }
        assert_eq!(shown(&(Tree::empty() | leaf())), "u(0 )", "nothing adds nothing");
        assert_eq!(shown(&Tree::union([Tree::empty(), Tree::empty()])), "- ");
        assert_eq!(shown(&(Tree::empty() - leaf())), "d(- 0 )");
        let first = Tree::combine(Operation::Difference, []);
        assert_eq!(shown(&(first - leaf())), "d(- 0 )", "the leaf must not become the first operand");
        assert_eq!(shown(&(leaf() & Tree::everything())), "i(0 )");
        assert_eq!(shown(&(leaf() ^ Tree::everything())), "x(0 c(- ))");
    }

    #[test]
    fn what_is_nothing_is_left_out_where_it_changes_nothing() {
        let none = || Tree::from(MeshBody::new(ClosedMesh::default(), Vec::new()));
        for none in [none(), Tree::empty(), Tree::combine(Operation::Xor, []), Tree::combine(Operation::Difference, [])]
        {
            let first = usize::from(none.brushes().len() == 1);
            assert_eq!(shown(&Tree::union([none.clone(), leaf()])), format!("u({first} )"));
            assert_eq!(shown(&Tree::xor([leaf(), none.clone()])), "x(0 )");
            assert_eq!(shown(&Tree::difference([leaf(), none.clone()])), "d(0 )");
            assert_eq!(shown(&Tree::difference([none.clone(), leaf()])), format!("d(- {first} )"));
            assert_eq!(shown(&Tree::intersection([leaf(), none.clone()])), "i(0 - )");
            assert_eq!(shown(&!none.clone()), "c(- )");
            assert_eq!(shown(&Tree::union([none.clone()])), "- ");
            assert_eq!(shown(&none), "- ");
        }
        assert_eq!(shown(&(leaf() & Brush::default().into())), "i(0 c(- ))");
    }

    #[test]
    fn a_complement_of_several_is_that_of_their_union() {
        let several = |operands: Vec<Tree>| shown(&Tree::combine(Operation::Complement, operands));
        assert_eq!(several(vec![leaf(), leaf() - leaf()]), "c(u(0 d(1 2 )))");
        assert_eq!(several(vec![leaf() | leaf(), leaf()]), "c(u(0 1 2 ))");
        assert_eq!(several(vec![leaf(), Tree::empty()]), "c(u(0 ))");
        assert_eq!(several(vec![Tree::empty(), Tree::empty()]), "c(- )");
    }

    #[test]
    fn operations_that_begin_together_begin_from_the_outermost() {
        let tree = ((leaf() & leaf()) | leaf()) - leaf();
        assert_eq!(shown(&tree), "d(u(i(0 1 )2 )3 )");
        let tree = leaf() - ((leaf() & leaf()) | leaf());
        assert_eq!(shown(&tree), "d(0 u(i(1 2 )3 ))");
    }

    #[test]
    fn a_million_operations_within_one_another_need_no_stack() {
        // all of them complements, as trees are appended to what is before them
        let tree = (0..1_000_000).fold(leaf(), |tree, _| !tree);
        let pieces = pieces(&tree);
        assert_eq!(pieces.len(), 2_000_001);
        assert_eq!((pieces[999_999], pieces[1_000_000]), (Piece::Open(Operation::Complement), Piece::Leaf(0)));
    }
}
