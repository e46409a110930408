//! The side of a plane on which a kept corner lies, as far as floating point tells: one plane, many corners.

use super::filter::DET4_BOUND;
use super::{Homogeneous, OffsetColumn, Row, Sign, counts};

/// The sign bit of an `f64`, which no permanent uses.
const SIGN: u64 = 1 << 63;

/// A meeting point as it is kept with each vertex: [`Homogeneous::quick`] has two different permanents, and of these the
/// upper halves, rounded up, are enough for a bound. A record of a vertex fits one cache line then.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Corner {
    value: [f64; 4],
    /// In the upper half that of the three coordinates, in the lower half that of `W`. The sign tells the column.
    permanents: u64,
}

impl Corner {
    /// What a free slot holds.
    pub(crate) const NOWHERE: Self = Self { value: [0.0; 4], permanents: 0 };

    /// Keeps a point that was made for a column by [`Homogeneous::quick`] or [`Homogeneous::corner`].
    #[inline(always)]
    pub(crate) fn new(point: &Homogeneous, column: OffsetColumn) -> Self {
        // the lower half of what is rounded up is less than one unit of the upper half
        let [reach, weight] = [point.permanent[0], point.permanent[3]].map(|v| (v.to_bits() >> 32) + 1);
        let sign = if column == OffsetColumn::Infinite { SIGN } else { 0 };
        Self { value: point.value, permanents: sign | reach << 32 | weight }
    }

    /// Whether this is the part in `M`, of a point on an infinity plane.
    #[inline(always)]
    pub(crate) fn is_ideal(&self) -> bool {
        self.permanents & SIGN != 0
    }

    /// About where a point is that is not ideal.
    #[inline(always)]
    pub(crate) fn place(&self) -> [f64; 3] {
        let [x, y, z, w] = self.value;
        let scale = 1.0 / w;
        [x * scale, y * scale, z * scale]
    }

    /// At least the permanents of the coordinates and of `W`, and hardly more.
    #[inline(always)]
    fn permanents(&self) -> [f64; 2] {
        // what is below the upper half makes a number larger by less than rounding up did
        [f64::from_bits(self.permanents & !SIGN), f64::from_bits(self.permanents << 32)]
    }

    /// The same with a permanent for each coordinate.
    pub(crate) fn homogeneous(&self) -> Homogeneous {
        let [reach, weight] = self.permanents();
        Homogeneous { value: self.value, permanent: [reach, reach, reach, weight] }
    }
}

/// A plane that many points are held against.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Probe {
    normal: [f64; 3],
    offset: f64,
    /// Bounds for the two parts of a permanent.
    bounds: [f64; 2],
}

impl Probe {
    /// A plane with its offset in one column.
    #[inline(always)]
    pub(crate) fn new(plane: &Row, column: OffsetColumn) -> Self {
        let [x, y, z, _] = *plane.coefficients();
        let offset = column.of(plane);
        let bounds = [DET4_BOUND * (x.abs() + y.abs() + z.abs()), DET4_BOUND * offset.abs()];
        Self { normal: [x, y, z], offset, bounds }
    }

    /// The side of the plane that a point is certainly on that was made for the same column; else zero.
    #[inline(always)]
    pub(crate) fn certain_side(&self, point: &Corner) -> Sign {
        let [x, y, z, w] = point.value;
        let [reach, weight] = point.permanents();
        let value = self.normal[0] * x + self.normal[1] * y + self.normal[2] * z - self.offset * w;
        let bound = self.bounds[0] * reach + self.bounds[1] * weight;
        if value > bound {
            counts::note_total();
            Sign::Positive
        } else if value < -bound {
            counts::note_total();
            Sign::Negative
        } else {
            Sign::Zero
        }
    }
}
