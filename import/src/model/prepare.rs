//! Everything that comes before NODEs are evaluated: the text is taken apart and checked, definitions are put in order.

use planecut_csg::Material;

use super::check::{Checker, Findings, Use};
use super::error::{Checked, Fault, ModelError, Stop};
use super::json::{self, Document, Entry, Kind};
use super::materials;
use super::meshes::Meshes;
use super::names::Names;
use super::order::{describe_circle, order};
use super::parameters::{Definitions, Environment, numbers_of};
use super::{MAX_TEXT, ModelOptions};
use crate::Warning;
use crate::lines::LineTable;
use crate::source::{at_most, shorten, without_byte_order_mark};
use crate::stream_error::StreamError;

/// A text that was checked, ready for evaluation.
pub(super) struct Prepared<'v, 'a> {
    pub(super) definitions: &'v Definitions<'v, 'a>,
    pub(super) names: &'v Names,
    pub(super) lines: &'v LineTable,
    pub(super) findings: &'v Findings,
    /// The model's NODE.
    pub(super) root: Entry,
    /// The values of the parameters.
    pub(super) environment: Environment,
    /// Those that the file defines or names.
    pub(super) materials: Vec<Material>,
    /// The mesh files, none of them read yet.
    pub(super) meshes: Meshes<'v>,
}

/// What is to be told of a text beside its model.
pub(super) struct Described {
    /// The values of the parameters, in the order of the file.
    pub(super) parameters: Vec<(String, f64)>,
    /// What is doubtful.
    pub(super) warnings: Vec<Warning>,
}

/// Takes a text apart and hands it to `work`, whose result and warnings are given back; `limit` is the most brushes that it may make.
///
/// # Errors
/// [`ModelError`] for a text that is no model, and what stops `work`.
pub(super) fn with_prepared<T, E>(
    text: &[u8],
    name: &str,
    options: &ModelOptions,
    limit: usize,
    work: impl FnOnce(Prepared<'_, '_>) -> Result<(T, Vec<Warning>), Stop<E>>,
) -> Result<(T, Described), StreamError<ModelError, E>> {
    if text.len() > MAX_TEXT {
        return Err(StreamError::Input(ModelError::TooLong { name: name.to_owned(), bytes: text.len() }));
    }
    let text = decode(without_byte_order_mark(text), name).map_err(StreamError::Input)?;
    let lines = LineTable::new(text.as_bytes());
    let document = json::parse(text).map_err(|fault| {
        StreamError::Input(ModelError::Syntax {
            name: name.to_owned(),
            line: lines.line_of(fault.offset),
            path: fault.path,
            found: fault.found,
            expected: fault.expected.to_owned(),
        })
    })?;
    let located = |fault: Fault| StreamError::Input(fault.locate(name, &document, &lines));
    let root = model_of(&document).map_err(located)?;
    let mut names = Names::read(&document).map_err(located)?;
    let set = numbers_of(&options.parameters, &names, name).map_err(StreamError::Input)?;
    let findings = Checker::new(&document, &names, limit).run(root).map_err(located)?;
    let order = order_of_definitions(&names, &findings.uses).map_err(located)?;
    refuse_too_many(&findings, &order, root, limit).map_err(located)?;
    let mut warnings = materials::warn_of_unknown(&document, &lines, &findings.unknown_materials);
    for entry in &findings.unknown_materials {
        names.material(&document.text(*entry));
    }
    let definitions = Definitions::new(&document, &findings.expressions, &names).map_err(located)?;
    let environment = definitions.environment(&set).map_err(located)?;
    let materials = materials::read(&names, &definitions.values(&environment)).map_err(located)?;
    let parameters = names.parameters.names.iter().cloned().zip(environment.values.iter().copied()).collect();
    let meshes = Meshes::new(&options.folder, options.textures, &names);
    let prepared = Prepared {
        definitions: &definitions,
        names: &names,
        lines: &lines,
        findings: &findings,
        root,
        environment,
        materials,
        meshes,
    };
    let (made, more) = work(prepared).map_err(|stop| match stop {
        Stop::Fault(fault) => located(fault),
        Stop::Sink(error) => StreamError::Sink(error),
    })?;
    warnings.extend(more);
    Ok((made, Described { parameters, warnings }))
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
