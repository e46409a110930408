//! The floating-point tier: a value, the sum of the magnitudes of its terms (its *permanent*), and a bound.
//!
//! With `u = 2⁻⁵³`, a term that goes through `k` rounded operations is off by at most `γ_k = k·u / (1 − k·u)` of its
//! magnitude, so a sum of such terms is off by at most `γ_k` of the permanent. The permanent is itself computed by
//! `k` roundings of positive numbers, which can lose another factor `(1 − u)^k`; the constants below leave room for
//! that. Underflow cannot matter: the accepted coefficient range (see [`HalfSpace`](crate::HalfSpace)) keeps every
//! non-zero product of a permanent above `2⁻⁹⁰⁰`, while an underflowed product is off by at most `2⁻¹⁰⁷⁵`.

use super::{Row, Sign, counts};
use super::{big, small_int};

const U: f64 = f64::EPSILON / 2.0;

/// 2×2 determinants: 2 roundings a term.
pub(super) const DET2_BOUND: f64 = 4.0 * U;
/// 3×3 determinants by minors: product, difference, product, two sums: 5 roundings a term.
pub(super) const DET3_BOUND: f64 = 8.0 * U;
/// 4×4 determinants through the homogeneous vertex: minor (2), times an offset (1), two sums, times the plane's
/// coefficient (1), three sums: 9 roundings a term.
pub(super) const DET4_BOUND: f64 = 12.0 * U;
/// `radial`: dot products (3), their product (1), a difference (1): each factor 3, so 8 roundings a term.
pub(super) const RADIAL_BOUND: f64 = 12.0 * U;

/// Below this permanent every intermediate of an integer expression is an integer below 2⁵³: the value is exact.
pub(super) const EXACT_PERMANENT: f64 = (1u64 << 52) as f64;

/// The index after 0, 1, 2 in cyclic order.
const NEXT: [usize; 3] = [1, 2, 0];
/// The index before.
const BEFORE: [usize; 3] = [2, 0, 1];

/// Which coefficient of the offsets `d + m·M` is meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum OffsetColumn {
    /// The constant `d`; zero for infinity planes.
    Finite,
    /// The factor of `M → ∞`; one for infinity planes, zero for all others.
    Infinite,
}

impl OffsetColumn {
    /// The offset of `row` in this column.
    pub(crate) fn of(self, row: &Row) -> f64 {
        match self {
            Self::Finite => row.coefficients()[3],
            Self::Infinite => f64::from(u8::from(row.is_at_infinity())),
        }
    }
}

/// The sign of `det(nₐ, n_b, n_c)` where a bound from the magnitudes of the rows decides it, else zero.
#[inline]
pub(super) fn certain_det3(a: &Row, b: &Row, c: &Row) -> Sign {
    // six products of three
    let bound = (6.0 * DET3_BOUND) * a.magnitude() * b.magnitude() * c.magnitude();
    let (a, b, c) = (a.coefficients(), b.coefficients(), c.coefficients());
    let value =
        a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
    if value.abs() > bound { Sign::of(value) } else { Sign::Zero }
}

/// Which edge at the vertex of three planes leads on in direction `n`: the one off plane `k` does where the determinant of
/// `n` and the normals of the other two is negative. The most negative one is taken, all three at once: a branch for each
/// would be mispredicted. Where the filter leaves a sign open on which this depends, an error.
#[inline]
pub(crate) fn certain_climb(n: &Row, rows: [&Row; 3]) -> Result<Option<usize>, ()> {
    let [a, b, c] = rows.map(Row::magnitude);
    let scale = (6.0 * DET3_BOUND) * n.magnitude();
    let bounds = [scale * (b * c), scale * (c * a), scale * (a * b)];
    let [a, b, c] = rows.map(Row::coefficients);
    let n = n.coefficients();
    let cross = |p: &[f64; 4]| [n[1] * p[2] - n[2] * p[1], n[2] * p[0] - n[0] * p[2], n[0] * p[1] - n[1] * p[0]];
    let dot = |p: [f64; 3], q: &[f64; 4]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    let (na, nb) = (cross(a), cross(b));
    let values = [dot(nb, c), -dot(na, c), dot(na, b)];
    let mut best = 0;
    for k in 1..3 {
        best = if values[k] < values[best] { k } else { best };
    }
    if values[best] < -bounds[best] {
        return Ok(Some(best));
    }
    let settled = values[0] > bounds[0] && values[1] > bounds[1] && values[2] > bounds[2];
    if settled { Ok(None) } else { Err(()) }
}

/// Value and permanent of `det(nₐ, n_b, n_c)`.
#[inline]
pub(super) fn det3(a: &Row, b: &Row, c: &Row) -> (f64, f64) {
    let (a, b, c) = (a.coefficients(), b.coefficients(), c.coefficients());
    let minor = |u: usize, v: usize| {
        let (p, q) = (b[u] * c[v], b[v] * c[u]);
        (p - q, p.abs() + q.abs())
    };
    let ((x, px), (y, py), (z, pz)) = (minor(1, 2), minor(2, 0), minor(0, 1));
    (a[0] * x + a[1] * y + a[2] * z, a[0].abs() * px + a[1].abs() * py + a[2].abs() * pz)
}

/// The meeting point of three planes in homogeneous coordinates `(X, Y, Z, W)`, with the permanents of each.
///
/// `W = det(nₐ, n_b, n_c)` and `(X, Y, Z) = dₐ·n_b×n_c + d_b·n_c×nₐ + d_c·nₐ×n_b`: asking on which side of a plane it
/// lies then takes no division.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Homogeneous {
    /// `(X, Y, Z, W)`, rounded.
    pub value: [f64; 4],
    /// The sums of the magnitudes of the terms of each.
    pub permanent: [f64; 4],
}

impl Homogeneous {
    /// The meeting point of three planes.
    #[must_use]
    pub fn meet(a: &Row, b: &Row, c: &Row) -> Self {
        Self::of(a, b, c, OffsetColumn::Finite)
    }

    /// On which side of `h` the point lies, times the sign of `W`: for right-handed `rows`, positive is outside, zero on
    /// the plane. `rows` are the planes that the point was made from, in the same order.
    #[inline]
    #[must_use]
    pub fn side_of(&self, rows: [&Row; 3], h: &Row) -> Sign {
        self.side(rows, h, OffsetColumn::Finite)
    }

    /// The meeting point for the offsets of one column.
    #[inline]
    pub(crate) fn of(a: &Row, b: &Row, c: &Row, column: OffsetColumn) -> Self {
        let offsets = [column.of(a), column.of(b), column.of(c)];
        let (a, b, c) = (a.coefficients(), b.coefficients(), c.coefficients());
        let mut value = [0.0; 4];
        let mut permanent = [0.0; 4];
        let magnitude = offsets.map(f64::abs);
        for axis in 0..3 {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let (bc0, bc1) = (b[u] * c[v], b[v] * c[u]);
            let (ca0, ca1) = (c[u] * a[v], c[v] * a[u]);
            let (ab0, ab1) = (a[u] * b[v], a[v] * b[u]);
            let bc = bc0 - bc1;
            let pbc = bc0.abs() + bc1.abs();
            value[axis] = offsets[0] * bc + offsets[1] * (ca0 - ca1) + offsets[2] * (ab0 - ab1);
            permanent[axis] =
                magnitude[0] * pbc + magnitude[1] * (ca0.abs() + ca1.abs()) + magnitude[2] * (ab0.abs() + ab1.abs());
            value[3] += a[axis] * bc;
            permanent[3] += a[axis].abs() * pbc;
        }
        Self { value, permanent }
    }

    /// The meeting point for the offsets of one column, with permanents from the magnitudes of the rows: they are a few
    /// times too large, equal for the three coordinates, and cost little.
    #[inline(always)]
    pub(crate) fn quick(a: &Row, b: &Row, c: &Row, column: OffsetColumn) -> Self {
        let [da, db, dc] = [column.of(a), column.of(b), column.of(c)];
        let [ma, mb, mc] = [a.magnitude(), b.magnitude(), c.magnitude()];
        let (a, b, c) = (a.coefficients(), b.coefficients(), c.coefficients());
        let mut value = [0.0; 4];
        for axis in 0..3 {
            let (u, v) = (NEXT[axis], BEFORE[axis]);
            let bc = b[u] * c[v] - b[v] * c[u];
            let ca = c[u] * a[v] - c[v] * a[u];
            let ab = a[u] * b[v] - a[v] * b[u];
            value[axis] = da * bc + db * ca + dc * ab;
            value[3] += a[axis] * bc;
        }
        // each minor has two products
        let reach = 2.0 * (da.abs() * (mb * mc) + db.abs() * (mc * ma) + dc.abs() * (ma * mb));
        Self { value, permanent: [reach, reach, reach, 6.0 * (ma * mb * mc)] }
    }

    /// The side of `h` that a point made by [`quick`](Self::quick) is certainly on, for the same column; else zero.
    #[inline]
    pub(crate) fn certain_side(&self, h: &Row, column: OffsetColumn) -> Sign {
        let [nx, ny, nz, _] = *h.coefficients();
        let d = column.of(h);
        let [x, y, z, w] = self.value;
        let value = nx * x + ny * y + nz * z - d * w;
        let permanent = (nx.abs() + ny.abs() + nz.abs()) * self.permanent[0] + d.abs() * self.permanent[3];
        if value.abs() > DET4_BOUND * permanent {
            counts::note_total();
            return Sign::of(value);
        }
        Sign::Zero
    }

    /// The sign of `n_h·(X, Y, Z) − d_h·W`; `rows` are the planes that this was made from, in the same order.
    #[inline]
    pub(crate) fn side(&self, rows: [&Row; 3], h: &Row, column: OffsetColumn) -> Sign {
        let n = h.coefficients();
        let d = column.of(h);
        let (x, p) = (&self.value, &self.permanent);
        let value = n[0] * x[0] + n[1] * x[1] + n[2] * x[2] - d * x[3];
        let permanent = n[0].abs() * p[0] + n[1].abs() * p[1] + n[2].abs() * p[2] + d.abs() * p[3];
        counts::note_total();
        if value.abs() > DET4_BOUND * permanent {
            return Sign::of(value);
        }
        if permanent == 0.0 {
            return Sign::Zero;
        }
        side_exact(rows, h, column, value, permanent)
    }
}

/// The tiers behind the filter.
#[cold]
#[inline(never)]
fn side_exact([a, b, c]: [&Row; 3], h: &Row, column: OffsetColumn, value: f64, permanent: f64) -> Sign {
    if let Some(sign) = small_int::side4([a, b, c], h, column, value, permanent) {
        counts::note_small_int();
        return sign;
    }
    counts::note_big();
    big::det4([a, b, c, h], column).flip()
}
