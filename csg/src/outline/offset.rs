//! Outlines grown and shrunk.
//!
//! Growing adds a strip along each side and, where the outline bends outward, what the join says; shrinking takes the same
//! strips of the other side away. So nothing is left to chance where strips overlap: it is a union like any other.

use i_overlay::core::overlay_rule::OverlayRule;
use planecut_kernel::DVec2;

use super::Outline;
use crate::primitives::ShapeError;
use crate::primitives::parameter::{coordinate, segments as accepted_segments};

/// What an offset makes of a corner that it goes around.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Join {
    /// An arc of chords between points on the circle, the arc cut into equal parts.
    #[default]
    Round,
    /// The sides run on until they meet; where that is more than [`MITER_LIMIT`] times the distance away, as
    /// [`Bevel`](Self::Bevel).
    Miter,
    /// The corner is cut straight between the ends of the sides.
    Bevel,
}

/// How many times the distance a mitered corner may lie from the corner that it goes around; the one of SVG.
pub const MITER_LIMIT: f64 = 4.0;

impl Outline {
    /// The outline grown by `by` on all sides, shrunk where that is negative; `segments` is the number of segments of a
    /// whole turn where corners are round.
    ///
    /// # Errors
    /// [`ShapeError::Parameter`] where the distance is not accepted or the segments are not 3 to 10,000.
    pub fn offset(&self, by: f64, join: Join, segments: u32) -> Result<Self, ShapeError> {
        let (by, segments) = (coordinate("by", by)?, accepted_segments("segments", segments)?);
        if by == 0.0 {
            return Ok(self.clone());
        }
        let band = Band { distance: by.abs(), join, segments };
        let rule = if by > 0.0 { OverlayRule::Union } else { OverlayRule::Difference };
        let mut pieces = Vec::new();
        for corners in self.loops() {
            let mut corners = corners.clone();
            if by < 0.0 {
                corners.reverse();
            }
            band.along(&corners, &mut pieces);
        }
        Ok(self.with_loops(&pieces, rule))
    }
}

/// The strip to the right of a loop.
struct Band {
    distance: f64,
    join: Join,
    segments: u32,
}

impl Band {
    /// Adds the parts of the strip, each counter-clockwise.
    fn along(&self, corners: &[DVec2], pieces: &mut Vec<Vec<DVec2>>) {
        let n = corners.len();
        let normal = |k: usize| outward(corners[(k + 1) % n] - corners[k % n]);
        for k in 0..n {
            let (p, q) = (corners[k], corners[(k + 1) % n]);
            let (before, own, after) = (normal(k + n - 1), normal(k), normal(k + 1));
            let start = self.miter(before, own).unwrap_or(own);
            let end = self.miter(own, after).unwrap_or(own);
            pieces.push(vec![p, p + start * self.distance, q + end * self.distance, q]);
            if own.perp_dot(after) > 0.0 || own.dot(after) < 0.0 && own.perp_dot(after) == 0.0 {
                pieces.extend(self.join(q, own, after));
            }
        }
    }

    /// Where two sides with these normals meet again, for a distance of 1, where the join asks for it.
    fn miter(&self, before: DVec2, after: DVec2) -> Option<DVec2> {
        // half the angle between the normals has the cosine 1 / |tip|
        let tip = (before + after) / (1.0 + before.dot(after));
        let bends = self.join == Join::Miter && before.perp_dot(after) > 0.0;
        (bends && tip.is_finite() && tip.length() <= MITER_LIMIT).then_some(tip)
    }

    /// What fills the gap between the strips of two sides at a corner.
    fn join(&self, corner: DVec2, before: DVec2, after: DVec2) -> Option<Vec<DVec2>> {
        if self.miter(before, after).is_some() {
            return None;
        }
        let steps = if self.join == Join::Round { self.steps(before, after) } else { 1 };
        let turn = angle(before, after) / steps as f64;
        let between = (1..steps).map(|k| DVec2::from_angle(turn * k as f64).rotate(before));
        let arc = std::iter::once(before).chain(between).chain([after]);
        Some(std::iter::once(corner).chain(arc.map(|v| corner + v * self.distance)).collect())
    }

    /// The number of chords of an arc.
    fn steps(&self, before: DVec2, after: DVec2) -> u32 {
        let whole = angle(before, after) / std::f64::consts::TAU * f64::from(self.segments);
        // an arc that is a whole number of segments but for rounding gets that number
        ((whole - 1e-9).ceil() as u32).max(1)
    }
}

/// The angle from one direction to another counter-clockwise, up to half a turn.
fn angle(before: DVec2, after: DVec2) -> f64 {
    before.perp_dot(after).abs().atan2(before.dot(after))
}

/// The unit normal to the right of a direction.
fn outward(along: DVec2) -> DVec2 {
    let unit = along / along.length();
    DVec2::new(unit.y, 0.0 - unit.x)
}
