//! Sequences of adds and removes, made before they are run so that they can be shrunk and printed.

use std::fmt::Write;

use crate::exact::Coefficients;
use crate::random::Rng;

/// One operation. A plane is named by the number its `Add` carries, unique within a script.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Op {
    Add { name: usize, plane: Coefficients },
    Remove { name: usize },
}

/// Writes a script while it keeps track of which planes are there.
pub(crate) struct Writer<'a> {
    pub(crate) rng: &'a mut Rng,
    /// No `Add` while this many planes are there: one is removed first.
    pub(crate) capacity: usize,
    ops: Vec<Op>,
    live: Vec<(usize, Coefficients)>,
    removed: Vec<Coefficients>,
}

impl<'a> Writer<'a> {
    pub(crate) fn new(rng: &'a mut Rng, capacity: usize) -> Self {
        Self { rng, capacity, ops: Vec::new(), live: Vec::new(), removed: Vec::new() }
    }

    pub(crate) fn finish(self) -> Vec<Op> {
        self.ops
    }

    pub(crate) fn add(&mut self, plane: Coefficients) {
        if self.live.len() >= self.capacity {
            self.remove_any();
        }
        let name = self.ops.len();
        self.live.push((name, plane));
        self.ops.push(Op::Add { name, plane });
    }

    pub(crate) fn add_all(&mut self, planes: &[Coefficients]) {
        planes.iter().for_each(|&p| self.add(p));
    }

    /// Removes the `k`-th oldest plane that is there.
    pub(crate) fn remove(&mut self, k: usize) {
        let (name, plane) = self.live.remove(k);
        self.removed.push(plane);
        self.ops.push(Op::Remove { name });
    }

    pub(crate) fn remove_any(&mut self) {
        if !self.live.is_empty() {
            let k = self.rng.below(self.live.len());
            self.remove(k);
        }
    }

    /// Removes and re-adds the same plane, which becomes the youngest.
    pub(crate) fn remove_and_re_add(&mut self, k: usize) {
        let plane = self.live[k].1;
        self.remove(k);
        self.add(plane);
    }

    pub(crate) fn live(&self) -> usize {
        self.live.len()
    }

    /// `steps` random operations: phases that grow and phases that shrink; what is added is sometimes
    /// one of the planes that were removed before.
    pub(crate) fn churn(&mut self, steps: usize, mut source: impl FnMut(&mut Rng) -> Coefficients) {
        let mut growth = 0.5;
        for step in 0..steps {
            if step % 8 == 0 {
                growth = self.rng.pick(&[0.2, 0.5, 0.8]);
            }
            if !self.rng.chance(growth) {
                self.remove_any();
            } else if !self.removed.is_empty() && self.rng.chance(0.4) {
                let k = self.rng.below(self.removed.len());
                let plane = self.removed.swap_remove(k);
                self.add(plane);
            } else {
                let plane = source(self.rng);
                self.add(plane);
            }
        }
    }

    /// Applies `change` to every plane written so far.
    pub(crate) fn map_planes(&mut self, change: impl Fn(Coefficients) -> Coefficients) {
        for op in &mut self.ops {
            if let Op::Add { plane, .. } = op {
                *plane = change(*plane);
            }
        }
    }
}

/// The script as Rust, to be pasted into `regressions.rs`.
pub(crate) fn as_rust(ops: &[Op]) -> String {
    let mut text = String::from("&[\n");
    for op in ops {
        let _ = match op {
            Op::Add { name, plane } => writeln!(text, "    Op::Add {{ name: {name}, plane: {plane:?} }},"),
            Op::Remove { name } => writeln!(text, "    Op::Remove {{ name: {name} }},"),
        };
    }
    text + "]"
}
