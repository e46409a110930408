//! The certificate of a redundant plane, and what happens when it breaks.

use planecut_kernel::{DVec2, DVec3, HalfSpace, HalfSpaceError, IncrementalPolytope, PlaneIdx, Support};

use super::super::body::{edges, faces, middle, normal, outline};
use super::super::camera::Camera;
use super::super::color::Color;
use super::super::svg::{Stroke, Svg, Word};
use super::add;

/// A box with slightly tilted faces; the last three meet at the corner that faces the viewer.
const SIDES: [([f64; 3], f64); 6] = [
    ([-1.0, 0.05, 0.0], 0.0),
    ([0.0, 1.0, 0.04], 1.2),
    ([0.0, 0.0, -1.0], 0.0),
    ([1.0, 0.06, 0.10], 1.2),
    ([0.05, -1.0, 0.08], 0.0),
    ([0.05, -0.06, 1.0], 0.95),
];
/// The redundant plane: beyond the corner.
const REDUNDANT: ([f64; 3], f64) = ([0.62, -0.58, 0.55], 1.30);
/// A second plane that the top hides, so that the body stays bounded without the top.
const LID: ([f64; 3], f64) = ([-0.05, 0.04, 1.0], 1.75);
const TOWARD: DVec3 = DVec3::new(0.22, -0.9, 0.42);

pub(crate) fn figure() -> Result<String, HalfSpaceError> {
    let mut before = IncrementalPolytope::new();
    let mut planes = Vec::new();
    for (normal, offset) in SIDES {
        planes.push(add(&mut before, normal, offset)?);
    }
    let [.., a, b, c] = planes[..] else { unreachable!("there are six") };
    let hidden = add(&mut before, REDUNDANT.0, REDUNDANT.1)?;
    let lid = add(&mut before, LID.0, LID.1)?;
    let mut after = before.clone();
    after.remove_plane(c);
    let corner = match before.support(DVec3::from_array(REDUNDANT.0)) {
        Some(Support::Vertex { vertex, position }) => (vertex, position),
        found => unreachable!("a box has a corner in each direction, not {found:?}"),
    };
    let certifiers = before.vertex(corner.0).map(|vertex| vertex.planes);
    assert_eq!(certifiers, Some(vec![a, b, c]), "the figure shows what the kernel keeps");

    let mut svg = Svg::new(960.0, 400.0);
    let panel = |x: f64| Camera::new(TOWARD, DVec3::new(0.6, 0.6, 0.75), DVec2::new(x, 215.0), 140.0);
    let [first, second] = [240.0, 720.0];

    let camera = panel(first);
    body(&mut svg, &camera, &before, c, None);
    sheet(&mut svg, &camera, corner.1)?;
    names(&mut svg, &camera, &before, &[(a, "a"), (b, "b"), (c, "c")]);
    normals(&mut svg, &camera, &before, corner.1, [(a, ""), (b, ""), (c, ""), (hidden, "n_r")]);
    svg.word(DVec2::new(first, 24.0), "r is redundant: certificate (a, b, c)", Word::Heading);
    let remark = "its normal lies between the normals of a, b, c";
    svg.word(DVec2::new(first, 378.0), remark, Word::Remark);

    let camera = panel(second);
    body(&mut svg, &camera, &after, c, Some(&before));
    names(&mut svg, &camera, &after, &[(a, "a"), (b, "b"), (hidden, "r"), (lid, "l")]);
    let gone: Vec<DVec2> = outline(&before, c).into_iter().map(|corner| camera.project(corner)).collect();
    svg.polygon(&gone, "none", 1.0, Some(&Stroke::dashed(Color::GONE)));
    svg.word(DVec2::new(second, 24.0), "c is removed: its list is looked at", Word::Heading);
    svg.word(DVec2::new(second, 378.0), "r and l were on it, both have a face now", Word::Remark);
    Ok(svg.finish("A redundant plane keeps three planes as its certificate; removing one of them examines it again"))
}

/// The faces by role: what grew is new, what shows itself was hidden.
fn body(
    svg: &mut Svg,
    camera: &Camera,
    polytope: &IncrementalPolytope,
    removed: PlaneIdx,
    before: Option<&IncrementalPolytope>,
) {
    faces(svg, camera, polytope, |plane| {
        Some(match before {
            None if plane == removed => Color::GONE,
            None => Color::RING,
            Some(before) if before.is_redundant(plane) => Color::HIDDEN,
            Some(_) => Color::NEW,
        })
    });
    if let Some(before) = before {
        faces(svg, camera, before, |plane| (plane != removed).then_some(Color::RING));
    }
    edges(svg, camera, polytope, |_| None);
}

/// The names of faces, each in the middle of its own.
fn names(svg: &mut Svg, camera: &Camera, polytope: &IncrementalPolytope, named: &[(PlaneIdx, &str)]) {
    for (plane, name) in named {
        svg.word(camera.project(middle(&outline(polytope, *plane))), name, Word::Name);
    }
}

/// The part of the redundant plane over the corner.
fn sheet(svg: &mut Svg, camera: &Camera, corner: DVec3) -> Result<(), HalfSpaceError> {
    let (normal, offset) = (DVec3::from_array(REDUNDANT.0), REDUNDANT.1);
    let foot = corner + normal * ((offset - normal.dot(corner)) / normal.length_squared());
    let mut window = IncrementalPolytope::new();
    let shown = window.add_plane(HalfSpace::new(normal, offset)?).plane();
    // an oblong around the foot, within the plane
    let across = DVec3::Z.cross(normal).normalize();
    let up = normal.cross(across).normalize();
    for (direction, reach) in [(across, 0.42), (-across, 0.42), (up, 0.33), (-up, 0.33), (-normal, 1.0)] {
        window.add_plane(HalfSpace::new(direction, direction.dot(foot) + reach)?);
    }
    let sheet: Vec<DVec2> = outline(&window, shown).into_iter().map(|p| camera.project(p)).collect();
    svg.polygon(&sheet, &Color::HIDDEN.flat(), 0.55, Some(&Stroke::dashed(Color::HIDDEN)));
    let place = camera.project(foot + (across * -0.3 + up * 0.2));
    svg.word(place, "r", Word::Name);
    Ok(())
}

/// The normals at the corner, each from there.
fn normals(
    svg: &mut Svg,
    camera: &Camera,
    polytope: &IncrementalPolytope,
    corner: DVec3,
    planes: [(PlaneIdx, &str); 4],
) {
    for (plane, name) in planes {
        let direction = normal(polytope, plane).normalize();
        let color = if name.is_empty() { Color::RING } else { Color::HIDDEN };
        svg.arrow(camera.project(corner), camera.project(corner + direction * 0.5), &Stroke::strong(color));
        if !name.is_empty() {
            svg.word(camera.project(corner + direction * 0.62), name, Word::Name);
        }
    }
    svg.dot(camera.project(corner), super::super::color::INK, false);
}
