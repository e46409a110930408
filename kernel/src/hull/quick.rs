//! Quickhull with exact signs: a triangulated hull, in which coplanar triangles are allowed.
//!
//! A point sees a triangle where it lies strictly outside its plane. What a point sees is then a disc whose border no new
//! triangle meets in a line, so that no triangle ever degenerates, whatever the points are like.
//!
//! Or with a tolerance, in floating point: there a point sees a triangle from farther away than that alone. What it sees may then be no disc, and there is no hull.

use glam::DVec3;
use robust::{Coord, Coord3D, orient2d, orient3d};

use super::HullError;
use super::neighbours::Neighbours;

/// A triangle of the hull, counter-clockwise seen from outside.
#[derive(Debug, Clone)]
struct Triangle {
    corners: [u32; 3],
    /// The triangle across the edge from corner `k` to the next.
    across: [u32; 3],
    /// Points that see it and have no other triangle yet.
    waiting: Vec<u32>,
    alive: bool,
    /// The last point that was asked whether it sees it, and the answer.
    asked: (u32, bool),
    /// Unit normal and offset of its plane, about, where there is a tolerance.
    plane: (DVec3, f64),
}

const NOBODY: u32 = u32::MAX;
/// The cosine between the normals of two facets that meet at less than about two degrees.
const SHARP: f64 = -0.9994;

/// The boundary of the hull.
#[derive(Debug)]
pub(super) struct Triangulation<'a> {
    points: &'a [DVec3],
    triangles: Vec<Triangle>,
    /// How far outside of a triangle's plane a point may lie without seeing it; exact where there is none.
    tolerance: Option<f64>,
}

/// An edge of the border of what a point sees, named from the side that stays.
struct Border {
    from: u32,
    to: u32,
    outside: u32,
}

impl<'a> Triangulation<'a> {
    /// The hull of points in the accepted range.
    pub(super) fn of(points: &'a [DVec3]) -> Result<Self, HullError> {
        let mut hull = Self { points, triangles: Vec::new(), tolerance: None };
        hull.begin(first_simplex(points)?);
        // what a point sees by exact signs is a disc
        hull.grow();
        Ok(hull)
    }

    /// A hull of points in the accepted range from which none sticks out by more than a tolerance, about; nothing where rounding would have it cross itself.
    pub(super) fn within(points: &'a [DVec3], tolerance: f64) -> Result<Option<Self>, HullError> {
        let mut hull = Self { points, triangles: Vec::new(), tolerance: Some(tolerance) };
        hull.begin(first_simplex(points)?);
        Ok(hull.grow().then_some(hull))
    }

    /// Makes a tetrahedron.
    fn begin(&mut self, simplex: [u32; 4]) {
        let [a, b, c, d] = simplex;
        let faces = if self.turn([a, b, c], d) < 0.0 {
            [[a, c, b], [a, b, d], [b, c, d], [c, a, d]]
        } else {
            [[a, b, c], [a, d, b], [b, d, c], [c, d, a]]
        };
        for corners in faces {
            self.push(corners);
        }
        for i in 0..4u32 {
            for k in 0..3 {
                let (from, to) = self.edge(i, k);
                self.triangles[i as usize].across[k] =
                    (0..4).find(|j| (0..3).any(|l| self.edge(*j, l) == (to, from))).unwrap_or(i);
            }
        }
        let all: Vec<u32> = (0..self.points.len() as u32).filter(|p| !simplex.contains(p)).collect();
        self.distribute(all, &[0, 1, 2, 3]);
    }

    /// Takes in all points; false where what one of them sees is no disc.
    fn grow(&mut self) -> bool {
        let mut open: Vec<u32> = (0..4).collect();
        while let Some(triangle) = open.pop() {
            if !self.triangles[triangle as usize].alive || self.triangles[triangle as usize].waiting.is_empty() {
                continue;
            }
            let point = self.farthest(triangle);
            let first_new = self.triangles.len() as u32;
            let (visible, border) = self.visible_from(point, triangle);
            if !self.cover(point, &border) {
                return false;
            }
            let mut orphans = Vec::new();
            for gone in visible {
                let gone = &mut self.triangles[gone as usize];
                gone.alive = false;
                orphans.append(&mut gone.waiting);
            }
            // it may seem to see a sliver that it is a corner of
            orphans.retain(|orphan| *orphan != point);
            let new: Vec<u32> = (first_new..self.triangles.len() as u32).collect();
            self.distribute(orphans, &new);
            open.extend(new);
        }
        true
    }

    fn edge(&self, triangle: u32, k: usize) -> (u32, u32) {
        let corners = &self.triangles[triangle as usize].corners;
        (corners[k], corners[(k + 1) % 3])
    }

    fn push(&mut self, corners: [u32; 3]) -> u32 {
        let asked = (NOBODY, false);
        let plane = if self.tolerance.is_some() { self.plane_of(corners) } else { (DVec3::ZERO, 0.0) };
        self.triangles.push(Triangle { corners, across: [NOBODY; 3], waiting: Vec::new(), alive: true, asked, plane });
        self.triangles.len() as u32 - 1
    }

    /// Unit normal and offset; zero for a line.
    fn plane_of(&self, corners: [u32; 3]) -> (DVec3, f64) {
        let [a, b, c] = corners.map(|p| self.points[p as usize]);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        (normal, normal.dot(a))
    }

    /// Whether a point lies strictly outside the plane of a triangle, or by more than the tolerance.
    fn is_outside(&self, triangle: u32, point: u32) -> bool {
        let Triangle { corners, plane: (normal, offset), .. } = &self.triangles[triangle as usize];
        match self.tolerance {
            None => self.turn(*corners, point) < 0.0,
            Some(tolerance) => normal.dot(self.points[point as usize]) - offset > tolerance,
        }
    }

    /// Negative outside the plane of three points that are counter-clockwise seen from there, exactly.
    fn turn(&self, [a, b, c]: [u32; 3], point: u32) -> f64 {
        let at = |p: u32| coordinates(self.points[p as usize]);
        orient3d(at(a), at(b), at(c), at(point))
    }

    /// The waiting point that seems to lie farthest out; any would do.
    fn farthest(&self, triangle: u32) -> u32 {
        let Triangle { corners, waiting, .. } = &self.triangles[triangle as usize];
        let [a, b, c] = corners.map(|p| self.points[p as usize]);
        let normal = (b - a).cross(c - a);
        let height = |p: u32| normal.dot(self.points[p as usize] - a);
        let mut best = (f64::NEG_INFINITY, waiting[0]);
        for &p in waiting {
            let h = height(p);
            if h > best.0 {
                best = (h, p);
            }
        }
        best.1
    }

    /// The triangles that a point sees, one of which is known, and their border in order.
    fn visible_from(&mut self, point: u32, known: u32) -> (Vec<u32>, Vec<Border>) {
        self.triangles[known as usize].asked = (point, true);
        let (mut visible, mut border) = (vec![known], Vec::new());
        let mut next = 0;
        while let Some(&triangle) = visible.get(next) {
            next += 1;
            for k in 0..3 {
                let other = self.triangles[triangle as usize].across[k];
                let seen = match self.triangles[other as usize].asked {
                    (asked, seen) if asked == point => seen,
                    _ => {
                        let seen = self.is_outside(other, point);
                        self.triangles[other as usize].asked = (point, seen);
                        if seen {
                            visible.push(other);
                        }
                        seen
                    }
                };
                if !seen {
                    let (from, to) = self.edge(triangle, k);
                    border.push(Border { from, to, outside: other });
                }
            }
        }
        (visible, border)
    }

    /// Joins a point to the border of what it sees; false, with nothing done, where that is not one loop.
    fn cover(&mut self, point: u32, border: &[Border]) -> bool {
        let first = self.triangles.len() as u32;
        // the triangle that begins where another ends is its neighbour
        let mut begins: Vec<(u32, u32)> = border.iter().map(|edge| edge.from).zip(first..).collect();
        begins.sort_unstable();
        if self.tolerance.is_some() && !is_loop(border, &begins, first) {
            return false;
        }
        for Border { from, to, outside } in border {
            let new = self.push([*from, *to, point]);
            self.triangles[new as usize].across[0] = *outside;
            let back = (0..3).find(|k| self.edge(*outside, *k) == (*to, *from)).unwrap_or(0);
            self.triangles[*outside as usize].across[back] = new;
        }
        for (edge, new) in border.iter().zip(first..) {
            let Ok(place) = begins.binary_search_by_key(&edge.to, |(from, _)| *from) else { continue };
            let following = begins[place].1;
            self.triangles[new as usize].across[1] = following;
            self.triangles[following as usize].across[2] = new;
        }
        true
    }

    /// Gives each point to one of some triangles that sees it; one that sees none is inside.
    fn distribute(&mut self, points: Vec<u32>, triangles: &[u32]) {
        for point in points {
            let sees = |t: &&u32| self.is_outside(**t, point);
            if let Some(&triangle) = triangles.iter().find(sees) {
                self.triangles[triangle as usize].waiting.push(point);
            }
        }
    }

    /// All triangles.
    pub(super) fn triangles(&self) -> impl Iterator<Item = [u32; 3]> {
        self.triangles.iter().filter(|triangle| triangle.alive).map(|triangle| triangle.corners)
    }

    /// One triangle for each facet, chosen among the coplanar ones, in an order in which neighbours are near each other.
    pub(super) fn facets(&self) -> Vec<u32> {
        let mut done = vec![false; self.triangles.len()];
        let mut facets = Vec::new();
        for start in (0..self.triangles.len() as u32).filter(|t| self.triangles[*t as usize].alive) {
            if std::mem::replace(&mut done[start as usize], true) {
                continue;
            }
            let mut coplanar = vec![start];
            let mut next = 0;
            while let Some(&triangle) = coplanar.get(next) {
                next += 1;
                for other in self.triangles[triangle as usize].across {
                    let corners = self.triangles[other as usize].corners;
                    let on_plane = |p: &u32| self.turn(self.triangles[start as usize].corners, *p) == 0.0;
                    if !done[other as usize] && corners.iter().all(on_plane) {
                        done[other as usize] = true;
                        coplanar.push(other);
                    }
                }
            }
            facets.push(start);
        }
        facets
    }

    /// The corners of a triangle.
    pub(super) fn corners(&self, triangle: u32) -> [u32; 3] {
        self.triangles[triangle as usize].corners
    }

    /// Edges at which the hull turns back on itself: their two ends and the opposite corners of both triangles.
    pub(super) fn sharp_edges(&self) -> Vec<[u32; 4]> {
        let mut edges = Vec::new();
        for (triangle, Triangle { across, corners, .. }) in (0u32..).zip(&self.triangles).filter(|(_, t)| t.alive) {
            for (k, &other) in across.iter().enumerate().filter(|(_, other)| triangle < **other) {
                let (from, to) = self.edge(triangle, k);
                let opposite = self.triangles[other as usize].corners.into_iter().find(|p| *p != from && *p != to);
                let normals = [triangle, other].map(|t| self.direction(t));
                if let Some(opposite) = opposite
                    && normals[0].dot(normals[1]) < SHARP
                {
                    edges.push([from, to, corners[(k + 2) % 3], opposite]);
                }
            }
        }
        edges
    }

    /// The normal of a triangle, about; zero for one that is nearly a line.
    fn direction(&self, triangle: u32) -> DVec3 {
        let [a, b, c] = self.corners(triangle).map(|p| self.points[p as usize]);
        (b - a).normalize_or_zero().cross((c - a).normalize_or_zero()).normalize_or_zero()
    }

    /// For each point the points that it shares an edge with; nothing for a point inside.
    pub(super) fn vertex_neighbours(&self) -> Neighbours {
        let alive = (0u32..).zip(&self.triangles).filter(|(_, triangle)| triangle.alive);
        let mut neighbours = Neighbours::of_none(self.points.len());
        for (triangle, corner) in alive.flat_map(|(t, triangle)| triangle.corners.map(|corner| (t, corner))) {
            if !neighbours.has(corner) {
                neighbours.push(self.points, corner, self.ring(corner, triangle));
            }
        }
        neighbours
    }

    /// The points around another one, in order, beginning at one of its triangles.
    fn ring(&self, point: u32, first: u32) -> impl Iterator<Item = u32> + '_ {
        let place = move |triangle: u32| self.corners(triangle).iter().position(|p| *p == point).unwrap_or(0);
        std::iter::successors(Some(first), move |&triangle| {
            let next = self.triangles[triangle as usize].across[(place(triangle) + 2) % 3];
            (next != first).then_some(next)
        })
        .map(move |triangle| self.corners(triangle)[(place(triangle) + 1) % 3])
    }
}

/// Whether edges, by the points where they begin with numbers from the first one on, are one closed loop that passes no point twice.
fn is_loop(border: &[Border], begins: &[(u32, u32)], first: u32) -> bool {
    let next = |edge: &Border| {
        let place = begins.binary_search_by_key(&edge.to, |(from, _)| *from).ok()?;
        Some((begins[place].1 - first) as usize)
    };
    let mut at = 0;
    for (passed, _) in (1..).zip(border) {
        match next(&border[at]) {
            Some(0) => return passed == border.len(),
            Some(following) => at = following,
            None => return false,
        }
    }
    false
}

fn coordinates(p: DVec3) -> Coord3D<f64> {
    Coord3D { x: p.x, y: p.y, z: p.z }
}

/// Four points that span space.
fn first_simplex(points: &[DVec3]) -> Result<[u32; 4], HullError> {
    let flat = |dimension: usize| HullError::NoInterior { dimension };
    let a = points.first().ok_or(flat(0))?;
    let farthest = |measure: &dyn Fn(&DVec3) -> f64, spans: &dyn Fn(&DVec3) -> bool| {
        // the best by floating point, if it passes exactly, else any that does
        let best = (0..points.len()).max_by(|i, j| measure(&points[*i]).total_cmp(&measure(&points[*j])))?;
        if spans(&points[best]) { Some(best) } else { points.iter().position(spans) }
    };
    let b = farthest(&|p| p.distance_squared(*a), &|p| p != a).ok_or(flat(0))?;
    let along = points[b] - *a;
    let on_line = |p: &DVec3| {
        [[0, 1], [1, 2], [2, 0]].into_iter().all(|[u, v]| {
            let at = |p: &DVec3| Coord { x: p[u], y: p[v] };
            orient2d(at(a), at(&points[b]), at(p)) == 0.0
        })
    };
    let c = farthest(&|p| along.cross(*p - *a).length_squared(), &|p| !on_line(p)).ok_or(flat(1))?;
    let normal = along.cross(points[c] - *a);
    let corners = [*a, points[b], points[c]].map(coordinates);
    let off_plane = |p: &DVec3| orient3d(corners[0], corners[1], corners[2], coordinates(*p)) != 0.0;
    let d = farthest(&|p| normal.dot(*p - *a).abs(), &off_plane).ok_or(flat(2))?;
    Ok([0, b as u32, c as u32, d as u32])
}
