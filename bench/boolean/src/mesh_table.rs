//! The table of closed meshes: time, memory and triangles of planecut and manifold3d.

use std::fmt::Write as _;

use crate::conductor::Record;
use crate::entrant::{CORES, MANIFOLD3D, PLANECUT};
use crate::markdown::{significant, thousands};
use crate::report::{Line, Report};

const COLUMNS: [&str; 11] = [
    "workload",
    "triangles in",
    "planecut ms",
    "manifold3d ms",
    "manifold3d / planecut",
    "on one core",
    "planecut MB",
    "manifold3d MB",
    "planecut / manifold3d",
    "triangles out: planecut, manifold3d",
    "planecut / manifold3d",
];

/// A row for each workload of meshes; nothing where there is none.
pub(crate) fn table(report: &Report) -> String {
    let mut lines = report.lines.iter().filter(|line| line.is_of_meshes).peekable();
    if lines.peek().is_none() {
        return String::new();
    }
    let mut table = format!("| {} |\n|---{}\n", COLUMNS.join(" | "), "|---:".repeat(COLUMNS.len() - 1) + "|");
    for line in lines {
        let _ = writeln!(table, "| {} |", row(line).join(" | "));
    }
    table
}

fn row(line: &Line) -> [String; 11] {
    let records = [PLANECUT, MANIFOLD3D].map(|name| line.record(name, CORES));
    let [ours, theirs] = records.map(|record| record.map_or(String::new(), time));
    let [both, one] = [CORES, 1].map(|cores| times(line.ratio(MANIFOLD3D, cores)));
    let peaks = records.map(|record| record?.peak);
    let [our_peak, their_peak] =
        peaks.map(|peak| peak.map_or(String::new(), |bytes| thousands((bytes >> 20) as usize)));
    let triangles = records.map(|record| record?.runs.last().map(|run| run.triangles as u64));
    let [our_count, their_count] =
        triangles.map(|count| count.map_or("–".to_owned(), |count| thousands(count as usize)));
    [
        line.name.clone(),
        thousands(line.triangles),
        ours,
        theirs,
        both,
        one,
        our_peak,
        their_peak,
        times(quotient(peaks)),
        format!("{our_count}, {their_count}"),
        times(quotient(triangles)),
    ]
}

/// The median in milliseconds, or why there is none.
fn time(record: &Record) -> String {
    match (record.median(), &record.wrong, &record.failure) {
        (Some(seconds), _, _) => significant(1e3 * seconds),
        (None, Some(wrong), _) => format!("WRONG: {wrong}"),
        (None, None, Some(failure)) => failure.text().to_owned(),
        (None, None, None) => String::new(),
    }
}

/// How many times the second the first is; nothing where that is zero.
fn quotient(values: [Option<u64>; 2]) -> Option<f64> {
    let [Some(ours), Some(theirs)] = values else { return None };
    (theirs > 0).then(|| ours as f64 / theirs as f64)
}

fn times(ratio: Option<f64>) -> String {
    ratio.map_or(String::new(), |ratio| format!("{}×", significant(ratio)))
}

#[cfg(test)]
mod tests {
    use super::{quotient, times};

    #[test]
    fn what_cannot_be_compared_has_no_ratio() {
        assert_eq!(times(quotient([Some(3), Some(4)])), "0.75×");
        assert_eq!([[None, Some(1)], [Some(1), None], [Some(0), Some(0)]].map(quotient), [None; 3]);
    }
}
