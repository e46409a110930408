//! Memory that is given back and needed again.

use std::hint::black_box;
use std::sync::atomic::{AtomicBool, Ordering};

/// The largest block by which the C library's allocator (glibc, `mallopt`, `M_MMAP_THRESHOLD`) measures what a program needs.
const LARGEST: usize = (32 << 20) - (1 << 16);

/// Whether memory that is freed is kept.
static IS_KEPT: AtomicBool = AtomicBool::new(false);

/// Lets a process that evaluates again and again keep the memory that it gives back, up to 64 MB for each thread, where its allocator is
/// that of glibc: what the next evaluation needs is not asked of the system page by page, which takes some hundredths of its time. Once is
/// enough; elsewhere it does nothing.
///
/// That allocator gives memory back to the system where twice as much is free as the largest block that was ever freed had, and 128 kB at
/// first. Here a large block is freed that nobody has written to. So that large models do not leave as much behind in every thread, their lists are mapped by
/// themselves from then on, with 32 MB of addresses for each; a limit on addresses (`RLIMIT_AS`, `RLIMIT_DATA`) is to leave room for that.
pub fn keep_freed_memory() {
    if !IS_KEPT.swap(true, Ordering::Relaxed) {
        drop(black_box(Vec::<u8>::with_capacity(LARGEST)));
    }
}

/// Whether [`keep_freed_memory`] was called.
pub fn keeps_freed_memory() -> bool {
    IS_KEPT.load(Ordering::Relaxed)
}
