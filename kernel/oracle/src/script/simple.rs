//! Scripts for kernels that can only add and remove single planes.

use std::collections::HashMap;

use super::Op;
use crate::exact::Coefficients;

/// The same planes after every operation of `ops` in single additions and removals, for kernels that have nothing else.
///
/// A `Move` becomes a removal and an addition, so that the plane is the youngest: the set is the same, its perturbation
/// is not.
#[must_use]
pub fn as_adds_and_removes(ops: &[Op]) -> Vec<Op> {
    let mut simple = Simple::default();
    for op in ops {
        match op {
            Op::Add { name, plane } => simple.add(*name, *plane),
            Op::Remove { name } => {
                simple.remove(*name);
            }
            Op::RemoveMany { names } => {
                for name in names {
                    simple.remove(*name);
                }
            }
            Op::Move { name, plane } => {
                if simple.remove(*name).is_some() {
                    simple.add(*name, *plane);
                }
            }
            Op::Clone => {}
            Op::Clear => simple.clear(),
        }
    }
    simple.ops
}

/// A script in the making.
#[derive(Default)]
struct Simple {
    ops: Vec<Op>,
    /// The planes that are there: what `ops` calls a plane, by its name in the original.
    live: HashMap<usize, usize>,
    names: usize,
}

impl Simple {
    fn add(&mut self, name: usize, plane: Coefficients) {
        self.live.insert(name, self.names);
        self.ops.push(Op::Add { name: self.names, plane });
        self.names += 1;
    }

    fn remove(&mut self, name: usize) -> Option<usize> {
        let name = self.live.remove(&name)?;
        self.ops.push(Op::Remove { name });
        Some(name)
    }

    fn clear(&mut self) {
        let mut left: Vec<usize> = self.live.drain().map(|(_, name)| name).collect();
        left.sort_unstable();
        self.ops.extend(left.into_iter().map(|name| Op::Remove { name }));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::category::Category;
    use crate::random::Rng;

    /// The planes that are there after a script, in no particular order.
    fn left(ops: &[Op]) -> Vec<Coefficients> {
        let mut live: Vec<(usize, Coefficients)> = Vec::new();
        for op in ops {
            match op {
                Op::Add { name, plane } => live.push((*name, *plane)),
                Op::Remove { name } => live.retain(|(n, _)| n != name),
                Op::RemoveMany { names } => live.retain(|(n, _)| !names.contains(n)),
                Op::Move { name, plane } => {
                    live.iter_mut().filter(|(n, _)| n == name).for_each(|(_, p)| *p = *plane);
                }
                Op::Clone => {}
                Op::Clear => live.clear(),
            }
        }
        let mut planes: Vec<Coefficients> = live.into_iter().map(|(_, p)| p).collect();
        planes.sort_by(|a, b| a.partial_cmp(b).expect("no NaN"));
        planes
    }

    #[test]
    fn simple_scripts_leave_the_same_planes() {
        let mut rng = Rng::new(1);
        let mut kinds = [0; 2];
        for _ in 0..20 {
            for category in Category::ALL {
                let ops = category.script(&mut rng, 12);
                let simple = as_adds_and_removes(&ops);
                assert!(simple.iter().all(|op| matches!(op, Op::Add { .. } | Op::Remove { .. })));
                assert_eq!(left(&simple), left(&ops), "{category:?}");
                kinds[0] += ops.iter().filter(|op| matches!(op, Op::Move { .. })).count();
                kinds[1] += ops.iter().filter(|op| matches!(op, Op::RemoveMany { .. })).count();
            }
        }
        assert!(kinds.iter().all(|&n| n > 50), "{kinds:?}");
    }
}
