//! The exact boundary of each brush, as plane ids: what the skin works on.

use std::hash::BuildHasher;

use glam::DVec3;
use planecut_kernel::sign::{Counts, Homogeneous};
use planecut_kernel::{HalfSpace, IncrementalPolytope, PlaneIdx};
use rayon::prelude::*;
use rustc_hash::{FxBuildHasher, FxHashMap};

use crate::bounds::Bounds;
use crate::brush::{Brush, MaterialId};
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

/// The bodies of the brushes of a model.
pub(crate) struct BrushBodies {
    pub(crate) table: PlaneTable,
    /// The planes of each brush, in its order.
    pub(crate) planes: Vec<Vec<PlaneId>>,
    pub(crate) bodies: Vec<BrushBody>,
    pub(crate) signs: Counts,
}

/// Numbers that are equal for bodies with the same faces of the same materials, and for no others.
pub(crate) fn kinds(bodies: &[BrushBody]) -> Vec<u32> {
    let faces = |number: u32| match &bodies[number as usize] {
        BrushBody::Bounded(body, _) => body.faces.as_slice(),
        BrushBody::Empty | BrushBody::Unbounded => &[],
    };
    let sorted = |number: u32| {
        let mut faces: Vec<(PlaneId, MaterialId)> =
            faces(number).iter().map(|face| (face.plane, face.material)).collect();
        faces.sort_unstable();
        faces
    };
    let hasher = FxBuildHasher;
    // a sum, so that the order of faces does not count
    let hash = |number: u32| {
        let each = faces(number).iter().map(|face| hasher.hash_one((face.plane, face.material)));
        each.fold(0_u64, u64::wrapping_add)
    };
    let mut known: FxHashMap<u64, Vec<u32>> = FxHashMap::default();
    let kind = |number: u32| {
        if faces(number).is_empty() {
            return number;
        }
        let alike = known.entry(hash(number)).or_default();
        let equal = (!alike.is_empty()).then(|| sorted(number));
        let first = equal.and_then(|own| alike.iter().copied().find(|other| sorted(*other) == own));
        first.unwrap_or_else(|| {
            alike.push(number);
            number
        })
    };
    (0..bodies.len() as u32).map(kind).collect()
}

/// Interns the planes of brushes and builds the body of each, in parallel.
pub(crate) fn build_bodies(brushes: &[Brush]) -> BrushBodies {
    let half_spaces: Vec<HalfSpace> =
        brushes.iter().flat_map(|brush| brush.faces.iter().map(|face| face.half_space)).collect();
    let (table, ids) = PlaneTable::intern(&half_spaces);
    let mut rest = ids.as_slice();
    let planes: Vec<Vec<PlaneId>> = brushes
        .iter()
        .map(|brush| {
            let (own, others) = rest.split_at(brush.faces.len());
            rest = others;
            own.to_vec()
        })
        .collect();
    let chunk = (brushes.len() / (4 * rayon::current_num_threads()).max(1)).max(16);
    let parts: Vec<(Vec<BrushBody>, Counts)> = brushes
        .par_chunks(chunk)
        .zip(planes.par_chunks(chunk))
        .map(|(brushes, planes)| {
            let before = Counts::now();
            let mut polytope = IncrementalPolytope::with_epsilon(0.0);
            let bodies = brushes.iter().zip(planes).map(|(brush, planes)| {
                let materials: Vec<MaterialId> = brush.faces.iter().map(|face| face.material).collect();
                build(&table, planes, &materials, &mut polytope)
            });
            let bodies = bodies.collect();
            (bodies, Counts::since(before))
        })
        .collect();
    let mut signs = Counts::default();
    let mut bodies = Vec::with_capacity(brushes.len());
    for (part, counted) in parts {
        bodies.extend(part);
        signs += counted;
    }
    BrushBodies { table, planes, bodies, signs }
}

/// The body that planes bound, each with the material of its face; `polytope` is a buffer.
pub(crate) fn build(
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
    match body_of(table, polytope, |idx| (planes[idx.0], materials[idx.0])) {
        Some(body) => {
            let redundant = planes.len() - body.faces.len();
            BrushBody::Bounded(body, redundant)
        }
        None => BrushBody::Unbounded,
    }
}

/// The body of a bounded polytope, whose planes are those of a table; nothing where it is not bounded.
pub(crate) fn body_of(
    table: &PlaneTable,
    polytope: &IncrementalPolytope,
    face_of: impl Fn(PlaneIdx) -> (PlaneId, MaterialId),
) -> Option<Body> {
    let facets = polytope.facets();
    let mut body = Body { faces: Vec::with_capacity(facets.len()), bounds: Bounds::EMPTY, volume: 0.0 };
    let mut polygons = Vec::with_capacity(facets.len());
    for (plane, edges) in &facets {
        let edges = edges.iter().map(|idx| idx.map(|idx| face_of(idx).0)).collect::<Option<Vec<PlaneId>>>()?;
        let (plane, material) = face_of(*plane);
        let face = body_face(table, plane, material, edges);
        let triple = |i: usize| [face.plane, face.edges[i], face.edges[(i + 1) % face.edges.len()]];
        let position = |i: usize| rounded(&face.corners[i]).or_else(|| table.position(triple(i)));
        let polygon: Vec<DVec3> = (0..face.edges.len()).filter_map(position).collect();
        body.bounds = body.bounds.union(&face.bounds);
        polygons.push(polygon);
        body.faces.push(face);
    }
    body.volume = volume(&polygons);
    Some(body)
}

fn body_face(table: &PlaneTable, plane: PlaneId, material: MaterialId, edges: Vec<PlaneId>) -> BodyFace {
    let n = edges.len();
    let corners: Vec<Homogeneous> = (0..n).map(|i| table.homogeneous([plane, edges[i], edges[(i + 1) % n]])).collect();
    let bounds = corners.iter().fold(Bounds::EMPTY, |bounds, corner| bounds.with_point(corner));
    BodyFace { plane, material, edges, corners, bounds }
}

/// A point rounded a few times, where it is well conditioned.
fn rounded(point: &Homogeneous) -> Option<DVec3> {
    const WELL: f64 = 64.0;
    let [x, y, z, w] = point.value;
    let [px, py, pz, pw] = point.permanent;
    let is_well = pw <= WELL * w.abs() && px.max(py).max(pz) <= WELL * x.abs().max(y.abs()).max(z.abs());
    is_well.then(|| DVec3::new(x, y, z) / w)
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
