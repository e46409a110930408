//! Ends the test run when one script takes for ever, and says which script it was.

use std::collections::HashMap;
use std::process::exit;
use std::sync::{Mutex, Once, PoisonError};
use std::thread::{self, ThreadId};
use std::time::{Duration, Instant};

use crate::script::{Op, as_rust};

/// Longer than any script, even on a busy machine.
const LIMIT: Duration = Duration::from_secs(60);

/// The script each thread runs, and since when.
static RUNNING: Mutex<Option<Running>> = Mutex::new(None);

type Running = HashMap<ThreadId, (Instant, Vec<Op>)>;

/// Says that this thread begins with a script. The watch ends when the result is dropped.
#[must_use]
pub fn watch(ops: &[Op]) -> Watch {
    static START: Once = Once::new();
    START.call_once(|| drop(thread::spawn(look_around)));
    with_running(|running| running.insert(thread::current().id(), (Instant::now(), ops.to_vec())));
    Watch
}

/// See [`watch`].
#[derive(Debug)]
pub struct Watch;

impl Drop for Watch {
    fn drop(&mut self) {
        with_running(|running| running.remove(&thread::current().id()));
    }
}

fn with_running<T>(act: impl FnOnce(&mut Running) -> T) -> T {
    act(RUNNING.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert_default())
}

fn look_around() {
    loop {
        thread::sleep(Duration::from_secs(1));
        let stuck = with_running(|running| running.values().find(|(since, _)| since.elapsed() > LIMIT).cloned());
        if let Some((_, ops)) = stuck {
            eprintln!("no end after {LIMIT:?}:\n{}", as_rust(&ops));
            exit(101);
        }
    }
}
