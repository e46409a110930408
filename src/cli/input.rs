//! Input files: what kind they are, and their bytes.

use std::fs;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use planecut::import::mesh::MeshFormat;
use planecut::import::model::MAX_TEXT;

use super::error::CliError;

/// An input that makes a solid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ModelKind {
    /// The native model file.
    Json,
    /// A Quake-family map.
    Map,
    /// An evaluated tree of OpenSCAD.
    Csg,
}

impl ModelKind {
    /// The name of the format, for reports.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Json => "json",
            Self::Map => "map",
            Self::Csg => "csg",
        }
    }
}

/// What a command can read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// A tree of brushes.
    Model(ModelKind),
    /// A triangle mesh.
    Mesh(MeshFormat),
}

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
}

impl Input {
    /// The input, and what `accept` makes of its kind; looks at the name alone. `stated` is the kind where the arguments
    /// say it.
    ///
    /// # Errors
    /// [`CliError::Ending`], which says `expected`, where the ending is that of no kind that is accepted.
    pub(crate) fn resolve<T>(
        path: &Path,
        stated: Option<ModelKind>,
        accept: impl FnOnce(Kind) -> Option<T>,
        expected: &'static str,
    ) -> Result<(Self, T), CliError> {
        let source = if path == Path::new("-") { Source::Stdin } else { Source::File };
        let of_name = || match source {
            Source::File => kind_of(path),
            Source::Stdin => Some(Kind::Model(ModelKind::Json)),
        };
        match stated.map(Kind::Model).or_else(of_name).and_then(accept) {
            Some(kind) => {
                let path = if source == Source::Stdin { PathBuf::from("standard input") } else { path.to_owned() };
                Ok((Self { path, source }, kind))
            }
            None => Err(CliError::Ending { path: path.to_owned(), expected }),
        }
    }

    /// A model or a map, for the commands that need brushes.
    ///
    /// # Errors
    /// [`CliError::Ending`] where it is neither by its name.
    pub(crate) fn resolve_model(path: &Path, stated: Option<ModelKind>) -> Result<(Self, ModelKind), CliError> {
        let model = |kind| match kind {
            Kind::Model(kind) => Some(kind),
            Kind::Mesh(_) => None,
        };
        Self::resolve(path, stated, model, "`.json`, `.map` or `.csg`, the inputs that this version builds from")
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
    /// [`CliError::Read`] where there is no such file, or it is a folder, or closed to us.
    pub(crate) fn read(&self) -> Result<Vec<u8>, CliError> {
        let bytes = match self.source {
            Source::File => fs::read(&self.path),
            Source::Stdin => read_stdin(),
        };
        bytes.map_err(|source| CliError::Read { path: self.path.clone(), source })
    }
}

/// Standard input to its end, or just past the length that readers refuse.
fn read_stdin() -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    io::stdin().lock().take(MAX_TEXT as u64 + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

fn kind_of(path: &Path) -> Option<Kind> {
    let ending = path.extension()?.to_str()?;
    let model = ModelKind::value_variants().iter().copied().find(|kind| kind.name().eq_ignore_ascii_case(ending));
    match model {
        Some(kind) => Some(Kind::Model(kind)),
        None => MeshFormat::from_extension(ending).map(Kind::Mesh),
    }
}
