//! Outlines in the plane: polygons with holes, their set operations, offsets, hulls and Minkowski sums.

mod boolean;
mod crossings;
mod hull;
mod minkowski;
mod offset;

use glam::DMat2;
pub(crate) use i_overlay::core::fill_rule::FillRule;
use planecut_kernel::DVec2;

pub use crossings::MAX_CROSSINGS;
pub(crate) use hull::{corners_of_hull, turn};
pub use offset::{ClipperJoin, Join, MITER_LIMIT, OffsetRule};

use crate::parameter::{ShapeError, direction, planar_point, positive, refuse, segments as accepted_segments};
use crate::tolerances::{NEGLIGIBLE_COORDINATE, SINGULAR_DETERMINANT};

/// A region of the plane, bounded by loops that do not cross: outer ones counter-clockwise, holes clockwise. Lengths have no
/// unit.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Outline {
    /// Connected regions, each its outer loop and then its holes.
    shapes: Vec<Vec<Vec<DVec2>>>,
}

impl Outline {
    /// Nothing.
    #[must_use]
    pub fn empty() -> Self {
        Self::default()
    }

    /// What lies within an odd number of loops: loops in others are holes. Loops may run either way and cross themselves and
    /// each other. Corners keep their coordinates to the last bit.
    ///
    /// # Errors
    /// [`ShapeError::Parameter`] where a loop has fewer than three points or a coordinate is not accepted,
    /// [`ShapeError::Crossings`] where sides cross more than [`MAX_CROSSINGS`] times.
    pub fn from_loops(loops: &[Vec<DVec2>]) -> Result<Self, ShapeError> {
        let loops = accepted(loops)?;
        crossings::refuse_many(loops.iter())?;
        Ok(Self::filled(&loops, FillRule::EvenOdd))
    }

    /// What loops go around, counting counter-clockwise turns as positive and clockwise ones as negative, a number of times
    /// that is not zero: loops that overlap in one sense join, those of opposite sense are holes in each other. It is the rule
    /// of glyphs.
    ///
    /// # Errors
    /// As [`from_loops`](Self::from_loops).
    pub fn from_wound_loops(loops: &[Vec<DVec2>]) -> Result<Self, ShapeError> {
        let loops = accepted(loops)?;
        crossings::refuse_many(loops.iter())?;
        Ok(Self::filled(&loops, FillRule::NonZero))
    }

    /// The rectangle between two corners.
    ///
    /// # Errors
    /// [`ShapeError::Parameter`] where a minimum is not below its maximum or a coordinate is not accepted.
    pub fn rectangle(min: impl Into<DVec2>, max: impl Into<DVec2>) -> Result<Self, ShapeError> {
        let (min, max) = (min.into(), max.into());
        let (min, max) = (planar_point("min", min)?, planar_point("max", max)?);
        for (name, low, high) in [("x", min.x, max.x), ("y", min.y, max.y)] {
            if low >= high {
                return Err(refuse("max", &format!("{name} = {high}"), &format!("more than {low}, that of min")));
            }
        }
        Ok(Self { shapes: vec![vec![vec![min, DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y)]]] })
    }

    /// A regular polygon about the origin, its corners on the circle, the first one on the x axis.
    ///
    /// # Errors
    /// [`ShapeError::Parameter`] where the radius is not above 0 or the segments are not 3 to 10,000.
    pub fn circle(radius: f64, segments: u32) -> Result<Self, ShapeError> {
        let (radius, segments) = (positive("radius", radius)?, accepted_segments("segments", segments)?);
        let corner = |k| direction(u64::from(k), u64::from(segments)) * radius;
        Ok(Self { shapes: vec![vec![(0..segments).map(corner).collect()]] })
    }

    /// The connected regions: of each the outer loop, counter-clockwise, and then the holes, clockwise.
    #[must_use]
    pub fn shapes(&self) -> &[Vec<Vec<DVec2>>] {
        &self.shapes
    }

    /// All loops.
    pub fn loops(&self) -> impl Iterator<Item = &Vec<DVec2>> + Clone {
        self.shapes.iter().flatten()
    }

    /// The number of corners of all loops.
    #[must_use]
    pub fn corner_count(&self) -> usize {
        self.loops().map(Vec::len).sum()
    }

    /// Whether nothing is left.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.shapes.is_empty()
    }

    /// The area.
    #[must_use]
    pub fn area(&self) -> f64 {
        self.loops().map(|corners| signed_area(corners)).sum()
    }

    /// The outline moved by an affine map, `x ↦ linear x + translation`, which may mirror it.
    ///
    /// # Errors
    /// [`ShapeError::Parameter`] where the matrix is flat or a coordinate is not accepted.
    pub fn transformed(&self, linear: DMat2, translation: DVec2) -> Result<Self, ShapeError> {
        let (size, determinant) = (linear.x_axis.length() * linear.y_axis.length(), linear.determinant());
        if !(determinant.abs() > SINGULAR_DETERMINANT * size && size.is_finite() && translation.is_finite()) {
            return Err(refuse("matrix", &"one that is singular or not finite", &"one that can be undone"));
        }
        let moved = |corners: &Vec<DVec2>| {
            let moved = corners.iter().map(|p| planar_point("matrix", clean(linear * *p + translation, *p)));
            moved.collect::<Result<Vec<DVec2>, ShapeError>>()
        };
        let loops = self.loops().map(moved).collect::<Result<Vec<_>, ShapeError>>()?;
        Ok(Self::filled(&loops, FillRule::EvenOdd))
    }
}

/// Loops of at least three accepted points each.
fn accepted(loops: &[Vec<DVec2>]) -> Result<Vec<Vec<DVec2>>, ShapeError> {
    let accepted = |corners: &Vec<DVec2>| {
        if corners.len() < 3 {
            return Err(refuse("polygon", &format!("a loop of {} points", corners.len()), &"at least 3"));
        }
        corners.iter().map(|p| planar_point("polygon", *p)).collect()
    };
    loops.iter().map(accepted).collect()
}

/// A point without coordinates that are mere rounding noise, so that they stay within the accepted range.
fn clean(moved: DVec2, from: DVec2) -> DVec2 {
    let noise = NEGLIGIBLE_COORDINATE * moved.abs().max_element().max(from.abs().max_element());
    DVec2::from_array(moved.to_array().map(|v| if v.abs() < noise { 0.0 } else { v }))
}

/// The area within a loop, negative where it runs clockwise.
pub(crate) fn signed_area(corners: &[DVec2]) -> f64 {
    let Some(origin) = corners.first() else { return 0.0 };
    0.5 * corners.windows(2).map(|pair| (pair[0] - origin).perp_dot(pair[1] - origin)).sum::<f64>()
}

/// The largest magnitude of a coordinate of some points; 0 without any.
pub(crate) fn largest_coordinate<'a>(points: impl IntoIterator<Item = &'a DVec2>) -> f64 {
    points.into_iter().map(|p| p.abs().max_element()).fold(0.0, f64::max)
}
