//! Builds one sphere with an allocator that counts and prints what it holds: `memory LIBRARY PLANES` gives
//! the live bytes of the polytope and its vertices. A program of its own, so that nothing else is counted and
//! nothing that is timed pays for the counting.

use peak_alloc::PeakAlloc;
use planecut_bench::inputs::fibonacci_sphere;
use planecut_bench::library::{Library, Planecut, PolySurge};
use std::process::ExitCode;

#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let planes = arguments.get(1).and_then(|count| count.parse().ok());
    match (arguments.first().map(String::as_str), planes) {
        (Some(Planecut::NAME), Some(planes)) => measure::<Planecut>(planes),
        (Some(PolySurge::NAME), Some(planes)) => measure::<PolySurge>(planes),
        _ => {
            eprintln!("usage: memory planecut|poly_surge PLANES");
            return ExitCode::from(2);
        }
    }
    ExitCode::SUCCESS
}

fn measure<L: Library>(planes: usize) {
    let half_spaces: Vec<_> = fibonacci_sphere(planes).iter().map(L::half_space).collect();
    let before = ALLOCATOR.current_usage();
    let mut polytope = L::build(&half_spaces);
    polytope.settle();
    let built = ALLOCATOR.current_usage() - before;
    // A clone holds no room to grow.
    let copy = polytope.clone();
    let cloned = ALLOCATOR.current_usage() - before - built;
    drop(copy);
    println!("{built} {cloned} {}", polytope.vertex_count());
}
