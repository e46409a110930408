//! The convex hull of solids.

use planecut_csg::stages::{KnownPlanes, compare};
use planecut_csg::{Brush, MaterialId, Tree};
use planecut_kernel::{DVec3, HalfSpace, HullError};

use super::convex::{Convex, evaluated, parts_of_unions, wide_faces};
use crate::parameter::ShapeError;

/// The convex hull of all operands together; empty where none has an interior. A single convex body is its own hull, with its
/// own planes and materials. Other hulls get the material; where one of their faces is one of an operand, it is the very same
/// plane.
///
/// The corners of convex bodies and unions are taken from their planes, those of other trees from their meshes; they are rounded
/// once.
///
/// # Errors
/// [`ShapeError::Unbounded`] where an operand is not bounded, [`ShapeError::Evaluate`] where one has no mesh.
pub fn hull(operands: &[Tree], material: MaterialId) -> Result<Tree, ShapeError> {
    hull_with_points(operands, &[], material)
}

/// The convex hull of operands and points together, as [`hull`]; empty where it has no interior.
///
/// # Errors
/// As [`hull`], and [`ShapeError::Hull`] for a point whose coordinates are not accepted.
pub fn hull_with_points(operands: &[Tree], points: &[DVec3], material: MaterialId) -> Result<Tree, ShapeError> {
    let is_in_parts = |operand: &&Tree| operand.is_union() && !operand.has_meshes();
    let bodies: Vec<(&Brush, Convex)> = parts_of_unions(operands.iter().filter(is_in_parts))?;
    let mut corners: Vec<DVec3> = points.to_vec();
    for operand in operands.iter().filter(|operand| !is_in_parts(operand)) {
        corners.extend(evaluated(operand)?.mesh.positions);
    }
    if let ([(brush, _)], true) = (&bodies[..], corners.is_empty()) {
        return Ok(Tree::from((*brush).clone()));
    }
    corners.extend(bodies.iter().flat_map(|(_, body)| &body.corners));
    if corners.is_empty() {
        return Ok(Tree::empty());
    }
    let polytope = match planecut_kernel::hull(&corners) {
        Err(HullError::NoInterior { .. }) => return Ok(Tree::empty()),
        other => other?,
    };
    let given = operands.iter().flat_map(Tree::brushes).flat_map(|brush| &brush.faces).map(|face| &face.half_space);
    let given = KnownPlanes::new(given);
    let faces = polytope.facets().into_iter().filter_map(|(plane, _)| polytope.plane(plane));
    let mut faces: Vec<HalfSpace> = faces.map(|face| given.like(face).next().unwrap_or(*face)).collect();
    faces.sort_by(compare);
    faces.dedup();
    Ok(Brush::from_half_spaces(wide_faces(&faces)?, material).into())
}
