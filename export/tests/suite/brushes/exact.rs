//! What decimals can say exactly comes back exactly.

use planecut_csg::{Brush, BrushFace, MaterialId};
use planecut_export::BrushFormat;
use planecut_import::map::{MapOptions, read_map};
use planecut_kernel::{DVec3, HalfSpace};
use planecut_testkit::random::Rng;

use super::support::{back, body, volume, written};

fn whole(random: &mut Rng, most: f64) -> f64 {
    random.float(-most, most).round()
}

/// The planes, each with a normal of whole numbers without a common factor.
fn planes(brush: &Brush) -> Vec<HalfSpace> {
    brush.faces.iter().map(|face| face.half_space).collect()
}

#[test]
fn boxes_of_whole_corners_keep_their_planes() {
    for seed in 0..200 {
        let mut random = Rng::new(seed);
        let min = DVec3::from([(); 3].map(|()| whole(&mut random, 4096.0)));
        let max = min + DVec3::from([(); 3].map(|()| 1.0 + whole(&mut random, 500.0).abs()));
        let cube = Brush::cuboid(min, max, MaterialId(0));
        assert_eq!(planes(&back(std::slice::from_ref(&cube), BrushFormat::Map, 1.0)[0]), planes(&cube), "seed {seed}");
        let text = written(&[cube], &[planecut_csg::Material::named("stone")], BrushFormat::Map, 1.0);
        assert!(!text.contains('.'), "seed {seed}: whole numbers are written as such:\n{text}");
        let trip = &back(&[Brush::cuboid(min, max, MaterialId(0))], BrushFormat::Scad, 1.0)[0];
        assert_eq!(volume(&body(trip)), (max - min).element_product(), "seed {seed}");
    }
}

/// Planes that a map's reader found, whatever points said them and although few of the corners are on any grid, come back bit for
/// bit.
#[test]
fn planes_through_whole_points_come_back_bit_for_bit() {
    let mut compared = 0;
    for seed in 0..300 {
        let mut random = Rng::new(seed);
        let places = [1.0, 1.0, 4.0, 100.0][seed as usize % 4];
        let mut faces = String::new();
        for _ in 0..12 {
            let [a, b, c] = [(); 3].map(|()| DVec3::from([(); 3].map(|()| whole(&mut random, 300.0) / places)));
            // turned so that the origin is inside
            let [a, c] = if (a - b).cross(c - b).dot(b) > 0.0 { [a, c] } else { [c, a] };
            let point = |p: DVec3| format!("( {} {} {} )", p.x, p.y, p.z);
            faces += &format!("{} {} {} t 0 0 0 1 1\n", point(a), point(b), point(c));
        }
        let text = format!("{{\n\"classname\" \"worldspawn\"\n{{\n{faces}}}\n}}\n");
        let read = read_map(text.as_bytes(), "made.map", &MapOptions::default()).expect("a map");
        let brush = &read.model.tree.brushes()[0];
        let before = body(brush);
        if before.is_empty() || !before.is_bounded() {
            continue;
        }
        let with_face = |(plane, half_space): (_, &HalfSpace)| before.face_polygon(plane).map(|_| *half_space);
        let expected: Vec<HalfSpace> = before.planes().filter_map(with_face).collect();
        assert_eq!(planes(&back(std::slice::from_ref(brush), BrushFormat::Map, 1.0)[0]), expected, "seed {seed}");
        compared += 1;
    }
    assert!(compared > 100, "{compared} bodies were bounded");
}

#[test]
fn planes_without_a_face_and_bodies_without_interior_are_left_out() {
    let half_space = |normal: DVec3, offset: f64| HalfSpace::new(normal, offset).expect("in range");
    let mut cut = Brush::cuboid(DVec3::ZERO, DVec3::splat(8.0), MaterialId(0));
    let faces = cut.faces.len();
    // touching a corner, touching a face, and far away
    for (normal, offset) in [(DVec3::ONE, 24.0), (DVec3::X * 2.0, 16.0), (DVec3::Y, 90.0)] {
        cut.faces.push(BrushFace { half_space: half_space(normal, offset), material: MaterialId(1) });
    }
    let empty = Brush::cuboid(DVec3::ONE, DVec3::ZERO, MaterialId(0));
    let flat = Brush::cuboid(DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0), MaterialId(0));
    // between two neighbouring numbers: no point in between can be written
    let thin = Brush::cuboid(DVec3::splat(1e3), DVec3::new(1e3f64.next_up(), 2e3, 2e3), MaterialId(0));
    for format in BrushFormat::ALL {
        let after = back(&[empty.clone(), cut.clone(), flat.clone(), thin.clone()], format, 1.0);
        assert_eq!(after.len(), 1, "{format:?}");
        assert_eq!(after[0].faces.len(), faces, "{format:?}");
    }
}

/// OpenSCAD's own grid has steps of about a millionth, and needles finer than that end it; plates do not.
#[test]
fn needles_are_left_out_for_openscad() {
    let fine = f64::from(1 << 20).recip();
    let needle = Brush::cuboid(DVec3::ZERO, DVec3::new(1.0, fine, fine), MaterialId(0));
    let plate = Brush::cuboid(DVec3::ZERO, DVec3::new(1.0, 1.0, fine), MaterialId(0));
    let bodies = [needle, plate];
    for (scale, expected) in [(1.0, 1), (100.0, 2), (fine, 0)] {
        assert_eq!(back(&bodies, BrushFormat::Scad, scale).len(), expected, "{scale}");
        assert_eq!(back(&bodies, BrushFormat::Map, scale).len(), bodies.len(), "{scale}");
    }
}

#[test]
fn bytes_are_the_same_on_any_number_of_threads() {
    let mut random = Rng::new(5);
    let cubes: Vec<Brush> = (0..1500)
        .map(|_| {
            let min = DVec3::from([(); 3].map(|()| random.float(-1e3, 1e3)));
            Brush::cuboid(min, min + random.float(1.0, 9.0), MaterialId(0))
        })
        .collect();
    for format in BrushFormat::ALL {
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            pool.install(|| written(&cubes, &[planecut_csg::Material::named("stone")], format, 1.0))
        };
        assert_eq!(on(1), on(3), "{format:?}");
    }
}
