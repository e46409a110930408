//! The convex hull of solids.

use planecut_kernel::{DVec3, HalfSpace, HullError};

use super::convex::{Convex, evaluated, is_union, parts_of_union, wide_faces};
use crate::brush::{Brush, MaterialId};
use crate::plane_table::SNAP_TOLERANCE;
use crate::primitives::ShapeError;
use crate::tree::Tree;

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
    let mut bodies: Vec<(&Brush, Convex)> = Vec::new();
    let mut corners: Vec<DVec3> = points.to_vec();
    for operand in operands {
        if is_union(operand) {
            bodies.extend(parts_of_union(operand)?);
        } else {
            corners.extend(evaluated(operand)?.mesh.positions);
        }
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
    let given = Faces::of(operands);
    let faces = polytope.facets().into_iter().filter_map(|(plane, _)| polytope.plane(plane));
    let mut faces: Vec<HalfSpace> = faces.map(|face| given.same_or(face)).collect();
    faces.sort_by(compare);
    faces.dedup();
    Ok(Brush::from_half_spaces(wide_faces(&faces)?, material).into())
}

fn key(half_space: &HalfSpace) -> [f64; 4] {
    let [x, y, z] = half_space.normal().to_array();
    [x, y, z, half_space.offset()]
}

/// The planes of operands, by the first component of their unit normals.
struct Faces {
    faces: Vec<(DVec3, f64, HalfSpace)>,
    size: f64,
}

impl Faces {
    fn of(operands: &[Tree]) -> Self {
        let faces = operands.iter().flat_map(Tree::brushes).flat_map(|brush| &brush.faces);
        let mut faces: Vec<(DVec3, f64, HalfSpace)> = faces.map(|face| unit(&face.half_space)).collect();
        faces.sort_by(|a, b| a.0.x.total_cmp(&b.0.x).then_with(|| compare(&a.2, &b.2)));
        let size = faces.iter().map(|face| face.1.abs()).fold(0.0, f64::max);
        Self { faces, size }
    }

    /// The plane of an operand that the half-space is but for rounding; else the half-space itself.
    fn same_or(&self, half_space: &HalfSpace) -> HalfSpace {
        let (normal, distance, own) = unit(half_space);
        let start = self.faces.partition_point(|face| face.0.x < normal.x - SNAP_TOLERANCE);
        let near = self.faces[start..].iter().take_while(|face| face.0.x <= normal.x + SNAP_TOLERANCE);
        let is_same = |face: &&(DVec3, f64, HalfSpace)| {
            (face.0 - normal).abs().max_element() <= SNAP_TOLERANCE
                && (face.1 - distance).abs() <= SNAP_TOLERANCE * self.size
        };
        near.filter(is_same).map(|face| face.2).next().unwrap_or(own)
    }
}

fn compare(a: &HalfSpace, b: &HalfSpace) -> std::cmp::Ordering {
    key(a).partial_cmp(&key(b)).unwrap_or(std::cmp::Ordering::Equal)
}

fn unit(half_space: &HalfSpace) -> (DVec3, f64, HalfSpace) {
    // no component leaves the range of numbers
    let scale = half_space.normal().abs().max_element();
    let normal = half_space.normal() / scale;
    let length = normal.length();
    (normal / length, half_space.offset() / scale / length, *half_space)
}
