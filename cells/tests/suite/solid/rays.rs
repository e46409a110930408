//! Rays against intervals worked out from the half-spaces of the tree.

use glam::DVec3;
use planecut_cells::{RayHit, Solid};
use planecut_csg::Brush;
use planecut_kernel::HalfSpace;

use planecut_testkit::random::Rng;
use planecut_testkit::scene::{Scene, ensure, ensure_eq, sweep};
use planecut_testkit::shape::{Kind, Shape, bounded, random_shape};

/// All parameters at which a ray crosses a plane of the tree, with the planes.
fn crossings(brushes: &[Brush], origin: DVec3, direction: DVec3) -> Vec<(f64, HalfSpace)> {
    let planes = brushes.iter().flat_map(|brush| &brush.faces).map(|face| face.half_space);
    let crossing = |plane: HalfSpace| {
        let t = (plane.offset() - plane.normal().dot(origin)) / plane.normal().dot(direction);
        (t.is_finite() && t > 0.0).then_some((t, plane))
    };
    let mut crossings: Vec<(f64, HalfSpace)> = planes.filter_map(crossing).collect();
    crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
    crossings
}

/// The first change of the tree's value along a ray, sampled between all crossings; `None` where some are too near to tell.
fn first_change(
    shape: &Shape,
    crossings: &[(f64, HalfSpace)],
    origin: DVec3,
    direction: DVec3,
) -> Option<Option<(f64, bool)>> {
    let mut times: Vec<f64> = crossings.iter().map(|(t, _)| *t).collect();
    times.dedup_by(|b, a| *b - *a < 1e-12 * *a);
    let ends = times.iter().copied().chain([times.last().copied().unwrap_or(0.0) + 1.0]);
    let (mut start, mut inside) = (0.0, shape.holds(origin)?);
    for end in ends {
        let value = shape.holds(origin + direction * (0.5 * (start + end)))?;
        if value != inside {
            return Some(Some((start, value)));
        }
        (start, inside) = (end, value);
    }
    Some(None)
}

fn judge(shape: &Shape) -> Result<(), String> {
    let solid = Solid::from_tree(&shape.tree());
    let brushes = shape.model().tree.into_brushes();
    let mut rng = Rng::spread(brushes.len() as u64);
    let mut asked = 0;
    for _ in 0..60 {
        let (origin, direction) = (rng.point(-8.0, 8.0), rng.unit() * rng.float(0.5, 3.0));
        let crossings = crossings(&brushes, origin, direction);
        let Some(expected) = first_change(shape, &crossings, origin, direction) else { continue };
        asked += 1;
        let found = solid.ray_cast(origin, direction);
        ensure_eq!(found.is_some(), expected.is_some(), format!("a hit from {origin} along {direction}"));
        let (Some(hit), Some((t, entering))) = (found, expected) else { continue };
        let RayHit { distance, point, normal, entering: enters, face } = hit;
        ensure_eq!(enters, entering, "entering");
        let expected = t * direction.length();
        ensure!((distance - expected).abs() < 1e-9 * (1.0 + expected), "distance {distance}, expected {expected}");
        ensure!((point - origin - direction * t).length() < 1e-9, "point {point}");
        ensure!((normal.dot(direction) < 0.0) == entering, "normal {normal} along {direction}");
        let (brush, number) = face.brush_face.ok_or("no brush")?;
        let source = brushes[brush as usize].faces[number as usize];
        let outside = brushes[brush as usize].faces.iter().map(|face| face.half_space.signed_distance(point));
        ensure!(outside.fold(0.0, f64::max) < 1e-8, "brush {brush} lies elsewhere than {point}");
        ensure!(source.half_space.signed_distance(point).abs() < 1e-9, "the face lies elsewhere");
        ensure_eq!(face.material, source.material, "material");
    }
    ensure!(asked > 20, "only {asked} rays were clear");
    Ok(())
}

#[test]
fn rays_find_the_first_change_of_the_tree() {
    for (kind, count) in [(Kind::Boxes, 80), (Kind::Sloped, 60), (Kind::Turned, 40), (Kind::Mixed, 60)] {
        let generate = |rng: &mut Rng| {
            let leaves = 1 + rng.below(8);
            bounded(random_shape(rng, kind, leaves))
        };
        sweep(count, generate, judge);
    }
}

#[test]
fn walls_between_cells_stop_no_ray() {
    let row = (0..40).map(|k| {
        planecut_testkit::scene::cuboid(
            DVec3::new(f64::from(k) * 0.1, 0.0, 0.0),
            DVec3::new(f64::from(k + 1) * 0.1, 1.0, 1.0),
        )
    });
    let solid = row.map(Solid::from).reduce(|a, b| &a | &b).expect("some boxes");
    let direction = DVec3::new(1.0, 0.01, 0.003);
    let hit = solid.ray_cast(DVec3::new(-1.0, 0.2, 0.3), direction).expect("it enters");
    assert!(hit.entering && (hit.point.x).abs() < 1e-15);
    let hit = solid.ray_cast(DVec3::new(0.05, 0.2, 0.3), direction).expect("it leaves");
    assert!(!hit.entering && (hit.point.x - 4.0).abs() < 1e-12, "{hit:?}");
    assert_eq!(solid.ray_cast(DVec3::splat(5.0), DVec3::X), None);
    assert_eq!(solid.ray_cast(DVec3::splat(f64::NAN), DVec3::X), None);
}
