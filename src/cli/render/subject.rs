//! What `render` draws of an input: its mesh, its cells, or what is left of it where it is cut open.

use planecut::csg::{
    Cutaway, FaceSource, Material, MaterialId, Mesh, MeshFace, Model, Solid, Tree, evaluate, summarize,
};
use planecut::import::Warning;
use planecut::import::mesh::{IndexedMesh, MeshFormat, SolidOptions, read_mesh};
use planecut::kernel::DVec3;
use planecut::picture::{PreviewOptions, Subject};
use planecut::reading::FileKind;

use super::args::{IdKind, RenderArgs};
use crate::cli::error::CliError;
use crate::cli::input::Input;
use crate::cli::pieces::{bounded_tree_of, brush_meshes, of_cells};
use crate::cli::progress::Progress;
use crate::cli::solve::{read, solve};

/// What is to be drawn.
pub(super) struct Drawn {
    pub(super) subject: Subject<'static>,
    pub(super) warnings: Vec<Warning>,
    /// Where the faces of each material come from, where ids of brushes are asked for.
    pub(super) sources: Vec<FaceSource>,
}

impl Drawn {
    fn new(subject: Subject<'static>, warnings: Vec<Warning>) -> Self {
        Self { subject, warnings, sources: Vec::new() }
    }
}

/// Reads an input and makes what the arguments want to see of it.
///
/// # Errors
/// [`CliError`] for unusable input or a solid without a mesh.
pub(super) fn subject(
    input: &Input,
    kind: FileKind,
    args: &RenderArgs,
    options: &PreviewOptions,
    progress: &Progress,
) -> Result<Drawn, CliError> {
    let is_whole = args.section().is_none() && args.spread().is_none();
    let takes_as_it_is = args.reading.solid_options() == SolidOptions::default();
    match kind {
        // A mesh is drawn as it is, whether it bounds a solid or not.
        FileKind::Mesh(format) if is_whole && args.buffers.id_of != IdKind::Brush && takes_as_it_is => {
            progress.stage("reading");
            mesh_as_it_is(input, format)
        }
        _ if is_whole => {
            let splits = (args.buffers.ids.is_some() && args.buffers.id_of == IdKind::Brush).then_some(true);
            let solved = solve(input, kind, &args.reading, splits, false, progress)?;
            Ok(Drawn { subject: solved.mesh.into(), warnings: solved.warnings, sources: solved.sources })
        }
        _ => inside(input, kind, args, options, progress),
    }
}

fn mesh_as_it_is(input: &Input, format: MeshFormat) -> Result<Drawn, CliError> {
    let read = read_mesh(&input.read()?, format, &input.name())?;
    Ok(Drawn::new(drawable(read).into(), Vec::new()))
}

/// A mesh with a face for each of its triangles. Those without an area have no normal and are left out.
fn drawable(read: IndexedMesh) -> Mesh {
    let (read, _) = read.painted();
    let plain = read.materials.len() as u32;
    let mut mesh = Mesh { positions: read.positions, materials: read.materials, ..Mesh::default() };
    mesh.materials.push(Material::named("mesh"));
    for (number, triangle) in read.triangles.into_iter().enumerate() {
        let [a, b, c] = triangle.map(|corner| mesh.positions[corner as usize]);
        let (u, v) = (b - a, c - a);
        // Scaled first: squares of tiny extents leave the range of numbers.
        let size = u.abs().max(v.abs()).max_element();
        let Some(normal) = (u / size).cross(v / size).try_normalize() else { continue };
        let material = read.material_of.get(number).copied().flatten().unwrap_or(plain);
        mesh.triangle_faces.push(mesh.faces.len() as u32);
        mesh.faces.push(MeshFace { normal, material: MaterialId(material) });
        mesh.triangles.push(triangle);
    }
    mesh
}

/// The cells of an input, or what is left where it is cut open.
fn inside(
    input: &Input,
    kind: FileKind,
    args: &RenderArgs,
    options: &PreviewOptions,
    progress: &Progress,
) -> Result<Drawn, CliError> {
    progress.stage("reading");
    let read = read(input, kind, &args.reading)?;
    progress.stage("cutting");
    let failed = |source| CliError::of_evaluation(&input.path, source);
    let unbounded = summarize(&read.model).unbounded;
    let tree = bounded_tree_of(kind, &read.model, &unbounded).into_owned();
    let mut model = Model { tree, ..read.model };
    let mut cuts = Vec::new();
    if let Some(section) = args.section()
        && let Some(bounds) = bounds(&evaluate(&model).map_err(failed)?.mesh)
        && let Some(half_space) = section.half_space(bounds, options)
    {
        Cutaway { model, cuts } = model.cut_open(&half_space);
    }
    let Some(spread) = args.spread() else {
        let mesh = evaluate(&model).map_err(failed)?.mesh;
        return Ok(Drawn::new(Subject::from(mesh).hatching(&cuts), read.warnings));
    };
    model.tree = of_cells(&input.path, &model.tree)?.into_owned();
    let cells = if matches!(kind, FileKind::Mesh(_)) && is_union(&model.tree) {
        // A file of convex bodies: they are the cells, even where they overlap.
        brush_meshes(model.tree.brushes(), &model.materials)
    } else {
        Solid::from_tree(&model.tree).cell_meshes(&model.materials)
    };
    let subject = Subject::of_cells(&cells.map_err(failed)?, spread, &cuts);
    Ok(Drawn::new(subject, read.warnings))
}

/// The box around a mesh.
fn bounds(mesh: &Mesh) -> Option<[DVec3; 2]> {
    mesh.positions.iter().map(|&point| [point, point]).reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
}

/// Whether a tree is the union of several brushes, all as they are.
fn is_union(tree: &Tree) -> bool {
    tree.brushes().len() > 1 && tree.is_union()
}
