//! Solids, meshes and hulls as few convex cells, written as others read them: what `coarsen` of the packages for Python and JavaScript gives.

use planecut_cells::coarsen::{Bounded, CoarsenError, CoarsenOptions, Coarsened, Side, Writing, written_meshes};
use planecut_check::measure_triangles;
use planecut_csg::{ConvexPiece, EvaluateError, Material, MaterialId, Mesh, Model, Tree, evaluate};
use planecut_import::mesh::{MeshFormat, SolidOptions, parts_of_mesh};
use planecut_kernel::DVec3;
use planecut_shapes::ShapeError;
use planecut_shapes::primitives::hull_of_points;
use thiserror::Error;

use crate::enclosing::{EncloseError, bounded_by, enclosed, enclosed_surface};
use crate::expression::{DEFAULT_MATERIAL, ExpressionError, Node, piece_of_planes};
use crate::triangles::{Triangles, said_of_surface};

/// By how much of its volume a cell may be larger as it is written, for the volume to be the same.
const SAME_VOLUME: f64 = 1e-9;

/// What is to be enclosed.
#[derive(Debug, Clone, Copy)]
pub enum Subject<'a> {
    /// A solid.
    Solid(&'a Node),
    /// Triangles, whether they bound a solid or not.
    Mesh(&'a Mesh),
    /// The corners of each of several convex bodies.
    Hulls(&'a [Vec<DVec3>]),
}

/// How triangles are taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Taken {
    /// As a solid where they bound one, else as a shell.
    Auto,
    /// As a shell.
    Shell,
    /// With all that they go around more than half.
    Filled,
}

/// Why there are no cells.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum CoarseningError {
    /// Something is wrong with the solid.
    #[error(transparent)]
    Solid(#[from] ExpressionError),
    /// A hull has no inside.
    #[error("hull {number}: {source}")]
    Hull {
        /// Which one, counted from 0.
        number: usize,
        /// What is wrong with it.
        source: ShapeError,
    },
    /// Triangles bound no solid, where cells within one are asked for.
    #[error("{0}")]
    Surface(String),
    /// A cell has no inside as it is written.
    #[error(transparent)]
    Written(#[from] ShapeError),
    /// As [`EncloseError`].
    #[error(transparent)]
    Enclose(#[from] EncloseError),
}

impl From<EvaluateError> for CoarseningError {
    fn from(error: EvaluateError) -> Self {
        ExpressionError::from(error).into()
    }
}

impl From<CoarsenError> for CoarseningError {
    fn from(error: CoarsenError) -> Self {
        EncloseError::from(error).into()
    }
}

impl CoarseningError {
    /// Whether it shows a bug of ours, whatever the input.
    #[must_use]
    pub fn is_bug(&self) -> bool {
        match self {
            Self::Solid(error) => error.is_bug(),
            Self::Enclose(EncloseError::Coarsen(CoarsenError::Evaluate(error))) => {
                ExpressionError::from(*error).is_bug()
            }
            _ => false,
        }
    }
}

/// A cell as others read it.
#[derive(Debug, Clone, PartialEq)]
pub struct WrittenCell {
    /// Its planes, corners, triangles and volume. The hull of the corners holds all that the planes bound.
    pub piece: ConvexPiece,
    /// What it is made of.
    pub material: Material,
}

/// Few convex cells, and what they were made of.
#[derive(Debug, Clone, PartialEq)]
pub struct WrittenCells {
    /// The cells, without those that are thinner than rounding.
    pub cells: Vec<WrittenCell>,
    /// The mesh of each cell.
    pub meshes: Vec<Mesh>,
    /// The cells as their planes say them, and volumes.
    pub outcome: Coarsened,
    /// The materials.
    pub materials: Vec<Material>,
    /// What the triangles bound, where cells were made of triangles.
    pub bounded: Option<Bounded>,
    /// How triangles were taken, where that may not be what was meant.
    pub note: Option<String>,
    /// What was enclosed.
    pub visual: Mesh,
    /// Whether what was enclosed is the boundary of a solid.
    pub is_closed: bool,
}

/// Few convex cells around a subject, or within it, by the side of the options.
///
/// ```
/// use planecut::cells::coarsen::CoarsenOptions;
/// use planecut::coarsening::{Subject, Taken, coarsened};
/// use planecut::csg::{Brush, Material, MaterialId};
/// use planecut::expression::Node;
/// use planecut::kernel::DVec3;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let cube = Node::of_tree(Brush::cuboid(DVec3::ZERO, DVec3::ONE, MaterialId(0)), Material::named("oak"));
/// let written = coarsened(Subject::Solid(&cube), Taken::Auto, &CoarsenOptions::default())?;
/// assert_eq!((written.cells.len(), written.cells[0].piece.volume), (1, 1.0));
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// [`CoarseningError`].
pub fn coarsened(
    subject: Subject<'_>,
    taken: Taken,
    options: &CoarsenOptions,
) -> Result<WrittenCells, CoarseningError> {
    let work = match subject {
        Subject::Solid(node) => {
            let visual = node.evaluated()?.evaluation.mesh.clone();
            of_model(node.model()?, visual, &[], options)
        }
        Subject::Hulls(hulls) => of_hulls(hulls, options),
        Subject::Mesh(mesh) => of_mesh(mesh, taken, options),
    };
    written(work?, options)
}

/// Cells, what they are made of, and what was noticed.
struct Work {
    outcome: Coarsened,
    materials: Vec<Material>,
    bounded: Option<Bounded>,
    note: Option<String>,
    visual: Mesh,
    is_closed: bool,
}

type Made = Result<Work, CoarseningError>;

fn of_hulls(hulls: &[Vec<DVec3>], options: &CoarsenOptions) -> Made {
    let brush = |(number, points): (usize, &Vec<DVec3>)| {
        hull_of_points(points, MaterialId(0)).map_err(|source| CoarseningError::Hull { number, source })
    };
    let brushes = hulls.iter().enumerate().map(brush).collect::<Result<_, _>>()?;
    let model = Model { materials: vec![Material::named(DEFAULT_MATERIAL)], tree: Tree::union_of(brushes) };
    let visual = evaluate(&model)?.mesh;
    of_model(model, visual, &hulls.concat(), options)
}

fn of_mesh(mesh: &Mesh, taken: Taken, options: &CoarsenOptions) -> Made {
    if taken != Taken::Auto {
        return of_surface(mesh, taken, None, options);
    }
    let triangles = Triangles::of_mesh(mesh).indexed();
    match parts_of_mesh(triangles, MeshFormat::Obj, "mesh", &SolidOptions::default()) {
        Ok(parts) => {
            let visual = evaluate(&parts.import.model)?.mesh;
            if visual.triangles.is_empty() && options.side == Side::Outer {
                return of_surface(mesh, taken, Some("found a surface with nothing inside".to_owned()), options);
            }
            of_model(parts.import.model, visual, &parts.points, options)
        }
        Err(error) if options.side == Side::Outer => of_surface(mesh, taken, Some(said_of_surface(&error)), options),
        Err(error) => Err(CoarseningError::Surface(said_of_surface(&error))),
    }
}

/// Cells of a tree, with its boundary.
fn of_model(model: Model, visual: Mesh, points: &[DVec3], options: &CoarsenOptions) -> Made {
    let (outcome, bounded) = enclosed(&model.tree, &visual, points, options)?;
    Ok(Work { outcome, materials: model.materials, bounded, note: None, visual, is_closed: true })
}

fn of_surface(mesh: &Mesh, taken: Taken, why: Option<String>, options: &CoarsenOptions) -> Made {
    let bounded = bounded_by(&mesh.positions, &mesh.triangles, taken == Taken::Filled, options.min_thickness);
    let note = match (bounded, why) {
        (Bounded::Shell { thickness }, Some(why)) => Some(format!(
            "{why}; the triangles are enclosed as a shell {thickness} thick (surface \"filled\" fills the mesh)"
        )),
        (Bounded::Shell { thickness }, None) if taken == Taken::Filled => Some(format!(
            "the mesh goes around no point by more than half: its triangles are enclosed as a shell {thickness} thick"
        )),
        _ => None,
    };
    let outcome = enclosed_surface(mesh, bounded, options)?;
    let (materials, visual) = (mesh.materials.clone(), mesh.clone());
    Ok(Work { outcome, materials, bounded: Some(bounded), note, visual, is_closed: false })
}

/// Cells as others read them: vertices in doubles whose hull holds the planes' body. A cell that has too many vertices for that becomes a larger one, and the volumes are measured again.
fn written(work: Work, options: &CoarsenOptions) -> Result<WrittenCells, CoarseningError> {
    let Work { mut outcome, materials, bounded, note, visual, is_closed } = work;
    let encloses = options.side == Side::Outer;
    let stored = |positions: &[DVec3]| positions.to_vec();
    let max_vertices = options.max_vertices.unwrap_or(usize::MAX);
    let writing = Writing { scale: 1.0, max_vertices, encloses, is_separated: false, stored: &stored };
    let mut meshes = written_meshes(&outcome.cells, &materials, &writing)?;
    let default = Material::named(DEFAULT_MATERIAL);
    let (mut cells, mut has_grown) = (Vec::new(), false);
    for (brush, mesh) in outcome.cells.iter_mut().zip(&meshes) {
        // within a solid a cell may be thinner than rounding
        if mesh.triangles.is_empty() {
            continue;
        }
        let number = brush.faces.first().map(|face| face.material);
        let material = number.and_then(|number| materials.get(number.0 as usize)).unwrap_or(&default).clone();
        let mut piece = piece_of_planes(brush.half_spaces().copied())?;
        let volume = measure_triangles(&mesh.positions, &mesh.triangles).map_or(0.0, |measures| measures.volume);
        if encloses && volume > piece.volume * (1.0 + SAME_VOLUME) {
            has_grown = true;
            *brush = hull_of_points(&mesh.positions, number.unwrap_or(MaterialId(0)))?;
            piece = piece_of_planes(brush.half_spaces().copied())?;
        }
        let (positions, triangles) = (mesh.positions.clone(), mesh.triangles.clone());
        cells.push(WrittenCell { piece: ConvexPiece { positions, triangles, ..piece }, material });
    }
    if has_grown {
        let tree = Tree::union_of(outcome.cells.clone());
        outcome.volume_out = evaluate(&Model { materials: materials.clone(), tree })?.solid.volume;
        outcome.volume_sum_out = cells.iter().map(|cell| cell.piece.volume).sum();
    }
    meshes.retain(|mesh| !mesh.triangles.is_empty());
    Ok(WrittenCells { cells, meshes, outcome, materials, bounded, note, visual, is_closed })
}
