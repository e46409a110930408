//! Which triangles may touch: a walk down two hierarchies of boxes at once.
//!
//! Slivers make boxes alone useless, so planes of triangles are tested against boxes, too, and the larger box is opened first.

use planecut_kernel::sign::Counts;

use super::contact::{Contacts, touch};
use super::predicates::RoundedPlane;
use super::surface::Surface;
use super::triangle_tree::{TreeNode, TriangleTree, bounds_of};
use crate::base::{Bounds, Boxes, map_chunks};
use crate::ids::{Id, TriangleId};

/// The walk is split into at least this many parts, where there is enough to do.
const PARTS: usize = 512;

/// Levels below which a pair of nodes is not split into parts.
const SMALL: u32 = 4;

/// Two nodes whose triangles are to be compared.
#[derive(Debug, Clone, Copy)]
struct Task {
    trees: [u32; 2],
    nodes: [TreeNode; 2],
}

/// What the triangles of some trees have in common: of different trees, and of each one that is not known to have nothing.
pub(super) fn contacts(surface: &Surface, trees: &[&TriangleTree], is_clean: &[bool]) -> Contacts {
    let boxes = Boxes::new(trees.iter().map(|tree| tree.all_bounds()).collect());
    let (mut tasks, mut near) = (Vec::new(), Vec::new());
    for (k, tree) in (0..).zip(trees) {
        let Some(root) = tree.root() else { continue };
        if !is_clean[k as usize] {
            tasks.push(Task { trees: [k, k], nodes: [root, root] });
        }
        boxes.touching(&tree.all_bounds(), &mut near);
        let later = near.iter().copied().filter(|other| *other > k);
        let root_of = |other: u32| trees[other as usize].root().map(|other_root| (other, other_root));
        tasks.extend(
            later.filter_map(root_of).map(|(other, other_root)| Task { trees: [k, other], nodes: [root, other_root] }),
        );
    }
    // a function of the trees alone, so that the order of contacts does not depend on the number of threads
    while tasks.len() < PARTS {
        let before = tasks.len();
        tasks = tasks.iter().flat_map(|task| split(trees, task)).collect();
        if tasks.len() == before {
            break;
        }
    }
    let work = |tasks: &[Task]| {
        let mut out = Contacts::default();
        for task in tasks {
            let [one, other] = task.trees.map(|k| trees[k as usize]);
            let mut walk = Walk { surface, one, other, out: &mut out };
            if task.trees[0] == task.trees[1] && task.nodes[0] == task.nodes[1] {
                walk.within(task.nodes[0]);
            } else {
                walk.between(task.nodes[0], task.nodes[1]);
            }
        }
        out
    };
    let (parts, _): (Vec<Contacts>, Counts) = map_chunks(&tasks, 1, work);
    let mut all = Contacts::default();
    for mut part in parts {
        all.append(&mut part);
    }
    all
}

/// Parts of a task; the task itself where it is small.
fn split(trees: &[&TriangleTree], task: &Task) -> Vec<Task> {
    let [one, other] = task.trees.map(|k| trees[k as usize]);
    let [a, b] = task.nodes;
    let of = |a: TreeNode, b: TreeNode| Task { nodes: [a, b], ..*task };
    if a.level.max(b.level) < SMALL {
        return vec![*task];
    }
    if task.trees[0] == task.trees[1] && a == b {
        let (first, second) = one.children(a);
        return match second {
            None => vec![of(first, first)],
            Some(second) => vec![of(first, first), of(second, second), of(first, second)],
        };
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

struct Walk<'a> {
    surface: &'a Surface,
    one: &'a TriangleTree,
    other: &'a TriangleTree,
    out: &'a mut Contacts,
}

/// A triangle with what is asked about it over and over.
struct Probe {
    triangle: TriangleId,
    bounds: Bounds,
    plane: RoundedPlane,
}

impl Walk<'_> {
    fn probe(&self, triangle: u32) -> Probe {
        let triangle = TriangleId::from_index(triangle as usize);
        let bounds = bounds_of(self.surface.places(triangle));
        Probe { triangle, bounds, plane: RoundedPlane::new(self.surface, triangle) }
    }

    /// Compares the triangles of a node with one another.
    fn within(&mut self, node: TreeNode) {
        if node.level > 0 {
            let (first, second) = self.one.children(node);
            self.within(first);
            if let Some(second) = second {
                self.within(second);
                self.between(first, second);
            }
            return;
        }
        let triangles = self.one.triangles(node);
        let probes: Vec<Probe> = triangles.iter().map(|triangle| self.probe(*triangle)).collect();
        for (k, probe) in probes.iter().enumerate() {
            for other in &probes[k + 1..] {
                self.compare(probe, other);
            }
        }
    }

    /// Compares the triangles of a node with those of a node that has none of them.
    fn between(&mut self, a: TreeNode, b: TreeNode) {
        let (of_a, of_b) = (*self.one.bounds(a), *self.other.bounds(b));
        if !of_a.touches(&of_b) {
            return;
        }
        let opens_first = b.level == 0 || (of_a.max - of_a.min).element_sum() >= (of_b.max - of_b.min).element_sum();
        match (a.level, b.level) {
            (0, 0) => {
                for &triangle in self.one.triangles(a) {
                    if bounds_of(self.places(triangle)).touches(&of_b) {
                        let probe = self.probe(triangle);
                        self.below(&probe, b, true);
                    }
                }
            }
            (0, _) if opens_first => self.for_triangles(a, b, true),
            (_, 0) if !opens_first => self.for_triangles(b, a, false),
            (0, _) => self.open(a, b, false),
            (_, 0) => self.open(a, b, true),
            _ => self.open(a, b, opens_first),
        }
    }

    fn places(&self, triangle: u32) -> [glam::DVec3; 3] {
        self.surface.places(TriangleId::from_index(triangle as usize))
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
        for &triangle in tree.triangles(leaf) {
            if bounds_of(self.places(triangle)).touches(other.bounds(node)) {
                let probe = self.probe(triangle);
                self.below(&probe, node, is_first);
            }
        }
    }

    /// Compares a triangle with those below a node of the other tree.
    fn below(&mut self, probe: &Probe, node: TreeNode, is_first: bool) {
        let tree = if is_first { self.other } else { self.one };
        let bounds = tree.bounds(node);
        if !bounds.touches(&probe.bounds) || self.misses(probe, bounds) {
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
        for &triangle in tree.triangles(node) {
            let bounds = bounds_of(self.places(triangle));
            if bounds.touches(&probe.bounds) {
                let other = self.probe(triangle);
                if is_first { self.compare(probe, &other) } else { self.compare(&other, probe) }
            }
        }
    }

    fn misses(&self, probe: &Probe, bounds: &Bounds) -> bool {
        // far from the origin the middle is rounded by more than it is off the plane: the half is taken from where it is
        let middle = 0.5 * bounds.min + 0.5 * bounds.max;
        let half = (bounds.max - middle).max(middle - bounds.min);
        self.surface.is_safe && probe.plane.misses(middle, half)
    }

    fn compare(&mut self, one: &Probe, other: &Probe) {
        if one.bounds.touches(&other.bounds) {
            touch(self.surface, [&one.plane, &other.plane], [one.triangle, other.triangle], self.out);
        }
    }
}
