//! What a person sees while longer work goes on.

use std::io::{self, IsTerminal};
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget};

/// Work shorter than this shows nothing.
const DELAY: Duration = Duration::from_secs(1);
/// Time between two pictures of the spinner.
const TICK: Duration = Duration::from_millis(100);

/// A spinner with the name of the stage, on standard error; only on a terminal, and only on work longer than [`DELAY`].
/// Dropping it clears the line.
pub(crate) struct Progress {
    bar: ProgressBar,
    /// Dropped to end the thread that reveals the spinner; none where there is nothing to reveal.
    reveal: Option<(Sender<()>, JoinHandle<()>)>,
}

impl Progress {
    /// Starts the clock; with `quiet` nothing is ever shown.
    pub(crate) fn start(quiet: bool) -> Self {
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
        let reveal = (!quiet && io::stderr().is_terminal()).then(|| reveal_later(bar.clone()));
        Self { bar, reveal }
    }

    /// Says what is being done now.
    pub(crate) fn stage(&self, name: &'static str) {
        self.bar.set_message(name);
    }

    /// Says how much of it is done.
    pub(crate) fn counted(&self, name: &'static str, done: usize, of: usize) {
        self.bar.set_message(format!("{name} {done} of {of}"));
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some((sender, thread)) = self.reveal.take() {
            drop(sender);
            // It has nothing to tell: a spinner that failed is no reason to fail the work.
            let _ = thread.join();
        }
        self.bar.finish_and_clear();
    }
}

fn reveal_later(bar: ProgressBar) -> (Sender<()>, JoinHandle<()>) {
    let (sender, receiver) = mpsc::channel();
    let thread = thread::spawn(move || {
        if receiver.recv_timeout(DELAY) == Err(RecvTimeoutError::Timeout) {
            bar.set_draw_target(ProgressDrawTarget::stderr());
            bar.enable_steady_tick(TICK);
        }
    });
    (sender, thread)
}
