//! `planecut coarsen`: few convex cells for a solid or a convex decomposition.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use planecut::csg::coarsen::{CoarsenOptions, Coarsened, Coarsener};
use planecut::csg::{Brush, EvaluateError, Material, MaterialId, Mesh, Model, Tree, evaluate};
use planecut::export::{ExportOptions, Format, Part, render_preview};
use planecut::import::Warning;
use planecut::import::mesh::read_parts;
use planecut::kernel::DVec3;
use rayon::prelude::*;

use super::args::{CoarsenArgs, Style};
use super::cells::{Cells, NUMBER, without};
use super::error::CliError;
use super::input::{Input, InputKind};
use super::output::{MeshTarget, Target, check_targets};
use super::pool::on_threads;
use super::product::{Encoded, Product, encode};
use super::progress::Progress;
use super::report::{CoarsenPart, milliseconds};
use super::solve::{Solved, read, solve_read};

/// What is to be written where.
struct Plan<'a> {
    args: &'a CoarsenArgs,
    input: Input,
    kind: InputKind,
    /// Where all cells go together.
    meshes: Vec<MeshTarget>,
    /// Where each goes alone: names in which its number stands for `{}`.
    patterns: Vec<(String, Format)>,
    clear: Vec<(Input, InputKind)>,
    preview: Option<Target>,
    report: Option<Target>,
}

/// Runs the command: everything is encoded in memory before the first file is written.
///
/// # Errors
/// Any [`CliError`] but those of `check` and `edit`.
pub(crate) fn run(args: &CoarsenArgs) -> Result<(), CliError> {
    let begin = Instant::now();
    let plan = Plan::resolve(args)?;
    let progress = Progress::start(args.common.quiet);
    let product = on_threads(args.common.threads, || plan.carry_out(&progress))?;
    drop(progress);
    // the names of single cells are known by now
    check_targets(plan.input.file(), product.outputs.iter().map(|(target, _)| target).chain(&plan.report))?;
    product.write(&plan.input.name(), args.common.quiet, plan.report.as_ref(), begin)
}

impl<'a> Plan<'a> {
    fn resolve(args: &'a CoarsenArgs) -> Result<Self, CliError> {
        let (input, kind) = Input::resolve_any(&args.input, args.reading.input_format)?;
        args.reading.check(kind)?;
        let (patterns, whole): (Vec<&PathBuf>, Vec<&PathBuf>) = args.outputs.iter().partition(|path| is_pattern(path));
        let whole: Vec<PathBuf> = whole.into_iter().cloned().collect();
        let pattern = |path: &&PathBuf| match MeshTarget::resolve_all(&[(*path).clone()], None)?.as_slice() {
            [MeshTarget { format, .. }] => Ok((path.display().to_string(), *format)),
            _ => Err(CliError::Usage("found no format for a pattern, expected one".to_owned())),
        };
        let clear = |path: &PathBuf| Input::resolve_any(path, None);
        let plan = Self {
            args,
            input,
            kind,
            meshes: MeshTarget::resolve_all(&whole, args.format)?,
            patterns: patterns.iter().map(pattern).collect::<Result<_, _>>()?,
            clear: args.limits.keep_clear.iter().map(clear).collect::<Result<_, _>>()?,
            preview: args.preview.as_deref().map(Target::picture).transpose()?,
            report: args.report.as_deref().map(Target::new),
        };
        let files = || plan.clear.iter().map(|(input, _)| input).chain([&plan.input]).filter_map(Input::file);
        for file in files().map(Some).chain([None]) {
            let meshes = plan.meshes.iter().map(|mesh| &mesh.target);
            check_targets(file, meshes.chain(&plan.preview).chain(&plan.report))?;
        }
        Ok(plan)
    }

    fn carry_out(&self, progress: &Progress) -> Result<Product, CliError> {
        let begin = Instant::now();
        progress.stage("reading");
        let (model, warnings, points) = self.read()?;
        let clear = self.read_clear()?;
        let mut solved = solve_read(&self.input, self.kind, (model, warnings), begin.elapsed(), progress)?;
        progress.stage("coarsening");
        let begin = Instant::now();
        let coarsened = self.coarsen(&solved, &points, &self.args.limits.options(clear))?;
        let time = begin.elapsed();
        let cells = self.cells(&coarsened, &solved)?;
        self.tell(&mut solved, &coarsened, &cells, time);
        solved.report.time_ms.evaluate += milliseconds(begin.elapsed());
        let begin = Instant::now();
        progress.stage("encoding");
        let mut outputs = self.encode(&cells)?;
        let encoding = begin.elapsed();
        if let Some(target) = &self.preview {
            let drawing = Instant::now();
            progress.stage("drawing");
            let union = in_colors(&coarsened).map_err(|source| CliError::of_evaluation(&self.input.path, source))?;
            let picture = render_preview(&union, &self.args.preview_size.preview(Style::Shaded))
                .map_err(|source| CliError::Encode { output: target.to_string(), source })?;
            outputs.push((target.clone(), picture));
            solved.report.time_ms.preview = milliseconds(drawing.elapsed());
        }
        Ok(Product { solved, outputs, encoding })
    }

    /// The model, and the points that its cells must hold.
    fn read(&self) -> Result<(Model, Vec<Warning>, Vec<DVec3>), CliError> {
        if let InputKind::Mesh(format) = self.kind {
            let parts = read_parts(&self.input.read()?, format, &self.input.name())?;
            return Ok((parts.import.model, parts.import.warnings, parts.points));
        }
        let (model, warnings) = read(&self.input, self.kind, &self.args.reading)?;
        Ok((model, warnings, Vec::new()))
    }

    /// The union of what is to be kept clear.
    fn read_clear(&self) -> Result<Option<Tree>, CliError> {
        let tree =
            |(input, kind): &(Input, InputKind)| Ok(read(input, *kind, &self.args.reading.of_any_kind())?.0.tree);
        let trees: Vec<Tree> = self.clear.iter().map(tree).collect::<Result<_, CliError>>()?;
        Ok((!trees.is_empty()).then(|| Tree::union(trees)))
    }

    fn coarsen(&self, solved: &Solved, points: &[DVec3], options: &CoarsenOptions) -> Result<Coarsened, CliError> {
        let tree = match self.kind {
            InputKind::Map => &without(&solved.model, &solved.unbounded),
            InputKind::Json | InputKind::Csg | InputKind::Mesh(_) => &solved.model.tree,
        };
        let coarsened = Coarsener::new(tree, points, options).and_then(|coarsener| coarsener.coarsened());
        coarsened.map_err(|source| CliError::Coarsen { path: self.input.path.clone(), source })
    }

    /// The mesh of each cell.
    fn cells(&self, coarsened: &Coarsened, solved: &Solved) -> Result<Cells, CliError> {
        let mesh = |cell: &Brush| -> Result<Mesh, EvaluateError> {
            let model = Model { materials: solved.model.materials.clone(), tree: cell.clone().into() };
            Ok(evaluate(&model)?.mesh)
        };
        let meshes: Result<Vec<Mesh>, EvaluateError> = coarsened.cells.par_iter().map(mesh).collect();
        let mut meshes = meshes.map_err(|source| CliError::of_evaluation(&self.input.path, source))?;
        // what is thinner than rounding has none
        meshes.retain(|mesh| !mesh.triangles.is_empty());
        Ok(Cells::named(meshes, &self.args.name))
    }

    /// Tells the report and, where cells could not become so few, warns.
    fn tell(&self, solved: &mut Solved, coarsened: &Coarsened, cells: &Cells, time: Duration) {
        solved.report.set_coarsen(CoarsenPart::new(coarsened, time), cells.measured());
        if let Some(asked) = self.args.limits.max_cells.filter(|asked| coarsened.cells.len() > *asked) {
            let found = coarsened.cells.len();
            let message =
                format!("found no way to fewer than {found} cells within the other limits, {asked} were asked for");
            let warning = Warning { line: 0, message };
            solved.report.warnings.push(warning.to_string());
            solved.warnings.push(warning);
        }
    }

    fn encode(&self, cells: &Cells) -> Result<Vec<Encoded>, CliError> {
        let options = ExportOptions { scale: self.args.scale, convex_colliders: true };
        let parts = cells.parts();
        let mut outputs = encode(&parts, &self.meshes, &options)?;
        for (pattern, format) in &self.patterns {
            for (number, part) in parts.iter().enumerate() {
                let target = Target::File(PathBuf::from(pattern.replace(NUMBER, &number.to_string())));
                outputs.extend(encode(&[Part { ..*part }], &[MeshTarget { target, format: *format }], &options)?);
            }
        }
        Ok(outputs)
    }
}

/// The union of cells, each in a colour of its own; of faces that overlap, one is seen.
fn in_colors(coarsened: &Coarsened) -> Result<Mesh, EvaluateError> {
    let colored = |(number, cell): (u32, &Brush)| Tree::from(cell.clone()).with_material(MaterialId(number));
    let tree = Tree::union((0..).zip(&coarsened.cells).map(colored));
    let material = |number| Material { color: Some(color(number)), ..Material::named(format!("{number:09}")) };
    Ok(evaluate(&Model { materials: (0..coarsened.cells.len()).map(material).collect(), tree })?.mesh)
}

/// A colour for a number, linear RGB: hues that are far apart for numbers that follow one another.
fn color(number: usize) -> [f32; 3] {
    const GOLDEN_RATIO: f64 = 0.618_033_988_749_895;
    let hue = (number as f64 * GOLDEN_RATIO).fract();
    let lightness = [0.42, 0.3, 0.52][number % 3];
    [0.0, 2.0 / 3.0, 1.0 / 3.0].map(|offset| {
        let ramp = (((hue + offset).fract() * 6.0 - 3.0).abs() - 1.0).clamp(0.0, 1.0);
        (lightness + 0.42 * (ramp - 0.5)).clamp(0.02, 1.0) as f32
    })
}

fn is_pattern(path: &Path) -> bool {
    path.to_str().is_some_and(|name| name.contains(NUMBER))
}
