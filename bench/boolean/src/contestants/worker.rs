//! The process of one contestant: reads a scene, says that it is ready, and answers each line of standard input with
//! one run.

use std::io::{BufRead, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::{Outcome, prepare};
use crate::entrant::OURS;
use crate::scene::Scene;

/// A line of standard output, as JSON.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) enum Answer {
    /// The scene is read.
    Ready,
    /// What a run gave.
    Ok(Outcome),
    /// Why there is nothing.
    Err(String),
}

/// Serves until standard input ends.
pub(crate) fn serve(name: &str, file: &Path) -> Result<(), String> {
    // Read by another thread than works with it: what is dropped before the clock starts would leave holes among what stays, and
    // count as memory of the kernel.
    let read = if OURS.contains(&name) { Scene::read_half_spaces } else { Scene::read };
    let scene = read(file).map_err(|error| error.to_string());
    // recursive kernels need it: a plane for each level
    let thread = std::thread::Builder::new().stack_size(1 << 30);
    let served = thread.spawn({
        let (name, file) = (name.to_owned(), file.to_owned());
        move || answer(&name, scene, &file)
    });
    served.map_err(|error| error.to_string())?.join().map_err(|_| "it panicked".to_owned())
}

fn answer(name: &str, scene: Result<Scene, String>, file: &Path) {
    let prepared = caught(|| prepare(name, scene?, file));
    // for everybody alike: processes that are run again and again
    planecut_csg::keep_freed_memory();
    let mut contestant = match prepared {
        Ok(contestant) => contestant,
        Err(error) => return say(&Answer::Err(error)),
    };
    say(&Answer::Ready);
    for _ in std::io::stdin().lock().lines().map_while(Result::ok) {
        say(&match caught(|| contestant.run()) {
            Ok(outcome) => Answer::Ok(outcome),
            Err(error) => Answer::Err(error),
        });
    }
}

/// A panic as an error. What it leaves behind is not used again: the first error ends a contestant.
fn caught<T>(run: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(run)).unwrap_or_else(|payload| {
        let text = payload.downcast_ref::<String>().map(String::as_str);
        Err(format!("panicked: {}", text.or(payload.downcast_ref::<&str>().copied()).unwrap_or_default()))
    })
}

fn say(answer: &Answer) {
    let mut out = std::io::stdout().lock();
    // a conductor that has gone away ends this process by its closed standard input
    let _ = serde_json::to_string(answer).map(|line| writeln!(out, "{line}").and_then(|()| out.flush()));
}
