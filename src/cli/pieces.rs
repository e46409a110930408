//! What is written as several meshes: the convex cells of a solid (`--cells`, `coarsen`), or its named parts (`--parts`).

use std::borrow::Cow;
use std::path::Path;
use std::time::Instant;

use planecut::check::check_topology;
use planecut::csg::polyhedron::{ConvexTreeError, convex_tree};
use planecut::csg::{
    Brush, EvaluateError, FaceSource, Material, Mesh, Model, Solid, Tree, UsedMaterials, convex_union, evaluate,
    evaluate_with,
};
use planecut::export::Part;
use planecut::reading::FileKind;
use rayon::prelude::*;

use super::error::CliError;
use super::input::Input;
use super::report::{MeshPart, milliseconds};
use super::solve::{Solved, unbounded_of};

/// What stands for a number in names.
pub(crate) const NUMBER: &str = "{}";

/// Meshes with names.
pub(crate) struct Pieces {
    meshes: Vec<Mesh>,
    names: Vec<String>,
    /// The sources of each mesh's own materials, where these are not the materials of all.
    sources: Vec<Vec<FaceSource>>,
}

impl Pieces {
    /// The convex cells of a solid; the report is told.
    ///
    /// # Errors
    /// [`CliError::Evaluate`] for an unbounded solid, [`CliError::Bug`] for a bug.
    pub(crate) fn cells(input: &Input, kind: FileKind, solved: &mut Solved) -> Result<Self, CliError> {
        let begin = Instant::now();
        let tree = bounded_tree(kind, solved);
        let solid = Solid::from_tree(&*of_cells(&input.path, &tree)?);
        let materials = &solved.model.materials;
        let cells: Result<Vec<(Mesh, Option<UsedMaterials>)>, EvaluateError> = if has_own_materials(&solved.sources) {
            let cells = solid.cell_meshes_with_used_materials(materials);
            cells.map(|cells| cells.into_iter().map(|(mesh, used)| (mesh, Some(used))).collect())
        } else {
            solid.cell_meshes(materials).map(|meshes| meshes.into_iter().map(|mesh| (mesh, None)).collect())
        };
        let mut cells = cells.map_err(|source| CliError::of_evaluation(&input.path, source))?;
        // Slivers between planes that differ by mere rounding: nothing of them is left once points of noise are joined.
        cells.retain(|(mesh, _)| !mesh.triangles.is_empty());
        let sources = cells.iter().filter_map(|(_, used)| Some(used.as_ref()?.select(&solved.sources))).collect();
        let meshes = cells.into_iter().map(|(mesh, _)| mesh).collect();
        let volume = solid.volume().ok_or_else(|| CliError::of_evaluation(&input.path, EvaluateError::Unbounded))?;
        let cells = Self { sources, ..Self::named(meshes, "cell {}") };
        solved.report.set_cells(cells.meshes.len(), volume, cells.measured());
        solved.report.time_ms.evaluate += milliseconds(begin.elapsed());
        Ok(cells)
    }

    /// The named parts of a solid, each evaluated by itself; the report is told of their meshes.
    ///
    /// # Errors
    /// [`CliError::Evaluate`] for an unbounded part, [`CliError::Bug`] for a bug.
    pub(crate) fn parts(input: &Input, kind: FileKind, solved: &mut Solved) -> Result<Self, CliError> {
        let begin = Instant::now();
        let trees = bounded_tree(kind, solved).into_owned().into_named_parts();
        let has_own = has_own_materials(&solved.sources);
        let (mut meshes, mut names, mut sources) = (Vec::new(), Vec::new(), Vec::new());
        for (name, tree) in trees {
            let (model, used) = if has_own {
                let (model, used) = tree.with_used_materials(&solved.model.materials);
                (model, Some(used))
            } else {
                (Model { materials: solved.model.materials.clone(), tree }, None)
            };
            let part = evaluate_with(&model, unbounded_of(kind))
                .map_err(|source| CliError::of_evaluation(&input.path, source))?;
            if !part.mesh.triangles.is_empty() {
                meshes.push(part.mesh);
                names.push(name.unwrap_or_else(|| "solid".to_owned()));
                sources.extend(used.map(|used| used.select(&solved.sources)));
            }
        }
        let parts = Self { meshes, names, sources };
        solved.report.set_parts(parts.measured());
        solved.report.time_ms.evaluate += milliseconds(begin.elapsed());
        Ok(parts)
    }

    /// Meshes whose names are a pattern with their numbers for `{}`.
    pub(crate) fn named(meshes: Vec<Mesh>, pattern: &str) -> Self {
        let names = (0..meshes.len()).map(|number| pattern.replace(NUMBER, &number.to_string())).collect();
        Self { meshes, names, sources: Vec::new() }
    }

    /// The same as writers want it; `sources` are those of the faces' materials where pieces have none of their own.
    pub(crate) fn as_parts<'a>(&'a self, sources: &'a [FaceSource]) -> Vec<Part<'a>> {
        let own = |place: usize| self.sources.get(place).map_or(sources, Vec::as_slice);
        let pieces = self.names.iter().zip(&self.meshes).enumerate();
        pieces.map(|(place, (name, mesh))| Part { name, mesh, sources: own(place) }).collect()
    }

    /// The names and the meshes.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (&str, &Mesh)> {
        self.names.iter().map(String::as_str).zip(&self.meshes)
    }

    /// The counts of all meshes together.
    pub(crate) fn measured(&self) -> MeshPart {
        self.measured_at(1.0)
    }

    /// The same, with each length that of the meshes times a factor.
    pub(crate) fn measured_at(&self, scale: f64) -> MeshPart {
        let (mut positions, mut triangles, mut faces) = (Vec::new(), Vec::new(), 0);
        for mesh in &self.meshes {
            let first = positions.len() as u32;
            positions.extend(mesh.positions.iter().map(|position| *position * scale));
            triangles.extend(mesh.triangles.iter().map(|corners| corners.map(|corner| corner + first)));
            faces += mesh.faces.len();
        }
        MeshPart::of_solid(&check_topology(&positions, &triangles), faces)
    }
}

/// Whether there may be as many materials as triangles, as of textured meshes: then pieces hold those that they use, not all.
fn has_own_materials(sources: &[FaceSource]) -> bool {
    sources.iter().any(|source| source.texture.is_some_and(|axes| axes.anchor.is_some()))
}

/// The mesh of each brush by itself, in their order.
///
/// # Errors
/// As [`evaluate`].
pub(crate) fn brush_meshes(brushes: &[Brush], materials: &[Material]) -> Result<Vec<Mesh>, EvaluateError> {
    let mesh = |brush: &Brush| {
        let model = Model { materials: materials.to_vec(), tree: brush.clone().into() };
        Ok(evaluate(&model)?.mesh)
    };
    brushes.par_iter().map(mesh).collect()
}

/// The solid of a tree as convex bodies: the brushes of a union as they are, closed meshes as cells, and any other tree as disjoint cells.
///
/// # Errors
/// As [`of_cells`].
pub(crate) fn brushes(path: &Path, tree: &Tree) -> Result<Vec<Brush>, CliError> {
    Ok(convex_union(&*of_cells(path, tree)?).into_owned())
}

/// A tree with convex cells in place of closed meshes.
///
/// # Errors
/// [`CliError::Cells`] for a mesh that falls into too many.
pub(crate) fn of_cells<'a>(path: &Path, tree: &'a Tree) -> Result<Cow<'a, Tree>, CliError> {
    convex_tree(tree).map_err(|source| no_cells(path, source))
}

/// The error for a tree without convex cells.
pub(crate) fn no_cells(path: &Path, source: ConvexTreeError) -> CliError {
    match source {
        ConvexTreeError::Evaluate(source) => CliError::of_evaluation(path, source),
        source => CliError::Cells { path: path.to_owned(), source },
    }
}

/// The tree of an input, of a map without what is not bounded.
pub(crate) fn bounded_tree(kind: FileKind, solved: &Solved) -> Cow<'_, Tree> {
    bounded_tree_of(kind, &solved.model, &solved.unbounded)
}

/// The same for a model, given the numbers of its unbounded brushes.
pub(crate) fn bounded_tree_of<'a>(kind: FileKind, model: &'a Model, unbounded: &[usize]) -> Cow<'a, Tree> {
    match kind {
        FileKind::Model | FileKind::Scad | FileKind::Mesh(_) => Cow::Borrowed(&model.tree),
        FileKind::Map => Cow::Owned(without(model, unbounded)),
    }
}

/// A model without the brushes of a map that are not bounded, given their numbers.
pub(crate) fn bounded_model<'a>(kind: FileKind, model: &'a Model, unbounded: &[usize]) -> Cow<'a, Model> {
    match bounded_tree_of(kind, model, unbounded) {
        Cow::Borrowed(_) => Cow::Borrowed(model),
        Cow::Owned(tree) => Cow::Owned(Model { materials: model.materials.clone(), tree }),
    }
}

/// The union of a map's brushes but for those that are not bounded.
pub(crate) fn without(model: &Model, unbounded: &[usize]) -> Tree {
    let brushes = model.tree.brushes().iter().zip(model.tree.source_lines()).enumerate();
    let bounded =
        brushes.filter(|(number, _)| !unbounded.contains(number)).map(|(_, (brush, line))| (brush.clone(), line));
    let (brushes, lines) = bounded.unzip();
    Tree::union_of(brushes).with_source_lines(lines)
}
