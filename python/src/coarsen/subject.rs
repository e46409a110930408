//! What is coarsened, and how.

use std::sync::Arc;

use glam::DVec3;
use planecut::cells::coarsen::{Bounded, CoarsenOptions, Coarsened as CoreCoarsened, Side, Writing, written_meshes};
use planecut::check::measure_triangles;
use planecut::csg::primitives::hull_of_points;
use planecut::csg::{Material, MaterialId, Mesh as CoreMesh, Model, Tree, evaluate};
use planecut::enclosing::{bounded_by, enclosed, enclosed_surface};
use planecut::import::mesh::{MeshFormat, SolidOptions, parts_of_mesh};
use pyo3::prelude::*;
use pyo3::types::PySequence;

use crate::arrays::{columns, points, positions, triangles};
use crate::cells::Cell;
use crate::errors::{Failure, Outcome, refuse};
use crate::expression::Node;
use crate::files::{indexed, parts_of_mesh_object, surface_failure};
use crate::mesh::{Given, Handle, Mesh};
use crate::solid::Solid;

/// By how much of its volume a cell may be larger as it is written, for the volume to be the same.
const SAME_VOLUME: f64 = 1e-9;

/// What is to be enclosed.
pub(super) enum Subject {
    Solid(Arc<Node>),
    Mesh(Handle),
    /// The corners of each of several convex bodies.
    Hulls(Vec<Vec<DVec3>>),
}

impl Subject {
    pub(super) fn of(value: &Bound<'_, PyAny>) -> PyResult<Self> {
        if let Ok(solid) = value.cast::<Solid>() {
            return Ok(Self::Solid(Arc::clone(solid.get().node())));
        }
        if let Ok(mesh) = value.cast::<Mesh>() {
            return Ok(Self::Mesh(mesh.get().handle()));
        }
        let expected = "a Solid, a Mesh, or a list of hulls: Cell, (vertices, triangles) or vertices of shape (n, 3)";
        if let Some((vertices, faces)) = parts_of_mesh_object(value)? {
            let vertices = positions(&vertices, "vertices")?;
            let mesh = Given::new(&vertices, &faces, None, None, None)?.into_core();
            return Ok(Self::Mesh(Handle::Own(Arc::new(mesh))));
        }
        let Ok(list) = value.cast::<PySequence>() else {
            return Err(refuse(format!("found {}, expected {expected}", value.get_type())));
        };
        let hull = |k: usize| -> PyResult<Vec<DVec3>> {
            let (item, name) = (list.get_item(k)?, format!("hull {k}"));
            if let Ok(cell) = item.cast::<Cell>() {
                return Ok(cell.get().parts().0.to_vec());
            }
            // a pair of arrays, as CoACD gives it
            let is_pair = item.cast::<PySequence>().is_ok_and(|pair| pair.len().is_ok_and(|length| length == 2));
            if is_pair && columns(&item, &name).map_or(true, |columns| columns != 3) {
                let vertices = points(&item.get_item(0)?, &name)?;
                triangles(&item.get_item(1)?, &name, vertices.len())?;
                return Ok(vertices);
            }
            points(&item, &name)
        };
        (0..list.len()?).map(hull).collect::<PyResult<_>>().map(Self::Hulls)
    }
}

/// How triangles are taken.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Taken {
    /// As a solid where they bound one, else as a shell.
    Auto,
    Shell,
    Filled,
}

/// Cells, what they are made of, and what was noticed.
pub(super) struct Work {
    pub(super) outcome: CoreCoarsened,
    pub(super) materials: Vec<Material>,
    pub(super) bounded: Option<Bounded>,
    pub(super) note: Option<String>,
    /// What was enclosed.
    pub(super) visual: CoreMesh,
    pub(super) is_closed: bool,
}

/// Cells of whatever there is.
pub(super) fn work(subject: Subject, taken: Taken, options: &CoarsenOptions) -> Outcome<Work> {
    match subject {
        Subject::Solid(node) => of_model(node.model()?, node.evaluated()?.evaluation.mesh.clone(), &[], options),
        Subject::Hulls(hulls) => {
            let mut brushes = Vec::new();
            for (number, points) in hulls.iter().enumerate() {
                let hull = hull_of_points(points, MaterialId(0));
                brushes.push(hull.map_err(|error| Failure::of(format!("hull {number}: {error}")))?);
            }
            let materials = vec![Material::named(crate::shapes::DEFAULT_MATERIAL)];
            let points: Vec<DVec3> = hulls.into_iter().flatten().collect();
            let model = Model { materials, tree: Tree::union_of(brushes) };
            let visual = evaluate(&model)?.mesh;
            of_model(model, visual, &points, options)
        }
        Subject::Mesh(handle) => {
            let mesh = handle.mesh();
            if taken != Taken::Auto {
                return of_surface(mesh, taken, None, options);
            }
            match parts_of_mesh(indexed(Given::of_core(mesh)), MeshFormat::Obj, "mesh", &SolidOptions::default()) {
                Ok(parts) => {
                    let visual = evaluate(&parts.import.model)?.mesh;
                    if visual.triangles.is_empty() && options.side == Side::Outer {
                        return of_surface(
                            mesh,
                            taken,
                            Some("found a surface with nothing inside".to_owned()),
                            options,
                        );
                    }
                    of_model(parts.import.model, visual, &parts.points, options)
                }
                Err(error) if options.side == Side::Outer => {
                    of_surface(mesh, taken, Some(surface_failure(&error).message), options)
                }
                Err(error) => Err(surface_failure(&error)),
            }
        }
    }
}

/// Cells of a tree, with its boundary.
fn of_model(model: Model, visual: CoreMesh, points: &[DVec3], options: &CoarsenOptions) -> Outcome<Work> {
    let (outcome, bounded) = enclosed(&model.tree, &visual, points, options)?;
    Ok(Work { outcome, materials: model.materials, bounded, note: None, visual, is_closed: true })
}

fn of_surface(mesh: &CoreMesh, taken: Taken, why: Option<String>, options: &CoarsenOptions) -> Outcome<Work> {
    let bounded = bounded_by(&mesh.positions, &mesh.triangles, taken == Taken::Filled, options.min_thickness);
    let note = match (bounded, why) {
        (Bounded::Shell { thickness }, Some(why)) => Some(format!(
            "{why}; the triangles are enclosed as a shell {thickness} thick (surface=\"filled\" fills the mesh)"
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
pub(super) fn written(
    work: &mut Work,
    max_vertices: Option<usize>,
    encloses: bool,
) -> Outcome<(Vec<Cell>, Vec<CoreMesh>)> {
    let stored = |positions: &[DVec3]| positions.to_vec();
    let max_vertices = max_vertices.unwrap_or(usize::MAX);
    let writing = Writing { scale: 1.0, max_vertices, encloses, is_separated: false, stored: &stored };
    let mut meshes = written_meshes(&work.outcome.cells, &work.materials, &writing)?;
    let default = Material::named(crate::shapes::DEFAULT_MATERIAL);
    let (mut cells, mut has_grown) = (Vec::new(), false);
    for (brush, mesh) in work.outcome.cells.iter_mut().zip(&meshes) {
        // within a solid a cell may be thinner than rounding
        if mesh.triangles.is_empty() {
            continue;
        }
        let material = brush.faces.first().map(|face| face.material);
        let named = material.and_then(|material| work.materials.get(material.0 as usize)).unwrap_or(&default);
        let cell = Cell::of_planes(brush.half_spaces().copied(), named)?;
        let volume = measure_triangles(&mesh.positions, &mesh.triangles).map_or(0.0, |measures| measures.volume);
        if encloses && volume > cell.volume() * (1.0 + SAME_VOLUME) {
            has_grown = true;
            *brush = hull_of_points(&mesh.positions, material.unwrap_or(MaterialId(0))).map_err(Failure::of)?;
            cells.push(Cell::of_planes(brush.half_spaces().copied(), named)?.written_as(mesh));
        } else {
            cells.push(cell.written_as(mesh));
        }
    }
    if has_grown {
        let tree = Tree::union_of(work.outcome.cells.clone());
        work.outcome.volume_out = evaluate(&Model { materials: work.materials.clone(), tree })?.solid.volume;
        work.outcome.volume_sum_out = cells.iter().map(Cell::volume).sum();
    }
    meshes.retain(|mesh| !mesh.triangles.is_empty());
    Ok((cells, meshes))
}
