//! Whether two triangles of a mesh are in each other's way: cheap tests first, then the exact ones.

use glam::DVec3;

use crate::bvh::Aabb;
use crate::contact::{Contact, ContactKind};
use crate::edges::surfaces;
use crate::options::ROUNDING_F32;
use crate::parallel;
use crate::separation::{Triangle, interiors_cross, interiors_overlap, normal, overlap_depth, penetration_depth};
use crate::sheet::Sheets;

/// Depths are computed to within this part of the scale: less than thirty roundings of lengths up to twice the scale.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// The data of a mesh, made ready for testing many pairs of its triangles.
pub(crate) struct PairTest<'a> {
    positions: &'a [DVec3],
    /// Positions divided by `unit`, so that no product of them over- or underflows; lengths below are in these units.
    scaled: Vec<DVec3>,
    /// A power of two.
    unit: f64,
    triangles: &'a [[u32; 3]],
    twins: &'a [u32],
    planes: Vec<Plane>,
    /// Which surface each triangle belongs to.
    surfaces: Vec<u32>,
    /// Depths up to this do not count.
    limit: f64,
    /// How far a computed depth may be from the true one.
    slack: f64,
    /// Whether rounding to `f32` may have put a vertex as far away as depths that do not count.
    is_single: bool,
}

/// The computed plane of a triangle. Its direction may be badly wrong for a narrow triangle; `thickness` tells.
#[derive(Clone, Copy)]
struct Plane {
    /// Unit normal, or zero.
    normal: DVec3,
    /// Largest distance of a corner of the triangle from the computed plane; infinite where there is none.
    thickness: f64,
}

impl Plane {
    fn of(t: &Triangle) -> Self {
        let normal = normal(t).normalize_or_zero();
        let height = |p: DVec3| normal.dot(p - t[0]).abs();
        let thickness = if normal == DVec3::ZERO { f64::INFINITY } else { height(t[1]).max(height(t[2])) };
        Self { normal, thickness }
    }
}

/// Where one triangle lies with respect to the plane of another.
#[derive(Clone, Copy)]
struct Side {
    /// Least and largest height of the corners.
    low: f64,
    high: f64,
    /// Number of corners that may lie in the plane.
    near: usize,
    thickness: f64,
}

impl Side {
    fn of(guest: &Triangle, host: &Triangle, plane: Plane, limit: f64) -> Self {
        let heights = guest.map(|p| plane.normal.dot(p - host[0]));
        let near = heights.iter().filter(|h| h.abs() <= limit + plane.thickness).count();
        let low = heights[0].min(heights[1]).min(heights[2]);
        let high = heights[0].max(heights[1]).max(heights[2]);
        Self { low, high, near, thickness: plane.thickness }
    }

    /// The triangles are further apart than `limit`.
    fn is_apart(&self, limit: f64) -> bool {
        self.low > limit + self.thickness || self.high < -limit - self.thickness
    }

    /// The guest reaches through the plane by `limit` or less.
    fn is_shallow(&self, limit: f64) -> bool {
        self.thickness - self.low <= limit || self.high + self.thickness <= limit
    }
}

impl<'a> PairTest<'a> {
    pub(crate) fn new(positions: &'a [DVec3], triangles: &'a [[u32; 3]], twins: &'a [u32], tolerance: f64) -> Self {
        let unit = unit_of(positions, triangles);
        let scaled: Vec<DVec3> = positions.iter().map(|&p| p / unit).collect();
        let corners = |t: &[u32; 3]| t.map(|v| scaled[v as usize]);
        let extent = triangles.iter().fold(Aabb::EMPTY, |b, t| b.joined(Aabb::of_points(&corners(t))));
        let largest = extent.min.abs().max(extent.max.abs()).max_element();
        let scale = if triangles.is_empty() { 0.0 } else { extent.min.distance(extent.max).max(largest) };
        let planes = parallel::map(triangles.len(), |t| Plane::of(&corners(&triangles[t])));
        let (limit, slack) = (tolerance * scale, ROUNDING * scale);
        let is_single = tolerance >= ROUNDING_F32;
        let surfaces = surfaces(twins);
        Self { positions, unit, triangles, twins, planes, surfaces, limit, slack, is_single, scaled }
    }

    /// Depth up to which contacts do not count, in the units of the positions.
    pub(crate) fn limit(&self) -> f64 {
        self.limit * self.unit
    }

    /// How far apart triangles may be that have a contact, in the units of [`Self::scaled_corners`].
    pub(crate) fn margin(&self) -> f64 {
        self.limit.max(self.slack)
    }

    /// The positions, scaled so that no product of them over- or underflows.
    pub(crate) fn scaled(&self) -> &[DVec3] {
        &self.scaled
    }

    /// The corners of a triangle, scaled so that no product of them over- or underflows.
    pub(crate) fn scaled_corners(&self, triangle: usize) -> Triangle {
        self.corners(triangle, &self.scaled)
    }

    /// A box such that triangles whose boxes do not meet have no contact.
    pub(crate) fn bounds(&self, triangle: usize) -> Aabb {
        Aabb::of_points(&self.corners(triangle, &self.scaled)).grown(self.limit / 2.0)
    }

    fn corners(&self, triangle: usize, positions: &[DVec3]) -> Triangle {
        self.triangles[triangle].map(|v| positions[v as usize])
    }

    /// How two triangles are in each other's way. The same whichever comes first.
    pub(crate) fn contact(&self, t: u32, u: u32) -> Option<Contact> {
        if t == u {
            return None;
        }
        let (t, u) = (t.min(u) as usize, t.max(u) as usize);
        let (a, b) = (self.corners(t, &self.scaled), self.corners(u, &self.scaled));
        // Below the rounding error of depths only exact signs decide, and only what is surely apart may be passed over.
        let margin = self.limit.max(self.slack);
        let b_at_a = Side::of(&b, &a, self.planes[t], margin);
        let a_at_b = Side::of(&a, &b, self.planes[u], margin);
        if b_at_a.is_apart(margin) || a_at_b.is_apart(margin) {
            return None;
        }
        let found = |kind| move |depth: f64| Contact { kind, triangles: [t, u], depth: depth.max(0.0) * self.unit };
        let shallow = if self.is_exact() { -self.slack } else { self.limit };
        let crossing = || {
            if b_at_a.is_shallow(shallow) || a_at_b.is_shallow(shallow) {
                return None;
            }
            let depth = penetration_depth(&a, &b, shallow)?;
            interiors_cross(&self.corners(t, self.positions), &self.corners(u, self.positions)).then_some(depth)
        };
        let overlap = || if b_at_a.near == 3 || a_at_b.near == 3 { self.overlap(t, u, &a, &b) } else { None };
        let edge_crossing = || {
            // An edge of one must lie in the plane of the other. Neighbours across an edge have no sheets that could cross.
            let may_cross = (b_at_a.near >= 2 || a_at_b.near >= 2) && self.shared_corners(t, u) < 2;
            may_cross.then(|| Sheets::new(self.triangles, self.twins, &self.scaled).crossing(t, u, margin)).flatten()
        };
        crossing()
            .map(found(ContactKind::Crossing))
            .or_else(|| overlap().map(found(ContactKind::Overlap)))
            .or_else(|| edge_crossing().map(found(ContactKind::EdgeCrossing)))
    }

    fn is_exact(&self) -> bool {
        self.limit <= self.slack
    }

    fn shared_corners(&self, t: usize, u: usize) -> usize {
        self.triangles[t].iter().filter(|v| self.triangles[u].contains(v)).count()
    }

    /// The depth of an overlap in one plane.
    ///
    /// What the tolerance calls one plane may be solids and gaps thinner than that, which are sound. Two layers that face opposite ways bound
    /// one, where a move by less than the tolerance parts them: only where they are in one plane to the last digits they are two walls
    /// at one place. Layers that face the same way have a third one between them, or are of two bodies: no small move mends that once they meet.
    fn overlap(&self, t: usize, u: usize, a: &Triangle, b: &Triangle) -> Option<f64> {
        let [a_exact, b_exact] = [t, u].map(|triangle| self.corners(triangle, self.positions));
        if self.is_exact() {
            return interiors_overlap(&a_exact, &b_exact).then(|| overlap_depth(a, b, self.slack).unwrap_or(0.0));
        }
        let depth = overlap_depth(a, b, self.limit)?;
        let is_within = |distance: f64| overlap_depth(a, b, distance).is_some();
        let coincide = interiors_overlap(&a_exact, &b_exact);
        let is_one_surface = self.surfaces[t] == self.surfaces[u];
        let counts = if normal(a).dot(normal(b)) < 0.0 {
            // Sides of a fin or a gap stay apart when they are rounded to `f64`, be it by the last digit; rounding to `f32` may make them one.
            !self.is_single && (coincide || !is_one_surface && is_within(self.slack))
        } else {
            let may_be_fold = || self.is_single && is_one_surface && is_within(self.rounding(a, b));
            coincide || is_within(self.slack) || interiors_cross(&a_exact, &b_exact) || may_be_fold()
        };
        counts.then_some(depth)
    }

    /// How far apart rounding to `f32` may put what was in one plane.
    fn rounding(&self, a: &Triangle, b: &Triangle) -> f64 {
        let largest = a.iter().chain(b).fold(0.0, |m: f64, p| m.max(p.abs().max_element()));
        (ROUNDING_F32 * largest).max(self.slack)
    }
}

/// The power of two by which coordinates are divided to bring the largest between one and two; one where all are zero.
fn unit_of(positions: &[DVec3], triangles: &[[u32; 3]]) -> f64 {
    let corners = triangles.as_flattened().iter().map(|&v| positions[v as usize]);
    let largest = corners.fold(0.0, |m: f64, p| m.max(p.abs().max_element()));
    if largest < f64::MIN_POSITIVE {
        return 1.0;
    }
    // The exponent bits alone: the number rounded down to a power of two.
    f64::from_bits(largest.to_bits() & (0x7ff << 52))
}
