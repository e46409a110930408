//! Models larger than memory: boxes that come one after another and are kept nowhere, planned, evaluated block by block and proven to fit.
//!
//! `blocks N KIND THREADS FOLDER [BRUSHES]`: N random boxes, `aligned` or `rotated`, on THREADS threads, in blocks of about BRUSHES brushes; FOLDER takes what
//! is written on the way. Prints a line of JSON: seconds after the last box, with the plan, and in all, and the largest memory of the process (Linux).

use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use planecut::blocks::{PlanBuilder, evaluate_all};
use planecut::csg::{BlockOptions, Brush, Material, MaterialId, Operation, TreeSink};
use planecut::kernel::{DVec3, HalfSpace};
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};
use serde_json::json;

#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match measure(&arguments) {
        Ok(line) => {
            println!("{line}");
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn measure(arguments: &[String]) -> Result<serde_json::Value, Box<dyn std::error::Error>> {
    let [boxes, kind, threads, folder, rest @ ..] = arguments else {
        return Err("usage: blocks N aligned|rotated THREADS FOLDER [BRUSHES]".into());
    };
    let (boxes, threads): (u64, usize) = (boxes.parse()?, threads.parse()?);
    let is_rotated = match kind.as_str() {
        "aligned" => false,
        "rotated" => true,
        other => return Err(format!("found {other}, expected aligned or rotated").into()),
    };
    let mut options = BlockOptions::default();
    if let [brushes] = rest {
        options.brushes = brushes.parse()?;
    }
    let begin = Instant::now();
    let mut builder = PlanBuilder::create(Path::new(folder), options)?;
    let random = &mut SmallRng::seed_from_u64(7);
    // as dense at any number
    let side = 1.6 * (boxes as f64).cbrt();
    builder.begin(Operation::Union)?;
    for _ in 0..boxes {
        let center = vector(random, 0.0, side);
        let half = vector(random, 0.2, 0.8);
        let brush = if is_rotated { rotated(random, center, half)? } else { aligned(center, half) };
        builder.leaf(brush, None)?;
    }
    builder.end()?;
    let streamed = begin.elapsed();
    let plan = builder.finish(vec![Material::named("stone")])?;
    let planned = begin.elapsed();
    let reached: u64 = plan.blocks().iter().map(|block| block.brushes).sum();
    let pieces = evaluate_all(&plan, threads, &|_, _| true)?;
    let total = begin.elapsed();
    let solid = pieces.solid();
    let difference = (pieces.mesh_volume() - solid.volume).abs() / solid.volume;
    if difference > 1e-9 {
        return Err(format!("the mesh encloses another volume than the solid, by {difference}").into());
    }
    Ok(json!({
        "boxes": boxes,
        "kind": kind,
        "threads": threads,
        "brushes_per_block": options.brushes,
        "blocks": pieces.count(),
        "brushes_in_blocks": reached as f64 / boxes as f64,
        "streamed_s": streamed.as_secs_f64(),
        "planned_s": planned.as_secs_f64(),
        "total_s": total.as_secs_f64(),
        "peak_mb": peak_megabytes(),
        "triangles": pieces.mesh_counts()[1],
        "volume": solid.volume,
    }))
}

fn vector(random: &mut SmallRng, low: f64, high: f64) -> DVec3 {
    DVec3::from_array([0; 3].map(|_| random.random_range(low..high)))
}

/// On a grid of 1/64, as levels are.
fn aligned(center: DVec3, half: DVec3) -> Brush {
    let on_grid = |at: DVec3| (at * 64.0).round() / 64.0;
    Brush::cuboid(on_grid(center - half), on_grid(center + half), MaterialId(0))
}

/// Turned by a random rotation (Shoemake, Uniform random rotations, 1992).
fn rotated(random: &mut SmallRng, center: DVec3, half: DVec3) -> Result<Brush, planecut::kernel::HalfSpaceError> {
    let [u, v, w] = [0; 3].map(|_| random.random_range(0.0..1.0_f64));
    let (p, q) = ((1.0 - u).sqrt(), u.sqrt());
    let (a, b) = (std::f64::consts::TAU * v, std::f64::consts::TAU * w);
    let [x, y, z, w] = [p * a.sin(), p * a.cos(), q * b.sin(), q * b.cos()];
    let axes = [
        DVec3::new(1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + z * w), 2.0 * (x * z - y * w)),
        DVec3::new(2.0 * (x * y - z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + x * w)),
        DVec3::new(2.0 * (x * z + y * w), 2.0 * (y * z - x * w), 1.0 - 2.0 * (x * x + y * y)),
    ];
    let mut sides = Vec::with_capacity(6);
    for (axis, half) in axes.into_iter().zip(half.to_array()) {
        let middle = axis.dot(center);
        sides.push(HalfSpace::new(axis, middle + half)?);
        sides.push(HalfSpace::new(-axis, half - middle)?);
    }
    Ok(Brush::from_half_spaces(sides, MaterialId(0)))
}

/// The largest memory of this process so far; nothing where the system does not tell.
fn peak_megabytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    Some(line.split_whitespace().nth(1)?.parse::<u64>().ok()? / 1024)
}
