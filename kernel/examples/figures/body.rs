//! Drawing a bounded polytope, or parts of it. What is drawn is ordered by place, so that a figure does not depend on how
//! the kernel numbers its vertices.

use std::collections::HashMap;

use planecut_kernel::{DVec2, DVec3, Edge, IncrementalPolytope, PlaneIdx, VertexIdx};

use super::camera::Camera;
use super::color::Color;
use super::svg::{Stroke, Svg};

/// Draws the faces of the near side, each in the colour of its role, where it has one.
pub(crate) fn faces(
    svg: &mut Svg,
    camera: &Camera,
    polytope: &IncrementalPolytope,
    role: impl Fn(PlaneIdx) -> Option<Color>,
) {
    for (plane, corners) in outlines(polytope) {
        let normal = normal(polytope, plane);
        if let Some(color) = role(plane).filter(|_| camera.sees(normal)) {
            let corners: Vec<DVec2> = corners.into_iter().map(|corner| camera.project(corner)).collect();
            svg.polygon(&corners, &color.shaded(normal), 1.0, None);
        }
    }
}

/// Draws the edges of the near side, the thicker ones of `special` last.
pub(crate) fn edges(
    svg: &mut Svg,
    camera: &Camera,
    polytope: &IncrementalPolytope,
    special: impl Fn(&Edge) -> Option<Stroke>,
) {
    let places = positions(polytope);
    let sees = |plane: PlaneIdx| camera.sees(normal(polytope, plane));
    let mut lines = Vec::new();
    for (_, edge) in polytope.edges() {
        if !edge.is_bounded() || !(sees(edge.planes.0) || sees(edge.planes.1)) {
            continue;
        }
        let mut ends = [edge.vertices.0, edge.vertices.1].map(|vertex| camera.project(places[&vertex]));
        ends.sort_by(|a, b| (a.x, a.y).partial_cmp(&(b.x, b.y)).expect("no NaN"));
        lines.push((ends, special(&edge)));
    }
    let key = |(ends, stroke): &([DVec2; 2], Option<Stroke>)| {
        (stroke.is_some(), [ends[0].x, ends[0].y, ends[1].x, ends[1].y].map(|v| (v * 10.0).round() as i64))
    };
    lines.sort_by_key(key);
    for ([from, to], stroke) in lines {
        svg.line(from, to, &stroke.unwrap_or_else(Stroke::edge));
    }
}

/// The outward normal of a plane.
pub(crate) fn normal(polytope: &IncrementalPolytope, plane: PlaneIdx) -> DVec3 {
    polytope.plane(plane).expect("the plane is there").normal()
}

/// The bounded faces, each with its corners in counter-clockwise order.
pub(crate) fn outlines(polytope: &IncrementalPolytope) -> Vec<(PlaneIdx, Vec<DVec3>)> {
    let (points, _) = polytope.to_mesh();
    let bounded = polytope.faces().into_iter().filter(|face| face.is_bounded);
    bounded.map(|face| (face.plane, face.vertices.into_iter().map(|corner| points[corner]).collect())).collect()
}

/// The corners of one face.
pub(crate) fn outline(polytope: &IncrementalPolytope, plane: PlaneIdx) -> Vec<DVec3> {
    let found = outlines(polytope).into_iter().find(|(face, _)| *face == plane);
    found.expect("the plane has a bounded face").1
}

/// The planes around a face in counter-clockwise order, from the one of the smallest handle on.
pub(crate) fn ring(polytope: &IncrementalPolytope, plane: PlaneIdx) -> Vec<PlaneIdx> {
    let facets = polytope.facets();
    let (_, edges) = facets.into_iter().find(|(face, _)| *face == plane).expect("the plane has a face");
    let mut ring: Vec<PlaneIdx> = edges.into_iter().map(|p| p.expect("the face is bounded")).collect();
    let first = (0..ring.len()).min_by_key(|at| ring[*at]).unwrap_or(0);
    ring.rotate_left(first);
    ring
}

/// The mean of some points.
pub(crate) fn middle(points: &[DVec3]) -> DVec3 {
    points.iter().copied().sum::<DVec3>() / points.len() as f64
}

/// The finite vertices.
pub(crate) fn positions(polytope: &IncrementalPolytope) -> HashMap<VertexIdx, DVec3> {
    polytope.vertices().filter_map(|(name, vertex)| Some((name, vertex.to_euclidean()?))).collect()
}
