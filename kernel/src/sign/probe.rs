//! The side of a plane on which a kept corner lies, as far as floating point tells: one plane, many corners.

use super::filter::DET4_BOUND;
use super::{Homogeneous, OffsetColumn, Row, Sign, counts, cross};

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

    /// Keeps a point that was made for a column by [`Homogeneous::quick`].
    #[inline(always)]
    pub(crate) fn new(point: &Homogeneous, column: OffsetColumn) -> Self {
        let sign = if column == OffsetColumn::Infinite { SIGN } else { 0 };
        Self::keep(point.value, [point.permanent[0], point.permanent[3]], sign)
    }

    #[inline(always)]
    fn keep(value: [f64; 4], permanents: [f64; 2], sign: u64) -> Self {
        // the lower half of what is rounded up is less than one unit of the upper half
        const ONE_EACH: u64 = 1 << 32 | 1;
        let [reach, weight] = permanents.map(f64::to_bits);
        Self { value, permanents: sign | ((reach & !0 << 32 | weight >> 32) + ONE_EACH) }
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

    /// Bounds for how far off [`place`](Self::place) is before it is rounded: one for a point near the origin, and what each unit of its
    /// distance from the origin, along the axis where it is largest, adds.
    ///
    /// With errors `x` and `w` of `X` and `W`, the point is `t = (X + x) / (W + w)`, so that `t − X/W = (x − t·w) / W`. Each error is less
    /// than the bound for a side, which has a product and three sums more. Where `W` may be zero, the second is not less than one.
    #[inline(always)]
    pub(crate) fn place_errors(&self) -> [f64; 2] {
        let scale = DET4_BOUND * (1.0 / self.value[3]).abs();
        self.permanents().map(|permanent| permanent * scale)
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

/// The corners of a face, one after the other around it: where its plane meets a plane of the ring and the next one. What
/// two corners share is computed once.
pub(crate) struct FaceCorners<'a> {
    n: &'a Row,
    /// The plane of the ring before.
    p: &'a Row,
    /// `n×p`.
    n_p: [f64; 3],
    magnitude_p: f64,
    /// The magnitude of the offset of `p` times twice that of `n`.
    reach_p: f64,
    /// Twice the magnitudes of the offset and the normal of `n`: each minor has two products.
    twice: [f64; 2],
}

impl<'a> FaceCorners<'a> {
    /// Begins with a plane of the ring.
    #[inline(always)]
    pub(crate) fn begin(n: &'a Row, p: &'a Row) -> Self {
        let twice = [2.0 * n.coefficients()[3].abs(), 2.0 * n.magnitude()];
        Self {
            n,
            p,
            n_p: cross(n, p),
            magnitude_p: p.magnitude(),
            reach_p: twice[1] * p.coefficients()[3].abs(),
            twice,
        }
    }

    /// The corner between the plane of the ring before and this one, as [`Homogeneous::quick`] has it; all planes must be finite.
    #[inline(always)]
    pub(crate) fn next(&mut self, q: &'a Row) -> Corner {
        let (n, p) = (self.n.coefficients(), self.p.coefficients());
        let (n_q, p_q) = (cross(self.n, q), cross(self.p, q));
        let [dn, dp, dq] = [n[3], p[3], q.coefficients()[3]];
        let coordinate = |k: usize| dn * p_q[k] - dp * n_q[k] + dq * self.n_p[k];
        let value = [coordinate(0), coordinate(1), coordinate(2), p_q[0] * n[0] + p_q[1] * n[1] + p_q[2] * n[2]];
        let magnitude_q = q.magnitude();
        let [twice_offset, twice_magnitude] = self.twice;
        let reach_q = twice_magnitude * dq.abs();
        let magnitudes = self.magnitude_p * magnitude_q;
        let reach = twice_offset * magnitudes + (self.reach_p * magnitude_q + reach_q * self.magnitude_p);
        let weight = 3.0 * twice_magnitude * magnitudes;
        (self.p, self.n_p, self.magnitude_p, self.reach_p) = (q, n_q, magnitude_q, reach_q);
        Corner::keep(value, [reach, weight], 0)
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
    /// A plane with its offset in one column; nothing is certain of an infinity plane in the finite column, where the other one
    /// decides first.
    #[inline(always)]
    pub(crate) fn new(plane: &Row, column: OffsetColumn) -> Self {
        let [x, y, z, _] = *plane.coefficients();
        let offset = column.of(plane);
        let mut bounds = [DET4_BOUND * (x.abs() + y.abs() + z.abs()), DET4_BOUND * offset.abs()];
        if column == OffsetColumn::Finite && plane.is_at_infinity() {
            bounds = [f64::INFINITY; 2];
        }
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
