//! Disjoint sets of numbered elements.

use crate::ids::number32;

/// A forest of parents (union-find with path halving).
pub struct DisjointSets(Vec<u32>);

impl DisjointSets {
    /// Each element in a set of its own.
    #[must_use]
    pub fn new(count: usize) -> Self {
        Self((0..number32(count)).collect())
    }

    /// The least element of an element's set.
    #[inline]
    pub fn root(&mut self, mut i: u32) -> u32 {
        while self.0[i as usize] != i {
            let grandparent = self.0[self.0[i as usize] as usize];
            self.0[i as usize] = grandparent;
            i = grandparent;
        }
        i
    }

    /// Joins the sets of two elements. The smaller root stays, so that the result does not depend on the order of joins.
    #[inline]
    pub fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b) as usize] = a.min(b);
    }

    /// The number of each element's set, in the order of their least elements, and how many sets there are.
    #[must_use]
    pub fn numbered(mut self) -> (Vec<u32>, usize) {
        let mut number = vec![0; self.0.len()];
        let mut count = 0;
        for i in 0..number.len() {
            // roots are the least of their sets
            let root = self.root(number32(i)) as usize;
            number[i] = number[root];
            if root == i {
                number[i] = count;
                count += 1;
            }
        }
        (number, count as usize)
    }
}
