//! The `planecut` program. All of it is in [`planecut::cli`].
#![forbid(unsafe_code)]

use std::process::ExitCode;

/// Bodies and faces are made of many short lists, and threads take and give them back at the same time.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    planecut::cli::run(std::env::args_os()).into()
}
