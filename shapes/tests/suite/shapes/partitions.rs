//! Outlines cut into convex cells: how many, that they do not overlap, and that together they are the outline.

use std::collections::HashSet;

use glam::{DMat2, DVec2};
use planecut_csg::{Material, MaterialId, Model, Operation, Tree, TreeNode, evaluate, summarize};
use planecut_shapes::Outline;
use planecut_shapes::primitives::{Extrusion, extrude};

use super::judge::{assert_near, contains, sweep};
use super::polygon;
use planecut_testkit::random::Rng;

const M: MaterialId = MaterialId(0);

fn prism(loops: &[Vec<DVec2>]) -> Tree {
    let outline = Outline::from_loops(loops).expect("an outline");
    extrude(&outline, &Extrusion::straight(1.0), M).expect("a prism")
}

fn reflex_corners(corners: &[DVec2]) -> usize {
    let n = corners.len();
    (0..n).filter(|k| (corners[(k + 1) % n] - corners[*k]).perp_dot(corners[(k + 2) % n] - corners[*k]) < 0.0).count()
}

/// The cells of one loop: at most one more than reflex corners, disjoint, all sides on lines of the loop; or the hull and its
/// pockets, far fewer.
fn assert_partition(corners: &[DVec2]) -> usize {
    let tree = prism(&[corners.to_vec()]);
    let cells = tree.brushes().len();
    assert!(cells <= reflex_corners(corners) + 1, "{cells} cells for {} reflex corners", reflex_corners(corners));
    let model = Model { materials: vec![Material::named("m")], tree: tree.clone() };
    let is_difference = |node: &TreeNode| matches!(node, TreeNode::Operation { operation: Operation::Difference, .. });
    if tree.nodes().iter().any(is_difference) {
        assert!(3 * (cells - 1) < reflex_corners(corners), "{cells} for {} reflex corners", reflex_corners(corners));
        let volume = evaluate(&model).expect("a mesh").solid.volume;
        assert_near(volume, polygon::area(&[corners.to_vec()]), 1e-11, "the hull without pockets");
        return cells;
    }
    let summary = summarize(&model);
    let area = polygon::area(&[corners.to_vec()]);
    // cells that add up and cover everything do not overlap
    assert_near(summary.brush_volume_sum, area, 1e-11, "the sum of all cells");
    assert!(summary.planes <= corners.len() + 2, "{} planes for {} sides", summary.planes, corners.len());
    cells
}

fn turned(corners: &[DVec2], angle: f64) -> Vec<DVec2> {
    let turn = DMat2::from_angle(angle);
    corners.iter().map(|p| turn * *p).collect()
}

#[test]
fn random_stars() {
    sweep(300, |rng| {
        let center = DVec2::new(rng.float(-3.0, 3.0), 0.5);
        let corners = polygon::random_star(rng, 40, center, 0.3, 2.0);
        assert_partition(&corners);
        let tree = prism(std::slice::from_ref(&corners));
        for _ in 0..50 {
            let point = DVec2::new(rng.float(-5.0, 5.0), rng.float(-2.0, 3.0));
            if let Some(found) = contains(&tree, point.extend(0.5), 1e-9) {
                assert_eq!(found, polygon::contains(std::slice::from_ref(&corners), point), "{point}");
            }
        }
    });
}

/// The outer loop of a union of squares of a lattice that hang together: corners in line, and cuts that end in corners.
fn lattice_loop(rng: &mut Rng) -> Vec<DVec2> {
    let mut cells = HashSet::from([(0, 0)]);
    let count = 2 + rng.below(30);
    while cells.len() < count {
        let mut all: Vec<(i32, i32)> = cells.iter().copied().collect();
        all.sort_unstable();
        let (x, y) = rng.pick(&all);
        cells.insert(rng.pick(&[(x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)]));
    }
    let squares = cells.iter().map(|(x, y)| {
        let low = DVec2::new(f64::from(*x), f64::from(*y)) * 0.1;
        Outline::rectangle(low, low + 0.1).expect("a square")
    });
    let union = Outline::combine(Operation::Union, &squares.collect::<Vec<_>>()).expect("a union");
    let largest = |a: &&Vec<Vec<DVec2>>, b: &&Vec<Vec<DVec2>>| {
        polygon::area(&[a[0].clone()]).total_cmp(&polygon::area(&[b[0].clone()]))
    };
    union.shapes().iter().max_by(largest).expect("a shape")[0].clone()
}

#[test]
fn unions_of_squares() {
    sweep(200, |rng| {
        let corners = lattice_loop(rng);
        let straight = assert_partition(&corners);
        // corners in line are known to be in line also where they are so but for rounding
        let inclined = assert_partition(&turned(&corners, rng.float(0.1, 1.4)));
        assert!(inclined <= straight + 1, "{straight} straight, {inclined} turned");
    });
}

#[test]
fn corners_in_line_are_cut_at_once() {
    // a comb of 20 teeth in line: one cut along the roots for each tooth, and none for its second corner
    let mut comb = vec![DVec2::new(40.0, 0.0), DVec2::new(40.0, 1.0)];
    for tooth in (0..20).rev() {
        let x = 2.0 * f64::from(tooth);
        comb.extend([[x + 1.5, 1.0], [x + 1.5, 3.0], [x + 0.5, 3.0], [x + 0.5, 1.0]].map(DVec2::from));
    }
    comb.extend([DVec2::new(0.0, 1.0), DVec2::ZERO]);
    assert_eq!(assert_partition(&comb), 21);
    for angle in [0.1, 0.7, 2.0, 3.3] {
        assert_eq!(assert_partition(&turned(&comb, angle)), 21);
    }
    let plus = [[1, 0], [2, 0], [2, 1], [3, 1], [3, 2], [2, 2], [2, 3], [1, 3], [1, 2], [0, 2], [0, 1], [1, 1]];
    assert_eq!(assert_partition(&plus.map(|[x, y]| DVec2::new(f64::from(x), f64::from(y)))), 3);
}

#[test]
fn gears() {
    for teeth in [8, 30, 120] {
        let step = std::f64::consts::TAU / f64::from(teeth);
        let tooth = |k: u32| {
            [(0.0, 9.0), (0.18, 9.3), (0.25, 10.0), (0.45, 10.0), (0.52, 9.3), (0.7, 9.0)]
                .map(|(part, radius)| DVec2::from_angle(step * (f64::from(k) + part)) * radius)
        };
        let gear: Vec<DVec2> = (0..teeth).flat_map(tooth).collect();
        assert_partition(&gear);
    }
}

#[test]
fn spirals() {
    for turns in [1.0, 3.0, 8.0] {
        let at = |k: u32, width: f64| {
            let angle = std::f64::consts::TAU * f64::from(k) / 24.0;
            DVec2::from_angle(angle) * (2.0 + 0.6 * angle / std::f64::consts::TAU * 2.0 + width)
        };
        let n = (24.0 * turns) as u32;
        let spiral: Vec<DVec2> = (0..=n).map(|k| at(k, 0.5)).chain((0..=n).rev().map(|k| at(k, 0.0))).collect();
        assert_partition(&spiral);
    }
}

#[test]
fn holes_are_subtracted() {
    let plate = vec![DVec2::new(-9.0, -9.0), DVec2::new(9.0, -9.0), DVec2::new(9.0, 9.0), DVec2::new(-9.0, 9.0)];
    let hole = |x: f64, y: f64| -> Vec<DVec2> {
        (0..64).map(|k| DVec2::new(x, y) + DVec2::from_angle(std::f64::consts::TAU * f64::from(k) / 64.0)).collect()
    };
    let tree = prism(&[plate.clone(), hole(-3.0, 0.0), hole(3.0, 0.0)]);
    assert_eq!(tree.brushes().len(), 3);
    let found = super::judge::figures(&tree);
    assert_near(found.volume, 324.0 - 2.0 * polygon::regular_area(64, 1.0), 1e-13, "volume");
    assert_eq!((found.faces, found.genus, found.components), (6 + 2 * 64, 2, 1));
    // a shape within a hole
    let nested = prism(&[plate, hole(0.0, 0.0), hole(0.0, 0.0).iter().map(|p| *p * 0.5).collect()]);
    assert_near(super::judge::figures(&nested).volume, 324.0 - 0.75 * polygon::regular_area(64, 1.0), 1e-13, "volume");
}

#[test]
fn loops_that_touch_themselves() {
    // two squares that share a corner, and a square with a notch whose tip touches the far side
    let bow = [[0, 0], [2, 0], [2, 2], [4, 2], [4, 4], [2, 4], [2, 2], [0, 2]];
    let notch = [[0, 0], [4, 0], [4, 4], [3, 4], [2, 0], [1, 4], [0, 4]];
    for (corners, area) in [(bow.to_vec(), 8.0), (notch.to_vec(), 12.0)] {
        let corners: Vec<DVec2> = corners.iter().map(|[x, y]| DVec2::new(f64::from(*x), f64::from(*y))).collect();
        let tree = prism(&[corners]);
        let model = Model { materials: vec![Material::named("m")], tree };
        assert_near(summarize(&model).brush_volume_sum, area, 1e-14, "the sum of all cells");
    }
}

#[test]
fn a_notch_along_an_arc_is_one_pocket() {
    // a square with half a disc of many sides taken out of its left side, turned so that no plane is along an axis
    for sides in [20, 64, 301] {
        let arc = (0..=sides)
            .map(|k| 0.25 * DVec2::from_angle(std::f64::consts::PI * (f64::from(k) / f64::from(sides) - 0.5)));
        let mut corners = [[0.0, -1.0], [2.0, -1.0], [2.0, 1.0], [0.0, 1.0]].map(DVec2::from).to_vec();
        corners.extend(arc.collect::<Vec<_>>().into_iter().rev());
        for angle in [0.0, 0.3, std::f64::consts::FRAC_PI_2, 2.0] {
            assert_eq!(assert_partition(&turned(&corners, angle)), 2, "{sides} sides turned by {angle}");
        }
    }
}

/// Corners along a straight side are in line but for rounding, and sides between near ones may point anywhere. Once they cut off
/// half of the body.
#[test]
fn rounding_along_a_side_is_no_boundary() {
    sweep(100, |rng| {
        let l =
            turned(&[[0, 0], [3, 0], [3, 1], [1, 1], [1, 4], [0, 4]].map(|[x, y]| DVec2::new(x.into(), y.into())), 0.1);
        let l = turned(&l, rng.float(0.0, 6.0));
        let mut corners = Vec::new();
        for (p, q) in polygon::edges(&l) {
            let mut parts = vec![0.0];
            for _ in 0..rng.below(4) {
                let part = rng.float(0.1, 0.9);
                parts.extend([part, part + 10f64.powi(-rng.integer(8, 15) as i32)]);
            }
            parts.sort_by(f64::total_cmp);
            corners.extend(parts.into_iter().map(|part| p + (q - p) * part));
        }
        corners.dedup();
        let tree = prism(&[corners]);
        let model = Model { materials: vec![Material::named("m")], tree };
        let evaluation = evaluate(&model).expect("a mesh");
        assert_near(evaluation.solid.volume, 6.0, 1e-11, "volume");
        // two or three, and some that are no wider than rounding
        assert!(model.tree.brushes().len() <= 8, "{} cells", model.tree.brushes().len());
    });
}
