//! The exact boundary of each brush, as plane ids: what the skin works on.

use glam::DVec3;
use planecut_kernel::sign::{Counts, Homogeneous};
use planecut_kernel::{HalfSpace, IncrementalPolytope, PlaneIdx};
use rayon::prelude::*;

use crate::bounds::Bounds;
use crate::brush::{MaterialId, Model};
use crate::plane_table::{PlaneId, PlaneTable};

/// A face of a [`Body`].
#[derive(Debug, Clone)]
pub(crate) struct BodyFace {
    pub(crate) plane: PlaneId,
    pub(crate) material: MaterialId,
    /// The planes of the edges, counter-clockwise seen from outside.
    pub(crate) edges: Vec<PlaneId>,
    /// Corner `i`, between the edges `i` and `i + 1`.
    pub(crate) corners: Vec<Homogeneous>,
    pub(crate) bounds: Bounds,
}

/// A bounded convex body with interior.
#[derive(Debug, Clone)]
pub(crate) struct Body {
    pub(crate) faces: Vec<BodyFace>,
    pub(crate) bounds: Bounds,
    pub(crate) volume: f64,
}

/// What a brush turned out to be.
#[derive(Debug, Clone)]
pub(crate) enum BrushBody {
    /// A bounded body; how many of its planes have no face.
    Bounded(Body, usize),
    /// No interior.
    Empty,
    /// Not bounded.
    Unbounded,
}

/// Interns the planes of a model and builds the body of every brush, in parallel.
pub(crate) fn build_bodies(model: &Model) -> (PlaneTable, Vec<BrushBody>, Counts) {
    let half_spaces: Vec<HalfSpace> =
        model.tree.brushes().iter().flat_map(|brush| brush.faces.iter().map(|face| face.half_space)).collect();
    let (table, ids) = PlaneTable::intern(&half_spaces);
    let mut ends: Vec<(usize, usize)> = Vec::with_capacity(model.tree.brushes().len());
    let mut start = 0;
    for brush in model.tree.brushes() {
        ends.push((start, start + brush.faces.len()));
        start += brush.faces.len();
    }
    let chunk = (model.tree.brushes().len() / (4 * rayon::current_num_threads()).max(1)).max(16);
    let parts: Vec<(Vec<BrushBody>, Counts)> = model
        .tree
        .brushes()
        .par_chunks(chunk)
        .zip(ends.par_chunks(chunk))
        .map(|(brushes, ends)| {
            let before = Counts::now();
            let mut polytope = IncrementalPolytope::with_epsilon(0.0);
            let bodies = brushes.iter().zip(ends).map(|(brush, (start, end))| {
                let materials: Vec<MaterialId> = brush.faces.iter().map(|face| face.material).collect();
                build(&table, &ids[*start..*end], &materials, &mut polytope)
            });
            let bodies = bodies.collect();
            (bodies, Counts::since(before))
        })
        .collect();
    let mut counts = Counts::default();
    let mut bodies = Vec::with_capacity(model.tree.brushes().len());
    for (part, counted) in parts {
        bodies.extend(part);
        counts += counted;
    }
    (table, bodies, counts)
}

fn build(
    table: &PlaneTable,
    planes: &[PlaneId],
    materials: &[MaterialId],
    polytope: &mut IncrementalPolytope,
) -> BrushBody {
    polytope.clear();
    for plane in planes {
        polytope.add_plane(*table.half_space(*plane));
    }
    if polytope.is_empty() {
        return BrushBody::Empty;
    }
    if !polytope.is_bounded() {
        return BrushBody::Unbounded;
    }
    let facets = polytope.facets();
    let mut body = Body { faces: Vec::with_capacity(facets.len()), bounds: Bounds::EMPTY, volume: 0.0 };
    let id = |idx: &Option<PlaneIdx>| idx.map(|idx| planes[idx.0]);
    let mut polygons = Vec::with_capacity(facets.len());
    for (plane, edges) in &facets {
        let Some(edges) = edges.iter().map(id).collect::<Option<Vec<PlaneId>>>() else { return BrushBody::Unbounded };
        let face = body_face(table, planes[plane.0], materials[plane.0], edges);
        let triples =
            (0..face.edges.len()).map(|i| [face.plane, face.edges[i], face.edges[(i + 1) % face.edges.len()]]);
        let polygon: Vec<DVec3> = triples.filter_map(|triple| table.position(triple)).collect();
        body.bounds = body.bounds.union(&face.bounds);
        polygons.push(polygon);
        body.faces.push(face);
    }
    body.volume = volume(&polygons);
    let redundant = planes.len() - body.faces.len();
    BrushBody::Bounded(body, redundant)
}

fn body_face(table: &PlaneTable, plane: PlaneId, material: MaterialId, edges: Vec<PlaneId>) -> BodyFace {
    let n = edges.len();
    let corners: Vec<Homogeneous> = (0..n).map(|i| table.homogeneous([plane, edges[i], edges[(i + 1) % n]])).collect();
    let bounds = corners.iter().fold(Bounds::EMPTY, |bounds, corner| bounds.with_point(corner));
    BodyFace { plane, material, edges, corners, bounds }
}

/// The volume between the polygons of a convex boundary, as a sum of tetrahedra from one corner: nothing cancels.
fn volume(polygons: &[Vec<DVec3>]) -> f64 {
    let Some(&apex) = polygons.first().and_then(|polygon| polygon.first()) else { return 0.0 };
    let mut six = 0.0;
    for polygon in polygons {
        let first = polygon[0] - apex;
        for pair in polygon[1..].windows(2) {
            six += first.cross(pair[0] - apex).dot(pair[1] - apex);
        }
    }
    six / 6.0
}
