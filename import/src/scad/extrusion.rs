//! Solids from regions of the plane.

use planecut_csg::{Transform, Tree, sine_and_cosine};
use planecut_kernel::{DVec2, DVec3};
use planecut_shapes::ShapeError;
use planecut_shapes::outline::Outline;
use planecut_shapes::primitives::{self, Extrusion, LayerRules};

use super::arguments::Arguments;
use super::evaluate::Evaluator;
use super::fragments::{Fragments, TooMany};
use super::problem::{Body, Geometry, Made, Problem};
use super::turn::Turn;
use super::{polyhedron, solid};

/// `linear_extrude`: an outline drawn up along z, turned and stretched on the way.
pub(super) fn linear(turn: Turn<'_, '_>, outline: &Outline) -> Made {
    let arguments = Arguments::of(turn.node, &["height"]);
    refuse_file(&arguments)?;
    let height = arguments.number_or("height", 100.0);
    if outline.is_empty() || !(height > 0.0 && height.is_finite()) {
        return Ok(Some(Tree::empty().into()));
    }
    let scale = DVec2::from_array(arguments.size::<2>("scale")).max(DVec2::ZERO);
    let twist = arguments.number("twist").filter(|twist| twist.is_finite()).unwrap_or(0.0);
    let extrusion = Extrusion {
        height,
        twist,
        scale,
        slices: Some(slices(&arguments, outline, height, twist, scale)?),
        center: arguments.is_set("center"),
        rules: LayerRules::OpenScad,
    };
    let tree = primitives::extrude(outline, &extrusion, turn.frame.material)?;
    let touches_itself =
        touches_in_plane(outline) || scale.min_element() == 0.0 && touches_on_top(outline, twist, scale);
    Ok(Some(Geometry::Solid(Body { tree, touches_itself, ..Body::default() })))
}

/// Whether loops meet in a corner, so that an upright edge has four faces.
fn touches_in_plane(outline: &Outline) -> bool {
    let mut corners: Vec<[u64; 2]> =
        outline.loops().flatten().map(|p| (*p + DVec2::ZERO).to_array().map(f64::to_bits)).collect();
    corners.sort_unstable();
    corners.windows(2).any(|pair| pair[0] == pair[1])
}

/// The grid on which OpenSCAD finds corners at the same place.
const GRID: f64 = 1.0 / (1u64 << 20) as f64;

/// Whether the sides are no manifold where the top is a line or a point, below which each loop is closed by a tip of its own.
fn touches_on_top(outline: &Outline, twist: f64, scale: DVec2) -> bool {
    let (sine, cosine) = sine_and_cosine(-twist);
    let on_top = |p: DVec2| {
        let turned = DVec2::new(cosine * p.x - sine * p.y, sine * p.x + cosine * p.y) * scale;
        (turned / GRID).round() * GRID
    };
    let (mut points, mut facets): (Vec<DVec3>, Vec<Vec<u32>>) = (Vec::new(), Vec::new());
    for (number, corners) in outline.loops().enumerate() {
        let (first, n) = (points.len() as u32, corners.len() as u32);
        points.extend(corners.iter().map(|p| p.extend(0.0)));
        points.extend(corners.iter().map(|p| on_top(*p).extend(1.0)));
        points.push(DVec3::new(number as f64, 0.0, -1.0));
        for k in 0..n {
            let (p, q, tip) = (first + k, first + (k + 1) % n, first + 2 * n);
            facets.push(vec![q, p, tip]);
            if points[(p + n) as usize] == points[(q + n) as usize] {
                facets.push(vec![p, q, q + n]);
            } else {
                facets.push(vec![p, q, q + n, p + n]);
            }
        }
    }
    polyhedron::touches_itself(&points, &facets)
}

fn slices(
    arguments: &Arguments<'_, '_>,
    outline: &Outline,
    height: f64,
    twist: f64,
    scale: DVec2,
) -> Result<u32, TooMany> {
    if let Some(slices) = arguments.number("slices") {
        let slices = slices.max(1.0);
        return if slices <= f64::from(primitives::MAX_SEGMENTS) { Ok(slices as u32) } else { Err(TooMany(slices)) };
    }
    let fragments = Fragments::of(arguments);
    let corners = || outline.loops().flatten();
    if arguments.number("twist").is_some() {
        let reach = corners().map(|p| p.length()).fold(0.0, f64::max);
        return fragments.twisted(reach, height, twist, scale);
    }
    if scale.x != scale.y {
        let shift = corners().map(|p| (*p - *p * scale).length()).fold(0.0, f64::max);
        return fragments.stretched(shift, height);
    }
    Ok(1)
}

/// `rotate_extrude`: an outline turned about z; its x is the distance from the axis, its y becomes z.
pub(super) fn rotational(evaluator: &mut Evaluator<'_, '_>, turn: Turn<'_, '_>, outline: Outline) -> Made {
    let arguments = Arguments::of(turn.node, &["angle"]);
    refuse_file(&arguments)?;
    let angle = arguments.number("angle").filter(|angle| angle.abs() <= 360.0).unwrap_or(360.0);
    if angle == 0.0 || outline.is_empty() {
        return Ok(None);
    }
    let (least, most) = outline.loops().flatten().fold((0.0f64, 0.0f64), |(a, b), p| (a.min(p.x), b.max(p.x)));
    if least < 0.0 && most > 0.0 {
        evaluator
            .warn_of_loss(turn, format!("an outline on both sides of the axis (x from {least} to {most}) is left out"));
        return Ok(None);
    }
    let fragments = Fragments::of(&arguments);
    let steps = fragments.along_arc(most - least, angle)?;
    let mirror = |factors: DVec2| outline.transformed(glam::DMat2::from_diagonal(factors), DVec2::ZERO);
    let outline = if least < 0.0 { mirror(DVec2::new(-1.0, 1.0))? } else { outline };
    let tree = primitives::revolve_in_steps(&outline, angle.abs(), steps, turn.frame.material)?;
    // whole turns begin on the other side
    let is_turned = (least < 0.0) != (angle == 360.0);
    let along = if is_turned { -1.0 } else { 1.0 };
    let sense = if angle < 0.0 { -along } else { along };
    let map = Transform::scale(DVec3::new(along, sense, 1.0)).map_err(ShapeError::from)?;
    let touches_itself = touches_in_plane(&outline) || angle == 360.0 && touches_axis(&outline);
    Ok(Some(Geometry::Solid(solid::moved(Body { tree, touches_itself, ..Body::default() }, &map)?)))
}

/// Whether a corner touches the axis between two that do not: turned around, there are two cones with one tip.
fn touches_axis(outline: &Outline) -> bool {
    outline.loops().any(|corners| {
        let n = corners.len();
        let is_on_axis = |k: usize| corners[k % n].x == 0.0;
        (0..n).any(|k| is_on_axis(k) && !is_on_axis(k + 1) && !is_on_axis(k + n - 1))
    })
}

/// Old trees name a drawing to extrude.
fn refuse_file(arguments: &Arguments<'_, '_>) -> Result<(), Problem> {
    match arguments.text("file").filter(|file| !file.is_empty()) {
        Some(file) => Err(Problem::new(format!("the drawing `{file}`, which is not supported"), "children to extrude")),
        None => Ok(()),
    }
}
