//! The small-integer tier: exact where the rows are integers and the result fits `i128`.
//!
//! Each function gives `None` where the rows are not integers or too long.

use super::filter::{EXACT_PERMANENT, OffsetColumn};
use super::{Row, Sign};

/// Bits of `i128` without its sign.
const CAPACITY: u32 = 127;

/// The sign of `det(nₐ, n_b, n_c)`; `value` and `permanent` are what the filter found.
pub(super) fn det3(a: &Row, b: &Row, c: &Row, value: f64, permanent: f64) -> Option<Sign> {
    if !(a.is_integer() && b.is_integer() && c.is_integer()) {
        return None;
    }
    if permanent < EXACT_PERMANENT {
        return Some(Sign::of(value));
    }
    // six products of three
    if a.bits()[0] + b.bits()[0] + c.bits()[0] + 3 > CAPACITY {
        return None;
    }
    Some(Sign::of(det3_of(&a.integers(), &b.integers(), &c.integers())))
}

fn det3_of(a: &[i128; 4], b: &[i128; 4], c: &[i128; 4]) -> i128 {
    let [x, y, z] = cross(b, c);
    a[0] * x + a[1] * y + a[2] * z
}

fn cross(b: &[i128; 4], c: &[i128; 4]) -> [i128; 3] {
    [b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]]
}

/// The sign of `n_h·(X, Y, Z) − d_h·W` for the meeting point of three rows.
pub(super) fn side4(rows: [&Row; 3], h: &Row, column: OffsetColumn, value: f64, permanent: f64) -> Option<Sign> {
    let all = [rows[0], rows[1], rows[2], h];
    if !all.iter().all(|row| row.is_integer()) {
        return None;
    }
    if permanent < EXACT_PERMANENT {
        return Some(Sign::of(value));
    }
    // Each of the 24 products takes the offset of one row and normal components of the three others.
    let normals: u32 = all.iter().map(|row| row.bits()[0]).sum();
    let longest = all.iter().map(|row| normals - row.bits()[0] + row.bits()[1].max(1)).max()?;
    if longest + 5 > CAPACITY {
        return None;
    }
    let offset = |row: &Row| column.of(row) as i128;
    let [a, b, c, n] = all.map(Row::integers);
    let (bc, ca, ab) = (cross(&b, &c), cross(&c, &a), cross(&a, &b));
    let (da, db, dc) = (offset(all[0]), offset(all[1]), offset(all[2]));
    let w = a[0] * bc[0] + a[1] * bc[1] + a[2] * bc[2];
    let side: i128 = (0..3).map(|k| n[k] * (da * bc[k] + db * ca[k] + dc * ab[k])).sum::<i128>() - offset(h) * w;
    Some(Sign::of(side))
}

/// The sign of the 2×2 determinant of the columns `u`, `v` of two normals.
pub(super) fn det2(i: &Row, j: &Row, [u, v]: [usize; 2]) -> Option<Sign> {
    // 53 bits each always fit
    (i.is_integer() && j.is_integer()).then(|| {
        let (p, q) = (i.integers(), j.integers());
        Sign::of(p[u] * q[v] - p[v] * q[u])
    })
}
