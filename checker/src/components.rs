//! The number of connected components, by disjoint sets of numbered elements.
//!
//! Thirty lines of our own: a union-find crate brings more than is needed, and the copy of the pipeline is not used because this crate
//! shares no code with what it checks.

/// A forest of parents (union-find with path halving).
pub(crate) struct Components(Vec<u32>);

impl Components {
    /// Each element in a component of its own.
    pub(crate) fn new(count: usize) -> Self {
        Self((0..count as u32).collect())
    }

    fn root(&mut self, mut i: u32) -> u32 {
        while self.0[i as usize] != i {
            let grandparent = self.0[self.0[i as usize] as usize];
            self.0[i as usize] = grandparent;
            i = grandparent;
        }
        i
    }

    /// Makes one component of those of two elements.
    pub(crate) fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b) as usize] = a.min(b);
    }

    /// A number for each element that those of its component have and no others.
    pub(crate) fn labels(mut self) -> Vec<u32> {
        (0..self.0.len() as u32).map(|i| self.root(i)).collect()
    }

    /// Number of components that hold one of the given elements.
    ///
    /// No component may hold both given and other elements: then each is counted at its root.
    pub(crate) fn count(&self, elements: impl Iterator<Item = usize>) -> usize {
        elements.filter(|&i| self.0[i] as usize == i).count()
    }
}
