//! Which triangles of one operand may touch each other.
//!
//! Every triangle is near its neighbours, so this is most of the work where meshes are large. Boxes are in single precision, and in a
//! frame in which large flat faces and their edges are likely to be parallel to the axes: those around slivers are thin there. Boxes are
//! grown by far more than rounding, so frame and precision decide nothing.

use glam::{DMat3, DVec3};
use planecut_parallel::prelude::*;
use rustc_hash::FxHashMap;

use super::operand::Operand;
use super::triangle_tree::LEAF;
use crate::ids::number32;

/// Triangles that are looked at to choose the frame.
const SAMPLES: usize = 4096;

/// Directions whose components differ by less than this share of their length are counted as one.
const STEP: f64 = 1.0 / 256.0;

/// Triangles that one thread looks at in a row.
const CHUNK: usize = 1 << 12;

/// Levels below which a pair of nodes is not split into parts.
const SMALL: u32 = 5;

/// What rounding to single precision, and turning before that, may do to coordinates of a mesh whose largest extent is 2.
const SLACK: f32 = 8.0 * f32::EPSILON;

/// What turning and rounding to double precision may do to coordinates in the frame, with room for a few products and sums of them.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// More than the sum of the magnitudes of a place's coordinates in the frame, and of a difference of two: the largest extent is 2 before it is turned.
const FRAME_SIZE: f64 = 16.0;

/// A box in the frame.
#[derive(Debug, Clone, Copy)]
struct SmallBox {
    min: [f32; 3],
    max: [f32; 3],
}

impl SmallBox {
    /// Its middle, and half of its extent with room for rounding of both.
    #[inline]
    fn middle_and_half(&self) -> (DVec3, DVec3) {
        let [min, max] = [self.min, self.max].map(|v| DVec3::from_array(v.map(f64::from)));
        (0.5 * (min + max), 0.5 * (max - min) + f64::from(SLACK))
    }

    #[inline]
    fn touches(&self, other: &Self) -> bool {
        (self.min[0] <= other.max[0])
            & (other.min[0] <= self.max[0])
            & (self.min[1] <= other.max[1])
            & (other.min[1] <= self.max[1])
            & (self.min[2] <= other.max[2])
            & (other.min[2] <= self.max[2])
    }

    fn union(&self, other: &Self) -> Self {
        let pick = |f: fn(f32, f32) -> f32, a: [f32; 3], b: [f32; 3]| [f(a[0], b[0]), f(a[1], b[1]), f(a[2], b[2])];
        Self { min: pick(f32::min, self.min, other.min), max: pick(f32::max, self.max, other.max) }
    }

    fn extent(&self) -> f32 {
        (self.max[0] - self.min[0]) + (self.max[1] - self.min[1]) + (self.max[2] - self.min[2])
    }
}

/// A vertex around which more may be in common.
const OTHER: u32 = u32::MAX;

/// A node: its level, 0 for leaves, and its place there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Node {
    level: u32,
    index: u32,
}

/// Boxes around the triangles of an operand.
pub(super) struct SelfTree<'a> {
    operand: &'a Operand<'a>,
    /// Turns, and makes the largest extent 2.
    frame: DMat3,
    origin: DVec3,
    /// By how much boxes are grown.
    slack: f32,
    order: &'a [u32],
    /// The places of vertices in the frame.
    places: Vec<DVec3>,
    /// In that order, the vertices of triangles around which triangles have nothing in common but edges; [`OTHER`] for others.
    simple: Vec<[u32; 3]>,
    /// The boxes of triangles in that order, and of nodes, leaves first.
    triangles: Vec<SmallBox>,
    levels: Vec<Vec<SmallBox>>,
}

/// The tiles of a leaf, as far as they were asked for.
type Tiles = [Option<Tile>; LEAF];

/// A triangle in the frame.
struct Tile {
    /// The coordinates of its corners along each axis.
    xs: [f64; 3],
    ys: [f64; 3],
    zs: [f64; 3],
    /// The normal of its plane, and those of planes through its edges along that, pointing away from it.
    normals: [DVec3; 4],
    /// The heights of these planes over the origin, along their normals.
    offsets: [f64; 4],
    /// What rounding may do to the height of a place over each.
    doubts: [f64; 4],
}

impl Tile {
    fn new(tree: &SelfTree<'_>, triangle: u32) -> Self {
        let [a, b, c] = tree.corners(triangle);
        let (ab, bc, ca) = (b - a, c - b, a - c);
        let normal = ca.cross(ab);
        let length = |v: DVec3| v.abs().element_sum();
        let doubt = ROUNDING * (length(ab) + length(ca));
        let of_normal = ROUNDING * length(normal);
        let (over_ab, over_bc, over_ca) = (ab.cross(normal), bc.cross(normal), ca.cross(normal));
        let room = |along: DVec3, over: DVec3| {
            FRAME_SIZE * (of_normal + length(along) * doubt + ROUNDING * length(over))
        };
        Self {
            xs: [a.x, b.x, c.x],
            ys: [a.y, b.y, c.y],
            zs: [a.z, b.z, c.z],
            normals: [normal, over_ab, over_bc, over_ca],
            offsets: [normal.dot(a), over_ab.dot(a), over_bc.dot(b), over_ca.dot(c)],
            doubts: [FRAME_SIZE * (doubt + of_normal), room(ab, over_ab), room(bc, over_bc), room(ca, over_ca)],
        }
    }

    /// The least and the largest height of another triangle's corners over one of the planes.
    #[inline]
    fn heights(&self, plane: usize, other: &Self) -> (f64, f64) {
        let (normal, offset) = (self.normals[plane], self.offsets[plane]);
        let height = |k: usize| normal.x * other.xs[k] + normal.y * other.ys[k] + normal.z * other.zs[k] - offset;
        let (a, b, c) = (height(0), height(1), height(2));
        (a.min(b).min(c), a.max(b).max(c))
    }

    /// Whether another triangle is sure to lie beyond its plane or one of its edges.
    #[inline]
    fn has_beyond(&self, other: &Self) -> bool {
        let (lowest, highest) = self.heights(0, other);
        lowest > self.doubts[0]
            || highest < -self.doubts[0]
            || (1..4).any(|k| self.heights(k, other).0 > self.doubts[k])
    }

    /// Whether it is sure to be apart from a box, given by its middle and half of its extent.
    #[inline]
    fn misses(&self, middle: DVec3, half: DVec3) -> bool {
        let height = |k: usize| self.normals[k].dot(middle) - self.offsets[k];
        let reach = |k: usize| self.normals[k].abs().dot(half) + self.doubts[k];
        height(0).abs() > reach(0) || (1..4).any(|k| height(k) > reach(k))
    }
}

impl<'a> SelfTree<'a> {
    pub(super) fn new(operand: &'a Operand<'a>) -> Self {
        let order = operand.tree().order();
        let bounds = operand.tree().all_bounds();
        let origin = if order.is_empty() { DVec3::ZERO } else { 0.5 * bounds.min + 0.5 * bounds.max };
        // by its size, which single precision may not hold
        let scale = (0.5 * bounds.max - 0.5 * bounds.min).max_element().recip();
        let mut tree = Self {
            operand,
            frame: if scale.is_finite() { frame(operand, order) * scale } else { DMat3::IDENTITY },
            origin,
            slack: if scale.is_finite() { SLACK } else { f32::INFINITY },
            order,
            places: Vec::new(),
            simple: Vec::new(),
            triangles: Vec::new(),
            levels: Vec::new(),
        };
        let (frame, origin) = (tree.frame, tree.origin);
        let in_frame = |position: &DVec3| frame * (*position - origin);
        tree.places = operand.positions().par_iter().with_min_len(CHUNK).map(in_frame).collect();
        let own = &tree;
        tree.triangles = order.par_iter().with_min_len(CHUNK).map(|triangle| own.small_box(*triangle)).collect();
        let simple = |vertex: u32| if operand.is_simple(vertex) { vertex } else { OTHER };
        let of_triangle = |triangle: &u32| operand.triangles()[*triangle as usize].map(simple);
        tree.simple = order.par_iter().with_min_len(CHUNK).map(of_triangle).collect();
        let union = |boxes: &[SmallBox]| boxes[1..].iter().fold(boxes[0], |all, one| all.union(one));
        if !order.is_empty() {
            tree.levels.push(tree.triangles.par_chunks(LEAF).with_min_len(CHUNK).map(union).collect());
        }
        while let Some(last) = tree.levels.last().filter(|last| last.len() > 1) {
            let next = last.chunks(2).map(union).collect();
            tree.levels.push(next);
        }
        tree
    }

    fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.operand.triangles()[triangle as usize].map(|vertex| self.places[vertex as usize])
    }

    fn small_box(&self, triangle: u32) -> SmallBox {
        let [a, b, c] = self.corners(triangle);
        let (min, max) = (a.min(b).min(c), a.max(b).max(c));
        SmallBox {
            min: min.to_array().map(|v| narrowed(v) - self.slack),
            max: max.to_array().map(|v| narrowed(v) + self.slack),
        }
    }

    fn bounds(&self, node: Node) -> &SmallBox {
        &self.levels[node.level as usize][node.index as usize]
    }

    fn children(&self, node: Node) -> (Node, Option<Node>) {
        let level = node.level - 1;
        let second = Node { level, index: 2 * node.index + 1 };
        let is_there = (second.index as usize) < self.levels[level as usize].len();
        (Node { level, index: 2 * node.index }, is_there.then_some(second))
    }

    /// The places of the triangles of a leaf in the order.
    fn leaf(&self, leaf: Node) -> std::ops::Range<usize> {
        let start = leaf.index as usize * LEAF;
        start..(start + LEAF).min(self.order.len())
    }

    /// Pairs of nodes that hold all pairs of triangles that may touch, at least `least` where there are as many.
    pub(super) fn tasks(&self, least: usize) -> Vec<[Node; 2]> {
        let Some(top) = self.levels.len().checked_sub(1) else { return Vec::new() };
        let root = Node { level: number32(top), index: 0 };
        let mut tasks = vec![[root, root]];
        while tasks.len() < least {
            let before = tasks.len();
            tasks = tasks.iter().flat_map(|task| self.split(*task)).collect();
            if tasks.len() == before {
                break;
            }
        }
        tasks
    }

    fn split(&self, [a, b]: [Node; 2]) -> Vec<[Node; 2]> {
        if a.level.max(b.level) < SMALL {
            return vec![[a, b]];
        }
        if a == b {
            let (first, second) = self.children(a);
            let other = second.map_or(Vec::new(), |second| vec![[second, second], [first, second]]);
            return std::iter::once([first, first]).chain(other).collect();
        }
        if !self.bounds(a).touches(self.bounds(b)) {
            return Vec::new();
        }
        let is_first = a.level >= b.level;
        let (first, second) = self.children(if is_first { a } else { b });
        let of = |child: Node| if is_first { [child, b] } else { [a, child] };
        std::iter::once(first).chain(second).map(of).collect()
    }

    /// Calls for each pair of triangles of two nodes that may touch.
    pub(super) fn walk(&self, [a, b]: [Node; 2], visit: &mut impl FnMut(u32, u32)) {
        if a != b {
            return self.between(a, b, visit);
        }
        if a.level > 0 {
            let (first, second) = self.children(a);
            self.walk([first, first], visit);
            if let Some(second) = second {
                self.walk([second, second], visit);
                self.between(first, second, visit);
            }
            return;
        }
        let leaf = self.leaf(a);
        for i in leaf.clone() {
            self.compare(i, i + 1..leaf.end, &mut Tiles::default(), visit);
        }
    }

    fn between(&self, a: Node, b: Node, visit: &mut impl FnMut(u32, u32)) {
        let (of_a, of_b) = (self.bounds(a), self.bounds(b));
        if !of_a.touches(of_b) {
            return;
        }
        let is_first_larger = of_a.extent() >= of_b.extent();
        match (a.level, b.level) {
            (0, 0) => {
                let (first, second) = (self.leaf(a), self.leaf(b));
                let mut tiles = Tiles::default();
                for i in first {
                    if self.triangles[i].touches(of_b) {
                        self.compare(i, second.clone(), &mut tiles, visit);
                    }
                }
            }
            // the larger one is a leaf: its triangles one by one
            (0, _) if is_first_larger => self.leaf(a).for_each(|i| self.below(i, b, visit)),
            (_, 0) if !is_first_larger => self.leaf(b).for_each(|i| self.below(i, a, visit)),
            (0, _) => self.open(b, |child| self.between(a, child, visit)),
            (_, 0) => self.open(a, |child| self.between(child, b, visit)),
            _ if is_first_larger => self.open(a, |child| self.between(child, b, visit)),
            _ => self.open(b, |child| self.between(a, child, visit)),
        }
    }

    fn open(&self, node: Node, mut visit: impl FnMut(Node)) {
        let (first, second) = self.children(node);
        visit(first);
        second.into_iter().for_each(visit);
    }

    /// Compares a triangle with those below a node that are near it.
    fn below(&self, i: usize, node: Node, visit: &mut impl FnMut(u32, u32)) {
        if self.triangles[i].touches(self.bounds(node)) {
            let tile = Tile::new(self, self.order[i]);
            self.below_tile(i, &tile, node, visit);
        }
    }

    fn below_tile(&self, i: usize, tile: &Tile, node: Node, visit: &mut impl FnMut(u32, u32)) {
        let bounds = self.bounds(node);
        if !self.triangles[i].touches(bounds) {
            return;
        }
        let (middle, half) = bounds.middle_and_half();
        if tile.misses(middle, half) {
            return;
        }
        if node.level == 0 {
            return self.compare(i, self.leaf(node), &mut Tiles::default(), visit);
        }
        self.open(node, |child| self.below_tile(i, tile, child, visit));
    }

    /// Calls for those of some triangles of one leaf, whose tiles are kept, that may touch another triangle.
    fn compare(&self, i: usize, others: std::ops::Range<usize>, tiles: &mut Tiles, visit: &mut impl FnMut(u32, u32)) {
        let mut tile = None;
        let first = others.start;
        for j in others {
            if !self.triangles[i].touches(&self.triangles[j]) {
                continue;
            }
            let (one, other) = (self.order[i], self.order[j]);
            let (p, q) = (&self.simple[i], &self.simple[j]);
            if p.iter().any(|vertex| *vertex != OTHER && q.contains(vertex)) {
                continue;
            }
            let tile = tile.get_or_insert_with(|| Tile::new(self, one));
            let other_tile = tiles[j - first].get_or_insert_with(|| Tile::new(self, other));
            if !other_tile.has_beyond(tile) && !tile.has_beyond(other_tile) {
                visit(one, other);
            }
        }
    }
}

/// A turn after which the plane in which most of the surface lies is perpendicular to an axis, and most edges in it parallel to one.
fn frame(operand: &Operand<'_>, order: &[u32]) -> DMat3 {
    let places = |triangle: u32| operand.triangles()[triangle as usize].map(|v| operand.positions()[v as usize]);
    let step = order.len().div_ceil(SAMPLES).max(1);
    let sample = || order.iter().step_by(step).map(|triangle| places(*triangle));
    let normals = sample().map(|[a, b, c]| (b - a).cross(c - a));
    let Some(normal) = most_common(normals) else { return DMat3::IDENTITY };
    let is_across =
        |[a, b, c]: &[DVec3; 3]| (*b - *a).cross(*c - *a).normalize_or_zero().dot(normal).abs() > 1.0 - STEP * STEP;
    let edges = sample().filter(is_across).flat_map(|[a, b, c]| [b - a, c - b, a - c]);
    let Some(along) = most_common(edges) else { return DMat3::IDENTITY };
    let along = (along - normal * along.dot(normal)).normalize_or_zero();
    let frame = DMat3::from_cols(along, normal.cross(along), normal).transpose();
    if frame.is_finite() && (frame.determinant().abs() - 1.0).abs() < 1e-6 { frame } else { DMat3::IDENTITY }
}

/// The direction, whichever way, in which the most length lies.
fn most_common(vectors: impl Iterator<Item = DVec3>) -> Option<DVec3> {
    let mut sums: FxHashMap<[i32; 3], (f64, DVec3)> = FxHashMap::default();
    for vector in vectors {
        let Some(unit) = vector.try_normalize() else { continue };
        // of opposite directions the one whose largest component is positive
        let unit = unit * unit[unit.abs().max_position()].signum();
        let entry = sums.entry((unit / STEP).round().as_ivec3().to_array()).or_insert((0.0, DVec3::ZERO));
        entry.0 += vector.length();
        entry.1 += unit * vector.length();
    }
    let largest = sums.into_iter().max_by(|(p, a), (q, b)| a.0.total_cmp(&b.0).then(p.cmp(q)))?;
    largest.1.1.try_normalize()
}

#[expect(clippy::cast_possible_truncation, reason = "boxes are grown by more than that rounds")]
fn narrowed(v: f64) -> f32 {
    v as f32
}
