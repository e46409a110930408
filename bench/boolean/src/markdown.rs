//! The results as tables: line by line for the terminal, and the page from its template.

use std::fmt::Write as _;

use crate::conductor::Record;
use crate::entrant::{CORES, Entrant, MANIFOLD3D, PLANECUT, PLANECUT_PLANES};
use crate::growth::growth;
use crate::machine;
use crate::mesh_table;
use crate::report::{Line, Report};
use crate::scaling;
use crate::trees::Tree;

const TEMPLATE: &str = include_str!("../performance.template.md");
const LEFT_OUT: &str = "Left out in this run.\n";

/// The columns of the table that is printed while the run goes on.
pub(crate) const COLUMNS: [&str; 9] = [
    "workload",
    "bodies",
    "triangles",
    "entrant",
    "median ms",
    "min – max ms",
    "× planecut",
    "MB before → peak",
    "volume",
];

/// The page, from the template.
pub(crate) fn page(report: &Report) -> String {
    let load = machine::load().map_or(String::new(), |load| format!(", load {load} at the end"));
    let run = format!(
        "{}, shared with other work{load}; {}; {}; {} rounds; {:.0} s",
        machine::processor(),
        machine::compiler(),
        machine::commit(),
        report.rounds,
        report.seconds
    );
    let parts = [
        ("run", run),
        ("versions", versions()),
        ("ratios", ratios(report)),
        ("meshes", or_left_out(mesh_table::table(report))),
        ("workloads", workloads(report)),
        ("growth", or_left_out(exponents(report))),
        ("scaling", or_left_out(scaling::table(report))),
        ("trees", trees(report)),
    ];
    parts
        .iter()
        .fold(TEMPLATE.to_owned(), |page, (name, text)| page.replace(&format!("{{{{{name}}}}}"), text.trim_end()))
}

/// A table, or that there is none.
fn or_left_out(table: String) -> String {
    if table.is_empty() { LEFT_OUT.to_owned() } else { table }
}

/// The other kernels and their versions.
pub(crate) fn versions() -> String {
    machine::versions().iter().map(|(name, version)| format!("{name} {version}")).collect::<Vec<_>>().join(", ")
}

/// A row of the terminal's table.
pub(crate) fn aligned(cells: &[impl AsRef<str>; 9]) -> String {
    let [name, bodies, triangles, entrant, median, range, ratio, memory, volume] = cells.each_ref().map(AsRef::as_ref);
    let row = format!(
        "{name:<22} {bodies:>7} {triangles:>9}  {entrant:<23} {median:>9} {range:>17} {ratio:>10} {memory:>16} {volume}"
    );
    row.trim_end().to_owned()
}

/// The rows of a workload, one for each entrant.
pub(crate) fn rows(line: &Line) -> impl Iterator<Item = [String; 9]> {
    line.records.iter().map(|(entrant, record)| row(line, *entrant, record))
}

fn row(line: &Line, entrant: Entrant, record: &Record) -> [String; 9] {
    let [min, median, max] = record.spread().map_or([const { String::new() }; 3], |s| s.map(|t| significant(1e3 * t)));
    let ratio = line.ratio(entrant.name, entrant.cores).filter(|_| entrant.name != PLANECUT);
    let megabytes = |bytes: Option<u64>| bytes.map_or(String::new(), |bytes| thousands((bytes >> 20) as usize));
    let told = match (&record.wrong, &record.failure) {
        (Some(wrong), _) => format!("WRONG: {wrong}"),
        (None, Some(failure)) => failure.text().to_owned(),
        (None, None) => "right".to_owned(),
    };
    [
        line.name.clone(),
        thousands(line.bodies),
        thousands(line.triangles),
        entrant.key(),
        median,
        if min.is_empty() { String::new() } else { format!("{min} – {max}") },
        ratio.map(significant).unwrap_or_default(),
        record.peak.map_or(String::new(), |_| format!("{} → {}", megabytes(record.before), megabytes(record.peak))),
        told,
    ]
}

/// Where planecut stands beside manifold3d.
pub(crate) fn ratios(report: &Report) -> String {
    let mut table = String::from(
        "| workload | planecut ms | manifold3d ms | manifold3d / planecut | on one core | from planes ms |\n|---|---:|---:|---:|---:|---:|\n",
    );
    for line in report.lines.iter().filter(|line| !line.is_of_meshes) {
        let time = |name| line.median(name, CORES).map(|seconds| significant(1e3 * seconds)).unwrap_or_default();
        let [ours, theirs, from_planes] = [PLANECUT, MANIFOLD3D, PLANECUT_PLANES].map(time);
        let ratios = [CORES, 1].map(|cores| line.ratio(MANIFOLD3D, cores));
        let [both, one] = ratios.map(|ratio| ratio.map_or(String::new(), |ratio| format!("{}×", significant(ratio))));
        let _ = writeln!(table, "| {} | {ours} | {theirs} | {both} | {one} | {from_planes} |", line.name);
    }
    table
}

fn workloads(report: &Report) -> String {
    let mut table = format!("| {} |\n|---|---:|---:|---|---:|---:|---:|---:|---|\n", COLUMNS.join(" | "));
    for cells in report.lines.iter().flat_map(rows) {
        let _ = writeln!(table, "| {} |", cells.join(" | "));
    }
    table
}

/// How time grows with size; nothing where no series was run.
pub(crate) fn exponents(report: &Report) -> String {
    let growths = growth(report);
    if growths.is_empty() {
        return String::new();
    }
    let mut table = String::from("| series | entrant | exponent | size: ms |\n|---|---|---:|---|\n");
    for growth in growths {
        let point =
            |[size, seconds]: &[f64; 2]| format!("{}: {}", thousands(*size as usize), significant(1e3 * seconds));
        let points = growth.points.iter().map(point).collect::<Vec<_>>().join(", ");
        let _ = writeln!(table, "| {} | {} | {:.2} | {points} |", growth.series, growth.entrant.key(), growth.exponent);
    }
    table
}

fn trees(report: &Report) -> String {
    if report.trees.is_empty() {
        return LEFT_OUT.to_owned();
    }
    let mut table = String::from(
        "| tree | planecut ms | min – max ms | manifold3d ms | min – max ms | manifold3d / planecut | whole process ms ",
    );
    table += "| OpenSCAD ms | |\n";
    table += "|---|---:|---:|---:|---:|---:|---:|---:|---|\n";
    for tree in &report.trees {
        let [ours, theirs] = tree.spreads().map(|spread| spread.map_or(" | ".to_owned(), times));
        let ratio = tree.ratio().map_or(String::new(), |ratio| format!("{}×", significant(ratio)));
        let [wall, openscad] = [tree.wall, tree.openscad].map(|time| time.map(significant).unwrap_or_default());
        let Tree { name, note, .. } = tree;
        let told = tree.wrong().map_or(note.clone(), |wrong| format!("WRONG: {wrong}"));
        let _ = writeln!(table, "| {name} | {ours} | {theirs} | {ratio} | {wall} | {openscad} | {told} |");
    }
    table
}

/// Median and range.
fn times(spread: [f64; 3]) -> String {
    let [min, median, max] = spread.map(significant);
    format!("{median} | {min} – {max}")
}

/// A number with three significant digits, larger ones without a fraction and with thousands apart.
pub(crate) fn significant(value: f64) -> String {
    if value >= 999.5 {
        return thousands(value.round() as usize);
    }
    let decimals = match value {
        ..0.1 => 3,
        ..10.0 => 2,
        _ => usize::from(value < 100.0),
    };
    format!("{value:.decimals$}")
}

pub(crate) fn thousands(value: usize) -> String {
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
        assert_eq!([0, 123, 1234, 123_456, 1_234_567].map(thousands), ["0", "123", "1,234", "123,456", "1,234,567"]);
        assert_eq!([0.0123, 0.5, 12.34, 123.4, 999.7].map(significant), ["0.012", "0.50", "12.3", "123", "1,000"]);
    }
}
