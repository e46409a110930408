//! The edges of a polyhedron that need not be bounded: segments, rays and lines, not perturbed, exact.

use std::array::from_fn;
use std::collections::BTreeSet;

use dashu_int::IBig;
use dashu_ratio::RBig;

use crate::exact::{Coefficients, cross, dot, integer_row, normal, sign};

/// What is seen of a polyhedron with interior.
#[derive(Debug, Default)]
pub struct Edges {
    /// Segments, rays and lines.
    pub count: usize,
    /// End points of segments and rays.
    pub finite_ends: BTreeSet<[RBig; 3]>,
    /// Ends of rays and lines: one per ray and two per line, parallel ones counted apart.
    pub ideal_ends: usize,
}

/// The part of a line `p + t u` that violates no plane; `None` is unbounded.
struct Interval {
    low: Option<RBig>,
    high: Option<RBig>,
}

impl Edges {
    /// Tries the lines of all pairs of planes. The caller knows that there is interior.
    #[must_use]
    pub fn of(planes: &[Coefficients]) -> Self {
        let rows: Vec<[IBig; 4]> = planes.iter().map(|&p| integer_row(p)).collect();
        let normals: Vec<[IBig; 3]> = rows.iter().map(normal).collect();
        let mut edges = Self::default();
        let mut lines = BTreeSet::new();
        for j in 0..rows.len() {
            for i in 0..j {
                let u = cross(&normals[i], &normals[j]);
                if u.iter().any(|c| !c.is_zero()) {
                    let start = point_on(&rows[i], &rows[j], &u);
                    let Some((interval, through)) = clip(&rows, &normals, &start, &u) else { continue };
                    // The planes that contain a line name it: each line counts once.
                    if lines.insert(through) {
                        edges.count += 1;
                        edges.note_ends(&interval, &start, &u);
                    }
                }
            }
        }
        edges
    }

    fn note_ends(&mut self, interval: &Interval, start: &[RBig; 3], u: &[IBig; 3]) {
        for end in [&interval.low, &interval.high] {
            if let Some(t) = end {
                self.finite_ends.insert(from_fn(|i| &start[i] + t * RBig::from(u[i].clone())));
            } else {
                self.ideal_ends += 1;
            }
        }
    }
}

/// The point of both planes that is nearest to the origin: `(dᵢ (nⱼ × u) + dⱼ (u × nᵢ)) / |u|²`.
fn point_on(i: &[IBig; 4], j: &[IBig; 4], u: &[IBig; 3]) -> [RBig; 3] {
    let (a, b) = (cross(&normal(j), u), cross(u, &normal(i)));
    let square = RBig::from(dot(u, u));
    from_fn(|k| RBig::from(&i[3] * &a[k] + &j[3] * &b[k]) / &square)
}

/// The part of the line inside all planes and the planes that contain it; `None` where that is at most a point.
fn clip(rows: &[[IBig; 4]], normals: &[[IBig; 3]], start: &[RBig; 3], u: &[IBig; 3]) -> Option<(Interval, Vec<usize>)> {
    let mut interval = Interval { low: None, high: None };
    let mut through = Vec::new();
    for (h, n) in normals.iter().enumerate() {
        let height = (0..3).fold(RBig::ZERO, |sum, k| sum + RBig::from(n[k].clone()) * &start[k]);
        let room = RBig::from(rows[h][3].clone()) - height;
        let speed = dot(n, u);
        match (sign(&speed), sign(room.numerator())) {
            (0, -1) => return None,
            (0, 0) => through.push(h),
            (0, _) => {}
            (towards, _) => {
                let t = room / RBig::from(speed);
                if towards > 0 && interval.high.as_ref().is_none_or(|high| t < *high) {
                    interval.high = Some(t);
                } else if towards < 0 && interval.low.as_ref().is_none_or(|low| t > *low) {
                    interval.low = Some(t);
                }
            }
        }
    }
    let is_edge = interval.low.as_ref().zip(interval.high.as_ref()).is_none_or(|(low, high)| low < high);
    is_edge.then_some((interval, through))
}

#[test]
fn a_quarter_space_and_an_octant() {
    let quarter = Edges::of(&[[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0], [1.0, 1.0, 0.0, 2.0]]);
    assert_eq!((quarter.count, quarter.finite_ends.len(), quarter.ideal_ends), (1, 0, 2));
    let octant = Edges::of(&[[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0]]);
    assert_eq!((octant.count, octant.finite_ends.len(), octant.ideal_ends), (3, 1, 3));
}
