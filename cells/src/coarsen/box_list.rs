//! Boxes that change, by number, and which of them touch a box.
//!
//! A tree would have to be balanced again all the time. Numbers that are near each other stand for what is near each other, mostly: parts
//! are given in the order in which they were made, and a merged pair takes the number of one that it replaces. So boxes around runs of numbers do.

use planecut_csg::stages::Bounds;

/// Boxes in a run.
const RUN: usize = 32;

/// A box for each number; empty ones touch nothing.
#[derive(Debug, Default)]
pub(super) struct BoxList {
    boxes: Vec<Bounds>,
    /// The box around each run of boxes.
    runs: Vec<Bounds>,
}

impl BoxList {
    pub(super) fn new(boxes: Vec<Bounds>) -> Self {
        let runs = boxes.chunks(RUN).map(around).collect();
        Self { boxes, runs }
    }

    /// Adds a box under the next number.
    pub(super) fn push(&mut self, bounds: Bounds) {
        if self.boxes.len().is_multiple_of(RUN) {
            self.runs.push(Bounds::EMPTY);
        }
        self.boxes.push(bounds);
        self.renew(self.boxes.len() - 1);
    }

    /// Replaces the box of a number.
    pub(super) fn set(&mut self, number: u32, bounds: Bounds) {
        self.boxes[number as usize] = bounds;
        self.renew(number as usize);
    }

    /// The numbers of the boxes that touch a box, ascending.
    pub(super) fn touching(&self, bounds: &Bounds) -> Vec<u32> {
        let mut found = Vec::new();
        for (run, _) in self.runs.iter().enumerate().filter(|(_, run)| run.touches(bounds)) {
            let first = run * RUN;
            let boxes = self.boxes[first..].iter().take(RUN);
            found.extend((first as u32..).zip(boxes).filter(|(_, own)| own.touches(bounds)).map(|(number, _)| number));
        }
        found
    }

    fn renew(&mut self, number: usize) {
        let run = number / RUN;
        let end = self.boxes.len().min((run + 1) * RUN);
        self.runs[run] = around(&self.boxes[run * RUN..end]);
    }
}

/// The box around boxes.
fn around(boxes: &[Bounds]) -> Bounds {
    boxes.iter().fold(Bounds::EMPTY, |all, one| all.union(one))
}

#[cfg(test)]
mod tests {
    use super::super::probes::spread;
    use super::*;

    #[test]
    fn the_boxes_found_are_those_that_are_asked_one_by_one() {
        let random = |k: usize| Bounds { min: spread(k) * 9.0, max: spread(k) * 9.0 + spread(k + 1) };
        for count in [0, 1, 31, 32, 33, 200] {
            let mut boxes: Vec<Bounds> = (0..count / 2).map(random).collect();
            let mut list = BoxList::new(boxes.clone());
            for k in count / 2..count {
                boxes.push(random(k));
                list.push(random(k));
            }
            for step in 0..50 {
                if count > 0 {
                    let number = step * 7 % count;
                    boxes[number] = if step % 3 == 0 { Bounds::EMPTY } else { random(1000 + step) };
                    list.set(number as u32, boxes[number]);
                }
                let asked = random(2000 + step);
                let expected: Vec<u32> = (0..count as u32).filter(|k| boxes[*k as usize].touches(&asked)).collect();
                assert_eq!(list.touching(&asked), expected, "{count} {step}");
            }
        }
    }
}
