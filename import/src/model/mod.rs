//! Reader of the native model file: JSON with brushes, primitives, trees, transforms, parameters and instances.
//!
//! The format is described in `docs/model-file.md` and, as a JSON Schema, in `docs/model.schema.json`. The stages, each in
//! its own file: text → flat list of values with their places (`json`), values → names and expressions (`names`, `check`,
//! `form`, `keys`, `expression`), values → bodies (`values`, `parameters`, `body`, `meshes`, `inline_mesh`), NODEs → one tree (`evaluate`, `copies`). No stage is
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
mod values;

use std::path::PathBuf;

use planecut_csg::Model;
use serde::{Deserialize, Serialize};

pub use error::ModelError;

use crate::Warning;
use crate::lines::LineTable;
use crate::source::{DEFAULT_MAX_PIECES, at_most, shorten, without_byte_order_mark};
use check::{Checker, Findings, Use};
use error::{Checked, Fault};
use evaluate::{Evaluated, Evaluator};
use json::{Document, Entry, Kind};
use meshes::Meshes;
use names::Names;
use order::{describe_circle, order};
use parameters::{Definitions, numbers_of};

pub use crate::source::MAX_TEXT;

/// Most nodes around a node.
pub const MAX_DEPTH: u32 = 10_000;
/// Most brushes of a model, copies of instances counted, whatever [`ModelOptions::max_pieces`] is: 4,194,304.
pub const MAX_BRUSHES: usize = 1 << 22;
/// Most planes of a model, copies of instances counted: 33,554,432.
pub const MAX_PLANES: usize = 1 << 25;

/// What a caller sets before a model is made.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ModelOptions {
    /// Values that replace those of parameters of the file, by name; others that depend on them follow.
    pub parameters: Vec<(String, f64)>,
    /// Most brushes of the model, copies of instances counted, and most corners of all outlines that are made on the way;
    /// [`DEFAULT_MAX_PIECES`] unless it is set, at most [`MAX_BRUSHES`].
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
    if text.len() > MAX_TEXT {
        return Err(ModelError::TooLong { name: name.to_owned(), bytes: text.len() });
    }
    let text = decode(without_byte_order_mark(text), name)?;
    let lines = LineTable::new(text.as_bytes());
    let document = json::parse(text).map_err(|fault| ModelError::Syntax {
        name: name.to_owned(),
        line: lines.line_of(fault.offset),
        path: fault.path,
        found: fault.found,
        expected: fault.expected.to_owned(),
    })?;
    let limit = options.max_pieces.min(MAX_BRUSHES);
    let located = |fault: Fault| fault.locate(name, &document, &lines);
    let root = model_of(&document).map_err(located)?;
    let mut names = Names::read(&document).map_err(located)?;
    let set = numbers_of(&options.parameters, &names, name)?;
    let findings = Checker::new(&document, &names, limit).run(root).map_err(located)?;
    let order = order_of_definitions(&names, &findings.uses).map_err(located)?;
    refuse_too_many(&findings, &order, root, limit).map_err(located)?;
    let warnings = materials::warn_of_unknown(&document, &lines, &findings.unknown_materials);
    for entry in &findings.unknown_materials {
        names.material(&document.text(*entry));
    }
    let definitions = Definitions::new(&document, &findings.expressions, &names).map_err(located)?;
    let environment = definitions.environment(&set).map_err(located)?;
    let mut materials = materials::read(&names, &definitions.values(&environment)).map_err(located)?;
    let parameters = names.parameters.names.iter().cloned().zip(environment.values.iter().copied()).collect();
    let meshes = Meshes::new(&options.folder, options.textures, &names);
    let evaluator = Evaluator::new(&definitions, &names, &lines, &findings.uses, limit, meshes);
    let Evaluated { mut tree, materials: of_meshes, warnings: more } =
        evaluator.run(root, environment).map_err(located)?;
    materials.extend(of_meshes);
    materials::fill(&mut tree, &mut materials);
    let warnings = warnings.into_iter().chain(more).collect();
    Ok(ModelImport { model: Model { materials, tree }, parameters, warnings })
}

/// The keys of the outermost object.
const ROOT_KEYS: [&str; 6] = ["planecut", "model", "materials", "parameters", "parts", "outlines"];
/// The version of the format.
const VERSION: f64 = 1.0;

fn decode<'a>(text: &'a [u8], name: &str) -> Result<&'a str, ModelError> {
    std::str::from_utf8(text).map_err(|error| {
        let offset = error.valid_up_to();
        ModelError::Syntax {
            name: name.to_owned(),
            line: LineTable::new(text).line_of(offset),
            path: "$".to_owned(),
            found: format!("the byte {:#04x} at offset {offset}", text[offset]),
            expected: "text in UTF-8".to_owned(),
        }
    })
}

/// The model's NODE; the version and the keys of the outermost object are right.
fn model_of(document: &Document<'_>) -> Checked<Entry> {
    let root = document.root();
    if document.kind(root) != Kind::Object {
        return document.refuse(root, "an object with the keys planecut and model");
    }
    let missing = |key: &str| Err(Fault::new(root, document.describe(root), format!("the key `{key}` as well")));
    match document.member(root, "planecut") {
        None => return missing("planecut"),
        Some(version) if document.kind(version) != Kind::Number(VERSION) => {
            return document.refuse(version, format!("{VERSION}, the version of the format"));
        }
        Some(_) => {}
    }
    for (key, value) in document.members(root) {
        let key = document.text(key);
        if !ROOT_KEYS.contains(&&*key) {
            let found = format!("the key `{}`", shorten(&key));
            return Err(Fault::new(value, found, format!("one of {}", ROOT_KEYS.join(", "))));
        }
    }
    document.member(root, "model").map_or_else(|| missing("model"), Ok)
}

/// The numbers of the definitions, each after all that it uses.
fn order_of_definitions(names: &Names, uses: &[Use]) -> Checked<Vec<usize>> {
    let mut needs = vec![Vec::new(); names.vertices()];
    for Use { user, used, .. } in uses {
        needs[*user].push(*used);
    }
    order(&needs).map_err(|circle| {
        let next = circle.get(1).unwrap_or(&circle[0]);
        let place = uses.iter().find(|each| (each.user, each.used) == (circle[0], *next));
        let entry = place.map_or(Entry::ROOT, |each| each.entry);
        let found = format!("a circle: {}", describe_circle(&circle, |vertex| names.vertex_name(vertex)));
        Fault::new(entry, found, "definitions that do not use themselves")
    })
}

/// Refuses a model that has too many brushes by its text alone, before the first of them is made.
fn refuse_too_many(findings: &Findings, order: &[usize], model: Entry, limit: usize) -> Checked<()> {
    let mut totals = findings.brushes.clone();
    let mut uses: Vec<&Use> = findings.uses.iter().collect();
    uses.sort_by_key(|each| each.user);
    for definition in order {
        let first = uses.partition_point(|each| each.user < *definition);
        let own = uses[first..].iter().take_while(|each| each.user == *definition);
        totals[*definition] += own.map(|each| each.copies * totals[each.used]).sum::<f64>();
    }
    if totals[0] <= limit as f64 {
        return Ok(());
    }
    let found = format!("{} or more brushes in all", totals[0]);
    Err(Fault::new(findings.too_many.unwrap_or(model), found, at_most(limit)))
}
