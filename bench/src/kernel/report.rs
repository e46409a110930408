//! All results of one run: medians with their spread, and what is asked of them.

use crate::memory::Memory;
use crate::robustness::Tally;
use planecut_bench::library::{Library, Planecut, PolySurge};

/// The samples of one case, in microseconds an operation.
pub(crate) struct Line {
    pub(crate) operation: String,
    pub(crate) size: usize,
    pub(crate) library: &'static str,
    pub(crate) samples: Vec<f64>,
}

impl Line {
    /// Smallest, median and largest sample.
    pub(crate) fn spread(&self) -> [f64; 3] {
        let mut sorted = self.samples.clone();
        sorted.sort_by(f64::total_cmp);
        [sorted[0], sorted[sorted.len() / 2], sorted[sorted.len() - 1]]
    }

    pub(crate) fn median(&self) -> f64 {
        self.spread()[1]
    }
}

/// All results of one run.
pub(crate) struct Report {
    pub(crate) lines: Vec<Line>,
    pub(crate) memory: Vec<Memory>,
    pub(crate) robustness: Vec<Tally>,
    /// How many Voronoi cells there are; none where the shared data is missing.
    pub(crate) cells: usize,
    pub(crate) rounds: usize,
    pub(crate) quick: bool,
}

impl Report {
    pub(crate) fn line(&self, operation: &str, size: usize, library: &str) -> Option<&Line> {
        self.lines.iter().find(|l| l.operation == operation && l.size == size && l.library == library)
    }

    pub(crate) fn lines_of<'a>(&'a self, operation: &'a str) -> impl Iterator<Item = &'a Line> {
        self.lines.iter().filter(move |line| line.operation == operation)
    }

    /// How many times longer `poly_surge` takes, by the medians.
    pub(crate) fn ratio(&self, operation: &str, size: usize) -> Option<f64> {
        let [ours, theirs] = [Planecut::NAME, PolySurge::NAME].map(|name| self.line(operation, size, name));
        Some(theirs?.median() / ours?.median())
    }

    /// Wrong cases of planecut and of `poly_surge`, all categories together.
    pub(crate) fn failures(&self) -> [usize; 2] {
        self.robustness.iter().map(Tally::failures).fold([0; 2], |sum, f| [sum[0] + f[0], sum[1] + f[1]])
    }
}
