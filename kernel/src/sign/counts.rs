//! How many signs each tier answered, per thread.

use std::cell::Cell;

thread_local! {
    static TOTAL: Cell<u64> = const { Cell::new(0) };
    static SMALL_INT: Cell<u64> = const { Cell::new(0) };
    static BIG: Cell<u64> = const { Cell::new(0) };
}

/// How many signs were asked for, and which tier answered.
///
/// Counted per thread: take [`Counts::now`] before and after a piece of work on one thread and subtract; add up the
/// differences of several threads.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Counts {
    /// All signs.
    pub total: u64,
    /// Those that needed exact small integers.
    pub small_int: u64,
    /// Those that needed big integers.
    pub big: u64,
}

impl Counts {
    /// The counters of this thread since it began.
    #[must_use]
    pub fn now() -> Self {
        Self { total: TOTAL.get(), small_int: SMALL_INT.get(), big: BIG.get() }
    }

    /// What was counted on this thread since `start` was taken on it.
    #[must_use]
    pub fn since(start: Self) -> Self {
        let now = Self::now();
        Self { total: now.total - start.total, small_int: now.small_int - start.small_int, big: now.big - start.big }
    }

    /// Those that the floating-point filter decided.
    #[must_use]
    pub fn filtered(&self) -> u64 {
        self.total - self.small_int - self.big
    }
}

impl std::ops::AddAssign for Counts {
    fn add_assign(&mut self, other: Self) {
        self.total += other.total;
        self.small_int += other.small_int;
        self.big += other.big;
    }
}

#[inline]
pub(super) fn note_total() {
    TOTAL.set(TOTAL.get() + 1);
}

pub(super) fn note_small_int() {
    SMALL_INT.set(SMALL_INT.get() + 1);
}

pub(super) fn note_big() {
    BIG.set(BIG.get() + 1);
}
