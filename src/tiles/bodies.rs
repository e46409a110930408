//! Small closed bodies that stand for what became a segment or a point.

use planecut_kernel::DVec3;

/// Octahedra and prisms have at most this part of a cell as their radius, and at least the other.
const RADII: [f64; 2] = [1.0 / 64.0, 1.0 / 8.0];

/// The least radius in steps: less than that cannot be told from nothing.
const LEAST_STEPS: f64 = 2.0;

/// How large bodies may be: all are multiples of the step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sizes {
    step: f64,
    least: f64,
    most: f64,
}

/// A closed body: positions, and triangles that are counter-clockwise seen from outside.
pub(super) type Body = (Vec<DVec3>, Vec<[u32; 3]>);

impl Sizes {
    /// For cells of a size, and coordinates that are multiples of a step.
    pub(super) fn new(cell: f64, step: f64) -> Self {
        let [least, most] = RADII.map(|part| (cell * part / step).floor().max(LEAST_STEPS) * step);
        Self { step, least, most }
    }

    fn near(&self, radius: f64) -> f64 {
        ((radius / self.step).round() * self.step).clamp(self.least, self.most)
    }

    /// An octahedron around a point with an area, where that is possible; its radius too.
    pub(super) fn octahedron(&self, at: DVec3, area: f64) -> (Body, f64) {
        // eight triangles with edges of √2 r
        let radius = self.near((area / (4.0 * 3_f64.sqrt())).sqrt());
        let positions = DVec3::AXES.iter().flat_map(|axis| [at + axis * radius, at - axis * radius]).collect();
        // +x, -x, +y, -y, +z, -z
        let triangles = vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
        ((positions, triangles), radius)
    }

    /// A prism around a segment with an area, where that is possible, and a radius: no point of it is farther from the segment.
    pub(super) fn prism(&self, [from, to]: [DVec3; 2], area: f64) -> (Body, f64) {
        let along = to - from;
        // the section has edges of 1.41, 1.84 and 1.84 times the radius
        let radius = self.near(area / (5.1 * along.length()));
        let long = along.abs().max_position();
        let [mut first, mut second] = [1, 2].map(|next| DVec3::AXES[(long + next) % 3]);
        if along[long] < 0.0 {
            (first, second) = (second, first);
        }
        // 0.7 is less than half the root of 2, and a multiple of the step is near
        let back = (0.7 * radius / self.step).floor() * self.step;
        let section = [first * radius, second * radius, -(first + second) * back];
        let positions = [from, to].iter().flat_map(|end| section.map(|corner| *end + corner)).collect();
        let mut triangles = vec![[2, 1, 0], [3, 4, 5]];
        for (k, next) in [(0, 1), (1, 2), (2, 0)] {
            triangles.extend([[k, next, next + 3], [k, next + 3, k + 3]]);
        }
        ((positions, triangles), radius)
    }
}

#[cfg(test)]
mod tests {
    use planecut_check::{check_topology, measure_triangles};
    use planecut_testkit::random::Rng;

    use super::*;

    #[test]
    fn bodies_are_closed_and_their_outside_is_outside() {
        let mut rng = Rng::new(11);
        let sizes = Sizes::new(16.0, 0.125);
        let check = |(positions, triangles): &Body| {
            let topology = check_topology(positions, triangles);
            assert!(topology.watertight && topology.manifold);
            assert!(measure_triangles(positions, triangles).expect("measured").volume > 0.0);
        };
        for _ in 0..200 {
            let [from, to] = [rng.point(-50.0, 50.0), rng.point(-50.0, 50.0)].map(|at| at.round());
            let area = rng.float(0.0, 30.0);
            let (body, radius) = sizes.octahedron(from, area);
            check(&body);
            assert!((0.25..=2.0).contains(&radius) && body.0.iter().all(|corner| corner.distance(from) <= radius));
            let (body, radius) = sizes.prism([from, to], area);
            check(&body);
            assert!((0.25..=2.0).contains(&radius));
            assert!(body.0[..3].iter().all(|corner| corner.distance(from) <= radius));
            assert!(body.0[3..].iter().all(|corner| corner.distance(to) <= radius));
            assert!(body.0.iter().all(|corner| (*corner * 8.0).fract() == DVec3::ZERO));
        }
    }
}
