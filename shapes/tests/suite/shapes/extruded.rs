//! Extrusions against the triangles that the page `docs/model-file.md` states.

use glam::{DVec2, DVec3};
use planecut_csg::{MaterialId, Transform};
use planecut_shapes::Outline;
use planecut_shapes::primitives::{Extrusion, LayerRules, ShapeError, extrude};

use super::judge::{assert_near, contains, figures, of_triangles, sweep, winds_around};
use super::polygon;
use planecut_testkit::random::Rng;

const M: MaterialId = MaterialId(0);

fn star(points: usize, outer: f64, inner: f64) -> Vec<DVec2> {
    let radius = |k: usize| if k.is_multiple_of(2) { outer } else { inner };
    let step = std::f64::consts::PI / points as f64;
    (0..2 * points).map(|k| DVec2::from_angle(step * k as f64) * radius(k)).collect()
}

fn outline(loops: &[Vec<DVec2>]) -> Outline {
    Outline::from_loops(loops).expect("an outline")
}

fn slices(extrusion: &Extrusion) -> u32 {
    let by_twist = (extrusion.twist.abs() / 5.0).ceil().max(1.0) as u32;
    extrusion.slices.unwrap_or(if extrusion.twist == 0.0 { 1 } else { by_twist })
}

/// Where a corner is at the height of layer `j`.
fn lifted(extrusion: &Extrusion, corner: DVec2, j: u32) -> DVec3 {
    let part = f64::from(j) / f64::from(slices(extrusion));
    let scaled = corner * (DVec2::ONE + (extrusion.scale - DVec2::ONE) * part);
    let turned = DVec2::from_angle(-extrusion.twist.to_radians() * part).rotate(scaled);
    let base = if extrusion.center { -0.5 * extrusion.height } else { 0.0 };
    turned.extend(base + extrusion.height * part)
}

/// The triangles of the sides, cut along the shorter diagonals.
fn side_triangles(loops: &[Vec<DVec2>], extrusion: &Extrusion) -> Vec<[DVec3; 3]> {
    let mut triangles = Vec::new();
    for j in 0..slices(extrusion) {
        for (p, q) in loops.iter().flat_map(|corners| polygon::edges(corners)) {
            let [a, b] = [p, q].map(|corner| lifted(extrusion, corner, j));
            let [d, c] = [p, q].map(|corner| lifted(extrusion, corner, j + 1));
            let rising = a.distance(c) <= b.distance(d) * (1.0 + 1e-9);
            triangles.extend(if rising { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] });
        }
    }
    triangles
}

/// The volume within sides and caps, and their area.
fn expected(loops: &[Vec<DVec2>], extrusion: &Extrusion) -> [f64; 2] {
    let sides = side_triangles(loops, extrusion);
    // the caps, as fans from the axis at their heights: signed, so that they may overlap
    let fan = |(p, q): (DVec2, DVec2)| {
        let top = slices(extrusion);
        let (axis, above) = (lifted(extrusion, DVec2::ZERO, 0), lifted(extrusion, DVec2::ZERO, top));
        let below = [axis, lifted(extrusion, q, 0), lifted(extrusion, p, 0)];
        [below, [above, lifted(extrusion, p, top), lifted(extrusion, q, top)]]
    };
    let caps: Vec<[DVec3; 3]> = loops.iter().flat_map(|corners| polygon::edges(corners)).flat_map(fan).collect();
    let volume = of_triangles(sides.iter().chain(&caps).copied()).volume;
    let ends = polygon::area(loops) * (1.0 + extrusion.scale.x * extrusion.scale.y);
    [volume, of_triangles(sides.into_iter()).area + ends]
}

fn random_extrusion(rng: &mut Rng) -> Extrusion {
    let scale = rng.pick(&[DVec2::ONE, DVec2::splat(0.5), DVec2::splat(1.7), DVec2::new(1.2, 0.7)]);
    let twist = rng.pick(&[0.0, 20.0, -33.0, 7.5]);
    let slices = if twist == 0.0 { rng.chance(0.5).then_some(1) } else { Some(4 + rng.below(10) as u32) };
    Extrusion { height: rng.float(0.5, 4.0), twist, scale, slices, center: rng.chance(0.5), ..Extrusion::straight(1.0) }
}

#[test]
fn straight_extrusions_with_holes() {
    sweep(100, |rng| {
        let center = DVec2::new(rng.float(-3.0, 3.0), rng.float(-3.0, 3.0));
        let loops = polygon::random_region(rng, 20, center);
        let (height, scale) = (rng.float(0.1, 3.0), rng.pick(&[1.0, 0.5, 2.0, 0.3]));
        let extrusion =
            Extrusion { scale: DVec2::splat(scale), center: rng.chance(0.5), ..Extrusion::straight(height) };
        let found = figures(&extrude(&outline(&loops), &extrusion, M).expect("an extrusion"));
        let area = polygon::area(&loops);
        assert_near(found.volume, area * height * (1.0 + scale + scale * scale) / 3.0, 1e-12, "volume");
        assert_near(found.area, expected(&loops, &extrusion)[1], 1e-12, "area");
        let sides: usize = loops.iter().map(Vec::len).sum();
        assert_eq!((found.faces, found.corners), (sides + 2, 2 * sides));
        assert_eq!((found.genus, found.components), (loops.len() as i64 - 1, 1));
    });
}

#[test]
fn a_scale_of_zero_ends_in_a_tip() {
    for loops in [vec![star(5, 2.0, 0.8)], vec![star(7, 1.0, 0.9)], vec![star(4, 3.0, 2.9)]] {
        for center in [false, true] {
            let extrusion = Extrusion { scale: DVec2::ZERO, center, ..Extrusion::straight(1.5) };
            let found = figures(&extrude(&outline(&loops), &extrusion, M).expect("a cone"));
            assert_near(found.volume, polygon::area(&loops) * 1.5 / 3.0, 1e-12, "volume");
            assert_eq!((found.faces, found.corners), (loops[0].len() + 1, loops[0].len() + 1));
        }
    }
    // a roof: the top is an edge
    let square = Outline::rectangle(DVec2::new(-1.0, -2.0), DVec2::new(1.0, 2.0)).expect("a rectangle");
    let roof = Extrusion { scale: DVec2::new(0.0, 1.0), ..Extrusion::straight(3.0) };
    let found = figures(&extrude(&square, &roof, M).expect("a roof"));
    assert_eq!((found.volume, found.faces, found.corners), (2.0 * 4.0 * 3.0 / 2.0, 5, 6));
}

#[test]
fn twisted_and_stretched_extrusions_are_bounded_by_the_stated_triangles() {
    let crossing = std::cell::Cell::new(0);
    sweep(60, |rng| {
        let center = DVec2::new(rng.float(-1.0, 1.0), rng.float(-1.0, 1.0));
        let loops = polygon::random_region(rng, 12, center);
        let extrusion = random_extrusion(rng);
        let tree = match extrude(&outline(&loops), &extrusion, M) {
            Err(ShapeError::CrossingSides { .. }) => return crossing.set(crossing.get() + 1),
            other => other.expect("an extrusion"),
        };
        let found = figures(&tree);
        let [volume, area] = expected(&loops, &extrusion);
        assert_near(found.volume, volume, 1e-12, "volume");
        assert_near(found.area, area, 1e-11, "area");
        let sides: usize = loops.iter().map(Vec::len).sum();
        let is_straight = extrusion.twist == 0.0 && extrusion.scale.x == extrusion.scale.y;
        let layers = if is_straight { 1 } else { slices(&extrusion) } as usize;
        let facets = if is_straight { 1 } else { 2 };
        assert_eq!((found.faces, found.corners), (facets * layers * sides + 2, (layers + 1) * sides));
        assert_eq!((found.genus, found.components), (loops.len() as i64 - 1, 1));
    });
    assert!(crossing.get() < 20, "{} of 60 were refused", crossing.get());
}

#[test]
fn points_of_a_twisted_extrusion() {
    sweep(20, |rng| {
        let loops = polygon::random_region(rng, 8, DVec2::ZERO);
        let extrusion = Extrusion { slices: Some(3), ..random_extrusion(rng) };
        let Ok(tree) = extrude(&outline(&loops), &extrusion, M) else { return };
        let caps = |top: bool, point: DVec3| {
            let level = lifted(&extrusion, DVec2::ZERO, if top { 3 } else { 0 }).z;
            if top { point.z < level } else { point.z > level }
        };
        let far: Vec<[DVec3; 3]> =
            side_triangles(&loops, &extrusion).into_iter().chain(cap_triangles(&loops, &extrusion)).collect();
        let mut inside = 0;
        for _ in 0..300 {
            let base = if extrusion.center { -0.5 * extrusion.height } else { 0.0 };
            let point = rng.point(-2.5, 2.5).with_z(base + extrusion.height * rng.float(-0.1, 1.1));
            let expected = caps(false, point) && caps(true, point) && winds_around(&far, point);
            inside += usize::from(expected);
            if let Some(found) = contains(&tree, point, 1e-9) {
                assert_eq!(found, expected, "{point}");
            }
        }
        assert!(inside > 2, "points inside were asked for: {inside}");
    });
}

/// The caps as fans from the axis.
fn cap_triangles(loops: &[Vec<DVec2>], extrusion: &Extrusion) -> Vec<[DVec3; 3]> {
    let top = slices(extrusion);
    let at = |corner: DVec2, j: u32| lifted(extrusion, corner, j);
    let edges = loops.iter().flat_map(|corners| polygon::edges(corners));
    edges
        .flat_map(|(p, q)| [[at(DVec2::ZERO, 0), at(q, 0), at(p, 0)], [at(DVec2::ZERO, top), at(p, top), at(q, top)]])
        .collect()
}

#[test]
fn regular_polygons_about_the_axis_need_one_cell_a_layer() {
    for n in [3, 4, 6, 17, 64] {
        let extrusion = Extrusion { twist: 45.0, slices: Some(15), ..Extrusion::straight(4.0) };
        let tree = extrude(&Outline::circle(1.0, n).expect("a circle"), &extrusion, M).expect("an extrusion");
        assert_eq!(tree.brushes().len(), 15, "{n} sides");
    }
}

#[test]
fn sides_that_cross_are_an_error() {
    // turned by half a turn at once, the edges between corners all meet on the axis
    let outline = outline(&[star(5, 2.0, 0.8)]);
    let extrusion = Extrusion { twist: 180.0, slices: Some(1), ..Extrusion::straight(1.0) };
    let error = extrude(&outline, &extrusion, M).expect_err("the sides cross");
    assert_eq!((error.clone(), error.parameter()), (ShapeError::CrossingSides { layer: 0, slices: 1 }, Some("slices")));
    extrude(&outline, &Extrusion { slices: Some(36), ..extrusion }, M).expect("with enough slices they do not");
}

#[test]
fn moved_extrusions_keep_their_figures() {
    sweep(12, |rng| {
        let loops = polygon::random_region(rng, 10, DVec2::ZERO);
        let extrusion = Extrusion { twist: 30.0, slices: Some(6), ..Extrusion::straight(2.0) };
        let Ok(tree) = extrude(&outline(&loops), &extrusion, M) else { return };
        let turn = Transform::rotation(rng.unit(), rng.float(0.0, 360.0)).expect("a turn");
        let shift = Transform::translation(rng.point(-20.0, 20.0)).expect("a shift");
        let motion = turn.then(&shift).expect("a motion");
        let (before, after) = (figures(&tree), figures(&tree.transformed(&motion).expect("in range")));
        assert_near(after.volume, before.volume, 1e-11, "volume");
        assert_eq!((after.faces, after.genus, after.components), (before.faces, before.genus, before.components));
    });
}

#[test]
fn several_shapes_and_none() {
    let loops = [star(5, 2.0, 0.8), star(4, 0.3, 0.2).into_iter().map(|p| p + DVec2::new(5.0, 0.0)).collect()];
    let found = figures(&extrude(&outline(&loops), &Extrusion::straight(1.0), M).expect("two bodies"));
    assert_eq!(found.components, 2);
    assert_near(found.volume, polygon::area(&loops), 1e-13, "volume");
    let nothing = extrude(&Outline::empty(), &Extrusion::straight(1.0), M).expect("nothing");
    assert!(nothing.brushes().is_empty());
}

#[test]
fn decimal_and_small_whole_corners_stay_what_they_are() {
    let l = [[0.1, 0.1], [0.7, 0.1], [0.7, 0.2], [0.3, 0.2], [0.3, 0.9], [0.1, 0.9]].map(DVec2::from).to_vec();
    let tree = extrude(&outline(std::slice::from_ref(&l)), &Extrusion::straight(0.3), M).expect("an L");
    let mesh = super::judge::evaluated(&tree).mesh;
    let exact: Vec<DVec3> = [0.0, 0.3].into_iter().flat_map(|z| l.iter().map(move |p| p.extend(z))).collect();
    assert_eq!(mesh.positions.len(), exact.len());
    assert!(mesh.positions.iter().all(|p| exact.contains(p)), "sides along the axes are exact planes");
    let arrow = [[0.0, 0.0], [5.0, 3.0], [10.0, 0.0], [5.0, 11.0]].map(DVec2::from).to_vec();
    let tree = extrude(&outline(std::slice::from_ref(&arrow)), &Extrusion::straight(2.0), M).expect("an arrow");
    let mesh = super::judge::evaluated(&tree).mesh;
    assert!(mesh.positions.iter().all(|p| arrow.contains(&p.truncate())), "sides between whole corners are exact");
}

/// Whole turns leave sides that are planar but for rounding; a cut along one of them once never ended.
#[test]
fn whole_turns_in_one_layer_are_tapered_prisms() {
    for scale in [0.3, 0.5, 2.0] {
        let extrusion =
            Extrusion { twist: 360.0, slices: Some(1), scale: DVec2::splat(scale), ..Extrusion::straight(2.0) };
        let shape = outline(&[star(12, 3.0, 2.0)]);
        let found = figures(&extrude(&shape, &extrusion, M).expect("a tree"));
        let expected = 2.0 / 3.0 * shape.area() * (1.0 + scale + scale * scale);
        assert_near(found.volume, expected, 1e-12, "volume");
    }
}

/// The triangles of the sides as OpenSCAD 2021.01 makes them, and the volume within them and the caps: it turns first and then
/// scales, cuts along the shorter diagonal, of two that are as long as each other within 1e-5 along one that depends on the sense
/// of the twist and on whether the loop is a hole, and along the other one below a top of no width.
fn openscad_volume(loops: &[Vec<DVec2>], extrusion: &Extrusion) -> f64 {
    let slices = extrusion.slices.expect("given");
    let part = |j: u32| f64::from(j) / f64::from(slices);
    let scale_at = |j: u32| DVec2::ONE - (DVec2::ONE - extrusion.scale) * part(j);
    let at = |p: DVec2, j: u32| {
        let turned = DVec2::from_angle(-(extrusion.twist * part(j)).to_radians()).rotate(p);
        (turned * scale_at(j)).extend(extrusion.height * part(j))
    };
    let mut triangles: Vec<[DVec3; 3]> = Vec::new();
    for j in 0..slices {
        let is_flat = scale_at(j + 1).min_element() == 0.0;
        for (p, q) in loops.iter().flat_map(|corners| polygon::edges(corners)) {
            let is_outer = |corners: &&Vec<DVec2>| corners.contains(&p);
            let is_positive = polygon::area(std::slice::from_ref(loops.iter().find(is_outer).expect("a loop"))) > 0.0;
            let [a, b, c, d] = [at(p, j), at(q, j), at(q, j + 1), at(p, j + 1)];
            let (own, other) = (a.truncate().distance(c.truncate()), b.truncate().distance(d.truncate()));
            let is_tie = 2.0 * (own - other).abs() * 1e5 <= own + other;
            let flip = is_positive == (extrusion.twist <= 0.0);
            let first = if is_tie { !flip } else { own < other };
            if c == d {
                triangles.push([a, b, c]);
            } else if first != is_flat {
                triangles.extend([[a, b, c], [a, c, d]]);
            } else {
                triangles.extend([[a, b, d], [b, c, d]]);
            }
        }
    }
    let area = polygon::area(loops);
    // the bottom is at height 0; the top, seen from the origin
    let top = area * extrusion.scale.x * extrusion.scale.y * extrusion.height / 3.0;
    triangles.iter().map(|[a, b, c]| a.cross(*b).dot(*c) / 6.0).sum::<f64>() + top
}

#[test]
fn openscad_rules_bound_what_openscad_draws() {
    let refused = std::cell::Cell::new(0);
    sweep(80, |rng| {
        let center = DVec2::new(rng.float(-1.0, 1.0), rng.float(-1.0, 1.0));
        let loops = polygon::random_region(rng, 10, center);
        let scale = rng.pick(&[
            DVec2::ONE,
            DVec2::splat(0.5),
            DVec2::new(1.2, 0.7),
            DVec2::ZERO,
            DVec2::new(1.0, 0.0),
            DVec2::new(0.0, 1.3),
        ]);
        let twist = rng.pick(&[0.0, 20.0, -33.0, 7.5]);
        let slices = Some(1 + rng.below(8) as u32);
        let rules = LayerRules::OpenScad;
        let extrusion = Extrusion { twist, scale, slices, rules, ..Extrusion::straight(rng.float(0.5, 4.0)) };
        let tree = match extrude(&outline(&loops), &extrusion, M) {
            Err(ShapeError::CrossingSides { .. }) => return refused.set(refused.get() + 1),
            other => other.expect("an extrusion"),
        };
        let volume = super::judge::evaluated(&tree).solid.volume;
        assert_near(volume, openscad_volume(&loops, &extrusion), 1e-11, &format!("{extrusion:?}"));
    });
    assert!(refused.get() < 30, "{} of 80 were refused", refused.get());
}

/// Squares about the axis, whose diagonals are as long as each other: which one is taken depends on the twist.
#[test]
fn ties_lean_as_the_twist_does() {
    let square = [[1.0, 0.0], [3.0, 0.0], [3.0, 2.0], [1.0, 2.0]].map(DVec2::from).to_vec();
    for twist in [30.0, -30.0] {
        let rules = LayerRules::OpenScad;
        let extrusion = Extrusion { twist, slices: Some(3), rules, ..Extrusion::straight(2.0) };
        let tree = extrude(&outline(std::slice::from_ref(&square)), &extrusion, M).expect("an extrusion");
        let volume = figures(&tree).volume;
        assert_near(volume, openscad_volume(std::slice::from_ref(&square), &extrusion), 1e-12, "volume");
    }
}
