//! A tree made ready for cells: complements are pushed down to the leaves, operations of one kind joined, and for each point
//! of the solid one *owner* is fixed, a leaf from whose body its cell is carved.
//!
//! The owner of a point of a union is that of the first operand that holds it, of an intersection that of the operand whose
//! cells are the fewest, of an exclusive or that of the first operand that holds it. So cells of different owners do not
//! overlap, and a leaf is cut only by what reaches it.

use std::cmp::Ordering;

use planecut_csg::{Operation, Tree, TreeNode};

use super::formula::{Formula, Kind};
use super::order::Rule;

const NONE: u32 = u32::MAX;

/// What a node does with its children.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Join {
    Leaf { body: u32, negated: bool },
    All,
    Any,
    Odd,
}

#[derive(Debug, Clone)]
struct Node {
    join: Join,
    parent: u32,
    children: Vec<u32>,
    /// The place among the parent's children in the order of owners.
    place: u32,
    /// The value far from all bounded leaves.
    default: bool,
    /// The children, by place, whose default is not the one that lets the others decide.
    exceptions: Vec<u32>,
    /// How much space it takes, about.
    size: f64,
    /// How many owners there are below, about.
    owners: f64,
}

/// Whence the cells of an owner are carved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Start {
    /// A body.
    Body(u32),
    /// All of space.
    Everything,
}

/// An owner: where its cells begin, and its node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Owner {
    pub(super) start: Start,
    node: u32,
}

/// The tree.
pub(super) struct NormalForm {
    nodes: Vec<Node>,
    /// The leaf of each body.
    node_of: Vec<u32>,
}

/// Buffers for [`NormalForm::formula`].
#[derive(Default)]
pub(super) struct Scratch {
    /// For each node the mark of the call that used it last.
    mark: Vec<u32>,
    on_path: Vec<u32>,
    call: u32,
    /// Formulas of the children of marked nodes: place, formula.
    pending: Vec<Vec<(u32, Formula)>>,
    heap: std::collections::BinaryHeap<u32>,
}

impl NormalForm {
    /// Of each leaf the number of its body, `None` where that is empty; and the sizes of the bodies.
    pub(super) fn new(tree: &Tree, bodies: &[Option<u32>], sizes: &[f64], rule: Rule) -> Self {
        let mut form = Self { nodes: Vec::new(), node_of: vec![NONE; sizes.len()] };
        form.read(tree, bodies);
        form.measure(sizes, rule);
        form
    }

    /// Reads the postfix order backwards: each operation before its operands, the last operand first.
    fn read(&mut self, tree: &Tree, bodies: &[Option<u32>]) {
        let mut waiting = vec![(NONE, false)];
        let mut bodies = bodies.iter().rev();
        for entry in tree.nodes().iter().rev() {
            let Some((parent, negated)) = waiting.pop() else { return };
            match *entry {
                TreeNode::Leaf => match bodies.next().copied().flatten() {
                    Some(body) => self.node_of[body as usize] = self.push(Join::Leaf { body, negated }, parent),
                    None => _ = self.push(if negated { Join::All } else { Join::Any }, parent),
                },
                TreeNode::Operation { operation, operands } => {
                    let (join, first, others) = meaning(operation, operands, negated);
                    let node = self.join_or_push(join, parent);
                    waiting.extend((0..operands).map(|k| (node, if k == 0 { first } else { others })));
                }
            }
        }
    }

    fn push(&mut self, join: Join, parent: u32) -> u32 {
        let number = self.nodes.len() as u32;
        self.nodes.push(Node {
            join,
            parent,
            children: Vec::new(),
            place: 0,
            default: false,
            exceptions: Vec::new(),
            size: 0.0,
            owners: 0.0,
        });
        if let Some(above) = self.nodes.get_mut(parent as usize) {
            above.children.push(number);
        }
        number
    }

    fn join_or_push(&mut self, join: Join, parent: u32) -> u32 {
        match self.nodes.get(parent as usize) {
            Some(above) if above.join == join => parent,
            _ => self.push(join, parent),
        }
    }

    /// Fills in defaults, sizes and the order of children, from the leaves up.
    fn measure(&mut self, sizes: &[f64], rule: Rule) {
        for number in (0..self.nodes.len()).rev() {
            let mut children = std::mem::take(&mut self.nodes[number].children);
            let nodes = &self.nodes;
            let at = |child: &u32| &nodes[*child as usize];
            // What holds far away comes first: it leaves bounded parts to the others. Then what is large, which is cut by
            // nothing and mostly cuts the others in few planes.
            children.sort_by(|a, b| {
                let (p, q) = (at(a), at(b));
                let by_size = if rule.chooses { q.size.total_cmp(&p.size) } else { Ordering::Equal };
                q.default.cmp(&p.default).then(by_size).then(b.cmp(a))
            });
            let sizes_below = children.iter().map(|child| at(child).size);
            let owners_below = children.iter().map(|child| at(child).owners);
            let true_below = children.iter().filter(|child| at(child).default).count();
            let (default, size, owners) = match self.nodes[number].join {
                Join::Leaf { body, negated: false } => (false, sizes[body as usize], 1.0),
                Join::Leaf { .. } => (true, f64::INFINITY, 1.0),
                Join::All => (
                    true_below == children.len(),
                    sizes_below.fold(f64::INFINITY, f64::min),
                    owners_below.fold(f64::INFINITY, f64::min),
                ),
                Join::Any => (true_below > 0, sizes_below.sum(), owners_below.sum()),
                Join::Odd => (true_below % 2 == 1, sizes_below.sum(), owners_below.sum()),
            };
            let usual = self.nodes[number].join == Join::All;
            let exceptions = children.iter().copied().filter(|child| at(child).default != usual).collect();
            for (place, child) in (0..).zip(&children) {
                self.nodes[*child as usize].place = place;
            }
            let node = &mut self.nodes[number];
            (node.children, node.exceptions, node.default, node.size, node.owners) =
                (children, exceptions, default, size, owners);
        }
    }

    /// The bodies, where the tree is their union and nothing else.
    pub(super) fn bodies_of_union(&self) -> Option<Vec<u32>> {
        let positive = |node: &u32| match self.nodes[*node as usize].join {
            Join::Leaf { body, negated: false } => Some(body),
            _ => None,
        };
        match self.nodes.first()?.join {
            Join::Any => self.nodes[0].children.iter().map(positive).collect(),
            _ => Some(vec![positive(&0)?]),
        }
    }

    /// The owners.
    pub(super) fn owners(&self) -> Vec<Owner> {
        let mut owners = Vec::new();
        let mut waiting = if self.nodes.is_empty() { Vec::new() } else { vec![0] };
        while let Some(number) = waiting.pop() {
            let node = &self.nodes[number as usize];
            match node.join {
                Join::Leaf { body, negated: false } => owners.push(Owner { start: Start::Body(body), node: number }),
                Join::Any | Join::Odd => waiting.extend(node.children.iter().rev()),
                Join::All if !node.exceptions.is_empty() => waiting.push(self.owner_of_all(node)),
                Join::All | Join::Leaf { .. } => owners.push(Owner { start: Start::Everything, node: number }),
            }
        }
        owners
    }

    /// Of the bounded operands of an intersection the one whose cells are carved: one that is composed, since plain bodies
    /// cut cells without making pieces; of these the simplest, of plain bodies the smallest.
    fn owner_of_all(&self, node: &Node) -> u32 {
        let key = |child: &&u32| {
            let node = &self.nodes[**child as usize];
            (node.children.is_empty(), node.owners, node.size)
        };
        let best = node.exceptions.iter().min_by(|a, b| {
            let ((p, q, r), (s, t, u)) = (key(a), key(b));
            p.cmp(&s).then(q.total_cmp(&t)).then(r.total_cmp(&u))
        });
        best.copied().unwrap_or(NONE)
    }

    /// What must hold beside the start of an owner, where of all bounded bodies only those in `near` count.
    pub(super) fn formula(&self, owner: &Owner, near: &[u32], scratch: &mut Scratch) -> Formula {
        scratch.begin(self.nodes.len());
        let call = scratch.call;
        let mut at = owner.node;
        while at != NONE {
            scratch.on_path[at as usize] = call;
            at = self.nodes[at as usize].parent;
        }
        if owner.start == Start::Everything {
            // its own formula counts, too: only what is above is the way
            scratch.on_path[owner.node as usize] = 0;
        }
        self.mark(near, scratch);
        self.fold_beside_path(scratch);
        self.fold_path(owner, scratch)
    }

    /// Puts the bodies that are near into their parents.
    fn mark(&self, near: &[u32], scratch: &mut Scratch) {
        for body in near {
            let node = self.node_of[*body as usize];
            if node == NONE || scratch.on_path[node as usize] == scratch.call {
                continue;
            }
            let Join::Leaf { body, negated } = self.nodes[node as usize].join else { continue };
            scratch.mark[node as usize] = scratch.call;
            self.hand_up(node, Formula::body(body, negated), scratch);
        }
    }

    /// Gives the parent of a node its formula; the parent will be folded unless it is on the way to the root.
    fn hand_up(&self, node: u32, formula: Formula, scratch: &mut Scratch) {
        let parent = self.nodes[node as usize].parent;
        let place = self.nodes[node as usize].place;
        if parent == NONE {
            scratch.pending[node as usize] = vec![(0, formula)];
            return;
        }
        let is_new = scratch.mark[parent as usize] != scratch.call;
        if is_new {
            scratch.mark[parent as usize] = scratch.call;
            scratch.pending[parent as usize].clear();
            if scratch.on_path[parent as usize] != scratch.call {
                scratch.heap.push(parent);
            }
        }
        scratch.pending[parent as usize].push((place, formula));
    }

    /// Folds marked nodes from below; children have larger numbers than their parents.
    fn fold_beside_path(&self, scratch: &mut Scratch) {
        while let Some(number) = scratch.heap.pop() {
            let node = &self.nodes[number as usize];
            let operands = std::mem::take(&mut scratch.pending[number as usize]);
            let formula = self.fold(node, operands, scratch);
            self.hand_up(number, formula, scratch);
        }
    }

    /// The formula of a node whose marked children have these formulas, the others being at their defaults.
    fn fold(&self, node: &Node, operands: Vec<(u32, Formula)>, scratch: &Scratch) -> Formula {
        let rest = node.exceptions.iter().filter(|child| scratch.mark[**child as usize] != scratch.call).count();
        let operands = operands.into_iter().map(|(_, formula)| formula);
        match node.join {
            Join::Leaf { body, negated } => Formula::body(body, negated),
            Join::All if rest > 0 => Formula::constant(false),
            Join::Any if rest > 0 => Formula::constant(true),
            Join::All => Formula::combine(Kind::And, operands),
            Join::Any => Formula::combine(Kind::Or, operands),
            Join::Odd => Formula::combine(Kind::Parity { odd: rest % 2 == 0 }, operands),
        }
    }

    /// What must hold on the way from an owner to the root.
    fn fold_path(&self, owner: &Owner, scratch: &mut Scratch) -> Formula {
        let mut conditions = Vec::new();
        let mut at = owner.node;
        if owner.start == Start::Everything {
            conditions.push(self.own_formula(at, scratch));
        }
        while let Some(node) = self.nodes.get(self.nodes[at as usize].parent as usize) {
            let parent = self.nodes[at as usize].parent as usize;
            let place = self.nodes[at as usize].place;
            let is_marked = scratch.mark[parent] == scratch.call;
            let mut operands = if is_marked { std::mem::take(&mut scratch.pending[parent]) } else { Vec::new() };
            // an owner that starts everywhere has handed its own formula up
            operands.retain(|(other, _)| *other != place);
            let condition = self.condition(node, place, at, operands, scratch);
            if condition.value() == Some(false) {
                return condition;
            }
            conditions.push(condition);
            at = parent as u32;
        }
        Formula::combine(Kind::And, conditions)
    }

    /// The formula of a node off the way that was folded, or its default.
    fn own_formula(&self, number: u32, scratch: &Scratch) -> Formula {
        let node = &self.nodes[number as usize];
        if scratch.mark[number as usize] != scratch.call {
            return Formula::constant(node.default);
        }
        let above = if node.parent == NONE { number } else { node.parent };
        let found = scratch.pending[above as usize].iter().find(|(place, _)| *place == node.place);
        found.map_or_else(|| Formula::constant(node.default), |(_, formula)| formula.clone())
    }

    /// What the siblings of a node on the way must be.
    fn condition(
        &self,
        node: &Node,
        place: u32,
        child: u32,
        operands: Vec<(u32, Formula)>,
        scratch: &Scratch,
    ) -> Formula {
        let is_unmarked = |k: &&u32| **k != child && scratch.mark[**k as usize] != scratch.call;
        let place_of = |k: &u32| self.nodes[*k as usize].place;
        match node.join {
            Join::Leaf { .. } => Formula::constant(true),
            Join::All => {
                if node.exceptions.iter().any(|k| is_unmarked(&k)) {
                    return Formula::constant(false);
                }
                Formula::combine(Kind::And, operands.into_iter().map(|(_, formula)| formula))
            }
            Join::Any | Join::Odd => {
                let mut before = node.exceptions.iter().take_while(|k| place_of(k) < place);
                if before.any(|k| is_unmarked(&k)) {
                    return Formula::constant(false);
                }
                let (before, behind): (Vec<_>, Vec<_>) = operands.into_iter().partition(|(other, _)| *other < place);
                let before = Formula::combine(Kind::And, before.into_iter().map(|(_, formula)| formula.negated()));
                if node.join == Join::Any {
                    return before;
                }
                let others = node.exceptions.iter().filter(|k| place_of(k) > place && is_unmarked(k)).count();
                let behind = behind.into_iter().map(|(_, formula)| formula);
                let even = Formula::combine(Kind::Parity { odd: others % 2 == 1 }, behind);
                Formula::combine(Kind::And, [before, even])
            }
        }
    }
}

/// What an operation does, and whether its first and its other operands are negated.
fn meaning(operation: Operation, operands: u32, negated: bool) -> (Join, bool, bool) {
    let (join, first, others) = match operation {
        Operation::Union => (Join::Any, false, false),
        Operation::Intersection => (Join::All, false, false),
        Operation::Difference if operands == 0 => (Join::Any, false, true),
        Operation::Difference => (Join::All, false, true),
        Operation::Complement => (Join::All, true, true),
        // one operand more or less turns the parity over; without operands nothing is odd
        Operation::Xor if operands == 0 => (Join::Any, false, false),
        Operation::Xor => return (Join::Odd, negated, false),
    };
    match (join, negated) {
        (_, false) => (join, first, others),
        (Join::All, true) => (Join::Any, !first, !others),
        (_, true) => (Join::All, !first, !others),
    }
}

impl Scratch {
    fn begin(&mut self, nodes: usize) {
        self.mark.resize(nodes, 0);
        self.on_path.resize(nodes, 0);
        self.pending.resize(nodes, Vec::new());
        self.heap.clear();
        self.call += 1;
    }
}
