//! Lines for people, and bytes for standard output.

use std::io::{self, ErrorKind, Write};
use std::sync::{Mutex, PoisonError};

use planecut::import::Warning;

use super::error::CliError;

/// What would have been printed.
#[derive(Debug, Default)]
pub(crate) struct Captured {
    /// What was for standard output.
    pub(crate) text: String,
    /// Warnings and errors, without what says that they are one.
    pub(crate) lines: Vec<String>,
}

/// What is printed while somebody captures it.
static CAPTURED: Mutex<Option<Captured>> = Mutex::new(None);

/// From now on nothing is printed, but kept: of a process that answers somebody else.
pub(crate) fn begin_capture() {
    *CAPTURED.lock().unwrap_or_else(PoisonError::into_inner) = Some(Captured::default());
}

/// Ends what [`begin_capture`] began.
pub(crate) fn end_capture() -> Captured {
    CAPTURED.lock().unwrap_or_else(PoisonError::into_inner).take().unwrap_or_default()
}

/// Whether something is captured; then `keep` is given it.
fn is_captured(keep: impl FnOnce(&mut Captured)) -> bool {
    CAPTURED.lock().unwrap_or_else(PoisonError::into_inner).as_mut().map(keep).is_some()
}

/// Prints one line that starts with `error:`.
pub(crate) fn print_error(message: &str) {
    print_line("error", message);
}

/// Prints one line that starts with `warning:`.
pub(crate) fn print_warning(message: &str) {
    print_line("warning", message);
}

/// Prints one line for each warning, that starts with `warning:` and names the file `name`.
pub(crate) fn print_warnings(name: &str, warnings: &[Warning]) {
    for Warning { line, message, .. } in warnings {
        let line = if *line > 0 { format!(":{line}") } else { String::new() };
        print_warning(&format!("{name}{line}: {message}"));
    }
}

fn print_line(kind: &str, message: &str) {
    if is_captured(|captured| captured.lines.push(in_one_line(message))) {
        return;
    }
    // Nobody is left to tell where standard error is closed.
    let _ = writeln!(io::stderr().lock(), "{kind}: {}", in_one_line(message));
}

/// The message without what would break the line or command the terminal: file names may hold anything.
pub(crate) fn in_one_line(message: &str) -> String {
    let shown = |c: char| match c {
        c if c.is_whitespace() => ' ',
        c if c.is_control() => char::REPLACEMENT_CHARACTER,
        c => c,
    };
    message.trim_end().chars().map(shown).collect()
}

/// Prints text to standard output. A reader that has seen enough (`| head`) is no error.
///
/// # Errors
/// [`CliError::Stdout`] where it cannot be written for another reason.
pub(crate) fn print_text(text: &str) -> Result<(), CliError> {
    match print_bytes(text.as_bytes()) {
        Err(CliError::Stdout(error)) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        result => result,
    }
}

/// Writes bytes to standard output.
///
/// # Errors
/// [`CliError::Stdout`] where not all of them could be written.
pub(crate) fn print_bytes(bytes: &[u8]) -> Result<(), CliError> {
    if is_captured(|captured| captured.text.push_str(&String::from_utf8_lossy(bytes))) {
        return Ok(());
    }
    let mut stdout = io::stdout().lock();
    stdout.write_all(bytes).and_then(|()| stdout.flush()).map_err(CliError::Stdout)
}

#[cfg(test)]
mod tests {
    use super::in_one_line;

    #[test]
    fn a_message_never_breaks_the_line() {
        assert_eq!(in_one_line("a\nb\r\n\x1b[31mc\t\u{2028}d\n"), "a b  \u{fffd}[31mc  d");
    }
}
