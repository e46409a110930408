//! Times of the library that the Python package is held against: `library_times [LEVEL.map]` prints microseconds as JSON.
//!
//! - `small_8`, `small_32`: the volume of a box less a sphere of 8 and 32 segments, made again each time, the median.
//! - `edit`: moving a plane of a brush of the level back and forth, the median over the brushes.

use std::env;
use std::error::Error;
use std::fs;
use std::time::Instant;

use planecut::csg::{Edit, LiveModel, Material, MaterialId, Model, Tree, evaluate, primitives};
use planecut::import::map::{MapOptions, read_map};

/// Solids that are made, and brushes that are edited.
const COUNT: usize = 400;

fn main() -> Result<(), Box<dyn Error>> {
    let mut times = vec![("small_8", small(8)?), ("small_32", small(32)?)];
    if let Some(level) = env::args().nth(1) {
        times.push(("edit", edit(&level)?));
    }
    let entries: Vec<String> = times.iter().map(|(name, time)| format!("\"{name}\": {time:.2}")).collect();
    println!("{{{}}}", entries.join(", "));
    Ok(())
}

fn small(segments: u32) -> Result<f64, Box<dyn Error>> {
    let mut times = Vec::new();
    for _ in 0..COUNT {
        let begin = Instant::now();
        let block = Tree::from(primitives::cuboid([0.0; 3], [4.0, 2.0, 1.0], MaterialId(0))?);
        let tree = block - primitives::sphere(0.5, segments, MaterialId(0))?.into();
        let volume = evaluate(&Model { materials: vec![Material::named("default")], tree })?.solid.volume;
        times.push(begin.elapsed().as_secs_f64());
        assert!(volume > 0.0);
    }
    Ok(median(times))
}

fn edit(level: &str) -> Result<f64, Box<dyn Error>> {
    let import = read_map(&fs::read(level)?, level, &MapOptions::default())?;
    let mut model = LiveModel::from_model(import.model)?;
    let brushes: Vec<_> = model.brushes().take(COUNT).collect();
    let mut times = Vec::new();
    for brush in brushes {
        let (body, planes) = (model.brush(brush)?.0, model.planes(brush)?);
        let (plane, offset) = (planes[0], body.faces[0].half_space.offset());
        let step = body.faces[0].half_space.normal().length();
        for offset in [offset + step, offset] {
            let begin = Instant::now();
            model.apply(Edit::MovePlane { brush, plane, offset })?;
            times.push(begin.elapsed().as_secs_f64());
        }
    }
    Ok(median(times))
}

/// In microseconds.
fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2] * 1e6
}
