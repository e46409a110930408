//! Hulls as the search sees them: planes and corners in floating point, and the probes that they cover.
//!
//! They propose what to merge. What is kept of a proposal is built again by exact signs ([`super::enclose`]).

use std::sync::OnceLock;

use planecut_csg::stages::Bounds;
use planecut_kernel::{DVec3, approximate_hull_triangles};

use super::part::bounds_of;
use super::probes::{Coverage, Probes};
use crate::tolerances::{COPLANAR_COSINE, HULL_TOUCHING};

/// The hull of points.
#[derive(Debug, Clone)]
pub(super) struct Hull {
    /// Its corners; some may lie within a facet.
    pub(super) corners: Vec<DVec3>,
    /// Unit normals and offsets.
    pub(super) planes: Vec<(DVec3, f64)>,
    pub(super) bounds: Bounds,
    pub(super) volume: f64,
    /// The probes within it, once they were asked for: of most hulls that are tried, shape and volume say enough.
    coverage: OnceLock<Coverage>,
}

impl Hull {
    /// The hull of points; their box where they span no space.
    pub(super) fn of(points: &[DVec3]) -> Self {
        let bounds = bounds_of(points);
        let mut hull = Self { corners: Vec::new(), planes: Vec::new(), bounds, volume: 0.0, coverage: OnceLock::new() };
        match approximate_hull_triangles(points, HULL_TOUCHING * hull.size()) {
            Ok(triangles) => hull.take(points, &triangles),
            Err(_) => {
                hull.corners = points.to_vec();
                hull.planes = sides_of(&bounds).collect();
            }
        }
        hull
    }

    fn take(&mut self, points: &[DVec3], triangles: &[[u32; 3]]) {
        let center = self.bounds.center();
        let mut is_corner = vec![false; points.len()];
        let mut volume = 0.0;
        for triangle in triangles {
            triangle.iter().for_each(|corner| is_corner[*corner as usize] = true);
            let [a, b, c] = triangle.map(|corner| points[corner as usize] - center);
            let normal = (b - a).cross(c - a);
            volume += normal.dot(a);
            let length = normal.length();
            if length > 0.0 {
                let normal = normal / length;
                let is_known = |(known, offset): &(DVec3, f64)| {
                    known.dot(normal) > COPLANAR_COSINE && (offset - normal.dot(a)).abs() <= HULL_TOUCHING * self.size()
                };
                if !self.planes.iter().any(is_known) {
                    self.planes.push((normal, normal.dot(a)));
                }
            }
        }
        self.volume = volume / 6.0;
        self.corners = points.iter().zip(&is_corner).filter(|(_, is_corner)| **is_corner).map(|(p, _)| *p).collect();
        for (normal, offset) in &mut self.planes {
            // the normals of slivers are no good: what they cut off is given back
            *offset = self.corners.iter().map(|corner| normal.dot(*corner)).fold(f64::NEG_INFINITY, f64::max);
        }
    }

    /// The probes within it.
    pub(super) fn coverage(&self, probes: &Probes) -> &Coverage {
        self.coverage.get_or_init(|| probes.within(&self.planes, &self.bounds))
    }

    /// Whether its probes are known.
    pub(super) fn is_covered(&self) -> bool {
        self.coverage.get().is_some()
    }

    /// The diagonal of its box.
    pub(super) fn size(&self) -> f64 {
        (self.bounds.max - self.bounds.min).length()
    }

    /// The box of all that it may hold, or nearly.
    pub(super) fn reach(&self) -> Bounds {
        let margin = DVec3::splat(HULL_TOUCHING * self.size());
        Bounds { min: self.bounds.min - margin, max: self.bounds.max + margin }
    }

    /// Whether points in a box lie within it, or outside by no more than rounding.
    pub(super) fn holds(&self, bounds: &Bounds, points: &[DVec3]) -> bool {
        let margin = HULL_TOUCHING * self.size();
        let reach = self.reach();
        let fits = bounds.min.cmpge(reach.min).all() && bounds.max.cmple(reach.max).all();
        let is_within =
            |point: &DVec3| self.planes.iter().all(|(normal, offset)| normal.dot(*point) <= offset + margin);
        fits && points.iter().all(is_within)
    }
}

/// The planes of a box: unit normals and offsets.
pub(super) fn sides_of(bounds: &Bounds) -> impl Iterator<Item = (DVec3, f64)> {
    let Bounds { min, max } = *bounds;
    DVec3::AXES.into_iter().flat_map(move |axis| [(axis, axis.dot(max)), (-axis, -axis.dot(min))])
}
