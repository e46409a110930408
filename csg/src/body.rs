//! The exact boundary of each brush, as plane ids: what the skin works on.

use std::hash::BuildHasher;
use std::sync::OnceLock;

use glam::DVec3;
use planecut_kernel::sign::{Counts, Sign};
use planecut_kernel::{HalfSpace, IncrementalPolytope, PlaneIdx};
use rustc_hash::{FxBuildHasher, FxHashMap};

use crate::bounds::Bounds;
use crate::brush::{Brush, MaterialId};
use crate::corner::{Corner, Sieve};
use crate::gauge::{Gauge, Place};
use crate::locality::renumber_planes;
use crate::parallel::map_chunks;
use crate::plane_table::{PlaneId, PlaneTable};

/// A face of a [`Body`].
#[derive(Debug, Clone)]
pub(crate) struct BodyFace {
    pub(crate) plane: PlaneId,
    pub(crate) material: MaterialId,
    pub(crate) bounds: Bounds,
    /// Its edges and corners among those of the body.
    start: u32,
    end: u32,
}

/// A bounded convex body with interior.
#[derive(Debug, Clone)]
pub(crate) struct Body {
    pub(crate) faces: Vec<BodyFace>,
    /// The planes of the edges, face by face.
    edges: Vec<PlaneId>,
    /// The different corners, and face by face the numbers of its own.
    corners: Vec<Corner>,
    corner_numbers: Vec<u32>,
    pub(crate) bounds: Bounds,
    pub(crate) volume: f64,
    /// Made when first asked for.
    gauge: OnceLock<Option<Box<Gauge>>>,
}

impl Body {
    /// Where points lie in it, for a body of many faces.
    pub(crate) fn gauge(&self, table: &PlaneTable) -> Option<&Gauge> {
        self.gauge.get_or_init(|| Gauge::of(table, self).map(Box::new)).as_deref()
    }

    /// The planes of the edges of a face, counter-clockwise seen from outside.
    pub(crate) fn edges(&self, face: &BodyFace) -> &[PlaneId] {
        &self.edges[face.start as usize..face.end as usize]
    }

    /// The corners of a face: corner `i` between the edges `i` and `i + 1`.
    pub(crate) fn corners(&self, face: &BodyFace) -> impl ExactSizeIterator<Item = &Corner> + Clone {
        let numbers = &self.corner_numbers[face.start as usize..face.end as usize];
        numbers.iter().map(|number| &self.corners[*number as usize])
    }

    /// How many different corners there are: their numbers are below this.
    pub(crate) fn corner_count(&self) -> usize {
        self.corners.len()
    }

    /// Whether all of some corners surely lie beyond one of its planes.
    pub(crate) fn is_surely_apart_from<'a>(
        &self,
        table: &PlaneTable,
        mut corners: impl Iterator<Item = &'a Corner> + Clone,
    ) -> bool {
        let Some(first) = corners.clone().next() else { return true };
        if let Some(gauge) = self.gauge(table) {
            let Place::Outside(face) = gauge.place(first, gauge.seed(first)) else { return false };
            return corners.all(|corner| gauge.is_beyond(corner, face));
        }
        self.faces.iter().any(|face| {
            let sieve = Sieve::new(table.half_space(face.plane));
            corners.clone().all(|corner| sieve.side(corner) == Sign::Positive)
        })
    }

    /// Cuts what corners are known to lie in down to what its planes leave of it.
    fn tighten_bounds(&mut self, table: &PlaneTable) {
        for face in &self.faces {
            self.bounds = self.bounds.within(table.half_space(face.plane));
        }
        for face in &mut self.faces {
            let on_plane = face.bounds.within(table.half_space(face.plane.flipped()));
            face.bounds = on_plane.intersection(&self.bounds);
        }
    }

    /// The face on a plane, whatever its side.
    pub(crate) fn face_on(&self, table: &PlaneTable, plane: PlaneId) -> Option<&BodyFace> {
        match self.gauge(table) {
            Some(gauge) => gauge.on_plane(plane).map(|face| &self.faces[face as usize]),
            None => self.faces.iter().find(|face| face.plane.index() == plane.index()),
        }
    }

    /// Puts other planes in the place of its own.
    pub(crate) fn renumber_planes(&mut self, renumbered: impl Fn(PlaneId) -> PlaneId) {
        self.gauge = OnceLock::new();
        self.faces.iter_mut().for_each(|face| face.plane = renumbered(face.plane));
        self.edges.iter_mut().for_each(|edge| *edge = renumbered(*edge));
    }

    /// How many edges all faces have together.
    pub(crate) fn edge_count(&self) -> usize {
        self.edges.len()
    }

    /// The mean of the corners, each counted once for each face at it.
    pub(crate) fn middle(&self) -> DVec3 {
        let corners = self.corner_numbers.iter().map(|number| self.corners[*number as usize].at);
        corners.sum::<DVec3>() / self.corner_numbers.len() as f64
    }
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

/// Numbers that are equal for bodies with the same faces of the same materials, and for no others; `faces` gives those of a
/// body, and `mark` a [`mark_of`] them.
pub(crate) fn kinds<'a>(bodies: usize, faces: impl Fn(u32) -> &'a [BodyFace], mark: impl Fn(u32) -> u64) -> Vec<u32> {
    let sorted = |number: u32| {
        let mut faces: Vec<(PlaneId, MaterialId)> =
            faces(number).iter().map(|face| (face.plane, face.material)).collect();
        faces.sort_unstable();
        faces
    };
    let mut known: FxHashMap<u64, Vec<u32>> = FxHashMap::default();
    let kind = |number: u32| {
        if faces(number).is_empty() {
            return number;
        }
        let alike = known.entry(mark(number)).or_default();
        let equal = (!alike.is_empty()).then(|| sorted(number));
        let first = equal.and_then(|own| alike.iter().copied().find(|other| sorted(*other) == own));
        first.unwrap_or_else(|| {
            alike.push(number);
            number
        })
    };
    (0..bodies as u32).map(kind).collect()
}

/// A number that faces of the same planes and materials share, whatever their order.
pub(crate) fn mark_of(faces: &[BodyFace]) -> u64 {
    let each = faces.iter().map(|face| FxBuildHasher.hash_one((face.plane, face.material)));
    each.fold(0, u64::wrapping_add)
}

/// Bodies that are built in a row have at least about so many planes.
const PLANES_OF_CHUNK: usize = 100;

/// Interns the planes of brushes and builds the body of each, in parallel.
pub(crate) fn build_bodies(brushes: &[Brush]) -> BrushBodies {
    let half_spaces: Vec<HalfSpace> =
        brushes.iter().flat_map(|brush| brush.faces.iter().map(|face| face.half_space)).collect();
    let (mut table, ids) = PlaneTable::intern(&half_spaces);
    let mut rest = ids.as_slice();
    let mut planes: Vec<Vec<PlaneId>> = brushes
        .iter()
        .map(|brush| {
            let (own, others) = rest.split_at(brush.faces.len());
            rest = others;
            own.to_vec()
        })
        .collect();
    // each chunk has a polytope of its own, which is worth the while from some planes on
    let least = PLANES_OF_CHUNK * brushes.len() / half_spaces.len().max(1);
    let with_planes: Vec<(&Brush, &Vec<PlaneId>)> = brushes.iter().zip(&planes).collect();
    let (parts, signs) = map_chunks(&with_planes, least, |chunk| {
        let mut polytope = IncrementalPolytope::with_epsilon(0.0);
        let body = |(brush, planes): &(&Brush, &Vec<PlaneId>)| {
            let materials: Vec<MaterialId> = brush.faces.iter().map(|face| face.material).collect();
            build(&table, planes, &materials, &mut polytope)
        };
        chunk.iter().map(body).collect::<Vec<BrushBody>>()
    });
    let mut bodies: Vec<BrushBody> = parts.into_iter().flatten().collect();
    renumber_planes(&mut table, &mut planes, &mut bodies);
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
    let mut body = Body {
        faces: Vec::new(),
        edges: Vec::new(),
        corners: Vec::new(),
        corner_numbers: Vec::new(),
        bounds: Bounds::EMPTY,
        volume: 0.0,
        gauge: OnceLock::new(),
    };
    let mut volume = Volume::default();
    let mut is_bounded = true;
    // the corners that other faces have as well, by their numbers
    let mut shared: Vec<Option<u32>> = vec![None; polytope.corner_bound()];
    polytope.for_each_facet(|plane, edges| {
        let (plane, material) = face_of(plane);
        let start = body.edges.len();
        for edge in edges {
            let Some(edge) = edge.plane else {
                is_bounded = false;
                return;
            };
            body.edges.push(face_of(edge).0);
        }
        let mut bounds = Bounds::EMPTY;
        volume.begin_face();
        for (i, edge) in edges.iter().enumerate() {
            let triple = [plane, body.edges[start + i], body.edges[start + (i + 1) % edges.len()]];
            let known = edge.corner.and_then(|number| shared[number]);
            let number = known.unwrap_or_else(|| {
                let number = body.corners.len() as u32;
                body.corners.push(Corner { number, ..Corner::new(table.homogeneous(triple)) });
                number
            });
            if let Some(shared_number) = edge.corner {
                shared[shared_number] = Some(number);
            }
            let corner = &body.corners[number as usize];
            bounds = bounds.with_corner(corner);
            volume.add(if corner.is_well_known() { Some(corner.at) } else { table.position(triple) });
            body.corner_numbers.push(number);
        }
        body.bounds = body.bounds.union(&bounds);
        let (start, end) = (start as u32, body.edges.len() as u32);
        body.faces.push(BodyFace { plane, material, bounds, start, end });
    });
    body.tighten_bounds(table);
    body.volume = volume.six / 6.0;
    is_bounded.then_some(body)
}

/// The volume between the polygons of a convex boundary, as a sum of tetrahedra from one corner: nothing cancels.
#[derive(Default)]
struct Volume {
    six: f64,
    apex: Option<DVec3>,
    /// The first corner of the face and the last one so far, seen from the apex.
    first: Option<DVec3>,
    last: Option<DVec3>,
}

impl Volume {
    fn begin_face(&mut self) {
        (self.first, self.last) = (None, None);
    }

    fn add(&mut self, corner: Option<DVec3>) {
        let Some(corner) = corner else { return };
        let corner = corner - *self.apex.get_or_insert(corner);
        let first = *self.first.get_or_insert(corner);
        if let Some(last) = self.last {
            self.six += first.cross(last).dot(corner);
        }
        self.last = Some(corner);
    }
}
