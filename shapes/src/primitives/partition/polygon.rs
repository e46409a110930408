//! Polygons on the lines of sides, and how they are cut.

use std::cmp::Ordering;

use planecut_kernel::DVec2;

use super::sides::{Placed, Sides, Vertex};
use crate::outline::signed_area;
use crate::primitives::cells::PlaneSide;

/// An edge of a [`Polygon`], along the line of a side; the polygon lies to its left.
#[derive(Debug, Clone, Copy)]
struct Edge {
    side: u32,
    /// Whether it runs against the side, so that the polygon is on the other side of the line.
    is_outer: bool,
    /// The number of the vertex where it begins.
    from: u32,
    /// Whether the polygon has more than half a turn there.
    is_reflex: bool,
    /// Whether a cut to another reflex corner has been looked for from there.
    is_tried: bool,
}

/// A polygon, counter-clockwise.
pub(super) struct Polygon(Vec<Edge>);

impl Polygon {
    /// The sides of lines that bound it, where it is convex.
    pub(super) fn sides(&self) -> Vec<PlaneSide> {
        let mut sides: Vec<(u32, bool)> = self.0.iter().map(|edge| (edge.side, edge.is_outer)).collect();
        sides.sort_unstable();
        sides.dedup();
        sides.into_iter().map(|(facet, is_outer)| PlaneSide { facet, is_outer }).collect()
    }
}

/// A direction from a vertex on: that of a side, or the opposite.
#[derive(Clone, Copy)]
struct Ray {
    side: u32,
    is_back: bool,
}

/// Where a ray leaves a polygon: at a vertex, or within the edge that begins there.
#[derive(Clone, Copy)]
enum Hit {
    Vertex(usize),
    Within(usize),
}

/// Cuts polygons until they are convex.
pub(super) struct Cutter<'a> {
    sides: Sides<'a>,
    vertices: Vec<Placed>,
    /// Of each line the number of reflex corners on it.
    reflex_on_line: Vec<u32>,
}

impl<'a> Cutter<'a> {
    pub(super) fn new(sides: Sides<'a>) -> Self {
        let vertices: Vec<Placed> = (0..sides.len()).map(|k| sides.placed(Vertex::Corner(k))).collect();
        let lines = (0..sides.len()).map(|side| sides.line(side) as usize + 1).max().unwrap_or(0);
        Self { sides, vertices, reflex_on_line: vec![0; lines] }
    }

    /// Convex polygons that together are the loop; `None` where a ray does not leave a polygon.
    pub(super) fn cells(&mut self) -> Option<Vec<Polygon>> {
        let mut waiting = vec![self.whole()];
        let mut done = Vec::new();
        while let Some(mut polygon) = waiting.pop() {
            if let Some(edge) = polygon.iter().position(|edge| edge.is_reflex) {
                let (at, ray, hit) = match self.double_cut(&mut polygon) {
                    Some(cut) => cut,
                    None => self.single_cut(&polygon, edge)?,
                };
                waiting.extend(self.split(&polygon, at, ray, hit));
            } else {
                done.push(Polygon(polygon));
            }
        }
        Some(done)
    }

    /// The area of a polygon, but for rounding.
    pub(super) fn area(&self, polygon: &Polygon) -> f64 {
        let corners: Vec<DVec2> = polygon.0.iter().map(|edge| self.position(edge.from)).collect();
        signed_area(&corners)
    }

    /// Whether the neighbours of each side are to its left, but for a distance.
    pub(super) fn is_convex(&self, polygon: &Polygon, margin: f64) -> bool {
        let n = polygon.0.len();
        let vertex = |k: usize| self.position(polygon.0[k % n].from);
        (0..n).all(|k| {
            let edge = &polygon.0[k];
            let depth = |p: DVec2| self.sides.distance(edge.side, p) * if edge.is_outer { -1.0 } else { 1.0 };
            depth(vertex(k + n - 1)) >= -margin && depth(vertex(k + 2)) >= -margin
        })
    }

    fn position(&self, vertex: u32) -> DVec2 {
        self.sides.position(&self.vertices[vertex as usize])
    }

    /// The loop itself.
    fn whole(&mut self) -> Vec<Edge> {
        let n = self.sides.len();
        let edge = |k: u32| {
            let before = (k + n - 1) % n;
            let is_reflex = self.sides.turn(before, &self.vertices[((k + 1) % n) as usize]) == Ordering::Less;
            // two sides on one line go on straight
            let is_reflex = is_reflex && self.sides.line(before) != self.sides.line(k);
            Edge { side: k, is_outer: false, from: k, is_reflex, is_tried: false }
        };
        let edges: Vec<Edge> = (0..n).map(edge).collect();
        for edge in edges.iter().filter(|edge| edge.is_reflex) {
            for side in [(edge.side + n - 1) % n, edge.side] {
                self.reflex_on_line[self.sides.line(side) as usize] += 1;
            }
        }
        edges
    }

    /// A cut from one reflex corner to another, along the lines of sides of both.
    fn double_cut(&self, polygon: &mut [Edge]) -> Option<(usize, Ray, Hit)> {
        for at in 0..polygon.len() {
            if !polygon[at].is_reflex || polygon[at].is_tried {
                continue;
            }
            polygon[at].is_tried = true;
            for ray in rays(polygon, at) {
                if self.reflex_on_line[self.sides.line(ray.side) as usize] < 2 {
                    continue;
                }
                if let Some(hit @ Hit::Vertex(end)) = self.exit(polygon, at, ray)
                    && self.solves(polygon, at, end)
                {
                    return Some((at, ray, hit));
                }
            }
        }
        None
    }

    /// Whether a cut between two reflex corners leaves no reflex corner at its end.
    fn solves(&self, polygon: &[Edge], at: usize, end: usize) -> bool {
        polygon[end].is_reflex && self.corners_at_end(polygon, at, end) == [false; 2]
    }

    /// Whether a cut that ends at a vertex leaves a reflex corner to its right and to its left.
    fn corners_at_end(&self, polygon: &[Edge], at: usize, end: usize) -> [bool; 2] {
        let start = polygon[at].from;
        let is_reflex = |edge: &Edge| polygon[end].is_reflex && self.turn(edge, start) == Ordering::Less;
        [is_reflex(&polygon[before(polygon, end)]), is_reflex(&polygon[end])]
    }

    /// The shorter one of the two cuts from a reflex corner.
    fn single_cut(&self, polygon: &[Edge], at: usize) -> Option<(usize, Ray, Hit)> {
        let mut best: Option<(f64, Ray, Hit)> = None;
        for ray in rays(polygon, at) {
            let Some(hit) = self.exit(polygon, at, ray) else { continue };
            let end = match hit {
                Hit::Vertex(end) => self.position(polygon[end].from),
                Hit::Within(edge) => {
                    self.sides.position(&self.sides.placed(Vertex::Meet(ray.side, polygon[edge].side)))
                }
            };
            let length = end.distance(self.position(polygon[at].from));
            if best.is_none_or(|(shortest, ..)| length < shortest) {
                best = Some((length, ray, hit));
            }
        }
        best.map(|(_, ray, hit)| (at, ray, hit))
    }

    /// Where a ray from a reflex corner first leaves the polygon.
    fn exit(&self, polygon: &[Edge], at: usize, ray: Ray) -> Option<Hit> {
        let line = self.sides.along(ray.side);
        let turn_at = |edge: &Edge| oriented(line.turn(&self.vertices[edge.from as usize]), ray.is_back);
        let start = polygon[at].from;
        let mut best: Option<(usize, Hit)> = None;
        let mut turn = turn_at(&polygon[0]);
        for (k, edge) in polygon.iter().enumerate() {
            let next = if k + 1 == polygon.len() { 0 } else { k + 1 };
            let turns = [turn, turn_at(&polygon[next])];
            turn = turns[1];
            // the polygon is to the left of the edge, which the ray crosses from left to right
            let crosses = turns[0] < turns[1];
            if !crosses || self.turn(edge, start) != Ordering::Greater {
                continue;
            }
            let hit = match turns {
                [Ordering::Equal, _] => Hit::Vertex(k),
                [_, Ordering::Equal] => Hit::Vertex(next),
                _ => Hit::Within(k),
            };
            if let Hit::Vertex(end) = hit
                && !self.sees(polygon, end, start)
            {
                continue;
            }
            let meet = self.sides.placed(Vertex::Meet(ray.side, edge.side));
            let is_nearer = |(nearest, _): (usize, Hit)| {
                let nearest = &polygon[nearest];
                oriented(self.sides.turn(nearest.side, &meet), nearest.is_outer) == Ordering::Greater
            };
            if best.is_none_or(is_nearer) {
                best = Some((k, hit));
            }
        }
        best.map(|(_, hit)| hit)
    }

    /// Whether a vertex lies between the edges of a corner.
    fn sees(&self, polygon: &[Edge], corner: usize, vertex: u32) -> bool {
        let edges = [before(polygon, corner), corner].map(|k| &polygon[k]);
        let is_left = edges.map(|edge| self.turn(edge, vertex) != Ordering::Less);
        if polygon[corner].is_reflex { is_left[0] || is_left[1] } else { is_left[0] && is_left[1] }
    }

    /// On which side of an edge a vertex lies.
    fn turn(&self, edge: &Edge, vertex: u32) -> Ordering {
        oriented(self.sides.turn(edge.side, &self.vertices[vertex as usize]), edge.is_outer)
    }

    /// The parts to the right and to the left of a cut.
    fn split(&mut self, polygon: &[Edge], at: usize, ray: Ray, hit: Hit) -> [Vec<Edge>; 2] {
        let cut = |is_outer: bool, from: u32, is_reflex: bool| Edge {
            side: ray.side,
            is_outer,
            from,
            is_reflex,
            is_tried: true,
        };
        let start = polygon[at].from;
        let (last, first, to, corners) = match hit {
            Hit::Vertex(end) => {
                let first = Edge { is_reflex: self.corners_at_end(polygon, at, end)[1], ..polygon[end] };
                (before(polygon, end), first, (end + 1) % polygon.len(), self.corners_at_end(polygon, at, end))
            }
            Hit::Within(edge) => {
                self.vertices.push(self.sides.placed(Vertex::Meet(ray.side, polygon[edge].side)));
                let from = self.vertices.len() as u32 - 1;
                (edge, Edge { from, is_reflex: false, ..polygon[edge] }, (edge + 1) % polygon.len(), [false; 2])
            }
        };
        let mut right: Vec<Edge> = around(polygon, at, (last + 1) % polygon.len()).collect();
        if let Some(first) = right.first_mut() {
            first.is_reflex = false;
        }
        right.push(cut(!ray.is_back, first.from, corners[0]));
        let mut left = vec![cut(ray.is_back, start, false), first];
        left.extend(around(polygon, to, at));
        [right, left]
    }
}

/// The edges from one on, up to another and without it.
fn around(polygon: &[Edge], from: usize, to: usize) -> impl Iterator<Item = Edge> + '_ {
    let (first, second) = if from <= to { (from..to, 0..0) } else { (from..polygon.len(), 0..to) };
    first.chain(second).map(|k| polygon[k])
}

/// The two ways on along the sides of a corner.
fn rays(polygon: &[Edge], at: usize) -> [Ray; 2] {
    let (into, out) = (&polygon[before(polygon, at)], &polygon[at]);
    [Ray { side: into.side, is_back: into.is_outer }, Ray { side: out.side, is_back: !out.is_outer }]
}

fn before(polygon: &[Edge], k: usize) -> usize {
    if k == 0 { polygon.len() - 1 } else { k - 1 }
}

fn oriented(turn: Ordering, is_reversed: bool) -> Ordering {
    if is_reversed { turn.reverse() } else { turn }
}
