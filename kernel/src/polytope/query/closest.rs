//! The point of the set that is nearest to a given one.
//!
//! The dual active-set method (Goldfarb, Idnani 1983) for `min |q − p|²` under `n·q ≤ d`, with at most three planes in
//! the active set and every decision in exact rationals: each step takes in the most violated plane and keeps those of the
//! others that still hold the nearest point. The distance grows with every step, so none comes twice.

use dashu_int::IBig;
use glam::DVec3;

use crate::arithmetic::square_root_of_quotient;
use crate::polytope::{IncrementalPolytope, PlaneIdx, external};
use crate::sign::{ExactPoint, Sign, integer_row, residual_with_error, side_of_point};

/// What of the boundary holds a nearest point: the fewest planes whose normals span the way to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum ClosestFeature {
    /// The point asked about belongs to the set.
    Inside,
    /// The plane of a face.
    Face(PlaneIdx),
    /// The two planes of an edge.
    Edge([PlaneIdx; 2]),
    /// Three planes of a vertex.
    Vertex([PlaneIdx; 3]),
}

/// A nearest point.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ClosestPoint {
    /// The nearest point of the set, each coordinate correctly rounded.
    pub point: DVec3,
    /// How far it is, correctly rounded; zero where the point asked about belongs to the set.
    pub distance: f64,
    /// What holds it.
    pub feature: ClosestFeature,
}

/// The nearest point on the meeting flat of some planes, from which `Σ weightᵢ·nᵢ` leads to the point asked about.
struct Projection {
    planes: Vec<u32>,
    point: ExactPoint,
    /// `numerator / denominator` is the squared distance.
    squared: (IBig, IBig),
}

impl IncrementalPolytope {
    /// The nearest point of the closed set, its distance and what of the boundary holds it; `None` where the set is empty or
    /// the point not finite. The numbers given are taken as exact, and the answer is that of exact arithmetic, rounded once.
    ///
    /// Cost: a few scans over the planes that have a face, and some ten microseconds of big integers for each.
    ///
    /// ```
    /// use planecut_kernel::{ClosestFeature, DVec3, HalfSpace, IncrementalPolytope};
    ///
    /// # fn main() -> Result<(), planecut_kernel::HalfSpaceError> {
    /// let mut quadrant = IncrementalPolytope::new();
    /// let x = quadrant.add_plane(HalfSpace::new(DVec3::X, 1.0)?).plane();
    /// let y = quadrant.add_plane(HalfSpace::new(DVec3::Y, 1.0)?).plane();
    /// let closest = quadrant.closest_point(DVec3::new(4.0, 5.0, 7.0)).expect("it is not empty");
    /// assert_eq!((closest.point, closest.distance), (DVec3::new(1.0, 1.0, 7.0), 5.0));
    /// assert_eq!(closest.feature, ClosestFeature::Edge([x, y]));
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn closest_point(&self, point: impl Into<DVec3>) -> Option<ClosestPoint> {
        self.closest_to(point.into())
    }

    fn closest_to(&self, point: DVec3) -> Option<ClosestPoint> {
        if self.is_empty() || !point.is_finite() {
            return None;
        }
        let Some(nearest) = self.project(point) else {
            return Some(ClosestPoint { point, distance: 0.0, feature: ClosestFeature::Inside });
        };
        let mut planes = nearest.planes;
        planes.sort_unstable();
        let feature = match planes.as_slice() {
            [a] => ClosestFeature::Face(external(*a)),
            [a, b] => ClosestFeature::Edge([external(*a), external(*b)]),
            [a, b, c, ..] => ClosestFeature::Vertex([external(*a), external(*b), external(*c)]),
            [] => ClosestFeature::Inside,
        };
        let (numerator, denominator) = nearest.squared;
        let distance = square_root_of_quotient(&numerator, &denominator);
        Some(ClosestPoint { point: nearest.point.rounded(), distance, feature })
    }

    /// The distance of a point from the closed set, correctly rounded: zero inside, infinite where the set is empty, NaN
    /// where the point is not finite.
    ///
    /// ```
    /// use planecut_kernel::{DVec3, HalfSpace, IncrementalPolytope};
    ///
    /// # fn main() -> Result<(), planecut_kernel::HalfSpaceError> {
    /// let mut half = IncrementalPolytope::new();
    /// half.add_plane(HalfSpace::new(DVec3::new(3.0, 4.0, 0.0), 5.0)?);
    /// assert_eq!(half.distance(DVec3::new(3.0, 4.0, 1.0)), 4.0);
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn distance(&self, point: impl Into<DVec3>) -> f64 {
        let point = point.into();
        if !point.is_finite() {
            return f64::NAN;
        }
        self.closest_point(point).map_or(f64::INFINITY, |closest| closest.distance)
    }

    /// The nearest point on the boundary; `None` where the point belongs to the set.
    fn project(&self, point: DVec3) -> Option<Projection> {
        let first = self.most_violated_by_number(point)?;
        let from = ExactPoint::of(point);
        let mut nearest = self.best_projection(&from, &[], first);
        while let Some(plane) = self.most_violated(&nearest) {
            let active = std::mem::take(&mut nearest.planes);
            nearest = self.best_projection(&from, &active, plane);
        }
        Some(nearest)
    }

    /// The plane that a point of exact numbers violates most, up to rounding.
    fn most_violated_by_number(&self, point: DVec3) -> Option<u32> {
        let outside = |plane: &u32| side_of_point(self.row(*plane), point) == Sign::Positive;
        let depth = |plane: u32| residual_with_error(self.row(plane), point).0 / self.normal_length(plane);
        self.face_slots()
            .filter(outside)
            .map(|plane| (depth(plane), plane))
            .max_by(|a, b| a.0.total_cmp(&b.0))
            .map(|p| p.1)
    }

    /// A plane that a projection violates, the worst up to rounding; `None` where there is none, exactly.
    fn most_violated(&self, nearest: &Projection) -> Option<u32> {
        let rounded = nearest.point.rounded();
        let mut worst: Option<(f64, u32)> = None;
        let mut uncertain = Vec::new();
        for plane in self.face_slots().filter(|plane| !nearest.planes.contains(plane)) {
            // the coordinates are rounded too, at most doubling the error
            let (value, error) = residual_with_error(self.row(plane), rounded);
            if value > 2.0 * error {
                let depth = value / self.normal_length(plane);
                if worst.is_none_or(|(most, _)| depth > most) {
                    worst = Some((depth, plane));
                }
            } else if value.is_nan() || value >= -2.0 * error {
                uncertain.push(plane);
            }
        }
        let is_violated = |plane: &u32| nearest.point.residual(&integer_row(self.row(*plane))) > IBig::ZERO;
        worst.map(|(_, plane)| plane).or_else(|| uncertain.into_iter().find(is_violated))
    }

    fn normal_length(&self, plane: u32) -> f64 {
        let [x, y, z, _] = *self.row(plane).coefficients();
        DVec3::new(x, y, z).length()
    }

    /// The nearest point of the intersection of at most four half-spaces, the last of which (`plane`) takes part in it.
    fn best_projection(&self, from: &ExactPoint, active: &[u32], plane: u32) -> Projection {
        let mut subsets = vec![vec![plane]];
        for size in 1..=2 {
            for (i, &a) in active.iter().enumerate() {
                if size == 1 {
                    subsets.push(vec![a, plane]);
                } else {
                    subsets.extend(active[i + 1..].iter().map(|&b| vec![a, b, plane]));
                }
            }
        }
        let holds = |found: &Projection| {
            let others = active.iter().filter(|other| !found.planes.contains(other));
            others.into_iter().all(|other| found.point.residual(&integer_row(self.row(*other))) <= IBig::ZERO)
        };
        let mut candidates = subsets.into_iter().filter_map(|subset| self.projection(from, subset));
        candidates.find(holds).expect("the intersection has a nearest point, held by at most three planes")
    }

    /// The projection onto the meeting flat of one to three planes; `None` where their normals are dependent or a weight is
    /// not positive.
    fn projection(&self, from: &ExactPoint, planes: Vec<u32>) -> Option<Projection> {
        let rows: Vec<[IBig; 4]> = planes.iter().map(|plane| integer_row(self.row(*plane))).collect();
        let residuals: Vec<IBig> = rows.iter().map(|row| from.residual(row)).collect();
        let dot = |p: &[IBig; 4], q: &[IBig; 4]| &p[0] * &q[0] + &p[1] * &q[1] + &p[2] * &q[2];
        let gram: Vec<Vec<IBig>> = rows.iter().map(|p| rows.iter().map(|q| dot(p, q)).collect()).collect();
        let determinant = determinant(&gram);
        if determinant.is_zero() {
            return None;
        }
        let weights: Vec<IBig> = (0..planes.len())
            .map(|column| {
                let mut replaced = gram.clone();
                for (row, residual) in replaced.iter_mut().zip(&residuals) {
                    row[column] = residual.clone();
                }
                self::determinant(&replaced)
            })
            .collect();
        if weights.iter().any(|weight| *weight <= IBig::ZERO) {
            return None;
        }
        let coordinate = |k: usize| {
            let back = rows.iter().zip(&weights).fold(IBig::ZERO, |sum, (row, weight)| sum + &row[k] * weight);
            &from.0[k] * &determinant - back
        };
        let point = ExactPoint([coordinate(0), coordinate(1), coordinate(2), &from.0[3] * &determinant]);
        let numerator = weights.iter().zip(&residuals).fold(IBig::ZERO, |sum, (w, s)| sum + w * s);
        let squared = (numerator, &from.0[3] * &from.0[3] * determinant);
        Some(Projection { planes, point, squared })
    }
}

/// The determinant of a matrix of one to three rows.
fn determinant(m: &[Vec<IBig>]) -> IBig {
    let minor = |i: usize, j: usize, u: usize, v: usize| &m[i][u] * &m[j][v] - &m[i][v] * &m[j][u];
    match m.len() {
        1 => m[0][0].clone(),
        2 => minor(0, 1, 0, 1),
        _ => &m[0][0] * minor(1, 2, 1, 2) - &m[0][1] * minor(1, 2, 0, 2) + &m[0][2] * minor(1, 2, 0, 1),
    }
}
