//! `planecut batch`: many jobs, each in a process with its limits; what is there already, or in a cache, is not made again.
//!
//! The manifest (`manifest`) gives jobs (`job`), which threads take one after another (`run`). Each thread has a process (`process`) that is kept (`worker` is what it
//! runs) and ended where a job is over its limits. Files appear under their names when a job is done. What becomes of it is a line of the results (`results`), with the
//! key (`key`) by which another batch sees whether it is up to date, and by which it is found in the cache (`cache`).

mod args;
mod cache;
mod job;
mod key;
mod manifest;
mod process;
mod results;
mod run;
mod verify;
mod worker;

pub(crate) use args::BatchArgs;

use super::error::{CliError, Done};

/// Runs the command.
///
/// # Errors
/// [`CliError::Manifest`] and [`CliError::Read`] where there are no jobs to begin with, [`CliError::Write`] where results cannot be told, [`CliError::Batch`] where a job failed.
pub(crate) fn run(args: &BatchArgs) -> Result<Done, CliError> {
    match (&args.manifest, &args.out) {
        (Some(manifest), Some(out)) if !args.worker => run::Batch::begin(args, manifest::read(manifest)?, out)?.run(),
        _ => worker::run(args.memory),
    }
}
