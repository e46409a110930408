//! Files that appear under their names only when complete.
//!
//! The crate `atomic-write-file` (0.3) does the core of it, but replaces a symbolic link instead of its target, knows no pipes and devices, gives
//! up where a file without a name cannot be named later, makes temporary names that are too long beside a long one, and waits for the disk at
//! each commit. `tempfile` cannot give a name to a file without one.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Seek, Write};
use std::path::{Path, PathBuf};
use std::process;
use std::sync::atomic::{AtomicU32, Ordering};

use crate::ExportError;

/// Bytes that are handed to the system at once.
const BUFFER: usize = 1 << 16;

/// A file that appears under its name only when it is complete.
///
/// What is written goes to a temporary file in the same folder, on Linux one without a name, which [`AtomicFile::commit`] renames; until then, and when it is
/// dropped before, an older file under the name is untouched. An existing file keeps its permissions; a symbolic link stays and its
/// target is replaced. Pipes and devices cannot be replaced and are written directly. The rename guards against errors and killed
/// processes, not against power loss.
#[derive(Debug)]
pub struct AtomicFile {
    path: PathBuf,
    writer: BufWriter<File>,
    /// None for pipes and devices.
    replacing: Option<Replacing>,
}

/// What a complete file replaces.
#[derive(Debug)]
struct Replacing {
    temporary: Temporary,
    target: PathBuf,
    permissions: Option<fs::Permissions>,
}

impl AtomicFile {
    /// Begins a file.
    ///
    /// # Errors
    /// [`ExportError::Write`] names the file when it is a folder or write-protected, or its folder is missing or closed to us.
    pub fn create(path: impl AsRef<Path>) -> Result<Self, ExportError> {
        let path = path.as_ref().to_owned();
        match begin(&path) {
            Ok((file, replacing)) => Ok(Self { writer: BufWriter::with_capacity(BUFFER, file), path, replacing }),
            Err(source) => Err(ExportError::Write { path, source }),
        }
    }

    /// Ends the file and gives it its name.
    ///
    /// # Errors
    /// [`ExportError::Write`] names the file when the disk is full. The temporary file is gone by then.
    pub fn commit(self) -> Result<(), ExportError> {
        let Self { path, writer, replacing } = self;
        end(writer, replacing).map_err(|source| ExportError::Write { path, source })
    }

    /// The name that the file will have.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }
}

impl Write for AtomicFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.writer.write(bytes)
    }

    fn write_all(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.writer.write_all(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.flush()
    }
}

/// Writes `bytes` to `path`, completely or not at all: see [`AtomicFile`].
///
/// # Errors
/// [`ExportError::Write`] names the file when it is a folder or write-protected, its folder is missing or closed to us,
/// or the disk is full. The temporary file is gone by then, and an older file under the name is untouched.
pub fn write_atomic(path: impl AsRef<Path>, bytes: &[u8]) -> Result<(), ExportError> {
    let mut file = AtomicFile::create(path)?;
    match file.write_all(bytes) {
        Ok(()) => file.commit(),
        Err(source) => Err(ExportError::Write { path: file.path, source }),
    }
}

fn begin(path: &Path) -> io::Result<(File, Option<Replacing>)> {
    let existing = match fs::metadata(path) {
        Ok(metadata) => Some(metadata),
        Err(error) if error.kind() == io::ErrorKind::NotFound => None,
        Err(error) => return Err(error),
    };
    let (target, permissions) = match existing {
        None => (path.to_owned(), None),
        Some(metadata) if metadata.is_dir() => return Err(io::ErrorKind::IsADirectory.into()),
        Some(metadata) if !metadata.is_file() => return Ok((OpenOptions::new().write(true).open(path)?, None)),
        Some(metadata) if metadata.permissions().readonly() => return Err(io::ErrorKind::PermissionDenied.into()),
        Some(metadata) => (fs::canonicalize(path)?, Some(metadata.permissions())),
    };
    let (file, temporary) = Temporary::beside(&target)?;
    Ok((file, Some(Replacing { temporary, target, permissions })))
}

fn end(writer: BufWriter<File>, replacing: Option<Replacing>) -> io::Result<()> {
    let file = writer.into_inner().map_err(io::IntoInnerError::into_error)?;
    let Some(Replacing { temporary, target, permissions }) = replacing else { return Ok(()) };
    if let Some(permissions) = permissions {
        file.set_permissions(permissions)?;
    }
    temporary.rename(file, &target)
}

/// A file that is gone unless it is renamed: one without a name where the system has such, which not even a killed process leaves behind.
#[derive(Debug)]
struct Temporary {
    path: PathBuf,
    is_named: bool,
}

impl Temporary {
    /// Creates a new file in the folder of `target`.
    fn beside(target: &Path) -> io::Result<(File, Self)> {
        let name = target.file_name().ok_or(io::ErrorKind::InvalidFilename)?;
        let path = hidden_name(target);
        debug_assert_ne!(path.file_name(), Some(name));
        if let Some(file) = unnamed::file_beside(target) {
            return Ok((file, Self { path, is_named: false }));
        }
        let (file, path) = Self::named(target)?;
        Ok((file, Self { path, is_named: true }))
    }

    /// A new file with a hidden name.
    fn named(target: &Path) -> io::Result<(File, PathBuf)> {
        loop {
            let path = hidden_name(target);
            match OpenOptions::new().write(true).create_new(true).open(&path) {
                Ok(file) => return Ok((file, path)),
                // Left by a killed process that had our number: never overwrite, take the next.
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
            }
        }
    }

    /// Gives the file, which is complete, the name of `target`.
    fn rename(mut self, file: File, target: &Path) -> io::Result<()> {
        while !self.is_named {
            match unnamed::name(&file, &self.path) {
                Ok(()) => self.is_named = true,
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => self.path = hidden_name(target),
                Err(_) => self.copy(&file, target)?,
            }
        }
        // Closed before the rename: some systems do not rename open files.
        drop(file);
        fs::rename(&self.path, target)?;
        self.is_named = false;
        Ok(())
    }

    /// Copies a file without a name to one that has one.
    fn copy(&mut self, mut file: &File, target: &Path) -> io::Result<()> {
        let (mut named, path) = Self::named(target)?;
        (self.path, self.is_named) = (path, true);
        file.rewind()?;
        io::copy(&mut file, &mut named)?;
        named.set_permissions(file.metadata()?.permissions())
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        if self.is_named {
            // Nothing more can be done about a failure here; the first error is the one to report.
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// A name in the folder of `target`, of a fixed length: the target's own may be as long as the file system allows.
fn hidden_name(target: &Path) -> PathBuf {
    static COUNTER: AtomicU32 = AtomicU32::new(0);
    let number = COUNTER.fetch_add(1, Ordering::Relaxed);
    target.with_file_name(format!(".planecut-{}-{number}.tmp", process::id()))
}

/// Files without names.
#[cfg(target_os = "linux")]
mod unnamed {
    use std::fs::File;
    use std::io;
    use std::os::fd::AsRawFd;
    use std::path::Path;

    use rustix::fs::{AtFlags, CWD, Mode, OFlags, linkat, open};

    /// Where open files have names.
    const OPEN_FILES: &str = "/proc/self/fd";

    /// A new file in the folder of another; `None` where the file system has no files without names.
    pub(super) fn file_beside(target: &Path) -> Option<File> {
        let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        if !Path::new(OPEN_FILES).exists() {
            return None;
        }
        let file = open(folder, OFlags::TMPFILE | OFlags::RDWR | OFlags::CLOEXEC, Mode::from_raw_mode(0o666)).ok()?;
        Some(File::from(file))
    }

    /// Names a file that has no name.
    pub(super) fn name(file: &File, path: &Path) -> io::Result<()> {
        let open_file = format!("{OPEN_FILES}/{}", file.as_raw_fd());
        Ok(linkat(CWD, open_file, CWD, path, AtFlags::SYMLINK_FOLLOW)?)
    }
}

/// Files without names: there are none here.
#[cfg(not(target_os = "linux"))]
mod unnamed {
    use std::fs::File;
    use std::io;
    use std::path::Path;

    pub(super) fn file_beside(_: &Path) -> Option<File> {
        None
    }

    pub(super) fn name(_: &File, _: &Path) -> io::Result<()> {
        Err(io::ErrorKind::Unsupported.into())
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
        let mut file = AtomicFile::create(&path).expect("begun");
        file.write_all(b"ne").expect("written");
        file.flush().expect("written");
        drop(file);
        assert_eq!(fs::read(&path).expect("readable"), b"old");
        assert_eq!(names(folder.path()), ["out.stl"]);
    }

    #[test]
    fn a_copy_takes_the_place_of_a_name_that_cannot_be_given() {
        let folder = tempfile::tempdir().expect("folder");
        let path = folder.path().join("out.stl");
        let (mut file, mut temporary) = Temporary::beside(&path).expect("begun");
        if temporary.is_named {
            // no files without names here
            return;
        }
        file.write_all(b"bytes").expect("written");
        assert!(names(folder.path()).is_empty());
        temporary.copy(&file, &path).expect("copied");
        assert_eq!(names(folder.path()).len(), 1);
        temporary.rename(file, &path).expect("renamed");
        assert_eq!(fs::read(&path).expect("readable"), b"bytes");
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
