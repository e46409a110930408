//! Where faces that lie on both sides of a line cross other faces in it, and must be slit along it.
//!
//! A face on both sides of a line has two half-planes around it. What was cut there and cancelled is known; of what was never cut there
//! at all there is at most one plane, because a body that passes through a line cuts the face of every other body that does. Two
//! planes always cross, so where two are known, or one is known and another one must be there, the known ones are slit.

use super::around::{AroundLine, Sheet};
use super::cancel::Run;
use super::points::Points;
use super::stops::Stops;
use crate::ids::Id;

/// Finds slits; holds buffers.
#[derive(Clone, Default)]
pub(super) struct SlitFinder {
    stops: Stops,
    /// What cancelled on an interval.
    passing: Vec<Run>,
    sheets: Vec<Sheet>,
}

impl SlitFinder {
    /// Adds the slits of a line, forward only: `cancelled` are the runs along which a region lies on both sides of it, forward only,
    /// `surviving` all others.
    pub(super) fn find(
        &mut self,
        around: &AroundLine<'_>,
        points: &Points,
        cancelled: &[Run],
        surviving: &[Run],
        slits: &mut Vec<Run>,
    ) {
        let plane = |run: &Run| around.planes[run.region.index()].index();
        let Some(first) = cancelled.first().map(plane) else { return };
        if surviving.is_empty() && cancelled.iter().all(|run| plane(run) == first) {
            return;
        }
        let ends = cancelled.iter().chain(surviving).flat_map(|run| [run.from, run.to]);
        self.stops.set(around.table, points, around.line, ends);
        let (of_cancelled, of_surviving) = self.stops.places().split_at(cancelled.len());
        for (k, ends) in (1..).zip(self.stops.points().windows(2)) {
            let spans = |[a, b]: [u32; 2]| a.min(b) < k && k <= a.max(b);
            self.passing.clear();
            self.passing
                .extend(cancelled.iter().zip(of_cancelled).filter(|(_, ends)| spans(**ends)).map(|(run, _)| *run));
            let Some(first) = self.passing.first() else { continue };
            let several = self.passing.iter().any(|run| plane(run) != plane(first));
            self.sheets.clear();
            let is_there = surviving.iter().zip(of_surviving).filter(|(_, ends)| spans(**ends));
            self.sheets.extend(is_there.map(|(run, _)| Sheet::from(run)));
            if several || is_crossed(around, &self.passing, &mut self.sheets) {
                let &[from, to] = ends else { continue };
                slits.extend(self.passing.iter().map(|run| Run { from, to, ..*run }));
            }
        }
    }
}

/// Whether another plane must pass through a line, unseen: where the order of all that is known, `ending` there or passing, does not
/// alternate.
fn is_crossed(around: &AroundLine<'_>, passing: &[Run], ending: &mut Vec<Sheet>) -> bool {
    if ending.is_empty() {
        return false;
    }
    let both_sides = |run: &Run| [true, false].map(|forward| Sheet { region: run.region, forward });
    ending.extend(passing.iter().flat_map(both_sides));
    around.sort(ending, |sheet| sheet);
    (0..ending.len()).any(|k| ending[k].forward == ending[(k + 1) % ending.len()].forward)
}
