//! What a sphere's polytope holds in memory, counted by the allocator of the program `memory` (`bench/src/memory`).

use planecut_bench::library::{Library, Planecut, PolySurge};
use std::process::Command;

/// Live bytes of one polytope.
pub(crate) struct Memory {
    pub(crate) library: &'static str,
    pub(crate) planes: usize,
    /// After the build, spare capacity included.
    pub(crate) built: f64,
    /// Of a clone, which has no spare capacity.
    pub(crate) cloned: f64,
    pub(crate) vertices: f64,
}

/// Both libraries at 200 planes, and ours up to 100,000.
///
/// # Errors
/// Where the program is not there or fails.
pub(crate) fn run() -> Result<Vec<Memory>, String> {
    let sizes = [(Planecut::NAME, 200), (PolySurge::NAME, 200), (Planecut::NAME, 10_000), (Planecut::NAME, 100_000)];
    sizes.into_iter().map(|(library, planes)| measure(library, planes)).collect()
}

fn measure(library: &'static str, planes: usize) -> Result<Memory, String> {
    let failed = |error: std::io::Error| format!("the program `memory`: {error}");
    let program = std::env::current_exe().map_err(failed)?.with_file_name("memory");
    let output = Command::new(program).args([library, &planes.to_string()]).output().map_err(failed)?;
    let text = String::from_utf8_lossy(&output.stdout);
    let numbers: Vec<f64> = text.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    match numbers[..] {
        [built, cloned, vertices] if output.status.success() => Ok(Memory { library, planes, built, cloned, vertices }),
        _ => Err(format!("the program `memory` gave {text:?}")),
    }
}
