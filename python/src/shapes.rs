//! Functions that make solids of parameters, points, outlines and meshes.

use std::sync::Arc;

use glam::DVec2;
use planecut::csg::outline::Outline;
use planecut::csg::polyhedron::convex_tree;
use planecut::csg::primitives::{self, Extrusion};
use planecut::csg::{Brush, Material, MaterialId, Operation, ShapeError, Tree, shaping};
use planecut::expression::{DEFAULT_MATERIAL, Node};
use pyo3::prelude::*;
use pyo3::types::{PyList, PySequence, PyTuple};

use crate::arrays::{columns, row, table, vector};
use crate::errors::{Failure, refuse};
use crate::job::Job;
use crate::solid::Solid;

/// The material of a name.
pub(crate) fn material_of(name: Option<String>) -> Material {
    Material::named(name.unwrap_or_else(|| DEFAULT_MATERIAL.to_owned()))
}

/// A shape with fewer planes or points than this is made in no time.
const FEW: u64 = 4096;

fn solid(tree: impl Into<Tree>, material: Option<String>) -> Solid {
    Solid::of(Node::of_tree(tree, material_of(material)))
}

/// A shape that takes as long as it has planes or points.
fn made<T: Into<Tree> + Send + 'static, E: std::fmt::Display>(
    py: Python<'_>,
    size: u64,
    material: Option<String>,
    make: impl FnOnce() -> Result<T, E> + Send + 'static,
) -> PyResult<Solid> {
    let make = move || make().map(Into::into).map_err(Failure::of);
    let tree: Tree = if size < FEW { make()? } else { Job::default().run(py, make)? };
    Ok(solid(tree, material))
}

/// How many planes a round shape has, about.
fn planes(segments: u32, rings: u32) -> u64 {
    u64::from(segments) * u64::from(rings)
}

/// A box between two corners, with sides along the axes.
///
/// Args:
///     min: The lowest coordinates, shape (3,).
///     max: The highest coordinates, shape (3,), each above that of `min`.
///     material: The name of what it is made of.
///
/// >>> import planecut as pc
/// >>> pc.box([0, 0, 0], [4, 2, 1]).volume
/// 8.0
#[pyfunction(name = "box")]
#[pyo3(signature = (min, max, material=None))]
fn cuboid(py: Python<'_>, min: &Bound<'_, PyAny>, max: &Bound<'_, PyAny>, material: Option<String>) -> PyResult<Solid> {
    let (min, max) = (vector(min, "min")?, vector(max, "max")?);
    made(py, 0, material, move || primitives::cuboid(min, max, MaterialId(0)))
}

/// A cylinder, cone or frustum along z from 0, with corners on the circles.
///
/// Args:
///     height: Above 0.
///     radius: Of the bottom, not below 0.
///     top_radius: Of the top; that of the bottom unless it is given. One of the two may be 0.
///     segments: Number of sides, 3 to 10,000. The first corner is at angle 0.
///     material: The name of what it is made of.
#[pyfunction]
#[pyo3(signature = (height, radius, top_radius=None, segments=48, material=None))]
fn cylinder(
    py: Python<'_>,
    height: f64,
    radius: f64,
    top_radius: Option<f64>,
    segments: u32,
    material: Option<String>,
) -> PyResult<Solid> {
    let top = top_radius.unwrap_or(radius);
    made(py, planes(segments, 1), material, move || primitives::cylinder(height, radius, top, segments, MaterialId(0)))
}

/// A sphere around the origin: rings of sides, with corners on the sphere.
///
/// Args:
///     radius: Above 0.
///     segments: Number of sides around, 3 to 10,000, and half as many from pole to pole.
///     material: The name of what it is made of.
#[pyfunction]
#[pyo3(signature = (radius, segments=32, material=None))]
fn sphere(py: Python<'_>, radius: f64, segments: u32, material: Option<String>) -> PyResult<Solid> {
    made(py, planes(segments, segments), material, move || primitives::sphere(radius, segments, MaterialId(0)))
}

/// A torus around the z axis.
///
/// Args:
///     radius: Of the circle in the middle of the tube.
///     tube: Radius of the tube, below that of the circle.
///     segments: Number of steps around the axis, 3 to 10,000.
///     tube_segments: Number of sides of the tube.
///     material: The name of what it is made of.
#[pyfunction]
#[pyo3(signature = (radius, tube, segments=48, tube_segments=24, material=None))]
fn torus(
    py: Python<'_>,
    radius: f64,
    tube: f64,
    segments: u32,
    tube_segments: u32,
    material: Option<String>,
) -> PyResult<Solid> {
    let size = planes(segments, tube_segments);
    made(py, size, material, move || primitives::torus(radius, tube, segments, tube_segments, MaterialId(0)))
}

/// The convex body `n · x <= d` of half-spaces. It may be unbounded, or empty.
///
/// Args:
///     planes: Shape (k, 4): a normal that points out of the body and need not have unit length, and the offset `d`.
///     material: The name of what it is made of.
///
/// >>> import planecut as pc
/// >>> half = pc.halfspaces([[1, 0, 0, 0.5]])
/// >>> (pc.box([0, 0, 0], [1, 1, 1]) & half).volume
/// 0.5
#[pyfunction]
#[pyo3(signature = (planes, material=None))]
fn halfspaces(planes: &Bound<'_, PyAny>, material: Option<String>) -> PyResult<Solid> {
    let mut half_spaces = Vec::new();
    for (number, plane) in table::<4>(planes, "planes")?.into_iter().enumerate() {
        let half_space = planecut::kernel::HalfSpace::from_array(plane);
        half_spaces.push(half_space.map_err(|error| refuse(format!("planes[{number}]: {error}")))?);
    }
    if half_spaces.is_empty() {
        return Ok(solid(Tree::everything(), material));
    }
    Ok(solid(Brush::from_half_spaces(half_spaces, MaterialId(0)), material))
}

/// The convex hull of points, or of solids together.
///
/// Args:
///     points: Shape (n, 3), not all in one plane; or a list of solids.
///     material: The name of what it is made of. A single convex solid keeps its own.
///
/// >>> import planecut as pc
/// >>> pc.hull([pc.box([0, 0, 0], [1, 1, 1]), pc.box([2, 0, 0], [3, 1, 1])]).volume
/// 3.0
#[pyfunction(name = "hull")]
#[pyo3(signature = (points, material=None))]
fn hull_of(py: Python<'_>, points: &Bound<'_, PyAny>, material: Option<String>) -> PyResult<Solid> {
    if let Some(nodes) = solids(points)? {
        return of_solids(py, nodes, material, |trees| shaping::hull(trees, MaterialId(0)));
    }
    let points = crate::arrays::points(points, "points")?;
    made(py, points.len() as u64, material, move || primitives::hull_of_points(&points, MaterialId(0)))
}

/// The Minkowski sum of two solids: all sums of a point of the one and a point of the other.
///
/// Args:
///     a: A Solid of convex bodies.
///     b: The same, as a small sphere to round edges.
///     material: The name of what it is made of.
#[pyfunction]
#[pyo3(signature = (a, b, material=None))]
fn minkowski(py: Python<'_>, a: &Bound<'_, Solid>, b: &Bound<'_, Solid>, material: Option<String>) -> PyResult<Solid> {
    let nodes = [a, b].map(|solid| Arc::clone(solid.get().node())).to_vec();
    of_solids(py, nodes, material, |trees| shaping::minkowski(&trees[0], &trees[1], MaterialId(0)))
}

/// What a function makes of the trees of solids, closed meshes among them taken apart into convex cells.
fn of_solids(
    py: Python<'_>,
    nodes: Vec<Arc<Node>>,
    material: Option<String>,
    make: impl FnOnce(&[Tree]) -> Result<Tree, ShapeError> + Send + 'static,
) -> PyResult<Solid> {
    let tree = Job::default().run(py, move || {
        let mut trees = Vec::new();
        for node in nodes {
            let tree = node.model()?.tree.with_material(MaterialId(0));
            trees.push(convex_tree(&tree).map_err(Failure::of)?.into_owned());
        }
        make(&trees).map_err(Failure::of)
    })?;
    Ok(solid(tree, material))
}

/// What solids of a list are made of; nothing where it is no list of solids.
fn solids(value: &Bound<'_, PyAny>) -> PyResult<Option<Vec<Arc<Node>>>> {
    if let Ok(solid) = value.cast::<Solid>() {
        return Ok(Some(vec![Arc::clone(solid.get().node())]));
    }
    // an array is no list of solids, whatever its items are
    let is_list = value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>();
    if !is_list || value.len()? == 0 || !value.get_item(0)?.is_instance_of::<Solid>() {
        return Ok(None);
    }
    nodes_of(value, "points").map(Some)
}

/// One loop, or a list of loops: those in others are holes.
fn outline_of(value: &Bound<'_, PyAny>) -> PyResult<Outline> {
    let loop_of = |value: &Bound<'_, PyAny>, name: &str| -> PyResult<Vec<DVec2>> {
        Ok(table::<2>(value, name)?.into_iter().map(DVec2::from).collect())
    };
    // one array of shape (n, 2) is one loop; a list of points, too
    let is_one = columns(value, "outline").is_ok_and(|columns| columns == 2);
    let loops = if is_one {
        vec![loop_of(value, "outline")?]
    } else if let Ok(list) = value.cast::<PySequence>() {
        (0..list.len()?).map(|k| loop_of(&list.get_item(k)?, &format!("outline[{k}]"))).collect::<PyResult<_>>()?
    } else {
        return Err(refuse("outline: found no loops, expected an array of shape (n, 2) or a list of them"));
    };
    Outline::from_loops(&loops).map_err(|error| Failure::of(error).into())
}

/// An outline extruded along z from 0.
///
/// Args:
///     outline: A loop of shape (n, 2), or a list of loops: what lies within an odd number of them, so that loops in others are holes. They may run either way.
///     height: Above 0.
///     twist: Degrees by which the top is turned, clockwise seen from above.
///     scale: How much wider the top is than the bottom: a number, or one for x and one for y.
///     slices: Number of layers; by default 1, and one for each 5 degrees of twist.
///     material: The name of what it is made of.
///
/// >>> import planecut as pc
/// >>> pc.extrude([[0, 0], [2, 0], [0, 2]], 3).volume
/// 6.0
#[pyfunction]
#[pyo3(signature = (outline, height, twist=0.0, scale=None, slices=None, material=None))]
fn extrude(
    py: Python<'_>,
    outline: &Bound<'_, PyAny>,
    height: f64,
    twist: f64,
    scale: Option<&Bound<'_, PyAny>>,
    slices: Option<u32>,
    material: Option<String>,
) -> PyResult<Solid> {
    let scale = match scale {
        None => DVec2::ONE,
        Some(value) => match value.extract::<f64>() {
            Ok(factor) => DVec2::splat(factor),
            Err(_) => row::<2>(value, "scale")?.into(),
        },
    };
    let extrusion = Extrusion { twist, scale, slices, ..Extrusion::straight(height) };
    let outline = outline_of(outline)?;
    let layers = slices.unwrap_or_else(|| (twist.abs() / 5.0).ceil().max(1.0) as u32);
    let size = outline.corner_count() as u64 * u64::from(layers);
    made(py, size, material, move || primitives::extrude(&outline, &extrusion, MaterialId(0)))
}

/// An outline revolved about the z axis: its x becomes the distance from the axis, its y becomes z.
///
/// Args:
///     outline: As for `extrude`, without negative x.
///     segments: Number of steps of a whole turn, 3 to 10,000.
///     angle: Degrees, above 0 and at most 360, counter-clockwise seen from above and beginning at the x axis.
///     material: The name of what it is made of.
#[pyfunction]
#[pyo3(signature = (outline, segments=64, angle=360.0, material=None))]
fn revolve(
    py: Python<'_>,
    outline: &Bound<'_, PyAny>,
    segments: u32,
    angle: f64,
    material: Option<String>,
) -> PyResult<Solid> {
    let outline = outline_of(outline)?;
    let size = outline.corner_count() as u64 * u64::from(segments);
    made(py, size, material, move || primitives::revolve(&outline, angle, segments, MaterialId(0)))
}

/// What solids of a list are made of.
fn nodes_of(solids: &Bound<'_, PyAny>, name: &str) -> PyResult<Vec<Arc<Node>>> {
    let expected = || refuse(format!("{name}: found what is no list of solids, expected one"));
    let mut nodes = Vec::new();
    for item in solids.try_iter().map_err(|_| expected())? {
        nodes.push(Arc::clone(item?.cast::<Solid>().map_err(|_| expected())?.get().node()));
    }
    Ok(nodes)
}

/// What lies in any of some solids; nothing where there are none.
///
/// Args:
///     solids: A list of solids, of any length.
#[pyfunction]
fn union(solids: &Bound<'_, PyAny>) -> PyResult<Solid> {
    Ok(Solid::of(Node::operation(Operation::Union, nodes_of(solids, "solids")?)))
}

/// What lies in all of some solids.
///
/// Args:
///     solids: A list of one solid at least.
#[pyfunction]
fn intersection(solids: &Bound<'_, PyAny>) -> PyResult<Solid> {
    let nodes = nodes_of(solids, "solids")?;
    if nodes.is_empty() {
        return Err(refuse("solids: found an empty list, expected one solid at least"));
    }
    Ok(Solid::of(Node::operation(Operation::Intersection, nodes)))
}

/// What lies in a solid and in none of others.
///
/// Args:
///     solid: A solid.
///     others: A list of solids, of any length.
#[pyfunction]
fn difference(solid: &Bound<'_, Solid>, others: &Bound<'_, PyAny>) -> PyResult<Solid> {
    let mut nodes = vec![Arc::clone(solid.get().node())];
    nodes.extend(nodes_of(others, "others")?);
    Ok(Solid::of(Node::operation(Operation::Difference, nodes)))
}

/// Adds the functions to the module.
pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(cuboid, module)?)?;
    module.add_function(wrap_pyfunction!(cylinder, module)?)?;
    module.add_function(wrap_pyfunction!(sphere, module)?)?;
    module.add_function(wrap_pyfunction!(torus, module)?)?;
    module.add_function(wrap_pyfunction!(halfspaces, module)?)?;
    module.add_function(wrap_pyfunction!(hull_of, module)?)?;
    module.add_function(wrap_pyfunction!(minkowski, module)?)?;
    module.add_function(wrap_pyfunction!(extrude, module)?)?;
    module.add_function(wrap_pyfunction!(revolve, module)?)?;
    module.add_function(wrap_pyfunction!(union, module)?)?;
    module.add_function(wrap_pyfunction!(intersection, module)?)?;
    module.add_function(wrap_pyfunction!(difference, module)?)
}
