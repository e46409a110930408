//! Meshes that `coarsen` takes as surfaces, without the exact cells of what they bound.

use std::time::Instant;

use planecut::check::check_topology;
use planecut::csg::coarsen::{Bounded, CoarsenError, CoarsenOptions, Coarsened, Coarsener, Surface};
use planecut::csg::{Material, MaterialId, Mesh, MeshFace, Model, Tree};
use planecut::enclosing::bounded_by;
use planecut::import::Warning;
use planecut::import::mesh::{MeshFormat, Place, SolidError, TrianglesImport, read_triangles};
use planecut::kernel::DVec3;
use planecut::reading::FileKind;

use super::args::SurfaceArgs;
use super::error::CliError;
use super::input::Input;
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
        why: Option<NoSolid>,
        begin: Instant,
    ) -> Result<(Self, Solved), CliError> {
        let import = read_triangles(&input.read()?, format, &input.name(), &reading.solid_options())?;
        let TrianglesImport { positions, triangles, materials, material_of, mut warnings } = import;
        let bounded = bounded_by(&positions, &triangles, asked.solid, min_thickness);
        warnings.extend(why.map(|why| why.note(bounded, asked)));
        let topology = check_topology(&positions, &triangles);
        let mut report = Report::of_mesh(input.given(), FileKind::Mesh(format).name(), &topology);
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

    /// The triangles as they are, each a face of its own.
    pub(crate) fn mesh(&self, materials: &[Material]) -> Mesh {
        let face = |(corners, material): (&[u32; 3], &MaterialId)| {
            let [a, b, c] = corners.map(|corner| self.positions[corner as usize]);
            MeshFace { normal: (b - a).cross(c - a).normalize_or(DVec3::Z), material: *material }
        };
        Mesh {
            positions: self.positions.clone(),
            triangles: self.triangles.clone(),
            triangle_faces: (0..self.triangles.len() as u32).collect(),
            faces: self.triangles.iter().zip(&self.material_of).map(face).collect(),
            materials: materials.to_vec(),
        }
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

/// Why a mesh is not taken as a solid.
pub(crate) struct NoSolid {
    line: u32,
    reason: String,
}

impl NoSolid {
    /// What is wrong with a surface; nothing where a file cannot be read at all.
    pub(crate) fn of_error(error: &SolidError) -> Option<Self> {
        let SolidError::Surface { place, source, .. } = error else { return None };
        let line = match place {
            Place::Line(line) => u32::try_from(*line).unwrap_or(0),
            _ => 0,
        };
        Some(Self { line, reason: source.to_string() })
    }

    /// Nothing is inside.
    pub(crate) fn empty() -> Self {
        Self { line: 0, reason: "found a surface with nothing inside".to_owned() }
    }

    /// Says so, and what the mesh is taken for.
    fn note(self, bounded: Bounded, asked: SurfaceArgs) -> Warning {
        let taken = match bounded {
            Bounded::Shell { thickness } if asked.solid => format!(
                "it goes around no point by more than half, either: the triangles are enclosed as a shell {thickness} thick (--min-thickness T is another thickness)"
            ),
            Bounded::Shell { thickness } => format!(
                "the triangles are enclosed as a shell {thickness} thick (--solid fills the mesh, --close EPS joins vertices, --min-thickness T is another thickness)"
            ),
            _ => "it is filled where it goes around more than half".to_owned(),
        };
        Warning::note(self.line, format!("{}; {taken}", self.reason))
    }
}
