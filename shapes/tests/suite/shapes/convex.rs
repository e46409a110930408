//! Convex bodies against formulas.

use glam::DVec3;
use planecut_csg::{Brush, MaterialId, Tree};
use planecut_shapes::primitives::{
    RegularSolid, body_of_half_spaces, capsule, cone, cuboid, cylinder, half_space, hull_of_points, prism, pyramid,
    regular, sphere, wedge,
};

use super::judge::{Figures, assert_near, evaluated, figures, sweep};
use super::polygon::regular_area;
use planecut_testkit::random::Rng;

const M: MaterialId = MaterialId(0);

/// The figures of a convex body all of whose planes have a face.
fn convex(brush: Brush) -> Figures {
    let tree = Tree::from(brush);
    assert_eq!(evaluated(&tree).model.redundant_planes, 0);
    let figures = figures(&tree);
    assert_eq!((figures.genus, figures.components), (0, 1));
    figures
}

fn length(rng: &mut Rng) -> f64 {
    10f64.powf(rng.float(-3.0, 3.0))
}

/// Volume and area between two regular polygons of `n` corners, one above the other.
fn frustum(n: u32, height: f64, [bottom, top]: [f64; 2]) -> [f64; 2] {
    let (low, high) = (regular_area(n, bottom), regular_area(n, top));
    let half = std::f64::consts::PI / f64::from(n);
    // trapezoids between chords
    let slant = height.hypot((bottom - top) * half.cos());
    [height / 3.0 * (low + high + (low * high).sqrt()), f64::from(n) * (bottom + top) * half.sin() * slant]
}

/// Polar angle `180° · (i + ½) / rings` as height and distance from the axis.
fn ring(i: u32, segments: u32, radius: f64) -> [f64; 2] {
    let rings = segments.div_ceil(2);
    let angle = std::f64::consts::PI * (f64::from(i) + 0.5) / f64::from(rings);
    [radius * angle.cos(), radius * angle.sin()]
}

fn sphere_by_rings(segments: u32, radius: f64) -> [f64; 2] {
    let rings = segments.div_ceil(2);
    let mut sums = [0.0, 2.0 * regular_area(segments, ring(0, segments, radius)[1])];
    for i in 1..rings {
        let ([above, high], [below, low]) = (ring(i - 1, segments, radius), ring(i, segments, radius));
        let part = frustum(segments, above - below, [low, high]);
        sums = [sums[0] + part[0], sums[1] + part[1]];
    }
    sums
}

#[test]
fn spheres() {
    sweep(40, |rng| {
        let (radius, n) = (length(rng), 3 + rng.below(30) as u32);
        let found = convex(sphere(radius, n, M).expect("a sphere"));
        let [volume, area] = sphere_by_rings(n, radius);
        assert_near(found.volume, volume, 1e-12, "volume");
        assert_near(found.area, area, 1e-12, "area");
        let rings = n.div_ceil(2) as usize;
        assert_eq!((found.faces, found.corners), (n as usize * (rings - 1) + 2, n as usize * rings), "{n} segments");
    });
}

#[test]
fn capsules_are_spheres_and_the_widest_ring_between_them() {
    sweep(40, |rng| {
        let (radius, height, n) = (length(rng), length(rng), 3 + rng.below(30) as u32);
        let found = convex(capsule(height, radius, n, M).expect("a capsule"));
        let widest = (0..n.div_ceil(2)).map(|i| ring(i, n, radius)[1]).fold(0.0, f64::max);
        let [volume, _] = sphere_by_rings(n, radius);
        assert_near(found.volume, volume + height * regular_area(n, widest), 1e-12, "volume");
    });
    let round = capsule(0.0, 2.0, 12, M).expect("a capsule of no height");
    assert_eq!(round, sphere(2.0, 12, M).expect("a sphere"));
}

#[test]
fn cylinders_cones_prisms_and_pyramids() {
    sweep(60, |rng| {
        let (height, bottom, top) = (length(rng), length(rng), length(rng));
        let n = 3 + rng.below(40) as u32;
        let radii = rng.pick(&[[bottom, top], [bottom, bottom], [bottom, 0.0], [0.0, top]]);
        let found = convex(cylinder(height, radii[0], radii[1], n, M).expect("a cylinder"));
        let [volume, area] = frustum(n, height, radii);
        assert_near(found.volume, volume, 1e-12, "volume");
        assert_near(found.area, area + regular_area(n, radii[0]) + regular_area(n, radii[1]), 1e-12, "area");
        let ends = radii.iter().filter(|r| **r > 0.0).count();
        let corners = if ends == 2 { 2 * n } else { n + 1 } as usize;
        assert_eq!((found.faces, found.corners), (n as usize + ends, corners));
        let same = |a: Brush, b: Brush| assert_eq!(a, b);
        same(cone(height, bottom, n, M).expect("a cone"), cylinder(height, bottom, 0.0, n, M).expect("a cone"));
        same(pyramid(height, bottom, n, M).expect("a pyramid"), cone(height, bottom, n, M).expect("a cone"));
        same(prism(height, bottom, n, M).expect("a prism"), cylinder(height, bottom, bottom, n, M).expect("a prism"));
    });
}

#[test]
fn regular_polyhedra() {
    let root = f64::sqrt;
    sweep(10, |rng| {
        let r = length(rng);
        let dodecahedron = 4.0 * r / (root(3.0) * (1.0 + root(5.0)));
        let icosahedron = 4.0 * r / root(10.0 + 2.0 * root(5.0));
        // volume, faces, corners
        let expected = [
            ("tetrahedron", 8.0 * root(3.0) / 27.0 * r.powi(3), 4, 4),
            ("cube", 8.0 * root(3.0) / 9.0 * r.powi(3), 6, 8),
            ("octahedron", 4.0 / 3.0 * r.powi(3), 8, 6),
            ("dodecahedron", (15.0 + 7.0 * root(5.0)) / 4.0 * dodecahedron.powi(3), 12, 20),
            ("icosahedron", 5.0 * (3.0 + root(5.0)) / 12.0 * icosahedron.powi(3), 20, 12),
        ];
        for (name, volume, faces, corners) in expected {
            let solid = RegularSolid::named(name).expect("a name");
            let brush = regular(solid, r, M).expect("a polyhedron");
            for position in evaluated(&brush.clone().into()).mesh.positions {
                assert_near(position.length(), r, 1e-14, name);
            }
            let found = convex(brush);
            assert_near(found.volume, volume, 1e-13, name);
            assert_eq!((found.faces, found.corners), (faces, corners), "{name}");
        }
    });
    assert_eq!(RegularSolid::named("Cube"), None);
}

#[test]
fn boxes_and_wedges_are_exact() {
    let found = convex(cuboid(DVec3::new(-1.0, 2.0, 0.5), DVec3::new(3.0, 5.0, 0.75), M).expect("a box"));
    assert_eq!((found.volume, found.faces, found.corners), (4.0 * 3.0 * 0.25, 6, 8));
    let wedge = wedge(DVec3::new(3.0, 5.0, 4.0), M).expect("a wedge");
    assert_eq!(evaluated(&wedge.clone().into()).mesh.positions.len(), 6);
    let found = convex(wedge);
    // 3-4-5: two triangles, three sides and a slope of 5 × 5
    assert_eq!((found.volume, found.area), (3.0 * 5.0 * 4.0 / 2.0, 3.0 * 4.0 + 5.0 * (3.0 + 4.0 + 5.0)));
}

#[test]
fn short_numbers_stay_exact() {
    for (height, radius) in [(2.0, 3.0), (7.0, 5.0), (0.5, 1.25)] {
        let square = 2.0 * radius * radius;
        assert_eq!(convex(prism(height, radius, 4, M).expect("a prism")).volume, square * height);
        let pyramid = evaluated(&pyramid(height, radius, 4, M).expect("a pyramid").into()).mesh;
        let tip = DVec3::new(0.0, 0.0, height);
        assert!(pyramid.positions.contains(&tip) && pyramid.positions.contains(&DVec3::new(0.0, -radius, 0.0)));
    }
    // whatever the numbers, the sides of a cone meet in one point
    let cone = evaluated(&cone(0.7, 0.3, 17, M).expect("a cone").into()).mesh;
    assert!(cone.positions.contains(&DVec3::new(0.0, 0.0, 0.7)));
}

#[test]
fn faces_mirror_each_other_to_the_last_bit() {
    for n in 3..30 {
        let bodies =
            [(sphere(0.7, n, M).expect("a sphere"), true), (cylinder(0.3, 0.7, 0.2, n, M).expect("a frustum"), false)];
        for (body, in_z) in bodies {
            let planes: Vec<[f64; 4]> = body
                .faces
                .iter()
                .map(|face| face.half_space.normal().extend(face.half_space.offset()).to_array())
                .collect();
            for [x, y, z, d] in &planes {
                assert!(planes.contains(&[*x, -y, *z, *d]), "{n} segments, y mirrored");
                assert!(n % 2 == 1 || planes.contains(&[-x, *y, *z, *d]), "{n} segments, x mirrored");
                assert!(n % 4 != 0 || planes.contains(&[*y, *x, *z, *d]), "{n} segments, x and y exchanged");
                assert!(!in_z || planes.contains(&[*x, *y, -z, *d]), "{n} segments, z mirrored");
            }
        }
    }
}

#[test]
fn hulls_of_points_and_bodies_of_half_spaces() {
    let corners: Vec<DVec3> =
        (0..8).map(|k| DVec3::new((k & 1) as f64, (k >> 1 & 1) as f64, (k >> 2) as f64)).collect();
    let found = convex(hull_of_points(&corners, M).expect("a cube"));
    assert_eq!((found.volume, found.faces, found.corners), (1.0, 6, 8));
    let octant = [(-DVec3::X, 0.0), (-DVec3::Y, 0.0), (-DVec3::Z, 0.0), (DVec3::ONE, 3.0)];
    assert_eq!(convex(body_of_half_spaces(&octant, M).expect("a corner")).volume, 27.0 / 6.0);
    let half = half_space(DVec3::X, 2.0, M).expect("a half-space");
    assert_eq!(half.faces.len(), 1);
}
