//! The file that is shown: its name in addresses, and what it holds at the moment.

use std::ffi::OsStr;
use std::fs::File;

use percent_encoding::{AsciiSet, CONTROLS, NON_ALPHANUMERIC, percent_encode, utf8_percent_encode};

use crate::cli::error::CliError;
use crate::cli::input::Input;
use crate::cli::terminal::in_one_line;

/// Where it is on the server.
const FOLDER: &str = "/file/";

/// What has a meaning of its own in the path of an address, or is lost in one.
const SPECIAL_IN_PATH: &AsciiSet = &CONTROLS.add(b'%').add(b'#').add(b'?').add(b'\\');
/// All but what stands for itself in a query.
const SPECIAL_IN_QUERY: &AsciiSet = &NON_ALPHANUMERIC.remove(b'-').remove(b'.').remove(b'_').remove(b'~').remove(b'/');

/// A file that is served under its name.
#[derive(Debug)]
pub(super) struct ServedFile {
    input: Input,
    name: String,
    path: Vec<u8>,
    in_query: String,
}

impl ServedFile {
    /// An input that is a file and can be read.
    ///
    /// # Errors
    /// [`CliError::Usage`] for standard input, and as [`Input::open`].
    pub(super) fn new(input: Input) -> Result<Self, CliError> {
        let Some(file) = input.file() else {
            let found = "found the input on standard input, expected a file";
            return Err(CliError::Usage(format!("{found}: it is read again when it changes")));
        };
        let name = file.file_name().unwrap_or_default();
        let path = [FOLDER.as_bytes(), name.as_encoded_bytes()].concat();
        let (in_query, name) = (in_query(name), in_one_line(&name.display().to_string()));
        input.open()?;
        Ok(Self { input, name, path, in_query })
    }

    /// Its name for people.
    pub(super) fn name(&self) -> &str {
        &self.name
    }

    /// The input that it is.
    pub(super) fn input(&self) -> &Input {
        &self.input
    }

    /// Its path in requests, decoded.
    pub(super) fn path(&self) -> &[u8] {
        &self.path
    }

    /// Its address as a value in a query.
    pub(super) fn in_query(&self) -> &str {
        &self.in_query
    }

    /// What it holds now, and how many bytes that are.
    ///
    /// # Errors
    /// As [`Input::open`].
    pub(super) fn open(&self) -> Result<(File, u64), CliError> {
        self.input.open()
    }
}

/// The address of a file as a value in a query. The page decodes the value and takes it for an address, so what is special in addresses is encoded twice; spaces and
/// letters of any language are not.
fn in_query(name: &OsStr) -> String {
    let name = match name.to_str() {
        Some(text) => text.chars().map(in_path).collect(),
        None => percent_encode(name.as_encoded_bytes(), SPECIAL_IN_PATH).to_string(),
    };
    utf8_percent_encode(&format!("{FOLDER}{name}"), SPECIAL_IN_QUERY).to_string()
}

fn in_path(letter: char) -> String {
    let text = letter.to_string();
    if letter.is_ascii() { utf8_percent_encode(&text, SPECIAL_IN_PATH).to_string() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_encoded_once_and_what_is_special_in_addresses_twice() {
        for (name, expected) in [
            ("plate-1_a.json", "/file/plate-1_a.json"),
            ("a b.json", "/file/a%20b.json"),
            ("ä+b&c=d.map", "/file/%C3%A4%2Bb%26c%3Dd.map"),
            ("100%.obj", "/file/100%2525.obj"),
            ("a#1?.stl", "/file/a%25231%253F.stl"),
            ("a\n.stl", "/file/a%250A.stl"),
        ] {
            assert_eq!(in_query(OsStr::new(name)), expected);
        }
    }

    #[cfg(unix)]
    #[test]
    fn names_that_are_no_text_have_addresses() {
        use std::os::unix::ffi::OsStrExt;
        assert_eq!(in_query(OsStr::from_bytes(b"\xff.obj")), "/file/%25FF.obj");
    }
}
