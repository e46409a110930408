//! Subdivision of one triangle or polygon into cells by the cuts within it and the points on its edges.

use std::cmp::Ordering;

use planecut_kernel::sign::Sign;

use super::points::Points;
use super::surface::Surface;
use crate::base::{DisjointSets, by_group};
use crate::ids::{PointId, TriangleId, number32};

/// The cells of subdivided triangles: polygons, perhaps with holes, whose boundary may run along a segment both ways.
#[derive(Debug, Default)]
pub(super) struct Cells {
    /// The triangle that each is a part of.
    pub(super) triangles: Vec<TriangleId>,
    /// Where the loops of each cell end; the first one goes around it, the others are holes.
    cell_ends: Vec<u32>,
    /// Where the points of each loop end.
    loop_ends: Vec<u32>,
    /// The points of loops, the cell to the left of each step as its triangle is seen.
    points: Vec<PointId>,
}

impl Cells {
    /// The number of cells.
    pub(super) fn len(&self) -> usize {
        self.triangles.len()
    }

    /// The loops of a cell.
    pub(super) fn loops(&self, cell: usize) -> impl Iterator<Item = &[PointId]> {
        let before = |ends: &[u32], k: usize| if k == 0 { 0 } else { ends[k - 1] as usize };
        (before(&self.cell_ends, cell)..self.cell_ends[cell] as usize)
            .map(move |k| &self.points[before(&self.loop_ends, k)..self.loop_ends[k] as usize])
    }

    fn add(&mut self, triangle: TriangleId, loops: impl Iterator<Item = impl Iterator<Item = PointId>>) {
        for points in loops {
            self.points.extend(points);
            self.loop_ends.push(number32(self.points.len()));
        }
        self.triangles.push(triangle);
        self.cell_ends.push(number32(self.loop_ends.len()));
    }

    pub(super) fn append(&mut self, other: &Self) {
        let (loops, points) = (number32(self.loop_ends.len()), number32(self.points.len()));
        self.triangles.extend(&other.triangles);
        self.cell_ends.extend(other.cell_ends.iter().map(|end| end + loops));
        self.loop_ends.extend(other.loop_ends.iter().map(|end| end + points));
        self.points.extend(&other.points);
    }
}

/// A triangle seen from where it is counter-clockwise.
#[derive(Clone, Copy)]
pub(super) struct View<'a> {
    pub(super) surface: &'a Surface<'a>,
    pub(super) points: &'a Points,
    pub(super) axis: usize,
    /// The sign of the triangle's normal along the axis.
    pub(super) facing: Sign,
}

impl View<'_> {
    pub(super) fn turn(&self, a: PointId, b: PointId, c: PointId) -> Sign {
        self.points.turn(self.surface, [a, b, c], self.axis).times(self.facing)
    }

    /// From left to right, then upwards.
    fn order(&self, a: PointId, b: PointId) -> Ordering {
        let (u, v) = ((self.axis + 1) % 3, (self.axis + 2) % 3);
        let axes = if self.facing == Sign::Positive { [u, v] } else { [v, u] };
        self.points.compare_along(self.surface, a, b, axes)
    }
}

/// Where a loop that goes around something is.
#[derive(Debug, Clone, Copy)]
enum Around {
    /// Within the cell that has a loop around it.
    Cell(u32),
    /// Within none.
    Nothing,
}

impl Around {
    fn cell(self) -> Option<u32> {
        match self {
            Self::Cell(cell) => Some(cell),
            Self::Nothing => None,
        }
    }
}

/// Half-edges of the subdivision. The first ones are those of the boundary of a triangle; of the others each two run along one segment.
struct Graph<'a> {
    view: View<'a>,
    nodes: Vec<PointId>,
    boundary: usize,
    /// Whether what lies to the left of a half-edge is not a part of the polygon; empty for a triangle.
    is_outside: Vec<bool>,
    /// Where each half-edge begins and ends, as places among the nodes.
    ends: Vec<[u32; 2]>,
    next: Vec<u32>,
}

/// Subdivides a triangle, or a polygon that has it as its first one. `border` are the segments of its boundary, itself to their left, those of
/// a triangle in order; `cuts` are segments that meet in ends alone, perhaps more than once each.
pub(super) fn subdivide(
    view: View<'_>,
    triangle: TriangleId,
    border: &[[PointId; 2]],
    is_triangle: bool,
    cuts: &mut Vec<[PointId; 2]>,
    cells: &mut Cells,
) {
    cuts.sort_unstable();
    cuts.dedup();
    let mut sides: Vec<[PointId; 2]> = border.iter().map(|[a, b]| super::surface::sorted(*a, *b)).collect();
    sides.sort_unstable();
    cuts.retain(|cut| sides.binary_search(cut).is_err());
    if cuts.is_empty() && is_triangle {
        cells.add(triangle, std::iter::once(border.iter().map(|side| side[0])));
        return;
    }
    let mut nodes: Vec<PointId> = border.iter().chain(cuts.iter()).flatten().copied().collect();
    nodes.sort_unstable();
    nodes.dedup();
    let node = |point: &PointId| number32(nodes.binary_search(point).expect("a point of the triangle"));
    let boundary = if is_triangle { border.len() } else { 0 };
    let mut ends: Vec<[u32; 2]> = Vec::with_capacity(boundary + 2 * cuts.len());
    let mut is_outside = Vec::new();
    if is_triangle {
        ends.extend(border.iter().map(|side| [node(&side[0]), node(&side[1])]));
    } else {
        // where both half-edges of a segment are parts of the boundary it is a slit
        let mut directed = border.to_vec();
        directed.sort_unstable();
        for [a, b] in border {
            let is_slit = directed.binary_search(&[*b, *a]).is_ok();
            if !is_slit || a < b {
                ends.extend([[node(a), node(b)], [node(b), node(a)]]);
                is_outside.extend([false, !is_slit]);
            }
        }
    }
    for [a, b] in cuts.iter() {
        let (a, b) = (node(a), node(b));
        ends.extend([[a, b], [b, a]]);
    }
    is_outside.resize(if is_triangle { 0 } else { ends.len() }, false);
    let mut graph = Graph { view, nodes, boundary, is_outside, next: vec![0; ends.len()], ends };
    graph.link();
    graph.emit(triangle, cells);
}

impl Graph<'_> {
    fn from(&self, half_edge: u32) -> PointId {
        self.nodes[self.ends[half_edge as usize][0] as usize]
    }

    fn to(&self, half_edge: u32) -> PointId {
        self.nodes[self.ends[half_edge as usize][1] as usize]
    }

    fn is_boundary(&self, half_edge: u32) -> bool {
        (half_edge as usize) < self.boundary
    }

    fn twin(&self, half_edge: u32) -> u32 {
        let first = number32(self.boundary);
        first + ((half_edge - first) ^ 1)
    }

    /// Links each half-edge to the one that follows it around the cell to its left.
    fn link(&mut self) {
        let begin = |half_edge: usize| self.ends[half_edge][0] as usize;
        let (starts, mut leaving) = by_group(self.nodes.len(), self.ends.len(), begin, number32);
        let mut into_boundary = vec![u32::MAX; self.nodes.len()];
        for k in 0..self.boundary {
            into_boundary[self.ends[k][1] as usize] = number32(k);
        }
        for node in 0..self.nodes.len() {
            let out = &mut leaving[starts[node] as usize..starts[node + 1] as usize];
            self.sort_around(self.nodes[node], out);
            // what comes in is followed by what leaves next to it on the right
            for k in 0..out.len() {
                if !self.is_boundary(out[k]) {
                    let incoming = self.twin(out[k]);
                    self.next[incoming as usize] = out[(k + out.len() - 1) % out.len()];
                }
            }
            if into_boundary[node] != u32::MAX {
                self.next[into_boundary[node] as usize] = out[out.len() - 1];
            }
        }
    }

    /// Sorts the half-edges that leave a node counter-clockwise, from that of the boundary on if there is one.
    fn sort_around(&self, node: PointId, out: &mut [u32]) {
        let ahead = |a: &u32, b: &u32| match self.view.turn(node, self.to(*a), self.to(*b)) {
            Sign::Positive => Ordering::Less,
            Sign::Zero => a.cmp(b),
            Sign::Negative => Ordering::Greater,
        };
        // half-edges of the boundary have the smallest numbers
        if self.is_boundary(out[0]) {
            out[1..].sort_by(ahead);
        } else if out.len() > 2 {
            let first = out[0];
            let quarter = |other: u32| match self.view.turn(node, self.to(first), self.to(other)) {
                Sign::Positive => 0,
                Sign::Zero => 1,
                Sign::Negative => 2,
            };
            out[1..].sort_by(|a, b| quarter(*a).cmp(&quarter(*b)).then_with(|| ahead(a, b)));
        }
    }

    fn emit(&self, triangle: TriangleId, cells: &mut Cells) {
        let mut of_half_edge = vec![u32::MAX; self.ends.len()];
        let mut loops: Vec<Vec<u32>> = Vec::new();
        for start in 0..number32(self.ends.len()) {
            if of_half_edge[start as usize] != u32::MAX {
                continue;
            }
            let mut members = Vec::new();
            let mut half_edge = start;
            while of_half_edge[half_edge as usize] == u32::MAX {
                of_half_edge[half_edge as usize] = number32(loops.len());
                members.push(half_edge);
                half_edge = self.next[half_edge as usize];
            }
            loops.push(members);
        }
        let parents = self.parents(&of_half_edge, loops.len());
        let mut holes: Vec<(u32, usize)> = (0..loops.len()).filter_map(|k| Some((parents[k]?.cell()?, k))).collect();
        holes.sort_unstable();
        let is_out = |members: &[u32]| members.iter().any(|h| self.is_outside.get(*h as usize) == Some(&true));
        for (k, around) in loops.iter().enumerate().filter(|(k, around)| parents[*k].is_none() && !is_out(around)) {
            let first = holes.partition_point(|(parent, _)| (*parent as usize) < k);
            let within =
                holes[first..].iter().take_while(|(parent, _)| *parent as usize == k).map(|(_, hole)| &loops[*hole]);
            let points = |members: &'_ Vec<u32>| members.iter().map(|h| self.from(*h)).collect::<Vec<_>>().into_iter();
            cells.add(triangle, std::iter::once(around).chain(within).map(points));
        }
    }

    /// For each loop that goes around something where that is.
    fn parents(&self, of_half_edge: &[u32], loops: usize) -> Vec<Option<Around>> {
        let mut parents: Vec<Option<Around>> = vec![None; loops];
        let mut sets = DisjointSets::new(self.nodes.len());
        self.ends.iter().for_each(|[a, b]| sets.join(*a, *b));
        let root = sets.root(self.ends[0][0]);
        let (numbers, count) = sets.numbered();
        // around a triangle there is no loop
        let outer = (self.boundary > 0).then_some(numbers[root as usize]);
        if count == 1 && outer.is_some() {
            return parents;
        }
        // the leftmost node of each part
        let mut leftmost: Vec<Option<u32>> = vec![None; count];
        for node in 0..number32(self.nodes.len()) {
            let best = &mut leftmost[numbers[node as usize] as usize];
            let is_left = |other: u32| self.view.order(self.nodes[node as usize], self.nodes[other as usize]).is_lt();
            if best.is_none_or(is_left) {
                *best = Some(node);
            }
        }
        let mut islands: Vec<u32> =
            (0..number32(count)).filter(|k| Some(*k) != outer).filter_map(|k| leftmost[k as usize]).collect();
        islands.sort_by(|a, b| self.view.order(self.nodes[*a as usize], self.nodes[*b as usize]));
        for node in islands {
            let point = self.nodes[node as usize];
            // around the island runs the loop of the last half-edge, counter-clockwise from below, that leaves its leftmost node
            let leaving = (0..number32(self.ends.len())).filter(|h| self.ends[*h as usize][0] == node);
            let last = leaving.max_by(|a, b| match self.view.turn(point, self.to(*a), self.to(*b)) {
                Sign::Positive => Ordering::Less,
                Sign::Zero => Ordering::Equal,
                Sign::Negative => Ordering::Greater,
            });
            let around = of_half_edge[last.expect("an island has segments") as usize];
            let below = self.below(node, &numbers).map(|half_edge| of_half_edge[half_edge as usize]);
            // what is around another island is so for this one, too
            let place = |cell: u32| parents[cell as usize].unwrap_or(Around::Cell(cell));
            parents[around as usize] = Some(below.map_or(Around::Nothing, place));
        }
        parents
    }

    /// The half-edge from left to right next below a node, of those of other parts.
    fn below(&self, node: u32, numbers: &[u32]) -> Option<u32> {
        let point = self.nodes[node as usize];
        let order = |a: PointId, b: PointId| self.view.order(a, b);
        let mut best: Option<u32> = None;
        for half_edge in 0..number32(self.ends.len()) {
            let (p, q) = (self.from(half_edge), self.to(half_edge));
            let is_below = numbers[self.ends[half_edge as usize][0] as usize] != numbers[node as usize]
                && order(p, point).is_lt()
                && order(point, q).is_lt()
                && self.view.turn(p, q, point) == Sign::Positive;
            if is_below && best.is_none_or(|best| self.is_above(half_edge, best)) {
                best = Some(half_edge);
            }
        }
        best
    }

    /// Whether a half-edge lies above another one where both have points; both run from left to right, and do not cross.
    fn is_above(&self, one: u32, other: u32) -> bool {
        let ((a, b), (c, d)) = ((self.from(one), self.to(one)), (self.from(other), self.to(other)));
        let side = if self.view.order(a, c).is_ge() { self.view.turn(c, d, a) } else { self.view.turn(a, b, c).flip() };
        if side != Sign::Zero {
            return side == Sign::Positive;
        }
        if self.view.order(b, d).is_le() {
            self.view.turn(c, d, b) == Sign::Positive
        } else {
            self.view.turn(a, b, d) == Sign::Negative
        }
    }
}
