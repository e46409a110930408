//! The threads that a command works with.

use std::num::NonZero;
use std::thread;

use rayon::ThreadPoolBuilder;

use super::error::CliError;

/// Runs `work` on a pool of `threads` threads, or of as many as there are cores.
///
/// # Errors
/// [`CliError::Threads`] where the system gives none, and what `work` returns.
pub(crate) fn on_threads<T: Send>(
    threads: Option<u16>,
    work: impl FnOnce() -> Result<T, CliError> + Send,
) -> Result<T, CliError> {
    let available = || thread::available_parallelism().map_or(1, NonZero::get);
    let pool = ThreadPoolBuilder::new().num_threads(threads.map_or_else(available, usize::from)).build()?;
    pool.install(work)
}
