//! Boxes of any direction around points. Long, narrow triangles that lie beside each other have such boxes beside each other.

use glam::DVec3;

/// Added to the cosines between axes of two boxes: the cross product of almost parallel axes is rounding noise, and separates nothing.
const PARALLEL: f64 = 1e-9;

/// A box with three orthogonal axes of unit length.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Obb {
    centre: DVec3,
    axes: [DVec3; 3],
    half: DVec3,
}

impl Obb {
    /// A box around points, each grown by `margin`; along the greatest distance that two scans find (after Larsson and Källberg 2011).
    pub(crate) fn of_points(points: &[DVec3], margin: f64) -> Self {
        let first = points.first().copied().unwrap_or_default();
        let farthest = |measure: &dyn Fn(DVec3) -> f64| {
            let better = |best: (f64, DVec3), &p: &DVec3| if measure(p) > best.0 { (measure(p), p) } else { best };
            points.iter().fold((f64::NEG_INFINITY, first), better).1
        };
        let from = farthest(&|p| p.distance_squared(first));
        let to = farthest(&|p| p.distance_squared(from));
        let along = (to - from).try_normalize().unwrap_or(DVec3::X);
        let aside = farthest(&|p| (p - from).reject_from_normalized(along).length_squared());
        let any = along.any_orthonormal_vector();
        let across = (aside - from).reject_from_normalized(along).try_normalize().unwrap_or(any);
        // Once more, so that rounding of what was left over does not tilt it.
        let across = across.reject_from_normalized(along).try_normalize().unwrap_or(any);
        Self::along([along, across, along.cross(across)], points, margin)
    }

    fn along(axes: [DVec3; 3], points: &[DVec3], margin: f64) -> Self {
        let origin = points.first().copied().unwrap_or_default();
        let place = |p: DVec3| DVec3::from_array(axes.map(|axis| axis.dot(p - origin)));
        let (low, high) = points
            .iter()
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), &p| (low.min(place(p)), high.max(place(p))));
        let middle = (low + high) / 2.0;
        let centre = origin + axes[0] * middle.x + axes[1] * middle.y + axes[2] * middle.z;
        Self { centre, axes, half: (high - low) / 2.0 + margin }
    }

    /// The axes, of unit length.
    pub(crate) fn axes(&self) -> [DVec3; 3] {
        self.axes
    }

    /// The length of the longest side, halved.
    pub(crate) fn reach(&self) -> f64 {
        self.half.max_element()
    }

    /// False only where no point is in both (Gottschalk, Lin and Manocha 1996).
    pub(crate) fn meets(&self, other: &Self) -> bool {
        let t = other.centre - self.centre;
        let own = DVec3::from_array(self.axes.map(|axis| axis.dot(t)));
        let theirs = DVec3::from_array(other.axes.map(|axis| axis.dot(t)));
        let cosines = self.axes.map(|a| DVec3::from_array(other.axes.map(|b| a.dot(b))));
        let sizes = cosines.map(|row| row.abs() + PARALLEL);
        let is_apart_along_own = (0..3).any(|i| own[i].abs() > self.half[i] + other.half.dot(sizes[i]));
        let is_apart_along_theirs = (0..3).any(|j| {
            let reach = self.half.x * sizes[0][j] + self.half.y * sizes[1][j] + self.half.z * sizes[2][j];
            theirs[j].abs() > other.half[j] + reach
        });
        let is_apart_across = |i: usize, j: usize| {
            let (i1, i2, j1, j2) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
            let distance = own[i2] * cosines[i1][j] - own[i1] * cosines[i2][j];
            let of_own = self.half[i1] * sizes[i2][j] + self.half[i2] * sizes[i1][j];
            let of_theirs = other.half[j1] * sizes[i][j2] + other.half[j2] * sizes[i][j1];
            distance.abs() > of_own + of_theirs
        };
        !is_apart_along_own && !is_apart_along_theirs && !(0..9).any(|k| is_apart_across(k / 3, k % 3))
    }
}

#[cfg(test)]
mod tests {
    use planecut_testkit::random::Rng;

    use super::*;

    #[test]
    fn boxes_that_share_a_point_meet_and_distant_ones_do_not() {
        let seed = 0x5eed_0005;
        let mut random = Rng::new(seed);
        let mut apart = 0;
        for case in 0..20_000 {
            let mut cloud = |shared: DVec3| {
                let (turn, size) = (random.rotation(), random.point(0.0, 1.0).powf(6.0));
                let mut points: Vec<DVec3> = (0..3).map(|_| shared + turn * (random.point(-1.0, 1.0) * size)).collect();
                points[random.below(3)] = shared;
                points
            };
            let (a, b) = (cloud(DVec3::ZERO), cloud(DVec3::ZERO));
            let [box_a, box_b] = [&a, &b].map(|points| Obb::of_points(points, 1e-14));
            assert!(box_a.meets(&box_b) && box_b.meets(&box_a), "seed {seed:#x} case {case}: {a:?} {b:?}");
            let far: Vec<DVec3> = b.iter().map(|&p| p + DVec3::splat(0.7)).collect();
            let box_far = Obb::of_points(&far, 1e-14);
            assert_eq!(box_a.meets(&box_far), box_far.meets(&box_a), "seed {seed:#x} case {case}");
            apart += usize::from(!box_a.meets(&box_far));
        }
        assert!(apart > 5_000, "told apart {apart}");
    }
}
