//! Principal axes of a symmetric matrix by Jacobi's rotations.

use glam::{DMat3, DVec3};

/// Rounds of three rotations each. They converge quadratically: three to five rounds do, whatever the matrix.
const ROUNDS: usize = 32;

/// The eigenvalues of a symmetric matrix, and a rotation whose columns are their axes (Jacobi 1846; Golub, Van Loan, *Matrix Computations*, 8.5).
pub(super) fn principal_axes(matrix: DMat3) -> (DVec3, DMat3) {
    let mut a = matrix.to_cols_array_2d();
    let mut axes = DMat3::IDENTITY.to_cols_array_2d();
    for _ in 0..ROUNDS {
        let mut is_diagonal = true;
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let size = a[p][p].abs().min(a[q][q].abs());
            if a[p][q].abs() <= f64::EPSILON * f64::EPSILON * size {
                continue;
            }
            is_diagonal = false;
            let (cosine, sine) = rotation(a[p][p], a[q][q], a[p][q]);
            turn(&mut a, p, q, cosine, sine);
            (a[p], a[q]) = (mixed(a[p], a[q], cosine, -sine), mixed(a[p], a[q], sine, cosine));
            (axes[p], axes[q]) = (mixed(axes[p], axes[q], cosine, -sine), mixed(axes[p], axes[q], sine, cosine));
            (a[p][q], a[q][p]) = (0.0, 0.0);
        }
        if is_diagonal {
            break;
        }
    }
    (DVec3::new(a[0][0], a[1][1], a[2][2]), DMat3::from_cols_array_2d(&axes))
}

/// Cosine and sine of the smaller angle that makes `[[pp, pq], [pq, qq]]` diagonal.
fn rotation(pp: f64, qq: f64, pq: f64) -> (f64, f64) {
    let tau = (qq - pp) / (2.0 * pq);
    let tangent =
        if tau >= 0.0 { 1.0 / (tau + (tau * tau + 1.0).sqrt()) } else { -1.0 / (tau.abs() + (tau * tau + 1.0).sqrt()) };
    let cosine = 1.0 / (tangent * tangent + 1.0).sqrt();
    (cosine, tangent * cosine)
}

/// Multiplies by the rotation from the right.
fn turn(a: &mut [[f64; 3]; 3], p: usize, q: usize, cosine: f64, sine: f64) {
    for row in a.iter_mut() {
        (row[p], row[q]) = (cosine * row[p] - sine * row[q], sine * row[p] + cosine * row[q]);
    }
}

/// `a` times `x` and `b` times `y` together.
fn mixed(x: [f64; 3], y: [f64; 3], a: f64, b: f64) -> [f64; 3] {
    std::array::from_fn(|k| a * x[k] + b * y[k])
}

#[cfg(test)]
mod tests {
    use planecut_testkit::random::Rng;

    use super::*;

    #[test]
    fn axes_are_a_rotation_that_gives_the_matrix_back() {
        let mut rng = Rng::new(3);
        for round in 0..2000 {
            let mut random = || rng.integer(-1000, 1000) as f64 / if round % 3 == 0 { 1000.0 } else { 1.0 };
            let [x, y, z] = [random(), random(), random()];
            let [xy, xz, yz] =
                if round % 5 == 0 { [0.0, 0.0, random() * 1e-9] } else { [random(), random(), random()] };
            let matrix = DMat3::from_cols_array_2d(&[[x, xy, xz], [xy, y, yz], [xz, yz, z]]);
            let (values, axes) = principal_axes(matrix);
            assert!((axes.determinant() - 1.0).abs() < 1e-14, "seed 3, round {round}");
            let back = axes * DMat3::from_diagonal(values) * axes.transpose();
            assert!(back.abs_diff_eq(matrix, 1e-14 * 6000.0), "seed 3, round {round}: {matrix}, {back}");
        }
    }
}
