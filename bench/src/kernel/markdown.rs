//! The results as Markdown: tables for the terminal, and the page `docs/benchmarks.md` from its template.

use crate::batch::{self, ARRANGEMENTS, WAYS};
use crate::machine;
use crate::plan::OPERATIONS;
use crate::queries::{BESIDE_PARRY, PARRY};
use crate::report::{Line, Report};
use crate::rings::{FORK_ALONE, FORK_SHARED, RING, ROOF};
use crate::robustness::Tally;
use crate::voronoi::{FACES, NEAREST, VORO};
use planecut_bench::library::{Library, Planecut, PolySurge};
use std::fmt::Write as _;

const TEMPLATE: &str = include_str!("benchmarks.template.md");
const LEFT_OUT: &str = "Left out in this run.\n";

/// The page, from the template.
pub(crate) fn page(report: &Report, paper: Option<&str>) -> String {
    let load = machine::load().map_or(String::new(), |load| format!(", load {load} at the end"));
    let run = format!(
        "{}, shared with other work{load}; {}; {}; {} rounds",
        machine::processor(),
        machine::compiler(),
        machine::commit(),
        report.rounds
    );
    let paper = paper.map_or(LEFT_OUT.to_owned(), |text| format!("```\n{}\n```\n", text.trim_end()));
    let [ours, theirs] = report.failures();
    let cases: usize = report.robustness.iter().map(|tally| tally.cases).sum();
    let parts = [
        ("run", run),
        ("operations", operations(report)),
        ("voronoi", voronoi(report)),
        ("queries", queries(report)),
        ("memory", memory(report)),
        ("batch", batch(report)),
        ("rings", rings(report)),
        ("robustness", robustness(report)),
        ("categories", report.robustness.len().to_string()),
        ("failures", format!("planecut {ours}, `poly_surge` {theirs} of {}", thousands(cases))),
        ("paper", paper),
    ];
    parts
        .iter()
        .fold(TEMPLATE.to_owned(), |page, (name, text)| page.replace(&format!("{{{{{name}}}}}"), text.trim_end()))
}

/// All tables, for the terminal.
pub(crate) fn tables(report: &Report) -> String {
    let parts = [operations, voronoi, queries, batch, rings, memory, robustness].map(|part| part(report));
    format!("{}\n{} rounds; all results agree\n", parts.join("\n"), report.rounds)
}

fn operations(report: &Report) -> String {
    let mut table = String::from("| operation | planes | library | median µs | min – max µs | poly_surge / ours |\n");
    table += "|---|---:|---|---:|---:|---:|\n";
    for line in OPERATIONS.iter().flat_map(|operation| report.lines_of(operation)) {
        let ratio = match report.ratio(&line.operation, line.size) {
            Some(ratio) if line.library == PolySurge::NAME => format!("{}×", significant(ratio)),
            _ => String::new(),
        };
        let (operation, size, library) = (&line.operation, thousands(line.size), line.library);
        let _ = writeln!(table, "| {operation} | {size} | {library} | {} | {ratio} |", times(line));
    }
    table
}

fn voronoi(report: &Report) -> String {
    if report.cells == 0 {
        return LEFT_OUT.to_owned();
    }
    let mut table =
        String::from("| cells | cuts a cell | by | median µs a cell | min – max µs | ns a cut | voro++ / this |\n");
    table += "|---|---:|---|---:|---:|---:|---:|\n";
    for operation in [FACES, NEAREST] {
        let voro = report.lines_of(operation).find(|line| line.library == VORO).map(Line::median);
        for line in report.lines_of(operation) {
            let cuts = line.size as f64 / report.cells as f64;
            let ratio = voro.filter(|_| line.library != VORO).map(|voro| significant(voro / line.median()));
            let (times, cut) = (times(line), significant(1000.0 * line.median() / cuts));
            let ratio = ratio.unwrap_or_default();
            let _ = writeln!(table, "| {operation} | {cuts:.1} | {} | {times} | {cut} | {ratio} |", line.library);
        }
    }
    if !report.lines_of(FACES).any(|line| line.library == VORO) {
        table += "\nvoro++ was left out: its program was not built.\n";
    }
    table
}

fn queries(report: &Report) -> String {
    let mut table =
        String::from("| query | planes or points | library | median µs | min – max µs | parry3d / ours |\n");
    table += "|---|---:|---|---:|---:|---:|\n";
    for line in BESIDE_PARRY.iter().flat_map(|query| report.lines_of(query)) {
        let ours = report.line(&line.operation, line.size, Planecut::NAME).filter(|_| line.library == PARRY);
        let ratio = ours.map_or(String::new(), |ours| format!("{}×", significant(line.median() / ours.median())));
        let (query, size, library) = (&line.operation, thousands(line.size), line.library);
        let _ = writeln!(table, "| {query} | {size} | {library} | {} | {ratio} |", times(line));
    }
    table
}

fn memory(report: &Report) -> String {
    let mut table = String::from("| planes | library | vertices | bytes held | bytes a vertex | of a clone |\n");
    table += "|---:|---|---:|---:|---:|---:|\n";
    for memory in &report.memory {
        let (built, cloned) = (memory.built / memory.vertices, memory.cloned / memory.vertices);
        let (planes, vertices, bytes) =
            (thousands(memory.planes), thousands(memory.vertices as usize), thousands(memory.built as usize));
        let _ = writeln!(table, "| {planes} | {} | {vertices} | {bytes} | {built:.0} | {cloned:.0} |", memory.library);
    }
    table
}

fn batch(report: &Report) -> String {
    let mut table = String::from(
        "| planes | removed | lie | remove_planes µs | one by one µs | rebuild µs | better of the two / remove_planes |\n",
    );
    table += "|---:|---:|---|---:|---:|---:|---:|\n";
    for (size, counts) in batch::sizes(report.quick) {
        for (count, arrangement) in counts.iter().flat_map(|count| ARRANGEMENTS.map(|a| (*count, a))) {
            let median = |way| report.line(&batch::operation(arrangement, way, count), size, Planecut::NAME);
            let [Some(at_once), Some(single), Some(rebuild)] = WAYS.map(|way| median(way).map(Line::median)) else {
                continue;
            };
            let ratio = significant(single.min(rebuild) / at_once);
            let [at_once, single, rebuild] = [at_once, single, rebuild].map(significant);
            let (size, count) = (thousands(size), thousands(count));
            let _ =
                writeln!(table, "| {size} | {count} | {arrangement} | {at_once} | {single} | {rebuild} | {ratio}× |");
        }
    }
    table
}

fn rings(report: &Report) -> String {
    let mut table = String::from("| operation | neighbours | median µs | min – max µs | µs a neighbour |\n");
    table += "|---|---:|---:|---:|---:|\n";
    for line in [ROOF, RING].iter().flat_map(|operation| report.lines_of(operation)) {
        let each = significant(line.median() / line.size as f64);
        let _ = writeln!(table, "| {} | {} | {} | {each} |", line.operation, thousands(line.size), times(line));
    }
    for line in [FORK_ALONE, FORK_SHARED].iter().flat_map(|fork| report.lines_of(fork)) {
        let _ = writeln!(table, "| {} | | {} | |", line.operation, times(line));
    }
    table
}

fn robustness(report: &Report) -> String {
    let mut table = String::from(
        "| category | cases | planecut wrong | poly_surge wrong | by panic | emptiness | boundedness | vertices | states compared | too close |\n",
    );
    table += "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n";
    for tally in &report.robustness {
        let [ours, theirs] = tally.failures();
        let [panic, emptiness, boundedness, vertices] = tally.faults[1];
        let Tally { category, cases, compared, too_close, .. } = tally;
        let [compared, too_close] = [*compared, *too_close].map(thousands);
        let _ = writeln!(
            table,
            "| {category} | {cases} | {ours} | {theirs} | {panic} | {emptiness} | {boundedness} | {vertices} | {compared} | {too_close} |"
        );
    }
    table
}

/// Median and range.
fn times(line: &Line) -> String {
    let [min, median, max] = line.spread().map(significant);
    format!("{median} | {min} – {max}")
}

/// A number with three significant digits, larger ones without a fraction and with thousands apart.
fn significant(value: f64) -> String {
    if value >= 1000.0 {
        return thousands(value.round() as usize);
    }
    let decimals = match value {
        ..0.1 => 3,
        ..10.0 => 2,
        _ => usize::from(value < 100.0),
    };
    format!("{value:.decimals$}")
}

fn thousands(value: usize) -> String {
    let text = value.to_string();
    let first = text.len() % 3;
    let mut groups: Vec<&str> = (first..text.len()).step_by(3).map(|i| &text[i..i + 3]).collect();
    if first > 0 {
        groups.insert(0, &text[..first]);
    }
    groups.join(",")
}

#[cfg(test)]
mod tests {
    use super::{significant, thousands};

    #[test]
    fn numbers_are_written_shortly() {
        assert_eq!(
            [0, 12, 123, 1234, 123_456, 1_234_567].map(thousands),
            ["0", "12", "123", "1,234", "123,456", "1,234,567"]
        );
        assert_eq!([0.0123, 0.5, 12.34, 123.4, 1234.5].map(significant), ["0.012", "0.50", "12.3", "123", "1,235"]);
    }
}
