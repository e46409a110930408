//! Changes of the file as events for pages, in the format of server-sent events (WHATWG HTML, section 9.2).

use std::io::{self, Write};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Time after which something is sent though nothing has happened: only by writing does one learn that a browser has left.
const SILENCE: Duration = Duration::from_secs(15);

/// What all pages wait for.
#[derive(Debug)]
pub(super) struct Changes {
    latest: Mutex<Version>,
    came: Condvar,
}

/// A version of the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Version {
    /// How many came before it.
    number: u64,
    /// What stands for its bytes.
    content: u64,
}

impl Changes {
    /// None yet, of a file that holds `content`.
    pub(super) fn new(content: u64) -> Self {
        Self { latest: Mutex::new(Version { number: 0, content }), came: Condvar::new() }
    }

    /// Tells all who wait that the file holds something else.
    pub(super) fn tell(&self, content: u64) {
        let mut latest = self.latest();
        *latest = Version { number: latest.number + 1, content };
        drop(latest);
        self.came.notify_all();
    }

    /// Writes an event for each change, until that fails. Where a page went without this stream for a while, `last_event` is the id of the last one that it got, and what has
    /// changed since is told at once.
    ///
    /// # Errors
    /// Those of writing.
    pub(super) fn stream(&self, last_event: Option<&str>, mut output: impl Write) -> io::Result<()> {
        let known = last_event.and_then(|id| u64::from_str_radix(id, 16).ok());
        let mut content = known.unwrap_or_else(|| self.latest().content);
        // an id alone is no event, but what the browser says when it comes again
        output.write_all(format!("id: {content:016x}\n\n").as_bytes())?;
        loop {
            output.flush()?;
            match self.wait(content, SILENCE) {
                Some(version) => {
                    content = version.content;
                    write!(output, "id: {content:016x}\nevent: change\ndata: {}\n\n", version.number)?;
                }
                None => output.write_all(b": nothing new\n\n")?,
            }
        }
    }

    /// The latest version, as soon as it holds something else than `content`; nothing where that takes too long.
    fn wait(&self, content: u64, time: Duration) -> Option<Version> {
        let is_same = |latest: &mut Version| latest.content == content;
        let waited = self.came.wait_timeout_while(self.latest(), time, is_same);
        let (latest, outcome) = waited.unwrap_or_else(PoisonError::into_inner);
        (!outcome.timed_out()).then_some(*latest)
    }

    fn latest(&self) -> MutexGuard<'_, Version> {
        self.latest.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use std::io::ErrorKind;

    use super::*;

    /// Takes what is written, up to a number of flushes.
    struct Limited {
        text: Vec<u8>,
        flushes: usize,
    }

    impl Write for &mut Limited {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.text.write(bytes)
        }

        fn flush(&mut self) -> io::Result<()> {
            self.flushes = self.flushes.checked_sub(1).ok_or(ErrorKind::BrokenPipe)?;
            Ok(())
        }
    }

    fn streamed(changes: &Changes, last_event: Option<&str>, flushes: usize) -> String {
        let mut output = Limited { text: Vec::new(), flushes };
        changes.stream(last_event, &mut output).expect_err("the reader leaves");
        String::from_utf8(output.text).expect("text")
    }

    #[test]
    fn a_page_that_comes_again_is_told_what_it_has_missed() {
        let changes = Changes::new(0xa);
        changes.tell(0xb);
        changes.tell(0xc);
        let told = "id: 000000000000000a\n\nid: 000000000000000c\nevent: change\ndata: 2\n\n";
        assert_eq!(streamed(&changes, Some("000000000000000a"), 1), told);
        for last_event in [None, Some("c"), Some("no number")] {
            assert_eq!(streamed(&changes, last_event, 0), "id: 000000000000000c\n\n", "{last_event:?}");
        }
    }

    #[test]
    fn only_other_content_is_waited_for() {
        let changes = Changes::new(1);
        assert_eq!(changes.wait(1, Duration::from_millis(1)), None);
        changes.tell(2);
        assert_eq!(changes.wait(1, Duration::ZERO), Some(Version { number: 1, content: 2 }));
        assert_eq!(changes.wait(2, Duration::from_millis(1)), None);
    }
}
