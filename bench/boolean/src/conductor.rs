//! Lets the entrants of one workload take turns, each in a process of its own.

use std::path::Path;
use std::time::Duration;

use crate::contestants::Outcome;
use crate::entrant::{Entrant, OPENSCAD};
use crate::process::{Failure, Process};

/// How long reading a scene may take; all do so at the same time.
const READING: Duration = Duration::from_secs(60);

/// What an entrant did with a workload.
#[derive(Debug, Clone, Default)]
pub(crate) struct Record {
    pub(crate) runs: Vec<Outcome>,
    /// Resident memory before the first run, in bytes, and the largest of all runs.
    pub(crate) before: Option<u64>,
    pub(crate) peak: Option<u64>,
    /// Why there are no runs, or no more.
    pub(crate) failure: Option<Failure>,
    /// What is wrong with the results; their times do not count.
    pub(crate) wrong: Option<String>,
}

impl Record {
    pub(crate) fn failed(failure: Failure) -> Self {
        Self { failure: Some(failure), ..Self::default() }
    }

    /// Smallest, median and largest time in seconds, right or wrong.
    pub(crate) fn spread(&self) -> Option<[f64; 3]> {
        spread(self.runs.iter().map(|run| run.seconds))
    }

    /// The median, where the results are right.
    pub(crate) fn median(&self) -> Option<f64> {
        self.spread().filter(|_| self.wrong.is_none()).map(|[_, median, _]| median)
    }
}

/// Smallest, median and largest; of an even number of values the median is the mean of the two in the middle.
pub(crate) fn spread(values: impl IntoIterator<Item = f64>) -> Option<[f64; 3]> {
    let mut sorted: Vec<f64> = values.into_iter().collect();
    sorted.sort_by(f64::total_cmp);
    let (first, last) = (*sorted.first()?, *sorted.last()?);
    let middle = sorted.len() / 2;
    let below = if sorted.len().is_multiple_of(2) { sorted[middle - 1] } else { sorted[middle] };
    Some([first, 0.5 * (below + sorted[middle]), last])
}

/// Rounds after the first, which is to warm up and counts only for those that had time for no other. Every other round
/// goes backwards, so that nobody always comes after the same one.
pub(crate) fn conduct(scene: &Path, entrants: &[Entrant], rounds: usize, is_quick: bool) -> Vec<Record> {
    let mut turns: Vec<Turn> = entrants.iter().map(|entrant| Turn::start(*entrant, scene)).collect();
    turns.iter_mut().for_each(Turn::ready);
    for round in 0..=rounds {
        let mut order: Vec<usize> = (0..entrants.len()).collect();
        if round % 2 == 1 {
            order.reverse();
        }
        for k in order {
            turns[k].run(entrants[k], round, is_quick);
        }
    }
    turns.into_iter().map(|turn| turn.record).collect()
}

/// An entrant, as long as it is in the game.
struct Turn {
    process: Option<Process>,
    record: Record,
    /// Seconds of all runs, and of the last one.
    used: f64,
    last: f64,
}

impl Turn {
    fn start(entrant: Entrant, scene: &Path) -> Self {
        let mut turn = Self { process: None, record: Record::default(), used: 0.0, last: 0.0 };
        match Process::start(entrant, scene) {
            Ok(process) => turn.process = Some(process),
            Err(failure) => turn.record.failure = Some(failure),
        }
        turn
    }

    fn ready(&mut self) {
        let Some(process) = &mut self.process else { return };
        match process.until_ready(READING) {
            Ok(()) => self.record.before = process.resident(),
            Err(failure) => self.end(failure),
        }
    }

    fn run(&mut self, entrant: Entrant, round: usize, is_quick: bool) {
        let limits = entrant.limits(is_quick);
        let Some(process) = &mut self.process else { return };
        if !limits.has_time(round, self.used, self.last) {
            self.process = None;
            return;
        }
        match process.run(limits.single) {
            Ok(outcome) => {
                self.last = outcome.seconds;
                self.used += outcome.seconds;
                if entrant.name == OPENSCAD {
                    // the memory is that of another process
                    self.record.before = None;
                } else {
                    self.record.peak = process.peak();
                }
                if round == 1 {
                    self.record.runs.clear();
                }
                self.record.runs.push(outcome);
            }
            Err(failure) => self.end(failure),
        }
    }

    fn end(&mut self, failure: Failure) {
        self.record.failure = Some(failure);
        self.process = None;
    }
}

#[cfg(test)]
mod tests {
    use super::spread;

    #[test]
    fn the_median_is_in_the_middle() {
        assert_eq!(spread([]), None);
        assert_eq!(spread([3.0]), Some([3.0; 3]));
        assert_eq!(spread([4.0, 1.0]), Some([1.0, 2.5, 4.0]));
        assert_eq!(spread([9.0, 1.0, 2.0]), Some([1.0, 2.0, 9.0]));
    }
}
