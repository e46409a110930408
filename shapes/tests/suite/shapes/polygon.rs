//! Polygons, worked out from their corners.

use glam::DVec2;

use planecut_testkit::random::Rng;

/// The area of a regular polygon of `n` corners on a circle.
pub(crate) fn regular_area(n: u32, radius: f64) -> f64 {
    0.5 * f64::from(n) * radius * radius * (std::f64::consts::TAU / f64::from(n)).sin()
}

pub(crate) fn edges(corners: &[DVec2]) -> impl Iterator<Item = (DVec2, DVec2)> + '_ {
    (0..corners.len()).map(|k| (corners[k], corners[(k + 1) % corners.len()]))
}

pub(crate) fn area(loops: &[Vec<DVec2>]) -> f64 {
    loops.iter().flat_map(|corners| edges(corners)).map(|(p, q)| 0.5 * p.perp_dot(q)).sum()
}

/// `∫ x dA`.
pub(crate) fn first_moment(loops: &[Vec<DVec2>]) -> f64 {
    loops.iter().flat_map(|corners| edges(corners)).map(|(p, q)| p.perp_dot(q) * (p.x + q.x) / 6.0).sum()
}

/// Whether a point lies within an odd number of loops.
pub(crate) fn contains(loops: &[Vec<DVec2>], point: DVec2) -> bool {
    let crosses = |(p, q): (DVec2, DVec2)| {
        (p.y > point.y) != (q.y > point.y) && point.x < p.x + (point.y - p.y) / (q.y - p.y) * (q.x - p.x)
    };
    loops.iter().flat_map(|corners| edges(corners)).filter(|edge| crosses(*edge)).count() % 2 == 1
}

/// The distance from the loops.
pub(crate) fn distance(loops: &[Vec<DVec2>], point: DVec2) -> f64 {
    let from = |(p, q): (DVec2, DVec2)| {
        let along = q - p;
        point.distance(p + along * ((point - p).dot(along) / along.length_squared()).clamp(0.0, 1.0))
    };
    loops.iter().flat_map(|corners| edges(corners)).map(from).fold(f64::INFINITY, f64::min)
}

/// A star-shaped loop about a point, counter-clockwise, of 3 to `most` corners between `low` and `high` away.
pub(crate) fn random_star(rng: &mut Rng, most: usize, center: DVec2, low: f64, high: f64) -> Vec<DVec2> {
    let n = 3 + rng.below(most - 2);
    let step = std::f64::consts::TAU / n as f64;
    let start = rng.float(0.0, std::f64::consts::TAU);
    let corner = |k: usize, rng: &mut Rng| {
        let angle = start + step * (k as f64 + rng.float(-0.3, 0.3));
        center + DVec2::from_angle(angle) * rng.float(low, high)
    };
    (0..n).map(|k| corner(k, rng)).collect()
}

/// A star with up to two holes in it, the holes clockwise.
pub(crate) fn random_region(rng: &mut Rng, most: usize, center: DVec2) -> Vec<Vec<DVec2>> {
    let mut loops = vec![random_star(rng, most, center, 1.0, 2.0)];
    // far enough inside: a triangle's sides are half as far away as its corners, or nearer where it is not regular
    for k in 0..rng.below(3) {
        let at = center + DVec2::new(0.1 * (k as f64 - 0.5) * 2.0, 0.0);
        let mut hole = random_star(rng, 6, at, 0.02, 0.07);
        hole.reverse();
        loops.push(hole);
    }
    let clear = |hole: &Vec<DVec2>| hole.iter().all(|p| contains(&loops[..1], *p) && distance(&loops[..1], *p) > 0.01);
    let is_clear = loops[1..].iter().all(clear);
    loops.truncate(if is_clear { loops.len() } else { 1 });
    loops
}
