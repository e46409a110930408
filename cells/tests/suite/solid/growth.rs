//! How many cells there are.

use glam::DVec3;
use planecut_cells::{CellPlane, Solid};
use planecut_csg::{Brush, MaterialId, Tree};

use std::time::Instant;

use planecut_testkit::generate::{ball, turned_box};
use planecut_testkit::random::Rng;
use planecut_testkit::scene::half_space;

fn block(min: DVec3, max: DVec3) -> Tree {
    Tree::from(Brush::cuboid(min, max, MaterialId(0)))
}

/// A block minus turned cubes, as dense whatever their number, and the volume of one cube.
fn block_without_cubes(count: u32) -> Solid {
    let mut rng = Rng::spread(count.into());
    let side = 5.0 * f64::from(count).cbrt();
    let cubes = (0..count).map(|_| {
        let at = rng.point(0.0, side);
        Tree::from(turned_box(&mut rng, at, DVec3::ONE))
    });
    Solid::from_tree(&Tree::difference([block(DVec3::ZERO, DVec3::splat(side))].into_iter().chain(cubes)))
}

#[test]
fn cells_grow_about_linearly_with_what_is_subtracted() {
    let counts = [375, 750, 1500, 3000].map(|count| (count, block_without_cubes(count).cells().count()));
    let [first, .., last] = counts;
    let exponent = (last.1 as f64 / first.1 as f64).ln() / (f64::from(last.0) / f64::from(first.0)).ln();
    assert!(exponent < 1.1, "cells grow as N^{exponent}: {counts:?}");
}

#[test]
fn cells_do_not_depend_on_the_number_of_threads() {
    let planes_with = |threads: usize| -> Vec<Vec<CellPlane>> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        let solid = pool.install(|| block_without_cubes(120));
        solid.cells().map(|cell| cell.planes().map(|(_, plane)| *plane).collect()).collect()
    };
    let single = planes_with(1);
    assert!(single.len() > 120 && [2, 3, 7].into_iter().all(|threads| planes_with(threads) == single));
}

/// A block cut out of the middle of a body with thousands of faces: each piece has few of these, and none of the memory of the others.
#[test]
fn pieces_of_a_body_of_many_faces_are_as_small_as_they_are() {
    let mut rng = Rng::spread(3);
    let body = Tree::from(ball(&mut rng, DVec3::ZERO, 10.0, 2000));
    let block = block(DVec3::new(-20.0, -4.0, -4.0), DVec3::new(20.0, 4.0, 4.0));
    let whole = Solid::from_tree(&body);
    let (left, taken) = (Solid::from_tree(&(body.clone() - block.clone())), Solid::from_tree(&(body & block)));
    let volume = |solid: &Solid| solid.volume().expect("bounded");
    assert!((volume(&left) + volume(&taken) - volume(&whole)).abs() < 1e-12 * volume(&whole));
    for cell in left.cells() {
        let (count, last) = (cell.planes().count(), cell.planes().last().expect("planes").0);
        assert!(last.0 < 64.max(4 * count), "{count} planes have handles up to {last:?}");
    }
}

/// Bars through all square holes of a Menger sponge of side `3^depth`, none within another.
fn menger_bars(depth: u32) -> Vec<Tree> {
    let side = 3_u32.pow(depth);
    let is_hole = |mut a: u32, mut b: u32, levels: u32| {
        (0..levels).any(|_| {
            let hole = a % 3 == 1 && b % 3 == 1;
            (a, b) = (a / 3, b / 3);
            hole
        })
    };
    let mut bars = Vec::new();
    for level in 0..depth {
        let (cells, width) = (3_u32.pow(level), f64::from(side / 3_u32.pow(level + 1)));
        for (a, b) in (0..cells).flat_map(|a| (0..cells).map(move |b| (a, b))).filter(|(a, b)| !is_hole(*a, *b, level))
        {
            let [u, v] = [a, b].map(|k| f64::from(3 * k + 1) * width);
            for axis in 0..3 {
                let place = |along: f64, shift: f64| {
                    let mut point = DVec3::splat(along);
                    point[(axis + 1) % 3] = u + shift;
                    point[(axis + 2) % 3] = v + shift;
                    point
                };
                bars.push(block(place(-1.0, 0.0), place(f64::from(side) + 1.0, width)));
            }
        }
    }
    bars
}

#[test]
fn a_menger_sponge_has_the_volume_of_its_boxes() {
    let bars = menger_bars(3);
    assert_eq!(bars.len(), 219);
    let sponge = Solid::from_tree(&Tree::difference([block(DVec3::ZERO, DVec3::splat(27.0))].into_iter().chain(bars)));
    assert_eq!(sponge.volume(), Some(8000.0));
    // 20 · 20 · 20 unit boxes; each box of side 9 that is left has 8 corners and 12 edges, and cells reach across them
    assert!(sponge.cells().count() < 2700, "{} cells", sponge.cells().count());
    assert_eq!(sponge.connected_components().len(), 1);
}

/// The same sponge as the union of its boxes.
#[test]
fn a_menger_sponge_of_eight_thousand_boxes() {
    let is_hole = |k: [u32; 3], level: u32| k.iter().filter(|v| **v / 3_u32.pow(level) % 3 == 1).count() >= 2;
    let all = (0..27_u32.pow(3)).map(|k| [k % 27, k / 27 % 27, k / 729]);
    let filled = all.filter(|k| (0..3).all(|level| !is_hole(*k, level)));
    let corners = filled.map(|k| DVec3::from_array(k.map(f64::from)));
    let boxes: Vec<Brush> = corners.map(|at| Brush::cuboid(at, at + 1.0, MaterialId(0))).collect();
    assert_eq!(boxes.len(), 8000);
    let sponge = Solid::from_tree(&Tree::union_of(boxes));
    assert_eq!(sponge.volume(), Some(8000.0));
    let bars = Tree::difference([block(DVec3::ZERO, DVec3::splat(27.0))].into_iter().chain(menger_bars(3)));
    assert!((&sponge ^ &Solid::from_tree(&bars)).is_empty());
    assert_eq!(sponge.area(), Solid::from_tree(&bars).area());
}

#[test]
fn boxes_of_a_grid_merge_into_one_cell() {
    let at = |x: u32, y: u32, z: u32| DVec3::new(x.into(), y.into(), z.into());
    let cubes = (0..6).flat_map(|x| (0..6).flat_map(move |y| (0..6).map(move |z| at(x, y, z))));
    let solid = Solid::from_tree(&Tree::union(cubes.map(|corner| block(corner, corner + 1.0))));
    assert_eq!((solid.cells().count(), solid.volume()), (1, Some(216.0)));
}

#[test]
fn one_body_leaves_one_piece_for_each_plane_that_cuts() {
    let wall = block(DVec3::ZERO, DVec3::new(10.0, 1.0, 10.0));
    let hole = block(DVec3::new(4.0, -1.0, 4.0), DVec3::new(6.0, 2.0, 6.0));
    assert_eq!(Solid::from_tree(&(wall.clone() - hole.clone())).cells().count(), 4);
    // a peg through the wall is left whole or in two parts, the wall stays one piece
    assert_eq!(Solid::from_tree(&(hole.clone() | wall.clone())).cells().count(), 3);
    assert_eq!((&Solid::from_tree(&hole) | &Solid::from_tree(&wall)).cells().count(), 3);
    let lid = block(DVec3::new(0.0, 1.0, 0.0), DVec3::new(10.0, 2.0, 10.0));
    assert_eq!(Solid::from_tree(&(wall - lid)).cells().count(), 1);
}

/// Time and number of cells of a tree's solid.
fn figure(name: &str, tree: &Tree) -> Solid {
    let begin = Instant::now();
    let solid = Solid::from_tree(tree);
    let time = begin.elapsed();
    eprintln!("{name}: {} leaves, {} cells, {time:.1?}", tree.brushes().len(), solid.cells().count());
    solid
}

#[test]
#[ignore = "2026-11-21: prints figures for people, asserts nothing"]
fn figures() {
    for count in [375, 750, 1500, 3000] {
        let begin = Instant::now();
        let cells = block_without_cubes(count).cells().count();
        eprintln!("block minus {count} turned cubes: {cells} cells, {:.1?}", begin.elapsed());
    }
    let mut sponge = figure(
        "sponge by bars",
        &Tree::difference([block(DVec3::ZERO, DVec3::splat(27.0))].into_iter().chain(menger_bars(3))),
    );
    let mut rng = Rng::spread(1);
    let mut balls = Vec::new();
    for _ in 0..250 {
        let at = rng.point(0.0, 20.0);
        balls.push(Tree::from(ball(&mut rng, at, 1.0, 100)));
    }
    figure(
        "block minus 250 balls",
        &Tree::difference([block(DVec3::ZERO, DVec3::splat(20.0))].into_iter().chain(balls.clone())),
    );
    figure("union of 250 balls", &Tree::union(balls));
    let cuts: Vec<_> = (0..100).map(|_| half_space(rng.unit(), rng.float(5.0, 30.0))).collect();
    let begin = Instant::now();
    for cut in &cuts {
        let id = sponge.add_plane(*cut);
        sponge.remove_plane(id);
    }
    eprintln!("cut and un-cut of the sponge: {:.1?}", begin.elapsed() / 100);
    let begin = Instant::now();
    let hits = (0..1000).filter(|_| sponge.ray_cast(rng.point(0.0, 27.0), rng.unit()).is_some()).count();
    eprintln!("{hits} hits of 1000 rays, {:.1?} a ray", begin.elapsed() / 1000);
    let begin = Instant::now();
    let mut row = Solid::empty();
    for k in 0..1000 {
        let at = DVec3::new(f64::from(k % 10), f64::from(k / 10 % 10), f64::from(k / 100)) * 1.5;
        row |= &Solid::from_tree(&block(at, at + 2.0));
    }
    eprintln!("1000 boxes, one after the other: {} cells, {:.1?}", row.cells().count(), begin.elapsed());
}
