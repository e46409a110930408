//! A city as a tile set: `cargo run --release --example tiles -- FOLDER [BUILDINGS [TILES_PER_FILE]]`.

use std::error::Error;
use std::io;
use std::path::Path;
use std::time::Instant;

use planecut::csg::{
    BlockOptions, Brush, Material, MaterialId, Mesh, Model, Tree, evaluate_in_blocks, sine_and_cosine,
};
use planecut::kernel::{DVec3, HalfSpace};
use planecut::tiles::{TileLeaf, TileOptions, TileSource, write_tiles};

/// Brushes of a block.
const BRUSHES: usize = 100;

/// From one street to the next in metres, and the width of streets.
const STREETS: [f64; 2] = [30.0, 9.0];

/// Blocks in memory. Those of models that are larger would be read from files.
#[derive(Default)]
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

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = arguments.next().ok_or("found no folder, expected one")?;
    let buildings = arguments.next().map_or(Ok(1_000), |number| number.parse())?;
    let mut options = TileOptions::default();
    if let Some(number) = arguments.next() {
        options.tiles_per_file = number.parse()?;
    }
    let model = city(buildings)?;
    let start = Instant::now();
    let mut blocks = Vec::new();
    evaluate_in_blocks(&model, BlockOptions { brushes: BRUSHES }, |block| {
        blocks.push((block.min, block.max, block.mesh));
        Ok::<(), Box<dyn Error>>(())
    })
    .map_err(|error| error.to_string())?;
    let blocks = in_grid(blocks);
    println!("{} brushes, {} blocks: {:.1?}", model.tree.brushes().len(), blocks.leaves.len(), start.elapsed());
    let start = Instant::now();
    let summary = write_tiles(&blocks, Path::new(&folder), &options)?;
    println!("written in {:.1?}: {} documents, {} bytes of GLBs", start.elapsed(), summary.documents, summary.bytes);
    for (height, tiles) in summary.tiles.iter().enumerate() {
        let (triangles, error) = (summary.triangles[height], summary.errors[height]);
        println!("height {height}: {tiles} tiles, {triangles} triangles, within {error:.3} m");
    }
    Ok(())
}

/// Numbers that look random, from 0 to 1.
fn noise(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 40) as f64 / f64::from(1 << 24)
}

/// Buildings between streets, higher towards the middle, some with a tower that is turned.
fn city(buildings: usize) -> Result<Model, Box<dyn Error>> {
    let [step, street] = STREETS;
    let side = (buildings as f64).sqrt().ceil();
    let reach = side * step / 2.0;
    let mut brushes = vec![Brush::cuboid([-reach, -reach, -2.0], [reach, reach, 0.0], MaterialId(0))];
    let mut seed = 1;
    for number in 0..buildings {
        let corner = DVec3::new((number as f64 % side).floor(), (number as f64 / side).floor(), 0.0) * step;
        let corner = corner - DVec3::new(reach, reach, 0.0) + DVec3::new(street, street, -1.0) / 2.0;
        let width = step - street;
        let far = corner.truncate().length() / reach;
        let height = (6.0 + 60.0 * noise(&mut seed).powi(2) * (1.2 - far).max(0.1)).round();
        let material = MaterialId(1 + (noise(&mut seed) * 4.0) as u32);
        let size = DVec3::new(width * (0.7 + 0.3 * noise(&mut seed)), width * (0.7 + 0.3 * noise(&mut seed)), height);
        brushes.push(Brush::cuboid(corner, corner + size, material));
        if height > 20.0 {
            let (sine, cosine) = sine_and_cosine((noise(&mut seed) * 90.0).round());
            let middle = corner + DVec3::new(size.x / 2.0, size.y / 2.0, height);
            let sides = [(cosine, sine), (-sine, cosine), (-cosine, -sine), (sine, -cosine)];
            let planes = sides.map(|(x, y)| (DVec3::new(x, y, 0.0), width / 4.0)).into_iter();
            let planes = planes.chain([(DVec3::Z, height / 2.0), (DVec3::NEG_Z, height / 2.0)]);
            let planes = planes.map(|(normal, half)| HalfSpace::new(normal, normal.dot(middle) + half));
            brushes.push(Brush::from_half_spaces(planes.collect::<Result<Vec<_>, _>>()?, MaterialId(5)));
        }
    }
    let colors = [
        ("ground", [0.25, 0.27, 0.25]),
        ("brick", [0.5, 0.2, 0.13]),
        ("sandstone", [0.65, 0.5, 0.3]),
        ("concrete", [0.5, 0.5, 0.5]),
        ("plaster", [0.75, 0.72, 0.65]),
        ("glass", [0.15, 0.3, 0.45]),
    ];
    let material = |(name, color): (&str, _)| Material { color: Some(color), ..Material::named(name) };
    Ok(Model { materials: colors.map(material).to_vec(), tree: Tree::union_of(brushes) })
}

/// The places of blocks follow from where their boxes end.
fn in_grid(blocks: Vec<(DVec3, DVec3, Mesh)>) -> Blocks {
    let walls = [0, 1, 2].map(|axis| {
        let mut walls: Vec<f64> = blocks.iter().map(|(min, _, _)| min[axis]).collect();
        walls.sort_by(f64::total_cmp);
        walls.dedup();
        walls
    });
    let place = |min: DVec3| [0, 1, 2].map(|axis| walls[axis].partition_point(|wall| *wall < min[axis]) as u32);
    let leaf = |(min, max, mesh)| (TileLeaf { place: place(min), min, max }, mesh);
    let mut all: Vec<(TileLeaf, Mesh)> = blocks.into_iter().map(leaf).collect();
    all.sort_by_key(|(leaf, _)| leaf.place);
    let (leaves, meshes) = all.into_iter().unzip();
    Blocks { leaves, meshes }
}
