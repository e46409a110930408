//! Loops over many elements: on all processor cores by `rayon` with feature `threads`, on the calling thread without it.
//!
//! The names are rayon's, and what is given back is the same: results in the order of the elements. Of rayon's methods those are here that
//! planecut's crates call; where one is missing, the build without `threads` says so. [`join`] and [`map_parts`] are for short work as well, that is over before another thread is awake; [`in_pool`] is for work of many loops.
//!
//! ```
//! use planecut_parallel::prelude::*;
//!
//! let squares: Vec<u32> = [1, 2, 3].par_iter().with_min_len(64).map(|n| n * n).collect();
//! assert_eq!(squares, [1, 4, 9]);
//! ```

#![forbid(unsafe_code)]
#![deny(missing_docs)]

#[cfg(feature = "threads")]
mod awake;
#[cfg(feature = "threads")]
mod halves;
#[cfg(feature = "threads")]
mod iterators;
pub mod job;
mod memory;
#[cfg(not(feature = "threads"))]
mod one_thread;
#[cfg(feature = "threads")]
mod parts;
#[cfg(all(feature = "threads", target_os = "linux"))]
mod processors;

#[cfg(feature = "threads")]
pub use iterators::prelude;
pub use memory::{keep_freed_memory, maps_long_lists, spare_addresses};
#[cfg(feature = "threads")]
pub use parts::{drop_beside, in_pool, join, map_parts};
#[cfg(feature = "threads")]
pub use rayon::current_num_threads;

#[cfg(not(feature = "threads"))]
pub use one_thread::{current_num_threads, drop_beside, in_pool, join, map_parts, prelude};

#[cfg(test)]
mod tests;
