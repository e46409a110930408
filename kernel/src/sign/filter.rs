//! The floating-point tier: a value, the sum of the magnitudes of its terms (its *permanent*), and a bound.
//!
//! With `u = 2⁻⁵³`, a term that goes through `k` rounded operations is off by at most `γ_k = k·u / (1 − k·u)` of its
//! magnitude, so a sum of such terms is off by at most `γ_k` of the permanent. The permanent is itself computed by
//! `k` roundings of positive numbers, which can lose another factor `(1 − u)^k`; the constants below leave room for
//! that. Underflow cannot matter: the accepted coefficient range (see [`HalfSpace`](crate::HalfSpace)) keeps every
//! non-zero product of a permanent above `2⁻⁹⁰⁰`, while an underflowed product is off by at most `2⁻¹⁰⁷⁵`.

use super::{Row, Sign, big, counts, extended, near_zero, small_int};

const U: f64 = f64::EPSILON / 2.0;

/// 3×3 determinants by minors: product, difference, product, two sums: 5 roundings a term.
pub(super) const DET3_BOUND: f64 = 8.0 * U;
/// 4×4 determinants through the homogeneous vertex: minor (2), times an offset (1), two sums, times the plane's
/// coefficient (1), three sums: 9 roundings a term.
pub(super) const DET4_BOUND: f64 = 12.0 * U;

/// Below this permanent every intermediate of an integer expression is an integer below 2⁵³: the value is exact.
pub(super) const EXACT_PERMANENT: f64 = (1u64 << 52) as f64;

/// The index after 0, 1, 2 in cyclic order.
pub(crate) const NEXT: [usize; 3] = [1, 2, 0];
/// The index before.
pub(crate) const BEFORE: [usize; 3] = [2, 0, 1];

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

/// Where to go on from a vertex.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Slope {
    /// Along the edge off the plane of this index, counted from the plane that the vertex was reached with.
    Up(usize),
    /// Nowhere: no edge is better.
    Top,
    /// The filter leaves a sign open on which this depends.
    Open,
}

impl Slope {
    /// Where the edge of index `k` has the lowest value.
    #[inline(always)]
    fn of(lowest: f64, bound: f64, k: usize) -> Self {
        if lowest < -bound {
            Self::Up(k)
        } else if lowest > bound {
            Self::Top
        } else {
            Self::Open
        }
    }
}

/// A climb in direction `n` along the edges of a simple polytope, as far as bounds from the magnitudes of the rows decide.
///
/// The edge off plane `a` of a vertex `(a, b, c)` leads on where `det(n, b, c)` is negative. Across an edge one plane
/// is new, `r`, and two are known: with their products `n×p` and `n×q` at hand, two dot products with `r` tell
/// both edges that lead away. The most negative one is taken without a branch, which would be mispredicted.
pub(crate) struct Ascent {
    /// `n×p` and `n×q` for the planes `(r, p, q)` of the vertex, counter-clockwise.
    crosses: [[f64; 3]; 2],
    magnitudes: [f64; 2],
    /// The bound for rows of magnitude one.
    scale: f64,
}

impl Ascent {
    /// At a vertex of three planes.
    #[inline]
    pub(crate) fn begin(n: &Row, [r, p, q]: [&Row; 3]) -> (Self, Slope) {
        let scale = (6.0 * DET3_BOUND) * n.magnitude();
        let (n_p, n_q) = (cross(n, p), cross(n, q));
        let (mp, mq) = (p.magnitude(), q.magnitude());
        let off_r = dot(&n_p, q);
        let bound = scale * mp * mq;
        if off_r < -bound {
            // from the other end of this edge, the two planes are seen in the other order
            return (Self { crosses: [n_q, n_p], magnitudes: [mq, mp], scale }, Slope::Up(0));
        }
        let mut ascent = Self { crosses: [n_p, n_q], magnitudes: [mp, mq], scale };
        let slope = ascent.step(n, r);
        if slope == Slope::Top && off_r <= bound { (ascent, Slope::Open) } else { (ascent, slope) }
    }

    /// Whether no edge of a vertex leads on for certain, so that every other vertex lies lower.
    #[inline(always)]
    pub(crate) fn is_top(n: &Row, [r, p, q]: [&Row; 3]) -> bool {
        let (n_p, n_q) = (cross(n, p), cross(n, q));
        let (off_r, off_p, off_q) = (dot(&n_p, q), dot(&n_q, r), -dot(&n_p, r));
        let [mr, mp, mq] = [r.magnitude(), p.magnitude(), q.magnitude()];
        let scale = (6.0 * DET3_BOUND) * n.magnitude();
        let bound = scale * larger(mr * larger(mp, mq), mp * mq);
        let lower = if off_p < off_q { off_p } else { off_q };
        (if off_r < lower { off_r } else { lower }) > bound
    }

    /// Across the edge, where plane `r` is new.
    #[inline]
    pub(crate) fn step(&mut self, n: &Row, r: &Row) -> Slope {
        let [p, q] = &self.crosses;
        let (off_p, off_q) = (dot(q, r), -dot(p, r));
        let magnitude = r.magnitude();
        let scale = self.scale * magnitude;
        let bound = scale * larger(self.magnitudes[0], self.magnitudes[1]);
        let takes_q = usize::from(off_q < off_p);
        let lowest = if off_q < off_p { off_q } else { off_p };
        // the plane left gives its place to `r`; from the other end the order is that of `crosses` again
        self.crosses[takes_q] = cross(n, r);
        self.magnitudes[takes_q] = magnitude;
        Slope::of(lowest, bound, 1 + takes_q)
    }
}

#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The cross product of two normals, rounded.
#[inline(always)]
pub(crate) fn cross(n: &Row, p: &Row) -> [f64; 3] {
    let (n, p) = (n.coefficients(), p.coefficients());
    [n[1] * p[2] - n[2] * p[1], n[2] * p[0] - n[0] * p[2], n[0] * p[1] - n[1] * p[0]]
}

#[inline(always)]
fn dot(p: &[f64; 3], row: &Row) -> f64 {
    let q = row.coefficients();
    p[0] * q[0] + p[1] * q[1] + p[2] * q[2]
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
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Homogeneous {
    /// `(X, Y, Z, W)`, rounded.
    pub value: [f64; 4],
    /// The sums of the magnitudes of the terms of each.
    pub permanent: [f64; 4],
}

impl Homogeneous {
    /// The meeting point of three planes.
    #[inline]
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

    /// The sign of `n_h·(X, Y, Z) − d_h·W`; `rows` are the planes that this was made from, in the same order.
    #[inline]
    pub(crate) fn side(&self, rows: [&Row; 3], h: &Row, column: OffsetColumn) -> Sign {
        let n = h.coefficients();
        let x = &self.value;
        let value = n[0] * x[0] + n[1] * x[1] + n[2] * x[2] - column.of(h) * x[3];
        let permanent = self.permanent_of_side(h, column);
        counts::note_total();
        if value.abs() > DET4_BOUND * permanent {
            return Sign::of(value);
        }
        if permanent == 0.0 {
            return Sign::Zero;
        }
        side_exact(rows, h, column, value, permanent)
    }

    /// The permanent of `n_h·(X, Y, Z) − d_h·W`.
    #[inline(always)]
    fn permanent_of_side(&self, h: &Row, column: OffsetColumn) -> f64 {
        let (n, p) = (h.coefficients(), &self.permanent);
        n[0].abs() * p[0] + n[1].abs() * p[1] + n[2].abs() * p[2] + column.of(h).abs() * p[3]
    }
}

/// On which side of `h` the meeting point of three planes lies, as [`Homogeneous::side_of`] has it: for where plain numbers have already left
/// it open.
///
/// Of planes that are no short integers double-doubles are asked at once, with a permanent that is a few times too large.
#[must_use]
pub fn side_left_open(rows: [&Row; 3], h: &Row) -> Sign {
    let [a, b, c] = rows;
    if [a, b, c, h].iter().all(|row| row.is_integer()) {
        return Homogeneous::meet(a, b, c).side_of(rows, h);
    }
    let offsets = [a, b, c, h].map(|row| row.coefficients()[3].abs());
    let [ma, mb, mc, mh] = [a, b, c, h].map(Row::magnitude);
    // a determinant of three normals has six terms
    let permanent = 6.0
        * (offsets[0] * (mb * mc * mh)
            + offsets[1] * (ma * mc * mh)
            + offsets[2] * (ma * mb * mh)
            + offsets[3] * (ma * mb * mc));
    counts::note_total();
    if permanent == 0.0 {
        return Sign::Zero;
    }
    side_of_long_numbers(rows, h, permanent)
}

/// By double-doubles, or else by integers; `permanent` is that of the whole determinant or larger.
fn side_of_long_numbers([a, b, c]: [&Row; 3], h: &Row, permanent: f64) -> Sign {
    let bound = match extended::side([a, b, c], h, permanent) {
        extended::Found::Sign(sign) => return sign,
        extended::Found::Below(bound) => Some(bound),
        extended::Found::Nothing => None,
    };
    counts::note_big();
    let known_small = bound.and_then(|bound| near_zero::side([a, b, c], h, bound));
    known_small.unwrap_or_else(|| big::det4([a, b, c, h], OffsetColumn::Finite).flip())
}

/// The tiers behind the filter.
#[cold]
#[inline(never)]
fn side_exact([a, b, c]: [&Row; 3], h: &Row, column: OffsetColumn, value: f64, permanent: f64) -> Sign {
    if let Some(sign) = small_int::side4([a, b, c], h, column, value, permanent) {
        counts::note_small_int();
        return sign;
    }
    if column == OffsetColumn::Infinite && [a, b, c].into_iter().any(|row| is_parallel_and_finite(row, h)) {
        return Sign::Zero;
    }
    if column == OffsetColumn::Finite {
        return side_of_long_numbers([a, b, c], h, permanent);
    }
    counts::note_big();
    big::det4([a, b, c, h], column).flip()
}

/// Whether two rows are seen to be equal or opposite in the infinite column: opposite sides of a slab are.
fn is_parallel_and_finite(a: &Row, b: &Row) -> bool {
    let ([ax, ay, az, _], [bx, by, bz, _]) = (a.coefficients(), b.coefficients());
    let is_equal = (ax, ay, az) == (bx, by, bz);
    let is_opposite = (-ax, -ay, -az) == (*bx, *by, *bz);
    (is_equal || is_opposite) && !a.is_at_infinity() && !b.is_at_infinity()
}
