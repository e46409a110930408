//! Closing a hole: the new vertices triangulate the ring in the dual.

use planecut_kernel::{DVec2, DVec3, HalfSpaceError, IncrementalPolytope, PlaneIdx, VertexIdx};

use super::super::body::{edges, faces, middle, normal, outline};
use super::super::camera::Camera;
use super::super::color::Color;
use super::super::svg::{Stroke, Svg, Word};
use super::{LETTERS, roof};

/// The sides around the face that is removed, counter-clockwise.
const SIDES: [([f64; 3], f64); 7] = [
    ([1.0, 0.10, 0.85], 2.9),
    ([0.40, 1.0, 0.95], 2.15),
    ([-0.22, 1.0, 0.80], 1.75),
    ([-0.95, 0.45, 0.90], 2.75),
    ([-0.85, -0.55, 0.75], 2.6),
    ([-0.08, -1.0, 0.75], 1.65),
    ([0.55, -0.95, 0.90], 2.25),
];
/// How far the corners of the dual polygon lie from its middle.
const RADIUS: f64 = 118.0;

/// A new vertex: where it lies, and the places of its planes in the ring, ascending.
struct Fresh {
    point: DVec3,
    at: [usize; 3],
}

pub(crate) fn figure() -> Result<String, HalfSpaceError> {
    let (before, sides, top) = roof(&SIDES, 0.7)?;
    let mut after = before.clone();
    let fresh = after.remove_plane(top).map(|result| result.new_vertices.to_vec()).unwrap_or_default();
    let found = in_order_of_filling(&after, &fresh, &sides);

    let mut svg = Svg::new(960.0, 400.0);
    let [first, second] = [265.0, 700.0];
    let camera = Camera::new(DVec3::Z, DVec3::ZERO, DVec2::new(first, 205.0), 64.0);
    faces(&mut svg, &camera, &after, |_| Some(Color::NEW));
    faces(&mut svg, &camera, &before, |plane| (plane != top).then_some(Color::RING));
    let is_entrance = |a: PlaneIdx, b: PlaneIdx| [a, b].contains(&sides[0]) && [a, b].contains(&sides[sides.len() - 1]);
    edges(&mut svg, &camera, &after, |edge| {
        is_entrance(edge.planes.0, edge.planes.1).then(|| Stroke::strong(Color::GONE))
    });
    let corners: Vec<DVec2> = outline(&before, top).into_iter().map(|corner| camera.project(corner)).collect();
    svg.polygon(&corners, "none", 1.0, Some(&Stroke::dashed(Color::GONE)));
    for (side, letter) in sides.iter().zip(LETTERS) {
        svg.word(camera.project(middle(&outline(&before, *side))), letter, Word::Name);
    }
    for (vertex, number) in found.iter().zip(1..) {
        numbered(&mut svg, camera.project(vertex.point), number);
    }
    svg.word(DVec2::new(first, 24.0), "the hole from above, closed", Word::Heading);
    let [a, g] = [LETTERS[0], LETTERS[sides.len() - 1]];
    let between = LETTERS[found[0].at[1]];
    let remark = format!("1: the edge of {a} and {g} comes in and leaves {between} first");
    svg.word(DVec2::new(first, 378.0), &remark, Word::Remark);

    dual(&mut svg, DVec2::new(second, 205.0), &sides, &found, &before);
    svg.word(DVec2::new(second, 24.0), "the same in the dual: a triangulated ring", Word::Heading);
    svg.word(DVec2::new(second, 378.0), "corner: plane, line: edge, triangle: new vertex", Word::Remark);
    Ok(svg.finish("Closing a hole: the new vertices are a triangulation of the ring"))
}

/// The new vertices in the order in which the filling finds them if it starts with the edge of the first and last plane.
fn in_order_of_filling(after: &IncrementalPolytope, fresh: &[VertexIdx], sides: &[PlaneIdx]) -> Vec<Fresh> {
    let place = |plane: &PlaneIdx| sides.iter().position(|side| side == plane).expect("only ring planes meet there");
    let vertices = fresh.iter().filter_map(|vertex| after.vertex(*vertex)).map(|vertex| {
        let mut at: Vec<usize> = vertex.planes.iter().map(place).collect();
        at.sort_unstable();
        let at = at.try_into().expect("three planes meet there");
        Fresh { point: vertex.to_euclidean().expect("it is finite"), at }
    });
    let mut vertices: Vec<Fresh> = vertices.collect();
    let mut order = Vec::new();
    let mut open = vec![(0, sides.len() - 1)];
    while let Some((first, last)) = open.pop() {
        let ends_at = |vertex: &Fresh| vertex.at[0] == first && vertex.at[2] == last;
        let number = vertices.iter().position(ends_at).expect("each edge ends in a vertex");
        let vertex = vertices.swap_remove(number);
        let between = vertex.at[1];
        open.extend([(first, between), (between, last)].into_iter().filter(|(i, j)| i + 1 < *j));
        order.push(vertex);
    }
    order
}

fn dual(svg: &mut Svg, center: DVec2, sides: &[PlaneIdx], found: &[Fresh], body: &IncrementalPolytope) {
    let corner = |at: usize| {
        let direction = normal(body, sides[at]).truncate().normalize();
        center + DVec2::new(direction.x, -direction.y) * RADIUS
    };
    let ring: Vec<DVec2> = (0..sides.len()).map(corner).collect();
    svg.polygon(&ring, &Color::NEW.flat(), 1.0, None);
    for vertex in found {
        let triangle = vertex.at.map(corner);
        svg.polygon(&triangle, "none", 1.0, Some(&Stroke::edge()));
    }
    svg.line(corner(0), corner(sides.len() - 1), &Stroke::strong(Color::GONE));
    for (vertex, number) in found.iter().zip(1..) {
        numbered(svg, vertex.at.map(corner).into_iter().sum::<DVec2>() / 3.0, number);
    }
    for (at, letter) in (0..sides.len()).zip(LETTERS) {
        svg.dot(corner(at), &Color::RING.deep(), false);
        svg.word(center + (corner(at) - center) * 1.17, letter, Word::Name);
    }
}

/// A vertex with its number.
fn numbered(svg: &mut Svg, at: DVec2, number: usize) {
    svg.badge(at, &Color::NEW.deep(), &number.to_string());
}
