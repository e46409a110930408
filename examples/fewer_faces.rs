//! A convex hull with fewer faces that still holds all of it: what physics engines with a limit ask for.
//!
//! ```sh
//! cargo run --release --example fewer_faces -- mesh.obj 64 hull.obj
//! ```
//!
//! Prints the seconds that the hull took and those that lowering it took. `bench/coarsen` measures with this.

use std::error::Error;
use std::fmt::Write;
use std::time::Instant;

use planecut::cells::coarsen::lower;
use planecut::kernel::{DVec3, hull};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [input, faces, output] = &arguments[..] else {
        return Err("expected three arguments: an OBJ file, a number of faces, and the OBJ file to write".into());
    };
    let points = vertices(&std::fs::read_to_string(input)?)?;

    let begin = Instant::now();
    let mut body = hull(&points)?;
    let of_hull = begin.elapsed();
    let begin = Instant::now();
    lower(&mut body, Some(faces.parse()?), None)?;
    println!("{} {}", of_hull.as_secs_f64(), begin.elapsed().as_secs_f64());

    // Exactly: no point is outside of what is left, not even by rounding.
    assert!(points.iter().all(|point| body.contains(*point)));

    let (corners, polygons) = body.to_mesh();
    let mut text = String::new();
    for corner in corners {
        writeln!(text, "v {} {} {}", corner.x, corner.y, corner.z)?;
    }
    for polygon in polygons {
        let numbers: Vec<String> = polygon.iter().map(|corner| (corner + 1).to_string()).collect();
        writeln!(text, "f {}", numbers.join(" "))?;
    }
    Ok(std::fs::write(output, text)?)
}

/// The vertices of an OBJ file.
fn vertices(text: &str) -> Result<Vec<DVec3>, Box<dyn Error>> {
    let lines = text.lines().filter_map(|line| line.strip_prefix("v "));
    let vertex = |line: &str| {
        let numbers: Vec<f64> = line.split_whitespace().map(str::parse).collect::<Result<_, _>>()?;
        let [x, y, z, ..] = numbers[..] else { return Err("found a vertex of fewer than three coordinates".into()) };
        Ok(DVec3::new(x, y, z))
    };
    lines.map(vertex).collect()
}
