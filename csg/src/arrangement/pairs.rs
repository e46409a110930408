//! Which triangles may touch: a walk down two hierarchies of boxes at once.
//!
//! Slivers make boxes alone useless, so planes of triangles are tested against boxes, too, and the larger box is opened first.

use std::cell::OnceCell;
use std::ops::Range;

use glam::DVec3;
use planecut_parallel::prelude::*;

use super::Cutting;
use super::contact::{Contacts, touch};
use super::flat_faces::FlatFaces;
use super::input::Input;
use super::predicates::{EdgePlane, RoundedPlane, Triangle};
use super::self_walk::SelfTree;
use super::triangle_tree::{LEAF, TreeNode, TriangleTree, bounds_of};
use crate::base::{Bounds, Boxes, map_chunks};
use crate::ids::{InputTriangleId, number32};

/// Operands of at most this many triangles are compared with themselves on one thread each.
const ALONE: usize = 1 << 12;

/// The walk is split into at least this many parts, where there is enough to do.
const PARTS: usize = 512;

/// Levels below which a pair of nodes is not split into parts.
const SMALL: u32 = 4;

/// Two nodes whose triangles are to be compared.
#[derive(Debug, Clone, Copy)]
struct Task {
    operands: [u32; 2],
    nodes: [TreeNode; 2],
}

/// What the triangles of all operands have in common, in parts: of different ones, and of each one that is no convex body; and the flat faces of
/// operands.
pub(super) fn contacts<'a>(input: &'a Input<'a>, cutting: Cutting) -> (Vec<Contacts>, FlatFaces<'a>) {
    let mut all: Vec<Contacts> = Vec::new();
    for operand in (0..input.operands.len()).filter(|k| !input.operands[*k].is_body()) {
        if input.operands[operand].triangles().len() > ALONE {
            all.extend(contacts_within(input, operand));
        }
    }
    // small ones side by side
    let small: Vec<usize> = (0..input.operands.len())
        .filter(|k| !input.operands[*k].is_body() && input.operands[*k].triangles().len() <= ALONE)
        .collect();
    let parts: Vec<Vec<Contacts>> = small.par_iter().map(|operand| contacts_within(input, *operand)).collect();
    all.extend(parts.into_iter().flatten());
    let touching: Vec<[InputTriangleId; 2]> = all.iter().flat_map(|part| &part.pairs).copied().collect();
    let faces = FlatFaces::new(input, &touching, cutting);
    all.extend(contacts_between(input, &faces));
    (all, faces)
}

/// What the triangles of an operand have in common.
fn contacts_within(input: &Input<'_>, operand: usize) -> Vec<Contacts> {
    let own = &input.operands[operand];
    let tree = SelfTree::new(own);
    let work = |tasks: &[Range<usize>]| {
        let mut out = Contacts::default();
        for task in tasks {
            tree.walk(task.clone(), &mut |one, other| {
                let [one, other] = [one, other].map(|triangle| Probe::new(input, operand, triangle));
                if one.bounds.touches(&other.bounds) {
                    touch(input, [&one, &other], None, &mut out);
                }
            });
        }
        out
    };
    map_chunks(&tree.tasks(), 1, work).0
}

/// What triangles of different operands have in common.
fn contacts_between(input: &Input<'_>, faces: &FlatFaces<'_>) -> Vec<Contacts> {
    let trees: Vec<&TriangleTree> = input.operands.iter().map(|operand| operand.tree()).collect();
    let boxes = Boxes::new(trees.iter().map(|tree| tree.all_bounds()).collect());
    let (mut tasks, mut near) = (Vec::new(), Vec::new());
    for (k, tree) in (0..).zip(&trees) {
        let Some(root) = tree.root() else { continue };
        boxes.touching(&tree.all_bounds(), &mut near);
        let later = near.iter().copied().filter(|other| *other > k);
        let root_of = |other: u32| trees[other as usize].root().map(|other_root| (other, other_root));
        tasks.extend(
            later
                .filter_map(root_of)
                .map(|(other, other_root)| Task { operands: [k, other], nodes: [root, other_root] }),
        );
    }
    // a function of the trees alone, so that the order of contacts does not depend on the number of threads
    while tasks.len() < PARTS {
        let before = tasks.len();
        tasks = tasks.iter().flat_map(|task| split(&trees, task)).collect();
        if tasks.len() == before {
            break;
        }
    }
    let work = |tasks: &[Task]| {
        let mut out = Contacts::default();
        for task in tasks {
            let [one, other] = task.operands.map(|k| trees[k as usize]);
            let operands = task.operands.map(|k| k as usize);
            let mut walk = Walk { input, faces, operands, one, other, out: &mut out };
            walk.between(task.nodes[0], task.nodes[1]);
        }
        out
    };
    map_chunks(&tasks, 1, work).0
}

/// Parts of a task; the task itself where it is small.
fn split(trees: &[&TriangleTree], task: &Task) -> Vec<Task> {
    let [one, other] = task.operands.map(|k| trees[k as usize]);
    let [a, b] = task.nodes;
    let of = |a: TreeNode, b: TreeNode| Task { nodes: [a, b], ..*task };
    if a.level.max(b.level) < SMALL {
        return vec![*task];
    }
    if !one.bounds(a).touches(other.bounds(b)) {
        return Vec::new();
    }
    if a.level >= b.level {
        let (first, second) = one.children(a);
        std::iter::once(first).chain(second).map(|a| of(a, b)).collect()
    } else {
        let (first, second) = other.children(b);
        std::iter::once(first).chain(second).map(|b| of(a, b)).collect()
    }
}

/// A triangle with what is asked about it over and over.
#[derive(Debug)]
pub(super) struct Probe {
    pub(super) triangle: Triangle,
    pub(super) plane: RoundedPlane,
    /// Planes through its edges, once they are asked for.
    edges: OnceCell<[EdgePlane; 3]>,
    bounds: Bounds,
    operand: usize,
    /// Its number in its operand, and the twins of its sides there.
    own: u32,
    twins: [u32; 3],
}

impl Probe {
    fn new(input: &Input<'_>, operand: usize, own: u32) -> Self {
        let triangle = input.triangle(operand, own);
        let plane = RoundedPlane::new(input, &triangle);
        let first = 3 * own as usize;
        let twins = &input.operands[operand].twins()[first..first + 3];
        let twins = [twins[0], twins[1], twins[2]];
        Self {
            triangle,
            plane,
            edges: OnceCell::new(),
            bounds: input.operands[operand].bounds(own),
            operand,
            own,
            twins,
        }
    }

    #[inline]
    fn edges(&self, input: &Input<'_>) -> &[EdgePlane; 3] {
        self.edges.get_or_init(|| self.plane.edge_planes(input))
    }

    /// Whether a box is sure to be apart from it: misses its plane, or lies beyond one of its edges.
    fn misses(&self, input: &Input<'_>, bounds: &Bounds) -> bool {
        // far from the origin the middle is rounded by more than it is off the plane: the half is taken from where it is
        let middle = 0.5 * bounds.min + 0.5 * bounds.max;
        let half = (bounds.max - middle).max(middle - bounds.min);
        input.is_safe
            && (self.plane.misses(middle, half) || self.edges(input).iter().any(|edge| edge.misses(middle, half)))
    }

    /// Whether another triangle is sure to be apart from it: on one side of its plane, or beyond one of its edges.
    #[inline]
    fn has_beyond(&self, input: &Input<'_>, places: &[DVec3; 3]) -> bool {
        let size = || places[0].abs().max(places[1].abs()).max(places[2].abs());
        // corners of bodies are not where they are said to be
        input.is_safe
            && (self.plane.has_on_one_side(input, places)
                || !input.has_bodies && self.edges(input).iter().any(|edge| edge.has_beyond(places, size())))
    }

    /// Whether it has one coordinate alone along an axis, and another triangle the same.
    pub(super) fn is_in_plane_of_axes(&self, input: &Input<'_>, other: &Self) -> bool {
        let is_flat = |axis: usize| {
            let height = self.bounds.min[axis];
            [self.bounds.max, other.bounds.min, other.bounds.max].iter().all(|end| end[axis] == height)
        };
        !input.has_bodies && (is_flat(0) || is_flat(1) || is_flat(2))
    }

    /// Whether an edge of the flat face of one of two triangles of one plane may touch the other triangle.
    pub(super) fn has_edges_near(&self, input: &Input<'_>, other: &Self, faces: &FlatFaces<'_>) -> bool {
        let is_near = |own: &Self, other: &Self| {
            let places = own.triangle.places();
            (0..3).any(|side| {
                let ends @ [a, b] = [places[side], places[(side + 1) % 3]];
                bounds_of([a, b, b]).touches(&other.bounds)
                    && !faces.is_diagonal(own.operand, 3 * own.own + number32(side))
                    && !other.plane.tells_edge_apart(input, ends)
            })
        };
        input.has_bodies || is_near(self, other) || is_near(other, self)
    }

    /// Whether another triangle is the one on the other side of an edge.
    pub(super) fn is_neighbour(&self, side: usize, other: &Self) -> bool {
        self.operand == other.operand && self.twins[side] / 3 == other.own
    }
}

struct Walk<'a> {
    input: &'a Input<'a>,
    faces: &'a FlatFaces<'a>,
    operands: [usize; 2],
    one: &'a TriangleTree,
    other: &'a TriangleTree,
    out: &'a mut Contacts,
}

impl Walk<'_> {
    fn probe(&self, k: usize, triangle: u32) -> Probe {
        Probe::new(self.input, self.operands[k], triangle)
    }

    fn places(&self, k: usize, triangle: u32) -> [DVec3; 3] {
        let own = &self.input.operands[self.operands[k]];
        let [a, b, c] = own.triangles()[triangle as usize];
        let positions = own.positions();
        [positions[a as usize], positions[b as usize], positions[c as usize]]
    }

    fn bounds(&self, k: usize, triangle: u32) -> Bounds {
        self.input.operands[self.operands[k]].bounds(triangle)
    }

    /// Compares the triangles of a node with those of a node of the other tree.
    fn between(&mut self, a: TreeNode, b: TreeNode) {
        let (of_a, of_b) = (*self.one.bounds(a), *self.other.bounds(b));
        if !of_a.touches(&of_b) {
            return;
        }
        let opens_first = b.level == 0 || (of_a.max - of_a.min).element_sum() >= (of_b.max - of_b.min).element_sum();
        match (a.level, b.level) {
            (0, 0) => self.leaves(a, b),
            (0, _) if opens_first => self.for_triangles(a, b, true),
            (_, 0) if !opens_first => self.for_triangles(b, a, false),
            (0, _) => self.open(a, b, false),
            (_, 0) => self.open(a, b, true),
            _ => self.open(a, b, opens_first),
        }
    }

    /// Compares the triangles of two leaves.
    fn leaves(&mut self, a: TreeNode, b: TreeNode) {
        let (of_a, of_b) = (*self.one.bounds(a), *self.other.bounds(b));
        let near = |walk: &Self, k: usize, triangles: &[u32], other: &Bounds| {
            let mut near = [(0, Bounds::EMPTY); LEAF];
            let mut count = 0;
            for triangle in triangles {
                let bounds = walk.bounds(k, *triangle);
                if bounds.touches(other) {
                    near[count] = (*triangle, bounds);
                    count += 1;
                }
            }
            (near, count)
        };
        let (ones, count) = near(self, 0, self.one.triangles(a), &of_b);
        if count == 0 {
            return;
        }
        let (others, other_count) = near(self, 1, self.other.triangles(b), &of_a);
        let mut probes: [Option<Probe>; LEAF] = [const { None }; LEAF];
        for (one, bounds) in &ones[..count] {
            let mut probe = None;
            for (k, (other, other_bounds)) in others[..other_count].iter().enumerate() {
                if bounds.touches(other_bounds) {
                    let probe = probe.get_or_insert_with(|| self.probe(0, *one));
                    if !probe.has_beyond(self.input, &self.places(1, *other)) {
                        let other = probes[k].get_or_insert_with(|| self.probe(1, *other));
                        self.compare(probe, other);
                    }
                }
            }
        }
    }

    fn open(&mut self, a: TreeNode, b: TreeNode, first: bool) {
        let (one, other) = if first { self.one.children(a) } else { self.other.children(b) };
        for child in std::iter::once(one).chain(other) {
            if first { self.between(child, b) } else { self.between(a, child) }
        }
    }

    /// Compares each triangle of a leaf with those below a node of the other tree.
    fn for_triangles(&mut self, leaf: TreeNode, node: TreeNode, is_first: bool) {
        let (tree, other) = if is_first { (self.one, self.other) } else { (self.other, self.one) };
        let k = usize::from(!is_first);
        for &triangle in tree.triangles(leaf) {
            if self.bounds(k, triangle).touches(other.bounds(node)) {
                let probe = self.probe(k, triangle);
                self.below(&probe, node, is_first);
            }
        }
    }

    /// Compares a triangle with those below a node of the other tree.
    fn below(&mut self, probe: &Probe, node: TreeNode, is_first: bool) {
        let tree = if is_first { self.other } else { self.one };
        let bounds = tree.bounds(node);
        if !bounds.touches(&probe.bounds) || probe.misses(self.input, bounds) {
            return;
        }
        if node.level > 0 {
            let (first, second) = tree.children(node);
            self.below(probe, first, is_first);
            if let Some(second) = second {
                self.below(probe, second, is_first);
            }
            return;
        }
        let k = usize::from(is_first);
        for &triangle in tree.triangles(node) {
            if self.bounds(k, triangle).touches(&probe.bounds)
                && !probe.has_beyond(self.input, &self.places(k, triangle))
            {
                let other = self.probe(k, triangle);
                if is_first { self.compare(probe, &other) } else { self.compare(&other, probe) }
            }
        }
    }

    /// Compares two triangles, the second of which is not sure to be apart from the first.
    fn compare(&mut self, one: &Probe, other: &Probe) {
        // the same triangle has the same box
        if one.bounds != other.bounds
            && one.is_in_plane_of_axes(self.input, other)
            && !one.has_edges_near(self.input, other, self.faces)
        {
            return;
        }
        if !other.has_beyond(self.input, &one.triangle.places()) {
            touch(self.input, [one, other], Some(self.faces), self.out);
        }
    }
}
