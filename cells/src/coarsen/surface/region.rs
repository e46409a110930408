//! A box of space with what it holds of a solid.

use planecut_kernel::{DVec3, approximate_hull_triangles};

use super::inside::Inside;
use super::polygons::Polygons;
use crate::tolerances::{CLIP_MARGIN, HULL_TOUCHING};

/// A box, and what of the surface lies in it.
#[derive(Debug, Clone)]
pub(super) struct Region {
    pub(super) low: DVec3,
    pub(super) high: DVec3,
    pub(super) polygons: Polygons,
    /// Whether each corner of the box is inside; bit `k` of its number is set where the corner is high along axis `k`.
    pub(super) corners: [bool; 8],
    /// The volume of what is inside, about.
    pub(super) filled: f64,
    /// Points inside that no polygon and no corner of the box tells of.
    open: Vec<DVec3>,
}

impl Region {
    pub(super) fn new(low: DVec3, high: DVec3, polygons: Polygons, inside: &impl Inside) -> Self {
        let corners = std::array::from_fn(|k| inside.holds(corner(low, high, k)));
        let region = Self { low, high, polygons, corners, filled: 0.0, open: Vec::new() };
        let (filled, open) = inside.fills(&region);
        Self { filled, open, ..region }
    }

    /// The two parts at a plane across an axis. They overlap by twice the margin.
    pub(super) fn split(&self, axis: usize, at: f64, inside: &impl Inside) -> [Self; 2] {
        let (mut high, mut low) = (self.high, self.low);
        high[axis] = at + CLIP_MARGIN;
        low[axis] = at - CLIP_MARGIN;
        let [below, above] = self.polygons.split(axis, at);
        [Self::new(self.low, high, below, inside), Self::new(low, self.high, above, inside)]
    }

    /// The points whose hull holds all of the solid that lies in the box: a corner of that is one of a polygon, or one of the box.
    pub(super) fn points(&self) -> Vec<DVec3> {
        self.polygons.corners().iter().copied().chain(self.inner_corners()).collect()
    }

    /// The corners of polygons that are vertices of the surface: those inside of the box.
    pub(super) fn vertices(&self) -> impl Iterator<Item = DVec3> {
        let is_inside = |p: &&DVec3| p.cmpgt(self.low).all() && p.cmplt(self.high).all();
        self.polygons.corners().iter().filter(is_inside).copied()
    }

    /// All other points whose hull holds all of the solid in the box, together with the vertices.
    pub(super) fn cut_points(&self) -> impl Iterator<Item = DVec3> {
        let is_on_side = |p: &&DVec3| !(p.cmpgt(self.low).all() && p.cmplt(self.high).all());
        self.polygons.corners().iter().filter(is_on_side).copied().chain(self.inner_corners())
    }

    /// The corners of the box that are inside, and the points inside that neither they nor polygons tell of.
    pub(super) fn inner_corners(&self) -> impl Iterator<Item = DVec3> {
        let inner = (0..8).filter(|k| self.corners[*k]).map(|k| corner(self.low, self.high, k));
        inner.chain(self.open.iter().copied())
    }

    /// The ends of the edges of the box.
    pub(super) fn edges(&self) -> impl Iterator<Item = (DVec3, DVec3)> {
        let at = |k: usize| corner(self.low, self.high, k);
        let ends = (0..8).flat_map(|k| (0..3).map(move |axis| (k, k | 1 << axis)));
        ends.filter(|(from, to)| from != to).map(move |(from, to)| (at(from), at(to)))
    }

    /// Whether there is nothing of the solid.
    pub(super) fn is_empty(&self) -> bool {
        self.polygons.is_empty() && self.open.is_empty() && !self.corners.contains(&true)
    }

    /// The volume of the solid in the box, by the divergence theorem from its low corner: sides through that add nothing, each other one a third of its height
    /// times what of it is inside.
    pub(super) fn volume(&self) -> f64 {
        let height = self.high - self.low;
        let mut volume = 0.0;
        // what of each high side is inside, and of each edge between two of them, along the axis
        let (mut areas, mut lengths) = (DVec3::ZERO, DVec3::ZERO);
        for (corners, _) in self.polygons.iter() {
            let normal = normal(corners);
            volume += normal.dot(corners[0] - self.low) / 2.0;
            for (k, a) in corners.iter().enumerate() {
                let b = corners[(k + 1) % corners.len()];
                let (is_high, next_is_high) = (a.cmpeq(self.high), b.cmpeq(self.high));
                let (p, q) = (*a - self.low, b - self.low);
                for axis in 0..3 {
                    if is_high.test(axis) && next_is_high.test(axis) {
                        // the side's boundary runs the other way
                        areas[axis] += q.cross(p)[axis] / 2.0;
                    }
                    if is_high.test((axis + 1) % 3) && is_high.test((axis + 2) % 3) {
                        lengths[axis] += p[axis].copysign(normal[axis]);
                    }
                }
            }
        }
        if self.corners[7] {
            lengths += height;
        }
        for axis in 0..3 {
            let (second, third) = ((axis + 1) % 3, (axis + 2) % 3);
            areas[axis] += (height[second] * lengths[third] + height[third] * lengths[second]) / 2.0;
        }
        (volume + height.dot(areas)) / 3.0
    }
}

/// The volume of the hull of points, about; none where it has none. All points are within a box of size 1.
pub(super) fn hull_volume(points: &[DVec3]) -> f64 {
    let Ok(triangles) = approximate_hull_triangles(points, HULL_TOUCHING) else { return 0.0 };
    let origin = points[triangles[0][0] as usize];
    let sum: f64 = triangles
        .iter()
        .map(|triangle| {
            let [a, b, c] = triangle.map(|corner| points[corner as usize] - origin);
            a.dot(b.cross(c))
        })
        .sum();
    sum / 6.0
}

/// Twice the area of a polygon times its unit normal.
pub(super) fn normal(corners: &[DVec3]) -> DVec3 {
    let first = corners[0];
    corners[1..].windows(2).map(|pair| (pair[0] - first).cross(pair[1] - first)).sum()
}

fn corner(low: DVec3, high: DVec3, number: usize) -> DVec3 {
    DVec3::from_array(std::array::from_fn(|axis| if number >> axis & 1 == 1 { high[axis] } else { low[axis] }))
}
