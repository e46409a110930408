//! Removing several faces that touch: one hole, one ring.

use planecut_kernel::{DVec2, DVec3, HalfSpaceError, PlaneIdx};

use super::super::body::{edges, faces, middle, normal, outline, positions, ring};
use super::super::camera::Camera;
use super::super::color::Color;
use super::super::svg::{Stroke, Svg, Word};
use super::ball;

const TOWARD: DVec3 = DVec3::new(0.3, -0.8, 0.5);
/// The number of faces that are removed.
const COUNT: usize = 3;

pub(crate) fn figure() -> Result<String, HalfSpaceError> {
    let (before, mut planes) = ball()?;
    planes.sort_by(|a, b| normal(&before, *b).dot(TOWARD).total_cmp(&normal(&before, *a).dot(TOWARD)));
    let patch = &planes[..COUNT];
    let is_leaving = |plane: &PlaneIdx| patch.contains(plane);
    let around: Vec<PlaneIdx> =
        patch.iter().flat_map(|plane| ring(&before, *plane)).filter(|plane| !is_leaving(plane)).collect();
    let corners = before.vertices().map(|(_, vertex)| vertex.planes.iter().filter(|plane| is_leaving(plane)).count());
    let leaving: Vec<usize> = corners.filter(|planes| *planes > 0).collect();
    let border = leaving.iter().filter(|planes| **planes == 1).count();
    assert_eq!(leaving.len() + 2, 2 * COUNT + border, "the patch is a disc");
    let mut after = before.clone();
    let fresh = after.remove_planes(patch).new_vertices.to_vec();

    let mut svg = Svg::new(960.0, 400.0);
    let panel = |x: f64| Camera::new(TOWARD, DVec3::ZERO, DVec2::new(x, 200.0), 140.0);
    let [first, second] = [250.0, 710.0];
    let camera = panel(first);
    let role = |plane: PlaneIdx| match plane {
        _ if is_leaving(&plane) => Color::GONE,
        _ if around.contains(&plane) => Color::RING,
        _ => Color::PLAIN,
    };
    faces(&mut svg, &camera, &before, |plane| Some(role(plane)));
    let on_border = |p: PlaneIdx, q: PlaneIdx| is_leaving(&p) != is_leaving(&q);
    edges(&mut svg, &camera, &before, |edge| {
        on_border(edge.planes.0, edge.planes.1).then(|| Stroke::strong(Color::GONE))
    });
    for (plane, number) in patch.iter().zip(1..) {
        svg.word(camera.project(middle(&outline(&before, *plane))), &format!("q_{number}"), Word::Name);
    }
    svg.word(DVec2::new(first, 24.0), "a patch of faces and its ring", Word::Heading);
    let remark = format!("{} vertices + 2 = 2·{COUNT} faces + {border} in the ring: a disc", leaving.len());
    svg.word(DVec2::new(first, 378.0), &remark, Word::Remark);

    let camera = panel(second);
    faces(&mut svg, &camera, &after, |plane| Some(if around.contains(&plane) { Color::NEW } else { Color::PLAIN }));
    faces(&mut svg, &camera, &before, |plane| (!is_leaving(&plane)).then(|| role(plane)));
    // what was there under what is there: the border is the end of old edges and the beginning of new ones
    edges(&mut svg, &camera, &before, |edge| {
        [edge.planes.0, edge.planes.1].iter().any(is_leaving).then(|| Stroke::dashed(Color::GONE))
    });
    edges(&mut svg, &camera, &after, |_| None);
    let places = positions(&after);
    let mut dots: Vec<DVec2> = fresh.iter().map(|vertex| camera.project(places[vertex])).collect();
    dots.sort_by(|a, b| (a.x, a.y).partial_cmp(&(b.x, b.y)).expect("no NaN"));
    for dot in dots {
        svg.dot(dot, &Color::NEW.deep(), false);
    }
    svg.word(DVec2::new(second, 24.0), "removed together: one hole is closed once", Word::Heading);
    let remark = format!("{border} planes in the ring: {} new vertices", fresh.len());
    svg.word(DVec2::new(second, 378.0), &remark, Word::Remark);
    Ok(svg.finish("A patch of faces that touch is opened together: its border is one ring, and one hole is closed"))
}
