//! The options for inputs that are read. The doc comments here are the help texts.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use planecut::import::DEFAULT_MAX_PIECES;
use planecut::import::map::MapOptions;
use planecut::import::mesh::{SolidOptions, WindingRule};
use planecut::import::model::{MAX_BRUSHES, MAX_STREAMED, ModelOptions};
use planecut::import::scad::ScadOptions;
use planecut::reading::FileKind;

use super::error::CliError;
use super::input::Input;

/// How to read the input.
#[derive(Debug, Clone, Args)]
pub(crate) struct ReadingArgs {
    /// Format of the input; by default from the ending of its name, and json for `-`
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub(crate) input_format: Option<FileKind>,
    /// End with exit status 0, not 3, where a solid that the input states is left out
    #[arg(long)]
    pub(crate) allow_loss: bool,
    /// Maximum number of convex pieces of a model or tree, and of corners of its outlines, 1 to 4194304: what has more is refused
    /// before it is made [default: 1048576; none for a model file with --blocks]
    #[arg(long, value_name = "N", value_parser = parse_pieces)]
    max_pieces: Option<usize>,
    /// Whether there is no such limit, as nothing is held of what is made.
    #[arg(skip)]
    is_streamed: bool,
    /// Whether texture coordinates of meshes are kept; this follows from what is written.
    #[arg(skip)]
    keeps_textures: bool,
    #[command(flatten)]
    model: ModelArgs,
    #[command(flatten)]
    map: MapArgs,
    #[command(flatten)]
    scad: ScadArgs,
    #[command(flatten)]
    mesh: MeshArgs,
}

impl ReadingArgs {
    /// The same with texture coordinates of meshes, or without.
    pub(crate) fn with_textures(&self, keeps_textures: bool) -> Self {
        Self { keeps_textures, ..self.clone() }
    }

    /// The same for a model that is read as a stream.
    pub(crate) fn streamed(&self) -> Self {
        Self { is_streamed: true, ..self.clone() }
    }

    /// The options for model files; meshes that `input` names lie beside it.
    pub(crate) fn model_options(&self, input: &Input) -> ModelOptions {
        let (parameters, folder) = (self.model.set.clone(), folder_of(input));
        let streamed = usize::try_from(MAX_STREAMED).unwrap_or(usize::MAX);
        let max_pieces = self.max_pieces.unwrap_or(if self.is_streamed { streamed } else { DEFAULT_MAX_PIECES });
        ModelOptions { parameters, max_pieces, folder, textures: self.keeps_textures }
    }

    /// The options for maps.
    pub(crate) fn map_options(&self) -> MapOptions {
        self.map.options()
    }

    /// The options for OpenSCAD's trees; files that `input` names lie beside it.
    pub(crate) fn scad_options(&self, input: &Input) -> ScadOptions {
        let ScadArgs { keep_going, keep_touching } = self.scad;
        ScadOptions {
            folder: folder_of(input),
            keep_going,
            keep_touching,
            max_pieces: self.max_pieces.unwrap_or(DEFAULT_MAX_PIECES),
            textures: self.keeps_textures,
        }
    }

    /// The options for meshes.
    pub(crate) fn solid_options(&self) -> SolidOptions {
        SolidOptions {
            rule: self.mesh.winding.into(),
            close: self.mesh.close.unwrap_or(0.0),
            textures: self.keeps_textures,
        }
    }

    /// The same for another input, of any kind: what is for one kind alone is left out.
    pub(crate) fn of_any_kind(&self) -> Self {
        Self {
            input_format: None,
            allow_loss: self.allow_loss,
            max_pieces: self.max_pieces,
            is_streamed: self.is_streamed,
            keeps_textures: self.keeps_textures,
            model: ModelArgs { set: Vec::new() },
            map: MapArgs { world_only: false, skip_texture: Vec::new(), skip_class: Vec::new() },
            scad: self.scad.clone(),
            mesh: self.mesh.clone(),
        }
    }

    /// Sees that no option is for another kind of input.
    ///
    /// # Errors
    /// [`CliError::Usage`]; `kind` is that of the input.
    pub(crate) fn check(&self, kind: FileKind) -> Result<(), CliError> {
        self.check_any(&[kind])
    }

    /// The same for several inputs of these kinds.
    ///
    /// # Errors
    /// As [`check`](Self::check).
    pub(crate) fn check_any(&self, kinds: &[FileKind]) -> Result<(), CliError> {
        let lacks = |kind: FileKind| !kinds.contains(&kind);
        let refuse = |option: &str, expected: &str| {
            Err(CliError::Usage(format!("found {option} with another input, expected it with {expected}")))
        };
        if lacks(FileKind::Model) && !self.model.set.is_empty() {
            return refuse("--set", "a model file (.json)");
        }
        if lacks(FileKind::Map) && self.map.options() != MapOptions::default() {
            return refuse("--world-only, --skip-texture or --skip-class", "a map (.map)");
        }
        if lacks(FileKind::Scad) && self.scad.keep_going {
            return refuse("--keep-going", "an OpenSCAD tree (.csg)");
        }
        if lacks(FileKind::Scad) && self.scad.keep_touching {
            return refuse("--keep-touching", "an OpenSCAD tree (.csg)");
        }
        let has_mesh = kinds.iter().any(|kind| matches!(kind, FileKind::Mesh(_)));
        let asked = SolidOptions { textures: false, ..self.solid_options() };
        if !has_mesh && asked != SolidOptions::default() {
            return refuse("--winding or --close", "a mesh (.obj, .stl, .ply, .glb, .gltf)");
        }
        Ok(())
    }
}

/// The folder of an input: the working folder for standard input.
fn folder_of(input: &Input) -> PathBuf {
    input.file().and_then(Path::parent).map(Path::to_owned).unwrap_or_default()
}

/// What to change in a model file.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Options for .json")]
struct ModelArgs {
    /// Give a parameter of the file another value; may be given several times
    #[arg(long, value_name = "NAME=VALUE", num_args = 1, value_parser = parse_setting)]
    set: Vec<(String, f64)>,
}

/// Which brushes of a map to take.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Options for .map")]
struct MapArgs {
    /// Take only the brushes of the world, of `func_group` and of `func_detail…`
    #[arg(long)]
    world_only: bool,
    /// Skip brushes whose faces all have a texture like this (`*` and `?` are wildcards); may be given several times
    #[arg(long, value_name = "PATTERN", num_args = 1)]
    skip_texture: Vec<String>,
    /// Skip the brushes of entities whose class is like this; may be given several times
    #[arg(long, value_name = "PATTERN", num_args = 1)]
    skip_class: Vec<String>,
}

impl MapArgs {
    /// The same as the reader wants it.
    fn options(&self) -> MapOptions {
        MapOptions {
            world_only: self.world_only,
            skip_textures: self.skip_texture.clone(),
            skip_classes: self.skip_class.clone(),
        }
    }
}

/// How strictly to read OpenSCAD's trees.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Options for .csg")]
struct ScadArgs {
    /// Leave out, with a warning, what is not supported or fails, instead of failing as a whole
    #[arg(long)]
    keep_going: bool,
    /// Keep solids that touch themselves also where they are combined with others, as OpenSCAD does since 2024
    #[arg(long)]
    keep_touching: bool,
}

/// How to take closed meshes.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Options for meshes")]
struct MeshArgs {
    /// What of a mesh that crosses itself, lies upon itself or is nested in itself is inside, by how often it winds around a place
    #[arg(long, value_enum, value_name = "RULE", default_value_t = Winding::Positive)]
    winding: Winding,
    /// Join vertices of a mesh that differ by no more than EPS in each coordinate, in its units; for meshes that are not closed
    #[arg(long, value_name = "EPS", value_parser = parse_distance)]
    close: Option<f64>,
}

/// Which winding numbers are inside.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Winding {
    /// Those above zero
    Positive,
    /// All but zero
    Nonzero,
    /// Odd ones
    Odd,
}

impl From<Winding> for WindingRule {
    fn from(winding: Winding) -> Self {
        match winding {
            Winding::Positive => Self::Positive,
            Winding::Nonzero => Self::NonZero,
            Winding::Odd => Self::Odd,
        }
    }
}

fn parse_setting(text: &str) -> Result<(String, f64), String> {
    let setting = text.split_once('=').and_then(|(name, value)| Some((name.trim(), value.trim().parse::<f64>().ok()?)));
    match setting {
        Some((name, value)) if !name.is_empty() && value.is_finite() => Ok((name.to_owned(), value)),
        _ => Err("expected NAME=VALUE, the value a number".to_owned()),
    }
}

fn parse_pieces(text: &str) -> Result<usize, String> {
    let count = text.parse().ok().filter(|count| (1..=MAX_BRUSHES).contains(count));
    count.ok_or_else(|| format!("expected a whole number from 1 to {MAX_BRUSHES}"))
}

fn parse_distance(text: &str) -> Result<f64, String> {
    let distance = text.parse().ok().filter(|distance| *distance > 0.0 && *distance <= 1e30);
    distance.ok_or_else(|| "expected a number above 0, at most 1e30".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_are_names_and_finite_numbers() {
        assert_eq!(parse_setting("width = -1.5e2"), Ok(("width".to_owned(), -150.0)));
        for text in ["", "width", "width=", "=1", "width=wide", "width=nan", "width=1e999", "width==1"] {
            assert!(parse_setting(text).is_err(), "{text}");
        }
    }
}
