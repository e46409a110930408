//! Meshes that `coarsen` takes as surfaces, without the exact cells of what they bound.

use std::time::Instant;

use planecut::check::check_topology;
use planecut::csg::coarsen::{Bounded, CoarsenError, CoarsenOptions, Coarsened, Coarsener, Surface};
use planecut::csg::{MaterialId, Mesh, Model, Tree};
use planecut::import::Warning;
use planecut::import::mesh::{MeshFormat, Place, SolidError, TrianglesImport, read_triangles};
use planecut::kernel::DVec3;

use super::args::SurfaceArgs;
use super::error::CliError;
use super::input::{Input, InputKind};
use super::reading_args::ReadingArgs;
use super::report::{Report, milliseconds};
use super::solve::Solved;

/// Triangles, and what they bound.
pub(crate) struct Triangles {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    material_of: Vec<MaterialId>,
    bounded: Bounded,
}

impl Triangles {
    /// The boundary of a solid.
    pub(crate) fn of_boundary(mesh: &Mesh) -> Self {
        let material_of = mesh.triangle_faces.iter().map(|face| mesh.faces[*face as usize].material).collect();
        let (positions, triangles) = (mesh.positions.clone(), mesh.triangles.clone());
        Self { positions, triangles, material_of, bounded: Bounded::Solid }
    }

    /// The triangles of a file that bound no solid, or are not to; `why` they do not. With the report on them.
    ///
    /// # Errors
    /// [`CliError`] for a file that cannot be read.
    pub(crate) fn read(
        input: &Input,
        format: MeshFormat,
        reading: &ReadingArgs,
        asked: SurfaceArgs,
        min_thickness: Option<f64>,
        why: Option<&SolidError>,
        begin: Instant,
    ) -> Result<(Self, Solved), CliError> {
        let import = read_triangles(&input.read()?, format, &input.name(), &reading.solid_options())?;
        let TrianglesImport { positions, triangles, materials, material_of, mut warnings } = import;
        let thickness = || min_thickness.unwrap_or_else(|| Bounded::default_thickness(&positions, &triangles));
        let bounded = if asked.solid { Bounded::Filled } else { Bounded::Shell { thickness: thickness() } };
        warnings.extend(why.and_then(|why| note(why, bounded)));
        let topology = check_topology(&positions, &triangles);
        let mut report = Report::of_mesh(input.given(), InputKind::Mesh(format).name(), &topology);
        report.time_ms.import = milliseconds(begin.elapsed());
        report.warn(&warnings);
        let model = Model { materials, tree: Tree::default() };
        let (mesh, sources, unbounded) = (Mesh::default(), Vec::new(), Vec::new());
        let solved = Solved { model, sources, mesh, unbounded, report, warnings };
        Ok((Self { positions, triangles, material_of, bounded }, solved))
    }

    /// What they bound.
    pub(crate) fn bounded(&self) -> Bounded {
        self.bounded
    }

    /// Few cells around what they bound.
    ///
    /// # Errors
    /// [`CoarsenError`].
    pub(crate) fn coarsened(&self, options: &CoarsenOptions) -> Result<Coarsened, CoarsenError> {
        let surface = Surface {
            positions: &self.positions,
            triangles: &self.triangles,
            materials: &self.material_of,
            bounded: self.bounded,
        };
        Coarsener::of_surface(&surface, None, options)?.coarsened()
    }
}

/// Says that a mesh is no solid, and what it is taken for.
fn note(why: &SolidError, bounded: Bounded) -> Option<Warning> {
    let SolidError::Surface { place, source, .. } = why else { return None };
    let line = match place {
        Place::Line(line) => u32::try_from(*line).unwrap_or(0),
        _ => 0,
    };
    let taken = match bounded {
        Bounded::Shell { thickness } => format!(
            "the triangles are enclosed as a shell {thickness} thick (--solid fills the mesh, --close EPS joins vertices, --min-thickness T is another thickness)"
        ),
        _ => "it is filled where it goes around more than half".to_owned(),
    };
    Some(Warning::note(line, format!("{source}; {taken}")))
}
