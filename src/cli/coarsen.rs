//! `planecut coarsen`: few convex cells for a solid or a convex decomposition.

use std::borrow::Cow;
use std::path::PathBuf;
use std::time::Instant;

use planecut::csg::coarsen::{Bounded, CoarsenOptions, Coarsened};
use planecut::csg::{Brush, EvaluateError, Material, MaterialId, Mesh, Model, Tree, evaluate};
use planecut::enclosing::{EncloseError, enclosed};
use planecut::export::{Collider, ExportOptions, Format, PhysicsFormat, distinct_color};
use planecut::import::Warning;
use planecut::import::mesh::{MeshImport, PartsImport, read_parts};
use planecut::kernel::DVec3;
use planecut::reading::FileKind;

use super::args::CoarsenArgs;
use super::error::{CliError, Done};
use super::input::Input;
use super::output::{MeshTarget, Output, OutputFormat, Target, check_targets};
use super::pieces::{NUMBER, bounded_tree, no_cells, of_cells};
use super::product::{Contents, Product, draw, encode, produce};
use super::progress::Progress;
use super::report::{CoarsenPart, milliseconds};
use super::rigid_body::{Body, BodyTarget, colliders};
use super::solve::{Read, Solved, read, solve_read};
use super::surface::{NoSolid, Triangles};
use super::written_cells::{Numbers, Request, WrittenCells, meters};

/// What cells are made of.
enum Shape {
    /// A solid; its cells must hold points that rounding may have left outside.
    Solid { points: Vec<DVec3> },
    /// Triangles that bound no solid.
    Surface(Triangles),
}

/// What is to be written where.
struct Plan<'a> {
    args: &'a CoarsenArgs,
    input: Input,
    kind: FileKind,
    /// The first output: the report says what it holds.
    first: Option<MeshTarget>,
    /// Where all cells go together.
    meshes: Vec<MeshTarget>,
    /// Where each goes alone: names in which its number stands for `{}`.
    patterns: Vec<MeshTarget>,
    /// Where they are the colliders of a body.
    bodies: Vec<BodyTarget>,
    /// A pattern for the names of cells.
    name: String,
    clear: Vec<(Input, FileKind)>,
    preview: Option<Target>,
    report: Option<Target>,
}

/// Runs the command: everything is complete before the first file gets its name.
///
/// # Errors
/// Any [`CliError`] but those of `check` and `edit`.
pub(crate) fn run(args: &CoarsenArgs) -> Result<Done, CliError> {
    let begin = Instant::now();
    let plan = Plan::resolve(args)?;
    let product = produce(&args.common, &plan.input, plan.report.as_ref(), begin, |progress| plan.carry_out(progress));
    product.map(|warnings| Done::with(&warnings, args.reading.allow_loss))
}

impl<'a> Plan<'a> {
    fn resolve(args: &'a CoarsenArgs) -> Result<Self, CliError> {
        let (input, kind) = Input::resolve_any(&args.input, args.reading.input_format)?;
        args.reading.check(kind)?;
        if (args.surface.shell || args.surface.solid) && !matches!(kind, FileKind::Mesh(_)) {
            let message =
                "found --shell or --solid with another input, expected it with a mesh (.obj, .stl, .ply, .glb, .gltf)";
            return Err(CliError::Usage(message.to_owned()));
        }
        args.output.assets.check_without_sources()?;
        let targets = args.output.all_targets()?;
        let first = targets.first().cloned();
        let name = cell_name(args, &targets, &input);
        let (bodies, targets): (Vec<MeshTarget>, Vec<MeshTarget>) =
            targets.into_iter().partition(|place| matches!(place.format, OutputFormat::Physics(_)));
        let bodies = bodies.into_iter().map(body_target).collect::<Result<_, _>>()?;
        let (patterns, meshes) = targets.into_iter().partition(|mesh| pattern_of(mesh).is_some());
        let clear = |path: &PathBuf| Input::resolve_any(path, None);
        let plan = Self {
            args,
            input,
            kind,
            first,
            meshes,
            patterns,
            bodies,
            name,
            clear: args.limits.keep_clear.iter().map(clear).collect::<Result<_, _>>()?,
            preview: args.picture.preview.as_deref().map(Target::picture).transpose()?,
            report: args.output.report.as_deref().map(Target::new),
        };
        let meshes: Vec<Target> = plan.meshes.iter().flat_map(MeshTarget::targets).collect();
        let bodies = plan.bodies.iter().map(|place| &place.target);
        plan.check(&meshes.iter().chain(bodies).chain(&plan.preview).collect::<Vec<_>>())?;
        Ok(plan)
    }

    /// Sees that outputs and report replace none of the inputs, nor each other.
    fn check(&self, outputs: &[&Target]) -> Result<(), CliError> {
        let inputs = self.clear.iter().map(|(input, _)| input).chain([&self.input]);
        // standard input is no file, and outputs must differ all the same
        for file in inputs.map(Input::file) {
            check_targets(file, outputs.iter().copied().chain(&self.report))?;
        }
        Ok(())
    }

    fn carry_out(&self, progress: &Progress) -> Result<Product, CliError> {
        let begin = Instant::now();
        progress.stage("reading");
        let (clear, warnings) = self.read_clear()?;
        let (mut solved, shape) = self.solve(warnings, begin, progress)?;
        progress.stage("coarsening");
        let begin = Instant::now();
        let (coarsened, bounded) =
            self.coarsen(&solved, &shape, &self.args.limits.options(clear, &self.args.engine))?;
        let time = begin.elapsed();
        let cells = self.cells(&coarsened, &solved)?;
        let body = self.body(&coarsened, &solved, &shape)?;
        let colliders = self.colliders(&cells);
        let mut part = CoarsenPart::new(&coarsened, bounded, time).for_engine(self.args.engine.engine());
        if let Some(body) = &body {
            let boxes = colliders.iter().filter(|collider| collider.cuboid.is_some()).count();
            part = part.with_body(boxes, body.told());
        }
        self.tell(&mut solved, part, &coarsened, &cells);
        let is_mjcf = self.bodies.iter().any(|place| place.format == PhysicsFormat::Mjcf);
        if let Some(doubt) = body.as_ref().filter(|_| is_mjcf).and_then(Body::doubt) {
            solved.report.warn(std::slice::from_ref(&doubt));
            solved.warnings.push(doubt);
        }
        solved.report.time_ms.evaluate += milliseconds(begin.elapsed());
        let begin = Instant::now();
        progress.stage("encoding");
        let mut outputs = self.encode(&cells, &solved)?;
        if let Some(body) = &body {
            outputs.extend(body.encode(&colliders, &self.bodies, &stem_of(&self.input))?);
        }
        let encoding = begin.elapsed();
        if let Some(target) = &self.preview {
            let drawing = Instant::now();
            progress.stage("drawing");
            let union = in_colors(&coarsened).map_err(|source| CliError::of_evaluation(&self.input.path, source))?;
            outputs.push(draw(&union.into(), target, &self.args.picture.options())?);
            solved.report.time_ms.preview = milliseconds(drawing.elapsed());
        }
        // the names of single cells are known by now
        self.check(&outputs.iter().map(Output::target).collect::<Vec<_>>())?;
        Ok(Product { warnings: solved.warnings, report: Some(solved.report), outputs, encoding })
    }

    /// The solid, and what its cells are to be made of. `warnings` are those about other files.
    fn solve(&self, warnings: Vec<Warning>, begin: Instant, progress: &Progress) -> Result<(Solved, Shape), CliError> {
        let CoarsenArgs { reading, surface, limits, .. } = self.args;
        let FileKind::Mesh(format) = self.kind else {
            let mut read = read(&self.input, self.kind, reading)?;
            read.warnings.extend(warnings);
            let solved = solve_read(&self.input, self.kind, read, begin.elapsed(), progress)?;
            return Ok((solved, Shape::Solid { points: Vec::new() }));
        };
        let triangles = |why: Option<NoSolid>, warnings: Vec<Warning>| {
            let (triangles, mut solved) =
                Triangles::read(&self.input, format, reading, *surface, limits.min_thickness, why, begin)?;
            solved.report.warn(&warnings);
            solved.warnings.extend(warnings);
            Ok((solved, Shape::Surface(triangles)))
        };
        if surface.shell {
            return triangles(None, warnings);
        }
        let parts = read_parts(&self.input.read()?, format, &self.input.name(), &reading.solid_options());
        match parts {
            Ok(PartsImport { import: MeshImport { model, warnings: own, .. }, points }) => {
                let warnings: Vec<Warning> = own.into_iter().chain(warnings).collect();
                let read = Read { model, warnings: warnings.clone(), ..Read::default() };
                let solved = solve_read(&self.input, self.kind, read, begin.elapsed(), progress)?;
                if solved.mesh.triangles.is_empty() && !limits.inner {
                    return triangles(Some(NoSolid::empty()), warnings);
                }
                Ok((solved, Shape::Solid { points }))
            }
            Err(error) => match NoSolid::of_error(&error) {
                Some(why) if !limits.inner => triangles(Some(why), warnings),
                _ => Err(error.into()),
            },
        }
    }

    /// The union of what is to be kept clear, and the warnings about it, which name the file.
    fn read_clear(&self) -> Result<(Option<Tree>, Vec<Warning>), CliError> {
        let (mut trees, mut warnings) = (Vec::new(), Vec::new());
        for (input, kind) in &self.clear {
            let read = read(input, *kind, &self.args.reading.of_any_kind())?;
            trees.push(of_cells(&input.path, &read.model.tree)?.into_owned());
            let in_file =
                |warning: Warning| Warning { line: 0, message: format!("{}: {warning}", input.name()), ..warning };
            warnings.extend(read.warnings.into_iter().map(in_file));
        }
        Ok(((!trees.is_empty()).then(|| Tree::union(trees)), warnings))
    }

    /// The cells, and what a surface bounds, where they were made of one.
    fn coarsen(
        &self,
        solved: &Solved,
        shape: &Shape,
        options: &CoarsenOptions,
    ) -> Result<(Coarsened, Option<Bounded>), CliError> {
        let failed = |source| CliError::Coarsen { path: self.input.path.clone(), source };
        let points = match shape {
            Shape::Surface(triangles) => {
                let coarsened = triangles.coarsened(options).map_err(failed)?;
                return Ok((coarsened, Some(triangles.bounded())));
            }
            Shape::Solid { points } => points,
        };
        let tree = bounded_tree(self.kind, solved);
        enclosed(&tree, &solved.mesh, points, options).map_err(|error| match error {
            EncloseError::Coarsen(source) => failed(source),
            EncloseError::Cells(source) => no_cells(&self.input.path, source),
        })
    }

    /// The cells as each of the formats holds them that are asked for.
    fn cells(&self, coarsened: &Coarsened, solved: &Solved) -> Result<WrittenCells, CliError> {
        // double precision where the first output holds planes, and for what is thinner than rounding among these
        let first = self.first.as_ref().and_then(|place| Numbers::of(place.format));
        let formats = [first.unwrap_or(Numbers::In(Format::Obj)), Numbers::In(Format::Obj)];
        let places = || self.meshes.iter().chain(&self.patterns);
        let formats = formats.into_iter().chain(places().filter_map(|place| Numbers::of(place.format)));
        let formats = formats.chain(self.bodies.first().map(|_| Numbers::Meters));
        let limits = self.args.limits.options(None, &self.args.engine);
        let request = Request {
            materials: &solved.model.materials,
            name: &self.name,
            encloses: !self.args.limits.inner,
            max_vertices: limits.max_vertices,
            options: self.options(),
            has_bodies: places().any(|place| matches!(place.format, OutputFormat::Brushes(_) | OutputFormat::Model)),
            is_single: self.args.engine.engine().is_some(),
        };
        WrittenCells::of(&coarsened.cells, formats, &request)
            .map_err(|source| CliError::Coarsen { path: self.input.path.clone(), source })
    }

    /// What the colliders belong to, where that is asked for.
    fn body(&self, coarsened: &Coarsened, solved: &Solved, shape: &Shape) -> Result<Option<Body>, CliError> {
        if self.bodies.is_empty() {
            return Ok(None);
        }
        let materials = &solved.model.materials;
        let (visual, is_closed) = match shape {
            Shape::Solid { .. } => (solved.mesh.clone(), true),
            Shape::Surface(triangles) => (triangles.mesh(materials), false),
        };
        let measures = (meters(&self.options()), self.args.engine.density);
        Body::new(visual, is_closed, coarsened, materials, measures, &self.input.path).map(Some)
    }

    /// The cells as colliders of a body, where that is asked for.
    fn colliders<'b>(&self, cells: &'b WrittenCells) -> Vec<Collider<'b>> {
        match self.bodies.first() {
            Some(place) => colliders(cells.in_format(OutputFormat::Physics(place.format)).0),
            None => Vec::new(),
        }
    }

    /// Tells the report and, where cells could not become so few, warns.
    fn tell(&self, solved: &mut Solved, part: CoarsenPart, coarsened: &Coarsened, cells: &WrittenCells) {
        solved.report.set_coarsen(part, cells.measured());
        if let Some(asked) = self.args.limits.max_cells.filter(|asked| coarsened.cells.len() > *asked) {
            let found = coarsened.cells.len();
            let message =
                format!("found no way to fewer than {found} cells within the other limits, {asked} were asked for");
            let warning = Warning::note(0, message);
            solved.report.warn(std::slice::from_ref(&warning));
            solved.warnings.push(warning);
        }
    }

    fn options(&self) -> ExportOptions {
        ExportOptions { convex_colliders: true, ..self.args.output.assets.options(self.args.output.scale) }
    }

    fn encode(&self, cells: &WrittenCells, solved: &Solved) -> Result<Vec<Output>, CliError> {
        let materials = &solved.model.materials;
        let mut outputs = Vec::new();
        for mesh in &self.meshes {
            let (pieces, options) = cells.in_format(mesh.format);
            let model = || Cow::Owned(union_of(cells.bodies(), pieces.iter().map(|(name, _)| name), materials));
            let brushes = || Ok(cells.bodies().to_vec());
            let contents = Contents { parts: &pieces.as_parts(&[]), materials, brushes: &brushes, model: &model };
            outputs.extend(encode(&contents, std::slice::from_ref(mesh), options)?);
        }
        for mesh in &self.patterns {
            let pattern = pattern_of(mesh).unwrap_or_default();
            let (pieces, options) = cells.in_format(mesh.format);
            for (number, (part, body)) in pieces.as_parts(&[]).iter().zip(cells.bodies()).enumerate() {
                let target = Target::File(PathBuf::from(pattern.replace(NUMBER, &number.to_string())));
                let body = std::slice::from_ref(body);
                let model = || Cow::Owned(union_of(body, [part.name].into_iter(), materials));
                let contents = Contents { parts: &[*part], materials, brushes: &|| Ok(body.to_vec()), model: &model };
                outputs.extend(encode(&contents, &[MeshTarget::alone(target, mesh.format)], options)?);
            }
        }
        Ok(outputs)
    }
}

/// The union of cells with names, in which they keep their materials.
fn union_of<'a>(cells: &[Brush], names: impl Iterator<Item = &'a str>, materials: &[Material]) -> Model {
    let named = cells.iter().zip(names).map(|(cell, name)| Brush { name: Some(name.to_owned()), ..cell.clone() });
    Model { materials: materials.to_vec(), tree: Tree::union_of(named.collect()) }
}

/// The union of cells, each in a colour of its own; of faces that overlap, one is seen.
fn in_colors(coarsened: &Coarsened) -> Result<Mesh, EvaluateError> {
    let colored = |(number, cell): (u32, &Brush)| Tree::from(cell.clone()).with_material(MaterialId(number));
    let tree = Tree::union((0..).zip(&coarsened.cells).map(colored));
    let material = |number| Material { color: Some(distinct_color(number)), ..Material::named(format!("{number:09}")) };
    Ok(evaluate(&Model { materials: (0..coarsened.cells.len()).map(material).collect(), tree })?.mesh)
}

/// The pattern for the names of cells: what is asked for, what an engine wants, or a plain one.
fn cell_name(args: &CoarsenArgs, targets: &[MeshTarget], input: &Input) -> String {
    let wanted = || {
        let stem = targets.iter().find_map(|place| place.target.stem()).unwrap_or_else(|| stem_of(input));
        Some(args.engine.limits()?.name?.replace("{stem}", &stem.replace(NUMBER, "")))
    };
    args.name.clone().or_else(wanted).unwrap_or_else(|| "cell {}".to_owned())
}

/// The name of an input without its ending.
fn stem_of(input: &Input) -> String {
    match input.path.file_stem() {
        Some(stem) if input.file().is_some() => stem.to_string_lossy().into_owned(),
        _ => "body".to_owned(),
    }
}

/// The place of a rigid body, which holds all cells.
fn body_target(place: MeshTarget) -> Result<BodyTarget, CliError> {
    if let Some(name) = pattern_of(&place) {
        let message = format!(
            "{name}: found {NUMBER} in the name of a rigid body, expected one name: all cells are its colliders"
        );
        return Err(CliError::Usage(message));
    }
    let OutputFormat::Physics(format) = place.format else { unreachable!("only rigid bodies have such places") };
    Ok(BodyTarget { target: place.target, format })
}

/// The name of a place for single cells.
fn pattern_of(mesh: &MeshTarget) -> Option<&str> {
    match &mesh.target {
        Target::File(path) => path.to_str().filter(|name| name.contains(NUMBER)),
        Target::Stdout => None,
    }
}
