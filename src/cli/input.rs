//! Input files: what kind they are, and their bytes.

use std::fs::{self, File};
use std::io::{self, ErrorKind, Read};
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use clap::builder::PossibleValue;
use planecut::import::file::{MAX_MESH, open_stream, read_file, read_stream};
use planecut::import::mesh::MeshFormat;
use planecut::import::model::MAX_TEXT;
use planecut::reading::FileKind;

use super::error::CliError;

impl ValueEnum for FileKind {
    fn value_variants<'a>() -> &'a [Self] {
        use MeshFormat::{Gltf, Obj, Ply, Stl};
        &[Self::Model, Self::Map, Self::Scad, Self::Mesh(Obj), Self::Mesh(Stl), Self::Mesh(Ply), Self::Mesh(Gltf)]
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let help = match self {
            Self::Model => "The native model file",
            Self::Map => "A Quake-family map",
            Self::Scad => "An evaluated tree of OpenSCAD",
            Self::Mesh(_) => "A closed mesh",
        };
        Some(PossibleValue::new(self.name()).help(help))
    }
}

/// The endings of all inputs.
const EXPECTED: &str = "`.json`, `.map`, `.csg`, `.obj`, `.stl`, `.ply`, `.glb` or `.gltf`";

/// Where an input is.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Source {
    File,
    /// Standard input, written `-`.
    Stdin,
}

/// Something to read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Input {
    /// The path as it was given, or a name for standard input.
    pub(crate) path: PathBuf,
    source: Source,
    /// Most bytes that are read of a regular file.
    limit: u64,
}

impl Input {
    /// The input, and what `accept` makes of its kind; looks at the name alone. `stated` is the kind where the arguments
    /// say it.
    ///
    /// # Errors
    /// [`CliError::Ending`], which says `expected`, where the ending is that of no kind that is accepted.
    pub(crate) fn resolve<T>(
        path: &Path,
        stated: Option<FileKind>,
        accept: impl FnOnce(FileKind) -> Option<T>,
        expected: &'static str,
    ) -> Result<(Self, T), CliError> {
        let source = if path == Path::new("-") { Source::Stdin } else { Source::File };
        let of_name = || match source {
            Source::File => kind_of(path),
            Source::Stdin => Some(FileKind::Model),
        };
        let kind = stated.or_else(of_name);
        match kind.and_then(|kind| Some((kind, accept(kind)?))) {
            Some((kind_read, kind)) => {
                let path = if source == Source::Stdin { PathBuf::from("standard input") } else { path.to_owned() };
                Ok((Self { path, source, limit: limit_of(kind_read) }, kind))
            }
            None => Err(CliError::Ending { path: path.to_owned(), expected }),
        }
    }

    /// A text on standard input.
    pub(crate) fn stdin() -> Self {
        Self { path: PathBuf::from("standard input"), source: Source::Stdin, limit: MAX_TEXT as u64 }
    }

    /// A text of any kind.
    pub(crate) fn plain(path: &Path) -> Self {
        Self { path: path.to_owned(), source: Source::File, limit: MAX_TEXT as u64 }
    }

    /// Any input.
    ///
    /// # Errors
    /// [`CliError::Ending`] where it is none by its name.
    pub(crate) fn resolve_any(path: &Path, stated: Option<FileKind>) -> Result<(Self, FileKind), CliError> {
        Self::resolve(path, stated, Some, EXPECTED)
    }

    /// The path for messages.
    pub(crate) fn name(&self) -> String {
        self.path.display().to_string()
    }

    /// The path as it was given, for reports.
    pub(crate) fn given(&self) -> String {
        match self.source {
            Source::File => self.name(),
            Source::Stdin => "-".to_owned(),
        }
    }

    /// The file, where it is one.
    pub(crate) fn file(&self) -> Option<&Path> {
        (self.source == Source::File).then_some(&self.path)
    }

    /// The content.
    ///
    /// # Errors
    /// [`CliError::Read`] where there is no such file, or it is a folder, or closed to us; [`CliError::TooLong`] where it has no end, or one too far.
    pub(crate) fn read(&self) -> Result<Vec<u8>, CliError> {
        let bytes = match self.source {
            Source::File => read_file(&self.path, self.limit),
            Source::Stdin => read_stream(io::stdin().lock(), MAX_TEXT as u64),
        };
        bytes.map_err(|source| self.failed(source))
    }

    /// The content, to be read piece by piece, of any length.
    ///
    /// # Errors
    /// [`CliError::Read`].
    pub(crate) fn stream(&self) -> Result<Box<dyn Read + Send>, CliError> {
        match self.source {
            Source::File => Ok(Box::new(open_stream(&self.path).map_err(|source| self.failed(source))?)),
            Source::Stdin => Ok(Box::new(io::stdin())),
        }
    }

    /// The file and its length, for what passes it on as it is. It must be a regular one, which can be read more than once.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub(crate) fn open(&self) -> Result<(File, u64), CliError> {
        open_file(&self.path, self.limit).map_err(|source| self.failed(source))
    }

    fn failed(&self, source: io::Error) -> CliError {
        match source.kind() {
            ErrorKind::FileTooLarge => CliError::TooLong { path: self.path.clone(), source },
            _ => CliError::Read { path: self.path.clone(), source },
        }
    }
}

fn open_file(path: &Path, limit: u64) -> io::Result<(File, u64)> {
    // asked before it is opened: a pipe is open only when another program is at its other end
    let metadata = fs::metadata(path)?;
    if metadata.is_dir() {
        return Err(ErrorKind::IsADirectory.into());
    }
    if !metadata.is_file() {
        return Err(io::Error::other("a device or a pipe"));
    }
    let file = File::open(path)?;
    let length = file.metadata()?.len();
    if length > limit {
        return Err(io::Error::new(ErrorKind::FileTooLarge, format!("more than {limit} bytes")));
    }
    Ok((file, length))
}

/// Most bytes of a regular file.
fn limit_of(kind: FileKind) -> u64 {
    match kind {
        FileKind::Mesh(_) => MAX_MESH,
        FileKind::Model | FileKind::Map | FileKind::Scad => MAX_TEXT as u64,
    }
}

fn kind_of(path: &Path) -> Option<FileKind> {
    FileKind::from_extension(path.extension()?.to_str()?)
}
