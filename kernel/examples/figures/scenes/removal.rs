//! The removal lemma: only planes of the ring bound what is new, because a face that grows had an edge with what is removed.

use planecut_kernel::{DVec2, DVec3, HalfSpaceError, IncrementalPolytope, PlaneIdx};

use super::super::body::{edges, faces, middle, normal, outline, ring};
use super::super::camera::Camera;
use super::super::color::Color;
use super::super::svg::{Stroke, Svg, Word};
use super::{LETTERS, ball};

const TOWARD: DVec3 = DVec3::new(0.35, -0.8, 0.62);

pub(crate) fn figure() -> Result<String, HalfSpaceError> {
    let (before, planes) = ball()?;
    let facing = |plane: &PlaneIdx| normal(&before, *plane).dot(TOWARD);
    let six = planes.iter().copied().filter(|plane| ring(&before, *plane).len() >= 6);
    let removed = six.max_by(|a, b| facing(a).total_cmp(&facing(b))).expect("a ball has hexagons");
    let around = ring(&before, removed);
    let mut after = before.clone();
    after.remove_plane(removed);

    let mut svg = Svg::new(960.0, 370.0);
    let panel = |x: f64| Camera::new(TOWARD, DVec3::ZERO, DVec2::new(x, 185.0), 126.0);
    let [first, second, third] = [165.0, 480.0, 795.0];

    let camera = panel(first);
    let role = |plane| match plane {
        _ if plane == removed => Color::GONE,
        _ if around.contains(&plane) => Color::RING,
        _ => Color::PLAIN,
    };
    faces(&mut svg, &camera, &before, |plane| Some(role(plane)));
    edges(&mut svg, &camera, &before, |edge| edge.is_on_plane(removed).then(|| Stroke::strong(Color::GONE)));
    svg.word(camera.project(middle(&outline(&before, removed))), "h", Word::Name);
    letters(&mut svg, &camera, &before, &around);
    title(&mut svg, first, "before: h and its ring", "the ring: planes with an edge on h");

    let camera = panel(second);
    faces(&mut svg, &camera, &after, |plane| Some(if around.contains(&plane) { Color::NEW } else { Color::PLAIN }));
    faces(&mut svg, &camera, &before, |plane| around.contains(&plane).then_some(Color::RING));
    edges(&mut svg, &camera, &after, |_| None);
    let corners: Vec<DVec2> = outline(&before, removed).into_iter().map(|corner| camera.project(corner)).collect();
    svg.polygon(&corners, "none", 1.0, Some(&Stroke::dashed(Color::GONE)));
    letters(&mut svg, &camera, &before, &around);
    title(&mut svg, second, "after: only the ring reaches out", "all others keep their faces");

    let facing = |plane: &&PlaneIdx| normal(&before, **plane).dot(TOWARD);
    let shown = *around.iter().max_by(|a, b| facing(a).total_cmp(&facing(b))).expect("a ring has planes");
    let letter = LETTERS[around.iter().position(|plane| *plane == shown).expect("it is one of the ring")];
    one_face(&mut svg, third, [&before, &after], [removed, shown], letter);
    title(&mut svg, third, &format!("why: the plane {letter} alone"), "");
    Ok(svg.finish("Only planes of the ring bound the new region: a face that grows had an edge with the removed one"))
}

/// The face of one plane of the ring, seen straight on: what it was and what it grew by.
fn one_face(
    svg: &mut Svg,
    x: f64,
    [before, after]: [&IncrementalPolytope; 2],
    [removed, shown]: [PlaneIdx; 2],
    letter: &str,
) {
    let (old, new) = (outline(before, shown), outline(after, shown));
    let away = normal(after, shown);
    let camera = Camera::new(away, middle(&new), DVec2::new(x, 170.0), 250.0);
    let on_page = |points: &[DVec3]| points.iter().map(|point| camera.project(*point)).collect::<Vec<DVec2>>();
    let edge = Stroke::edge();
    svg.polygon(&on_page(&new), &Color::NEW.flat(), 1.0, Some(&edge));
    svg.polygon(&on_page(&old), &Color::RING.flat(), 1.0, Some(&edge));
    let plane = before.plane(removed).expect("the plane is there");
    let shared: Vec<DVec3> = old.iter().copied().filter(|p| plane.signed_distance(*p).abs() < 1e-9).collect();
    svg.line(camera.project(shared[0]), camera.project(shared[1]), &Stroke::strong(Color::GONE));
    let beyond: Vec<DVec3> = new.iter().copied().filter(|p| plane.signed_distance(*p) > 1e-9).collect();
    let mut grown = beyond;
    grown.extend(&shared);
    svg.word(camera.project(middle(&old)), "g", Word::Name);
    svg.word(camera.project(middle(&grown)), "new", Word::Name);
    svg.word(DVec2::new(x, 322.0), &format!("g: the face of {letter} before"), Word::Remark);
    svg.colored_word(DVec2::new(x, 346.0), "it can only grow across an edge with h", Word::Remark, &Color::GONE.deep());
}

fn letters(svg: &mut Svg, camera: &Camera, body: &IncrementalPolytope, around: &[PlaneIdx]) {
    for (plane, letter) in around.iter().zip(LETTERS) {
        if camera.sees(normal(body, *plane)) {
            svg.word(camera.project(middle(&outline(body, *plane))), letter, Word::Name);
        }
    }
}

fn title(svg: &mut Svg, x: f64, heading: &str, remark: &str) {
    svg.word(DVec2::new(x, 24.0), heading, Word::Heading);
    svg.word(DVec2::new(x, 346.0), remark, Word::Remark);
}
