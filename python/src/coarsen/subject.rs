//! What is coarsened.

use std::sync::Arc;

use glam::DVec3;
use planecut::cells::coarsen::CoarsenOptions;
use planecut::coarsening::{self, Taken, WrittenCells};
use planecut::expression::Node;
use pyo3::prelude::*;
use pyo3::types::PySequence;

use crate::arrays::{columns, points, positions, triangles};
use crate::cells::Cell;
use crate::errors::{Outcome, refuse};
use crate::files::parts_of_mesh_object;
use crate::mesh::{Handle, Mesh, given};
use crate::solid::Solid;

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
            let mesh = given(&vertices, &faces, None, None, None)?.into_mesh();
            return Ok(Self::Mesh(Handle::Own(Arc::new(mesh))));
        }
        let Ok(list) = value.cast::<PySequence>() else {
            return Err(refuse(format!("found {}, expected {expected}", value.get_type())));
        };
        let hull = |k: usize| -> PyResult<Vec<DVec3>> {
            let (item, name) = (list.get_item(k)?, format!("hull {k}"));
            if let Ok(cell) = item.cast::<Cell>() {
                return Ok(cell.get().corners().to_vec());
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

impl Subject {
    /// Cells of whatever there is.
    pub(super) fn coarsened(&self, taken: Taken, options: &CoarsenOptions) -> Outcome<WrittenCells> {
        let subject = match self {
            Self::Solid(node) => coarsening::Subject::Solid(node),
            Self::Mesh(handle) => coarsening::Subject::Mesh(handle.mesh()),
            Self::Hulls(hulls) => coarsening::Subject::Hulls(hulls),
        };
        Ok(coarsening::coarsened(subject, taken, options)?)
    }
}
