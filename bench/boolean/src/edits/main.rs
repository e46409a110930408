//! Times edits of live models beside building the same models from scratch, in one run: on maps, of planes and brushes that are
//! dragged, of brushes of many planes, in grids that grow, and a million times in a row; and what is asked between edits.

#![forbid(unsafe_code)]

#[path = "../machine.rs"]
#[allow(dead_code, reason = "shared with the benchmark of Booleans")]
mod machine;

mod bodies;
mod dragging;
mod draw;
mod endurance;
mod grid;
mod maps;
mod questions;
mod table;

use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

const USAGE: &str = "usage: bench/edits [--quick] [--verify] [--json FILE] [--markdown FILE]";
const TEMPLATE: &str = include_str!("../../edits.template.md");
/// The map in which planes are dragged.
const DRAGGED: &str = "e1m1";
const MAPS: [&str; 3] = ["spacehare/64u_rabbit.map", "romero/e1m1.map", "romero/e2m7.map"];

/// How much is done.
#[derive(Debug, Default)]
pub(crate) struct Options {
    /// A tenth of the edits, and no million of them.
    is_quick: bool,
    /// After each edit of a map, compare with the model built from scratch.
    verifies: bool,
    json: Option<String>,
    markdown: Option<String>,
}

impl Options {
    fn parse(mut arguments: impl Iterator<Item = String>) -> Result<Self, String> {
        let mut options = Self::default();
        while let Some(argument) = arguments.next() {
            let mut value = || arguments.next().ok_or(format!("{argument} needs a value"));
            match argument.as_str() {
                "--quick" => options.is_quick = true,
                "--verify" => options.verifies = true,
                "--json" => options.json = Some(value()?),
                "--markdown" => options.markdown = Some(value()?),
                other => return Err(format!("unknown argument {other:?}; {USAGE}")),
            }
        }
        Ok(options)
    }
}

fn main() -> ExitCode {
    let outcome = Options::parse(std::env::args().skip(1)).map_err(|error| (error, 2));
    match outcome.and_then(|options| run(&options).map_err(|error| (error, 1))) {
        Ok(()) => ExitCode::SUCCESS,
        Err((error, status)) => {
            eprintln!("error: {error}");
            ExitCode::from(status)
        }
    }
}

fn run(options: &Options) -> Result<(), String> {
    let begin = Instant::now();
    println!("{}; {}; {}", machine::processor(), machine::compiler(), machine::commit());
    // first, so that the memory is its own
    let endurance = endurance::measure(if options.is_quick { 20_000 } else { 1_000_000 })?;
    println!("\n{}", table::of_endurance(&endurance));
    let plates: &[u32] = if options.is_quick { &[12] } else { &[12, 24, 48] };
    let mut dragged = dragging::plates(plates, options.verifies)?;
    let (mut of_maps, mut asked) = (Vec::new(), Vec::new());
    for name in MAPS {
        let file = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data/map")).join(name);
        if !file.exists() {
            println!("{name} is left out: ../shared/data/map is not there");
            continue;
        }
        let outcome = maps::measure(&file, if options.is_quick { 100 } else { 1000 }, options.verifies)?;
        println!("\n{}", table::of_map(&outcome));
        if outcome.name == DRAGGED {
            let (name, model) = maps::read(&file)?;
            dragged.push(dragging::map(&format!("`{name}`"), &model, options.verifies)?);
            asked.push((name, model));
        }
        of_maps.push(outcome);
    }
    let of_dragged: Vec<String> = dragged.iter().map(table::of_dragged).collect();
    println!("\n{}", of_dragged.join("\n"));
    let questions = questions::measure(options.is_quick, &asked)?;
    println!("\n{}", table::of_questions(&questions));
    let bodies = bodies::measure(options.is_quick)?;
    println!("\n{}", table::of_bodies(&bodies));
    let sides: &[u32] = if options.is_quick { &[4, 8] } else { &[4, 6, 8, 12, 16, 20] };
    let grids = grid::measure(sides)?;
    println!("\n{}", table::of_grids(&grids));
    let seconds = begin.elapsed().as_secs_f64();
    if let Some(file) = &options.json {
        let json = serde_json::json!({
            "maps": of_maps, "dragged": dragged, "questions": questions, "bodies": bodies, "grids": grids, "endurance": endurance, "seconds": seconds, "verified": options.verifies,
            "processor": machine::processor(), "compiler": machine::compiler(), "commit": machine::commit(),
        });
        write(file, &format!("{json:#}\n"))?;
    }
    if let Some(file) = &options.markdown {
        let maps: Vec<String> = of_maps.iter().map(table::of_map).collect();
        let run = format!(
            "{}, shared with other work; {}; {}; {seconds:.0} s{}",
            machine::processor(),
            machine::compiler(),
            machine::commit(),
            if options.verifies { "; every mesh on a map was compared with the one built from scratch" } else { "" }
        );
        let parts = [
            ("run", run),
            ("maps", maps.join("\n")),
            ("dragging", of_dragged.join("\n")),
            ("questions", table::of_questions(&questions)),
            ("bodies", table::of_bodies(&bodies)),
            ("grids", table::of_grids(&grids)),
            ("endurance", table::of_endurance(&endurance)),
        ];
        let fill =
            |page: String, (name, text): &(&str, String)| page.replace(&format!("{{{{{name}}}}}"), text.trim_end());
        write(file, &parts.iter().fold(TEMPLATE.to_owned(), fill))?;
    }
    Ok(())
}

fn write(file: &str, text: &str) -> Result<(), String> {
    std::fs::write(file, text).map_err(|error| format!("{file}: {error}"))
}
