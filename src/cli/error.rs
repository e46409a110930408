//! Everything that can go wrong, and the exit status it gives.

use std::io;
use std::path::{Path, PathBuf};

use planecut::blocks::BlocksError;
use planecut::check::MeshProblem;
use planecut::csg::coarsen::CoarsenError;
use planecut::csg::polyhedron::ConvexTreeError;
use planecut::csg::{EditError, EvaluateError};
use planecut::export::ExportError;
use planecut::import::Warning;
use planecut::import::edits::EditsError;
use planecut::import::map::MapError;
use planecut::import::mesh::{MeshError, SolidError};
use planecut::import::model::ModelError;
use planecut::import::scad::ScadError;
use planecut::picture::PictureError;
use planecut::tiles::TilesError;
use rayon::ThreadPoolBuildError;
use thiserror::Error;

/// Exit status of a job that failed although its input was read.
pub(crate) const FAILED: u8 = 1;
/// Exit status where arguments or input are unusable.
pub(crate) const UNUSABLE: u8 = 2;
/// Exit status where all is done and written, but a solid that the input states is left out.
pub(crate) const INCOMPLETE: u8 = 3;

/// A job that was done.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Done {
    /// With all that the input states.
    Complete,
    /// Without some solid that the input states.
    Incomplete,
}

impl Done {
    /// What warnings say of a job; with `allow_loss` solids may be missing.
    pub(crate) fn with<'a>(warnings: impl IntoIterator<Item = &'a Warning>, allow_loss: bool) -> Self {
        let is_incomplete = warnings.into_iter().any(|warning| warning.left_out > 0);
        if is_incomplete && !allow_loss { Self::Incomplete } else { Self::Complete }
    }

    /// The status that the process ends with.
    pub(crate) fn exit_status(self) -> u8 {
        match self {
            Self::Complete => 0,
            Self::Incomplete => INCOMPLETE,
        }
    }
}

/// Why a command did not do its job. Displays as one line, which names the file that it is about.
#[derive(Debug, Error)]
pub(crate) enum CliError {
    /// The arguments are unusable.
    #[error("{0}")]
    Usage(String),
    /// A file's name does not end as the command needs it.
    #[error("{}: found {}, expected {expected}", .path.display(), ending(.path))]
    Ending {
        /// The file.
        path: PathBuf,
        /// The endings that will do.
        expected: &'static str,
    },
    /// An output cannot be what the arguments say.
    #[error("{}: found {found}, expected {expected}", .path.display())]
    Output {
        /// The output.
        path: PathBuf,
        /// What it is.
        found: &'static str,
        /// What it should be.
        expected: &'static str,
    },
    /// The input cannot be read.
    #[error("{}: found {}, expected a file that can be read", .path.display(), reason(.source))]
    Read {
        /// The input.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The input has more bytes than are read, or no end at all.
    #[error("{}: found {source}, expected no more", .path.display())]
    TooLong {
        /// The input.
        path: PathBuf,
        /// How many are read.
        source: io::Error,
    },
    /// The input is no map.
    #[error(transparent)]
    Map(#[from] MapError),
    /// The input is no model.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The input is no evaluated tree of OpenSCAD, or one of more than is supported.
    #[error(transparent)]
    Scad(#[from] ScadError),
    /// The input is no mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The input is no closed mesh.
    #[error("{error}{advice}", error = .0, advice = advice(.0))]
    Solid(#[from] SolidError),
    /// The edits are none.
    #[error(transparent)]
    Edits(#[from] EditsError),
    /// An edit cannot be done.
    #[error("{}{}: {source}", .path.display(), at_line(*.line))]
    Edit {
        /// The edits.
        path: PathBuf,
        /// The line, counted from 1; 0 for none.
        line: u32,
        /// Why.
        source: EditError,
    },
    /// After an edit the mesh is not that of a fresh build.
    #[error("{}{}: found a bug in planecut: a mesh that differs from that of a fresh build", .path.display(), at_line(*.line))]
    NotFresh {
        /// The edits.
        path: PathBuf,
        /// The line, counted from 1; 0 for all.
        line: u32,
    },
    /// A closed mesh has no convex cells that could be found.
    #[error("{}: found {source}, expected one that convex cells can fill", .path.display())]
    Cells {
        /// The input.
        path: PathBuf,
        /// Why.
        source: ConvexTreeError,
    },
    /// The cells cannot be coarsened so.
    #[error("{}: {source}", .path.display())]
    Coarsen {
        /// The input.
        path: PathBuf,
        /// Why.
        source: CoarsenError,
    },
    /// The mesh is not sound.
    #[error("{}: found {problem}, expected a watertight, manifold mesh that does not cross itself", .path.display())]
    NotSound {
        /// The mesh.
        path: PathBuf,
        /// The first problem.
        problem: MeshProblem,
    },
    /// The solid has no mesh.
    #[error("{}: {source}", .path.display())]
    Evaluate {
        /// The input.
        path: PathBuf,
        /// Why.
        source: EvaluateError,
    },
    /// The boundary does not close, or something else that no input should lead to.
    #[error("{}: found a bug in planecut, expected a closed boundary: {source}", .path.display())]
    Bug {
        /// The input.
        path: PathBuf,
        /// What happened.
        source: EvaluateError,
    },
    /// A picture cannot be drawn or encoded.
    #[error("{output}: {source}")]
    Draw {
        /// The output.
        output: String,
        /// Why.
        source: PictureError,
    },
    /// A mesh cannot be encoded.
    #[error("{output}: {source}")]
    Encode {
        /// The output.
        output: String,
        /// What the encoder said.
        source: ExportError,
    },
    /// An output, or the folder it belongs into, cannot be written.
    #[error("{}: found {}, expected a place that can be written", .path.display(), reason(.source))]
    Write {
        /// The output.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// Standard output cannot be written.
    #[error("standard output: found {}, expected a place that can be written", reason(.0))]
    Stdout(io::Error),
    /// Nothing can be served at a port.
    #[error("127.0.0.1:{port}: found {}, expected a port that is free", reason(.source))]
    Port {
        /// The port.
        port: u16,
        /// What the system said.
        source: io::Error,
    },
    /// A line of a manifest is no job.
    #[error("{}:{line}: {message}", .path.display())]
    Manifest {
        /// The manifest.
        path: PathBuf,
        /// The line, counted from 1.
        line: usize,
        /// What was found, and what was expected.
        message: String,
    },
    /// Jobs of a batch have failed.
    #[error("{}: found {failed} of {jobs} jobs that failed, expected none", .path.display())]
    Batch {
        /// What says why.
        path: PathBuf,
        /// How many.
        failed: usize,
        /// Of how many.
        jobs: usize,
    },
    /// A model is not evaluated block by block.
    #[error("{}{}: {source}", .path.display(), at_line(source.line()))]
    Blocks {
        /// The input.
        path: PathBuf,
        /// Why.
        source: BlocksError,
    },
    /// A tile set is not written.
    #[error("{}: {source}", .folder.display())]
    Tiles {
        /// Its folder.
        folder: PathBuf,
        /// Why.
        source: TilesError,
    },
    /// The system gives no threads.
    #[error("found no threads to work with: {0}, expected a smaller --threads")]
    Threads(#[from] ThreadPoolBuildError),
}

impl CliError {
    /// The error of an input whose solid has no mesh.
    pub(crate) fn of_evaluation(path: &Path, source: EvaluateError) -> Self {
        let path = path.to_owned();
        match source {
            EvaluateError::Unbounded => Self::Evaluate { path, source },
            source => Self::Bug { path, source },
        }
    }

    /// The status that the process ends with.
    pub(crate) fn exit_status(&self) -> u8 {
        match self {
            Self::Usage(_)
            | Self::Manifest { .. }
            | Self::Ending { .. }
            | Self::Output { .. }
            | Self::Read { .. }
            | Self::TooLong { .. }
            | Self::Map(_)
            | Self::Model(_)
            | Self::Scad(_)
            | Self::Mesh(_)
            | Self::Solid(_)
            | Self::Edits(_) => UNUSABLE,
            Self::NotSound { .. }
            | Self::Edit { .. }
            | Self::NotFresh { .. }
            | Self::Evaluate { .. }
            | Self::Cells { .. }
            | Self::Coarsen { .. }
            | Self::Bug { .. }
            | Self::Draw { .. }
            | Self::Encode { .. }
            | Self::Write { .. }
            | Self::Stdout(_)
            | Self::Port { .. }
            | Self::Batch { .. }
            | Self::Blocks { .. }
            | Self::Tiles { .. }
            | Self::Threads(_) => FAILED,
        }
    }
}

/// What would make a solid of a mesh that is none.
pub(crate) fn advice(error: &SolidError) -> &'static str {
    if error.is_open() { " (--close EPS joins vertices that are no farther apart than EPS)" } else { "" }
}

/// A line after the name of a file; nothing for line 0.
fn at_line(line: u32) -> String {
    if line == 0 { String::new() } else { format!(":{line}") }
}

fn ending(path: &Path) -> String {
    match path.extension() {
        Some(ending) => format!("a name that ends in `.{}`", ending.display()),
        None => "a name without an ending".to_owned(),
    }
}

/// What the system said, in words that do not depend on the system where it matters.
fn reason(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "no such file".to_owned(),
        io::ErrorKind::IsADirectory => "a folder".to_owned(),
        io::ErrorKind::AddrInUse => "a port in use".to_owned(),
        io::ErrorKind::PermissionDenied => "no permission".to_owned(),
        _ => format!("`{error}`"),
    }
}
