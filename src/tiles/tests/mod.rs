//! Tile sets of small cities, as they are on disk, against the blocks that they were made of.

mod files;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io;
use std::path::Path;

use planecut_csg::{BlockOptions, Brush, Material, MaterialId, Mesh, Model, Tree, evaluate_in_blocks};
use planecut_kernel::{DVec3, HalfSpace};
use planecut_testkit::random::Rng;

use self::files::Tile;
use super::*;

/// Blocks in memory.
struct Blocks {
    leaves: Vec<TileLeaf>,
    meshes: Vec<Mesh>,
}

impl TileSource for Blocks {
    fn leaves(&self) -> &[TileLeaf] {
        &self.leaves
    }

    fn mesh(&self, leaf: usize) -> io::Result<Mesh> {
        Ok(self.meshes[leaf].clone())
    }
}

impl Blocks {
    fn of(brushes: Vec<Brush>, most: usize) -> Self {
        let materials = vec![Material::named("ground"), Material::named("brick"), Material::named("glass")];
        let model = Model { materials, tree: Tree::union_of(brushes) };
        let mut blocks = Vec::new();
        let take = |block| {
            blocks.push(block);
            Ok::<(), ()>(())
        };
        let summary = evaluate_in_blocks(&model, BlockOptions { brushes: most }, take).expect("evaluated");
        assert_eq!(summary.open_edges, 0);
        let walls = [0, 1, 2].map(|axis| {
            let ends = blocks.iter().flat_map(|block| [block.min[axis], block.max[axis]]);
            // positive numbers sort as their bits do
            ends.map(|at| (at + 1000.0).to_bits()).collect::<BTreeSet<u64>>()
        });
        let place =
            |min: DVec3| [0, 1, 2].map(|axis| walls[axis].range(..(min[axis] + 1000.0).to_bits()).count() as u32);
        let mut all: Vec<(TileLeaf, Mesh)> = blocks
            .into_iter()
            .map(|block| (TileLeaf { place: place(block.min), min: block.min, max: block.max }, block.mesh))
            .collect();
        all.sort_by_key(|(leaf, _)| leaf.place);
        let (leaves, meshes) = all.into_iter().unzip();
        Self { leaves, meshes }
    }

    /// Towers on a ground, some of them turned, thin walls, masts, and balls in the air.
    fn city(seed: u64, count: usize, most: usize) -> Self {
        let mut rng = Rng::new(seed);
        let size = 20.0 * (count as f64).sqrt();
        let mut brushes = vec![Brush::cuboid([-size, -size, -1.0], [size, size, 0.0], MaterialId(0))];
        for number in 0..count {
            let at = DVec3::new(rng.whole(-(size as i64), size as i64), rng.whole(-(size as i64), size as i64), 0.0);
            let material = MaterialId(1 + number as u32 % 2);
            let half = match number % 8 {
                0 => DVec3::new(0.05, rng.float(2.0, 20.0), 2.0),
                1 => DVec3::new(0.04, 0.05, rng.float(5.0, 30.0)),
                2 => DVec3::splat(0.1),
                _ => DVec3::new(rng.whole(3, 9), rng.whole(3, 9), rng.whole(4, 40)),
            };
            let low = if number % 8 == 2 { rng.float(10.0, 60.0) } else { -0.5 };
            let middle = at + DVec3::Z * (low + half.z);
            let turn = if number % 3 == 0 { rng.rotation() } else { Default::default() };
            let planes =
                (0..3).flat_map(|axis| [DVec3::AXES[axis], -DVec3::AXES[axis]].map(|normal| (normal, half[axis])));
            let planes = planes.map(|(normal, half)| {
                let normal = turn * normal;
                HalfSpace::new(normal, normal.dot(middle) + half).expect("a plane")
            });
            brushes.push(Brush::from_half_spaces(planes.collect::<Vec<_>>(), material));
        }
        Self::of(brushes, most)
    }

    fn triangles(&self, leaf: usize) -> Vec<[DVec3; 3]> {
        let mesh = &self.meshes[leaf];
        mesh.triangles.iter().map(|corners| corners.map(|corner| mesh.positions[corner as usize])).collect()
    }
}

/// How far a point is from a triangle (Ericson 2005, by regions).
fn distance(p: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let normal = (b - a).cross(c - a);
    let of_segment = |from: DVec3, to: DVec3| {
        let along = to - from;
        let share =
            if along == DVec3::ZERO { 0.0 } else { ((p - from).dot(along) / along.length_squared()).clamp(0.0, 1.0) };
        p.distance(from + along * share)
    };
    let is_inside = |from: DVec3, to: DVec3| normal.cross(to - from).dot(p - from) >= 0.0;
    if normal != DVec3::ZERO && is_inside(a, b) && is_inside(b, c) && is_inside(c, a) {
        return normal.dot(p - a).abs() / normal.length();
    }
    of_segment(a, b).min(of_segment(b, c)).min(of_segment(c, a))
}

/// Random points of triangles, of those as likely by their area as by their number.
fn points(triangles: &[[DVec3; 3]], count: usize, rng: &mut Rng) -> Vec<DVec3> {
    let mut sums = vec![0.0];
    for [a, b, c] in triangles {
        sums.push(sums[sums.len() - 1] + (*b - *a).cross(*c - *a).length());
    }
    let point = |number: usize, rng: &mut Rng| {
        let (mut s, mut t) = (rng.float(0.0, 1.0), rng.float(0.0, 1.0));
        if s + t > 1.0 {
            (s, t) = (1.0 - s, 1.0 - t);
        }
        let [a, b, c] = triangles[number];
        a + (b - a) * s + (c - a) * t
    };
    let by_area = |rng: &mut Rng| {
        sums[1..].partition_point(|sum| *sum < rng.float(0.0, 1.0) * sums[triangles.len()]).min(triangles.len() - 1)
    };
    (0..count)
        .map(|k| {
            let number = if k % 2 == 0 { rng.below(triangles.len()) } else { by_area(rng) };
            point(number, rng)
        })
        .collect()
}

/// The largest distance of points from triangles that are seen.
fn farthest(points: &[DVec3], triangles: &[[DVec3; 3]]) -> f64 {
    let seen: Vec<&[DVec3; 3]> = triangles.iter().filter(|[a, b, c]| (*b - *a).cross(*c - *a) != DVec3::ZERO).collect();
    let nearest =
        |point: &DVec3| seen.iter().map(|triangle| distance(*point, **triangle)).fold(f64::INFINITY, f64::min);
    points.iter().map(nearest).fold(0.0, f64::max)
}

/// The tiles of each height that a tile set has, leaves first.
fn by_height(root: &Tile) -> Vec<Vec<&Tile>> {
    let mut heights = vec![vec![root]];
    while let Some(next) = heights
        .last()
        .map(|tiles| tiles.iter().flat_map(|tile| &tile.children).collect::<Vec<_>>())
        .filter(|next| !next.is_empty())
    {
        heights.push(next);
    }
    heights.reverse();
    heights
}

/// The triangles of all blocks under a tile.
fn below(tile: &Tile, blocks: &Blocks, scale: f64) -> Vec<[DVec3; 3]> {
    if tile.children.is_empty() {
        let name = tile.content.file_stem().expect("a name").to_string_lossy().into_owned();
        let place: Vec<u32> = name.split('-').map(|part| part.parse().expect("a number")).collect();
        let leaf = blocks.leaves.iter().position(|leaf| leaf.place == place[..]).expect("a block");
        return blocks.triangles(leaf).iter().map(|corners| corners.map(|corner| corner * scale)).collect();
    }
    tile.children.iter().flat_map(|child| below(child, blocks, scale)).collect()
}

fn edges_open(tiles: &[Vec<[DVec3; 3]>]) -> usize {
    let mut edges: BTreeMap<[[u64; 3]; 2], i32> = BTreeMap::new();
    for triangle in tiles.iter().flatten() {
        let at = triangle.map(|corner| (corner + 0.0).to_array().map(f64::to_bits));
        for (from, to) in [(at[0], at[1]), (at[1], at[2]), (at[2], at[0])] {
            *edges.entry([from.min(to), from.max(to)]).or_default() += if from < to { 1 } else { -1 };
        }
    }
    edges.values().filter(|sum| **sum != 0).count()
}

fn export(scale: f64, quantize: bool) -> ExportOptions {
    ExportOptions { scale, quantize, ..ExportOptions::default() }
}

/// Writes a tile set and checks all that it promises; gives the summary.
fn check(blocks: &Blocks, folder: &Path, options: &TileOptions, samples: usize) -> TilesSummary {
    let summary = write_tiles(blocks, folder, options).expect("written");
    let (root, documents) = files::read(folder);
    let heights = by_height(&root);
    assert_eq!(documents, summary.documents);
    assert_eq!(summary.tiles, heights.iter().map(Vec::len).collect::<Vec<_>>());
    assert_eq!(summary.tiles[0], blocks.meshes.iter().filter(|mesh| !mesh.triangles.is_empty()).count());
    let mut rng = Rng::new(5);
    let scale = options.export.scale;
    // the largest part of a bound that a distance is
    let mut nearest = 0.0_f64;
    for (height, tiles) in heights.iter().enumerate() {
        let contents: Vec<Vec<[DVec3; 3]>> = tiles.iter().map(|tile| files::triangles(&tile.content).0).collect();
        assert_eq!(summary.triangles[height], contents.iter().map(Vec::len).sum::<usize>());
        if height > 0 {
            assert_eq!(edges_open(&contents), 0, "height {height}");
        }
        for (tile, content) in tiles.iter().zip(&contents) {
            let content: Vec<[DVec3; 3]> = content.iter().map(|corners| corners.map(|corner| corner * scale)).collect();
            assert!(content.iter().flatten().all(|at| (*at - tile.center).abs().cmple(tile.half).all()));
            for child in &tile.children {
                assert!(child.error < tile.error, "{} {}", child.error, tile.error);
                assert!(((child.center - tile.center).abs() + child.half).cmple(tile.half * (1.0 + 1e-9)).all());
            }
            if height == 0 {
                assert_eq!(tile.error, 0.0);
                continue;
            }
            let fine = below(tile, blocks, scale);
            let far = farthest(&points(&fine, samples, &mut rng), &content)
                .max(farthest(&points(&content, samples, &mut rng), &fine));
            assert!(far <= tile.error, "{}: {far} of {}", tile.content.display(), tile.error);
            nearest = nearest.max(far / tile.error);
        }
    }
    // a bound that says nothing would pass the rest
    assert!(nearest > 0.25 || samples < 30, "{nearest}");
    summary
}

#[test]
fn tiles_are_as_near_as_they_say_and_fit_together() {
    let folder = tempfile::tempdir().expect("folder");
    let blocks = Blocks::city(1, 300, 8);
    let options = TileOptions { triangles: 700, export: export(0.3048, false), ..TileOptions::default() };
    let summary = check(&blocks, &folder.path().join("city"), &options, 150);
    assert!(summary.tiles.len() >= 4 && summary.tiles[0] >= 30, "{summary:?}");
    // cells grew until there were few enough
    let (root, _) = files::read(&folder.path().join("city"));
    for tile in by_height(&root)[1..].iter().flatten() {
        let (triangles, json) = files::triangles(&tile.content);
        assert!(triangles.len() <= 700, "{}", triangles.len());
        let is_open = edges_open(&[triangles]) > 0;
        assert!(!is_open || !json.to_string().contains("EXT_mesh_manifold"));
    }
}

#[test]
fn tiles_on_the_grid_of_16_bits_fit_together() {
    let folder = tempfile::tempdir().expect("folder");
    let options = TileOptions { triangles: 2_000, export: export(1.0, true), ..TileOptions::default() };
    check(&Blocks::city(2, 150, 10), &folder.path().join("city"), &options, 60);
}

#[test]
fn a_city_far_from_the_origin_fits_together() {
    let folder = tempfile::tempdir().expect("folder");
    let mut blocks = Blocks::city(3, 60, 6);
    // a number that all coordinates can be moved by without rounding differently on both sides of a wall
    let far = DVec3::new(3e7, -2e7, 1e3);
    for leaf in &mut blocks.leaves {
        (leaf.min, leaf.max) = (leaf.min + far, leaf.max + far);
    }
    blocks.meshes.iter_mut().flat_map(|mesh| &mut mesh.positions).for_each(|at| *at += far);
    check(&blocks, &folder.path().join("city"), &TileOptions::default(), 60);
}

#[test]
fn tiles_that_are_thinner_than_cells_fit_together() {
    let folder = tempfile::tempdir().expect("folder");
    let mut rng = Rng::new(6);
    let mut brush = || {
        let low = rng.point(0.0, 1.0) * DVec3::new(60.0, 60.0, 300.0);
        let size = rng.point(0.2, 1.0) * DVec3::new(20.0, 20.0, 60.0);
        Brush::cuboid(low, low + size, MaterialId(1))
    };
    let mut blocks = Blocks::of((0..150).map(|_| brush()).collect(), 4);
    let flat = DVec3::new(1.0, 1.0, 1.0 / 1024.0);
    for leaf in &mut blocks.leaves {
        (leaf.min, leaf.max) = (leaf.min * flat, leaf.max * flat);
    }
    blocks.meshes.iter_mut().flat_map(|mesh| &mut mesh.positions).for_each(|at| *at *= flat);
    let places = |axis: usize| blocks.leaves.iter().map(|leaf| leaf.place[axis]).collect::<BTreeSet<_>>().len();
    assert!(places(2) > 4 && places(0) > 1 && places(1) > 1);
    let options = TileOptions { triangles: 400, ..TileOptions::default() };
    check(&blocks, &folder.path().join("layers"), &options, 30);
}

#[test]
fn many_tiles_are_in_several_documents() {
    let folder = tempfile::tempdir().expect("folder");
    let beams = (0..40).map(|k| Brush::cuboid([f64::from(k), 0.0, 0.0], [f64::from(k) + 0.5, 1.0, 1.0], MaterialId(1)));
    let blocks = Blocks::of(beams.collect(), 1);
    let options = TileOptions { tiles_per_file: 10, ..TileOptions::default() };
    let summary = check(&blocks, &folder.path().join("beams"), &options, 20);
    assert!(summary.documents > 4, "{summary:?}");
    let bytes: u64 = walk(&folder.path().join("beams"))
        .iter()
        .filter(|(name, _)| name.ends_with(".glb"))
        .map(|(_, bytes)| bytes.len() as u64)
        .sum();
    assert_eq!(summary.bytes, bytes);
}

/// All files under a folder by their paths.
fn walk(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files = BTreeMap::new();
    for entry in fs::read_dir(folder).expect("folder") {
        let path = entry.expect("entry").path();
        if path.is_dir() {
            files.append(&mut walk(&path));
        } else {
            files.insert(path.display().to_string(), fs::read(&path).expect("read"));
        }
    }
    files
}

#[test]
fn the_number_of_threads_changes_no_byte() {
    let folder = tempfile::tempdir().expect("folder");
    let blocks = Blocks::city(4, 100, 6);
    let path = folder.path().join("city");
    let of_threads = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| write_tiles(&blocks, &path, &TileOptions::default())).expect("written");
        walk(&path)
    };
    let one = of_threads(1);
    assert!(one.len() > 10 && one.keys().all(|name| !name.contains("meshes")));
    assert!(one == of_threads(5));
    assert_eq!(fs::read_dir(folder.path()).expect("folder").count(), 1);
}

#[test]
fn one_block_is_a_tile_set_of_one_tile() {
    let folder = tempfile::tempdir().expect("folder");
    let blocks = Blocks::of(vec![Brush::cuboid([0.0; 3], [1.0, 2.0, 3.0], MaterialId(2))], 10);
    let summary = check(&blocks, &folder.path().join("box"), &TileOptions::default(), 10);
    assert_eq!(
        (summary.tiles, summary.triangles, summary.errors, summary.documents),
        (vec![1], vec![12], vec![0.0], 1)
    );
}

#[test]
fn what_fails_leaves_nothing_behind() {
    struct Failing(Vec<TileLeaf>);
    impl TileSource for Failing {
        fn leaves(&self) -> &[TileLeaf] {
            &self.0
        }

        fn mesh(&self, leaf: usize) -> io::Result<Mesh> {
            if leaf == 1 { Err(io::Error::other("torn page")) } else { Ok(Mesh::default()) }
        }
    }
    let folder = tempfile::tempdir().expect("folder");
    let path = folder.path().join("tiles");
    let leaf = |place: u32| TileLeaf {
        place: [place, 0, 0],
        min: DVec3::X * f64::from(place),
        max: DVec3::ONE + DVec3::X * f64::from(place),
    };
    let of = |count| write_tiles(&Failing((0..count).map(leaf).collect()), &path, &TileOptions::default());
    assert!(matches!(of(0), Err(TilesError::Empty { blocks: 0 })));
    assert!(matches!(of(1), Err(TilesError::Empty { blocks: 1 })));
    assert_eq!(of(2).expect_err("torn").to_string(), "block (1, 0, 0): torn page");
    assert_eq!(fs::read_dir(folder.path()).expect("folder").count(), 0);
}
