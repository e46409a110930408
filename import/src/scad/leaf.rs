//! Nodes without children: bodies and regions of given size.
//!
//! Sizes of zero and below, and infinite ones, give an empty object, as in OpenSCAD. Shapes have OpenSCAD's corners: a sphere
//! is `⌊(n + 1) / 2⌋` rings, half a step from the poles.

use planecut_csg::{MaterialId, Tree};
use planecut_kernel::{DVec2, DVec3};
use planecut_shapes::outline::Outline;
use planecut_shapes::primitives;

use super::arguments::Arguments;
use super::fragments::Fragments;
use super::problem::Problem;
use super::syntax::Node;
use super::value::Value;

/// Most faces of a sphere: it would take seconds.
const MAX_FACES: u64 = 1 << 20;

fn is_size(value: f64) -> bool {
    value > 0.0 && value.is_finite()
}

pub(super) fn cube(node: &Node<'_>, material: MaterialId) -> Result<Tree, Problem> {
    let arguments = Arguments::of(node, &["size", "center"]);
    let size = arguments.size::<3>("size");
    if !size.into_iter().all(is_size) {
        return Ok(Tree::empty());
    }
    let size = DVec3::from_array(size);
    let min = if arguments.is_set("center") { size * -0.5 } else { DVec3::ZERO };
    let max = if arguments.is_set("center") { size * 0.5 } else { size };
    Ok(primitives::cuboid(min, max, material)?.into())
}

pub(super) fn sphere(node: &Node<'_>, material: MaterialId) -> Result<Tree, Problem> {
    let arguments = Arguments::of(node, &["r"]);
    let radius = radius(&arguments, "r", "d").unwrap_or(1.0);
    if !is_size(radius) {
        return Ok(Tree::empty());
    }
    let segments = Fragments::of(&arguments).around(radius)?;
    let faces = u64::from(segments) * u64::from(segments / 2) + 2;
    if faces > MAX_FACES {
        return Err(Problem::new(format!("a sphere of {faces} faces"), format!("at most {MAX_FACES}")));
    }
    Ok(primitives::sphere(radius, segments, material)?.into())
}

pub(super) fn cylinder(node: &Node<'_>, material: MaterialId) -> Result<Tree, Problem> {
    let arguments = Arguments::of(node, &["h", "r1", "r2", "center"]);
    let height = arguments.number_or("h", 1.0);
    let both = radius(&arguments, "r", "d");
    let bottom = radius(&arguments, "r1", "d1").or(both).unwrap_or(1.0);
    let top = radius(&arguments, "r2", "d2").or(both).unwrap_or(1.0);
    let is_radius = |radius: f64| radius == 0.0 || is_size(radius);
    if !(is_size(height) && is_radius(bottom) && is_radius(top) && bottom + top > 0.0) {
        return Ok(Tree::empty());
    }
    let segments = Fragments::of(&arguments).around(bottom.max(top))?;
    let body: Tree = primitives::cylinder(height, bottom, top, segments, material)?.into();
    if !arguments.is_set("center") {
        return Ok(body);
    }
    let down = planecut_csg::Transform::translation(DVec3::new(0.0, 0.0, -0.5 * height));
    down.and_then(|down| body.transformed(&down)).map_err(|error| Problem::new(error.to_string(), "a smaller height"))
}

/// The radius, which a diameter overrides.
fn radius(arguments: &Arguments<'_, '_>, radius: &str, diameter: &str) -> Option<f64> {
    arguments.number(diameter).map(|diameter| 0.5 * diameter).or_else(|| arguments.number(radius))
}

pub(super) fn square(node: &Node<'_>) -> Result<Outline, Problem> {
    let arguments = Arguments::of(node, &["size", "center"]);
    let size = arguments.size::<2>("size");
    if !size.into_iter().all(is_size) {
        return Ok(Outline::empty());
    }
    let size = DVec2::from_array(size);
    let (min, max) = if arguments.is_set("center") { (size * -0.5, size * 0.5) } else { (DVec2::ZERO, size) };
    Ok(Outline::rectangle(min, max)?)
}

pub(super) fn circle(node: &Node<'_>) -> Result<Outline, Problem> {
    let arguments = Arguments::of(node, &["r"]);
    let radius = radius(&arguments, "r", "d").unwrap_or(1.0);
    if !is_size(radius) {
        return Ok(Outline::empty());
    }
    Ok(Outline::circle(radius, Fragments::of(&arguments).around(radius)?)?)
}

/// What lies within an odd number of the paths; with a message where OpenSCAD has one.
pub(super) fn polygon(node: &Node<'_>) -> Result<(Outline, Option<String>), Problem> {
    let arguments = Arguments::of(node, &["points", "paths", "convexity"]);
    let given = arguments.get("points").map(Value::items).unwrap_or_default();
    let mut points = Vec::with_capacity(given.len());
    for (place, point) in given.iter().enumerate() {
        let Some(point) = point.finite::<2>() else {
            let message = format!("the polygon is left out: its point {place} is not two finite numbers");
            return Ok((Outline::empty(), Some(message)));
        };
        points.push(DVec2::from_array(point));
    }
    let mut loops = match arguments.get("paths") {
        None => vec![points],
        Some(paths) => paths.items().iter().map(|path| corners(path, &points)).collect(),
    };
    loops.retain(|corners: &Vec<DVec2>| corners.len() >= 3);
    Ok((Outline::from_loops(&loops)?, None))
}

/// The points of a path; numbers beyond the points are passed over.
pub(super) fn corners<T: Copy>(path: &Value, points: &[T]) -> Vec<T> {
    let index = |value: &Value| value.number().filter(|number| *number >= 0.0).map(|number| number as usize);
    path.items().iter().filter_map(|value| points.get(index(value)?).copied()).collect()
}
