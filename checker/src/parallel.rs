//! Loops over numbered items: on several threads with the feature `parallel`, otherwise on this one.

#[cfg(feature = "parallel")]
use rayon::prelude::*;

/// What `f` gives for each of `0..count`, in this order.
#[cfg(feature = "parallel")]
pub(crate) fn map<T: Send>(count: usize, f: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    (0..count).into_par_iter().map(f).collect()
}

/// What `f` gives for each of `0..count`, in this order.
#[cfg(not(feature = "parallel"))]
pub(crate) fn map<T: Send>(count: usize, f: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    (0..count).map(f).collect()
}

/// Calls `f` with each of `0..count`, in any order.
#[cfg(feature = "parallel")]
pub(crate) fn for_each(count: usize, f: impl Fn(usize) + Sync + Send) {
    (0..count).into_par_iter().for_each(f);
}

/// Calls `f` with each of `0..count`, in any order.
#[cfg(not(feature = "parallel"))]
pub(crate) fn for_each(count: usize, f: impl Fn(usize) + Sync + Send) {
    (0..count).for_each(f);
}

/// Runs both, possibly at the same time.
#[cfg(feature = "parallel")]
pub(crate) fn join(a: impl FnOnce() + Send, b: impl FnOnce() + Send) {
    rayon::join(a, b);
}

/// Runs both, possibly at the same time.
#[cfg(not(feature = "parallel"))]
pub(crate) fn join(a: impl FnOnce() + Send, b: impl FnOnce() + Send) {
    a();
    b();
}
