//! Whether a file has changed, asked again and again: by its time, its length and its place on the disk, and where one of these is another, by its bytes.
//!
//! Asking works on every file system, those of a network included, and sees what editors do that write a new file and give it the name of the old one.

use std::fs;
use std::hash::{DefaultHasher, Hasher};
use std::io::{self, ErrorKind, Read};
use std::time::SystemTime;

use crate::cli::error::CliError;
use crate::cli::input::Input;

/// Bytes that are read at once.
const CHUNK: u64 = 1 << 20;

/// A file that may change.
#[derive(Debug)]
pub(super) struct Watch {
    input: Input,
    known: Look,
    content: u64,
    /// What was seen last, where it is not what is known.
    seen: Option<Look>,
}

/// What tells two versions of a file apart without reading them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Look {
    modified: Option<SystemTime>,
    length: u64,
    /// Its number on the disk, where files have one.
    number: u64,
}

impl Watch {
    /// A file as it is now.
    ///
    /// # Errors
    /// Those of reading it.
    pub(super) fn new(input: &Input) -> Result<Self, CliError> {
        let failed = |source| CliError::Read { path: input.path.clone(), source };
        let known = Look::at(input).map_err(failed)?;
        Ok(Self { input: input.clone(), known, content: fingerprint(input)?, seen: None })
    }

    /// A number that stands for what the file holds, as far as is known: equal for equal bytes.
    pub(super) fn content(&self) -> u64 {
        self.content
    }

    /// Looks again, and tells whether the file holds something else. While it is written to, or has no name for a moment, it is what it was.
    pub(super) fn look(&mut self) -> bool {
        let before = self.seen.take();
        let Ok(look) = Look::at(&self.input) else { return false };
        if look == self.known {
            return false;
        }
        self.seen = Some(look);
        if before != self.seen {
            return false;
        }
        let Ok(content) = fingerprint(&self.input) else { return false };
        if Look::at(&self.input).ok() != self.seen {
            return false;
        }
        self.seen = None;
        self.known = look;
        let is_other = content != self.content;
        self.content = content;
        is_other
    }
}

impl Look {
    fn at(input: &Input) -> io::Result<Self> {
        let metadata = fs::metadata(&input.path)?;
        if !metadata.is_file() {
            return Err(ErrorKind::NotFound.into());
        }
        #[cfg(unix)]
        let number = std::os::unix::fs::MetadataExt::ino(&metadata);
        #[cfg(not(unix))]
        let number = 0;
        Ok(Self { modified: metadata.modified().ok(), length: metadata.len(), number })
    }
}

/// A number for the bytes of a file.
fn fingerprint(input: &Input) -> Result<u64, CliError> {
    let (file, length) = input.open()?;
    let mut file = file.take(length);
    let (mut hasher, mut chunk) = (DefaultHasher::new(), Vec::new());
    loop {
        chunk.clear();
        let read = file.by_ref().take(CHUNK).read_to_end(&mut chunk);
        match read.map_err(|source| CliError::Read { path: input.path.clone(), source })? {
            0 => return Ok(hasher.finish()),
            _ => hasher.write(&chunk),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::fs::File;
    use std::path::Path;
    use std::time::Duration;

    use super::*;

    /// A file that is watched, and the time of its first version.
    fn watched(folder: &Path) -> (Watch, SystemTime) {
        let path = folder.join("a.json");
        fs::write(&path, "one").expect("written");
        let (input, _) = Input::resolve_any(&path, None).expect("an input");
        let begin = fs::metadata(&path).and_then(|metadata| metadata.modified()).expect("a time");
        (Watch::new(&input).expect("a file"), begin)
    }

    fn write(path: &Path, text: &str, time: SystemTime) {
        fs::write(path, text).expect("written");
        File::options().write(true).open(path).and_then(|file| file.set_modified(time)).expect("a time");
    }

    #[test]
    fn a_change_is_told_once_and_not_before_the_file_stands_still() {
        let folder = tempfile::tempdir().expect("a folder");
        let (mut watch, begin) = watched(folder.path());
        let path = folder.path().join("a.json");
        assert!(!watch.look() && !watch.look());
        write(&path, "", begin + Duration::from_secs(1));
        assert!(!watch.look());
        write(&path, "two", begin + Duration::from_secs(2));
        assert!(!watch.look());
        let before = watch.content();
        assert!(watch.look());
        assert_ne!(watch.content(), before);
        assert!(!watch.look() && !watch.look());
    }

    #[test]
    fn the_same_bytes_at_another_time_are_no_change() {
        let folder = tempfile::tempdir().expect("a folder");
        let (mut watch, begin) = watched(folder.path());
        write(&folder.path().join("a.json"), "one", begin + Duration::from_secs(1));
        assert!(!watch.look() && !watch.look() && !watch.look());
    }

    #[cfg(unix)]
    #[test]
    fn another_file_of_the_same_name_length_and_time_is_a_change() {
        let folder = tempfile::tempdir().expect("a folder");
        let (mut watch, begin) = watched(folder.path());
        let (path, other) = (folder.path().join("a.json"), folder.path().join("b.json"));
        write(&other, "two", begin);
        fs::rename(&other, &path).expect("renamed");
        assert!(!watch.look() && watch.look());
    }

    #[test]
    fn a_file_that_is_gone_for_a_while_is_what_it_was() {
        let folder = tempfile::tempdir().expect("a folder");
        let (mut watch, begin) = watched(folder.path());
        let path = folder.path().join("a.json");
        fs::remove_file(&path).expect("removed");
        assert!(!watch.look() && !watch.look());
        fs::create_dir(&path).expect("a folder");
        assert!(!watch.look() && !watch.look());
        fs::remove_dir(&path).expect("removed");
        write(&path, "one", begin);
        assert!(!watch.look() && !watch.look());
        fs::remove_file(&path).expect("removed");
        assert!(!watch.look());
        write(&path, "three", begin);
        assert!(!watch.look() && watch.look());
    }
}
