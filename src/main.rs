//! The `planecut` program. All of it is in [`cli`].
#![forbid(unsafe_code)]

mod cli;

use std::process::ExitCode;

/// Bodies and faces are made of many short lists, and threads take and give them back at the same time.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    cli::run()
}
