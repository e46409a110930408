//! Cells with few faces and vertices, as physics engines want them, and none too thin.

use planecut_kernel::DVec3;

use super::clear::Clear;
use super::enclose::enclose;
use super::lower::lower_beside;
use super::part::{Part, mesh_of};
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
        let CoarsenOptions { max_faces, max_vertices, .. } = *self.options;
        if max_faces.is_none() && max_vertices.is_none() {
            return Ok(body);
        }
        let faces = body.half_spaces.len();
        let mut polytope = body.polytope.clone();
        polytope.set_epsilon(ONE_VERTEX * body.size());
        lower_beside(&mut polytope, max_faces, max_vertices, self.clear)?;
        if polytope.planes().count() == faces {
            return Ok(body);
        }
        Part::of_cell(polytope.planes().map(|(_, plane)| *plane), body.material)
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

/// The direction in which a body is thinnest, and its width there.
///
/// The least width is found across a face, or across two edges that are not parallel (Houle, Toussaint 1988).
fn thinnest(body: &Part) -> (DVec3, f64) {
    let (corners, polygons) = mesh_of(&body.polytope);
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
