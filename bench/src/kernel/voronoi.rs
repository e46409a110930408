//! Voronoi cells by cutting, beside voro++ where its program (`bench/voro/cells.cc`) was built.
//!
//! Every cell begins as the container's box and is cut by the same half-spaces in the same order by everybody. Volumes are
//! compared before a time counts.

use crate::case::{Sampler, half_spaces, microseconds};
use crate::plan::Case;
use cpu_time::ThreadTime;
use planecut_bench::cells::{self, Cell};
use planecut_bench::inputs::dot;
use planecut_bench::library::{Library, Planecut, PolySurge};
use std::fmt::Write as _;
use std::io::{BufRead, BufReader, Write};
use std::path::PathBuf;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

/// By the planes that bound the cell.
pub(crate) const FACES: &str = "Voronoi cell, its own faces";
/// By the bisectors to the nearest sites, nearest first.
pub(crate) const NEAREST: &str = "Voronoi cell, 60 nearest sites";
/// The name of voro++ in the report.
pub(crate) const VORO: &str = "voro++";
/// Our ways to begin a cell.
pub(crate) const WAYS: [&str; 3] = ["planecut", "planecut, new()", "planecut, box copied"];

const NEAREST_COUNT: usize = 60;
/// Relative; both sides compute in `f64`.
const VOLUME_TOLERANCE: f64 = 1e-9;

/// All cells with one choice of cuts.
pub(crate) struct Set {
    pub(crate) operation: &'static str,
    pub(crate) cells: Vec<Cell>,
}

impl Set {
    /// The cuts of all cells, walls not counted.
    pub(crate) fn cuts(&self) -> usize {
        self.cells.iter().map(|cell| cell.cuts.len()).sum()
    }
}

/// Both choices of cuts.
///
/// # Errors
/// Where the shared data is not there.
pub(crate) fn sets() -> Result<[Set; 2], String> {
    let cells = cells::read(&cells::packing_file())?;
    let sites: Vec<_> = cells.iter().map(|cell| cell.site).collect();
    let nearest = cells.iter().map(|cell| cell.among_nearest(&sites, NEAREST_COUNT)).collect();
    Ok([Set { operation: FACES, cells }, Set { operation: NEAREST, cells: nearest }])
}

/// All ways for both choices; without voro++ where its program is not there.
///
/// # Errors
/// A volume that is wrong.
pub(crate) fn cases(sets: &[Set]) -> Result<Vec<Case>, String> {
    let mut cases = Vec::new();
    for set in sets {
        let mut push = |library, sampler| cases.push(Case::new(set.operation, set.cuts(), library, sampler));
        check_volumes(set, "planecut", our_volumes(&set.cells))?;
        if let Some(program) = voro_program() {
            push(VORO, voro(set, &program)?);
        }
        push(
            WAYS[0],
            by::<Planecut>(&set.cells, |polytope, planes, _| {
                polytope.clear();
                polytope.add_all(planes);
            }),
        );
        push(WAYS[1], by::<Planecut>(&set.cells, |polytope, planes, _| *polytope = Planecut::build(planes)));
        push(
            WAYS[2],
            by::<Planecut>(&set.cells, |polytope, planes, container| {
                polytope.0.clone_from(&container.0);
                polytope.add_all(&planes[6..]);
            }),
        );
        push(
            PolySurge::NAME,
            by::<PolySurge>(&set.cells, |polytope, planes, _| {
                polytope.clear();
                polytope.add_all(planes);
            }),
        );
    }
    Ok(cases)
}

/// Makes one polytope after the other into a cell: given its walls and cuts and the container with its walls alone.
fn by<L: Library>(cells: &[Cell], make: fn(&mut L, &[L::HalfSpace], &L)) -> Sampler {
    let planes = |cell: &Cell| [&cell.walls()[..], &cell.cuts].concat();
    let cells: Vec<_> = cells.iter().map(|cell| half_spaces::<L>(&planes(cell))).collect();
    let container = L::build(&cells[0][..6]);
    let mut polytope = L::new();
    Box::new(move || {
        let start = ThreadTime::now();
        for planes in &cells {
            make(&mut polytope, planes, &container);
        }
        Ok(vec![microseconds(start.elapsed(), cells.len())])
    })
}

fn our_volumes(cells: &[Cell]) -> Vec<f64> {
    let volume = |cell: &Cell| {
        let planes = [&cell.walls()[..], &cell.cuts].concat();
        Planecut::build(&half_spaces::<Planecut>(&planes)).0.measures().map_or(f64::NAN, |measures| measures.volume)
    };
    cells.iter().map(volume).collect()
}

fn check_volumes(set: &Set, name: &str, volumes: Vec<f64>) -> Result<(), String> {
    if volumes.len() != set.cells.len() {
        return Err(format!("{name}: {} volumes for {} cells", volumes.len(), set.cells.len()));
    }
    for (k, (cell, volume)) in set.cells.iter().zip(volumes).enumerate() {
        let right = (volume - cell.volume).abs() <= VOLUME_TOLERANCE * cell.volume;
        if !right {
            return Err(format!("{name}, {}: cell {k} has volume {volume}, expected {}", set.operation, cell.volume));
        }
    }
    Ok(())
}

/// The program that `bench/voro/build` made, beside the profile's folder.
pub(crate) fn voro_program() -> Option<PathBuf> {
    let program = std::env::current_exe().ok()?.parent()?.parent()?.join("voro-cells");
    program.exists().then_some(program)
}

/// voro++ in a process of its own, which times itself.
struct Voro {
    child: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
}

impl Voro {
    fn start(program: &PathBuf, cells: &[Cell]) -> std::io::Result<Self> {
        let mut child = Command::new(program).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn()?;
        let mut input = child.stdin.take().expect("it is piped");
        let output = BufReader::new(child.stdout.take().expect("it is piped"));
        input.write_all(as_text(cells).as_bytes())?;
        Ok(Self { child, input, output })
    }

    fn ask(&mut self, command: &str) -> std::io::Result<Vec<f64>> {
        writeln!(self.input, "{command}")?;
        self.input.flush()?;
        let mut line = String::new();
        self.output.read_line(&mut line)?;
        Ok(line.split_whitespace().filter_map(|word| word.parse().ok()).collect())
    }
}

impl Drop for Voro {
    fn drop(&mut self) {
        // It ends when its input does; should it hang, this ends it.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn voro(set: &Set, program: &PathBuf) -> Result<Sampler, String> {
    let failed = |error: std::io::Error| format!("voro++: {error}");
    let mut voro = Voro::start(program, &set.cells).map_err(failed)?;
    check_volumes(set, VORO, voro.ask("volumes").map_err(failed)?)?;
    let count = set.cells.len();
    Ok(Box::new(move || {
        let answer = voro.ask("run 1").map_err(failed)?;
        let nanoseconds = answer.first().ok_or("voro++ gave no time")?;
        Ok(vec![nanoseconds / 1e3 / count as f64])
    }))
}

/// The cells as `voro/cells.cc` reads them: everything relative to the site, offsets doubled.
fn as_text(cells: &[Cell]) -> String {
    let mut text = format!("{}\n", cells.len());
    for cell in cells {
        let [low, high] = cell.container;
        for k in 0..3 {
            let _ = write!(text, "{:?} {:?} ", low[k] - cell.site[k], high[k] - cell.site[k]);
        }
        let _ = writeln!(text, "{}", cell.cuts.len());
        for plane in &cell.cuts {
            let [x, y, z] = plane.normal;
            let _ = writeln!(text, "{x:?} {y:?} {z:?} {:?}", 2.0 * (plane.offset - dot(plane.normal, cell.site)));
        }
    }
    text
}
