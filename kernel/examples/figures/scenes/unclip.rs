//! Removing a face: the edges that ended on it grow, and meet in new vertices.

use std::collections::HashMap;

use planecut_kernel::{DVec2, DVec3, HalfSpaceError, IncrementalPolytope, PlaneIdx, VertexIdx};

use super::super::body::{edges, faces, middle, normal, outline, positions};
use super::super::camera::Camera;
use super::super::color::Color;
use super::super::svg::{Stroke, Svg, Word};
use super::{LETTERS, roof};

/// The sides around the face that is removed.
const SIDES: [([f64; 3], f64); 5] = [
    ([1.0, 0.1, 0.55], 2.2),
    ([0.3, 1.0, 0.8], 1.9),
    ([-0.8, 0.75, 0.75], 2.0),
    ([-0.9, -0.5, 0.6], 2.2),
    ([0.2, -1.0, 0.75], 2.0),
];
/// How far the arrows lead out of the hole.
const ARROW: f64 = 0.75;

pub(crate) fn figure() -> Result<String, HalfSpaceError> {
    let (before, sides, top) = roof(&SIDES, 1.0)?;
    let mut after = before.clone();
    let fresh = after.remove_plane(top).map(|result| result.new_vertices.to_vec()).unwrap_or_default();
    let mut svg = Svg::new(960.0, 370.0);
    let panel =
        |x: f64| Camera::new(DVec3::new(0.28, -0.66, 0.95), DVec3::new(0.0, 0.0, 0.6), DVec2::new(x, 180.0), 60.0);
    let [first, second, third] = [165.0, 480.0, 795.0];

    let camera = panel(first);
    let role = |plane| if plane == top { Some(Color::GONE) } else { Some(Color::RING) };
    faces(&mut svg, &camera, &before, role);
    edges(&mut svg, &camera, &before, |edge| edge.is_on_plane(top).then(|| Stroke::strong(Color::GONE)));
    svg.word(camera.project(middle(&outline(&before, top))), "h", Word::Name);
    letters(&mut svg, &camera, &before, &sides);
    title(&mut svg, first, "a face h and its ring", "h had cut five edges short");

    let camera = panel(second);
    hole(&mut svg, &camera, &before, top);
    letters(&mut svg, &camera, &before, &sides);
    title(&mut svg, second, "h is taken away", "the edges it cut grow again");

    let camera = panel(third);
    faces(&mut svg, &camera, &after, |_| Some(Color::NEW));
    faces(&mut svg, &camera, &before, |plane| (plane != top).then_some(Color::RING));
    let places = positions(&after);
    edges(&mut svg, &camera, &after, |_| None);
    let corners = outline(&before, top);
    let mut grown = Vec::new();
    for (_, edge) in after.edges().filter(|(_, edge)| fresh.iter().any(|v| edge.other_vertex(*v).is_some())) {
        // an edge that grew is new from the removed face on
        let height = corners[0].z;
        let [low, high] = in_height(edge.vertices, &places);
        let from = if low.z < height { low + (high - low) * ((height - low.z) / (high.z - low.z)) } else { low };
        grown.push((camera.project(from), camera.project(high)));
    }
    grown.sort_by(|a, b| (a.0 + a.1).x.total_cmp(&(b.0 + b.1).x));
    for (from, to) in grown {
        svg.line(from, to, &Stroke::strong(Color::NEW));
    }
    let corners: Vec<DVec2> = corners.into_iter().map(|corner| camera.project(corner)).collect();
    svg.polygon(&corners, "none", 1.0, Some(&Stroke::dashed(Color::GONE)));
    dots(&mut svg, &camera, fresh.iter().map(|vertex| places[vertex]).collect());
    letters(&mut svg, &camera, &before, &sides);
    let remark = format!("{} new vertices, on planes of the ring", fresh.len());
    title(&mut svg, third, "each ends at the next plane", &remark);
    Ok(svg.finish("Removing a face: the edges that ended on it grow until they meet the next plane"))
}

/// The body with its open top: the inside, and where its edges go on.
fn hole(svg: &mut Svg, camera: &Camera, before: &IncrementalPolytope, top: PlaneIdx) {
    faces(svg, camera, before, |plane| Some(if plane == top { Color::INSIDE } else { Color::RING }));
    edges(svg, camera, before, |edge| edge.is_on_plane(top).then(|| Stroke::dashed(Color::GONE)));
    let places = positions(before);
    let mut arrows = Vec::new();
    for (_, edge) in before.edges().filter(|(_, edge)| !edge.is_on_plane(top)) {
        let [low, high] = in_height(edge.vertices, &places);
        if before.plane(top).is_some_and(|plane| plane.signed_distance(high) > -1e-9) {
            arrows.push((high, high + (high - low).normalize() * ARROW));
        }
    }
    arrows.sort_by(|a, b| a.0.x.total_cmp(&b.0.x));
    for (from, to) in arrows {
        svg.arrow(camera.project(from), camera.project(to), &Stroke::strong(Color::NEW));
    }
}

/// The ends of an edge, the lower one first.
fn in_height((a, b): (VertexIdx, VertexIdx), places: &HashMap<VertexIdx, DVec3>) -> [DVec3; 2] {
    let [a, b] = [places[&a], places[&b]];
    if a.z < b.z { [a, b] } else { [b, a] }
}

fn dots(svg: &mut Svg, camera: &Camera, mut points: Vec<DVec3>) {
    points.sort_by(|a, b| a.x.total_cmp(&b.x));
    for point in points {
        svg.dot(camera.project(point), &Color::NEW.deep(), false);
    }
}

/// The names of the sides that can be seen, in the middle of their faces.
fn letters(svg: &mut Svg, camera: &Camera, body: &IncrementalPolytope, sides: &[PlaneIdx]) {
    for (side, letter) in sides.iter().zip(LETTERS) {
        if camera.sees(normal(body, *side)) {
            svg.word(camera.project(middle(&outline(body, *side))), letter, Word::Name);
        }
    }
}

fn title(svg: &mut Svg, x: f64, heading: &str, remark: &str) {
    svg.word(DVec2::new(x, 24.0), heading, Word::Heading);
    svg.word(DVec2::new(x, 346.0), remark, Word::Remark);
}
