//! How far a point is from planes: the quadrics of Garland and Heckbert 1997, with the weights of Lindstrom 2000.

use planecut_kernel::DVec3;

/// The sum of squares of `n·(x − p)` over planes through `p` with normals `n`, as a function of `x`.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Quadric {
    /// Of the symmetric matrix: xx, yy, zz, xy, yz, zx.
    squares: [f64; 6],
    linear: DVec3,
    constant: f64,
    /// The sum of squares of normals.
    weight: f64,
}

impl Quadric {
    /// Adds a plane through a point, with the square of its normal's length as its weight.
    pub(super) fn add(&mut self, normal: DVec3, point: DVec3) {
        let offset = normal.dot(point);
        let DVec3 { x, y, z } = normal;
        for (square, more) in self.squares.iter_mut().zip([x * x, y * y, z * z, x * y, y * z, z * x]) {
            *square += more;
        }
        self.linear += normal * offset;
        self.constant += offset * offset;
        self.weight += normal.length_squared();
    }

    /// The weighted mean of squares of distances of a point from the planes; 0 where there are none.
    pub(super) fn mean_square(&self, at: DVec3) -> f64 {
        if self.weight == 0.0 {
            return 0.0;
        }
        let [xx, yy, zz, xy, yz, zx] = self.squares;
        let turned = DVec3::new(
            xx * at.x + xy * at.y + zx * at.z,
            xy * at.x + yy * at.y + yz * at.z,
            zx * at.x + yz * at.y + zz * at.z,
        );
        ((turned - 2.0 * self.linear).dot(at) + self.constant).max(0.0) / self.weight
    }
}

#[cfg(test)]
mod tests {
    use planecut_testkit::random::Rng;

    use super::*;

    #[test]
    fn distances_from_planes() {
        let mut rng = Rng::new(3);
        let planes: Vec<(DVec3, DVec3)> = (0..20).map(|_| (3.0 * rng.unit(), rng.point(-2.0, 2.0))).collect();
        let mut quadric = Quadric::default();
        planes.iter().for_each(|(normal, point)| quadric.add(*normal, *point));
        for _ in 0..100 {
            let at = rng.point(-2.0, 2.0);
            let squares = planes.iter().map(|(normal, point)| (normal.dot(at - *point) / 3.0).powi(2));
            let expected = squares.sum::<f64>() / planes.len() as f64;
            assert!((quadric.mean_square(at) - expected).abs() < 1e-12);
        }
    }
}
