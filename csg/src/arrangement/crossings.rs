//! Where cuts of a triangle cross one another.
//!
//! Two cuts come from two other triangles. They have a point in common only where these touch each other, too; so few pairs are
//! looked at, none where two meshes that do not cross themselves meet.

use planecut_kernel::sign::{Counts, Sign};

use super::points::{PointKey, Points};
use super::predicates::best_axis;
use super::surface::{Surface, sorted};
use crate::base::{by_group, map_chunks};
use crate::ids::{Id, PointId, TriangleId};

/// A segment within a triangle, along which it is cut; or a point, at which cuts through it are divided.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct CutLine {
    pub(super) triangle: TriangleId,
    /// The triangle that it comes from.
    pub(super) other: TriangleId,
    /// The ends, in ascending order.
    pub(super) ends: [PointId; 2],
    /// The edge of the other triangle that it lies on.
    pub(super) edge: Option<[PointId; 2]>,
}

impl CutLine {
    /// Whether it is a point alone.
    pub(super) fn is_point(&self) -> bool {
        self.ends[0] == self.ends[1]
    }
}

/// Pairs of triangles that touch, by triangle.
#[derive(Debug)]
pub(super) struct Neighbours {
    starts: Vec<u32>,
    others: Vec<TriangleId>,
}

impl Neighbours {
    /// From pairs of triangles below a number.
    pub(super) fn new(triangles: usize, pairs: &[[TriangleId; 2]]) -> Self {
        let triangle = |member: usize| pairs[member / 2][member % 2].index();
        let other = |member: usize| pairs[member / 2][1 - member % 2];
        let (starts, mut others) = by_group(triangles, 2 * pairs.len(), triangle, other);
        for ends in starts.windows(2) {
            others[ends[0] as usize..ends[1] as usize].sort_unstable();
        }
        Self { starts, others }
    }

    fn of(&self, triangle: TriangleId) -> &[TriangleId] {
        &self.others[self.starts[triangle.index()] as usize..self.starts[triangle.index() + 1] as usize]
    }
}

/// A point on a cut, other than its ends: the place of the cut, and the point.
pub(super) type PointOnCut = (u32, PointKey);

/// The points at which cuts, sorted, cross or touch others.
pub(super) fn crossings(
    surface: &Surface<'_>,
    points: &Points,
    planes: &[TriangleId],
    cuts: &[CutLine],
    neighbours: &Neighbours,
) -> Vec<PointOnCut> {
    let groups: Vec<&[CutLine]> =
        cuts.chunk_by(|a, b| a.triangle == b.triangle).filter(|group| group.len() > 1).collect();
    let work = |groups: &[&[CutLine]]| {
        let mut found = Vec::new();
        for group in groups {
            let within = Within { surface, points, planes, group };
            within.find(neighbours, |place, key| found.push((place_in(cuts, group) + place, key)));
        }
        found
    };
    let (parts, _): (Vec<Vec<PointOnCut>>, Counts) = map_chunks(&groups, 16, work);
    let mut found = parts.concat();
    found.sort_unstable();
    found.dedup();
    found
}

/// The place of the first of a group.
fn place_in(cuts: &[CutLine], group: &[CutLine]) -> u32 {
    crate::ids::number32(cuts.partition_point(|cut| cut.triangle < group[0].triangle))
}

struct Within<'a> {
    surface: &'a Surface<'a>,
    points: &'a Points,
    planes: &'a [TriangleId],
    group: &'a [CutLine],
}

impl Within<'_> {
    fn find(&self, neighbours: &Neighbours, mut add: impl FnMut(u32, PointKey)) {
        let Some((axis, _)) = best_axis(self.surface.input, &self.surface.triangle(self.group[0].triangle)) else {
            return;
        };
        let mut others: Vec<TriangleId> = self.group.iter().map(|cut| cut.other).collect();
        others.dedup();
        for &one in &others {
            let near = neighbours.of(one);
            let (few, many) = if near.len() < others.len() { (near, &others[..]) } else { (&others[..], near) };
            for other in few.iter().filter(|other| **other > one && many.binary_search(other).is_ok()) {
                for p in self.of(one) {
                    for q in self.of(*other) {
                        self.cross(p, q, axis, &mut add);
                    }
                }
            }
        }
    }

    fn of(&self, other: TriangleId) -> std::ops::Range<usize> {
        let first = self.group.partition_point(|cut| cut.other < other);
        first..first + self.group[first..].iter().take_while(|cut| cut.other == other).count()
    }

    fn cross(&self, p: usize, q: usize, axis: usize, add: &mut impl FnMut(u32, PointKey)) {
        use crate::ids::number32;
        let ([a, b], [c, d]) = (self.group[p].ends, self.group[q].ends);
        let turn =
            |a, b, c| if c == a || c == b { Sign::Zero } else { self.points.turn(self.surface, [a, b, c], axis) };
        let (of_c, of_d) = (turn(a, b, c), turn(a, b, d));
        if of_c == of_d && of_c != Sign::Zero {
            return;
        }
        let (of_a, of_b) = (turn(c, d, a), turn(c, d, b));
        if of_a == of_b && of_a != Sign::Zero {
            return;
        }
        for (cut, [from, to], other, sides) in [(p, [a, b], [c, d], [of_c, of_d]), (q, [c, d], [a, b], [of_a, of_b])] {
            for (point, side) in other.into_iter().zip(sides) {
                if side == Sign::Zero && self.is_between(from, to, point, axis) {
                    add(number32(cut), PointKey::Vertex(point));
                }
            }
        }
        if [of_a, of_b, of_c, of_d].iter().all(|side| *side != Sign::Zero) {
            let key = self.key(&self.group[p], &self.group[q]);
            add(number32(p), key);
            add(number32(q), key);
        }
    }

    fn is_between(&self, from: PointId, to: PointId, point: PointId, axis: usize) -> bool {
        let axes = [(axis + 1) % 3, (axis + 2) % 3];
        let order = |a, b| self.points.compare_along(self.surface, a, b, axes);
        point != from && point != to && order(from, point) == order(point, to)
    }

    fn key(&self, p: &CutLine, q: &CutLine) -> PointKey {
        let plane = |triangle: TriangleId| self.planes[triangle.index()];
        match (p.edge, q.edge) {
            (Some(one), Some(other)) => PointKey::of_edges(sorted(one[0], one[1]), sorted(other[0], other[1])),
            (Some(edge), None) => PointKey::EdgePlane { edge, triangle: plane(q.other) },
            (None, Some(edge)) => PointKey::EdgePlane { edge, triangle: plane(p.other) },
            (None, None) => {
                let mut triangles = [p.triangle, p.other, q.other].map(plane);
                triangles.sort_unstable();
                PointKey::ThreePlanes(triangles)
            }
        }
    }
}
