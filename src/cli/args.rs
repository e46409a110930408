//! The arguments of every command. The doc comments here are the help texts.

use std::ffi::OsString;
use std::path::PathBuf;

use clap::error::ErrorKind;
use clap::{Args, CommandFactory, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;
use planecut::csg::Tree;
use planecut::csg::coarsen::{CoarsenOptions, DEFAULT_OVERLAP_WEIGHT, LEAST_MAX_FACES, LEAST_MAX_VERTICES, Side};
use planecut::picture::{MAX_IMAGE_SIDE, PreviewOptions};

use super::asset_args::AssetArgs;
use super::batch::BatchArgs;
use super::engine_args::EngineArgs;
use super::error::CliError;
use super::output::{MeshTarget, OutputFormat};
use super::reading_args::ReadingArgs;
use super::render::RenderArgs;
use super::terminal;
use super::view::ViewArgs;

/// Convex-CSG modeling kernel: exact half-spaces in, watertight meshes out.
#[derive(Debug, Parser)]
#[command(name = "planecut", version, arg_required_else_help = false, subcommand_required = true)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

/// One variant for each command.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Evaluate a model or a map and write its boundary as a mesh
    Build(BuildArgs),
    /// Print what a file holds as JSON: the report that `build` would write
    Info(InfoArgs),
    /// Render a model or a map as a picture
    Render(RenderArgs),
    /// Apply edits to a model incrementally and write the result
    Edit(EditArgs),
    /// Reduce a solid or a convex decomposition to few convex cells within an error bound, for colliders
    Coarsen(CoarsenArgs),
    /// Show a file in the editor, in a browser, and again when it changes
    View(ViewArgs),
    /// Do many jobs, each in a process with its limits; what is up to date or in the cache is not made again
    Batch(BatchArgs),
    /// Check that a mesh is watertight, manifold and not self-crossing; exit status 1 if not
    Check(CheckArgs),
    /// Print the JSON Schema of the model file
    Schema,
    /// Print a script that completes commands and options in a shell
    Completions(CompletionsArgs),
    /// Print the manual page of the program or of a command, or write all of them
    Man(ManArgs),
}

/// Arguments of `build`.
#[derive(Debug, Args)]
#[command(mut_arg("outputs", |outputs| outputs.required(false).required_unless_present("tiles")))]
pub(crate) struct BuildArgs {
    /// The model, map, tree or closed mesh to read (.json, .map, .csg, .obj, .stl, .ply, .glb, .gltf); several, of any kinds, with --combine; `-` is standard
    /// input
    #[arg(value_name = "INPUT", required = true)]
    pub(crate) inputs: Vec<PathBuf>,
    /// How to combine several inputs; `difference` takes all others from the first one
    #[arg(long, value_enum, value_name = "OPERATION")]
    pub(crate) combine: Option<Combine>,
    #[command(flatten)]
    pub(crate) output: OutputArgs,
    /// Write the convex cells of the solid, one mesh each, instead of its boundary
    #[arg(long)]
    pub(crate) cells: bool,
    /// Write each named part as a solid of its own, instead of their union
    #[arg(long, conflicts_with = "cells")]
    pub(crate) parts: bool,
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
    #[command(flatten)]
    pub(crate) blocks: BlockArgs,
    #[command(flatten)]
    pub(crate) reading: ReadingArgs,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

/// Block by block.
#[derive(Debug, Args)]
#[command(next_help_heading = "Models larger than memory")]
pub(crate) struct BlockArgs {
    /// Evaluate block by block, of about N brushes each [default: 8192]: memory holds one block for each thread, whatever the size of the model. Of convex bodies alone; maps and copies in model files are read as a stream.
    /// Outputs may be .glb, .gltf, .obj, .stl and .ply
    #[arg(long, value_name = "N", num_args = 0..=1, require_equals = true, value_parser = parse_count::<1>, conflicts_with_all = ["cells", "parts", "combine", "preview"])]
    pub(crate) blocks: Option<Option<usize>>,
    /// Where blocks and their meshes are kept: what is up to date there is not evaluated again. By default a temporary folder, which takes about 1 GB for a million boxes
    #[arg(long, value_name = "DIR")]
    pub(crate) work_dir: Option<PathBuf>,
    /// Write a tile set (3D Tiles 1.1) to this folder, with coarser levels for what is far away; implies --blocks
    #[arg(long, value_name = "DIR", conflicts_with_all = ["cells", "parts", "combine", "preview"])]
    pub(crate) tiles: Option<PathBuf>,
}

impl BlockArgs {
    /// Whether the model is evaluated block by block.
    pub(crate) fn are_asked_for(&self) -> bool {
        self.blocks.is_some() || self.tiles.is_some()
    }
}

/// How several inputs become one solid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Combine {
    /// What lies in any of them
    Union,
    /// What lies in the first one and in no other
    Difference,
    /// What lies in all of them
    Intersection,
    /// What lies in an odd number of them
    Xor,
}

/// Where meshes and the report go.
#[derive(Debug, Args)]
pub(crate) struct OutputArgs {
    /// Output file: a mesh (.glb, .gltf, .obj, .stl, .3mf or .ply), convex bodies (.map or .csg) or the model with its tree of operations (.json); may be given several times; `-` is standard output. With `coarsen`
    /// also a rigid body for a physics engine (.xml: MJCF, .urdf or .usda), and a name with `{}` writes a file for each cell, `{}` standing for its number
    #[arg(short, long = "output", value_name = "OUT", required = true, num_args = 1)]
    pub(crate) outputs: Vec<PathBuf>,
    /// Format of `-o -`: glb, gltf, obj, stl, 3mf, ply, map, csg or json; with `coarsen` also usda
    #[arg(long, value_name = "FORMAT", value_parser = parse_format)]
    pub(crate) format: Option<OutputFormat>,
    /// Factor from the input's units to those of the outputs
    #[arg(long, value_name = "S", default_value_t = 1.0, value_parser = parse_scale)]
    pub(crate) scale: f64,
    /// Also write a report as JSON: counts, measures and times
    #[arg(long, value_name = "JSON")]
    pub(crate) report: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) assets: AssetArgs,
}

impl OutputArgs {
    /// The places of meshes, convex bodies and models.
    ///
    /// # Errors
    /// As [`MeshTarget::resolve_all`], and [`CliError::Usage`] for a rigid body.
    pub(crate) fn targets(&self) -> Result<Vec<MeshTarget>, CliError> {
        let targets = self.all_targets()?;
        match targets.iter().find(|place| matches!(place.format, OutputFormat::Physics(_))) {
            Some(MeshTarget { target, .. }) => Err(CliError::Usage(format!(
                "{target}: found a rigid body as the output of another command, expected it of coarsen, which makes convex colliders"
            ))),
            None => Ok(targets),
        }
    }

    /// The places of meshes, convex bodies, models and rigid bodies.
    ///
    /// # Errors
    /// As [`MeshTarget::resolve_all`].
    pub(crate) fn all_targets(&self) -> Result<Vec<MeshTarget>, CliError> {
        MeshTarget::resolve_all(&self.outputs, self.format, self.assets.mtl)
    }
}

/// A picture beside the meshes.
#[derive(Debug, Args)]
pub(crate) struct PictureArgs {
    /// Also render a picture (.png); `coarsen` gives each cell a colour of its own
    #[arg(long, value_name = "PNG")]
    pub(crate) preview: Option<PathBuf>,
    /// Size of the picture in pixels
    #[arg(long, value_name = "WxH", default_value = "1280x960", value_parser = parse_size)]
    preview_size: Size,
}

impl PictureArgs {
    /// How to draw it.
    pub(crate) fn options(&self) -> PreviewOptions {
        self.preview_size.preview()
    }
}

/// Arguments of `info`.
#[derive(Debug, Args)]
pub(crate) struct InfoArgs {
    /// The file to examine (.json, .map, .csg, .obj, .stl, .ply, .glb, .gltf); `-` is standard input
    #[arg(value_name = "INPUT")]
    pub(crate) input: PathBuf,
    #[command(flatten)]
    pub(crate) reading: ReadingArgs,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

/// Arguments of `edit`.
#[derive(Debug, Args)]
#[command(mut_arg("outputs", |outputs| outputs.required(false).required_unless_present("serve")))]
pub(crate) struct EditArgs {
    /// The model, map, tree or closed mesh to begin with (.json, .map, .csg, .obj, .stl, .ply, .glb, .gltf); `-` is standard input
    #[arg(value_name = "INPUT")]
    pub(crate) input: PathBuf,
    /// The edits, one JSON object a line
    #[arg(value_name = "EDITS.jsonl", required_unless_present = "serve")]
    pub(crate) edits: Option<PathBuf>,
    /// Read edits and queries from standard input, a JSON object a line, and answer each by a line on standard output, until the input ends
    #[arg(long, conflicts_with_all = ["edits", "outputs", "report", "verify", "format"])]
    pub(crate) serve: bool,
    #[command(flatten)]
    pub(crate) output: OutputArgs,
    /// After each edit, compare the mesh with that of a fresh build of the edited model
    #[arg(long)]
    pub(crate) verify: bool,
    #[command(flatten)]
    pub(crate) reading: ReadingArgs,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

/// Arguments of `coarsen`.
#[derive(Debug, Args)]
pub(crate) struct CoarsenArgs {
    /// The model, map, tree, closed mesh or convex decomposition to read (.json, .map, .csg, .obj, .stl, .ply, .glb, .gltf); `-` is standard input
    #[arg(value_name = "INPUT")]
    pub(crate) input: PathBuf,
    #[command(flatten)]
    pub(crate) output: OutputArgs,
    /// Names of the cells, `{}` standing for their numbers; by default `cell {}`, or what --engine wants
    #[arg(long, value_name = "PATTERN")]
    pub(crate) name: Option<String>,
    #[command(flatten)]
    pub(crate) engine: EngineArgs,
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
    #[command(flatten)]
    pub(crate) limits: CoarsenLimits,
    #[command(flatten)]
    pub(crate) surface: SurfaceArgs,
    #[command(flatten)]
    pub(crate) reading: ReadingArgs,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

/// What a mesh bounds.
#[derive(Debug, Clone, Copy, Args)]
#[command(
    next_help_heading = "What a mesh bounds; by default what is inside of it, and nothing where it is not closed"
)]
pub(crate) struct SurfaceArgs {
    /// Enclose the triangles alone, each as thick as --min-thickness says, by default 1/512 of the diagonal; this is how a mesh is taken that is not closed or bounds nothing
    #[arg(long, conflicts_with = "inner")]
    pub(crate) shell: bool,
    /// Fill a mesh that is not closed: inside is what it goes around by more than half (generalized winding numbers)
    #[arg(long, conflicts_with_all = ["shell", "inner"])]
    pub(crate) solid: bool,
}

/// Limits on cells.
#[derive(Debug, Args)]
#[command(next_help_heading = "Limits; without any, cells are merged as long as that adds no volume")]
pub(crate) struct CoarsenLimits {
    /// Maximum number of cells; a number that is not below the present one changes nothing
    #[arg(long, value_name = "N", value_parser = parse_count::<1>)]
    pub(crate) max_cells: Option<usize>,
    /// Maximum added volume, relative to that of the solid (0.1: a tenth); takes precedence over --max-cells
    #[arg(long, value_name = "R", value_parser = parse_ratio)]
    pub(crate) max_excess: Option<f64>,
    /// Maximum number of faces of a cell, 6 or more
    #[arg(long, value_name = "N", value_parser = parse_count::<LEAST_MAX_FACES>)]
    pub(crate) max_faces: Option<usize>,
    /// Maximum number of vertices of a cell, 8 or more
    #[arg(long, value_name = "N", value_parser = parse_count::<LEAST_MAX_VERTICES>)]
    pub(crate) max_vertices: Option<usize>,
    /// A solid that cells must not grow into, such as door and window openings, in the units of the input; may be given several times
    #[arg(long, value_name = "FILE", num_args = 1)]
    pub(crate) keep_clear: Vec<PathBuf>,
    /// Keep clear what a ball of this radius can reach from outside, such as rooms behind doors, or the inside of a mug, even if more cells are left then; in the units of the input
    #[arg(long, value_name = "R", value_parser = parse_radius)]
    pub(crate) clear_radius: Option<f64>,
    /// Do not merge cells of different materials
    #[arg(long)]
    pub(crate) by_material: bool,
    /// Minimum thickness of a cell, in the units of the input; thinner cells are thickened
    #[arg(long, value_name = "T", value_parser = parse_thickness)]
    pub(crate) min_thickness: Option<f64>,
    /// How much volume that cells share counts, relative to volume that is added: more for cells that overlap less
    #[arg(long, value_name = "W", default_value_t = DEFAULT_OVERLAP_WEIGHT, value_parser = parse_weight)]
    pub(crate) overlap_weight: f64,
    /// Maximum empty distance between parts of one cell, in the units of the input, about, even if more cells are left then; by default 1/20 of the diagonal, as long
    /// as there are other parts to merge
    #[arg(long, value_name = "D", value_parser = parse_thickness)]
    pub(crate) max_gap: Option<f64>,
    /// Cells within the solid instead of around it
    #[arg(long, conflicts_with_all = ["max_faces", "max_vertices", "min_thickness", "keep_clear", "clear_radius"])]
    pub(crate) inner: bool,
}

impl CoarsenLimits {
    /// The same as the library wants it, with the caps of an engine where there are no others.
    pub(crate) fn options(&self, keep_clear: Option<Tree>, engine: &EngineArgs) -> CoarsenOptions {
        CoarsenOptions {
            max_cells: self.max_cells,
            max_excess: self.max_excess,
            max_faces: self.max_faces.or_else(|| engine.limits()?.max_faces),
            max_vertices: self.max_vertices.or_else(|| engine.limits()?.max_vertices),
            keep_clear,
            clear_radius: self.clear_radius,
            by_material: self.by_material,
            min_thickness: self.min_thickness,
            side: if self.inner { Side::Inner } else { Side::Outer },
            overlap_weight: Some(self.overlap_weight),
            max_gap: self.max_gap,
        }
    }
}

/// Arguments of `check`.
#[derive(Debug, Args)]
pub(crate) struct CheckArgs {
    /// The mesh to check (.obj, .stl, .ply, .glb, .gltf)
    #[arg(value_name = "MESH")]
    pub(crate) mesh: PathBuf,
    /// Depth up to which crossings count as touching, relative to the size of the mesh; by default it follows the precision of the format
    #[arg(long, value_name = "T", value_parser = parse_tolerance)]
    pub(crate) tolerance: Option<f64>,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

/// Arguments of `completions`.
#[derive(Debug, Args)]
pub(crate) struct CompletionsArgs {
    /// The shell
    #[arg(value_enum, value_name = "SHELL")]
    pub(crate) shell: Shell,
}

/// Arguments of `man`.
#[derive(Debug, Args)]
pub(crate) struct ManArgs {
    /// The command to describe; by default the program as a whole
    #[arg(value_name = "COMMAND")]
    pub(crate) command: Option<String>,
    /// Write all pages to this folder instead: planecut.1, planecut-build.1, …
    #[arg(long, value_name = "DIR", conflicts_with = "command")]
    pub(crate) dir: Option<PathBuf>,
}

/// What every command takes.
#[derive(Debug, Args)]
#[command(next_help_heading = "General options")]
pub(crate) struct CommonArgs {
    /// Number of threads, 1 to 1024; by default as many as there are cores
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    /// Print no warnings and no progress to standard error
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

/// Width and height of a picture in pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Size {
    width: u32,
    height: u32,
}

/// Maximum number of pixels of a picture: drawing takes about 40 bytes for each.
const MAX_PIXELS: u64 = 1 << 26;

impl Size {
    /// Where nothing else is asked for.
    pub(crate) const DEFAULT: Self = Self { width: 1280, height: 960 };

    /// The same for turntables, which hold many pictures.
    pub(crate) const TURNTABLE: Self = Self { width: 640, height: 480 };

    /// How to draw a picture of this size.
    pub(crate) fn preview(self) -> PreviewOptions {
        PreviewOptions { width: self.width, height: self.height, ..PreviewOptions::default() }
    }
}

/// The program's arguments as the parser sees them.
pub(crate) fn command() -> clap::Command {
    Cli::command()
}

/// The command to run; `None` where help or the version was asked for and printed.
pub(crate) fn parse(arguments: &[OsString]) -> Result<Option<Command>, CliError> {
    match Cli::try_parse_from(arguments) {
        Ok(cli) => Ok(Some(cli.command)),
        Err(error) if matches!(error.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion) => {
            terminal::print_text(&error.render().to_string())?;
            Ok(None)
        }
        Err(error) => Err(CliError::Usage(in_one_line(&error.render().to_string()))),
    }
}

/// The parser's message and its tips, without the usage text that follows.
fn in_one_line(message: &str) -> String {
    let message = message.strip_prefix("error: ").unwrap_or(message);
    let paragraphs = message.split("\n\n").map(|paragraph| paragraph.split_whitespace().collect::<Vec<_>>().join(" "));
    let told = paragraphs.enumerate().filter(|(place, text)| *place == 0 || text.starts_with("tip: "));
    told.map(|(_, text)| text).collect::<Vec<_>>().join("; ")
}

fn parse_format(text: &str) -> Result<OutputFormat, String> {
    OutputFormat::from_extension(text)
        .ok_or_else(|| "expected glb, gltf, obj, stl, 3mf, ply, map, csg, json or usda".to_owned())
}

fn parse_scale(text: &str) -> Result<f64, String> {
    let scale = text.parse().ok().filter(|scale| (1e-30..=1e30).contains(scale));
    scale.ok_or_else(|| "expected a number between 1e-30 and 1e30".to_owned())
}

fn parse_tolerance(text: &str) -> Result<f64, String> {
    let tolerance = text.parse().ok().filter(|tolerance| (0.0..=1.0).contains(tolerance));
    tolerance.ok_or_else(|| "expected a number between 0 and 1".to_owned())
}

fn parse_count<const LEAST: usize>(text: &str) -> Result<usize, String> {
    let count = text.parse().ok().filter(|count| *count >= LEAST);
    count.ok_or_else(|| format!("expected a whole number, at least {LEAST}"))
}

fn parse_ratio(text: &str) -> Result<f64, String> {
    let ratio = text.parse().ok().filter(|ratio: &f64| ratio.is_finite() && *ratio >= 0.0);
    ratio.ok_or_else(|| "expected a number that is not negative".to_owned())
}

fn parse_weight(text: &str) -> Result<f64, String> {
    let weight = text.parse().ok().filter(|weight| (0.0..=1e6).contains(weight));
    weight.ok_or_else(|| "expected a number between 0 and 1e6".to_owned())
}

fn parse_thickness(text: &str) -> Result<f64, String> {
    let thickness = text.parse().ok().filter(|thickness| (0.0..=1e30).contains(thickness));
    thickness.ok_or_else(|| "expected a number between 0 and 1e30".to_owned())
}

fn parse_radius(text: &str) -> Result<f64, String> {
    let radius = text.parse().ok().filter(|radius| *radius > 0.0 && *radius <= 1e30);
    radius.ok_or_else(|| "expected a number above 0, up to 1e30".to_owned())
}

pub(crate) fn parse_size(text: &str) -> Result<Size, String> {
    let side = |text: &str| text.parse().ok().filter(|side| (1..=MAX_IMAGE_SIDE).contains(side));
    let size = text.split_once(['x', 'X']).and_then(|(width, height)| Some((side(width)?, side(height)?)));
    match size {
        Some((width, height)) if u64::from(width) * u64::from(height) <= MAX_PIXELS => Ok(Size { width, height }),
        _ => Err(format!(
            "expected WIDTHxHEIGHT, each from 1 to {MAX_IMAGE_SIDE}, with at most {MAX_PIXELS} pixels in all"
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_parser_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn sizes_have_two_sides_within_bounds() {
        assert_eq!(parse_size("640x480"), Ok(Size { width: 640, height: 480 }));
        for text in
            ["", "640", "640x", "x480", "0x1", "1x0", "-1x5", "1.5x2", "16385x1", "16384x16384", "1x2x3", "9e9x1"]
        {
            assert!(parse_size(text).is_err(), "{text}");
        }
    }

    #[test]
    fn numbers_that_are_no_scale_or_tolerance_are_refused() {
        assert_eq!((parse_scale("0.0254"), parse_tolerance("0")), (Ok(0.0254), Ok(0.0)));
        for text in ["0", "-1", "nan", "inf", "1e31", "", "x"] {
            assert!(parse_scale(text).is_err(), "{text}");
        }
        for text in ["-1e-9", "nan", "inf", "2", "", "x"] {
            assert!(parse_tolerance(text).is_err(), "{text}");
        }
    }

    #[test]
    fn every_message_of_the_parser_fits_on_a_line() {
        let commands: [&[&str]; 7] = [
            &[],
            &["buidl"],
            &["build"],
            &["build", "a.map"],
            &["build", "a.map", "-o", "a.glb", "--reprot", "r.json"],
            &["build", "a.map", "-o", "a.glb", "--threads", "0"],
            &["render", "a.map", "-o", "a.png", "--style", "sketch"],
        ];
        for command in commands {
            let error = Cli::try_parse_from([&["planecut"], command].concat()).expect_err("refused");
            let line = in_one_line(&error.render().to_string());
            assert!(!line.is_empty() && !line.contains('\n') && !line.contains("Usage"), "{line}");
        }
    }
}
