//! On which side of a plane a vertex lies, ties broken by the perturbation: inside or outside, never on.

use super::IncrementalPolytope;
use super::infinity::is_infinity;
use super::store::PlaneStore;
use crate::sign::{Corner, Homogeneous, OffsetColumn, Probe, Row, Sign, orient3};

impl IncrementalPolytope {
    pub(super) fn row(&self, plane: u32) -> &Row {
        self.planes.row(plane)
    }

    fn rows(&self, planes: [u32; 3]) -> [&Row; 3] {
        planes.map(|plane| self.row(plane))
    }

    /// The cached position of a vertex: its part in `M` where an infinity plane takes part, else its constant part.
    #[inline(always)]
    pub(super) fn meeting_point(&self, planes: [u32; 3]) -> Corner {
        let [a, b, c] = self.rows(planes);
        let column = leading_column(planes);
        Corner::new(&Homogeneous::quick(a, b, c, column), column)
    }

    /// Whether vertex `vertex` violates plane `plane`.
    #[inline]
    pub(super) fn is_outside(&self, vertex: u32, plane: u32) -> bool {
        self.violates(vertex, plane, &Probe::new(self.row(plane), OffsetColumn::Finite))
    }

    /// The same where the probe of the plane is at hand.
    #[inline(always)]
    pub(super) fn violates(&self, vertex: u32, plane: u32, probe: &Probe) -> bool {
        let (planes, point) = self.vertices.planes_and_point(vertex);
        self.planes.is_outside(probe, plane, planes, point)
    }

    /// Whether the meeting point of three planes, counter-clockwise seen from outside, violates `plane`.
    #[inline]
    pub(super) fn is_point_outside(&self, planes: [u32; 3], point: &Corner, plane: u32) -> bool {
        let probe = Probe::new(self.row(plane), OffsetColumn::Finite);
        self.planes.is_outside(&probe, plane, &planes, point)
    }

    /// Whether four planes meet in one point exactly (or in one ideal point along one line).
    pub(super) fn is_exactly_on(&self, planes: [u32; 3], plane: u32) -> bool {
        let [a, b, c] = self.rows(planes);
        [OffsetColumn::Infinite, OffsetColumn::Finite].into_iter().all(|column| {
            let all_finite = !planes.iter().chain([&plane]).any(|p| is_infinity(*p));
            (column == OffsetColumn::Infinite && all_finite)
                || Homogeneous::of(a, b, c, column).side([a, b, c], self.row(plane), column) == Sign::Zero
        })
    }
}

impl PlaneStore {
    /// Whether the meeting point of `planes` violates `plane`; `probe` is made from its row for the finite column, where it tells nothing of
    /// an infinity plane.
    #[inline(always)]
    pub(super) fn is_outside(&self, probe: &Probe, plane: u32, planes: &[u32; 3], point: &Corner) -> bool {
        if !point.is_ideal() {
            match probe.certain_side(point) {
                Sign::Positive => return true,
                Sign::Negative => return false,
                Sign::Zero => {}
            }
        }
        self.decide_outside(planes, point, plane)
    }

    /// The same where an infinity plane takes part or the quick filter could not tell.
    #[cold]
    #[inline(never)]
    fn decide_outside(&self, planes: &[u32; 3], point: &Corner, plane: u32) -> bool {
        let planes = *planes;
        let column = leading_column(planes);
        if column == OffsetColumn::Finite && is_infinity(plane) {
            return false;
        }
        if column == OffsetColumn::Infinite {
            match Probe::new(self.row(plane), column).certain_side(point) {
                Sign::Positive => return true,
                Sign::Negative => return false,
                Sign::Zero => {}
            }
        }
        let rows @ [a, b, c] = planes.map(|plane| self.row(plane));
        match Homogeneous::of(a, b, c, column).side(rows, self.row(plane), column) {
            Sign::Positive => true,
            Sign::Negative => false,
            Sign::Zero => self.breaks_tie_outside(planes, plane),
        }
    }

    /// The constant part where that in `M` is zero, then the part in the `ε` of the oldest plane that has one.
    ///
    /// Moving plane `a` inward by `ε` changes `n_h·P − d_h·W` by `−ε·det(n_h, n_b, n_c)`, moving `h` inward changes it by
    /// `+ε·W`, and `W > 0`.
    fn breaks_tie_outside(&self, planes: [u32; 3], plane: u32) -> bool {
        let rows = planes.map(|plane| self.row(plane));
        let h = self.row(plane);
        if leading_column(planes) == OffsetColumn::Infinite {
            let point = Homogeneous::of(rows[0], rows[1], rows[2], OffsetColumn::Finite);
            match point.side(rows, h, OffsetColumn::Finite) {
                Sign::Positive => return true,
                Sign::Negative => return false,
                Sign::Zero => {}
            }
        }
        let stamp = |plane: u32| self.stamp(plane);
        let [a, b, c] = rows;
        let mut order = [(stamp(planes[0]), 0), (stamp(planes[1]), 1), (stamp(planes[2]), 2)];
        order.sort_unstable();
        for (age, k) in order {
            if age > stamp(plane) {
                break;
            }
            let cofactor = match k {
                0 => orient3(h, b, c),
                1 => orient3(a, h, c),
                _ => orient3(a, b, h),
            };
            match cofactor {
                Sign::Positive => return false,
                Sign::Negative => return true,
                Sign::Zero => {}
            }
        }
        true
    }
}

/// The column of the offsets that decides first for a meeting point.
fn leading_column(planes: [u32; 3]) -> OffsetColumn {
    if planes.into_iter().any(is_infinity) { OffsetColumn::Infinite } else { OffsetColumn::Finite }
}
