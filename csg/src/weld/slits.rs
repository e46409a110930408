//! Where faces that lie on both sides of a line cross other faces in it, and must be slit along it.
//!
//! A face on both sides of a line has two half-planes around it. What was cut there and cancelled is known; of what was never cut there
//! at all there is at most one plane, because a body that passes through a line cuts the face of every other body that does. Two
//! planes always cross, so where two are known, or one is known and another one must be there, the known ones are slit.

use super::around::{AroundLine, Sheet};
use super::cancel::{Run, place, sort_along};
use super::points::Points;
use crate::ids::{Id, PointId};

/// Finds slits; holds buffers.
#[derive(Default)]
pub(super) struct SlitFinder {
    stops: Vec<PointId>,
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
        self.stops.clear();
        self.stops.extend(cancelled.iter().chain(surviving).flat_map(|run| [run.from, run.to]));
        sort_along(around.table, points, around.line, &mut self.stops);
        let interval = |run: &Run, k: usize| {
            let [a, b] = [run.from, run.to].map(|end| place(around.table, points, around.line, &self.stops, end));
            a.min(b) < k && k <= a.max(b)
        };
        for k in 1..self.stops.len() {
            self.passing.clear();
            self.passing.extend(cancelled.iter().filter(|run| interval(run, k)));
            let Some(first) = self.passing.first() else { continue };
            let several = self.passing.iter().any(|run| plane(run) != plane(first));
            self.sheets.clear();
            self.sheets.extend(surviving.iter().filter(|run| interval(run, k)).map(Sheet::from));
            if several || is_crossed(around, &self.passing, &mut self.sheets) {
                let (from, to) = (self.stops[k - 1], self.stops[k]);
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
