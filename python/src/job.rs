//! Work without the interpreter's lock: on other threads, watched, and ended by Ctrl-C.

use std::collections::HashMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Arc, LazyLock, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use planecut_parallel::job::{Watch, set_watch, watched};
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::errors::{Failure, Outcome, refuse};

/// The process that has imported the package.
static FIRST_PROCESS: LazyLock<u32> = LazyLock::new(process::id);

/// Time between two looks at signals and progress: Ctrl-C is seen within it.
const TICK: Duration = Duration::from_millis(50);

/// How work is done.
#[derive(Default)]
pub(crate) struct Job {
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
    is_short: bool,
    is_counted: bool,
}

impl Job {
    /// Work that may take long: it can be interrupted, and tells how far it is where that is asked for.
    ///
    /// # Errors
    /// `PlanecutError` for no threads at all, and for what cannot be called.
    pub(crate) fn new(py: Python<'_>, threads: Option<usize>, progress: Option<Py<PyAny>>) -> PyResult<Self> {
        if let Some(found) = threads.filter(|threads| !(1..=1024).contains(threads)) {
            return Err(refuse(format!("threads: found {found}, expected 1 to 1024")));
        }
        if progress.as_ref().is_some_and(|progress| !progress.bind(py).is_callable()) {
            return Err(refuse("progress: found what cannot be called, expected a function of done and total"));
        }
        Ok(Self { threads, progress, ..Self::default() })
    }

    /// The same for work that surely takes far less than anybody waits: it costs no thread of its own.
    pub(crate) fn short_if(self, is_short: bool) -> Self {
        let is_short = is_short && self.threads.is_none() && self.progress.is_none();
        Self { is_short, ..self }
    }

    /// The same for work that knows all of its steps: these are told as they are.
    pub(crate) fn counted(self) -> Self {
        Self { is_counted: true, ..self }
    }

    /// Does the work.
    ///
    /// # Errors
    /// What the work gives; `InternalError` for a panic; `KeyboardInterrupt`, and whatever a handler of a signal or the function for progress raises. Then the work goes on for
    /// a moment without anybody waiting for it.
    pub(crate) fn run<T: Send + 'static>(
        self,
        py: Python<'_>,
        work: impl FnOnce() -> Outcome<T> + Send + 'static,
    ) -> PyResult<T> {
        if self.is_short {
            return Ok(py.detach(|| on_threads_of_process(work))?);
        }
        self.run_watched(py, move |_| work())
    }

    /// The same for work that has threads of its own, which are to know the watch.
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub(crate) fn run_watched<T: Send + 'static>(
        self,
        py: Python<'_>,
        work: impl FnOnce(&Arc<Watch>) -> Outcome<T> + Send + 'static,
    ) -> PyResult<T> {
        let watch = Watch::new();
        let (sender, mut receiver) = mpsc::channel();
        let (threads, own) = (self.threads, Arc::clone(&watch));
        let begin = move || {
            let outcome =
                new_pool(threads, Some(&own)).and_then(|pool| pool.install(|| watched(&own, || caught(|| work(&own)))));
            // nobody waits any more after an interrupt
            let _ = sender.send(outcome);
        };
        thread::Builder::new().name("planecut".to_owned()).spawn(begin).map_err(refuse)?;
        let mut told = Told::default();
        loop {
            // it is moved there and back: a receiver is for one thread
            let (back, received) = py.detach(move || {
                let received = receiver.recv_timeout(TICK);
                (receiver, received)
            });
            receiver = back;
            match received {
                Ok(outcome) => {
                    let outcome = outcome?;
                    self.tell(py, watch.progress(), &mut told, true)?;
                    return Ok(outcome);
                }
                Err(RecvTimeoutError::Disconnected) => {
                    return Err(Failure::bug("found a thread that ended without an outcome").into());
                }
                Err(RecvTimeoutError::Timeout) => {
                    let seen = py.check_signals().and_then(|()| self.tell(py, watch.progress(), &mut told, false));
                    if let Err(error) = seen {
                        watch.stop();
                        return Err(error);
                    }
                }
            }
        }
    }

    /// Calls the function for progress where there is news.
    fn tell(&self, py: Python<'_>, now: (usize, usize), told: &mut Told, is_end: bool) -> PyResult<()> {
        let Some(progress) = &self.progress else { return Ok(()) };
        let (done, total) = match self.is_counted {
            // threads tell it in any order
            true => (if is_end { now.1 } else { told.done.max(now.0) }, now.1),
            false => (if is_end { Told::TOTAL } else { told.next(now) }, Told::TOTAL),
        };
        if done == told.done {
            return Ok(());
        }
        told.done = done;
        progress.call1(py, (done, total)).map(|_| ())
    }
}

/// How far work is, as it is told: it never falls, although each stage of the work starts at nothing and nobody knows how many there are. Each takes half of what is left.
#[derive(Default)]
struct Told {
    done: usize,
    /// The last steps of the stage, and what was told when it began.
    stage: (usize, usize),
    begin: usize,
}

impl Told {
    const TOTAL: usize = 1000;

    fn next(&mut self, (done, total): (usize, usize)) -> usize {
        if total != self.stage.1 || done < self.stage.0 {
            self.begin = self.done;
        }
        self.stage = (done, total);
        let left = (Self::TOTAL - self.begin) / 2;
        // between two looks a stage may have become another one of as many steps
        self.done.max(self.begin + left * done.min(total) / total.max(1))
    }
}

/// Does work, and catches panics.
fn caught<T>(work: impl FnOnce() -> Outcome<T>) -> Outcome<T> {
    // what a panic leaves half-done is dropped with it: objects are changed by work that is complete alone
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|payload| Err(Failure::of_panic(&*payload)))
}

fn new_pool(threads: Option<usize>, watch: Option<&Arc<Watch>>) -> Outcome<ThreadPool> {
    let builder = ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0));
    let builder = match watch.map(Arc::clone) {
        Some(watch) => builder.start_handler(move |_| set_watch(&watch)),
        None => builder,
    };
    builder.build().map_err(Failure::of)
}

/// The threads for short work. A process that was forked has none of its parent's threads: it makes its own.
fn shared_pool() -> Outcome<Arc<ThreadPool>> {
    static POOLS: Mutex<Option<HashMap<u32, Arc<ThreadPool>>>> = Mutex::new(None);
    let mut pools = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
    let pools = pools.get_or_insert_default();
    if let Some(pool) = pools.get(&process::id()) {
        return Ok(Arc::clone(pool));
    }
    let pool = Arc::new(new_pool(None, None)?);
    pools.insert(process::id(), Arc::clone(&pool));
    Ok(pool)
}

/// Does short work on the calling thread, and where it is worth it on the threads that the process has for all. A process that was forked has none of these: there, and there alone,
/// it is done on a pool of our own.
pub(crate) fn on_threads_of_process<T: Send>(work: impl FnOnce() -> Outcome<T> + Send) -> Outcome<T> {
    if *FIRST_PROCESS == process::id() { caught(work) } else { shared_pool()?.install(|| caught(work)) }
}

/// Notes which process has imported the package.
pub(crate) fn note_process() {
    LazyLock::force(&FIRST_PROCESS);
}
