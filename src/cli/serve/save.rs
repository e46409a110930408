//! A live model as a file.

use std::path::Path;

use planecut::csg::{LiveModel, summarize};
use planecut::import::Warning;
use planecut::reading::FileKind;

use crate::cli::args::EditArgs;
use crate::cli::edit::encode_model;
use crate::cli::error::CliError;
use crate::cli::input::Input;
use crate::cli::output::{MeshTarget, Output, OutputFormat, Target, check_targets};
use crate::cli::solve::solid_warnings;

/// How a model is written.
pub(super) struct Saving<'a> {
    pub(super) args: &'a EditArgs,
    pub(super) input: &'a Input,
    pub(super) kind: FileKind,
}

impl Saving<'_> {
    /// Writes the model to a file, which gets its name when it is complete; gives what there is to warn of.
    ///
    /// # Errors
    /// As of `-o`: [`CliError`] of a name, of encoding and of writing; [`CliError::Usage`] for standard output.
    pub(super) fn save(&self, live: &LiveModel, path: &Path) -> Result<Vec<Warning>, CliError> {
        let Self { args, input, kind } = *self;
        if Target::new(path) == Target::Stdout {
            return Err(CliError::Usage("found standard output, expected the name of a file".into()));
        }
        let targets = MeshTarget::resolve_all(&[path.to_owned()], None, args.output.assets.mtl)?;
        if targets.iter().any(|target| matches!(target.format, OutputFormat::Physics(_))) {
            let expected = "`.glb`, `.gltf`, `.obj`, `.stl`, `.3mf`, `.ply`, `.map`, `.csg` or `.json`";
            return Err(CliError::Ending { path: path.to_owned(), expected });
        }
        let all: Vec<Target> = targets.iter().flat_map(MeshTarget::targets).collect();
        check_targets(input.file(), all.iter())?;
        let mesh = live.mesh().map_err(|source| CliError::of_evaluation(&input.path, source))?;
        let model = live.to_model();
        let summary = summarize(&model);
        let warnings = solid_warnings(kind, &model, &summary, &mesh);
        Output::commit_all(encode_model(args, (input, kind), (&model, &summary.unbounded), &mesh, &targets)?)?;
        Ok(warnings)
    }
}
