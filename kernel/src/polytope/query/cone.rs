//! The directions in which a set goes on for ever.

use std::collections::BTreeSet;

use dashu_int::{IBig, UBig, ops::Gcd};
use glam::DVec3;

use crate::arithmetic::{big_cross, big_dot, unit_vector};
use crate::polytope::IncrementalPolytope;
use crate::polytope::infinity::is_infinity;
use crate::polytope::store::{BEFORE, NEXT};
use crate::sign::integer_row;

/// The recession cone `{r : x + t·r in the set for all x in it and t ≥ 0}`: the sum of the lines and rays listed.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RecessionCone {
    /// Unit directions of its extreme rays, at right angles to the lines where there are any.
    pub rays: Vec<DVec3>,
    /// An orthonormal basis of the lines that the set contains, whose opposite directions belong to the cone as well.
    pub lines: Vec<DVec3>,
}

type Vector = [IBig; 3];

impl IncrementalPolytope {
    /// The recession cone: no rays and no lines where the set is bounded or empty.
    ///
    /// Which directions there are is decided exactly, each is listed once, and its components are accurate to a few
    /// roundings.
    ///
    /// ```
    /// use planecut_kernel::{DVec3, HalfSpace, IncrementalPolytope};
    ///
    /// # fn main() -> Result<(), planecut_kernel::HalfSpaceError> {
    /// let mut quadrant = IncrementalPolytope::new();
    /// quadrant.add_plane(HalfSpace::new(-DVec3::X, 0.0)?);
    /// quadrant.add_plane(HalfSpace::new(-DVec3::Y, 0.0)?);
    /// let cone = quadrant.recession_cone();
    /// assert_eq!((cone.rays.len(), cone.lines.len()), (2, 1));
    /// assert!(cone.rays.contains(&DVec3::X) && cone.rays.contains(&DVec3::Y));
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn recession_cone(&self) -> RecessionCone {
        if self.is_bounded() {
            return RecessionCone::default();
        }
        let mut independent: Vec<[IBig; 4]> = Vec::new();
        for plane in self.face_slots() {
            let row = integer_row(self.row(plane));
            if is_independent(&independent, &row) {
                independent.push(row);
            }
            if independent.len() == 3 {
                break;
            }
        }
        match independent.as_slice() {
            [] => RecessionCone { rays: Vec::new(), lines: DVec3::AXES.to_vec() },
            [normal] => self.half_space_cone(normal),
            [a, b] => self.cone_along_line(&big_cross(a, b)),
            _ => self.pointed_cone(),
        }
    }

    /// All normals are parallel: a half-space or a slab.
    fn half_space_cone(&self, normal: &[IBig; 4]) -> RecessionCone {
        let inward: Vector = std::array::from_fn(|k| -&normal[k]);
        let direction = unit_vector(&inward);
        let (u, v) = direction.any_orthonormal_pair();
        let rays = if self.is_recession_direction(&inward) { vec![direction] } else { Vec::new() };
        RecessionCone { rays, lines: vec![u, v] }
    }

    /// All normals are at right angles to one line: an unbounded polygon times the line. The sides at its ends have at most
    /// one neighbour.
    fn cone_along_line(&self, line: &Vector) -> RecessionCone {
        let [x, y, z] = line.clone();
        let along = [x, y, z, IBig::ZERO];
        let mut rays = BTreeSet::new();
        for plane in self.face_slots() {
            let ring = self.vertices.face_corners(plane, self.planes.face_vertex(plane));
            let mut neighbours: Vec<u32> = ring
                .map(|(vertex, k)| self.vertices.planes(vertex)[BEFORE[k]])
                .filter(|neighbour| !is_infinity(*neighbour))
                .collect();
            neighbours.sort_unstable();
            neighbours.dedup();
            if neighbours.len() > 1 {
                continue;
            }
            let side = big_cross(&integer_row(self.row(plane)), &along);
            let opposite: Vector = std::array::from_fn(|k| -&side[k]);
            rays.extend([side, opposite].into_iter().filter(|ray| self.is_recession_direction(ray)).map(primitive));
        }
        RecessionCone { rays: rays.iter().map(unit_vector).collect(), lines: vec![unit_vector(line)] }
    }

    /// The set has a vertex: the extreme rays of the cone are the directions of its unbounded edges.
    fn pointed_cone(&self) -> RecessionCone {
        let mut rays = BTreeSet::new();
        for vertex in self.vertices.slots().filter(|vertex| self.vertices.is_ideal(*vertex)) {
            let planes = self.vertices.planes(vertex);
            let infinite = planes.map(is_infinity);
            if infinite.into_iter().filter(|at_infinity| *at_infinity).count() != 1 {
                continue;
            }
            let k = infinite.into_iter().position(|at_infinity| at_infinity).unwrap_or(0);
            let [b, c] = [planes[NEXT[k]], planes[BEFORE[k]]].map(|plane| integer_row(self.row(plane)));
            rays.insert(primitive(big_cross(&b, &c)));
        }
        RecessionCone { rays: rays.iter().map(unit_vector).collect(), lines: Vec::new() }
    }

    fn is_recession_direction(&self, ray: &Vector) -> bool {
        self.face_slots().all(|plane| big_dot(&integer_row(self.row(plane)), ray) <= IBig::ZERO)
    }
}

/// Whether the normal of `row` is independent of at most two independent ones.
fn is_independent(found: &[[IBig; 4]], row: &[IBig; 4]) -> bool {
    match found {
        [] => true,
        [a] => big_cross(a, row).iter().any(|v| !v.is_zero()),
        [a, b, ..] => !big_dot(row, &big_cross(a, b)).is_zero(),
    }
}

/// The vector divided by the greatest common divisor of its components: one form for each direction.
fn primitive(vector: Vector) -> Vector {
    let divisor = vector.iter().filter(|v| !v.is_zero()).fold(UBig::ZERO, |divisor, v| {
        let magnitude = v.clone().into_parts().1;
        if divisor.is_zero() { magnitude } else { divisor.gcd(magnitude) }
    });
    let divisor = IBig::from(divisor);
    vector.map(|v| v / &divisor)
}
