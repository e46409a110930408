//! Recession cones and witnesses of emptiness.

use dashu_ratio::RBig;
use planecut_kernel::DVec3;

use super::cases;
use super::truth::{Vector, cross, dot, is_zero, planes, solve, subsets};

/// Directions of all extreme rays of a pointed cone, from all pairs of planes.
fn extreme_rays(normals: &[Vector]) -> Vec<Vector> {
    let mut rays: Vec<Vector> = Vec::new();
    for pair in subsets(normals.len(), 2).into_iter().filter(|pair| pair.len() == 2) {
        let along = cross(&normals[pair[0]], &normals[pair[1]]);
        for ray in [along.clone(), along.map(|v| -v)] {
            let inside = !is_zero(&ray) && normals.iter().all(|n| dot(n, &ray) <= RBig::ZERO);
            if inside && !rays.iter().any(|r| is_zero(&cross(r, &ray)) && dot(r, &ray) > RBig::ZERO) {
                rays.push(ray);
            }
        }
    }
    rays
}

fn rank(normals: &[Vector]) -> usize {
    let independent = |subset: &Vec<usize>| match subset.as_slice() {
        [_] => true,
        [a, b] => !is_zero(&cross(&normals[*a], &normals[*b])),
        [a, b, c] => dot(&normals[*a], &cross(&normals[*b], &normals[*c])) != RBig::ZERO,
        _ => false,
    };
    subsets(normals.len(), 3).iter().filter(|s| independent(s)).map(Vec::len).max().unwrap_or(0)
}

#[test]
fn recession_cones() {
    let mut ranks = [0usize; 4];
    for case in cases::any(800) {
        let polytope = case.polytope();
        let cone = polytope.recession_cone();
        let report = || case.report(&format!("{cone:?}"));
        if polytope.is_empty() {
            assert!(cone.rays.is_empty() && cone.lines.is_empty(), "{}", report());
            continue;
        }
        let normals: Vec<Vector> = planes(&case.planes).into_iter().map(|plane| plane.n).collect();
        let rank = rank(&normals);
        ranks[rank] += 1;
        assert_eq!(cone.lines.len(), 3 - rank, "{}", report());
        let unit: Vec<DVec3> = case.planes.iter().map(|p| DVec3::new(p[0], p[1], p[2]).normalize()).collect();
        for line in &cone.lines {
            assert!(unit.iter().all(|n| n.dot(*line).abs() < 1e-14), "{}", report());
        }
        for ray in &cone.rays {
            assert!((ray.length() - 1.0).abs() < 1e-14 && unit.iter().all(|n| n.dot(*ray) < 1e-14), "{}", report());
            assert!(cone.lines.iter().all(|line| line.dot(*ray).abs() < 1e-14), "{}", report());
        }
        let expected = match rank {
            // closing the lines by planes at right angles to them leaves a pointed cone with the same rays
            3 => extreme_rays(&normals).len(),
            2 => {
                let pair = subsets(normals.len(), 2)
                    .into_iter()
                    .find(|p| p.len() == 2 && !is_zero(&cross(&normals[p[0]], &normals[p[1]])));
                let pair = pair.expect("the rank is two");
                let line = cross(&normals[pair[0]], &normals[pair[1]]);
                let mut closed = normals.clone();
                closed.extend([line.clone(), line.map(|v| -v)]);
                extreme_rays(&closed).len()
            }
            1 => usize::from(!normals.iter().any(|n| dot(n, &normals[0]) < RBig::ZERO)),
            _ => 0,
        };
        assert_eq!(cone.rays.len(), expected, "{}", report());
    }
    assert!(ranks.iter().all(|n| *n > 10), "sets by rank: {ranks:?}");
}

#[test]
fn witnesses_are_minimal_and_prove_emptiness() {
    let mut empty = 0;
    for mut case in cases::any(1500) {
        if case.rng.chance(0.5) {
            let copy = case.planes.first().copied();
            case.planes.extend(copy.map(|[x, y, z, d]| [-x, -y, -z, -d - 0.25]));
        }
        let polytope = case.polytope();
        let witness = polytope.emptiness_witness();
        assert_eq!(witness.is_some(), polytope.is_empty());
        let Some(witness) = witness else { continue };
        empty += 1;
        let report = || case.report(&format!("{witness:?}"));
        let all = planes(&case.planes);
        assert!((2..=4).contains(&witness.len()), "{}", report());
        // −n of the last is a positive combination of the others, which are independent: none can be left out
        let (last, rest) = witness.split_last().expect("not empty");
        let normals: Vec<Vector> = rest.iter().map(|p| all[p.0].n.clone()).collect();
        let weights = solve(&normals, &all[last.0].n.clone().map(|v| -v)).unwrap_or_else(|| panic!("{}", report()));
        assert!(weights.iter().all(|w| *w > RBig::ZERO), "{}", report());
        let offset = rest.iter().zip(weights).fold(all[last.0].d.clone(), |sum, (p, w)| sum + w * &all[p.0].d);
        assert!(offset <= RBig::ZERO, "{}", report());
    }
    assert!(empty > 100, "{empty} empty sets");
}
