//! Times planecut's Booleans beside those of other kernels, on the same bodies, in one run, interleaved. No time counts
//! before the results agree.

#![forbid(unsafe_code)]

mod catalogue;
mod conductor;
mod contestants;
mod entrant;
mod growth;
mod json;
mod machine;
mod markdown;
mod mesh_table;
mod meshes;
mod process;
mod report;
mod scaling;
mod scene;
mod stl;
mod trees;
mod verify;
mod workloads;

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use catalogue::{InBlocks, Workload};
use conductor::Record;
use entrant::Entrant;
use process::Failure;
use report::{Line, Report};

const USAGE: &str = "usage: bench/csg [--quick] [--json FILE] [--markdown FILE] [--only NAME[,NAME…]]";

/// Rounds of a full and of a quick run, after one to warm up.
const ROUNDS: usize = 7;
const QUICK_ROUNDS: usize = 3;
/// How many of OpenSCAD's trees are timed, and what stands for them in `--only`.
const TREES: usize = 20;
const TREES_NAME: &str = "trees";

#[derive(Default)]
struct Options {
    is_quick: bool,
    json: Option<String>,
    markdown: Option<String>,
    /// Names of workloads; all where it is empty.
    only: Vec<String>,
    /// The program that the trees are timed with.
    planecut: Option<String>,
}

impl Options {
    fn parse(mut arguments: impl Iterator<Item = String>) -> Result<Self, String> {
        let mut options = Self::default();
        while let Some(argument) = arguments.next() {
            let mut value = || arguments.next().ok_or(format!("{argument} needs a value"));
            match argument.as_str() {
                "--quick" => options.is_quick = true,
                "--json" => options.json = Some(value()?),
                "--markdown" => options.markdown = Some(value()?),
                "--only" => options.only.extend(value()?.split(',').map(str::to_owned)),
                "--planecut" => options.planecut = Some(value()?),
                other => return Err(format!("unknown argument {other:?}; {USAGE}")),
            }
        }
        Ok(options)
    }

    /// By name where names are given, else by the kind of run.
    fn wants(&self, name: &str, is_quick: bool) -> bool {
        if self.only.is_empty() { is_quick || !self.is_quick } else { self.only.iter().any(|only| only == name) }
    }
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [worker, name, scene] = &arguments[..]
        && worker == "--worker"
    {
        return contestants::worker::serve(name, Path::new(scene)).map_or_else(|e| fail(&e, 1), |()| ExitCode::SUCCESS);
    }
    let options = match Options::parse(arguments.into_iter()) {
        Ok(options) => options,
        Err(error) => return fail(&error, 2),
    };
    match run(&options) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => fail(&error, 1),
    }
}

fn fail(error: &str, status: u8) -> ExitCode {
    eprintln!("error: {error}");
    ExitCode::from(status)
}

fn run(options: &Options) -> Result<(), String> {
    let begin = Instant::now();
    let all = catalogue::all();
    let is_known = |name: &String| name == TREES_NAME || all.iter().any(|workload| workload.name == *name);
    if let Some(name) = options.only.iter().find(|name| !is_known(name)) {
        let names: Vec<&str> = all.iter().map(|workload| workload.name.as_str()).collect();
        return Err(format!("no workload is called {name:?}; there are {} and {TREES_NAME}", names.join(", ")));
    }
    if !all.iter().any(|workload| workload.name == "e1m1") {
        println!("the maps are left out: ../shared/data/map is not there");
    }
    if !all.iter().any(|workload| workload.name.starts_with("ember_")) {
        println!("the meshes of files are left out: ../shared/data/mesh is not there");
    }
    let rounds = if options.is_quick { QUICK_ROUNDS } else { ROUNDS };
    let mut session = Session {
        folder: Folder::make()?,
        entrants: Entrant::all(options.is_quick),
        too_slow: HashMap::new(),
        last: HashMap::new(),
        rounds,
        is_quick: options.is_quick,
    };
    println!("{}; {}; {}", machine::processor(), machine::compiler(), machine::commit());
    println!("{}", markdown::versions());
    println!("{}", markdown::aligned(&markdown::COLUMNS));
    let mut lines = Vec::new();
    for workload in all.iter().filter(|workload| options.wants(&workload.name, workload.is_quick)) {
        let line = session.measure(workload)?;
        markdown::rows(&line).for_each(|row| println!("{}", markdown::aligned(&row)));
        lines.push(line);
    }
    let trees = if options.wants(TREES_NAME, false) { session.trees(options) } else { Vec::new() };
    let seconds = begin.elapsed().as_secs_f64();
    let report = Report { lines, trees, rounds, is_quick: options.is_quick, seconds };
    for table in [markdown::ratios(&report), mesh_table::table(&report), markdown::exponents(&report)] {
        println!("{table}");
    }
    println!("{seconds:.0} s");
    if let Some(file) = &options.json {
        write(file, &format!("{:#}\n", json::json(&report)))?;
    }
    if let Some(file) = &options.markdown {
        write(file, &markdown::page(&report))?;
    }
    match &report.our_faults()[..] {
        [] => Ok(()),
        faults => Err(format!("planecut was wrong: {}", faults.join("; "))),
    }
}

fn write(file: &str, text: &str) -> Result<(), String> {
    std::fs::write(file, text).map_err(|error| format!("{file}: {error}"))
}

/// What lasts from workload to workload.
struct Session {
    folder: Folder,
    entrants: Vec<Entrant>,
    /// By series and entrant, the workload whose limit was too short.
    too_slow: HashMap<(&'static str, String), String>,
    /// By series and entrant, the last size and its median in seconds.
    last: HashMap<(&'static str, String), (usize, f64)>,
    rounds: usize,
    is_quick: bool,
}

impl Session {
    fn measure(&mut self, workload: &Workload) -> Result<Line, String> {
        let task = workload.make().map_err(|error| format!("{}: {error}", workload.name))?;
        let file = self.folder.0.join("bodies.scene");
        task.scene.write(&file).map_err(|error| format!("{}: {error}", file.display()))?;
        let reason = |entrant: &Entrant| self.reason_to_leave_out(workload, *entrant);
        let in_blocks = (workload.in_blocks != InBlocks::No).then_some(Entrant::IN_BLOCKS);
        let is_of_meshes = task.scene.is_of_meshes();
        let does =
            |entrant: &&Entrant| workload.in_blocks != InBlocks::Only && (!is_of_meshes || entrant.does_meshes());
        let at_once = self.entrants.iter().filter(does).copied();
        let (taking_part, left_out): (Vec<Entrant>, Vec<Entrant>) =
            at_once.chain(in_blocks).partition(|entrant| reason(entrant).is_none());
        let records = conductor::conduct(&file, &taking_part, self.rounds, self.is_quick);
        let mut records: Vec<(Entrant, Record)> = taking_part.into_iter().zip(records).collect();
        for entrant in left_out {
            let text = reason(&entrant).unwrap_or_default();
            records.push((entrant, Record::failed(Failure::Refused(text))));
        }
        for (entrant, record) in &records {
            let Some((series, size)) = workload.series else { continue };
            if let Some(Failure::OverLimit(_)) = &record.failure {
                self.too_slow.insert((series, entrant.key()), workload.name.clone());
            }
            if let Some(median) = record.median() {
                self.last.insert((series, entrant.key()), (size, median));
            }
        }
        let volume = verify::expected(task.volume, &task.scene, &records);
        verify::mark(&mut records, volume, is_of_meshes);
        Ok(Line {
            name: workload.name.clone(),
            series: workload.series,
            bodies: task.scene.bodies.len(),
            triangles: task.scene.triangles(),
            is_of_meshes,
            volume,
            records,
        })
    }

    /// Why an entrant need not begin: a smaller workload was too long for it, or this one would be if time grows with size.
    fn reason_to_leave_out(&self, workload: &Workload, entrant: Entrant) -> Option<String> {
        let (series, size) = workload.series?;
        let key = (series, entrant.key());
        if let Some(smaller) = self.too_slow.get(&key) {
            return Some(format!("left out: too slow for {smaller}"));
        }
        let (before, median) = self.last.get(&key)?;
        let limit = entrant.limits(self.is_quick).single;
        let is_too_long = median * size as f64 / *before as f64 > limit.as_secs_f64();
        is_too_long.then(|| format!("left out: {median:.1} s for {before}, {} s at most", limit.as_secs()))
    }

    fn trees(&self, options: &Options) -> Vec<trees::Tree> {
        let slowest = catalogue::slowest_trees(TREES);
        let Some(planecut) = options.planecut.as_deref().filter(|_| !slowest.is_empty()) else {
            println!("the trees are left out: ../shared/data/csg is not there, or no --planecut FILE to run them with");
            return Vec::new();
        };
        trees::run(&slowest, planecut, self.rounds, &self.folder.0.join("trees.json"))
    }
}

/// A folder for this run's files, which goes with it.
struct Folder(PathBuf);

impl Folder {
    fn make() -> Result<Self, String> {
        let folder = std::env::temp_dir().join(format!("planecut-bench-{}", std::process::id()));
        std::fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        Ok(Self(folder))
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}
