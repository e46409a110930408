//! The inside of a surface that is not closed, as generalized winding numbers tell.

use std::f64::consts::PI;

use planecut_kernel::DVec3;

use super::bounds;

/// Triangles of a leaf, at most.
const LEAF: usize = 8;
/// A node is one dipole from this many times its radius on (Barill, Dickson, Schmidt, Levin, Jacobson 2018, section 3.1).
const FAR: f64 = 2.0;

/// Generalized winding numbers: the solid angle of all triangles, seen from a point, over that of a sphere (Jacobson, Kavan, Sorkine-Hornung 2013).
#[derive(Debug)]
pub(super) struct SolidAngles {
    corners: Vec<[DVec3; 3]>,
    nodes: Vec<Node>,
}

#[derive(Debug)]
struct Node {
    /// The triangles.
    from: u32,
    to: u32,
    /// The second child; the first comes next. None of a leaf.
    second: Option<u32>,
    /// The sum of the areas, each times its unit normal.
    area: DVec3,
    /// The mean of the triangles' centres by area, and how far their corners are from there.
    center: DVec3,
    radius: f64,
}

impl SolidAngles {
    pub(super) fn new(positions: &[DVec3], triangles: &[[u32; 3]]) -> Self {
        let corners = triangles.iter().map(|triangle| triangle.map(|corner| positions[corner as usize])).collect();
        let mut angles = Self { corners, nodes: Vec::new() };
        if !triangles.is_empty() {
            angles.build(0, triangles.len());
        }
        angles
    }

    fn build(&mut self, from: usize, to: usize) {
        let own = &mut self.corners[from..to];
        let (mut area, mut center, mut sum) = (DVec3::ZERO, DVec3::ZERO, 0.0);
        for [a, b, c] in &*own {
            let of_one = (*b - *a).cross(*c - *a) / 2.0;
            area += of_one;
            center += of_one.length() * (*a + *b + *c) / 3.0;
            sum += of_one.length();
        }
        center = if sum > 0.0 { center / sum } else { own[0][0] };
        let radius = own.iter().flatten().map(|p| p.distance(center)).fold(0.0, f64::max);
        let number = self.nodes.len();
        self.nodes.push(Node { from: from as u32, to: to as u32, second: None, area, center, radius });
        if to - from <= LEAF {
            return;
        }
        let middle = |[a, b, c]: &[DVec3; 3]| *a + *b + *c;
        let (low, high) = bounds(own.iter().map(middle));
        let axis = (high - low).max_position();
        let half = own.len() / 2;
        own.select_nth_unstable_by(half, |a, b| middle(a)[axis].total_cmp(&middle(b)[axis]));
        self.build(from, from + half);
        self.nodes[number].second = Some(self.nodes.len() as u32);
        self.build(from + half, to);
    }

    /// How often the surface goes around a point, about.
    pub(super) fn around(&self, point: DVec3) -> f64 {
        if self.nodes.is_empty() { 0.0 } else { self.below(0, point) / (4.0 * PI) }
    }

    fn below(&self, number: usize, point: DVec3) -> f64 {
        let node = &self.nodes[number];
        let away = node.center - point;
        let distance = away.length();
        if distance > FAR * node.radius {
            return node.area.dot(away) / (distance * distance * distance);
        }
        match node.second {
            Some(second) => self.below(number + 1, point) + self.below(second as usize, point),
            None => self.corners[node.from as usize..node.to as usize].iter().map(|own| solid_angle(own, point)).sum(),
        }
    }
}

/// The solid angle of a triangle (van Oosterom, Strackee 1983); positive where the point sees it from behind.
fn solid_angle(corners: &[DVec3; 3], point: DVec3) -> f64 {
    let [a, b, c] = corners.map(|corner| corner - point);
    let [p, q, r] = [a, b, c].map(DVec3::length);
    let volume = a.dot(b.cross(c));
    let sum = p * q * r + a.dot(b) * r + b.dot(c) * p + c.dot(a) * q;
    2.0 * volume.atan2(sum)
}
