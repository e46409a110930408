//! The part of a ray or a segment that lies in the set.

use std::cmp::Ordering;

use dashu_int::IBig;
use glam::DVec3;

use crate::arithmetic::{big_integers, round_quotient};
use crate::polytope::{IncrementalPolytope, PlaneIdx, external};
use crate::sign::{POINT_BOUND, Row, Sign, UNDERFLOW, integer_row, residual_with_error, side_of_point};

/// The part of a ray or a segment that lies in the closed set, by its parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ClippedLine {
    /// Where it begins, correctly rounded; 0 where the line begins in the set.
    pub from: f64,
    /// Where it ends, correctly rounded: for a ray infinite where it never leaves, for a segment 1.
    pub to: f64,
    /// The plane through which it enters; `None` where the line begins in the set. Of several the first by handle.
    pub entry: Option<PlaneIdx>,
    /// The plane through which it leaves; `None` where it does not. Of several the first by handle.
    pub exit: Option<PlaneIdx>,
}

/// `origin + t·direction`, or `origin + t·(target − origin)`.
#[derive(Debug, Clone, Copy)]
struct Line {
    origin: DVec3,
    toward: DVec3,
    is_segment: bool,
}

/// A parameter: a plane's crossing, or an end of the line.
#[derive(Debug, Clone)]
struct Parameter {
    plane: Option<u32>,
    low: f64,
    high: f64,
    exact: Option<(IBig, IBig)>,
}

impl Parameter {
    fn end(value: u8) -> Self {
        let at = f64::from(value);
        Self { plane: None, low: at, high: at, exact: Some((IBig::from(value), IBig::ONE)) }
    }
}

impl IncrementalPolytope {
    /// The part of the ray `origin + t·direction`, `t ≥ 0`, that lies in the closed set; `None` where they do not meet,
    /// the set is empty, or a number is not finite.
    ///
    /// The numbers are taken as exact, and whether they meet and through which planes is decided exactly. A ray of zero
    /// direction stays at its origin.
    ///
    /// ```
    /// use planecut_kernel::{DVec3, HalfSpace, IncrementalPolytope};
    ///
    /// # fn main() -> Result<(), planecut_kernel::HalfSpaceError> {
    /// let mut slab = IncrementalPolytope::new();
    /// slab.add_plane(HalfSpace::new(DVec3::Z, 1.0)?);
    /// let floor = slab.add_plane(HalfSpace::new(-DVec3::Z, 0.0)?).plane();
    /// let clip = slab.clip_ray(DVec3::new(0.0, 0.0, -2.0), DVec3::new(1.0, 0.0, 4.0)).expect("it meets the slab");
    /// assert_eq!((clip.from, clip.to, clip.entry), (0.5, 0.75, Some(floor)));
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn clip_ray(&self, origin: impl Into<DVec3>, direction: impl Into<DVec3>) -> Option<ClippedLine> {
        self.clip(Line { origin: origin.into(), toward: direction.into(), is_segment: false })
    }

    /// The part of the segment from `a` (parameter 0) to `b` (parameter 1) that lies in the closed set; `None` where they do
    /// not meet, the set is empty, or a number is not finite.
    ///
    /// The two points are taken as exact, and whether they meet and through which planes is decided exactly.
    ///
    /// ```
    /// use planecut_kernel::{DVec3, HalfSpace, IncrementalPolytope};
    ///
    /// # fn main() -> Result<(), planecut_kernel::HalfSpaceError> {
    /// let mut half = IncrementalPolytope::new();
    /// let plane = half.add_plane(HalfSpace::new(DVec3::X, 1.0)?).plane();
    /// let clip = half.clip_segment(DVec3::ZERO, DVec3::new(4.0, 0.0, 0.0)).expect("it begins inside");
    /// assert_eq!((clip.from, clip.to, clip.exit), (0.0, 0.25, Some(plane)));
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn clip_segment(&self, a: impl Into<DVec3>, b: impl Into<DVec3>) -> Option<ClippedLine> {
        self.clip(Line { origin: a.into(), toward: b.into(), is_segment: true })
    }

    fn clip(&self, line: Line) -> Option<ClippedLine> {
        if self.is_empty() || !line.origin.is_finite() || !line.toward.is_finite() {
            return None;
        }
        let mut entry = Parameter::end(0);
        let mut exit = line.is_segment.then(|| Parameter::end(1));
        for plane in self.face_slots() {
            let (slope, mut crossing) = line.crossing(self.row(plane), plane);
            match slope {
                Sign::Zero => {
                    if line.residual_sign(self.row(plane)) == Sign::Positive {
                        return None;
                    }
                }
                Sign::Negative => {
                    if self.compare(&line, &mut crossing, &mut entry) == Ordering::Greater {
                        entry = crossing;
                    }
                }
                Sign::Positive => {
                    let earlier = |exit: &mut Parameter| self.compare(&line, &mut crossing, exit) == Ordering::Less;
                    if exit.as_mut().is_none_or(earlier) {
                        exit = Some(crossing);
                    }
                }
            }
        }
        if let Some(exit) = &mut exit
            && self.compare(&line, &mut entry, exit) == Ordering::Greater
        {
            return None;
        }
        let mut value = |parameter: &mut Parameter| {
            let (numerator, denominator) = self.exactly(&line, parameter);
            round_quotient(numerator.clone(), denominator)
        };
        Some(ClippedLine {
            from: value(&mut entry),
            to: exit.as_mut().map_or(f64::INFINITY, &mut value),
            entry: entry.plane.map(external),
            exit: exit.and_then(|exit| exit.plane).map(external),
        })
    }

    /// The exact order of two parameters.
    fn compare(&self, line: &Line, a: &mut Parameter, b: &mut Parameter) -> Ordering {
        if a.high < b.low {
            return Ordering::Less;
        }
        if a.low > b.high {
            return Ordering::Greater;
        }
        let (p, q) = self.exactly(line, a);
        let (r, s) = self.exactly(line, b);
        (p * s).cmp(&(r * q))
    }

    /// Numerator and (positive) denominator of a parameter.
    fn exactly<'a>(&self, line: &Line, parameter: &'a mut Parameter) -> &'a (IBig, IBig) {
        let Parameter { plane, exact, .. } = parameter;
        exact.get_or_insert_with(|| {
            let plane = plane.expect("the ends of the line have their parameters from the start");
            let (residual, slope) = line.exact(self.row(plane));
            if slope < IBig::ZERO { (residual, -slope) } else { (-residual, slope) }
        })
    }
}

impl Line {
    /// `s(0)` and `s(1) − s(0)` for `s(t) = n·x(t) − d`, exactly, up to one positive scale.
    fn exact(&self, row: &Row) -> (IBig, IBig) {
        let (o, t) = (self.origin, self.toward);
        let [ox, oy, oz, tx, ty, tz, w] = big_integers([o.x, o.y, o.z, t.x, t.y, t.z, 1.0]);
        let [nx, ny, nz, d] = integer_row(row);
        let start = &nx * &ox + &ny * &oy + &nz * &oz;
        let mut slope = nx * tx + ny * ty + nz * tz;
        if self.is_segment {
            slope -= &start;
        }
        (start - d * w, slope)
    }

    fn residual_sign(&self, row: &Row) -> Sign {
        side_of_point(row, self.origin)
    }

    /// The sign of the slope along the line, and the parameter where the line crosses the plane, within bounds.
    fn crossing(&self, row: &Row, plane: u32) -> (Sign, Parameter) {
        let (start, start_error) = residual_with_error(row, self.origin);
        let (slope, slope_error) = if self.is_segment {
            let (end, end_error) = residual_with_error(row, self.toward);
            // the difference is rounded once more
            (end - start, (end_error + start_error) * (1.0 + f64::EPSILON) + POINT_BOUND * (end.abs() + start.abs()))
        } else {
            let [x, y, z, _] = *row.coefficients();
            let terms = [x * self.toward.x, y * self.toward.y, z * self.toward.z];
            let permanent = terms[0].abs() + terms[1].abs() + terms[2].abs();
            (terms[0] + terms[1] + terms[2], POINT_BOUND * permanent + UNDERFLOW)
        };
        let mut parameter = Parameter { plane: Some(plane), low: f64::NEG_INFINITY, high: f64::INFINITY, exact: None };
        let certain = slope.abs() > slope_error;
        if !certain {
            return (Sign::of_big(&self.exact(row).1), parameter);
        }
        let at = -start / slope;
        let error = 1.01 * (start_error + at.abs() * slope_error) / (slope.abs() - slope_error)
            + POINT_BOUND * at.abs()
            + UNDERFLOW;
        if (at + error).is_finite() && (at - error).is_finite() {
            (parameter.low, parameter.high) = (at - error, at + error);
        }
        (Sign::of(slope), parameter)
    }
}
