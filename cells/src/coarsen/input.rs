//! What is to be coarsened: its convex parts, and what is measured of them.

use planecut_csg::stages::{Bounds, evaluate_shape};
use planecut_csg::{Brush, Tree};
use planecut_kernel::DVec3;
use planecut_parallel::prelude::*;

use super::CoarsenError;
use super::clear::Clear;
use super::part::{Part, boxes_of, mesh_of};
use super::point_tree::PointTree;
use crate::solid::convex_union;

/// The convex parts of a tree's solid: the brushes of a union, else disjoint cells.
pub(super) fn parts_of(tree: &Tree) -> Result<Vec<Part>, CoarsenError> {
    if tree.has_meshes() {
        return Err(CoarsenError::Mesh);
    }
    convex_union(tree).iter().filter_map(|brush| Part::of_brush(brush).transpose()).collect()
}

/// The triangles of the boundaries of all parts.
pub(super) fn triangles_of(parts: &[Part]) -> Vec<[DVec3; 3]> {
    let of_one = |part: &Part| {
        let (corners, polygons) = mesh_of(&part.polytope);
        let fan = |polygon: &Vec<usize>| {
            let triangle = |pair: &[usize]| [polygon[0], pair[0], pair[1]].map(|corner| corners[corner]);
            polygon[1..].windows(2).map(triangle).collect::<Vec<_>>()
        };
        polygons.iter().flat_map(fan).collect::<Vec<[DVec3; 3]>>()
    };
    parts.iter().flat_map(of_one).collect()
}

/// The part, loosened as far as its points ask for it.
pub(super) fn held_exactly(part: &Part) -> Result<Part, CoarsenError> {
    if part.points.is_empty() { Ok(part.clone()) } else { Part::around(&[part], &Clear::default()) }
}

/// Gives each point that no part holds exactly to the nearest one, however far it is: a mesh's vertices may be off the planes of its cells by as much
/// as the rounding of its file leaves open.
pub(super) fn give_points(parts: &mut [Part], points: &[DVec3]) {
    if let [part] = parts {
        part.points = PointTree::new(points.to_vec()).outside(&part.half_spaces);
        return;
    }
    let boxes = boxes_of(parts);
    let mut near = Vec::new();
    for point in points {
        boxes.touching(&Bounds { min: *point, max: *point }, &mut near);
        if near.iter().any(|part| parts[*part as usize].polytope.contains(*point)) {
            continue;
        }
        let distance = |part: &Part| {
            let planes = part.half_spaces.iter().map(|plane| plane.signed_distance(*point));
            planes.fold(f64::NEG_INFINITY, f64::max)
        };
        if let Some(part) = parts.iter_mut().min_by(|a, b| distance(a).total_cmp(&distance(b))) {
            part.points.push(*point);
        }
    }
}

/// The sum of volumes, in the order of the parts.
pub(super) fn sum_of_volumes(parts: &[Part]) -> f64 {
    parts.par_iter().map(Part::volume).collect::<Vec<f64>>().into_iter().sum()
}

/// The volume of the union of bodies.
pub(super) fn union_volume(bodies: impl Iterator<Item = Brush>) -> Result<f64, CoarsenError> {
    Ok(evaluate_shape(Tree::union_of(bodies.collect()))?.solid.volume)
}
