//! Points that faces do not need: those at which two faces alone meet, along a straight edge.

use glam::DVec3;
use planecut_kernel::sign::Sign;
use planecut_parallel::prelude::*;
use rustc_hash::FxHashSet;

use super::Arranged;
use super::merge::Face;
use super::predicates::best_axis;
use crate::ids::{Id, PointId};
use crate::tolerances::FLATNESS;

/// Faces that one thread looks at in a row.
const CHUNK: usize = 1 << 7;

impl Arranged<'_> {
    /// Takes points out of polygons, those from a place in the list of faces on, at which two faces alone meet, along a straight edge.
    pub(super) fn straighten(&self, faces: &mut [Face], first: usize) {
        let surface = &self.arrangement.surface;
        // of two polygons, once each: there it may go
        let mut uses = vec![0_u32; self.arrangement.points.len()];
        for point in faces[first..].iter().flat_map(|face| &face.loops).flatten() {
            uses[point.index()] += 1;
        }
        // corners of triangles stay
        for face in &faces[..first] {
            for corner in surface.corners[face.kept.facet.index()] {
                if uses[corner.index()] > 0 {
                    uses[corner.index()] += 2;
                }
            }
        }
        self.straighten_exactly(&mut faces[first..], &uses);
        self.straighten_within_rounding(&mut faces[first..], &uses);
    }

    fn straighten_exactly(&self, faces: &mut [Face], uses: &[u32]) {
        let surface = &self.arrangement.surface;
        let of_face = |face: &Face| {
            let triangle = self.facets.triangle(&self.arrangement.cells, face.kept.facet);
            let mut straight = Vec::new();
            let Some((axis, _)) = best_axis(surface.input, &surface.triangle(triangle)) else { return straight };
            for points in &face.loops {
                let count = points.len();
                for k in 0..count {
                    let [before, point, after] = [count - 1, 0, 1].map(|step| points[(k + step) % count]);
                    if uses[point.index()] == 2
                        // where a slit ends the turn is a whole one
                        && before != after
                        && self.arrangement.points.turn(surface, [before, point, after], axis) == Sign::Zero
                    {
                        straight.push(point);
                    }
                }
            }
            straight
        };
        let straight: Vec<Vec<PointId>> = faces.par_iter().with_min_len(CHUNK).map(of_face).collect();
        let mut times = vec![0_u8; self.arrangement.points.len()];
        straight.iter().flatten().for_each(|point| times[point.index()] += 1);
        for points in faces.iter_mut().flat_map(|face| &mut face.loops) {
            points.retain(|point| times[point.index()] != 2);
        }
    }

    /// Where a face is flat but for rounding, its edges are straight but for rounding.
    fn straighten_within_rounding(&self, faces: &mut [Face], uses: &[u32]) {
        let mut chains = Chains { arranged: self, straight: FxHashSet::default() };
        for points in faces.iter().filter(|face| !face.is_plane).flat_map(|face| &face.loops) {
            chains.of_loop(points, |point| uses[point.index()] != 2);
        }
        let straight = chains.straight;
        if !straight.is_empty() {
            for points in faces.iter_mut().flat_map(|face| &mut face.loops) {
                points.retain(|point| !straight.contains(point));
            }
        }
    }
}

/// Chains of points between two faces.
struct Chains<'a> {
    arranged: &'a Arranged<'a>,
    /// Points that lie on a straight line between two that stay.
    straight: FxHashSet<PointId>,
}

impl Chains<'_> {
    fn at(&self, point: PointId) -> DVec3 {
        self.arranged.arrangement.points.at(&self.arranged.arrangement.surface, point)
    }

    /// The chains of a loop, between points that stay.
    fn of_loop(&mut self, points: &[PointId], stays: impl Fn(&PointId) -> bool) {
        let mut ends: Vec<usize> = (0..points.len()).filter(|k| stays(&points[*k])).collect();
        if ends.len() == points.len() {
            return;
        }
        if ends.is_empty() {
            // two faces alone meet all around: its extreme points are corners of both
            let place = |k: &usize| (self.at(points[*k]).to_array(), points[*k]);
            let is_before = |a: &usize, b: &usize| {
                let ((p, a), (q, b)) = (place(a), place(b));
                let by_place = p.iter().zip(&q).map(|(p, q)| p.total_cmp(q)).find(|order| order.is_ne());
                by_place.unwrap_or_else(|| a.cmp(&b))
            };
            ends.extend((0..points.len()).min_by(is_before));
            ends.extend((0..points.len()).max_by(is_before));
            ends.sort_unstable();
            ends.dedup();
        }
        let mut chain = Vec::new();
        for (k, start) in ends.iter().enumerate() {
            let end = ends.get(k + 1).copied().unwrap_or(ends[0] + points.len());
            if end > start + 1 {
                chain.clear();
                chain.extend((*start..=end).map(|k| points[k % points.len()]));
                self.of_chain(&chain);
            }
        }
    }

    /// Finds the points within a chain that are not needed: the farthest from the line between the ends stays where rounding does not
    /// explain its distance, and divides the chain (Douglas and Peucker). The same from either end.
    fn of_chain(&mut self, chain: &[PointId]) {
        let mut parts = vec![chain];
        while let Some(part) = parts.pop() {
            let [from, within @ .., to] = part else { continue };
            let ends = [(*from).min(*to), (*from).max(*to)].map(|end| self.at(end));
            let size = part.iter().map(|point| self.at(*point).abs().max_element()).fold(0.0, f64::max);
            let distances: Vec<f64> = within.iter().map(|point| distance(self.at(*point), ends)).collect();
            let farther = |j: &usize, k: &usize| {
                distances[*j].total_cmp(&distances[*k]).then_with(|| within[*k].cmp(&within[*j]))
            };
            let Some(farthest) = (0..within.len()).max_by(farther) else { continue };
            if distances[farthest] <= FLATNESS * size {
                self.straight.extend(within);
            } else {
                parts.extend([&part[..farthest + 2], &part[farthest + 1..]]);
            }
        }
    }
}

/// The distance of a point from a segment; infinite where it lies beyond an end.
fn distance(point: DVec3, [a, b]: [DVec3; 2]) -> f64 {
    let (along, to) = (b - a, point - a);
    let length = along.length();
    let share = to.dot(along) / length;
    if (0.0..=length).contains(&share) { to.cross(along).length() / length } else { f64::INFINITY }
}
