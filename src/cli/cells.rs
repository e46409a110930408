//! The convex cells of a solid, for `--cells` and `coarsen`.

use std::borrow::Cow;
use std::time::Instant;

use planecut::csg::check::check_topology;
use planecut::csg::{EvaluateError, Mesh, Model, Solid, Tree};
use planecut::export::Part;

use super::error::CliError;
use super::input::{Input, InputKind};
use super::report::{MeshPart, milliseconds};
use super::solve::Solved;

/// What stands for a number in names.
pub(crate) const NUMBER: &str = "{}";

/// Convex cells, as meshes.
pub(crate) struct Cells {
    meshes: Vec<Mesh>,
    names: Vec<String>,
}

impl Cells {
    /// Takes the solid apart, and tells the report.
    ///
    /// # Errors
    /// [`CliError::Evaluate`] for an unbounded solid, [`CliError::Bug`] for a bug.
    pub(crate) fn new(input: &Input, kind: InputKind, solved: &mut Solved) -> Result<Self, CliError> {
        let begin = Instant::now();
        let solid = Solid::from_tree(&bounded_tree(kind, solved));
        let mut meshes = solid
            .cell_meshes(&solved.model.materials)
            .map_err(|source| CliError::of_evaluation(&input.path, source))?;
        // Slivers between planes that differ by mere rounding: nothing of them is left once points of noise are joined.
        meshes.retain(|mesh| !mesh.triangles.is_empty());
        let volume = solid.volume().ok_or_else(|| CliError::of_evaluation(&input.path, EvaluateError::Unbounded))?;
        let cells = Self::named(meshes, "cell {}");
        solved.report.set_cells(cells.meshes.len(), volume, cells.measured());
        solved.report.time_ms.evaluate += milliseconds(begin.elapsed());
        Ok(cells)
    }

    /// Meshes whose names are a pattern with their numbers for `{}`.
    pub(crate) fn named(meshes: Vec<Mesh>, pattern: &str) -> Self {
        let names = (0..meshes.len()).map(|number| pattern.replace(NUMBER, &number.to_string())).collect();
        Self { meshes, names }
    }

    /// One part for each cell.
    pub(crate) fn parts(&self) -> Vec<Part<'_>> {
        self.names.iter().zip(&self.meshes).map(|(name, mesh)| Part::new(name, mesh)).collect()
    }

    /// The counts of all meshes together.
    pub(crate) fn measured(&self) -> MeshPart {
        let (mut positions, mut triangles, mut faces) = (Vec::new(), Vec::new(), 0);
        for mesh in &self.meshes {
            let first = positions.len() as u32;
            positions.extend_from_slice(&mesh.positions);
            triangles.extend(mesh.triangles.iter().map(|corners| corners.map(|corner| corner + first)));
            faces += mesh.faces.len();
        }
        MeshPart::of_solid(&check_topology(&positions, &triangles), faces)
    }
}

/// The tree of an input, of a map without what is not bounded.
pub(crate) fn bounded_tree(kind: InputKind, solved: &Solved) -> Cow<'_, Tree> {
    match kind {
        InputKind::Json | InputKind::Csg | InputKind::Mesh(_) => Cow::Borrowed(&solved.model.tree),
        InputKind::Map => Cow::Owned(without(&solved.model, &solved.unbounded)),
    }
}

/// The union of a map's brushes but for those that are not bounded.
fn without(model: &Model, unbounded: &[usize]) -> Tree {
    let brushes = model.tree.brushes().iter().enumerate();
    Tree::union_of(brushes.filter(|(number, _)| !unbounded.contains(number)).map(|(_, brush)| brush.clone()).collect())
}
