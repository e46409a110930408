//! Trees taken apart into convex bodies.

use planecut_cells::{Cell, Solid};
use planecut_csg::stages::evaluate_shape;
use planecut_csg::{Brush, EvaluateError, Evaluation, Tree};
use planecut_kernel::sign::Row;
use planecut_kernel::{DVec3, HalfSpace, IncrementalPolytope, PlaneIdx, meet};
use rustc_hash::{FxHashMap, FxHashSet};

use crate::parameter::ShapeError;
use crate::tolerances::MERGED_VERTICES;

/// Number of planes from which bodies are worth waiting for threads.
const MANY_PLANES: usize = 256;

/// A bounded convex body with interior.
pub(super) struct Convex {
    /// The half-spaces that have a face, exactly.
    pub(super) half_spaces: Vec<HalfSpace>,
    /// The corners, those that were meant to be one but once.
    pub(super) corners: Vec<DVec3>,
    /// The edges that are longer than rounding.
    pub(super) edges: Vec<Edge>,
}

/// An edge: two planes through it, between whose normals there is none of another face, and an end.
///
/// Where a plane touches the body along an edge, the edge is there once with it and each of the faces.
pub(super) struct Edge {
    pub(super) planes: [HalfSpace; 2],
    pub(super) end: DVec3,
}

/// The faces of a bounded convex body with interior.
struct Faces {
    polytope: IncrementalPolytope,
    /// Each with the planes of its edges in order.
    facets: Vec<(PlaneIdx, Vec<PlaneIdx>)>,
    half_spaces: Vec<HalfSpace>,
    /// The corners of each in order.
    polygons: Vec<Vec<DVec3>>,
}

impl Faces {
    /// Those of half-spaces; `None` where these have no interior.
    fn of(half_spaces: &[HalfSpace]) -> Result<Option<Self>, ShapeError> {
        let polytope = build(half_spaces);
        if polytope.is_empty() {
            return Ok(None);
        }
        let facets = finite_facets(&polytope).filter(|_| polytope.is_bounded()).ok_or(ShapeError::Unbounded)?;
        let half_spaces: Vec<HalfSpace> =
            facets.iter().filter_map(|(plane, _)| polytope.plane(*plane).copied()).collect();
        let rows: FxHashMap<usize, Row> = polytope.planes().map(|(plane, h)| (plane.0, Row::new(h))).collect();
        let mut known: FxHashMap<[usize; 3], DVec3> = FxHashMap::default();
        let mut position = |planes: [PlaneIdx; 3]| {
            let mut key = planes.map(|plane| plane.0);
            key.sort_unstable();
            *known.entry(key).or_insert_with(|| {
                let [a, b, c] = key.map(|plane| &rows[&plane]);
                meet(a, b, c).expect("the planes of a corner are independent")
            })
        };
        let polygon = |(plane, edges): &(PlaneIdx, Vec<PlaneIdx>)| {
            let next = edges.iter().cycle().skip(1);
            edges.iter().zip(next).map(|(edge, next)| position([*plane, *edge, *next])).collect()
        };
        let polygons = facets.iter().map(polygon).collect();
        Ok(Some(Self { polytope, facets, half_spaces, polygons }))
    }
}

impl Convex {
    /// The body of half-spaces; `None` where it has no interior.
    pub(super) fn new(half_spaces: &[HalfSpace]) -> Result<Option<Self>, ShapeError> {
        let Some(Faces { polytope, facets, half_spaces, polygons }) = Faces::of(half_spaces)? else { return Ok(None) };
        let size = extent(&polygons);
        let edges = edges_of(&polytope, &facets, &polygons, size * MERGED_VERTICES);
        let corners = merged(polygons.iter().flatten().copied(), size * MERGED_VERTICES);
        Ok(Some(Self { half_spaces, corners, edges }))
    }

    pub(super) fn of_brush(brush: &Brush) -> Result<Option<Self>, ShapeError> {
        Self::new(&brush.faces.iter().map(|face| face.half_space).collect::<Vec<_>>())
    }
}

/// The facets of a polytope; `None` where one reaches infinity.
fn finite_facets(polytope: &IncrementalPolytope) -> Option<Vec<(PlaneIdx, Vec<PlaneIdx>)>> {
    let finite =
        |(plane, edges): (PlaneIdx, Vec<Option<PlaneIdx>>)| Some((plane, edges.into_iter().collect::<Option<_>>()?));
    polytope.facets().into_iter().map(finite).collect()
}

/// The edges but for those that are not longer than `least`.
fn edges_of(
    polytope: &IncrementalPolytope,
    facets: &[(PlaneIdx, Vec<PlaneIdx>)],
    polygons: &[Vec<DVec3>],
    least: f64,
) -> Vec<Edge> {
    let have_faces: FxHashSet<usize> = facets.iter().map(|(plane, _)| plane.0).collect();
    let mut found = Vec::new();
    for ((plane, edges), corners) in facets.iter().zip(polygons) {
        for (k, edge) in edges.iter().enumerate() {
            // corner `k` lies between the edges `k` and `k + 1`
            let (start, end) = (corners[(k + corners.len() - 1) % corners.len()], corners[k]);
            let is_first = plane.0 < edge.0 || !have_faces.contains(&edge.0);
            if let (true, Some(own), Some(other)) = (is_first, polytope.plane(*plane), polytope.plane(*edge))
                && start.distance(end) > least
            {
                found.push(Edge { planes: [*own, *other], end });
            }
        }
    }
    found
}

/// The longest side of the box around polygons.
fn extent(polygons: &[Vec<DVec3>]) -> f64 {
    let nowhere = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (min, max) = polygons.iter().flatten().fold(nowhere, |(min, max), p| (min.min(*p), max.max(*p)));
    (max - min).max_element()
}

/// Points, of those in one cell of a grid the first. Near the walls of cells a few are left twice, which does no harm.
fn merged(points: impl Iterator<Item = DVec3>, grid: f64) -> Vec<DVec3> {
    let mut seen: FxHashSet<[i64; 3]> = FxHashSet::default();
    let cell = |p: &DVec3| (*p / grid).round().to_array().map(|v| v as i64);
    points.filter(|p| seen.insert(cell(p))).collect()
}

/// The half-spaces whose faces are wider than rounding.
///
/// Planes through corners that nearly lie on a line, and across edges that are no longer than an ulp, touch the body and have no
/// say in it.
pub(super) fn wide_faces(half_spaces: &[HalfSpace]) -> Result<Vec<HalfSpace>, ShapeError> {
    let Some(body) = Faces::of(half_spaces)? else { return Ok(Vec::new()) };
    let least = extent(&body.polygons) * MERGED_VERTICES;
    let faces = body.half_spaces.iter().zip(&body.polygons);
    let wide: Vec<HalfSpace> = faces.filter(|(_, polygon)| width(polygon) > least).map(|(face, _)| *face).collect();
    // a body that is all needles keeps its planes
    let is_enough = wide.len() == body.half_spaces.len() || are_bounded(&wide);
    Ok(if is_enough { wide } else { body.half_spaces })
}

/// The area of a polygon over its diameter, but for a factor near 1.
fn width(corners: &[DVec3]) -> f64 {
    let Some(first) = corners.first() else { return 0.0 };
    let spread = corners.iter().map(|p| p.distance(*first)).fold(0.0, f64::max);
    let area: DVec3 = corners.windows(2).map(|pair| (pair[0] - first).cross(pair[1] - first)).sum();
    if spread > 0.0 { area.length() / spread } else { 0.0 }
}

/// Whether half-spaces have no more than a bounded body in common: mostly a few that look all ways tell. Those that follow one another may
/// be sorted and look the same way, so that steps are taken.
fn are_bounded(half_spaces: &[HalfSpace]) -> bool {
    const STEP: usize = 32;
    let mut polytope = IncrementalPolytope::with_epsilon(0.0);
    (0..STEP).flat_map(|first| half_spaces.iter().skip(first).step_by(STEP)).any(|half_space| {
        polytope.add_plane(*half_space);
        polytope.is_bounded()
    })
}

fn build(half_spaces: &[HalfSpace]) -> IncrementalPolytope {
    let mut polytope = IncrementalPolytope::with_epsilon(0.0);
    for half_space in half_spaces {
        polytope.add_plane(*half_space);
    }
    polytope
}

/// The brushes of unions that have an interior; those of many planes are built in parallel.
pub(super) fn parts_of_unions<'a>(
    trees: impl IntoIterator<Item = &'a Tree>,
) -> Result<Vec<(&'a Brush, Convex)>, ShapeError> {
    let brushes: Vec<&Brush> = trees.into_iter().flat_map(Tree::brushes).collect();
    let planes: usize = brushes.iter().map(|brush| brush.faces.len()).sum();
    let bodies: Vec<Result<Option<Convex>, ShapeError>> = if planes >= MANY_PLANES {
        planecut_parallel::map_parts(brushes.len(), |k| Convex::of_brush(brushes[k]))
    } else {
        brushes.iter().map(|brush| Convex::of_brush(brush)).collect()
    };
    let parts = brushes.into_iter().zip(bodies).map(|(brush, body)| Ok(body?.map(|body| (brush, body))));
    parts.filter_map(Result::transpose).collect()
}

/// The mesh of a tree, whatever its materials.
pub(super) fn evaluated(tree: &Tree) -> Result<Evaluation, ShapeError> {
    evaluate_shape(tree.clone()).map_err(|error| match error {
        EvaluateError::Unbounded => ShapeError::Unbounded,
        other => ShapeError::Evaluate(other),
    })
}

/// Disjoint convex cells of a tree.
pub(super) fn cells(tree: &Tree) -> Result<Vec<Convex>, ShapeError> {
    let solid = Solid::from_tree(tree);
    let half_spaces = |cell: &Cell| cell.polytope().planes().map(|(_, half_space)| *half_space).collect::<Vec<_>>();
    let cells = solid.cells().map(|cell| Convex::new(&half_spaces(cell)));
    cells.filter_map(Result::transpose).collect()
}
