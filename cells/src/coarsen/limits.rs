//! Cells with few faces and vertices, as physics engines want them, and none too thin.

use planecut_kernel::{DVec3, HalfSpace, IncrementalPolytope, PlaneIdx};
use rustc_hash::FxHashMap;

use super::clear::Clear;
use super::enclose::enclose;
use super::part::{Part, built};
use super::{CoarsenError, CoarsenOptions};
use crate::tolerances::{ONE_VERTEX, PARALLEL_EDGES, THICK_ENOUGH};

/// Of a cell with more edges not all pairs are looked at for its width.
const MOST_EDGES: usize = 300;

/// What every cell must fulfil.
pub(super) struct Limits<'a> {
    pub(super) options: &'a CoarsenOptions,
    pub(super) clear: &'a Clear,
}

impl Limits<'_> {
    /// The cell grown until it is thick enough and has few enough faces and vertices.
    ///
    /// # Errors
    /// [`CoarsenError::Blocked`] where what is kept clear does not allow that.
    pub(super) fn fulfil(&self, body: Part) -> Result<Part, CoarsenError> {
        let body = match self.options.min_thickness {
            Some(least) => self.thickened(body, least)?,
            None => body,
        };
        self.reduced(body)
    }

    /// The body of fewest faces and vertices that is left when planes are taken out, always the one that adds least.
    fn reduced(&self, body: Part) -> Result<Part, CoarsenError> {
        let most_faces = self.options.max_faces.unwrap_or(usize::MAX);
        let most_vertices = self.options.max_vertices.unwrap_or(usize::MAX);
        if most_faces == usize::MAX && most_vertices == usize::MAX {
            return Ok(body);
        }
        let mut polytope = IncrementalPolytope::with_epsilon(ONE_VERTEX * body.size());
        for half_space in &body.half_spaces {
            polytope.add_plane(*half_space);
        }
        let mut is_changed = false;
        let mut known: FxHashMap<usize, Removal> = FxHashMap::default();
        loop {
            let (faces, vertices) = (polytope.faces().len(), polytope.vertex_count());
            if faces <= most_faces && vertices <= most_vertices {
                break;
            }
            let facets = polytope.facets();
            known.retain(|plane, removal| facets.iter().any(|(p, around)| p.0 == *plane && *around == removal.around));
            let mut order: Vec<(f64, PlaneIdx)> = Vec::with_capacity(facets.len());
            for (plane, around) in facets {
                let removal = known.entry(plane.0).or_insert_with(|| Removal::new(&polytope, plane, around));
                order.extend(removal.added.map(|added| (added, plane)));
            }
            order.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.0.cmp(&b.1.0)));
            let without = |(_, plane): (f64, PlaneIdx)| {
                let mut wider = polytope.clone();
                wider.remove_plane(plane);
                (wider.is_bounded() && self.clear.allows(&wider)).then_some(wider)
            };
            polytope = order.into_iter().find_map(without).ok_or(CoarsenError::Blocked { faces, vertices })?;
            is_changed = true;
        }
        if !is_changed {
            return Ok(body);
        }
        let facets = polytope.facets();
        Part::of_cell(facets.iter().filter_map(|(plane, _)| polytope.plane(*plane).copied()), body.material)
    }

    /// The cell swept along the direction in which it is thinnest, until it is nowhere thinner than `least`; on one side alone where the other
    /// is kept clear, and as it is where both are.
    fn thickened(&self, mut body: Part, least: f64) -> Result<Part, CoarsenError> {
        // a needle is thin in two directions
        for _ in 0..3 {
            let (direction, width) = thinnest(&body);
            let lacking = least - width;
            if lacking <= THICK_ENOUGH * least {
                break;
            }
            let mut swept = None;
            for (forth, back) in [(0.5, 0.5), (1.0, 0.0), (0.0, 1.0)] {
                let wider = self.swept(&body, direction * lacking * forth, direction * lacking * back)?;
                if self.clear.allows(&wider.polytope) {
                    swept = Some(wider);
                    break;
                }
            }
            match swept {
                Some(wider) => body = wider,
                None => break,
            }
        }
        Ok(body)
    }

    fn swept(&self, body: &Part, forth: DVec3, back: DVec3) -> Result<Part, CoarsenError> {
        let points = body.corners.iter().flat_map(|corner| [*corner + forth, *corner - back]).collect();
        Part::of_cell(enclose(&[&Part { points, ..body.clone() }], self.clear)?, body.material)
    }
}

/// What taking out a plane adds.
struct Removal {
    /// The planes around its face.
    around: Vec<Option<PlaneIdx>>,
    /// The volume; `None` where there is no end to it.
    added: Option<f64>,
}

impl Removal {
    /// Beyond a face, a body without its plane is bounded by the planes around it alone.
    fn new(polytope: &IncrementalPolytope, plane: PlaneIdx, around: Vec<Option<PlaneIdx>>) -> Self {
        let sides = around.iter().flatten().filter_map(|side| polytope.plane(*side).copied());
        let below = polytope.plane(plane).map(HalfSpace::flipped);
        let added = built(sides.chain(below)).measures().map(|measures| measures.volume);
        Self { around, added }
    }
}

/// The direction in which a body is thinnest, and its width there.
///
/// The least width is found across a face, or across two edges that are not parallel (Houle, Toussaint 1988).
fn thinnest(body: &Part) -> (DVec3, f64) {
    let (corners, polygons) = body.polytope.to_mesh();
    let mut directions: Vec<DVec3> = body.half_spaces.iter().map(|plane| unit(plane.normal())).collect();
    let edges =
        polygons.iter().flat_map(|polygon| (0..polygon.len()).map(|k| (polygon[k], polygon[(k + 1) % polygon.len()])));
    let edges: Vec<DVec3> =
        edges.filter(|(a, b)| a < b).map(|(a, b)| unit(corners[b] - corners[a])).take(MOST_EDGES).collect();
    for (k, first) in edges.iter().enumerate() {
        let across =
            edges[k + 1..].iter().map(|second| first.cross(*second)).filter(|across| across.length() > PARALLEL_EDGES);
        directions.extend(across.map(unit));
    }
    let width = |direction: &DVec3| {
        let along = corners.iter().map(|corner| direction.dot(*corner));
        let (low, high) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
        high - low
    };
    let widths = directions.into_iter().map(|direction| (direction, width(&direction)));
    widths.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((DVec3::Z, f64::INFINITY))
}

fn unit(v: DVec3) -> DVec3 {
    v.normalize_or(DVec3::Z)
}
