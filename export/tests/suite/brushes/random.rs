//! Random bodies at odd scales and places.

use planecut_csg::{Brush, MaterialId};
use planecut_export::BrushFormat;
use planecut_kernel::{DVec3, HalfSpace};
use planecut_shapes::primitives;
use planecut_testkit::random::Rng;

use super::support::{back, body, extent, polygons, volume};

/// What rounding may add to a body's planes, in roundings of its largest coordinate: each point is off by one, and no corner of a
/// face is farther outside of the largest triangle than that is wide.
const ROUNDINGS: f64 = 8.0 * f64::EPSILON;

fn direction(random: &mut Rng) -> DVec3 {
    loop {
        let v = DVec3::from([(); 3].map(|()| random.float(-1.0, 1.0)));
        if (0.01..1.0).contains(&v.length_squared()) {
            return v.normalize();
        }
    }
}

/// A body of up to twenty planes around a place that may be far from the origin.
fn random_body(random: &mut Rng) -> Brush {
    let size = 10f64.powf(random.float(-3.0, 4.0));
    let center = direction(random) * size * 10f64.powf(random.float(-1.0, 3.0));
    let more = random.float(0.0, 15.0) as usize;
    let mut normals: Vec<DVec3> = DVec3::AXES.iter().flat_map(|axis| [*axis, -*axis]).collect();
    let turn = random.float(0.0, 3.0);
    normals
        .iter_mut()
        .for_each(|normal| *normal = glam::DMat3::from_axis_angle(DVec3::ONE.normalize(), turn) * *normal);
    normals.extend((0..more).map(|_| direction(random)));
    let half_spaces = normals.into_iter().map(|normal| {
        let normal = normal * random.float(0.1, 10.0);
        let offset = normal.dot(center) + normal.length() * size * random.float(0.5, 1.0);
        HalfSpace::new(normal, offset).expect("in range")
    });
    Brush::from_half_spaces(half_spaces.collect::<Vec<_>>(), MaterialId(0))
}

/// The volume comes back to within rounding, which counts for more where a body is thin beside its coordinates.
fn assert_same_volume(before: &Brush, after: &Brush, scale: f64, context: &str) {
    let before = body(before);
    let (reach, thickness) = extent(&before);
    let (expected, found) = (volume(&before) * scale.powi(3), volume(&body(after)));
    let tolerance = 1e-13 * (1.0 + reach / thickness);
    assert!((found - expected).abs() <= tolerance * expected, "{context}: {found} for {expected}");
}

#[test]
fn random_bodies_come_back() {
    for seed in 0..400 {
        let mut random = Rng::new(seed);
        let brush = random_body(&mut random);
        let scale = if seed % 2 == 0 { 1.0 } else { 10f64.powf(random.float(-4.0, 4.0)) };
        // what OpenSCAD's own grid has no room for is another test's
        for (format, scale) in [(BrushFormat::Map, scale), (BrushFormat::Scad, scale.max(0.02))] {
            let context = format!("seed {seed}, scale {scale}, {format:?}");
            let [after] = &back(std::slice::from_ref(&brush), format, scale)[..] else { panic!("{context}: one body") };
            assert_same_volume(&brush, after, scale, &context);
        }
    }
}

/// The planes of a map are those of the body, in its order, as near as rounded points allow.
#[test]
fn planes_of_random_bodies_are_as_near_as_rounding_allows() {
    for seed in 0..400 {
        let brush = random_body(&mut Rng::new(seed));
        let before = body(&brush);
        let (reach, _) = extent(&before);
        let after = &back(std::slice::from_ref(&brush), BrushFormat::Map, 1.0)[0];
        let faces = polygons(&before);
        assert_eq!(after.faces.len(), faces.len(), "seed {seed}");
        for (face, corners) in after.faces.iter().zip(&faces) {
            let off = corners.iter().map(|corner| face.half_space.signed_distance(*corner).abs()).fold(0.0, f64::max);
            assert!(off <= ROUNDINGS * reach, "seed {seed}: {off} off at coordinates of {reach}");
        }
    }
}

/// Walls along an axis stay along it, exactly, wherever they are and however narrow.
#[test]
fn walls_stay_upright() {
    for seed in 0..200 {
        let mut random = Rng::new(seed);
        let axis = seed as usize % 3;
        let (size, height) = (10f64.powf(random.float(-2.0, 3.0)), random.float(0.01, 100.0));
        let center = direction(&mut random) * size * random.float(0.0, 100.0);
        let tilted = direction(&mut random) * 0.1;
        let lids = [DVec3::AXES[axis] + tilted, -DVec3::AXES[axis]].map(|normal| (normal, height));
        let count = 3.0 + random.float(0.0, 300.0).floor();
        let walls = (0..count as usize).map(|k| {
            let (sine, cosine) = (k as f64 * std::f64::consts::TAU / count + 0.1).sin_cos();
            let mut normal = DVec3::ZERO;
            (normal[(axis + 1) % 3], normal[(axis + 2) % 3]) = (cosine, sine);
            (normal, size)
        });
        let half_spaces = lids.into_iter().chain(walls).map(|(normal, away)| {
            HalfSpace::new(normal, normal.dot(center) + away * normal.length()).expect("in range")
        });
        let brush = Brush::from_half_spaces(half_spaces.collect::<Vec<_>>(), MaterialId(0));
        let before = body(&brush);
        let upright = |half_space: &HalfSpace| half_space.normal()[axis] == 0.0;
        let expected: Vec<bool> = before
            .planes()
            .filter(|(plane, _)| before.face_polygon(*plane).is_some())
            .map(|(_, half_space)| upright(half_space))
            .collect();
        let after = &back(std::slice::from_ref(&brush), BrushFormat::Map, 1.0)[0];
        let found: Vec<bool> = after.faces.iter().map(|face| upright(&face.half_space)).collect();
        assert_eq!(found, expected, "seed {seed}");
        assert_same_volume(&brush, after, 1.0, &format!("seed {seed}"));
    }
}

/// Many faces at one corner, faces that are narrow, faces that are nearly parallel.
#[test]
fn round_shapes_come_back() {
    let material = MaterialId(0);
    let shapes = [
        primitives::sphere(3.3, 30, material),
        primitives::sphere(1e-3, 7, material),
        primitives::cylinder(0.1, 20.0, 20.0, 200, material),
        primitives::cylinder(50.0, 7.0, 0.0, 64, material),
        primitives::cylinder(1e4, 1.0, 1.001, 90, material),
    ];
    for (number, shape) in shapes.into_iter().enumerate() {
        let brush = shape.expect("a shape");
        for format in BrushFormat::ALL {
            for scale in [1.0, 0.0254, 39.37] {
                let context = format!("shape {number}, scale {scale}, {format:?}");
                let [after] = &back(std::slice::from_ref(&brush), format, scale)[..] else {
                    panic!("{context}: one body")
                };
                assert_same_volume(&brush, after, scale, &context);
            }
        }
    }
}

/// A face so narrow that its own corners would let its plane tilt: the edge of a block, broken by a hair.
#[test]
fn planes_of_narrow_faces_do_not_tilt() {
    for seed in 0..100 {
        let mut random = Rng::new(seed);
        let mut brush = random_body(&mut random);
        let whole = body(&brush);
        let (reach, thickness) = extent(&whole);
        let normal = direction(&mut random);
        let farthest = whole.to_mesh().0.iter().map(|corner| corner.dot(normal)).fold(f64::NEG_INFINITY, f64::max);
        let offset = farthest - 1e-9 * thickness.max(1e-3 * reach);
        brush.faces.push(planecut_csg::BrushFace {
            half_space: HalfSpace::new(normal, offset).expect("in range"),
            material: MaterialId(1),
        });
        let after = &back(std::slice::from_ref(&brush), BrushFormat::Map, 1.0)[0];
        let narrow = after.faces.last().expect("faces").half_space;
        let tilt = narrow.normal().normalize().distance(normal);
        assert!(tilt <= 1e-3 * ROUNDINGS.sqrt(), "seed {seed}: tilted by {tilt}");
        assert_same_volume(&brush, after, 1.0, &format!("seed {seed}"));
    }
}
