//! Flips diagonals towards the Delaunay criterion (Lawson 1977): fewer slivers, nicer meshes, the same boundary.

use super::{Node, orient};
use crate::ids::{Id, NodeId, TriangleId};
use crate::tolerances::{DELAUNAY_MARGIN, FLAT_TRIANGLE};
use planecut_kernel::DVec2;
use rustc_hash::FxHashMap;

/// Boundaries of at most this many nodes have a table of all pairs.
const FEW: usize = 48;

/// A directed side of a triangle: where it begins and where it ends.
type Side = (NodeId, NodeId);

/// Improves triangulations, reusing its buffers.
#[derive(Debug, Default)]
pub(super) struct Flips {
    small: PairTable,
    large: FxHashMap<Side, TriangleId>,
    queue: Vec<Side>,
}

/// The triangle at each directed edge.
trait Across {
    fn get(&self, edge: Side) -> Option<TriangleId>;
    fn set(&mut self, edge: Side, triangle: TriangleId);
    fn remove(&mut self, edge: Side);
}

/// One for few nodes: an entry for every pair of them, the triangle plus 1.
#[derive(Debug, Default)]
struct PairTable {
    nodes: usize,
    triangles: Vec<u16>,
}

impl PairTable {
    fn at(&self, (a, b): Side) -> usize {
        a.index() * self.nodes + b.index()
    }
}

impl Across for PairTable {
    fn get(&self, edge: Side) -> Option<TriangleId> {
        let next = usize::from(self.triangles[self.at(edge)]);
        next.checked_sub(1).map(TriangleId::from_index)
    }

    fn set(&mut self, edge: Side, triangle: TriangleId) {
        let at = self.at(edge);
        self.triangles[at] = u16::try_from(triangle.number() + 1).expect("a table of pairs is for few nodes");
    }

    fn remove(&mut self, edge: Side) {
        let at = self.at(edge);
        self.triangles[at] = 0;
    }
}

impl Across for FxHashMap<Side, TriangleId> {
    fn get(&self, edge: Side) -> Option<TriangleId> {
        self.get(&edge).copied()
    }

    fn set(&mut self, edge: Side, triangle: TriangleId) {
        self.insert(edge, triangle);
    }

    fn remove(&mut self, edge: Side) {
        self.remove(&edge);
    }
}

impl Flips {
    /// Improves triangles of nodes, counter-clockwise, in place. Boundary edges and bridges between copies of one node stay.
    pub(super) fn improve(&mut self, nodes: &[Node], triangles: &mut [[NodeId; 3]]) {
        if triangles.len() < 2 {
            return;
        }
        if nodes.len() <= FEW {
            self.small.nodes = nodes.len();
            self.small.triangles.clear();
            self.small.triangles.resize(nodes.len() * nodes.len(), 0);
            improve(nodes, triangles, &mut self.small, &mut self.queue);
        } else {
            self.large.clear();
            improve(nodes, triangles, &mut self.large, &mut self.queue);
        }
    }
}

/// Improves triangles; `across` is empty.
fn improve(nodes: &[Node], triangles: &mut [[NodeId; 3]], across: &mut impl Across, queue: &mut Vec<Side>) {
    queue.clear();
    for (t, triangle) in TriangleId::all(triangles.len()).zip(triangles.iter()) {
        for k in 0..3 {
            let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
            across.set((a, b), t);
            // met for the second time
            if across.get((b, a)).is_some() {
                queue.push((a.min(b), a.max(b)));
            }
        }
    }
    queue.sort_unstable();
    // Lawson's flips end; the cap guards against a cycle that rounding could make.
    let mut budget = 20 * triangles.len();
    while let Some((a, b)) = queue.pop() {
        let (Some(left), Some(right)) = (across.get((a, b)), across.get((b, a))) else { continue };
        let (Some(c), Some(d)) = (apex(&triangles[left.index()], a, b), apex(&triangles[right.index()], b, a)) else {
            continue;
        };
        let at = |node: NodeId| nodes[node.index()].corner.at;
        if budget == 0 || c == d || across.get((c, d)).is_some() || across.get((d, c)).is_some() {
            continue;
        }
        if !should_flip(at(a), at(b), at(c), at(d)) {
            continue;
        }
        budget -= 1;
        triangles[left.index()] = [a, d, c];
        triangles[right.index()] = [d, b, c];
        across.remove((a, b));
        across.remove((b, a));
        for (edge, t) in
            [((a, d), left), ((d, c), left), ((c, a), left), ((d, b), right), ((b, c), right), ((c, d), right)]
        {
            across.set(edge, t);
        }
        for (p, q) in [(a, d), (d, b), (b, c), (c, a)] {
            if across.get((q, p)).is_some() {
                queue.push((p.min(q), p.max(q)));
            }
        }
    }
}

fn apex(triangle: &[NodeId; 3], a: NodeId, b: NodeId) -> Option<NodeId> {
    (0..3).find(|k| triangle[*k] == a && triangle[(k + 1) % 3] == b).map(|k| triangle[(k + 2) % 3])
}

/// Whether the diagonal `a b` of the quadrilateral `a d b c` should become `c d`.
fn should_flip(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> bool {
    let longest =
        a.distance_squared(b).max(c.distance_squared(d)).max(a.distance_squared(c)).max(b.distance_squared(d));
    if orient(a, d, c) <= FLAT_TRIANGLE * longest || orient(d, b, c) <= FLAT_TRIANGLE * longest {
        return false;
    }
    // in-circle of a, b, c at d, by the sum of the opposite angles: flip where it exceeds half a turn
    let (u, v) = (a - c, b - c);
    let (s, t) = (b - d, a - d);
    let (cos_c, sin_c) = (u.dot(v), u.perp_dot(v));
    let (cos_d, sin_d) = (s.dot(t), s.perp_dot(t));
    let value = sin_c * cos_d + cos_c * sin_d;
    value < -DELAUNAY_MARGIN * longest * longest
}
