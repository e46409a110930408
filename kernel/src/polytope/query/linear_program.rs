//! The linear program of a largest inscribed ball: `max r` under `uᵢ·c + r ≤ bᵢ` with unit normals `uᵢ`.
//!
//! The dual simplex method on its four unknowns in exact integers: the data are rounded once when they enter (unit
//! normals are not rational), and no step is. Four artificial planes with offset `M → ∞`, compared before the constant part,
//! give the first basis; where one of them is left in the last, the radius or the centre has a part in `M`.

use std::array::from_fn;

use crate::arithmetic::{big_integers, round_quotient};
use dashu_int::IBig;
use glam::DVec3;

/// Normals are rounded to integers of this many bits.
const SCALE: f64 = (1u64 << 60) as f64;
/// Of two parts that differ by less, relative to their size, exact numbers decide.
const NEGLIGIBLE: f64 = 1e-12;
/// After this many steps the first violated plane is taken in instead of the worst, which cannot cycle (Bland 1977).
const PATIENCE: usize = 300;

/// `u·c + r ≤ b`, where `b` is `offset`, or `M` for an artificial plane.
#[derive(Debug, Clone)]
pub(super) struct Constraint {
    normal: DVec3,
    offset: f64,
    is_artificial: bool,
    row: [IBig; 4],
}

impl Constraint {
    /// A plane with a unit normal.
    pub(super) fn new(normal: DVec3, offset: f64) -> Self {
        Self { normal, offset, is_artificial: false, row: integer_normal(normal) }
    }

    /// How far the plane lies from the origin.
    pub(super) fn distance(&self) -> f64 {
        self.offset.abs()
    }

    fn artificial(normal: DVec3) -> Self {
        Self { is_artificial: true, ..Self::new(normal, 0.0) }
    }
}

fn integer_normal(normal: DVec3) -> [IBig; 4] {
    let [x, y, z] = normal.to_array().map(|v| IBig::from((v * SCALE).round() as i64));
    [x, y, z, IBig::from(1u64 << 60)]
}

/// The optimum `(c, r)` in two parts: constant, and the factor of `M`.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Optimum {
    /// Centre and radius, constant parts.
    pub(super) finite: [f64; 4],
    /// Centre and radius, the factors of `M`.
    pub(super) infinite: [f64; 4],
}

/// The four planes of a basis with the adjugate of their rows.
struct Basis {
    members: [usize; 4],
    adjugate: [[IBig; 4]; 4],
    /// The determinant, made positive together with the adjugate.
    determinant: IBig,
}

impl Basis {
    fn new(constraints: &[Constraint], members: [usize; 4]) -> Self {
        let rows = members.map(|member| &constraints[member].row);
        let cofactor = |i: usize, j: usize| {
            let others: [usize; 3] = from_fn(|k| if k < i { k } else { k + 1 });
            let columns: [usize; 3] = from_fn(|k| if k < j { k } else { k + 1 });
            let at = |r: usize, c: usize| &rows[others[r]][columns[c]];
            let minor = |c: usize, d: usize| at(1, c) * at(2, d) - at(1, d) * at(2, c);
            let value = at(0, 0) * minor(1, 2) - at(0, 1) * minor(0, 2) + at(0, 2) * minor(0, 1);
            if (i + j).is_multiple_of(2) { value } else { -value }
        };
        let mut adjugate: [[IBig; 4]; 4] = from_fn(|j| from_fn(|i| cofactor(i, j)));
        let mut determinant = (0..4).fold(IBig::ZERO, |sum, k| sum + &rows[0][k] * &adjugate[k][0]);
        if determinant < IBig::ZERO {
            determinant = -determinant;
            adjugate = adjugate.map(|row| row.map(|v| -v));
        }
        Self { members, adjugate, determinant }
    }

    /// The solution for offsets, times the determinant.
    fn solve(&self, offsets: &[IBig; 4]) -> [IBig; 4] {
        from_fn(|k| (0..4).fold(IBig::ZERO, |sum, i| sum + &self.adjugate[k][i] * &offsets[i]))
    }

    /// Exchanges the member that the ratio test names for a violated constraint; `None` where there is none to name.
    fn exchange(&self, constraints: &[Constraint], entering: usize) -> Option<Self> {
        let row = &constraints[entering].row;
        let mut leaving: Option<(usize, IBig, &IBig)> = None;
        for i in 0..4 {
            let share = (0..4).fold(IBig::ZERO, |sum, k| sum + &row[k] * &self.adjugate[k][i]);
            if share <= IBig::ZERO {
                continue;
            }
            let multiplier = &self.adjugate[3][i];
            let better = leaving.as_ref().is_none_or(|(at, least_share, least)| {
                let (new, old) = (multiplier * least_share, *least * &share);
                new < old || (new == old && self.members[i] < self.members[*at])
            });
            if better {
                leaving = Some((i, share, multiplier));
            }
        }
        let (at, ..) = leaving?;
        let mut members = self.members;
        members[at] = entering;
        Some(Self::new(constraints, members))
    }
}

/// The program over given constraints.
pub(super) struct Program {
    constraints: Vec<Constraint>,
    /// The offsets as integer multiples of `grain`.
    offsets: Vec<IBig>,
    grain: f64,
}

impl Program {
    /// The program of some planes.
    pub(super) fn new(mut constraints: Vec<Constraint>) -> Self {
        let corners = [DVec3::new(1.0, 1.0, 1.0), DVec3::new(1.0, -1.0, -1.0), DVec3::new(-1.0, 1.0, -1.0)];
        for normal in corners.into_iter().chain([DVec3::new(-1.0, -1.0, 1.0)]) {
            constraints.push(Constraint::artificial(normal.normalize()));
        }
        let finest = constraints.iter().map(|c| c.offset.abs()).filter(|v| *v > 0.0).fold(f64::INFINITY, f64::min);
        let grain = if finest.is_finite() { finest * f64::EPSILON } else { 1.0 };
        // the power of two at or below it, of which every offset is a multiple
        let grain = f64::from_bits(grain.to_bits() & !((1u64 << 52) - 1));
        let integer = |offset: f64| {
            let [value, one] = big_integers([offset / grain, 1.0]);
            value / one
        };
        let offsets = constraints.iter().map(|c| integer(c.offset)).collect();
        Self { constraints, offsets, grain }
    }

    /// The optimum, in as many steps as it takes.
    pub(super) fn optimum(&self) -> Option<Optimum> {
        let count = self.constraints.len();
        let mut basis = Basis::new(&self.constraints, from_fn(|k| count - 4 + k));
        for step in 0.. {
            let finite = basis.solve(&from_fn(|i| self.offsets[basis.members[i]].clone()));
            let infinite =
                basis.solve(&from_fn(|i| IBig::from(u8::from(self.constraints[basis.members[i]].is_artificial))));
            // x = adj·b / det, and rows are counted in units of 1 / SCALE
            let scale = IBig::from(1u64 << 60);
            let optimum = Optimum {
                finite: from_fn(|k| round_quotient(&finite[k] * &scale, &basis.determinant) * self.grain),
                infinite: from_fn(|k| round_quotient(&infinite[k] * &scale, &basis.determinant)),
            };
            let violates = |i: usize| self.violates(i, &basis, &finite, &infinite);
            let entering = if step < PATIENCE {
                self.worst(&basis, &optimum, violates)
            } else {
                (0..count).find(|i| !basis.members.contains(i) && violates(*i))
            };
            let Some(entering) = entering else { return Some(optimum) };
            basis = basis.exchange(&self.constraints, entering)?;
        }
        None
    }

    /// Whether a constraint is violated, exactly: first the part in `M`.
    fn violates(&self, i: usize, basis: &Basis, finite: &[IBig; 4], infinite: &[IBig; 4]) -> bool {
        let row = &self.constraints[i].row;
        let value = |x: &[IBig; 4]| (0..4).fold(IBig::ZERO, |sum, k| sum + &row[k] * &x[k]);
        let artificial = IBig::from(u8::from(self.constraints[i].is_artificial));
        let part = value(infinite) - artificial * &basis.determinant;
        if part.is_zero() { value(finite) > &self.offsets[i] * &basis.determinant } else { part > IBig::ZERO }
    }

    /// The constraint that is violated most, up to rounding; what is violated by a negligible part only may be passed over.
    fn worst(&self, basis: &Basis, at: &Optimum, violates: impl Fn(usize) -> bool) -> Option<usize> {
        let (mut infinite, mut finite) = (Vec::new(), Vec::new());
        for (i, constraint) in self.constraints.iter().enumerate().filter(|(i, _)| !basis.members.contains(i)) {
            let (part, size) = excess(constraint.normal, &at.infinite, f64::from(u8::from(constraint.is_artificial)));
            if part > NEGLIGIBLE * size {
                infinite.push((part, i));
            } else if part >= -NEGLIGIBLE * size {
                let (part, size) = excess(constraint.normal, &at.finite, constraint.offset);
                if part > NEGLIGIBLE * 1e-3 * size {
                    finite.push((part, i));
                }
            }
        }
        for mut list in [infinite, finite] {
            list.sort_unstable_by(|a, b| b.0.total_cmp(&a.0));
            if let Some((_, i)) = list.into_iter().find(|(_, i)| violates(*i)) {
                return Some(i);
            }
        }
        None
    }

    /// A value of `M` from which on the optimum fulfils all constraints.
    pub(super) fn enough(&self, at: &Optimum) -> f64 {
        let mut least = 0.0f64;
        for constraint in self.constraints.iter().filter(|constraint| !constraint.is_artificial) {
            let (part, size) = excess(constraint.normal, &at.infinite, 0.0);
            let (rest, _) = excess(constraint.normal, &at.finite, constraint.offset);
            if part < -NEGLIGIBLE * size {
                least = least.max(rest / -part);
            }
        }
        least
    }

    /// The largest radius that the planes leave around a centre.
    pub(super) fn room(&self, center: DVec3) -> f64 {
        let real = self.constraints.iter().filter(|constraint| !constraint.is_artificial);
        real.map(|constraint| constraint.offset - constraint.normal.dot(center)).fold(f64::INFINITY, f64::min)
    }
}

/// `u·c + r − b` and the sum of the magnitudes of its terms.
fn excess(normal: DVec3, x: &[f64; 4], offset: f64) -> (f64, f64) {
    let terms = [normal.x * x[0], normal.y * x[1], normal.z * x[2], x[3], -offset];
    (terms.iter().sum(), terms.iter().map(|v| v.abs()).sum())
}
