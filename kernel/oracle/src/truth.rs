//! The perturbed polytope of a few planes, from the definition, by trying all subsets.
//!
//! Plane `i` (in the order of insertion) is `nᵢ·x ≤ dᵢ − εᵢ` with `ε₀ ≫ ε₁ ≫ … > 0` infinitesimal. Every
//! question below ends in the sign of `c + Σ eᵢ εᵢ`, which is the first non-zero of `c, e₀, e₁, …`.
//! Emptiness and redundancy come from Farkas certificates, not from the vertices, so that the two
//! halves of this file check each other.

use std::array::from_fn;

use dashu_int::IBig;

use crate::exact::{Coefficients, cross, dot, integer_row, normal, sign};

/// Determinants and cross products of all normals, computed once.
struct Table {
    rows: Vec<[IBig; 4]>,
    normals: Vec<[IBig; 3]>,
    crosses: Vec<[IBig; 3]>,
}

/// A corner `n_i, n_j, n_k` with positive determinant: counter-clockwise seen from outside.
pub type Triple = [usize; 3];

/// What is true of a list of planes, by their index in the list.
#[derive(Debug)]
pub struct Truth {
    /// No interior, hence empty once all planes have moved inward.
    pub empty: bool,
    /// Empty, or no direction in which the set goes on for ever.
    pub bounded: bool,
    /// Per plane: it has no face in the perturbed set. All false if the set is empty.
    pub redundant: Vec<bool>,
    /// The finite vertices of the perturbed set, smallest index first, sorted.
    pub corners: Vec<Triple>,
    /// `[i, j]` where the perturbed edge of `i` and `j` goes on for ever along `nᵢ × nⱼ`; sorted.
    pub rays: Vec<[usize; 2]>,
}

impl Truth {
    /// Decides everything about `planes`, which are given in the order of insertion. O(n⁴) big-integer products.
    ///
    /// # Panics
    /// Where its own answers contradict each other.
    #[must_use]
    pub fn of(planes: &[Coefficients]) -> Self {
        let table = Table::new(planes);
        let all = 0..planes.len();
        if table.infeasible(None) {
            return Self { empty: true, bounded: true, redundant: Vec::new(), corners: Vec::new(), rays: Vec::new() };
        }
        let truth = Self {
            empty: false,
            bounded: table.bounded(),
            redundant: all.map(|h| table.infeasible(Some(h))).collect(),
            corners: table.corners(),
            rays: table.rays(),
        };
        truth.assert_consistent();
        truth
    }

    /// A set with vertices shows every face in some vertex or ray, and only faces.
    fn assert_consistent(&self) {
        assert!(!self.bounded || self.rays.is_empty(), "bounded with rays: {self:?}");
        if self.corners.is_empty() {
            return;
        }
        for (h, &redundant) in self.redundant.iter().enumerate() {
            let seen = self.corners.iter().flatten().chain(self.rays.iter().flatten()).any(|&i| i == h);
            assert_eq!(seen, !redundant, "the oracle contradicts itself about plane {h}: {self:?}");
        }
    }
}

/// `constant + Σ coefficient·ε_index`; the indices must differ.
fn perturbed_sign<const N: usize>(constant: &IBig, mut infinitesimals: [(usize, IBig); N]) -> i32 {
    infinitesimals.sort_by_key(|&(index, _)| index);
    std::iter::once(sign(constant)).chain(infinitesimals.iter().map(|(_, c)| sign(c))).find(|&s| s != 0).unwrap_or(0)
}

impl Table {
    fn new(planes: &[Coefficients]) -> Self {
        let rows: Vec<[IBig; 4]> = planes.iter().map(|&p| integer_row(p)).collect();
        let normals: Vec<[IBig; 3]> = rows.iter().map(normal).collect();
        let crosses = normals.iter().flat_map(|a| normals.iter().map(move |b| cross(a, b))).collect();
        Self { rows, normals, crosses }
    }

    fn len(&self) -> usize {
        self.rows.len()
    }

    fn cross(&self, i: usize, j: usize) -> &[IBig; 3] {
        &self.crosses[i * self.len() + j]
    }

    fn offset(&self, i: usize) -> &IBig {
        &self.rows[i][3]
    }

    fn det(&self, i: usize, j: usize, k: usize) -> IBig {
        dot(&self.normals[i], self.cross(j, k))
    }

    /// Whether the set goes on for ever: normals of rank below 3 leave a line free; otherwise the cone
    /// `nᵢ·u ≤ 0` is pointed, and an extreme ray of it lies in two planes.
    fn bounded(&self) -> bool {
        let n = self.len();
        let full_rank = (0..n).any(|i| (0..i).any(|j| (0..j).any(|k| sign(&self.det(i, j, k)) != 0)));
        full_rank && !(0..n).any(|i| (0..n).any(|j| self.direction_stays_inside(i, j)))
    }

    fn direction_stays_inside(&self, i: usize, j: usize) -> bool {
        let u = self.cross(i, j);
        u.iter().any(|c| !c.is_zero()) && self.normals.iter().all(|n| sign(&dot(n, u)) <= 0)
    }

    fn corners(&self) -> Vec<Triple> {
        let n = self.len();
        let mut found = Vec::new();
        for i in 0..n {
            for j in i + 1..n {
                for k in j + 1..n {
                    let triple = match sign(&self.det(i, j, k)) {
                        1 => [i, j, k],
                        -1 => [i, k, j],
                        _ => continue,
                    };
                    if (0..n).all(|h| triple.contains(&h) || self.corner_is_inside(triple, h)) {
                        found.push(triple);
                    }
                }
            }
        }
        found.sort_unstable();
        found
    }

    /// Whether the perturbed corner satisfies plane `h`. With `W = det > 0` the corner is
    /// `((dᵢ−εᵢ) nⱼ×nₖ + (dⱼ−εⱼ) nₖ×nᵢ + (dₖ−εₖ) nᵢ×nⱼ) / W`.
    fn corner_is_inside(&self, [i, j, k]: Triple, h: usize) -> bool {
        let w = self.det(i, j, k);
        let (a, b, c) = (self.det(h, j, k), self.det(h, k, i), self.det(h, i, j));
        let constant = self.offset(i) * &a + self.offset(j) * &b + self.offset(k) * &c - self.offset(h) * &w;
        perturbed_sign(&constant, [(i, -a), (j, -b), (k, -c), (h, w)]) < 0
    }

    fn rays(&self) -> Vec<[usize; 2]> {
        let n = self.len();
        let pairs = (0..n).flat_map(|i| (0..n).map(move |j| [i, j])).filter(|[i, j]| i != j);
        pairs.filter(|&[i, j]| self.is_ray(i, j)).collect()
    }

    fn is_ray(&self, i: usize, j: usize) -> bool {
        let u = self.cross(i, j);
        u.iter().any(|c| !c.is_zero())
            && (0..self.len()).filter(|&h| h != i && h != j).all(|h| match sign(&dot(&self.normals[h], u)) {
                0 => self.parallel_line_is_inside(i, j, h),
                s => s < 0,
            })
    }

    /// Whether the perturbed line of `i` and `j` satisfies a plane `h` it never meets. Its normal is
    /// `|u|² nₕ = α nᵢ + β nⱼ` with `u = nᵢ × nⱼ`, `α = (nₕ × nⱼ)·u`, `β = (nᵢ × nₕ)·u`.
    fn parallel_line_is_inside(&self, i: usize, j: usize, h: usize) -> bool {
        let u = self.cross(i, j);
        let (alpha, beta, square) = (dot(self.cross(h, j), u), dot(self.cross(i, h), u), dot(u, u));
        let constant = &alpha * self.offset(i) + &beta * self.offset(j) - &square * self.offset(h);
        perturbed_sign(&constant, [(i, -alpha), (j, -beta), (h, square)]) < 0
    }

    /// Whether no point satisfies all planes, with plane `flipped` (if any) turned to face the other way.
    ///
    /// Farkas: exactly when some `λ ≥ 0`, not zero, has `Σ λᵢ nᵢ = 0` and `Σ λᵢ (dᵢ − εᵢ) < 0`. The set of such
    /// `λ` is a pointed cone whose extreme rays have at most four positive entries. With a flipped
    /// plane only certificates that use it are tried: the others are known not to exist.
    fn infeasible(&self, flipped: Option<usize>) -> bool {
        let n = self.len();
        let signed = |i: usize| if flipped == Some(i) { -1 } else { 1 };
        let relevant = |subset: &[usize]| flipped.is_none_or(|f| subset.contains(&f));
        (0..n).any(|a| {
            (0..a).any(|b| {
                relevant(&[a, b]) && self.opposite([a, b], signed)
                    || (0..b).any(|c| {
                        relevant(&[a, b, c]) && self.coplanar_certificate([a, b, c], signed)
                            || (0..c).any(|d| relevant(&[a, b, c, d]) && self.full_certificate([a, b, c, d], signed))
                    })
            })
        })
    }

    /// `λ` for two opposite normals: `|n_b|² n_a − (n_a·n_b) n_b = 0`.
    fn opposite(&self, [a, b]: [usize; 2], signed: impl Fn(usize) -> i32) -> bool {
        if self.cross(a, b).iter().any(|c| !c.is_zero()) {
            return false;
        }
        let product = dot(&self.normals[a], &self.normals[b]) * signed(a) * signed(b);
        sign(&product) < 0 && self.certifies([a, b], &[dot(&self.normals[b], &self.normals[b]), -product], signed)
    }

    /// `λ` for three normals in one plane: `λ_a = (n_b × n_c)·u` and cyclic, with `u = n_a × n_b`.
    fn coplanar_certificate(&self, [a, b, c]: [usize; 3], signed: impl Fn(usize) -> i32) -> bool {
        if sign(&self.det(a, b, c)) != 0 {
            return false;
        }
        let u = self.cross(a, b);
        let lambda = [(b, c), (c, a), (a, b)]
            .map(|(i, j)| dot(self.cross(i, j), u) * signed(i) * signed(j) * signed(a) * signed(b));
        lambda.iter().all(|l| sign(l) > 0) && self.certifies([a, b, c], &lambda, signed)
    }

    /// `λ` for four normals: the 3×3 minors with alternating signs.
    fn full_certificate(&self, subset: [usize; 4], signed: impl Fn(usize) -> i32) -> bool {
        let [a, b, c, d] = subset;
        let minors = [self.det(b, c, d), -self.det(a, c, d), self.det(a, b, d), -self.det(a, b, c)];
        // det with one row left out carries the product of the other rows' signs: that of all, times its own.
        let lambda: [IBig; 4] = from_fn(|i| &minors[i] * signed(subset[i]));
        let common = sign(&lambda[0]);
        common != 0
            && lambda.iter().all(|l| sign(l) == common)
            && self.certifies(subset, &lambda.map(|l| l * common), signed)
    }

    /// Whether `Σ λᵢ σᵢ (dᵢ − εᵢ) < 0`.
    fn certifies<const N: usize>(&self, subset: [usize; N], lambda: &[IBig; N], signed: impl Fn(usize) -> i32) -> bool {
        let weights: [IBig; N] = from_fn(|i| &lambda[i] * signed(subset[i]));
        let constant = (0..N).fold(IBig::ZERO, |sum, i| sum + &weights[i] * self.offset(subset[i]));
        perturbed_sign::<N>(&constant, from_fn(|i| (subset[i], -&weights[i]))) < 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CUBE: [Coefficients; 6] = [
        [1.0, 0.0, 0.0, 1.0],
        [-1.0, 0.0, 0.0, 1.0],
        [0.0, 1.0, 0.0, 1.0],
        [0.0, -1.0, 0.0, 1.0],
        [0.0, 0.0, 1.0, 1.0],
        [0.0, 0.0, -1.0, 1.0],
    ];

    #[test]
    fn a_cube_has_eight_corners() {
        let truth = Truth::of(&CUBE);
        assert!(!truth.empty && truth.bounded && truth.rays.is_empty());
        assert_eq!(truth.redundant, [false; 6]);
        assert_eq!(truth.corners.len(), 8);
        assert!(truth.corners.contains(&[0, 2, 4]) && truth.corners.contains(&[1, 4, 2]));
    }

    #[test]
    fn of_equal_planes_the_younger_is_redundant() {
        let doubled: Vec<Coefficients> = CUBE.iter().copied().chain([[3.0, 0.0, 0.0, 3.0]]).collect();
        assert_eq!(Truth::of(&doubled).redundant, [false, false, false, false, false, false, true]);
    }

    #[test]
    fn touching_from_outside_is_empty() {
        let touching: Vec<Coefficients> = CUBE.iter().copied().chain([[-1.0, -1.0, -1.0, -3.0]]).collect();
        assert!(Truth::of(&touching).empty);
        assert!(Truth::of(&[CUBE[0], [-1.0, 0.0, 0.0, -1.0]]).empty);
    }

    #[test]
    fn a_corner_plane_that_only_touches_loses_against_older_ones_if_they_move_further() {
        // x + y + z ≤ 3 touches the corner (1, 1, 1): ε₀, ε₂, ε₄ pull the corner away from it.
        let last: Vec<Coefficients> = CUBE.iter().copied().chain([[1.0, 1.0, 1.0, 3.0]]).collect();
        assert_eq!(Truth::of(&last).redundant, [false, false, false, false, false, false, true]);
        let first: Vec<Coefficients> = [[1.0, 1.0, 1.0, 3.0]].into_iter().chain(CUBE).collect();
        let truth = Truth::of(&first);
        assert_eq!(truth.redundant, [false; 7]);
        assert_eq!(truth.corners.len(), 10);
    }

    #[test]
    fn open_sets() {
        let slab = Truth::of(&CUBE[..2]);
        assert!(!slab.empty && !slab.bounded && slab.corners.is_empty() && slab.rays.is_empty());
        let tube = Truth::of(&CUBE[..4]);
        assert!(!tube.bounded && tube.corners.is_empty());
        assert_eq!(tube.rays.len(), 8);
        let octant = Truth::of(&[CUBE[0], CUBE[2], CUBE[4]]);
        assert_eq!(octant.corners, [[0, 1, 2]]);
        // The edge of x ≤ 1 and y ≤ 1 goes down along -z = n_y × n_x.
        assert_eq!(octant.rays, [[0, 2], [1, 0], [2, 1]]);
        assert!(!Truth::of(&[]).bounded && !Truth::of(&[]).empty);
    }
}
