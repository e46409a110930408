//! Times the kernel's polytope beside `poly_surge` and voro++, in one run, interleaved; counts wrong answers and bytes. No time
//! counts before the results agree.

mod batch;
mod case;
mod contestant;
mod hulls;
mod json;
mod machine;
mod markdown;
mod measure;
mod memory;
mod plan;
mod queries;
mod report;
mod rings;
mod robustness;
mod verify;
mod voronoi;

use report::Report;
use std::process::ExitCode;

const USAGE: &str = "usage: bench/kernel [--quick] [--json FILE] [--markdown FILE] [--cases COUNT] [--paper FILE]";

/// Rounds of a full and of a quick run.
const ROUNDS: usize = 31;
const QUICK_ROUNDS: usize = 5;
/// Scripts of each category in a full and in a quick run.
const CASES: usize = 2000;
const QUICK_CASES: usize = 80;

#[derive(Default)]
struct Options {
    quick: bool,
    json: Option<String>,
    markdown: Option<String>,
    cases: Option<usize>,
    /// What `cargo bench` printed, to be quoted in the Markdown.
    paper: Option<String>,
}

impl Options {
    fn parse(mut arguments: impl Iterator<Item = String>) -> Result<Self, String> {
        let mut options = Self::default();
        while let Some(argument) = arguments.next() {
            let mut value = || arguments.next().ok_or(format!("{argument} needs a value"));
            match argument.as_str() {
                "--quick" => options.quick = true,
                "--json" => options.json = Some(value()?),
                "--markdown" => options.markdown = Some(value()?),
                "--paper" => options.paper = Some(value()?),
                "--cases" => {
                    let cases = value()?.parse().map_err(|error| format!("--cases: {error}"))?;
                    options.cases = Some(cases);
                }
                other => return Err(format!("unknown argument {other:?}; {USAGE}")),
            }
        }
        Ok(options)
    }
}

fn main() -> ExitCode {
    let options = match Options::parse(std::env::args().skip(1)) {
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
    let rounds = if options.quick { QUICK_ROUNDS } else { ROUNDS };
    let cases = options.cases.unwrap_or(if options.quick { QUICK_CASES } else { CASES });
    let sets = voronoi::sets().map(Vec::from).unwrap_or_else(|error| {
        eprintln!("Voronoi cells are left out: {error}");
        Vec::new()
    });
    let report = Report {
        lines: measure::run(plan::prepare(options.quick, &sets)?, rounds)?,
        memory: memory::run()?,
        robustness: robustness::run(cases),
        cells: sets.first().map_or(0, |set| set.cells.len()),
        rounds,
        quick: options.quick,
    };
    let paper = options.paper.as_ref().map(|file| read(file)).transpose()?;
    print!("{}", markdown::tables(&report));
    if let Some(file) = &options.json {
        write(file, &format!("{:#}\n", json::json(&report)))?;
    }
    if let Some(file) = &options.markdown {
        write(file, &markdown::page(&report, paper.as_deref()))?;
    }
    match report.robustness.iter().find_map(|tally| tally.our_first.map(|seed| (&tally.category, seed))) {
        Some((category, seed)) => Err(format!("planecut was wrong: category {category}, seed {seed}")),
        None => Ok(()),
    }
}

fn read(file: &str) -> Result<String, String> {
    std::fs::read_to_string(file).map_err(|error| format!("{file}: {error}"))
}

fn write(file: &str, text: &str) -> Result<(), String> {
    std::fs::write(file, text).map_err(|error| format!("{file}: {error}"))
}
