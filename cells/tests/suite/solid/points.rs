//! Distances, against a search over the half-spaces of the tree.

use glam::DVec3;
use planecut_cells::Solid;

use planecut_testkit::random::Rng;
use planecut_testkit::scene::{ensure, ensure_eq, sweep};
use planecut_testkit::shape::{Kind, Shape, bounded, random_shape};

/// The closest point belongs to the solid, lies as far away as is told, and no point nearer belongs to the tree.
fn judge(shape: &Shape) -> Result<(), String> {
    let solid = Solid::from_tree(&shape.tree());
    let mut rng = Rng::spread(solid.cells().count() as u64);
    for _ in 0..20 {
        let point = rng.point(-9.0, 9.0);
        let Some((closest, distance)) = solid.closest_point(point) else {
            ensure!(solid.is_empty() && solid.distance(point) == f64::INFINITY, "no closest point");
            continue;
        };
        ensure_eq!(solid.distance(point), distance, "distance");
        ensure!((closest.distance(point) - distance).abs() < 1e-12 * (1.0 + distance), "distance {distance}");
        ensure_eq!(distance == 0.0, solid.contains(point), "no distance inside");
        let nearly = [1e-9, -1e-9].map(|step| closest + (closest - point).normalize_or_zero() * step);
        ensure!(distance == 0.0 || !solid.contains(nearly[1]), "a nearer point is inside");
        for _ in 0..200 {
            let other = point + rng.unit() * distance * rng.float(0.0, 0.999);
            ensure!(shape.holds(other) != Some(true) || distance == 0.0, "{other} is nearer to {point}");
        }
    }
    Ok(())
}

#[test]
fn no_point_of_the_tree_is_nearer_than_the_closest() {
    for kind in [Kind::Boxes, Kind::Sloped, Kind::Turned] {
        let generate = |rng: &mut Rng| {
            let leaves = 1 + rng.below(5);
            bounded(random_shape(rng, kind, leaves))
        };
        sweep(50, generate, judge);
    }
}

#[test]
fn what_is_not_finite_is_nowhere() {
    let solid = Solid::from(planecut_testkit::scene::cuboid(DVec3::ZERO, DVec3::ONE));
    assert!(!solid.contains(DVec3::NAN) && solid.distance(DVec3::NAN).is_nan());
    assert_eq!(solid.closest_point(DVec3::INFINITY), None);
    assert_eq!(solid.distance(DVec3::new(2.0, 0.5, 0.5)), 1.0);
}
