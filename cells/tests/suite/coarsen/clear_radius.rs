//! What a ball can reach stays clear, against balls that are moved through space without a grid of voxels: step by step, by distances to boxes.

use std::collections::VecDeque;

use glam::{DVec3, IVec3};
use planecut_cells::coarsen::{Bounded, CoarsenError, CoarsenOptions, Coarsened, Coarsener, Surface, coarsen};
use planecut_csg::{Brush, Material, Mesh, Model, Tree, evaluate};
use planecut_testkit::random::Rng;
use planecut_testkit::scene::{cuboid, scaled};

use super::judge::assert_sound;

/// Boxes, each by two corners.
type Boxes = Vec<(DVec3, DVec3)>;

fn tree_of(boxes: &Boxes) -> Tree {
    Tree::union(boxes.iter().map(|(low, high)| Tree::from(cuboid(*low, *high))))
}

fn mesh_of(tree: &Tree) -> Mesh {
    let model = Model { materials: vec![Material::named("any")], tree: tree.clone() };
    evaluate(&model).expect("a solid").mesh
}

fn around(mesh: &Mesh, bounded: Bounded, options: &CoarsenOptions) -> Result<Coarsened, CoarsenError> {
    let surface = Surface { positions: &mesh.positions, triangles: &mesh.triangles, materials: &[], bounded };
    Coarsener::of_surface(&surface, None, options)?.coarsened()
}

fn clear_of(radius: f64) -> CoarsenOptions {
    CoarsenOptions { max_cells: Some(1), clear_radius: Some(radius), ..CoarsenOptions::default() }
}

/// How far a point is from boxes.
fn distance(boxes: &Boxes, point: DVec3) -> f64 {
    boxes.iter().map(|(low, high)| (point - point.clamp(*low, *high)).length()).fold(f64::INFINITY, f64::min)
}

/// Points around which a ball can be that came in steps from outside; between two of them it touches nothing either.
fn reached(boxes: &Boxes, radius: f64) -> Vec<DVec3> {
    let step = radius / 3.0;
    let all = |pick: fn(&(DVec3, DVec3)) -> DVec3, fold: fn(DVec3, DVec3) -> DVec3| {
        boxes.iter().map(pick).reduce(fold).expect("boxes")
    };
    let room = DVec3::splat(2.0 * radius);
    let (low, high) = (all(|b| b.0, DVec3::min) - room, all(|b| b.1, DVec3::max) + room);
    let count = ((high - low) / step).floor().as_ivec3();
    let at = |k: IVec3| low + k.as_dvec3() * step;
    let number = |k: IVec3| ((k.z * (count.y + 1) + k.y) * (count.x + 1) + k.x) as usize;
    let mut is_known = vec![false; number(count) + 1];
    let (mut waiting, mut found) = (VecDeque::from([IVec3::ZERO]), Vec::new());
    while let Some(k) = waiting.pop_front() {
        let is_in_grid = k.cmpge(IVec3::ZERO).all() && k.cmple(count).all();
        if !is_in_grid || std::mem::replace(&mut is_known[number(k)], true) || distance(boxes, at(k)) < radius + step {
            continue;
        }
        found.push(at(k));
        waiting.extend([IVec3::X, IVec3::Y, IVec3::Z].into_iter().flat_map(|way| [k + way, k - way]));
    }
    found
}

fn holds(cell: &Brush, point: DVec3) -> bool {
    cell.faces.iter().all(|face| face.half_space.signed_distance(point) < 0.0)
}

/// Balls around points, but for the tolerance, have nothing in common with cells, as far as points in them tell.
fn assert_clear(found: &Coarsened, middles: &[DVec3], radius: f64, rng: &mut Rng, what: &str) {
    let tolerance = found.clear_tolerance.expect("asked for");
    assert!(tolerance <= radius, "{what}: {tolerance}");
    for middle in middles {
        for _ in 0..3 {
            let point = *middle + rng.unit() * (radius - tolerance) * rng.float(0.9, 1.0);
            assert!(!found.cells.iter().any(|cell| holds(cell, point)), "{what}: {point} of the ball around {middle}");
        }
    }
}

#[test]
fn no_cell_is_where_a_ball_can_go() {
    let mut inside = 0;
    for seed in 0..scaled(3) {
        let mut rng = Rng::spread(seed);
        let corner = |rng: &mut Rng| DVec3::new(rng.whole(0, 4), rng.whole(0, 4), rng.whole(0, 2));
        let boxes: Boxes = (0..8)
            .map(|_| {
                let low = corner(&mut rng);
                (low, low + DVec3::new(rng.whole(1, 4), rng.whole(1, 4), rng.whole(1, 3)) * 0.75)
            })
            .collect();
        let radius = rng.float(0.5, 1.0);
        let what = format!("seed {seed}: radius {radius}, boxes {boxes:?}");
        let tree = tree_of(&boxes);
        let middles = reached(&boxes, radius);
        let [as_cells, as_surface] = [
            coarsen(&tree, &[], &clear_of(radius)).expect("cells"),
            around(&mesh_of(&tree), Bounded::Solid, &clear_of(radius)).expect("cells"),
        ];
        for found in [&as_cells, &as_surface] {
            assert_clear(found, &middles, radius, &mut rng, &what);
        }
        assert_sound(&tree, &as_cells);
        // where one cell around everything would be
        let hull = coarsen(&tree, &[], &CoarsenOptions { max_cells: Some(1), ..CoarsenOptions::default() });
        let hull = hull.expect("a cell").cells;
        inside += middles.iter().filter(|middle| hull.iter().any(|cell| holds(cell, **middle))).count();
    }
    assert!(inside > 100, "{inside} balls in a hull");
}

/// A room of 6 by 6 by 4 with walls one thick, and a door of a width up to its ceiling.
fn room(door: f64) -> Tree {
    let hollow = Tree::from(cuboid(DVec3::ZERO, DVec3::new(8.0, 8.0, 6.0)))
        - cuboid(DVec3::ONE, DVec3::new(7.0, 7.0, 5.0)).into();
    let half = DVec3::new(0.5 * door, 0.0, 0.0);
    let sides = (DVec3::new(4.0, -1.0, 1.0) - half, DVec3::new(4.0, 2.0, 5.0) + half);
    if door > 0.0 { hollow - cuboid(sides.0, sides.1).into() } else { hollow }
}

#[test]
fn a_room_is_kept_clear_where_its_door_is_wide_enough() {
    let middle = DVec3::new(4.0, 4.0, 3.0);
    let is_filled = |tree: &Tree, radius: f64| {
        let as_cells = coarsen(tree, &[], &clear_of(radius)).expect("cells");
        let as_surface = around(&mesh_of(tree), Bounded::Solid, &clear_of(radius)).expect("cells");
        assert_sound(tree, &as_cells);
        [as_cells, as_surface].map(|found| {
            let is_filled = found.cells.iter().any(|cell| holds(cell, middle));
            assert!(!is_filled || found.cells.len() == 1, "{} cells", found.cells.len());
            is_filled
        })
    };
    assert_eq!(is_filled(&room(2.5), 1.0), [false; 2]);
    // so large that it comes no farther into the door than the tolerance
    assert_eq!(is_filled(&room(2.5), 8.0), [true; 2]);
    assert_eq!(is_filled(&room(0.0), 1.0), [true; 2]);
}

#[test]
fn the_inside_of_an_open_box_is_kept_clear_of_a_shell() {
    let mut mesh = mesh_of(&cuboid(DVec3::ZERO, DVec3::splat(4.0)).into());
    mesh.triangles.retain(|triangle| triangle.iter().any(|corner| mesh.positions[*corner as usize].z < 4.0));
    let shell = Bounded::Shell { thickness: 0.125 };
    let sides = around(&mesh, shell, &clear_of(1.0)).expect("cells");
    assert_eq!(sides.cells.len(), 5);
    let middle = DVec3::new(2.0, 2.0, 2.0);
    assert!(!sides.cells.iter().any(|cell| holds(cell, middle)));
    // nor where it is filled
    let filled = around(&mesh, Bounded::Filled, &clear_of(1.0)).expect("a cell");
    assert!(filled.cells.iter().any(|cell| holds(cell, middle)));
    let filled = around(&mesh, shell, &clear_of(16.0)).expect("a cell");
    assert_eq!(filled.cells.len(), 1);
}

#[test]
fn radii_that_cannot_be_are_refused() {
    let tree = room(2.5);
    for radius in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = coarsen(&tree, &[], &clear_of(radius)).expect_err("no radius");
        assert!(matches!(error, CoarsenError::Option { option: "clear_radius", .. }), "{error}");
    }
    let error = coarsen(&tree, &[], &clear_of(1e-3)).expect_err("too small");
    let CoarsenError::Radius { found, least } = error else { panic!("{error}") };
    assert_eq!(found, 1e-3);
    let error = coarsen(&tree, &[], &clear_of(0.9 * least)).expect_err("still too small");
    assert!(matches!(error, CoarsenError::Radius { .. }), "{error}");
}
