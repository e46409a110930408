//! All blocks of a plan on this machine.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;

use planecut_export::write_atomic;
use rayon::ThreadPoolBuilder;

use super::error::BlocksError;
use super::evaluate::evaluate_block;
use super::pieces::Pieces;
use super::plan::BlockPlan;

/// Evaluates the blocks of a plan, as many at a time as there are `threads`: each on one of them, so that memory holds one block for each
/// thread. Pieces that are there already and are those of their blocks are not made again. `watch` is told how many blocks are done and how many there are,
/// and says whether to go on.
///
/// # Errors
/// The first [`BlocksError`] of a block, after which no other is begun; [`BlocksError::Stopped`]; those of [`Pieces::open`].
pub fn evaluate_all(
    plan: &BlockPlan,
    threads: usize,
    watch: &(dyn Fn(usize, usize) -> bool + Sync),
) -> Result<Pieces, BlocksError> {
    let count = plan.blocks().len();
    let (next, done, is_over) = (AtomicUsize::new(0), AtomicUsize::new(0), AtomicBool::new(false));
    let failed: Mutex<Option<BlocksError>> = Mutex::new(None);
    let fail = |error: BlocksError| {
        is_over.store(true, Ordering::Relaxed);
        failed.lock().expect("no thread panics with it").get_or_insert(error);
    };
    let work = || {
        // loops over many elements within a block stay on this thread: others have blocks of their own
        let pool = match ThreadPoolBuilder::new().num_threads(1).build() {
            Ok(pool) => pool,
            Err(error) => return fail(BlocksError::Threads(error.to_string())),
        };
        while !is_over.load(Ordering::Relaxed) {
            let block = next.fetch_add(1, Ordering::Relaxed);
            if block >= count {
                break;
            }
            if let Err(error) = pool.install(|| evaluate_one(plan, block)) {
                return fail(error);
            }
            if !watch(done.fetch_add(1, Ordering::Relaxed) + 1, count) {
                return fail(BlocksError::Stopped);
            }
        }
    };
    thread::scope(|scope| {
        for _ in 0..threads.clamp(1, count.max(1)) {
            scope.spawn(work);
        }
    });
    match failed.into_inner().expect("no thread panics with it") {
        Some(error) => Err(error),
        None => Pieces::open(plan),
    }
}

/// Makes the piece of a block where it is not there.
fn evaluate_one(plan: &BlockPlan, block: usize) -> Result<(), BlocksError> {
    let Some(bytes) = plan.missing(block)? else { return Ok(()) };
    let piece = evaluate_block(&bytes).map_err(|error| match error {
        BlocksError::Damaged { expected, .. } => BlocksError::Damaged { path: plan.block_path(block), expected },
        error => error,
    })?;
    Ok(write_atomic(plan.piece_path(block), &piece)?)
}
