//! Minkowski sums.
//!
//! The sum of two convex bodies has a facet for each direction in which one of them has a facet, or in which both have edges
//! that are not parallel: where an arc between the normals of neighbouring faces of one body crosses such an arc of the
//! other (the Gaussian maps laid over each other). Its distance from the origin is the sum of theirs. Which arcs cross is
//! decided by exact signs of the normals.

use planecut_csg::Tree;
use planecut_csg::{Brush, MaterialId};
use planecut_kernel::sign::{Row, Sign, orient3};
use planecut_kernel::{DVec3, HalfSpace, direction_across, line_direction};

use super::convex::{Convex, Edge, parts_of_union, wide_faces};
use crate::parameter::{ShapeError, pieces};

/// All sums of a point of `a` and a point of `b`; empty where one of them is. All faces get the material.
///
/// Unions and other trees are summed part by part, each convex part of one with each of the other.
///
/// # Errors
/// [`ShapeError::Unbounded`] where an operand is not bounded, [`ShapeError::TooLarge`] where there would be too many pieces.
pub fn minkowski(a: &Tree, b: &Tree, material: MaterialId) -> Result<Tree, ShapeError> {
    let (a, b) = (convex_parts(a)?, convex_parts(b)?);
    pieces(a.len() as u64 * b.len() as u64)?;
    let mut brushes = Vec::with_capacity(a.len() * b.len());
    for first in &a {
        for second in &b {
            brushes.push(Brush::from_half_spaces(sum(first, second)?, material));
        }
    }
    Ok(Tree::union_of(brushes))
}

fn convex_parts(tree: &Tree) -> Result<Vec<Gauss>, ShapeError> {
    let parts = if tree.is_union() {
        parts_of_union(tree)?.into_iter().map(|(_, body)| body).collect()
    } else {
        super::convex::cells(tree)?
    };
    Ok(parts.iter().map(Gauss::of).collect())
}

/// The Gaussian map of a body.
struct Gauss {
    corners: Vec<DVec3>,
    faces: Vec<HalfSpace>,
    edges: Vec<Arc>,
}

/// An edge: the normals of its faces, its unit direction and one of its ends.
struct Arc {
    rows: [Row; 2],
    outward: DVec3,
    direction: DVec3,
    end: DVec3,
}

impl Gauss {
    fn of(body: &Convex) -> Self {
        let arc = |edge: &Edge| {
            let rows = edge.planes.each_ref().map(Row::new);
            let outward = unit(edge.planes[0].normal()) + unit(edge.planes[1].normal());
            Arc { rows, outward, direction: line_direction(&rows[0], &rows[1]), end: edge.end }
        };
        let edges = body.edges.iter().map(arc).collect();
        Self { corners: body.corners.clone(), faces: body.half_spaces.clone(), edges }
    }

    /// The greatest `normal · x`.
    fn reach(&self, normal: DVec3) -> f64 {
        self.corners.iter().map(|corner| normal.dot(*corner)).fold(f64::NEG_INFINITY, f64::max)
    }

    /// The offset in the direction of a half-space: that of the face with the same normal, where there is one.
    fn offset_along(&self, half_space: &HalfSpace) -> f64 {
        let normal = half_space.normal();
        let same = self.faces.iter().find(|face| face.normal() == normal);
        same.map_or_else(|| self.reach(normal), HalfSpace::offset)
    }
}

fn unit(v: DVec3) -> DVec3 {
    (v / v.abs().max_element()).normalize()
}

/// The planes of the sum of two bodies.
fn sum(a: &Gauss, b: &Gauss) -> Result<Vec<HalfSpace>, ShapeError> {
    let mut planes = Vec::new();
    for (own, other) in [(a, b), (b, a)] {
        for face in &own.faces {
            planes.push(HalfSpace::new(face.normal(), face.offset() + other.offset_along(face))?);
        }
    }
    for first in &a.edges {
        for second in b.edges.iter().filter(|second| crosses(first, second)) {
            planes.extend(across(first, second)?);
        }
    }
    wide_faces(&planes)
}

/// Whether the arcs cross, each within the other.
fn crosses(first: &Arc, second: &Arc) -> bool {
    let ([a, b], [c, d]) = (&first.rows, &second.rows);
    let from = orient3(a, b, c);
    if from == Sign::Zero || orient3(a, b, d) != from.flip() {
        return false;
    }
    // with p = (a × b) × (c × d), the first arc crosses the other's plane at p or −p as det(c, d, a) is above or below 0,
    // and the second at p or −p as det(a, b, c) is below or above 0
    let back = orient3(c, d, a);
    back == from.flip() && orient3(c, d, b) == from
}

/// Directions farther apart than this by their sine give an accurate normal of both.
const WELL_APART: f64 = 0.125;

/// The plane along both edges.
///
/// Where edges are parallel but for rounding, arcs may lie on each other and cross anywhere: the normal must be that of the arcs
/// as they are, for a plane that is turned about such edges cuts into the sum.
fn across(first: &Arc, second: &Arc) -> Result<Option<HalfSpace>, ShapeError> {
    let mut normal = first.direction.cross(second.direction);
    if normal.length_squared() < WELL_APART * WELL_APART {
        normal = direction_across([first, second].map(|arc| arc.rows.each_ref()));
    }
    if normal == DVec3::ZERO {
        return Ok(None);
    }
    let normal = normal / normal.abs().max_element();
    let normal = if normal.dot(first.outward) < 0.0 { -normal } else { normal };
    Ok(Some(crate::primitives::plane(normal, normal.dot(first.end) + normal.dot(second.end))?))
}
