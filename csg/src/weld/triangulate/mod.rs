//! Triangles of one planar face with holes: no boundary point is dropped, none is added.
//!
//! Holes are joined to the outer loop by bridges ([`bridge`]), then ears are cut ([`ears`]) (Eberly, "Triangulation by Ear
//! Clipping"). The turns asked for are those of the exact points ([`turn`]): rounded, points that are collinear or lie on an
//! edge no longer do, loops cross themselves a little, and an ear that looks fine folds the rest over.

mod bridge;
mod ears;
mod flip;
mod grid;
mod turn;

use planecut_kernel::sign::Sign;
use planecut_kernel::{DVec2, DVec3};

use super::nest::Projection;
use crate::ids::{HalfEdgeId, Id, LineId, NodeId, PointId};
use ears::Ears;
use flip::Flips;
use turn::Turns;
pub(super) use turn::WeldPoints;
pub(crate) use turn::{ExactPoints, rounded_turn};

/// A corner of a loop that is to be added.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LoopCorner {
    /// The exact point.
    pub(crate) point: PointId,
    /// Its place, correctly rounded.
    pub(crate) at: DVec3,
    /// The line on which the edge to the next corner lies.
    pub(crate) line: LineId,
    /// The half-edge to the next corner.
    pub(crate) piece: HalfEdgeId,
}

/// A corner of a loop.
#[derive(Debug, Clone, Copy)]
struct Corner {
    at: DVec2,
    /// The exact point.
    point: PointId,
    /// The line on which the edge to the next corner lies.
    line: LineId,
    /// The half-edge to the next corner.
    piece: HalfEdgeId,
}

/// Triangles of faces: for each corner the half-edge of a loop that begins there, and which sides lie on these half-edges.
#[derive(Debug, Default)]
pub(crate) struct Triangles {
    pub(crate) corners: Vec<[HalfEdgeId; 3]>,
    /// A bit for each side that lies on the half-edge that begins at its first corner; the others are diagonals.
    pub(crate) on_loops: Vec<u8>,
}

/// The bits of the sides of a triangle for which something holds.
pub(crate) fn side_bits(sides: [bool; 3]) -> u8 {
    sides.into_iter().rev().fold(0, |bits, side| bits << 1 | u8::from(side))
}

/// The line of a bridge or a diagonal.
const NO_LINE: LineId = LineId::NONE;

/// A corner in the doubly linked boundary of what is left to triangulate.
#[derive(Debug, Clone, Copy)]
struct Node {
    corner: Corner,
    /// The lines of the two boundary edges that met here.
    lines: [LineId; 2],
    previous: NodeId,
    next: NodeId,
    /// Not strictly convex: only such corners can lie inside an ear.
    reflex: bool,
    removed: bool,
}

/// The boundary of a face: one ring once the holes are joined to it.
struct Boundary<'a> {
    nodes: Vec<Node>,
    turns: Turns<'a>,
    /// Whether it is one loop that turns left at each of its nodes, which follow one another by their numbers.
    is_convex: bool,
}

/// Triangulates faces, reusing its buffers.
pub(crate) struct Triangulator<'a> {
    boundary: Boundary<'a>,
    /// The first node of each loop, the outer one first.
    rings: Vec<NodeId>,
    ears: Ears,
    ahead: Vec<NodeId>,
    flips: Flips,
}

/// The buffers of a [`Triangulator`], kept for the next one.
#[derive(Clone, Default)]
pub(crate) struct TriangulatorBuffers {
    nodes: Vec<Node>,
    rings: Vec<NodeId>,
    ears: Ears,
    ahead: Vec<NodeId>,
    flips: Flips,
}

impl<'a> Triangulator<'a> {
    pub(crate) fn new(points: &'a dyn ExactPoints) -> Self {
        Self::with_buffers(points, TriangulatorBuffers::default())
    }

    /// The same with the buffers of another one.
    pub(crate) fn with_buffers(points: &'a dyn ExactPoints, buffers: TriangulatorBuffers) -> Self {
        let TriangulatorBuffers { nodes, rings, ears, ahead, flips } = buffers;
        let turns = Turns { points, projection: Projection { u: 0, v: 1 } };
        Self { boundary: Boundary { nodes, turns, is_convex: false }, rings, ears, ahead, flips }
    }

    /// The buffers, for the next one.
    pub(crate) fn into_buffers(self) -> TriangulatorBuffers {
        let Self { boundary: Boundary { nodes, .. }, rings, ears, ahead, flips } = self;
        TriangulatorBuffers { nodes, rings, ears, ahead, flips }
    }

    /// Begins a face.
    pub(crate) fn begin(&mut self, projection: Projection) {
        self.boundary.turns.projection = projection;
        self.boundary.nodes.clear();
        self.rings.clear();
    }

    /// Adds a loop, the outer one first, the inside to the left.
    pub(crate) fn add_loop(&mut self, corners: impl ExactSizeIterator<Item = LoopCorner>) {
        let projection = self.boundary.turns.projection;
        let nodes = &mut self.boundary.nodes;
        let (first, count) = (NodeId::from_index(nodes.len()), corners.len());
        self.rings.push(first);
        for (k, LoopCorner { point, at, line, piece }) in corners.enumerate() {
            let at = projection.of(at);
            let before = nodes.last().filter(|_| k > 0).map_or(NO_LINE, |node| node.corner.line);
            nodes.push(Node {
                corner: Corner { at, point, line, piece },
                lines: [before, line],
                previous: first.plus((k + count - 1) % count),
                next: first.plus((k + 1) % count),
                reflex: false,
                removed: false,
            });
        }
        nodes[first.index()].lines[0] = nodes[nodes.len() - 1].corner.line;
    }

    /// Adds the triangles of the face that was begun.
    pub(crate) fn triangulate(&mut self, out: &mut Triangles) {
        let Self { boundary, rings, ears, ahead, flips } = self;
        if let [a, b, c] = boundary.nodes[..] {
            let pieces = [a, b, c].map(|node| node.corner.piece);
            out.corners.push(pieces);
            out.on_loops.push(side_bits([true; 3]));
            return;
        }
        if let [a, b, c, d] = boundary.nodes[..]
            && rings.len() == 1
            && let Some(triangles) = convex_quadrilateral([a, b, c, d].map(|node| node.corner.at))
        {
            let pieces = [a, b, c, d].map(|node| node.corner.piece);
            let is_on_loop = |from: usize, to: usize| to == (from + 1) % 4;
            out.corners.extend(triangles.map(|corners| corners.map(|corner| pieces[corner])));
            let on_loop = |[a, b, c]: [usize; 3]| side_bits([is_on_loop(a, b), is_on_loop(b, c), is_on_loop(c, a)]);
            out.on_loops.extend(triangles.map(on_loop));
            return;
        }
        let start = rings[0];
        boundary.is_convex = rings.len() == 1 && boundary.turns_left_everywhere();
        boundary.join_holes(start, &mut rings[1..]);
        ahead.clear();
        ahead.extend(boundary.boundary_edges());
        let triangles = ears.cut(boundary, start);
        flips.improve(&boundary.nodes, triangles);
        let corner = |node: NodeId| &boundary.nodes[node.index()].corner;
        out.corners.extend(triangles.iter().map(|t| t.map(|node| corner(node).piece)));
        let is_on_loop = |from: NodeId, to: NodeId| ahead[from.index()] == to;
        let on_loop = |&[a, b, c]: &[NodeId; 3]| side_bits([is_on_loop(a, b), is_on_loop(b, c), is_on_loop(c, a)]);
        out.on_loops.extend(triangles.iter().map(on_loop));
    }
}

/// The two triangles of a quadrilateral whose corners, counter-clockwise, all turn left for certain: those that cutting ears and flipping would give.
pub(crate) fn convex_quadrilateral(at: [DVec2; 4]) -> Option<[[usize; 3]; 2]> {
    let turns_left = |k: usize| {
        let (value, bound) = rounded_turn(at[(k + 3) % 4], at[k], at[(k + 1) % 4]);
        value > bound
    };
    let is_flipped = || flip::should_flip(at[1], at[3], at[0], at[2]);
    (0..4).all(turns_left).then(|| if is_flipped() { [[1, 2, 0], [2, 3, 0]] } else { [[3, 0, 1], [1, 2, 3]] })
}

impl Boundary<'_> {
    /// For each node the one that ends the boundary edge beginning there; none for a bridge.
    fn boundary_edges(&self) -> impl Iterator<Item = NodeId> {
        self.nodes.iter().map(|node| if node.corner.line == NO_LINE { NodeId::NONE } else { node.next })
    }

    fn at(&self, node: NodeId) -> DVec2 {
        self.nodes[node.index()].corner.at
    }

    fn next(&self, node: NodeId) -> NodeId {
        self.nodes[node.index()].next
    }

    fn previous(&self, node: NodeId) -> NodeId {
        self.nodes[node.index()].previous
    }

    /// Whether it is known to turn left at each node of its one loop.
    fn turns_left_everywhere(&self) -> bool {
        let count = self.nodes.len();
        (0..count).all(|k| {
            let [a, b, c] = [k + count - 1, k, k + 1].map(|k| &self.nodes[k % count].corner);
            let is_left = Turns::is_left_at([a, b, c], || self.turns.points.corner(a.piece, b.piece));
            debug_assert!(!is_left || self.turns.of(a, b, c) == Sign::Positive, "planes tell what points do");
            is_left
        })
    }

    /// Which way three nodes turn, exactly; positive is left.
    fn turn(&self, a: NodeId, b: NodeId, c: NodeId) -> Sign {
        if self.is_convex {
            // a loop that does not cross itself and always turns left is a convex polygon, of which any three corners turn left in their order
            let is_left = [(a, b), (b, c), (c, a)].iter().filter(|(p, q)| p < q).count() == 2;
            return if is_left { Sign::Positive } else { Sign::Negative };
        }
        let [a, b, c] = [a, b, c].map(|node| &self.nodes[node.index()]);
        // without a branch for each
        let is_on = |node: &Node, line: LineId| (node.lines[0] == line) | (node.lines[1] == line);
        if a.lines.iter().fold(false, |is_any, line| is_any | (is_on(b, *line) & is_on(c, *line))) {
            return Sign::Zero;
        }
        self.turns.of(&a.corner, &b.corner, &c.corner)
    }

    /// Whether a node lies in the closed triangle of three others, counter-clockwise.
    fn is_in_triangle(&self, [a, b, c]: [NodeId; 3], node: NodeId) -> bool {
        let sides = [(a, b), (b, c), (c, a)];
        let corner = |node: NodeId| &self.nodes[node.index()].corner;
        // mostly one side tells, and the others need not be asked exactly
        !sides.iter().any(|(from, to)| Turns::is_surely_right(corner(*from), corner(*to), corner(node)))
            && sides.into_iter().all(|(from, to)| self.turn(from, to, node) != Sign::Negative)
    }

    /// The nodes of a ring from `start` on.
    fn ring(&self, start: NodeId) -> impl Iterator<Item = NodeId> + '_ {
        let mut node = Some(start);
        std::iter::from_fn(move || {
            let this = node?;
            node = Some(self.next(this)).filter(|next| *next != start);
            Some(this)
        })
    }
}

/// Positive where three rounded points turn left, zero where they are collinear; the sign is exact.
pub(super) fn orient(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let coord = |p: DVec2| robust::Coord { x: p.x, y: p.y };
    robust::orient2d(coord(a), coord(b), coord(c))
}
