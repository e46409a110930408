//! Any input as a model, from its bytes: what `load` of the Python package and the page in a browser read.

use std::num::NonZeroU32;
use std::path::PathBuf;

use planecut_csg::{Model, Tree, summarize};
use planecut_import::map::{MapError, MapOptions, read_map};
use planecut_import::mesh::{MeshFormat, Place, SolidError, SolidOptions, read_solid};
use planecut_import::model::{ModelError, ModelOptions, read_model};
use planecut_import::scad::{ScadError, ScadOptions, read_scad};
use planecut_import::{DEFAULT_MAX_PIECES, Warning};
use thiserror::Error;

/// What a file is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FileKind {
    /// The native model file.
    Model,
    /// A Quake-family map.
    Map,
    /// An evaluated tree of OpenSCAD.
    Scad,
    /// A closed mesh.
    Mesh(MeshFormat),
}

/// The endings of the names of files that can be read.
pub const ENDINGS: &str = ".json, .map, .csg, .obj, .stl, .ply, .glb or .gltf";

impl FileKind {
    /// The name of the format, for arguments and reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Model => "json",
            Self::Map => "map",
            Self::Scad => "csg",
            Self::Mesh(MeshFormat::Obj) => "obj",
            Self::Mesh(MeshFormat::Stl) => "stl",
            Self::Mesh(MeshFormat::Ply) => "ply",
            Self::Mesh(MeshFormat::Gltf) => "gltf",
        }
    }

    /// That of a file with an ending, without the dot and in any case; nothing where none has it.
    #[must_use]
    pub fn from_extension(extension: &str) -> Option<Self> {
        match extension.to_ascii_lowercase().as_str() {
            "json" => Some(Self::Model),
            "map" => Some(Self::Map),
            "csg" => Some(Self::Scad),
            other => MeshFormat::from_extension(other).map(Self::Mesh),
        }
    }
}

/// How a file is read.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ReadOptions {
    /// Values for parameters of a model file.
    pub parameters: Vec<(String, f64)>,
    /// Where files lie that the file names.
    pub folder: PathBuf,
    /// How a mesh is taken.
    pub solid: SolidOptions,
}

/// Why a file was not read. Displays as one line that begins with the name of the file.
#[derive(Debug, Error)]
pub enum ReadError {
    /// A model file.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// A map.
    #[error(transparent)]
    Map(#[from] MapError),
    /// A tree of OpenSCAD.
    #[error(transparent)]
    Scad(#[from] ScadError),
    /// A mesh.
    #[error(transparent)]
    Mesh(#[from] SolidError),
    /// A file that has no parameters is to be read with some.
    #[error("{name}: found parameters for a file that has none, expected a model file (.json)")]
    Parameters {
        /// The file's name as given to the reader.
        name: String,
    },
}

impl ReadError {
    /// The line of the error, counted from 1, where there is one.
    #[must_use]
    pub fn line(&self) -> Option<u32> {
        match self {
            Self::Model(error) => error.line(),
            Self::Map(error) => error.line(),
            Self::Scad(error) => error.line(),
            Self::Mesh(SolidError::Mesh(error)) => line_of(&error.place),
            Self::Mesh(SolidError::Surface { place, .. }) => line_of(place),
            Self::Mesh(_) | Self::Parameters { .. } => None,
        }
    }

    /// The place of the error in a model file, as a JSON path, where there is one.
    #[must_use]
    pub fn json_path(&self) -> Option<&str> {
        match self {
            Self::Model(error) => error.path(),
            _ => None,
        }
    }
}

fn line_of(place: &Place) -> Option<u32> {
    match place {
        Place::Line(line) => u32::try_from(*line).ok(),
        Place::Byte(_) | Place::Json(_) | Place::End => None,
    }
}

/// Reads a file, of which `name` is what errors call it; gives its model, and what was repaired, left out or is doubtful. Brushes of a map that are not bounded are left out.
///
/// # Errors
/// [`ReadError`].
///
/// ```
/// use planecut::reading::{FileKind, ReadOptions, read};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let text = br#"{"planecut": 1, "model": {"box": {"min": [0, 0, 0], "max": [1, 1, 1]}}}"#;
/// let (model, warnings) = read(text, FileKind::Model, "box.json", &ReadOptions::default())?;
/// assert_eq!((model.tree.brushes().len(), warnings.len()), (1, 0));
/// assert_eq!(read(b"{", FileKind::Model, "box.json", &ReadOptions::default()).unwrap_err().line(), Some(1));
/// # Ok(())
/// # }
/// ```
pub fn read(
    bytes: &[u8],
    kind: FileKind,
    name: &str,
    options: &ReadOptions,
) -> Result<(Model, Vec<Warning>), ReadError> {
    let ReadOptions { parameters, folder, solid } = options;
    if !parameters.is_empty() && kind != FileKind::Model {
        return Err(ReadError::Parameters { name: name.to_owned() });
    }
    let folder = folder.clone();
    Ok(match kind {
        FileKind::Model => {
            let options = ModelOptions { parameters: parameters.clone(), folder, ..ModelOptions::default() };
            let import = read_model(bytes, name, &options)?;
            (import.model, import.warnings)
        }
        FileKind::Map => {
            let import = read_map(bytes, name, &MapOptions::default())?;
            let mut warnings = import.warnings;
            (without_unbounded(import.model, &mut warnings), warnings)
        }
        FileKind::Scad => {
            let options = ScadOptions { folder, max_pieces: DEFAULT_MAX_PIECES, ..ScadOptions::default() };
            let import = read_scad(bytes, name, &options)?;
            (import.model, import.warnings)
        }
        FileKind::Mesh(format) => {
            let import = read_solid(bytes, format, name, solid)?;
            (import.model, import.warnings)
        }
    })
}

/// A map without brushes that are not bounded: nobody means half of space there, the brush lacks a face.
fn without_unbounded(model: Model, warnings: &mut Vec<Warning>) -> Model {
    let unbounded = summarize(&model).unbounded;
    let Some(first) = unbounded.first() else { return model };
    let line = model.tree.source_line(*first).map_or(0, NonZeroU32::get);
    let count = unbounded.len();
    let message = format!("left out {count} brushes that are not bounded, the first of them here");
    warnings.push(Warning::loss(line, message, count));
    let brushes = model.tree.into_brushes().into_iter().enumerate();
    let kept = brushes.filter(|(number, _)| unbounded.binary_search(number).is_err()).map(|(_, brush)| brush);
    Model { materials: model.materials, tree: Tree::union_of(kept.collect()) }
}
