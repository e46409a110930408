//! For each direction a face that a ray from the center of a body leaves by, or one near it.

use planecut_kernel::DVec3;

use crate::ids::{BodyFaceId, Id};

/// The sides of a cube around the center, each divided into squares; for the middle of each square the face behind it.
#[derive(Debug, Clone)]
pub(super) struct Directions {
    /// By which coordinates are multiplied, so that a long body is no longer than it is wide.
    scale: DVec3,
    /// Number of squares along an edge of the cube.
    squares: usize,
    /// By side, row and place in the row.
    faces: Vec<BodyFaceId>,
}

impl Directions {
    /// About as many as there are faces, of a body of a size along each axis. `find` gives the face in a direction, searched from one that is mostly near.
    pub(super) fn new(count: usize, size: DVec3, mut find: impl FnMut(DVec3, BodyFaceId) -> BodyFaceId) -> Self {
        // the root of a sixth, rounded
        let squares = (2 * count / 3).isqrt().midpoint(1);
        let scale = size.recip();
        let scale = if scale.is_finite() { scale } else { DVec3::ONE };
        let mut faces = Vec::with_capacity(6 * squares * squares);
        let mut last = BodyFaceId::from_index(0);
        let middle = |k: usize| (2 * k + 1) as f64 / squares as f64 - 1.0;
        for (side, row, place) in
            (0..6 * squares * squares).map(|k| (k / squares / squares, k / squares % squares, k % squares))
        {
            let mut direction = [0.0; 3];
            direction[side / 2] = if side % 2 == 0 { 1.0 } else { -1.0 };
            direction[(side / 2 + 1) % 3] = middle(row);
            direction[(side / 2 + 2) % 3] = middle(place);
            last = find(DVec3::from_array(direction) / scale, last);
            faces.push(last);
        }
        Self { scale, squares, faces }
    }

    /// A face in a direction or near it; any where this is no number.
    #[inline]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "squares are counted from zero, and any does for no number"
    )]
    pub(super) fn face(&self, direction: DVec3) -> BodyFaceId {
        let direction = (direction * self.scale).to_array();
        let [x, y, z] = direction.map(f64::abs);
        let (axis, largest) = if y > x { (1, y) } else { (0, x) };
        let (axis, largest) = if z > largest { (2, z) } else { (axis, largest) };
        let side = 2 * axis + usize::from(direction[axis] < 0.0);
        let half = 0.5 * self.squares as f64;
        let [row, place] = [1, 2].map(|next| {
            let square = half + direction[(axis + next) % 3] * (half / largest);
            (square as usize).min(self.squares - 1)
        });
        self.faces[(side * self.squares + row) * self.squares + place]
    }
}

#[cfg(test)]
mod tests {
    use planecut_testkit::random::Rng;

    use super::*;

    /// The face with the largest value in a direction, and that value.
    fn largest(duals: &[DVec3], direction: DVec3) -> (BodyFaceId, f64) {
        let values = BodyFaceId::all(duals.len()).zip(duals.iter().map(|dual| dual.dot(direction)));
        values.max_by(|(_, a), (_, b)| a.total_cmp(b)).expect("faces")
    }

    #[test]
    fn a_face_is_found_near_every_direction() {
        let mut rng = Rng::spread(32);
        let (mut found, mut asked) = (0, 0);
        for round in 0..60 {
            // balls, and the same as long or flat as they may be in a model
            let size = if round % 2 == 0 { DVec3::ONE } else { DVec3::new(1.0, 100.0, 1e-3) * rng.point(0.5, 2.0) };
            let count = 60 + 10 * round;
            let turn = rng.rotation();
            // evenly spread along a spiral from pole to pole
            let normal = |k: usize| {
                let z = 1.0 - (2 * k + 1) as f64 / count as f64;
                let (y, x) = (k as f64 * std::f64::consts::PI * (3.0 - 5.0_f64.sqrt())).sin_cos();
                turn * DVec3::new(x * (1.0 - z * z).sqrt(), y * (1.0 - z * z).sqrt(), z)
            };
            let duals: Vec<DVec3> = (0..count).map(|k| normal(k) / size).collect();
            let directions = Directions::new(count, size, |direction, _| largest(&duals, direction).0);
            for _ in 0..200 {
                let direction = rng.unit() * size;
                let (face, value) = largest(&duals, direction);
                let other = directions.face(direction);
                let other_value = duals[other.index()].dot(direction);
                assert!(other_value > 0.5 * value, "{duals:?} in {direction:?}: {other:?} in place of {face:?}");
                asked += 1;
                found += usize::from(other == face);
            }
            for nothing in [DVec3::ZERO, DVec3::NAN, DVec3::INFINITY, DVec3::new(0.0, f64::NAN, 1.0)] {
                assert!(directions.face(nothing).index() < count);
            }
        }
        assert!(3 * found > asked, "{found} of {asked}");
    }
}
