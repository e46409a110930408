//! Folders that appear under their names only when complete.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process;
use std::sync::atomic::{AtomicU32, Ordering};

use serde_json::Value;

use super::TilesError;
use super::document::{CONTENTS, GENERATOR, ROOT};

/// A folder that is written beside where it is to be. It is gone unless it is finished.
#[derive(Debug)]
pub(super) struct Building {
    temporary: PathBuf,
    target: PathBuf,
}

impl Building {
    /// Begins a folder.
    ///
    /// # Errors
    /// [`TilesError::Occupied`] where something else is there, [`TilesError::Write`].
    pub(super) fn begin(folder: &Path) -> Result<Self, TilesError> {
        let refused = |source| TilesError::Write { path: folder.to_owned(), source };
        let target = match fs::symlink_metadata(folder) {
            // a link stays, and what it leads to is replaced
            Ok(_) => fs::canonicalize(folder).map_err(refused)?,
            Err(error) if error.kind() == io::ErrorKind::NotFound => folder.to_owned(),
            Err(error) => return Err(refused(error)),
        };
        if target.file_name().is_none() {
            return Err(refused(io::ErrorKind::InvalidFilename.into()));
        }
        if target.exists() && !may_be_replaced(&target).map_err(refused)? {
            return Err(TilesError::Occupied { path: folder.to_owned() });
        }
        loop {
            let temporary = hidden_name(&target);
            match fs::create_dir(&temporary) {
                Ok(()) => return Ok(Self { temporary, target }),
                // left by a process that was killed
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(refused(error)),
            }
        }
    }

    /// Where to write.
    pub(super) fn path(&self) -> &Path {
        &self.temporary
    }

    /// Gives the folder its name, in place of what was there.
    ///
    /// # Errors
    /// [`TilesError::Write`]; what was there is there again.
    pub(super) fn finish(self) -> Result<(), TilesError> {
        let refused = |source| TilesError::Write { path: self.target.clone(), source };
        if !self.target.exists() {
            return fs::rename(&self.temporary, &self.target).map_err(refused);
        }
        let old = hidden_name(&self.target);
        fs::rename(&self.target, &old).map_err(refused)?;
        if let Err(error) = fs::rename(&self.temporary, &self.target) {
            fs::rename(&old, &self.target).map_err(refused)?;
            return Err(refused(error));
        }
        fs::remove_dir_all(&old).map_err(|source| TilesError::Write { path: old.clone(), source })
    }
}

impl Drop for Building {
    fn drop(&mut self) {
        // Nothing more can be done about a failure here; the first error is the one to report.
        let _ = fs::remove_dir_all(&self.temporary);
    }
}

/// A name beside the target.
fn hidden_name(target: &Path) -> PathBuf {
    static COUNTER: AtomicU32 = AtomicU32::new(0);
    let number = COUNTER.fetch_add(1, Ordering::Relaxed);
    target.with_file_name(format!(".planecut-tiles-{}-{number}.tmp", process::id()))
}

/// Whether it is an empty folder, or one with nothing but a tile set of ours.
fn may_be_replaced(folder: &Path) -> io::Result<bool> {
    if !folder.is_dir() {
        return Ok(false);
    }
    let mut is_empty = true;
    for entry in fs::read_dir(folder)? {
        is_empty = false;
        let name = entry?.file_name();
        if name != ROOT && name != CONTENTS {
            return Ok(false);
        }
    }
    if is_empty {
        return Ok(true);
    }
    let Ok(bytes) = fs::read(folder.join(ROOT)) else { return Ok(false) };
    let document: Value = serde_json::from_slice(&bytes).unwrap_or_default();
    Ok(document["asset"]["extras"]["generator"] == GENERATOR)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).expect("folder");
        let mut names: Vec<_> =
            entries.map(|entry| entry.expect("entry").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    fn write(folder: &Path, text: &str) -> Result<(), TilesError> {
        let building = Building::begin(folder)?;
        fs::write(
            building.path().join(ROOT),
            format!(r#"{{"asset": {{"extras": {{"generator": "planecut"}}}}, "text": "{text}"}}"#),
        )
        .expect("written");
        building.finish()
    }

    #[test]
    fn a_tile_set_of_ours_is_replaced_and_nothing_else() {
        let folder = tempfile::tempdir().expect("folder");
        let target = folder.path().join("tiles of a city");
        let text = || fs::read_to_string(target.join(ROOT)).expect("read");
        write(&target, "first").expect("new");
        write(&target, "second").expect("replaced");
        assert!(text().contains("second"));
        drop(Building::begin(&target).expect("begun"));
        assert!(text().contains("second"));
        fs::write(target.join("index.html"), "page").expect("written");
        let message = write(&target, "third").expect_err("refused").to_string();
        assert!(message.contains("tiles of a city which is no tile set"), "{message}");
        fs::remove_file(target.join("index.html")).expect("removed");
        fs::write(target.join(ROOT), r#"{"asset": {"version": "1.0"}}"#).expect("written");
        assert!(matches!(write(&target, "third"), Err(TilesError::Occupied { .. })));
        let file = folder.path().join("file");
        fs::write(&file, "text").expect("written");
        assert!(matches!(write(&file, "third"), Err(TilesError::Occupied { .. })));
        fs::create_dir(folder.path().join("empty")).expect("made");
        write(&folder.path().join("empty"), "text").expect("nothing is lost");
        assert!(matches!(write(&folder.path().join("no/where"), "text"), Err(TilesError::Write { .. })));
        assert_eq!(names(folder.path()), ["empty", "file", "tiles of a city"]);
    }
}
