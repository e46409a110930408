//! Procedural modelling: a town of some thousand parts, made by a few lines, evaluated as one solid.
//!
//! ```sh
//! cargo run --release --example procedural            # writes out/town.glb and out/town.png
//! ```

use std::error::Error;
use std::time::Instant;

use planecut::csg::{Brush, Material, MaterialId, Model, Tree, evaluate, primitives};
use planecut::export::{ExportOptions, Format, PreviewOptions, Subject, encode, render, write_atomic};
use planecut::kernel::DVec3;

const GROUND: MaterialId = MaterialId(0);
const WALL: MaterialId = MaterialId(1);
const ROOF: MaterialId = MaterialId(2);
const WATER: MaterialId = MaterialId(3);

/// Houses along each side of the town.
const HOUSES: u32 = 30;
/// From one house to the next.
const LOT: f64 = 12.0;

fn main() -> Result<(), Box<dyn Error>> {
    let model = Model { materials: materials(), tree: town()? };
    let begin = Instant::now();
    let town = evaluate(&model)?;
    println!(
        "{} brushes in {:.1} ms: volume {}, {} triangles, {} faces",
        town.model.brushes,
        begin.elapsed().as_secs_f64() * 1e3,
        town.solid.volume,
        town.mesh.triangles.len(),
        town.mesh.faces.len(),
    );
    std::fs::create_dir_all("out")?;
    write_atomic("out/town.glb", &encode(&town.mesh, Format::Glb, &ExportOptions::default())?)?;
    write_atomic("out/town.png", &render(&Subject::of_mesh(&town.mesh), &PreviewOptions::default())?.to_png()?)?;
    Ok(())
}

fn materials() -> Vec<Material> {
    let colors = [
        ("ground", [0.2, 0.27, 0.11]),
        ("wall", [0.62, 0.56, 0.47]),
        ("roof", [0.4, 0.13, 0.08]),
        ("water", [0.08, 0.2, 0.3]),
    ];
    colors.map(|(name, color)| Material { color: Some(color), ..Material::named(name) }).into()
}

/// The ground without a canal, the water in it, and the houses that do not stand in the way.
fn town() -> Result<Tree, Box<dyn Error>> {
    let size = LOT * f64::from(HOUSES);
    let block = |min: [f64; 3], max: [f64; 3], material| {
        Tree::from(Brush::cuboid(DVec3::from_array(min), DVec3::from_array(max), material))
    };
    let canal = |floor: f64, top: f64, material| {
        let bend = |x: f64| [[x, 0.4 * size - 0.2 * x], [x, 0.4 * size - 0.2 * x + 2.0 * LOT]];
        let corners = [-1.0, size + 1.0].into_iter().flat_map(bend);
        let points: Vec<DVec3> = corners.flat_map(|[x, y]| [DVec3::new(x, y, floor), DVec3::new(x, y, top)]).collect();
        primitives::hull_of_points(&points, material).map(Tree::from)
    };
    let ground = block([0.0, 0.0, -6.0], [size, size, 0.0], GROUND);
    let banks = canal(-4.0, 60.0, GROUND)?;
    let water = canal(-4.0, -2.0, WATER)? & ground.clone();
    let is_dry = |number: &u32| {
        let [x, y] = lot(*number);
        (y - (0.4 * size - 0.2 * x + LOT)).abs() > 1.75 * LOT
    };
    let houses = (0..HOUSES * HOUSES).filter(is_dry).map(house).collect::<Result<Vec<Tree>, _>>()?;
    Ok((ground - banks) | Tree::union(houses) | water)
}

/// The middle of a house.
fn lot(number: u32) -> [f64; 2] {
    [number % HOUSES, number / HOUSES].map(|place| LOT * (f64::from(place) + 0.5))
}

/// A house with a gabled roof and a chimney, its size from its number.
fn house(number: u32) -> Result<Tree, Box<dyn Error>> {
    // Some digits of the number's multiple of the golden ratio: scattered, and the same on every run.
    let scatter = |k: u32| f64::from((number * 16 + k).wrapping_mul(0x9E37_79B9) >> 24) / 256.0;
    let [x, y] = lot(number);
    let (a, b, height) =
        (3.0 + (1.9 * scatter(0)).round(), 3.0 + (1.9 * scatter(1)).round(), 4.0 + (9.0 * scatter(2)).round());
    let at = |dx: f64, dy: f64, z: f64| DVec3::new(x + dx, y + dy, z);
    let walls = Tree::from(Brush::cuboid(at(-a, -b, -1.0), at(a, b, height), WALL));
    let eaves = [(-a, -b), (a, -b), (-a, b), (a, b)].map(|(dx, dy)| at(1.1 * dx, 1.1 * dy, height));
    let ridge = if a > b {
        [at(-a, 0.0, height + b), at(a, 0.0, height + b)]
    } else {
        [at(0.0, -b, height + a), at(0.0, b, height + a)]
    };
    let roof = primitives::hull_of_points(&[&eaves[..], &ridge].concat(), ROOF)?;
    let chimney = Brush::cuboid(at(1.0, 1.0, height), at(2.0, 2.0, height + a.min(b) + 1.0), WALL);
    Ok(Tree::union([walls, roof.into(), chimney.into()]))
}
