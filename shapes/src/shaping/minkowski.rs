//! Minkowski sums.
//!
//! The sum of two convex bodies has a facet for each direction in which one of them has a facet, or in which both have edges
//! that are not parallel: where an arc between the normals of neighbouring faces of one body crosses such an arc of the
//! other (the Gaussian maps laid over each other). Its distance from the origin is the sum of theirs. Which arcs cross is
//! decided by exact signs of the normals, of those alone whose boxes on the unit sphere meet.

use planecut_csg::Tree;
use planecut_csg::{Brush, MaterialId};
use planecut_kernel::sign::{Row, Sign, orient3};
use planecut_kernel::{DVec3, HalfSpace, direction_across, line_direction};
use rustc_hash::FxHashMap;

use super::boxes::{Bounds, BoxTree};
use super::convex::{Convex, Edge, parts_of_unions, wide_faces};
use crate::parameter::{ShapeError, pieces};
use crate::polyhedron::convex_tree;

/// All sums of a point of `a` and a point of `b`; empty where one of them is. All faces get the material.
///
/// Unions and other trees are summed part by part, each convex part of one with each of the other.
///
/// # Errors
/// [`ShapeError::Unbounded`] where an operand is not bounded, [`ShapeError::TooLarge`] where there would be too many pieces.
pub fn minkowski(a: &Tree, b: &Tree, material: MaterialId) -> Result<Tree, ShapeError> {
    let (a, b) = (convex_parts(a)?, convex_parts(b)?);
    pieces(a.len() as u64 * b.len() as u64)?;
    let sum_of_pair = |k: usize| {
        let faces = sum(&a[k / b.len()], &b[k % b.len()])?;
        Ok(Brush::from_half_spaces(faces, material))
    };
    let brushes = planecut_parallel::map_parts(a.len() * b.len(), sum_of_pair);
    Ok(Tree::union_of(brushes.into_iter().collect::<Result<Vec<Brush>, ShapeError>>()?))
}

fn convex_parts(tree: &Tree) -> Result<Vec<Gauss>, ShapeError> {
    let tree = convex_tree(tree)?;
    let parts = if tree.is_union() {
        parts_of_unions([&*tree])?.into_iter().map(|(_, body)| body).collect()
    } else {
        super::convex::cells(&tree)?
    };
    Ok(parts.iter().map(Gauss::of).collect())
}

/// The Gaussian map of a body.
struct Gauss {
    corners: BoxTree,
    faces: Vec<HalfSpace>,
    /// The offset of the face with a normal.
    offsets: FxHashMap<[u64; 3], f64>,
    edges: Vec<Arc>,
    /// The boxes of the arcs.
    arcs: BoxTree,
}

/// An edge: the normals of its faces, its unit direction and one of its ends.
struct Arc {
    rows: [Row; 2],
    outward: DVec3,
    direction: DVec3,
    end: DVec3,
    /// A box around the arc on the unit sphere.
    bounds: Bounds,
}

impl Gauss {
    fn of(body: &Convex) -> Self {
        let arc = |edge: &Edge| {
            let rows = edge.planes.each_ref().map(Row::new);
            let normals = edge.planes.map(|plane| unit(plane.normal()));
            let direction = line_direction(&rows[0], &rows[1]);
            Arc { rows, outward: normals[0] + normals[1], direction, end: edge.end, bounds: around_arc(normals) }
        };
        let edges: Vec<Arc> = body.edges.iter().map(arc).collect();
        let mut offsets = FxHashMap::default();
        for face in &body.half_spaces {
            offsets.entry(key(face.normal())).or_insert(face.offset());
        }
        Self {
            corners: BoxTree::new(body.corners.iter().map(|corner| [*corner; 2])),
            faces: body.half_spaces.clone(),
            offsets,
            arcs: BoxTree::new(edges.iter().map(|arc| arc.bounds)),
            edges,
        }
    }

    /// The offset in the direction of a half-space: that of the face with the same normal, where there is one.
    fn offset_along(&self, half_space: &HalfSpace) -> f64 {
        let normal = half_space.normal();
        self.offsets.get(&key(normal)).copied().unwrap_or_else(|| self.corners.reach(normal))
    }
}

/// The same for equal vectors, whatever the signs of their zeros.
fn key(v: DVec3) -> [u64; 3] {
    (v + DVec3::ZERO).to_array().map(f64::to_bits)
}

/// Far above the rounding of a unit vector.
const ROUNDING: f64 = 1e-12;

/// A box around the shorter arc between two points of the unit sphere: nowhere is it farther from the chord than in its middle.
fn around_arc([a, b]: [DVec3; 2]) -> Bounds {
    let half = 0.5 * a.distance(b);
    let height = 1.0 - (1.0 - half * half).max(0.0).sqrt() + ROUNDING;
    [a.min(b) - height, a.max(b) + height]
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
        let near = b.arcs.meeting(first.bounds).into_iter().map(|number| &b.edges[number as usize]);
        for second in near.filter(|second| crosses(first, second)) {
            planes.extend(across(first, second)?);
        }
        pieces(planes.len() as u64)?;
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
