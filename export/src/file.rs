//! Files that appear under their names only when complete.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process;
use std::sync::atomic::{AtomicU32, Ordering};

use crate::ExportError;

/// Writes `bytes` to `path`, completely or not at all.
///
/// The bytes go to a temporary file in the same folder, which is then renamed. An existing file keeps its permissions; a
/// symbolic link stays and its target is replaced. Pipes and devices cannot be replaced and are written directly. The
/// rename guards against errors and killed processes, not against power loss.
///
/// # Errors
/// [`ExportError::Write`] names the file when it is a folder or write-protected, its folder is missing or closed to us,
/// or the disk is full. The temporary file is gone by then, and an older file under the name is untouched.
pub fn write_atomic(path: impl AsRef<Path>, bytes: &[u8]) -> Result<(), ExportError> {
    let path = path.as_ref();
    write_with(path, |file| file.write_all(bytes))
        .map_err(|source| ExportError::Write { path: path.to_owned(), source })
}

fn write_with(path: &Path, write: impl FnOnce(&mut File) -> io::Result<()>) -> io::Result<()> {
    let existing = match fs::metadata(path) {
        Ok(metadata) => Some(metadata),
        Err(error) if error.kind() == io::ErrorKind::NotFound => None,
        Err(error) => return Err(error),
    };
    match existing {
        None => replace(path, None, write),
        Some(metadata) if metadata.is_dir() => Err(io::ErrorKind::IsADirectory.into()),
        Some(metadata) if !metadata.is_file() => write(&mut OpenOptions::new().write(true).open(path)?),
        Some(metadata) if metadata.permissions().readonly() => Err(io::ErrorKind::PermissionDenied.into()),
        Some(metadata) => replace(&fs::canonicalize(path)?, Some(metadata.permissions()), write),
    }
}

fn replace(
    target: &Path,
    permissions: Option<fs::Permissions>,
    write: impl FnOnce(&mut File) -> io::Result<()>,
) -> io::Result<()> {
    let (mut file, temporary) = Temporary::beside(target)?;
    write(&mut file)?;
    if let Some(permissions) = permissions {
        file.set_permissions(permissions)?;
    }
    // Closed before the rename: some systems do not rename open files.
    drop(file);
    temporary.rename(target)
}

/// A file that is removed again unless it is renamed.
struct Temporary {
    path: PathBuf,
    renamed: bool,
}

impl Temporary {
    /// Creates a new file in the folder of `target`, hidden and named after it.
    fn beside(target: &Path) -> io::Result<(File, Self)> {
        static COUNTER: AtomicU32 = AtomicU32::new(0);
        let name = target.file_name().ok_or(io::ErrorKind::InvalidFilename)?;
        loop {
            // A fixed-length name: the target's own may be as long as the file system allows.
            let number = COUNTER.fetch_add(1, Ordering::Relaxed);
            let path = target.with_file_name(format!(".planecut-{}-{number}.tmp", process::id()));
            debug_assert_ne!(path.file_name(), Some(name));
            match OpenOptions::new().write(true).create_new(true).open(&path) {
                Ok(file) => return Ok((file, Self { path, renamed: false })),
                // Left by a killed process that had our number: never overwrite, take the next.
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
            }
        }
    }

    fn rename(mut self, target: &Path) -> io::Result<()> {
        fs::rename(&self.path, target)?;
        self.renamed = true;
        Ok(())
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        if !self.renamed {
            // Nothing more can be done about a failure here; the first error is the one to report.
            let _ = fs::remove_file(&self.path);
        }
    }
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

    #[test]
    fn a_write_that_fails_half_way_leaves_the_old_file_alone() {
        let folder = tempfile::tempdir().expect("folder");
        let path = folder.path().join("out.stl");
        write_atomic(&path, b"old").expect("written");
        let result = write_with(&path, |file| {
            file.write_all(b"ne")?;
            Err(io::ErrorKind::StorageFull.into())
        });
        assert_eq!(result.expect_err("full").kind(), io::ErrorKind::StorageFull);
        assert_eq!(fs::read(&path).expect("readable"), b"old");
        assert_eq!(names(folder.path()), ["out.stl"]);
    }

    #[test]
    fn an_older_file_is_replaced() {
        let folder = tempfile::tempdir().expect("folder");
        let path = folder.path().join("out.stl");
        for bytes in [&b"a longer first text"[..], b"second"] {
            write_atomic(&path, bytes).expect("written");
            assert_eq!(fs::read(&path).expect("readable"), bytes);
        }
        assert_eq!(names(folder.path()), ["out.stl"]);
    }

    #[test]
    fn a_folder_or_a_missing_folder_is_an_error_that_names_the_file() {
        let folder = tempfile::tempdir().expect("folder");
        let inside = folder.path().join("sub");
        fs::create_dir(&inside).expect("made");
        for path in [inside.clone(), folder.path().join("none/out.glb"), inside.join("..")] {
            let message = write_atomic(&path, b"x").expect_err("refused").to_string();
            assert!(message.contains(&path.display().to_string()) && !message.contains('\n'), "{message}");
        }
        assert_eq!(names(folder.path()), ["sub"]);
        assert!(names(&inside).is_empty());
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_a_link_and_permissions_stay() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().expect("folder");
        let (real, link) = (folder.path().join("real.obj"), folder.path().join("link.obj"));
        fs::write(&real, "old").expect("written");
        fs::set_permissions(&real, fs::Permissions::from_mode(0o640)).expect("set");
        symlink(&real, &link).expect("linked");
        write_atomic(&link, b"new").expect("written");
        assert_eq!(fs::read(&real).expect("readable"), b"new");
        assert!(fs::symlink_metadata(&link).expect("there").is_symlink());
        assert_eq!(fs::metadata(&real).expect("there").permissions().mode() & 0o777, 0o640);
        fs::set_permissions(&real, fs::Permissions::from_mode(0o440)).expect("set");
        assert!(write_atomic(&link, b"newer").is_err(), "write-protected");
        assert_eq!(names(folder.path()), ["link.obj", "real.obj"]);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn devices_are_written_directly() {
        use std::os::unix::fs::FileTypeExt;
        let is_device = |path: &str| fs::metadata(path).is_ok_and(|m| m.file_type().is_char_device());
        if !(is_device("/dev/full") && is_device("/dev/null")) {
            return;
        }
        write_atomic("/dev/null", b"x").expect("swallowed");
        let message = write_atomic("/dev/full", b"x").expect_err("full").to_string();
        assert!(message.starts_with("cannot write /dev/full: "), "{message}");
        assert!(is_device("/dev/full") && is_device("/dev/null"));
    }
}
