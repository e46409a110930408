//! Reader of the native model file: JSON with brushes, primitives, trees, transforms, parameters and instances.
//!
//! The format is described in `docs/model-file.md` and, as a JSON Schema, in `docs/model.schema.json`. The stages, each in
//! its own file: text → flat list of values with their places (`json`), values → names and expressions (`names`, `check`,
//! `form`, `keys`, `expression`), values → bodies (`values`, `parameters`, `body`, `meshes`, `inline_mesh`), NODEs → one tree, or its
//! pieces one by one (`evaluate`, `copies`); `prepare` goes through all before that. No stage is
//! recursive, so a file can be nested as deep as [`MAX_DEPTH`] on any stack.

mod body;
mod budget;
mod check;
mod copies;
mod error;
mod evaluate;
mod expression;
mod form;
mod inline_mesh;
mod json;
mod keys;
mod materials;
mod meshes;
mod names;
mod order;
mod parameters;
mod prepare;
mod values;

use std::convert::Infallible;
use std::path::PathBuf;

use planecut_csg::{Material, Model, TreeSink};
use serde::{Deserialize, Serialize};

pub use error::ModelError;

use crate::Warning;
use crate::source::DEFAULT_MAX_PIECES;
use crate::stream_error::StreamError;
use error::Stop;
use evaluate::{Evaluated, Evaluator, Spine};
use prepare::{Prepared, with_prepared};

pub use crate::source::MAX_TEXT;

/// Most nodes around a node.
pub const MAX_DEPTH: u32 = 10_000;
/// Most brushes of a model, copies of instances counted, whatever [`ModelOptions::max_pieces`] is: 4,194,304.
pub const MAX_BRUSHES: usize = 1 << 22;
/// Most brushes of a model that is handed on brush by brush, whatever [`ModelOptions::max_pieces`] is: 2^40.
pub const MAX_STREAMED: u64 = 1 << 40;
/// Most planes of a model, copies of instances counted: 33,554,432.
pub const MAX_PLANES: usize = 1 << 25;

/// What a caller sets before a model is made.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ModelOptions {
    /// Values that replace those of parameters of the file, by name; others that depend on them follow.
    pub parameters: Vec<(String, f64)>,
    /// Most brushes of the model, copies of instances counted, and most corners of all outlines that are made on the way;
    /// [`DEFAULT_MAX_PIECES`] unless it is set, at most [`MAX_BRUSHES`], or [`MAX_STREAMED`] where brushes are handed on by [`stream_model`].
    pub max_pieces: usize,
    /// Where mesh files that the model names are looked for; the current folder by default.
    pub folder: PathBuf,
    /// Whether texture coordinates of these files are kept, as [`SolidOptions::textures`](crate::mesh::SolidOptions::textures) says.
    pub textures: bool,
}

impl Default for ModelOptions {
    fn default() -> Self {
        Self { parameters: Vec::new(), max_pieces: DEFAULT_MAX_PIECES, folder: PathBuf::new(), textures: false }
    }
}

/// A model that was read.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ModelImport {
    /// The tree; each brush has the name of the innermost node that has one, and the line of the node that made it.
    pub model: Model,
    /// The values of the parameters, in the order of the file.
    pub parameters: Vec<(String, f64)>,
    /// What is doubtful.
    pub warnings: Vec<Warning>,
}

/// What a model file held whose brushes were handed on.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ModelSummary {
    /// Brushes that were handed on.
    pub brushes: u64,
    /// The materials of all faces: brushes name them by their places here.
    pub materials: Vec<Material>,
    /// As [`ModelImport::parameters`].
    pub parameters: Vec<(String, f64)>,
    /// As [`ModelImport::warnings`].
    pub warnings: Vec<Warning>,
}

/// Reads a model file; `name` is what errors call it.
///
/// ```
/// use planecut_import::model::{ModelOptions, read_model};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let text = br#"{
///   "planecut": 1,
///   "parameters": {"width": 4},
///   "model": {"box": {"min": [0, 0, 0], "max": ["=width", "=width / 2", 1]}}
/// }"#;
/// let options = ModelOptions { parameters: vec![("width".to_owned(), 6.0)], ..ModelOptions::default() };
/// let import = read_model(text, "block.json", &options)?;
/// assert_eq!(planecut_csg::evaluate(&import.model)?.solid.volume, 18.0);
///
/// let error = read_model(br#"{"planecut": 1, "model": {"bax": {}}}"#, "typo.json", &ModelOptions::default()).unwrap_err();
/// assert!(error.to_string().starts_with("typo.json:1: $.model.bax: found the key `bax`, expected one of halfspaces, "));
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// [`ModelError`], with line and path, where the text is no JSON, not of the form that the format asks for, or says
/// something that cannot be made.
pub fn read_model(text: &[u8], name: &str, options: &ModelOptions) -> Result<ModelImport, ModelError> {
    let limit = options.max_pieces.min(MAX_BRUSHES);
    let evaluated = with_prepared(text, name, options, limit, |prepared| -> Result<_, Stop<Infallible>> {
        let Prepared { names, lines, findings, root, environment, mut materials, meshes, .. } = prepared;
        let evaluator = Evaluator::new(prepared.definitions, names, lines, &findings.uses, limit, meshes);
        let Evaluated { mut tree, materials: of_meshes, warnings } = evaluator.run(root, environment)?;
        materials.extend(of_meshes);
        materials::fill(&mut tree, &mut materials);
        Ok((Model { materials, tree }, warnings))
    });
    let (model, described) = evaluated.map_err(StreamError::into_input)?;
    Ok(ModelImport { model, parameters: described.parameters, warnings: described.warnings })
}

/// Reads a model file and hands its brushes to a sink one by one, in the order and with the names, materials and lines that [`read_model`] gives them.
///
/// Operations and copies around which there are only operations, copies and uses of parts are sent as they stand, copies one after another and each
/// set within a union: what they expand to is never in memory. What is below (bodies, hulls, sums) is made as by `read_model`, and held while it is
/// sent, or while copies of it are. The tree means the same solid as that of `read_model`, which writes a union within a union as one.
///
/// [`ModelOptions::max_pieces`] is the most brushes that are sent, up to [`MAX_STREAMED`]. What is held has no more than [`MAX_BRUSHES`] brushes and
/// [`MAX_PLANES`] planes. Where the model uses mesh files and defines no material called `default`, nothing is sent before all files are read.
///
/// ```
/// use planecut_csg::TreeBuilder;
/// use planecut_import::model::{ModelOptions, stream_model};
///
/// let text = br#"{"planecut": 1, "model": {
///   "array": {"of": {"box": {"min": [0, 0, 0], "max": [1, 1, 1]}}, "count": [10, 10, 10], "step": [2, 2, 2]}
/// }}"#;
/// let mut builder = TreeBuilder::default();
/// let summary = stream_model(text, "boxes.json", &ModelOptions::default(), &mut builder).unwrap();
/// assert_eq!((summary.brushes, builder.finish().brushes().len()), (1000, 1000));
/// ```
///
/// # Errors
/// [`StreamError::Input`] as `read_model`, [`StreamError::Sink`] where the sink does not take a piece. The sink may have taken pieces before either.
pub fn stream_model<S: TreeSink>(
    text: &[u8],
    name: &str,
    options: &ModelOptions,
    sink: &mut S,
) -> Result<ModelSummary, StreamError<ModelError, S::Error>> {
    let limit = (options.max_pieces as u64).min(MAX_STREAMED);
    let streamed = with_prepared(text, name, options, limit as usize, |prepared| {
        let Prepared { names, lines, findings, root, environment, mut materials, meshes, .. } = prepared;
        let held = options.max_pieces.min(MAX_BRUSHES);
        let evaluator = Evaluator::new(prepared.definitions, names, lines, &findings.uses, held, meshes);
        let default = (!findings.has_mesh_files || names.defines_material(materials::DEFAULT))
            .then(|| materials::number_of_default(&materials));
        let streamed = Spine::new(evaluator, sink, limit, default, &materials).run(root, environment)?;
        materials.extend(streamed.materials);
        if streamed.uses_default && materials::number_of_default(&materials).0 as usize == materials.len() {
            materials.push(Material::named(materials::DEFAULT));
        }
        Ok(((streamed.brushes, materials), streamed.warnings))
    });
    let ((brushes, materials), described) = streamed?;
    Ok(ModelSummary { brushes, materials, parameters: described.parameters, warnings: described.warnings })
}
