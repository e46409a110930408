//! All results of one run, and what is asked of them.

use crate::conductor::Record;
use crate::entrant::{CORES, Entrant, PLANECUT};
use crate::trees::Tree;

/// What all entrants did with one workload.
pub(crate) struct Line {
    pub(crate) name: String,
    pub(crate) series: Option<(&'static str, usize)>,
    pub(crate) bodies: usize,
    /// Of all bodies.
    pub(crate) triangles: usize,
    /// Whether bodies are meshes, made of arrays on the clock.
    pub(crate) is_of_meshes: bool,
    /// The volume that counts as right.
    pub(crate) volume: Option<f64>,
    pub(crate) records: Vec<(Entrant, Record)>,
}

impl Line {
    /// What an entrant did.
    pub(crate) fn record(&self, name: &str, cores: usize) -> Option<&Record> {
        let mut records = self.records.iter();
        records.find(|(entrant, _)| entrant.name == name && entrant.cores == cores).map(|(_, record)| record)
    }

    /// The median of an entrant in seconds, where its results are right.
    pub(crate) fn median(&self, name: &str, cores: usize) -> Option<f64> {
        self.record(name, cores)?.median()
    }

    /// How many times longer an entrant takes than planecut on as many cores.
    pub(crate) fn ratio(&self, name: &str, cores: usize) -> Option<f64> {
        Some(self.median(name, cores)? / self.median(PLANECUT, cores)?)
    }

    /// What is wrong with planecut's own results.
    pub(crate) fn our_fault(&self) -> Option<&str> {
        let mut ours = self.records.iter().filter(|(entrant, _)| entrant.is_ours());
        ours.find_map(|(_, record)| record.wrong.as_deref())
    }
}

/// All results of one run.
pub(crate) struct Report {
    pub(crate) lines: Vec<Line>,
    pub(crate) trees: Vec<Tree>,
    pub(crate) rounds: usize,
    pub(crate) is_quick: bool,
    /// Of the whole run.
    pub(crate) seconds: f64,
}

impl Report {
    /// How many times longer an entrant takes than planecut on all cores, for each workload.
    pub(crate) fn ratios<'a>(&'a self, name: &'a str) -> impl Iterator<Item = (&'a str, Option<f64>)> {
        self.lines.iter().map(move |line| (line.name.as_str(), line.ratio(name, CORES)))
    }

    /// Everything that planecut did wrong; no run with anything there is a good one.
    pub(crate) fn our_faults(&self) -> Vec<String> {
        let lines = self.lines.iter().filter_map(|line| Some(format!("{}: {}", line.name, line.our_fault()?)));
        lines.collect()
    }
}
