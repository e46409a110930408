//! An unbounded set: what is stored, closed by infinity planes, and what is seen.

use planecut_kernel::{DVec2, DVec3, Edge, EdgeKind, HalfSpace, HalfSpaceError, IncrementalPolytope, PlaneIdx, Vertex};

use super::super::body::{edges, faces, middle, normal, outlines, positions};
use super::super::camera::Camera;
use super::super::color::{Color, INK};
use super::super::svg::{Stroke, Svg, Word};
use super::add;

/// A cup: a floor and sides that lean outward; one of them cuts a corner off the floor.
const CUP: [([f64; 3], f64); 6] = [
    ([0.0, 0.0, -1.0], 0.0),
    ([1.0, 0.15, -0.55], 1.0),
    ([-0.1, 1.0, -0.6], 1.0),
    ([-1.0, 0.1, -0.5], 1.0),
    ([0.1, -1.0, -0.5], 1.0),
    ([0.8, -0.9, -0.2], 1.45),
];
/// The normals of the kernel's infinity planes (`kernel/src/polytope/infinity.rs`).
const INFINITY: [[f64; 3]; 4] =
    [[97.0, 101.0, 89.0], [103.0, -83.0, -107.0], [-109.0, 79.0, -91.0], [-85.0, -99.0, 113.0]];
/// What stands for `M` in the picture.
const FAR: f64 = 330.0;
/// The height at which the drawn faces end.
const RIM: f64 = 1.9;
/// How far rays are drawn beyond it.
const BEYOND: f64 = 0.6;

pub(crate) fn figure() -> Result<String, HalfSpaceError> {
    let mut cup = IncrementalPolytope::new();
    for (normal, offset) in CUP {
        add(&mut cup, normal, offset)?;
    }
    let mut closed = cup.clone();
    let mut lids = Vec::new();
    for normal in INFINITY {
        lids.push(add(&mut closed, normal, FAR)?);
    }
    let stored = cup.simple_vertices().count();
    assert_eq!(closed.vertex_count(), stored, "the picture's M is large enough to show the kernel's own structure");

    let mut svg = Svg::new(960.0, 410.0);
    let toward = DVec3::new(0.9, -0.55, 0.5);
    let [first, second] = [240.0, 720.0];

    let camera = Camera::new(toward, DVec3::new(0.0, 0.0, 2.1), DVec2::new(first, 205.0), 56.0);
    let role = |plane: PlaneIdx| if lids.contains(&plane) { Color::HIDDEN } else { Color::RING };
    faces(&mut svg, &camera, &closed, |plane| Some(role(plane)));
    let at_infinity = |edge: &Edge| lids.iter().any(|lid| edge.is_on_plane(*lid));
    edges(&mut svg, &camera, &closed, |edge| at_infinity(edge).then(|| Stroke::strong(Color::HIDDEN)));
    let shown: Vec<(usize, Vec<DVec3>)> = outlines(&closed)
        .into_iter()
        .filter_map(|(plane, face)| Some((lids.iter().position(|lid| *lid == plane)?, face)))
        .collect();
    for (number, face) in &shown {
        if camera.sees(normal(&closed, lids[*number])) {
            svg.word(camera.project(middle(face)), &format!("m_{number}"), Word::Name);
        }
    }
    svg.word(DVec2::new(first, 24.0), "what is stored: closed at infinity", Word::Heading);
    let remark = format!("{stored} vertices, {} of 4 infinity planes have a face", shown.len());
    svg.word(DVec2::new(first, 388.0), &remark, Word::Remark);

    let camera = Camera::new(toward, DVec3::new(0.0, 0.0, 1.1), DVec2::new(second, 215.0), 62.0);
    opened(&mut svg, &camera, &cup);
    svg.word(DVec2::new(second, 24.0), "what is seen: rays to ideal vertices", Word::Heading);
    let finite = positions(&cup).len();
    let remark = format!("{finite} points and {} ideal vertices (x, y, z, 0)", cup.vertex_count() - finite);
    svg.word(DVec2::new(second, 388.0), &remark, Word::Remark);
    Ok(svg.finish("An unbounded set is stored closed by infinity planes and seen without them"))
}

/// The set with its rays, the faces cut off where the picture ends.
fn opened(svg: &mut Svg, camera: &Camera, cup: &IncrementalPolytope) {
    let mut drawn = cup.clone();
    let rim = drawn.add_plane(HalfSpace::new(DVec3::Z, RIM).expect("an accepted plane")).plane();
    faces(svg, camera, &drawn, |plane| Some(if plane == rim { Color::INSIDE } else { Color::RING }));
    let places = positions(cup);
    let (mut rays, mut segments) = (Vec::new(), Vec::new());
    for (_, edge) in cup.edges() {
        let is_near = [edge.planes.0, edge.planes.1].into_iter().any(|plane| camera.sees(normal(cup, plane)));
        let from = places[&edge.vertices.0];
        match edge.kind {
            EdgeKind::Segment if is_near => {
                segments.push((camera.project(from), camera.project(places[&edge.vertices.1])));
            }
            EdgeKind::Ray => {
                let at_rim = from + edge.direction * ((RIM - from.z) / edge.direction.z);
                rays.push((if is_near { from } else { at_rim }, at_rim + edge.direction * BEYOND));
            }
            _ => {}
        }
    }
    segments.sort_by(|a, b| (a.0 + a.1).x.total_cmp(&(b.0 + b.1).x));
    for (from, to) in segments {
        svg.line(from, to, &Stroke::edge());
    }
    rays.sort_by(|a, b| (a.1.x, a.1.y).partial_cmp(&(b.1.x, b.1.y)).expect("no NaN"));
    for (from, to) in rays {
        svg.arrow(camera.project(from), camera.project(to), &Stroke::edge());
        svg.dot(camera.project(to + (to - from).normalize() * 0.16), &Color::HIDDEN.deep(), true);
    }
    let is_near = |vertex: &Vertex| vertex.planes.iter().any(|plane| camera.sees(normal(cup, *plane)));
    let near = cup.vertices().filter(|(_, vertex)| is_near(vertex));
    let mut points: Vec<DVec2> = near.filter_map(|(_, vertex)| Some(camera.project(vertex.to_euclidean()?))).collect();
    points.sort_by(|a, b| (a.x, a.y).partial_cmp(&(b.x, b.y)).expect("no NaN"));
    for point in points {
        svg.dot(point, INK, false);
    }
}
