//! Memory that is given back and needed again.

use std::hint::black_box;
use std::sync::atomic::{AtomicBool, Ordering};

/// The largest block by which the C library's allocator (glibc, `mallopt`, `M_MMAP_THRESHOLD`) measures what a program needs.
const LARGEST: usize = (32 << 20) - (1 << 16);

/// Whether memory that is freed is kept.
static IS_KEPT: AtomicBool = AtomicBool::new(false);

/// Whether addresses are limited.
static ARE_ADDRESSES_SPARED: AtomicBool = AtomicBool::new(false);

/// Lets a process that evaluates again and again keep the memory that it gives back, up to 64 MB for each thread, where its allocator is
/// that of glibc: what the next evaluation needs is not asked of the system page by page, which takes some hundredths of its time. Once is
/// enough; elsewhere it does nothing.
///
/// That allocator gives memory back to the system where twice as much is free as the largest block that was ever freed had, and 128 kB at
/// first. Here a large block is freed that nobody has written to. So that large models do not leave as much behind in every thread, their lists are mapped by
/// themselves from then on, with 32 MB of addresses for each, unless [`spare_addresses`] is called.
pub fn keep_freed_memory() {
    if !IS_KEPT.swap(true, Ordering::Relaxed) {
        drop(black_box(Vec::<u8>::with_capacity(LARGEST)));
    }
}

/// Lets no lists be mapped by themselves by a process that keeps freed memory: where addresses are limited (`RLIMIT_AS`, `RLIMIT_DATA`), those count that
/// nothing is written to.
pub fn spare_addresses() {
    ARE_ADDRESSES_SPARED.store(true, Ordering::Relaxed);
}

/// Whether the lists of large models are to be mapped by themselves: where [`keep_freed_memory`] was called, and [`spare_addresses`] was not.
pub fn maps_long_lists() -> bool {
    IS_KEPT.load(Ordering::Relaxed) && !ARE_ADDRESSES_SPARED.load(Ordering::Relaxed)
}
