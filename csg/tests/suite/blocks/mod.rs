//! Models in blocks against the same models at once.

use std::collections::BTreeMap;

use glam::DVec3;
use planecut_csg::{
    BlockOptions, BlocksError, Brush, BrushFace, EvaluateError, Material, MaterialId, Mesh, Model, Transform, Tree,
    UnboundedBrush, evaluate, evaluate_in_blocks,
};
use planecut_kernel::HalfSpace;

use planecut_testkit::generate::{ball, turned_box};
use planecut_testkit::random::Rng;

/// Meshes put together: each edge between positions is met as often in either direction.
fn is_closed(meshes: &[Mesh]) -> bool {
    let mut edges: BTreeMap<[[u64; 3]; 2], i32> = BTreeMap::new();
    for mesh in meshes {
        for triangle in &mesh.triangles {
            let at = triangle.map(|vertex| (mesh.positions[vertex as usize] + 0.0).to_array().map(f64::to_bits));
            for k in 0..3 {
                let (from, to) = (at[k], at[(k + 1) % 3]);
                *edges.entry([from.min(to), from.max(to)]).or_default() += if from < to { 1 } else { -1 };
            }
        }
    }
    edges.values().all(|sum| *sum == 0)
}

/// Volume, and area of each material.
fn measure(meshes: &[Mesh], materials: usize) -> (f64, Vec<f64>) {
    let (mut volume, mut areas) = (0.0, vec![0.0; materials]);
    for mesh in meshes {
        for (triangle, face) in mesh.triangles.iter().zip(&mesh.triangle_faces) {
            let [a, b, c] = triangle.map(|vertex| mesh.positions[vertex as usize]);
            let normal = (b - a).cross(c - a);
            volume += a.dot(normal) / 6.0;
            areas[mesh.faces[*face as usize].material.0 as usize] += 0.5 * normal.length();
        }
    }
    (volume, areas)
}

/// Compares a model in blocks with the same at once; gives how many blocks there were.
fn compare(model: &Model, brushes: usize) -> usize {
    let (mut meshes, mut area) = (Vec::new(), 0.0);
    let all = evaluate_in_blocks(model, BlockOptions { brushes }, |block| {
        area += block.solid.area;
        for at in &block.mesh.positions {
            assert!(at.cmpge(block.min).all() && at.cmple(block.max).all());
        }
        meshes.push(block.mesh);
        Ok::<(), ()>(())
    })
    .unwrap();
    let whole = evaluate(model).unwrap();
    assert_eq!((all.blocks, all.open_edges), (meshes.len(), 0));
    assert_eq!(all.triangles, meshes.iter().map(|mesh| mesh.triangles.len()).sum::<usize>());
    assert!(is_closed(&meshes));
    let (volume, areas) = measure(&meshes, model.materials.len());
    let (_, expected) = measure(&[whole.mesh], model.materials.len());
    let tolerance = 1e-9 * (1.0 + whole.solid.volume.abs() + whole.solid.area);
    assert!((all.volume - whole.solid.volume).abs() < tolerance);
    assert!((volume - whole.solid.volume).abs() < tolerance);
    assert!((area - whole.solid.area).abs() < tolerance, "{area} {}", whole.solid.area);
    assert!(areas.iter().zip(&expected).all(|(a, b)| (a - b).abs() < tolerance), "{areas:?} {expected:?}");
    meshes.len()
}

fn materials() -> Vec<Material> {
    ["stone", "brick"].map(Material::named).to_vec()
}

/// Brushes of all kinds in a long room, of two materials.
fn brushes(rng: &mut Rng, count: usize) -> Vec<Brush> {
    let brush = |_| {
        let at = DVec3::new(rng.float(0.0, 12.0), rng.float(0.0, 5.0), rng.float(0.0, 3.0));
        let mut brush = match rng.below(3) {
            0 => {
                let low = at.floor();
                let size = DVec3::from_array([0; 3].map(|_| rng.whole(1, 3)));
                Brush::cuboid(low, low + size, MaterialId(0))
            }
            1 => turned_box(rng, at, DVec3::splat(0.8)),
            _ => ball(rng, at, 0.9, 24),
        };
        let material = MaterialId(rng.below(2) as u32);
        brush.faces.iter_mut().for_each(|face| face.material = material);
        brush
    };
    (0..count).map(brush).collect()
}

#[test]
fn unions_and_differences_are_the_same_in_blocks() {
    for seed in 0..12 {
        let rng = &mut Rng::spread(seed);
        let parts: Vec<Tree> = brushes(rng, 60).into_iter().map(Tree::from).collect();
        let (first, rest) = parts.split_at(40);
        let tree = match seed % 4 {
            0 => Tree::union(parts.clone()),
            1 => Tree::union(first.to_vec()) - Tree::union(rest.to_vec()),
            2 => Tree::union(first.to_vec()) ^ Tree::union(rest.to_vec()),
            _ => Tree::union(first.to_vec()) & !Tree::union(rest.to_vec()),
        };
        let blocks = compare(&Model { materials: materials(), tree }, 6);
        assert!(blocks > 8, "seed {seed}: {blocks} blocks");
    }
}

#[test]
fn what_cannot_be_parted_stays_one_block() {
    let cube = Tree::from(Brush::cuboid(DVec3::ZERO, DVec3::ONE, MaterialId(0)));
    let tree = Tree::union(vec![cube; 20]);
    assert_eq!(compare(&Model { materials: materials(), tree }, 1), 1);
    let none = Model { materials: materials(), tree: Tree::empty() };
    assert_eq!(compare(&none, 1), 0);
}

#[test]
fn planes_of_noise_are_one_in_all_blocks() {
    // a row of boxes whose common turned walls went through decimal text
    let (sin, cos) = 0.3_f64.sin_cos();
    let brush = |k: u32| {
        let noise = |v: f64| v * (1.0 + f64::from(k % 7) * 2e-14);
        let at = f64::from(k);
        let planes = [
            (DVec3::new(noise(cos), sin, 0.0), 1.0),
            (DVec3::new(-noise(cos), -sin, 0.0), 0.0),
            (DVec3::new(-sin, noise(cos), 0.0), at + 1.0),
            (DVec3::new(sin, -noise(cos), 0.0), -at),
            (DVec3::Z, 1.0),
            (-DVec3::Z, 0.0),
        ];
        Brush::from_half_spaces(planes.map(|(normal, at)| HalfSpace::new(normal, at).unwrap()), MaterialId(0))
    };
    let model = Model { materials: materials(), tree: Tree::union_of((0..60).map(brush).collect()) };
    assert!(compare(&model, 5) > 8);
}

#[test]
fn what_is_not_bounded_is_refused() {
    let half = Brush::from_half_spaces([HalfSpace::new(DVec3::X, 1.0).unwrap()], MaterialId(0));
    let cube = Brush::cuboid(DVec3::ZERO, DVec3::ONE, MaterialId(0));
    let run = |tree: Tree| {
        let model = Model { materials: materials(), tree };
        evaluate_in_blocks(&model, BlockOptions::default(), |_| Ok::<(), ()>(()))
    };
    assert_eq!(run(Tree::from(cube.clone()) - half.into()), Err(UnboundedBrush { brush: 1, is_mesh: false }.into()));
    assert_eq!(run(!Tree::from(cube.clone())), Err(BlocksError::Evaluate(EvaluateError::Unbounded)));
    let refused =
        evaluate_in_blocks(&Model { materials: materials(), tree: cube.into() }, BlockOptions::default(), |_| {
            Err("full")
        });
    assert_eq!(refused, Err(BlocksError::Taker("full")));
}

/// Trees of all operations over brushes of which many are equal, or have faces on one plane.
fn random_of(seed: u64) -> Tree {
    let rng = &mut Rng::spread(1000 + seed);
    let mut parts: Vec<Tree> = brushes(rng, 40).into_iter().map(Tree::from).collect();
    while parts.len() > 1 {
        let count = 1 + rng.below(parts.len().min(6));
        let operands = parts.split_off(parts.len() - count);
        let tree = match rng.below(5) {
            0 => Tree::union(operands),
            1 => Tree::difference(operands),
            2 => Tree::xor(operands),
            3 => Tree::union(operands.iter().cloned()) - Tree::intersection(operands),
            // what is outside is taken from something, not from everything
            _ => Tree::intersection([operands[0].clone(), !Tree::union(operands[1..].to_vec())]),
        };
        let place = rng.below(parts.len() + 1);
        parts.insert(place, tree);
    }
    parts.pop().unwrap()
}

#[test]
fn random_trees_are_the_same_in_blocks() {
    for seed in 0..60 {
        println!("seed {seed}");
        compare(&Model { materials: materials(), tree: random_of(seed) }, 5);
    }
}

/// A slab is added and another one taken that are the same within one block alone: which of their coplanar faces the boundary gets may not be
/// decided there, or the blocks beside it decide otherwise.
#[test]
fn brushes_that_are_equal_in_one_block_alone_are_told_apart_there() {
    let slab = |low: f64, high: f64, material: u32| {
        Tree::from(Brush::cuboid(DVec3::new(low, 0.0, 0.0), DVec3::new(high, 4.0, 1.0), MaterialId(material)))
    };
    for (first, second) in [(0, 1), (1, 0)] {
        let tower = |k: u32| {
            let at = DVec3::new(f64::from(k), 1.0, -2.0);
            Tree::from(Brush::cuboid(at, at + DVec3::new(0.5, 1.0, 3.0), MaterialId(first)))
        };
        let long = slab(-3.0, 40.0, first);
        let taken = slab(-1.0, 30.0, second) & slab(-2.0, 44.0, first);
        let tree = (Tree::union((0..30).map(tower)) | long) ^ taken;
        assert!(compare(&Model { materials: materials(), tree }, 3) > 8);
    }
}

#[test]
fn blocks_fit_where_edges_are_as_short_as_noise() {
    // centimetres in the coordinates of a map of a country: what is shorter than 5e-6 there is noise
    let mut noise = 0;
    for seed in 0..6 {
        let rng = &mut Rng::spread(seed);
        let away = Transform::translation(DVec3::splat(5e6)).unwrap();
        let map = Transform::scale(DVec3::splat(1e-2)).unwrap().then(&away).unwrap();
        let tree = Tree::union_of(brushes(rng, 60)).transformed(&map).unwrap();
        let model = Model { materials: materials(), tree };
        let all = evaluate_in_blocks(&model, BlockOptions { brushes: 6 }, |block| {
            noise += block.noise.collapsed;
            Ok::<(), ()>(())
        });
        let all = all.unwrap();
        assert_eq!((all.blocks > 8, all.open_edges), (true, 0), "seed {seed}");
    }
    assert!(noise > 0);
}

#[test]
fn faces_through_the_line_in_which_two_walls_cross_go_on_in_any_block_around_it() {
    // a slab along a diagonal through each line in which walls cross, one at a time: most leave the walls where they were
    let mut crossings = 0;
    for seed in 0..2 {
        let others = brushes(&mut Rng::spread(70 + seed), 60);
        let [across_x, across_y] = walls_of(&others);
        for (x, y) in across_x[1..].iter().flat_map(|x| across_y[1..].iter().map(move |y| (*x, *y))) {
            for slope in [1.0, -1.0, 0.5] {
                let normal = DVec3::new(1.0, slope, 0.0);
                let at = normal.dot(DVec3::new(x, y, 0.0));
                let slab = [HalfSpace::new(normal, at).unwrap(), HalfSpace::new(-normal, 0.25 - at).unwrap()];
                let mut brush = Brush::cuboid(DVec3::new(0.0, 0.0, 1.0), DVec3::new(12.0, 5.0, 1.75), MaterialId(1));
                brush.faces.extend(slab.map(|half_space| BrushFace { half_space, material: MaterialId(1) }));
                let tree = Tree::union_of(others.iter().cloned().chain([brush]).collect());
                let model = Model { materials: materials(), tree };
                let all = evaluate_in_blocks(&model, BlockOptions { brushes: 6 }, |block| {
                    crossings += block.seams.crossings.len();
                    Ok::<(), ()>(())
                });
                assert_eq!(all.unwrap().open_edges, 0, "seed {seed}: {x} {y} {slope}");
            }
        }
    }
    assert!(crossings > 10, "{crossings}");
}

/// The coordinates of the walls across x and y of a union in blocks.
fn walls_of(brushes: &[Brush]) -> [Vec<f64>; 2] {
    let model = Model { materials: materials(), tree: Tree::union_of(brushes.to_vec()) };
    let mut walls = [Vec::new(), Vec::new()];
    evaluate_in_blocks(&model, BlockOptions { brushes: 6 }, |block| {
        walls.iter_mut().enumerate().for_each(|(axis, walls)| walls.push(block.min[axis]));
        Ok::<(), ()>(())
    })
    .unwrap();
    for walls in &mut walls {
        walls.sort_by(f64::total_cmp);
        walls.dedup();
    }
    walls
}
