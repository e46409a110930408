//! Few cells around meshes: whether they hold what the mesh bounds, in exact rationals and by exact cells of the tree that it came from.

use glam::DVec3;
use planecut_cells::coarsen::{Bounded, CoarsenError, CoarsenOptions, Coarsened, Coarsener, Surface};
use planecut_csg::{Brush, MaterialId, Mesh, Model, Tree, evaluate};
use planecut_testkit::generate::{general_scene, placed, sloped_scene};
use planecut_testkit::random::Rng;
use planecut_testkit::scene::{as_rust, cuboid, scaled};

use super::judge::{assert_holds_points, holds, volume_outside};

const TREES: u64 = 3;
const SOUPS: u64 = 6;

fn surface(mesh: &Mesh, bounded: Bounded) -> Surface<'_> {
    Surface { positions: &mesh.positions, triangles: &mesh.triangles, materials: &[], bounded }
}

fn coarsened(mesh: &Mesh, bounded: Bounded, cells: usize) -> Coarsened {
    let options = CoarsenOptions { max_cells: Some(cells), ..CoarsenOptions::default() };
    let coarsener = Coarsener::of_surface(&surface(mesh, bounded), None, &options).expect("a surface");
    coarsener.coarsened().expect("cells")
}

fn mesh_of(tree: &Tree) -> Mesh {
    let model = Model { materials: vec![planecut_csg::Material::named("any")], tree: tree.clone() };
    evaluate(&model).expect("a solid").mesh
}

fn cube(low: f64, high: f64) -> Brush {
    cuboid(DVec3::splat(low), DVec3::splat(high))
}

/// A mesh without the triangles of which a question about their corners is answered with yes.
fn without(mesh: &Mesh, is_gone: impl Fn([DVec3; 3]) -> bool) -> Mesh {
    let corners = |triangle: &[u32; 3]| triangle.map(|corner| mesh.positions[corner as usize]);
    let triangles = mesh.triangles.iter().filter(|triangle| !is_gone(corners(triangle))).copied().collect();
    Mesh { triangles, ..mesh.clone() }
}

#[test]
fn what_trees_bound_is_enclosed_wherever_it_is() {
    for seed in 0..scaled(TREES) {
        let mut rng = Rng::spread(seed);
        let scene = if seed % 2 == 0 { general_scene(&mut rng) } else { sloped_scene(&mut rng) };
        let (scale, shift) = [(1.0, 0.0), (1e-3, 5.0), (2e5, -1e6)][(seed / 2 % 3) as usize];
        let model = placed(scene, scale, DVec3::splat(shift));
        let evaluation = evaluate(&model).expect("a solid");
        let (mesh, whole) = (&evaluation.mesh, evaluation.solid.volume);
        eprintln!("seed {seed}: {}", as_rust(&model));
        for cells in [1, 3, 8] {
            let found = coarsened(mesh, Bounded::Solid, cells);
            assert!(found.cells.len() <= cells);
            assert_holds_points(&found.cells, &mesh.positions);
            let left = volume_outside(&model.tree, &found.cells);
            assert!(left <= 1e-12 * whole, "{left} of {whole} is in no cell");
            // far away the coordinates of the mesh say the volume less exactly
            let extent = evaluation.solid.max - evaluation.solid.min;
            let rounding = 1e-14 * evaluation.solid.min.abs().max(evaluation.solid.max.abs()).max_element();
            let off = rounding * (extent.x * extent.y + extent.y * extent.z + extent.z * extent.x);
            assert!((found.volume_in - whole).abs() <= 1e-12 * whole + off, "{} {whole}", found.volume_in);
            assert!(found.volume_out >= whole - off, "{} {whole}", found.volume_out);
        }
    }
}

#[test]
fn one_cell_is_the_hull_but_for_rounding() {
    let ring = Tree::from(cuboid(DVec3::new(-3.0, -3.0, 0.0), DVec3::new(3.0, 3.0, 1.0))) - Tree::from(cube(-1.0, 1.0));
    let found = coarsened(&mesh_of(&ring), Bounded::Solid, 1);
    assert_eq!(found.volume_in, 32.0);
    assert!((found.volume_out - 36.0).abs() <= 36.0 * 1e-10, "{}", found.volume_out);
}

#[test]
fn a_frame_takes_four_cells() {
    let frame = Tree::from(cuboid(DVec3::new(-3.0, -3.0, 0.0), DVec3::new(3.0, 3.0, 1.0)))
        - Tree::from(cuboid(DVec3::new(-2.0, -2.0, -1.0), DVec3::new(2.0, 2.0, 2.0)));
    let found = coarsened(&mesh_of(&frame), Bounded::Solid, 4);
    assert_eq!(found.cells.len(), 4);
    assert!(found.excess() <= 1e-6, "{}", found.excess());
}

#[test]
fn shells_of_soups_hold_what_is_near_a_triangle() {
    for seed in 0..scaled(SOUPS) {
        let mut rng = Rng::spread(seed);
        let positions: Vec<DVec3> = (0..12).map(|_| DVec3::from_array(rng.lattice(4))).collect();
        let corner = |rng: &mut Rng| rng.below(positions.len()) as u32;
        let triangles: Vec<[u32; 3]> = (0..10).map(|_| [0; 3].map(|_| corner(&mut rng))).collect();
        eprintln!("seed {seed}: {positions:?}, {triangles:?}");
        let thickness = 0.25;
        let mesh = Mesh { positions, triangles, ..Mesh::default() };
        for cells in [1, 5, 40] {
            let found = coarsened(&mesh, Bounded::Shell { thickness }, cells);
            assert!(found.cells.len() <= cells);
            for triangle in &mesh.triangles {
                for _ in 0..20 {
                    let [u, v] = [0; 2].map(|_| rng.float(0.0, 1.0));
                    let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
                    let [a, b, c] = triangle.map(|corner| mesh.positions[corner as usize]);
                    let near = a + u * (b - a) + v * (c - a) + rng.unit() * 0.499 * thickness;
                    assert!(found.cells.iter().any(|cell| holds(cell, near)), "{near:?} is in no cell");
                }
            }
        }
    }
}

#[test]
fn surfaces_that_cross_or_cover_each_other_are_one_solid() {
    let (one, two) = (mesh_of(&cube(0.0, 2.0).into()), mesh_of(&cube(1.0, 3.0).into()));
    let joined = |parts: &[&Mesh]| {
        let mut all = Mesh::default();
        for part in parts {
            let first = all.positions.len() as u32;
            all.positions.extend_from_slice(&part.positions);
            all.triangles.extend(part.triangles.iter().map(|triangle| triangle.map(|corner| corner + first)));
        }
        all
    };
    for mesh in [joined(&[&one, &two]), joined(&[&one, &one, &two])] {
        let options = CoarsenOptions { max_cells: Some(2), ..CoarsenOptions::default() };
        let coarsener =
            Coarsener::of_surface(&surface(&mesh, Bounded::Solid), Some(15.0), &options).expect("a surface");
        let found = coarsener.coarsened().expect("cells");
        let union = Tree::union([cube(0.0, 2.0).into(), cube(1.0, 3.0).into()]);
        assert!(volume_outside(&union, &found.cells) <= 1e-12);
        assert!(found.excess() <= 0.35, "{}", found.excess());
    }
}

#[test]
fn a_box_without_a_lid_is_filled_or_not() {
    let open = without(&mesh_of(&cube(0.0, 4.0).into()), |corners| corners.iter().all(|p| p.z == 4.0));
    let middle = DVec3::splat(2.0);
    let filled = coarsened(&open, Bounded::Filled, 8);
    assert!(filled.cells.iter().any(|cell| holds(cell, middle)));
    assert_holds_points(&filled.cells, &open.positions);
    let shell = coarsened(&open, Bounded::Shell { thickness: 0.125 }, 8);
    assert!(!shell.cells.iter().any(|cell| holds(cell, middle)));
    assert_holds_points(&shell.cells, &open.positions);
    // five sides of 16
    assert_eq!(shell.volume_in, 10.0);
}

#[test]
fn regions_stay_clear() {
    let wall = |low: f64, high: f64| Tree::from(cuboid(DVec3::new(low, 0.0, 0.0), DVec3::new(high, 1.0, 4.0)));
    let portal = Tree::union([
        wall(0.0, 2.0),
        wall(4.0, 6.0),
        cuboid(DVec3::new(0.0, 0.0, 3.0), DVec3::new(6.0, 1.0, 4.0)).into(),
    ]);
    let door = Tree::from(cuboid(DVec3::new(2.0, 0.0, 0.0), DVec3::new(4.0, 1.0, 3.0)));
    let mesh = mesh_of(&portal);
    for cells in [1, 2, 3, 5] {
        let options =
            CoarsenOptions { max_cells: Some(cells), keep_clear: Some(door.clone()), ..CoarsenOptions::default() };
        let coarsener = Coarsener::of_surface(&surface(&mesh, Bounded::Solid), None, &options).expect("a surface");
        let found = coarsener.coarsened().expect("cells");
        let through = Tree::union_of(found.cells.clone()) & door.clone();
        let covered = planecut_cells::Solid::from_tree(&through).volume().expect("bounded");
        // pieces are larger than the solid by rounding
        assert!(covered <= 1e-10, "{cells}: {covered}");
        assert!(volume_outside(&portal, &found.cells) <= 1e-12);
    }
}

#[test]
fn no_cell_reaches_across_a_gap() {
    let apart = Tree::union([cube(0.0, 1.0).into(), cube(9.0, 10.0).into()]);
    let mesh = mesh_of(&apart);
    let cells = |max_gap| {
        let options = CoarsenOptions { max_cells: Some(1), max_gap, ..CoarsenOptions::default() };
        let coarsener = Coarsener::of_surface(&surface(&mesh, Bounded::Solid), None, &options).expect("a surface");
        coarsener.coarsened().expect("cells").cells.len()
    };
    assert_eq!((cells(Some(1.0)), cells(Some(20.0)), cells(None)), (2, 1, 1));
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let mut rng = Rng::spread(7);
    let mesh = evaluate(&general_scene(&mut rng)).expect("a solid").mesh;
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| coarsened(&mesh, Bounded::Solid, 6))
    };
    let one = on(1);
    assert_eq!(one, on(2));
    assert_eq!(one, on(3));
}

#[test]
fn what_makes_no_sense_is_refused() {
    let mesh = mesh_of(&cube(0.0, 1.0).into());
    let refused = |mesh: &Mesh, options: &CoarsenOptions| {
        Coarsener::of_surface(&surface(mesh, Bounded::Solid), None, options).expect_err("it is refused")
    };
    assert_eq!(refused(&Mesh::default(), &CoarsenOptions::default()), CoarsenError::Empty);
    let point = Mesh { positions: vec![DVec3::ONE; 3], triangles: vec![[0, 1, 2]], ..Mesh::default() };
    assert_eq!(refused(&point, &CoarsenOptions::default()), CoarsenError::Empty);
    for options in [
        CoarsenOptions { overlap_weight: Some(f64::NAN), ..CoarsenOptions::default() },
        CoarsenOptions { max_gap: Some(-1.0), ..CoarsenOptions::default() },
        CoarsenOptions { side: planecut_cells::coarsen::Side::Inner, ..CoarsenOptions::default() },
    ] {
        assert!(matches!(refused(&mesh, &options), CoarsenError::Option { .. }));
    }
}

#[test]
fn materials_stay_apart() {
    let mesh = mesh_of(&Tree::union([cube(0.0, 1.0).into(), cube(2.0, 3.0).into()]));
    let material = |triangle: &[u32; 3]| MaterialId(u32::from(mesh.positions[triangle[0] as usize].x >= 2.0));
    let materials: Vec<MaterialId> = mesh.triangles.iter().map(material).collect();
    let surface = Surface { materials: &materials, ..surface(&mesh, Bounded::Solid) };
    let options = CoarsenOptions { max_cells: Some(1), by_material: true, ..CoarsenOptions::default() };
    let found = Coarsener::of_surface(&surface, None, &options).expect("a surface").coarsened().expect("cells");
    let mut found: Vec<MaterialId> = found.cells.iter().map(|cell| cell.faces[0].material).collect();
    found.sort_unstable();
    assert_eq!(found, [MaterialId(0), MaterialId(1)]);
}
