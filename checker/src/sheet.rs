//! Crossings that run along mesh edges.
//!
//! Where two surfaces cross exactly along an edge, each pair of triangles only touches: models on a grid do that. The two
//! triangles at an edge form a *sheet* that is folded there. A sheet crosses a triangle that holds its edge where its wings
//! are on opposite sides, and crosses another sheet with a collinear edge where the four wings alternate around the line.
//!
//! Only clear cases count, so that rounded corners cannot feign one: angles above [`MIN_SINE`], lengths above
//! [`MIN_REACH`] times the limit. All of it is floating point; a sheet that is missed is one that nearly folds onto the other.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use crate::edges::{NO_TWIN, next, origin, previous};
use crate::separation::{edges, normal, overlap_along};

/// Lengths must exceed this many times the limit: a corner that is uncertain by half the limit then turns a direction by
/// less than [`MIN_SINE`].
const MIN_REACH: f64 = 100.0;
/// Sine of the least angle that is told from zero, about one degree.
const MIN_SINE: f64 = 0.02;

/// The sheets of a mesh: its edges with the two triangles at each.
pub(crate) struct Sheets<'a> {
    triangles: &'a [[u32; 3]],
    twins: &'a [u32],
    positions: &'a [DVec3],
}

/// An edge and the two corners opposite to it.
#[derive(Clone, Copy)]
struct Sheet {
    from: DVec3,
    to: DVec3,
    wings: [DVec3; 2],
}

impl<'a> Sheets<'a> {
    pub(crate) fn new(triangles: &'a [[u32; 3]], twins: &'a [u32], positions: &'a [DVec3]) -> Self {
        Self { triangles, twins, positions }
    }

    /// How deeply the surfaces of two triangles cross along one of their edges, if they do.
    pub(crate) fn crossing(&self, t: usize, u: usize, limit: f64) -> Option<f64> {
        let (sheets_t, sheets_u) = (self.around(t), self.around(u));
        let through_face = |sheets: &[Option<Sheet>; 3], face: usize| {
            let corners = self.triangles[face].map(|v| self.positions[v as usize]);
            let axis = normal(&corners).try_normalize()?;
            sheets.iter().flatten().find_map(|sheet| sheet.depth_through_face(&corners, axis, limit))
        };
        let through_sheet = || {
            let pairs = sheets_t.iter().flatten().flat_map(|e| sheets_u.iter().flatten().map(move |f| (e, f)));
            pairs.into_iter().find_map(|(e, f)| e.depth_through_sheet(f, limit))
        };
        through_face(&sheets_t, u).or_else(|| through_face(&sheets_u, t)).or_else(through_sheet)
    }

    /// The sheets of a triangle's edges, where they have a twin.
    fn around(&self, triangle: usize) -> [Option<Sheet>; 3] {
        let at = |half_edge| self.positions[origin(self.triangles, half_edge) as usize];
        [0, 1, 2].map(|k| {
            let half_edge = (3 * triangle + k) as u32;
            let twin = self.twins[half_edge as usize];
            (twin != NO_TWIN).then(|| Sheet {
                from: at(half_edge),
                to: at(next(half_edge)),
                wings: [at(previous(half_edge)), at(previous(twin))],
            })
        })
    }
}

impl Sheet {
    fn length(&self) -> f64 {
        self.from.distance(self.to)
    }

    fn distance_from_line(&self, point: DVec3) -> f64 {
        let along = (self.to - self.from).normalize_or_zero();
        (point - self.from).reject_from_normalized(along).length()
    }

    /// Depth to which the wings reach out on both sides of a face in which the edge lies.
    fn depth_through_face(&self, corners: &[DVec3; 3], axis: DVec3, limit: f64) -> Option<f64> {
        let height = |p: DVec3| axis.dot(p - corners[0]);
        if height(self.from).abs() > limit || height(self.to).abs() > limit {
            return None;
        }
        let [up, down] = self.wings.map(height);
        let is_clear = |wing: DVec3, height: f64| {
            let reach = self.distance_from_line(wing);
            reach > MIN_REACH * limit && height.abs() > MIN_SINE * reach
        };
        if (up > 0.0) == (down > 0.0) || !is_clear(self.wings[0], up) || !is_clear(self.wings[1], down) {
            return None;
        }
        // The edge must pass the inside of the face, not its border.
        let segment = [self.from, self.to];
        let mut depth = up.abs().min(down.abs());
        let sides = edges(corners).into_iter().map(|(p, q)| q - p);
        for side in sides.chain([self.to - self.from]) {
            depth = depth.min(overlap_along(axis.cross(side), &segment, corners, MIN_REACH * limit)?);
        }
        Some(depth)
    }

    /// Depth to which two sheets whose edges share a part of one line reach through each other.
    fn depth_through_sheet(&self, other: &Self, limit: f64) -> Option<f64> {
        let (long, short) = if self.length() >= other.length() { (self, other) } else { (other, self) };
        let along = (long.to - long.from).try_normalize()?;
        let from_line = |p: DVec3| (p - long.from).reject_from_normalized(along);
        if from_line(short.from).length() > limit || from_line(short.to).length() > limit {
            return None;
        }
        overlap_along(along, &[long.from, long.to], &[short.from, short.to], MIN_REACH * limit)?;
        let (x, y) = along.any_orthonormal_pair();
        let wings = [long.wings[0], short.wings[0], long.wings[1], short.wings[1]]
            .map(from_line)
            .map(|w| DVec2::new(w.dot(x), w.dot(y)));
        let reach = wings.iter().map(|w| w.length()).fold(f64::INFINITY, f64::min);
        let gap = alternation(wings.map(|w| w.to_angle()))?;
        (reach > MIN_REACH * limit && gap.sin() > MIN_SINE).then(|| reach * gap.sin())
    }
}

/// Least angle between neighbours where four directions come in the order given or its reverse, `None` where they do not. At most
/// a right angle.
fn alternation(angles: [f64; 4]) -> Option<f64> {
    let [a, b, c] = [1, 2, 3].map(|k| (angles[k] - angles[0]).rem_euclid(TAU));
    let gaps = if a < b && b < c { [a, b - a, c - b, TAU - c] } else { [TAU - a, a - b, b - c, c] };
    let least = gaps.into_iter().fold(f64::INFINITY, f64::min);
    (least > 0.0).then_some(least)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn alternation_is_told_from_nesting() {
        assert!(alternation([0.0, 1.0, 2.0, 3.0]).is_some());
        assert!(alternation([0.0, 3.0, 2.0, 1.0]).is_some());
        assert!(alternation([6.0, 1.0, 2.0, 3.0]).is_some());
        assert!(alternation([0.0, 2.0, 1.0, 3.0]).is_none());
        assert!(alternation([0.0, 1.0, 3.0, 2.0]).is_none());
        assert!(alternation([1.0, 1.0, 2.0, 3.0]).is_none());
    }
}
