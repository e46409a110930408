//! Sums that lose nothing to rounding but the last digit.

/// A sum that carries its own rounding errors along (Neumaier's variant of Kahan's), each found without a branch (Knuth, The Art of Computer Programming,
/// volume 2, section 4.2.2, theorem B).
#[derive(Debug, Clone, Copy, Default)]
pub struct CompensatedSum {
    sum: f64,
    lost: f64,
}

impl CompensatedSum {
    /// Adds a term.
    #[inline]
    pub fn add(&mut self, term: f64) {
        let total = self.sum + term;
        let added = total - self.sum;
        self.lost += (self.sum - (total - added)) + (term - added);
        self.sum = total;
    }

    /// The sum.
    #[inline]
    #[must_use]
    pub fn value(self) -> f64 {
        self.sum + self.lost
    }
}
