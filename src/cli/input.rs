//! Input files: what kind they are, and their bytes.

use std::fs;
use std::path::{Path, PathBuf};

use planecut::import::mesh::MeshFormat;

use super::error::CliError;

/// What a command can read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// A Quake-family map.
    Map,
    /// A triangle mesh.
    Mesh(MeshFormat),
}

/// A file to read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Input {
    /// The path as it was given.
    pub(crate) path: PathBuf,
}

impl Input {
    /// The input, and what `accept` makes of its kind; looks at the name alone.
    ///
    /// # Errors
    /// [`CliError::Ending`], which says `expected`, where the ending is that of no kind that is accepted.
    pub(crate) fn resolve<T>(
        path: &Path,
        accept: impl FnOnce(Kind) -> Option<T>,
        expected: &'static str,
    ) -> Result<(Self, T), CliError> {
        match kind_of(path).and_then(accept) {
            Some(kind) => Ok((Self { path: path.to_owned() }, kind)),
            None => Err(CliError::Ending { path: path.to_owned(), expected }),
        }
    }

    /// A map, for the commands that need brushes.
    ///
    /// # Errors
    /// [`CliError::Ending`] where it is no map by its name.
    pub(crate) fn resolve_map(path: &Path) -> Result<Self, CliError> {
        let map = |kind| (kind == Kind::Map).then_some(());
        Self::resolve(path, map, "`.map`, the one input from which this version builds").map(|(input, ())| input)
    }

    /// The path for messages and reports.
    pub(crate) fn name(&self) -> String {
        self.path.display().to_string()
    }

    /// The file's content.
    ///
    /// # Errors
    /// [`CliError::Read`] where there is no such file, or it is a folder, or closed to us.
    pub(crate) fn read(&self) -> Result<Vec<u8>, CliError> {
        fs::read(&self.path).map_err(|source| CliError::Read { path: self.path.clone(), source })
    }
}

fn kind_of(path: &Path) -> Option<Kind> {
    let ending = path.extension()?.to_str()?;
    if ending.eq_ignore_ascii_case("map") {
        return Some(Kind::Map);
    }
    MeshFormat::from_extension(ending).map(Kind::Mesh)
}
