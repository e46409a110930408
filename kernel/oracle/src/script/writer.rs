//! Writes scripts whose operations make sense.

use super::{Op, map_planes};
use crate::exact::Coefficients;
use crate::random::Rng;

/// Writes a script while it keeps track of which planes are there.
pub struct Writer<'a> {
    /// Where choices come from.
    pub rng: &'a mut Rng,
    /// No `Add` while this many planes are there: one is removed first.
    pub capacity: usize,
    ops: Vec<Op>,
    names: usize,
    live: Vec<(usize, Coefficients)>,
    removed: Vec<Coefficients>,
}

impl<'a> Writer<'a> {
    /// An empty script of at most `capacity` planes at one time.
    pub fn new(rng: &'a mut Rng, capacity: usize) -> Self {
        Self { rng, capacity, ops: Vec::new(), names: 0, live: Vec::new(), removed: Vec::new() }
    }

    /// The script.
    #[must_use]
    pub fn finish(self) -> Vec<Op> {
        self.ops
    }

    /// Adds a plane; where there is no room a random one goes first.
    pub fn add(&mut self, plane: Coefficients) {
        if self.live.len() >= self.capacity {
            self.remove_any();
        }
        let name = self.names;
        self.names += 1;
        self.live.push((name, plane));
        self.ops.push(Op::Add { name, plane });
    }

    /// Adds planes in this order.
    pub fn add_all(&mut self, planes: &[Coefficients]) {
        planes.iter().for_each(|&p| self.add(p));
    }

    /// Removes the `k`-th oldest plane that is there.
    pub fn remove(&mut self, k: usize) {
        let (name, plane) = self.live.remove(k);
        self.removed.push(plane);
        self.ops.push(Op::Remove { name });
    }

    /// Removes a random plane, if there is one.
    pub fn remove_any(&mut self) {
        if !self.live.is_empty() {
            let k = self.rng.below(self.live.len());
            self.remove(k);
        }
    }

    /// Removes up to `count` random planes at once.
    pub fn remove_many(&mut self, count: usize) {
        let mut names = Vec::new();
        for _ in 0..count.min(self.live.len()) {
            let k = self.rng.below(self.live.len());
            let (name, plane) = self.live.remove(k);
            self.removed.push(plane);
            names.push(name);
        }
        self.ops.push(Op::RemoveMany { names });
    }

    /// Moves the `k`-th oldest plane that is there.
    pub fn move_to(&mut self, k: usize, plane: Coefficients) {
        let entry = &mut self.live[k];
        entry.1 = plane;
        self.ops.push(Op::Move { name: entry.0, plane });
    }

    /// Removes and re-adds the same plane, which becomes the youngest.
    pub fn remove_and_re_add(&mut self, k: usize) {
        let plane = self.live[k].1;
        self.remove(k);
        self.add(plane);
    }

    /// Goes on with a clone.
    pub fn clone_polytope(&mut self) {
        self.ops.push(Op::Clone);
    }

    /// Back to all of space.
    pub fn clear(&mut self) {
        self.live.clear();
        self.ops.push(Op::Clear);
    }

    /// How many planes are there.
    #[must_use]
    pub fn live(&self) -> usize {
        self.live.len()
    }

    /// The half-space of the `k`-th oldest plane that is there.
    #[must_use]
    pub fn plane(&self, k: usize) -> Coefficients {
        self.live[k].1
    }

    /// `steps` random operations: phases that grow and phases that shrink; what is added is sometimes
    /// one of the planes that were removed before. One step in twelve moves a plane or removes several.
    pub fn churn(&mut self, steps: usize, mut source: impl FnMut(&mut Rng) -> Coefficients) {
        let mut growth = 0.5;
        for step in 0..steps {
            if step % 8 == 0 {
                growth = self.rng.pick(&[0.2, 0.5, 0.8]);
            }
            match self.rng.below(24) {
                0 if self.live() > 2 => {
                    let count = self.rng.integer(2, 5) as usize;
                    self.remove_many(count);
                }
                1 if self.live() > 0 => {
                    let k = self.rng.below(self.live());
                    let plane = source(self.rng);
                    self.move_to(k, plane);
                }
                _ if !self.rng.chance(growth) => self.remove_any(),
                _ if !self.removed.is_empty() && self.rng.chance(0.4) => {
                    let k = self.rng.below(self.removed.len());
                    let plane = self.removed.swap_remove(k);
                    self.add(plane);
                }
                _ => {
                    let plane = source(self.rng);
                    self.add(plane);
                }
            }
        }
    }

    /// Applies `change` to every plane written so far.
    pub fn map_planes(&mut self, change: impl Fn(Coefficients) -> Coefficients) {
        map_planes(&mut self.ops, &change);
        self.live.iter_mut().map(|(_, plane)| plane).chain(&mut self.removed).for_each(|p| *p = change(*p));
    }
}
