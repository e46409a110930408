//! The largest ball: inside, and held by planes whose normals balance.

use planecut_kernel::DVec3;

use super::cases;
use super::truth::{planes, rational, solve, subsets, support, vector};

/// Relative to the distance of the planes from each other.
const TOLERANCE: f64 = 1e-13;

#[test]
fn balls_are_inside_and_as_large_as_can_be() {
    let (mut finite, mut infinite) = (0, 0);
    for case in cases::any(600) {
        let polytope = case.polytope();
        let Some(ball) = polytope.chebyshev_ball() else {
            assert!(polytope.is_empty(), "{}", case.report("no ball"));
            continue;
        };
        let report = || case.report(&format!("{ball:?}"));
        let unit: Vec<(DVec3, f64)> = case
            .planes
            .iter()
            .map(|&[x, y, z, d]| {
                let (n, length) = (DVec3::new(x, y, z), DVec3::new(x, y, z).length());
                (n / length, d / length)
            })
            .collect();
        let room: Vec<f64> = unit.iter().map(|(n, d)| d - n.dot(ball.center)).collect();
        let largest = unit.iter().map(|(_, d)| d.abs()).fold(ball.center.length(), f64::max);
        let tolerance = TOLERANCE * (1.0 + largest);
        if ball.radius.is_infinite() {
            // some direction leads away from all planes: no combination of normals is zero
            infinite += 1;
            assert!(room.iter().all(|room| *room > -tolerance), "{}", report());
            assert!(!balance(&case.planes, 0..case.planes.len()), "{}", report());
            continue;
        }
        finite += 1;
        assert!(room.iter().all(|room| *room >= ball.radius - tolerance), "{}", report());
        // Optimal by duality: the touched planes have a non-negative combination of normals that is zero.
        let touched: Vec<usize> = (0..room.len()).filter(|i| room[*i] <= ball.radius + tolerance).collect();
        assert!(nearly_balance(&unit, &touched), "touches {touched:?} {}", report());
    }
    assert!(finite > 200 && infinite > 50, "{finite} finite, {infinite} infinite");
}

/// Whether a positive combination of normals is zero, exactly: then the opposite of one is in the cone of others.
fn balance(coefficients: &[[f64; 4]], among: std::ops::Range<usize>) -> bool {
    let all = planes(coefficients);
    among.into_iter().any(|i| support(&all, &vector([0, 1, 2].map(|k| -coefficients[i][k]))).is_some())
}

/// Whether some two to four unit normals have a convex combination of nearly zero.
fn nearly_balance(unit: &[(DVec3, f64)], touched: &[usize]) -> bool {
    subsets(touched.len(), 4).into_iter().filter(|subset| subset.len() > 1).any(|subset| {
        // the weights that make |Σ wᵢ·uᵢ| least with sum one: (G + 1·1ᵀ)·w ∝ 1, G the Gram matrix
        let normals: Vec<DVec3> = subset.iter().map(|i| unit[touched[*i]].0).collect();
        let columns: Vec<[dashu_ratio::RBig; 4]> = (0..normals.len())
            .map(|i| std::array::from_fn(|j| normals.get(j).map_or(0.0, |n| n.dot(normals[i]) + 1.0)).map(rational))
            .collect();
        let ones = std::array::from_fn(|j| rational(if j < normals.len() { 1.0 } else { 0.0 }));
        let Some(weights) = solve(&columns, &ones) else { return false };
        let weights: Vec<f64> = weights.iter().map(|w| w.to_f64().value()).collect();
        let total: f64 = weights.iter().sum();
        let sum = normals.iter().zip(&weights).fold(DVec3::ZERO, |sum, (n, w)| sum + *n * (*w / total));
        weights.iter().all(|w| *w >= -1e-6 * total) && sum.length() < 1e-6
    })
}
