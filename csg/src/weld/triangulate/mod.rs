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

pub(super) use turn::Turns;

use planecut_kernel::DVec2;
use planecut_kernel::sign::Sign;

use super::cancel::UNPAIRED;
use super::manifold::Labels;

/// A corner of a loop.
#[derive(Debug, Clone, Copy)]
pub(super) struct Corner {
    pub(super) at: DVec2,
    /// The exact point.
    pub(super) point: u32,
    /// The mesh vertex.
    pub(super) vertex: u32,
    /// The line on which the edge to the next corner lies.
    pub(super) line: u32,
    /// The half-edge to the next corner.
    pub(super) piece: u32,
}

/// The triangles of a face: mesh vertices, and for each side the half-edge it lies on.
#[derive(Debug, Default)]
pub(super) struct Triangles {
    pub(super) vertices: Vec<[u32; 3]>,
    pub(super) labels: Labels,
}

/// The line of a bridge or a diagonal.
const NO_LINE: u32 = u32::MAX;

/// A corner in the doubly linked boundary of what is left to triangulate.
#[derive(Debug, Clone, Copy)]
struct Node {
    corner: Corner,
    /// The lines of the two boundary edges that met here.
    lines: [u32; 2],
    previous: u32,
    next: u32,
    /// Not strictly convex: only such corners can lie inside an ear.
    reflex: bool,
    removed: bool,
}

/// The boundary of a face: one ring once the holes are joined to it.
pub(super) struct Boundary<'a> {
    nodes: Vec<Node>,
    turns: Turns<'a>,
}

/// Triangulates a face given by its loops, the outer one first, the inside to the left; triangles of mesh vertices.
pub(super) fn triangulate(loops: &[Vec<Corner>], turns: Turns<'_>, out: &mut Triangles) {
    let first = out.vertices.len();
    let Some((outer, holes)) = loops.split_first() else { return };
    if holes.is_empty() && outer.len() == 3 {
        out.vertices.push([outer[0].vertex, outer[1].vertex, outer[2].vertex]);
        out.labels.push([outer[0].piece, outer[1].piece, outer[2].piece]);
        return;
    }
    let mut boundary = Boundary { nodes: Vec::with_capacity(outer.len()), turns };
    let start = boundary.push_ring(outer);
    let mut rings: Vec<u32> = holes.iter().map(|hole| boundary.push_ring(hole)).collect();
    boundary.join_holes(start, &mut rings);
    let ahead = boundary.boundary_edges();
    let mut triangles = boundary.cut_ears(start);
    flip::improve(&boundary.nodes, &mut triangles);
    let corner = |node: u32| &boundary.nodes[node as usize].corner;
    out.vertices.extend(triangles.iter().map(|t| t.map(|node| corner(node).vertex)));
    let label = |from: u32, to: u32| if ahead[from as usize] == to { corner(from).piece } else { UNPAIRED };
    out.labels.extend(triangles.iter().map(|[a, b, c]| [label(*a, *b), label(*b, *c), label(*c, *a)]));
    debug_assert_eq!(out.vertices.len() - first, loops.iter().map(Vec::len).sum::<usize>() + 2 * holes.len() - 2);
}

impl Boundary<'_> {
    /// Links a loop into a ring of nodes; gives its first node.
    fn push_ring(&mut self, corners: &[Corner]) -> u32 {
        let first = self.nodes.len() as u32;
        let n = corners.len() as u32;
        for (k, corner) in corners.iter().enumerate() {
            let before = corners[(k + corners.len() - 1) % corners.len()];
            let k = k as u32;
            self.nodes.push(Node {
                corner: *corner,
                lines: [before.line, corner.line],
                previous: first + (k + n - 1) % n,
                next: first + (k + 1) % n,
                reflex: false,
                removed: false,
            });
        }
        first
    }

    /// For each node the one that ends the boundary edge beginning there; none for a bridge.
    fn boundary_edges(&self) -> Vec<u32> {
        self.nodes.iter().map(|node| if node.corner.line == NO_LINE { u32::MAX } else { node.next }).collect()
    }

    fn at(&self, node: u32) -> DVec2 {
        self.nodes[node as usize].corner.at
    }

    fn next(&self, node: u32) -> u32 {
        self.nodes[node as usize].next
    }

    fn previous(&self, node: u32) -> u32 {
        self.nodes[node as usize].previous
    }

    /// Which way three nodes turn, exactly; positive is left.
    fn turn(&self, a: u32, b: u32, c: u32) -> Sign {
        let [a, b, c] = [a, b, c].map(|node| &self.nodes[node as usize]);
        if a.lines.iter().any(|line| b.lines.contains(line) && c.lines.contains(line)) {
            return Sign::Zero;
        }
        self.turns.of(&a.corner, &b.corner, &c.corner)
    }

    /// Whether a node lies in the closed triangle of three others, counter-clockwise.
    fn is_in_triangle(&self, [a, b, c]: [u32; 3], node: u32) -> bool {
        let sides = [(a, b), (b, c), (c, a)];
        let corner = |node: u32| &self.nodes[node as usize].corner;
        // mostly one side tells, and the others need not be asked exactly
        !sides.iter().any(|(from, to)| Turns::is_surely_right(corner(*from), corner(*to), corner(node)))
            && sides.into_iter().all(|(from, to)| self.turn(from, to, node) != Sign::Negative)
    }

    /// The nodes of a ring from `start` on.
    fn ring(&self, start: u32) -> impl Iterator<Item = u32> + '_ {
        let mut node = Some(start);
        std::iter::from_fn(move || {
            let this = node?;
            node = Some(self.next(this)).filter(|next| *next != start);
            Some(this)
        })
    }
}

/// Positive where three rounded points turn left, zero where they are collinear; the sign is exact.
fn orient(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let coord = |p: DVec2| robust::Coord { x: p.x, y: p.y };
    robust::orient2d(coord(a), coord(b), coord(c))
}
