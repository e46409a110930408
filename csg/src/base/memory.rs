//! Lists that take much memory.

/// Number of bytes from which lists are not kept longer than they must.
pub(super) const MUCH_MEMORY: usize = 1 << 24;

/// Number of bytes from which the allocator of glibc maps a block by itself, whatever was dropped before, and unmaps it when it is dropped: 32 MB, the
/// greatest value of its `M_MMAP_THRESHOLD`, and a page. With other allocators nothing is to be had.
const MAPPED: usize = if cfg!(all(target_os = "linux", target_env = "gnu", target_pointer_width = "64")) {
    (1 << 25) + (1 << 12)
} else {
    0
};

/// Least number of bytes of a part of a long list for which this is worth while.
const MAPPED_PART: usize = 1 << 20;

/// Whether a list is so long that it should not be there twice.
pub(crate) fn takes_much_memory<T>(count: usize) -> bool {
    count * size_of::<T>() >= MUCH_MEMORY
}

/// An empty list with capacity for `count` elements. It is a whole list, or one of the parts in which a list of `of_all` elements is made. Where freed memory is kept
/// and the whole takes much memory, the capacity is at least 32 MB: the allocator then maps the block by itself and unmaps it when it is dropped, and pages that are
/// not written to take no memory. Of smaller blocks the allocator keeps some 64 MB for each thread that dropped them.
pub(crate) fn with_room<T>(count: usize, of_all: usize) -> Vec<T> {
    let is_mapped =
        planecut_parallel::maps_long_lists() && takes_much_memory::<T>(of_all) && count * size_of::<T>() >= MAPPED_PART;
    let least = if is_mapped { MAPPED.div_ceil(size_of::<T>()) } else { 0 };
    Vec::with_capacity(count.max(least))
}
