//! Times the kernel's polytope beside `poly_surge`, in one run, interleaved: every round visits every case, so that a slow
//! moment of the machine falls on all of them. No time counts before the results agree.

mod case;
mod inputs;
mod library;
mod plan;
mod report;
mod verify;

use report::{Line, Report};
use std::process::ExitCode;
use std::time::{Duration, Instant};

const USAGE: &str = "usage: bench/kernel [--quick] [--json FILE]";

/// Rounds of a full and of a quick run.
const ROUNDS: usize = 31;
const QUICK_ROUNDS: usize = 9;
/// How long a case is sampled in one round; one sample is always taken.
const SLICE: Duration = Duration::from_millis(10);

struct Options {
    quick: bool,
    json: Option<String>,
}

impl Options {
    fn parse(mut arguments: impl Iterator<Item = String>) -> Result<Self, String> {
        let mut options = Self { quick: false, json: None };
        while let Some(argument) = arguments.next() {
            match argument.as_str() {
                "--quick" => options.quick = true,
                "--json" => options.json = Some(arguments.next().ok_or("--json needs a file")?),
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
    let report = measure(plan::prepare(options.quick)?, rounds, options.quick)?;
    print!("{}", report.table());
    println!("\n{rounds} rounds; all vertex counts agree");
    if let Some(file) = &options.json {
        let text = format!("{:#}\n", report.json());
        std::fs::write(file, text).map_err(|error| format!("{file}: {error}"))?;
    }
    Ok(())
}

fn measure(mut cases: Vec<plan::Case>, rounds: usize, quick: bool) -> Result<Report, String> {
    let mut samples = vec![Vec::new(); cases.len()];
    // The first round warms caches and buffers up and is not kept.
    for round in 0..=rounds {
        for (case, samples) in cases.iter_mut().zip(&mut samples) {
            let start = Instant::now();
            loop {
                let sample = (case.sampler)()?;
                if round > 0 {
                    samples.push(sample);
                }
                if start.elapsed() >= SLICE {
                    break;
                }
            }
        }
    }
    let line = |(case, samples): (&plan::Case, Vec<f64>)| Line {
        operation: case.operation,
        size: case.size,
        library: case.library,
        samples,
    };
    Ok(Report { lines: cases.iter().zip(samples).map(line).collect(), rounds, quick })
}
