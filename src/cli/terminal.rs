//! Lines for people, and bytes for standard output.

use std::io::{self, ErrorKind, Write};

use planecut::import::Warning;

use super::error::CliError;

/// Prints one line that starts with `error:`.
pub(crate) fn print_error(message: &str) {
    print_line("error", message);
}

/// Prints one line for each warning, that starts with `warning:` and names the file `name`.
pub(crate) fn print_warnings(name: &str, warnings: &[Warning]) {
    for Warning { line, message, .. } in warnings {
        let line = if *line > 0 { format!(":{line}") } else { String::new() };
        print_line("warning", &format!("{name}{line}: {message}"));
    }
}

fn print_line(kind: &str, message: &str) {
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
