//! Medians with their spread, as a table and as JSON.

use crate::library::{Library, Planecut, PolySurge};
use crate::plan::{BUILD, CLONE_REMOVE, IN_PLACE, PYRAMID_BASE, PYRAMID_SIDES};
use serde_json::{Map, Value, json};

/// The samples of one case, in microseconds an operation.
pub(crate) struct Line {
    pub(crate) operation: &'static str,
    pub(crate) size: usize,
    pub(crate) library: &'static str,
    pub(crate) samples: Vec<f64>,
}

impl Line {
    /// Smallest, median and largest sample.
    fn spread(&self) -> [f64; 3] {
        let mut sorted = self.samples.clone();
        sorted.sort_by(f64::total_cmp);
        [sorted[0], sorted[sorted.len() / 2], sorted[sorted.len() - 1]]
    }

    fn median(&self) -> f64 {
        self.spread()[1]
    }
}

/// All lines of one run.
pub(crate) struct Report {
    pub(crate) lines: Vec<Line>,
    pub(crate) rounds: usize,
    pub(crate) quick: bool,
}

impl Report {
    fn line(&self, operation: &str, size: usize, library: &str) -> Option<&Line> {
        self.lines.iter().find(|l| l.operation == operation && l.size == size && l.library == library)
    }

    /// How many times longer `poly_surge` takes, by the medians.
    fn ratio(&self, operation: &str, size: usize) -> Option<f64> {
        let [ours, theirs] = [Planecut::NAME, PolySurge::NAME].map(|name| self.line(operation, size, name));
        Some(theirs?.median() / ours?.median())
    }

    /// One row for each case, in Markdown.
    pub(crate) fn table(&self) -> String {
        let mut table =
            String::from("| operation | planes | library | median µs | min – max µs | poly_surge / ours |\n");
        table += "|---|---:|---|---:|---:|---:|\n";
        for line in &self.lines {
            let [min, median, max] = line.spread().map(significant);
            let ratio = match self.ratio(line.operation, line.size) {
                Some(ratio) if line.library == PolySurge::NAME => format!("{}×", significant(ratio)),
                _ => String::new(),
            };
            let (operation, size, library) = (line.operation, line.size, line.library);
            table += &format!("| {operation} | {size} | {library} | {median} | {min} – {max} | {ratio} |\n");
        }
        table
    }

    /// The medians by operation and size, the ratios of the two libraries, and every line with its spread.
    pub(crate) fn json(&self) -> Value {
        let medians = |operation: &str, library: &str| -> Map<String, Value> {
            let of = self.lines.iter().filter(|l| l.operation == operation && l.library == library);
            of.map(|l| (l.size.to_string(), json!(l.median()))).collect()
        };
        let operations = |library: &str| {
            json!({
                "remove_in_place_us": medians(IN_PLACE, library),
                "clone_remove_us": medians(CLONE_REMOVE, library),
                "build_us": medians(BUILD, library),
                "pyramid_base_us": medians(PYRAMID_BASE, library),
            })
        };
        let mut report = operations(Planecut::NAME);
        report["poly_surge"] = operations(PolySurge::NAME);
        report["vs_poly_surge"] = json!({
            "remove_30": self.ratio(CLONE_REMOVE, 30),
            "remove_200": self.ratio(CLONE_REMOVE, 200),
            "in_place_30": self.ratio(IN_PLACE, 30),
            "in_place_200": self.ratio(IN_PLACE, 200),
            "build_30": self.ratio(BUILD, 30),
            "build_200": self.ratio(BUILD, 200),
            "pyramid_200": self.ratio(PYRAMID_BASE, PYRAMID_SIDES),
        });
        report["rounds"] = json!(self.rounds);
        report["quick"] = json!(self.quick);
        report["spread"] = self.lines.iter().map(spread_entry).collect();
        report
    }
}

fn spread_entry(line: &Line) -> Value {
    let [min, median, max] = line.spread();
    let (operation, size, library) = (line.operation, line.size, line.library);
    json!({"operation": operation, "planes": size, "library": library, "min_us": min, "median_us": median, "max_us": max})
}

/// A number with three significant digits, larger ones without a fraction and with thousands apart.
fn significant(value: f64) -> String {
    let decimals = if value < 10.0 { 2 } else { usize::from(value < 100.0) };
    let text = format!("{value:.decimals$}");
    if value < 1000.0 {
        return text;
    }
    let digits: Vec<&str> = (0..text.len())
        .filter(|i| *i == 0 || (text.len() - i) % 3 == 0)
        .map(|i| &text[i..i + if i == 0 && text.len() % 3 != 0 { text.len() % 3 } else { 3 }])
        .collect();
    digits.join(",")
}
