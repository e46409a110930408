//! Bridges from holes to the loop around them.

use planecut_kernel::sign::Sign;

use super::{Boundary, NO_LINE, Node};
use crate::ids::{Id, NodeId};

impl Boundary<'_> {
    /// Joins rings of holes to the ring of `outer`, from left to right, so that each finds the ones before it joined.
    pub(super) fn join_holes(&mut self, outer: NodeId, holes: &mut [NodeId]) {
        let order =
            |a: &NodeId, b: &NodeId| self.turns.order(&self.nodes[a.index()].corner, &self.nodes[b.index()].corner);
        for hole in holes.iter_mut() {
            *hole = self.ring(*hole).min_by(order).expect("a ring has nodes");
        }
        holes.sort_by(order);
        for &hole in holes.iter() {
            if let Some([node, hole]) = self.touching(hole, outer) {
                self.splice(node, hole);
                continue;
            }
            let proposed = self.visible_from(hole, outer);
            let bridge = if self.sees(proposed, hole) { Some(proposed) } else { self.nearest_in_sight(hole, outer) };
            let bridge = bridge.unwrap_or(proposed);
            // a hole that touches itself there has several corners, one of which opens towards the outside
            let end = self.corners_at(hole, hole).find(|corner| self.opens_towards(*corner, bridge));
            self.connect(bridge, end.unwrap_or(hole));
        }
    }

    /// The nodes of a ring that are at the point of another node.
    fn corners_at(&self, ring: NodeId, node: NodeId) -> impl Iterator<Item = NodeId> + '_ {
        let point = self.nodes[node.index()].corner.point;
        self.ring(ring).filter(move |corner| self.nodes[corner.index()].corner.point == point)
    }

    /// A node of the outer ring and one of a hole at the point of the leftmost one of it, where the hole touches the ring. Either may have
    /// several nodes there: those two are wanted between whose edges the others' lie.
    fn touching(&self, hole: NodeId, outer: NodeId) -> Option<[NodeId; 2]> {
        let pairs =
            self.corners_at(outer, hole).flat_map(|node| self.corners_at(hole, hole).map(move |own| [node, own]));
        pairs.into_iter().find(|[node, own]| {
            self.opens_towards(*node, self.next(*own)) && self.opens_towards(*own, self.next(*node))
        })
    }

    /// A node of the outer ring that sees `hole`, the leftmost node of a hole, but for rounding: heights are those of the rounded points.
    ///
    /// The ray to the left meets an edge; its left end is seen unless some corner lies in the triangle between, and then
    /// the one at the smallest angle to the ray is. Sides are those of the exact points.
    fn visible_from(&self, hole: NodeId, outer: NodeId) -> NodeId {
        let from = self.at(hole);
        let mut nearest: Option<(f64, NodeId)> = None;
        for node in self.ring(outer) {
            let next = self.next(node);
            let (p, q) = (self.at(node), self.at(next));
            // left of the hole the boundary runs downward
            if p.y < from.y || q.y > from.y || p.y == q.y || self.turn(node, next, hole) == Sign::Negative {
                continue;
            }
            let x = p.x + (from.y - p.y) / (q.y - p.y) * (q.x - p.x);
            if nearest.is_none_or(|(best, _)| x > best) {
                nearest = Some((x, node));
            }
        }
        nearest.map_or(outer, |(_, edge)| self.first_in_sight(hole, edge))
    }

    /// The corner at the smallest angle to the ray from `hole` to the left, in the triangle between the ray, the edge it
    /// meets and that edge's left end.
    fn first_in_sight(&self, hole: NodeId, edge: NodeId) -> NodeId {
        let (from, edge_end) = (self.at(hole), self.next(edge));
        let target = if self.at(edge).x < self.at(edge_end).x { edge } else { edge_end };
        let (left, height) = (self.at(target).x, self.at(target).y - from.y);
        let closer_to_ray = if height > 0.0 { Sign::Positive } else { Sign::Negative };
        // earlier bridges have left several corners at one point, of which only one may open towards the hole
        let (mut best, mut is_open) = (target, self.opens_towards(target, hole));
        for node in self.ring(target) {
            let p = self.at(node);
            if p.x < left || p.x >= from.x || (p.y - from.y) * height < 0.0 {
                continue;
            }
            let turn = self.turn(hole, best, node);
            let is_twin = self.nodes[node.index()].corner.point == self.nodes[best.index()].corner.point;
            let is_nearer = is_twin && !is_open
                || height != 0.0 && turn == closer_to_ray
                || turn == Sign::Zero && p.x > self.at(best).x;
            if is_nearer && self.turn(edge, edge_end, node) != Sign::Negative && self.opens_towards(node, hole) {
                (best, is_open) = (node, true);
            }
        }
        best
    }

    /// The nearest node of the outer ring, of those to the left of `hole`, that sees it.
    fn nearest_in_sight(&self, hole: NodeId, outer: NodeId) -> Option<NodeId> {
        let corner = |node: NodeId| &self.nodes[node.index()].corner;
        let is_left = |node: &NodeId| self.turns.order(corner(*node), corner(hole)).is_lt();
        let mut nodes: Vec<NodeId> = self.ring(outer).filter(is_left).collect();
        let distance = |node: &NodeId| self.at(*node).distance_squared(self.at(hole));
        nodes.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
        nodes.into_iter().find(|node| self.sees(*node, hole))
    }

    /// Whether a node of the outer ring sees the leftmost node of a hole, and its inside opens towards it: no edge of the ring crosses
    /// the way between them, none of its corners lies on it. All by the exact points.
    fn sees(&self, node: NodeId, hole: NodeId) -> bool {
        let corner = |node: NodeId| &self.nodes[node.index()].corner;
        let ends = [node, hole].map(|end| corner(end).point);
        let (low, high) = (self.at(node).min(self.at(hole)), self.at(node).max(self.at(hole)));
        let is_blocked = |from: NodeId| {
            let to = self.next(from);
            // correct rounding keeps the order of coordinates
            let (min, max) = (self.at(from).min(self.at(to)), self.at(from).max(self.at(to)));
            if min.cmpgt(high).any() || max.cmplt(low).any() || ends.contains(&corner(from).point) {
                return false;
            }
            let side = self.turn(node, hole, from);
            let is_between = || {
                let order = |a: NodeId, b: NodeId| self.turns.order(corner(a), corner(b));
                order(node, from) == order(from, hole)
            };
            if side == Sign::Zero {
                return is_between();
            }
            !ends.contains(&corner(to).point)
                && self.turn(node, hole, to) == side.flip()
                && self.turn(from, to, node) == self.turn(from, to, hole).flip()
        };
        self.opens_towards(node, hole) && !self.ring(node).any(is_blocked)
    }

    /// Whether the inside at `node` lies towards `other`.
    fn opens_towards(&self, node: NodeId, other: NodeId) -> bool {
        let (before, after) = (self.previous(node), self.next(node));
        let (of_next, of_last) = (self.turn(node, after, other), self.turn(before, node, other));
        let order = |to: NodeId| self.turns.order(&self.nodes[node.index()].corner, &self.nodes[to.index()].corner);
        match self.turn(before, node, after) {
            Sign::Positive => of_next != Sign::Negative && of_last != Sign::Negative,
            // the end of a slit: the inside lies all around it
            Sign::Zero if order(before) == order(after) => of_next != Sign::Zero || order(other) != order(after),
            _ => of_next == Sign::Positive || of_last == Sign::Positive,
        }
    }

    /// Joins the ring of `hole` to that of `node`, which is at the same point.
    fn splice(&mut self, node: NodeId, hole: NodeId) {
        let (after_node, after_hole) = (self.next(node), self.next(hole));
        let (own, other) = (self.nodes[node.index()], self.nodes[hole.index()]);
        (self.nodes[node.index()].next, self.nodes[hole.index()].next) = (after_hole, after_node);
        self.nodes[after_hole.index()].previous = node;
        self.nodes[after_node.index()].previous = hole;
        // each goes on along the edge of the other
        (self.nodes[node.index()].corner, self.nodes[hole.index()].corner) = (other.corner, own.corner);
        (self.nodes[node.index()].lines[1], self.nodes[hole.index()].lines[1]) = (other.lines[1], own.lines[1]);
    }

    /// Doubles both ends of a bridge and splices the ring of `hole` into that of `bridge`.
    fn connect(&mut self, bridge: NodeId, hole: NodeId) {
        let (after_bridge, before_hole) = (self.next(bridge), self.previous(hole));
        let hole_copy = NodeId::from_index(self.nodes.len());
        let bridge_copy = hole_copy.plus(1);
        let mut end = self.nodes[hole.index()];
        end.corner.line = NO_LINE;
        self.nodes.push(Node { previous: before_hole, next: bridge_copy, ..end });
        let start = self.nodes[bridge.index()];
        self.nodes.push(Node { previous: hole_copy, next: after_bridge, ..start });
        self.nodes[before_hole.index()].next = hole_copy;
        self.nodes[after_bridge.index()].previous = bridge_copy;
        self.nodes[bridge.index()].next = hole;
        self.nodes[bridge.index()].corner.line = NO_LINE;
        self.nodes[hole.index()].previous = bridge;
    }
}
