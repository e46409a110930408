//! Memory that is given back and needed again.

use std::hint::black_box;
use std::sync::Once;

/// The largest block by which the C library's allocator (glibc, `mallopt`, `M_MMAP_THRESHOLD`) measures what a program needs.
const LARGEST: usize = (32 << 20) - (1 << 16);

/// Lets a process that evaluates again and again keep the memory that it gives back, up to 64 MB for each thread, where its allocator is
/// that of glibc: what the next evaluation needs is not asked of the system page by page, which takes some hundredths of its time. Once is
/// enough; elsewhere it does nothing.
///
/// That allocator gives memory back to the system where twice as much is free as the largest block that was ever freed had, and 128 kB at
/// first. Here a large block is freed that nobody has written to.
pub fn keep_freed_memory() {
    static DONE: Once = Once::new();
    DONE.call_once(|| drop(black_box(Vec::<u8>::with_capacity(LARGEST))));
}
