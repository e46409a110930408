//! Outlines grown and shrunk.
//!
//! Each loop is moved as a whole: where it turns away from its new place the corner gets what the join says, where it turns
//! towards it the moved loop goes through the corner itself. What a moved loop goes around at least once, counting clockwise
//! turns as negative, is the outline together with a strip along each side, or without these strips where it shrinks. So
//! nothing is left to chance where strips overlap: it is a union like any other.

use planecut_csg::sine_and_cosine;
use planecut_kernel::DVec2;

use super::{FillRule, Outline};
use crate::parameter::{ShapeError, coordinate, segments as accepted_segments};
use crate::tolerances::CLIPPER_GRID;

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

/// What an [`OffsetRule`] makes of a corner that it goes around, corner for corner as Angus Johnson's Clipper 6 does it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ClipperJoin {
    /// Steps of 360° over the number of segments of a whole turn, from the end of the side before on: as many as the bend has
    /// when rounded, at least one, and less one; a last chord of what is left. Three segments and four are taken for 4.35.
    Round {
        /// 3 to 10,000.
        segments: u32,
    },
    /// The sides run on until they meet; where that is more than a million times the distance away, as
    /// [`Square`](Self::Square).
    Miter,
    /// The corner is cut straight, square to the bisector and as far away as the sides.
    Square,
}

/// An offset as OpenSCAD makes it with Clipper 6: see [`Outline::offset_with`].
///
/// | OpenSCAD | rule |
/// |---|---|
/// | `offset(r = x)` | by `x`, [`ClipperJoin::Round`] with the segments of a circle of radius `\|x\|` |
/// | `offset(delta = x)` | by `x`, [`ClipperJoin::Miter`] |
/// | `offset(delta = x, chamfer = true)` | by `x`, [`ClipperJoin::Square`] |
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OffsetRule {
    /// By how much to grow, shrunk where it is negative.
    pub by: f64,
    /// What becomes of corners.
    pub join: ClipperJoin,
}

/// With `m` as the limit of a miter, `2 / m²`; OpenSCAD's is a million.
const CLIPPER_MITER: f64 = 2e-12;
/// Clipper's arcs deviate from the circle by this part of its radius at most.
const CLIPPER_TOLERANCE: f64 = 0.25;

impl Outline {
    /// The outline grown by `by` on all sides, shrunk where that is negative; `segments` is the number of segments of a
    /// whole turn where corners are round.
    ///
    /// # Errors
    /// [`ShapeError::Parameter`] where the distance is not accepted or the segments are not 3 to 10,000.
    pub fn offset(&self, by: f64, join: Join, segments: u32) -> Result<Self, ShapeError> {
        let (by, segments) = (coordinate("by", by)?, accepted_segments("segments", segments)?);
        let corner = |bend: &Bend| match join {
            Join::Round => equal_arc(bend, segments),
            Join::Miter => {
                miter(bend).filter(|tip| tip.length() <= MITER_LIMIT).map_or(vec![bend.before, bend.after], |p| vec![p])
            }
            Join::Bevel => vec![bend.before, bend.after],
        };
        Ok(self.moved(by, 0.0, &corner))
    }

    /// The outline grown or shrunk as Clipper 6 does it, but without its rounding to whole numbers.
    ///
    /// # Errors
    /// [`ShapeError::Parameter`] where the distance is not accepted or the segments are not 3 to 10,000.
    pub fn offset_with(&self, rule: &OffsetRule) -> Result<Self, ShapeError> {
        let by = coordinate("by", rule.by)?;
        if let ClipperJoin::Round { segments } = rule.join {
            accepted_segments("segments", segments)?;
        }
        let corner = |bend: &Bend| match rule.join {
            ClipperJoin::Round { segments } => stepped_arc(bend, segments),
            ClipperJoin::Miter => {
                let is_within = 1.0 + bend.before.dot(bend.after) >= CLIPPER_MITER;
                miter(bend).filter(|_| is_within).map_or_else(|| square(bend), |tip| vec![tip])
            }
            ClipperJoin::Square => square(bend),
        };
        Ok(self.moved(by, CLIPPER_GRID, &corner))
    }

    /// The region that its loops, moved outward by `by`, go around.
    fn moved(&self, by: f64, least: f64, corner: &dyn Fn(&Bend) -> Vec<DVec2>) -> Self {
        if by == 0.0 {
            return self.clone();
        }
        let loops: Vec<Vec<DVec2>> =
            self.loops().map(|corners| moved_loop(corners, by, least, corner)).filter(|c| c.len() >= 3).collect();
        Self::filled(&loops, FillRule::Positive).without_slivers()
    }
}

/// The unit normals of the sides before and after a corner, to the right of them.
struct Bend {
    before: DVec2,
    after: DVec2,
}

/// A loop moved to its right by `by`; where sides end nearer than `least` to each other, the second goes on along the first.
fn moved_loop(corners: &[DVec2], by: f64, least: f64, corner: &dyn Fn(&Bend) -> Vec<DVec2>) -> Vec<DVec2> {
    let n = corners.len();
    let normals: Vec<DVec2> = (0..n).map(|k| outward(corners[(k + 1) % n] - corners[k])).collect();
    let mut moved = Vec::with_capacity(2 * n);
    let mut before = n - 1;
    for (k, at) in corners.iter().enumerate() {
        let bend = Bend { before: normals[before], after: normals[k] };
        let sine = bend.before.perp_dot(bend.after);
        if (sine * by).abs() < least && bend.before.dot(bend.after) > 0.0 {
            moved.push(*at + bend.before * by);
            continue;
        }
        before = k;
        if sine * by < 0.0 {
            moved.extend([*at + bend.before * by, *at, *at + bend.after * by]);
        } else {
            moved.extend(corner(&bend).into_iter().map(|v| *at + v * by));
        }
    }
    moved
}

/// Where two sides meet again, for a distance of 1; nowhere where one comes back along the other.
fn miter(bend: &Bend) -> Option<DVec2> {
    // half the angle between the normals has the cosine 1 / |tip|; nothing cancels where they are nearly opposite
    let sum = bend.before + bend.after;
    let tip = sum * (2.0 / sum.length_squared());
    tip.is_finite().then_some(tip)
}

/// Ends of a cut square to the bisector and as far away as the sides, for a distance of 1.
fn square(bend: &Bend) -> Vec<DVec2> {
    let along = (angle(bend) / 4.0).tan();
    vec![bend.before + bend.before.perp() * along, bend.after - bend.after.perp() * along]
}

/// An arc of `⌈segments · bend / 360°⌉` equal parts.
fn equal_arc(bend: &Bend, segments: u32) -> Vec<DVec2> {
    let whole = angle(bend).abs() / std::f64::consts::TAU * f64::from(segments);
    // an arc that is a whole number of segments but for rounding gets that number
    let steps = ((whole - 1e-9).ceil() as u32).max(1);
    arc(bend, angle(bend) / f64::from(steps), steps)
}

/// An arc of steps as large as those of a whole turn, and what is left.
fn stepped_arc(bend: &Bend, segments: u32) -> Vec<DVec2> {
    let sagitta = 1.0 - sine_and_cosine(180.0 / f64::from(segments)).1;
    let fewest = std::f64::consts::PI / (1.0 - CLIPPER_TOLERANCE).acos();
    let segments = if sagitta > CLIPPER_TOLERANCE { fewest } else { std::f64::consts::PI / (1.0 - sagitta).acos() };
    let step = std::f64::consts::TAU / segments;
    // in this order, as halves of steps are rounded as they come out
    let steps = segments / std::f64::consts::TAU * angle(bend).abs();
    let steps = ((steps + 0.5).floor() as u32).max(1);
    arc(bend, step.copysign(angle(bend)), steps)
}

/// The directions after `0, 1, … steps − 1` steps, and the last.
fn arc(bend: &Bend, step: f64, steps: u32) -> Vec<DVec2> {
    let between = (1..steps).map(|k| DVec2::from_angle(step * f64::from(k)).rotate(bend.before));
    std::iter::once(bend.before).chain(between).chain([bend.after]).collect()
}

/// The angle from one normal to the other counter-clockwise, up to half a turn of either sense.
fn angle(bend: &Bend) -> f64 {
    bend.before.perp_dot(bend.after).atan2(bend.before.dot(bend.after))
}

/// The unit normal to the right of a direction.
fn outward(along: DVec2) -> DVec2 {
    let unit = along / along.length();
    DVec2::new(unit.y, 0.0 - unit.x)
}
