//! The points of the set that lie farthest in a direction.

use std::collections::HashSet;

use dashu_int::IBig;
use glam::DVec3;

use crate::arithmetic::{big_cross, big_dot, unit_vector};
use crate::half_space::HalfSpace;
use crate::meet::meet;
use crate::polytope::infinity::is_infinity;
use crate::polytope::store::{BEFORE, NEXT};
use crate::polytope::{IncrementalPolytope, VertexIdx};
use crate::sign::{ExactPoint, OffsetColumn, Row, Sign, integer_row, orient3};

/// Where a set lies farthest in a direction.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Support {
    /// At a vertex; where several lie equally far, at one of them.
    Vertex {
        /// The vertex, a good start for the next question.
        vertex: VertexIdx,
        /// Its position, correctly rounded.
        position: DVec3,
    },
    /// The set has no vertex (it contains a whole line) and lies farthest at this point and others.
    Flat {
        /// Of the line or plane that carries the farthest points, the one nearest to the origin, correctly rounded.
        point: DVec3,
    },
    /// The set goes on for ever.
    Unbounded {
        /// A unit direction in which it goes on, and which leads farther in the direction that was asked for.
        direction: DVec3,
    },
    /// The set is empty.
    Empty,
}

impl IncrementalPolytope {
    /// Where the set lies farthest in a direction, by climbing from a vertex that is known to lie in about this direction (paper §3).
    ///
    /// The direction needs no unit length; its numbers are taken as exact and so is every step. `None` where it is
    /// zero or not accepted as a normal (see [`HalfSpace::new`]).
    ///
    /// ```
    /// use planecut_kernel::{DVec3, HalfSpace, IncrementalPolytope, Support};
    ///
    /// # fn main() -> Result<(), planecut_kernel::HalfSpaceError> {
    /// let mut octant = IncrementalPolytope::new();
    /// for axis in DVec3::AXES {
    ///     octant.add_plane(HalfSpace::new(axis, 1.0)?);
    /// }
    /// let up = octant.support(DVec3::new(1.0, 2.0, 3.0));
    /// assert!(matches!(up, Some(Support::Vertex { position: DVec3::ONE, .. })));
    /// assert!(matches!(octant.support(-DVec3::X), Some(Support::Unbounded { .. })));
    /// assert_eq!(octant.support(DVec3::ZERO), None);
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn support(&self, direction: impl Into<DVec3>) -> Option<Support> {
        let row = direction_row(direction.into())?;
        Some(self.support_of_row(&row, self.start(&row)))
    }

    /// [`support`](Self::support), climbing from a vertex that was found before: a few steps where the directions are near
    /// each other. A vertex that is no longer there does no harm.
    ///
    /// ```
    /// use planecut_kernel::{DVec3, HalfSpace, IncrementalPolytope, Support};
    ///
    /// # fn main() -> Result<(), planecut_kernel::HalfSpaceError> {
    /// let mut cube = IncrementalPolytope::new();
    /// for axis in DVec3::AXES {
    ///     cube.add_plane(HalfSpace::new(axis, 1.0)?);
    ///     cube.add_plane(HalfSpace::new(-axis, 1.0)?);
    /// }
    /// let Some(Support::Vertex { vertex, .. }) = cube.support(DVec3::new(3.0, 2.0, 1.0)) else { panic!() };
    /// let next = cube.support_from(DVec3::new(3.0, 2.0, -1.0), vertex);
    /// assert!(matches!(next, Some(Support::Vertex { position: DVec3 { z: -1.0, .. }, .. })));
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn support_from(&self, direction: impl Into<DVec3>, start: VertexIdx) -> Option<Support> {
        let row = direction_row(direction.into())?;
        let start = if self.vertices.is_live(start.0) { start.0 } else { self.start(&row) };
        Some(self.support_of_row(&row, start))
    }

    fn support_of_row(&self, row: &Row, start: u32) -> Support {
        if self.is_empty() {
            return Support::Empty;
        }
        let top = self.climb(row, start);
        if !self.vertices.is_ideal(top) {
            return self.support_vertex(top);
        }
        let planes = self.vertices.planes(top);
        let rows = planes.map(|plane| self.row(plane));
        if self.vertices.point(top).homogeneous().side(rows, row, OffsetColumn::Infinite) == Sign::Positive {
            return Support::Unbounded { direction: self.ideal_direction(planes) };
        }
        match self.finite_vertex_at_same_height(row, top) {
            Some(vertex) => self.support_vertex(vertex),
            None => Support::Flat { point: self.nearest_point_of_flat(planes).rounded() },
        }
    }

    fn support_vertex(&self, vertex: u32) -> Support {
        let [a, b, c] = self.vertices.planes(vertex).map(|plane| self.row(plane));
        let position = meet(a, b, c).expect("the normals at a vertex are independent");
        Support::Vertex { vertex: VertexIdx(vertex), position }
    }

    /// The unit direction in which an ideal vertex moves as the infinity planes do: one of the recession cone.
    fn ideal_direction(&self, planes: [u32; 3]) -> DVec3 {
        let [a, b, c] = planes.map(|plane| integer_row(self.row(plane)));
        let (bc, ca, ab) = (big_cross(&b, &c), big_cross(&c, &a), big_cross(&a, &b));
        let moved = planes.map(|plane| IBig::from(u8::from(is_infinity(plane))));
        unit_vector(&std::array::from_fn(|k| &moved[0] * &bc[k] + &moved[1] * &ca[k] + &moved[2] * &ab[k]))
    }

    /// Searches the farthest face, which begins at the ideal vertex `top`, for a finite vertex. There is one unless the
    /// set contains a line.
    fn finite_vertex_at_same_height(&self, row: &Row, top: u32) -> Option<u32> {
        let mut seen = HashSet::from([top]);
        let mut waiting = vec![top];
        while let Some(vertex) = waiting.pop() {
            if !self.vertices.is_ideal(vertex) {
                return Some(vertex);
            }
            let planes = self.vertices.planes(vertex);
            for (k, neighbour) in self.vertices.neighbours(vertex).into_iter().enumerate() {
                let level = orient3(row, self.row(planes[NEXT[k]]), self.row(planes[BEFORE[k]])) == Sign::Zero;
                if level && seen.insert(neighbour) {
                    waiting.push(neighbour);
                }
            }
        }
        None
    }

    /// The point nearest to the origin of the flat on which the finite ones of three planes meet.
    pub(super) fn nearest_point_of_flat(&self, planes: [u32; 3]) -> ExactPoint {
        let finite: Vec<[IBig; 4]> =
            planes.into_iter().filter(|plane| !is_infinity(*plane)).map(|plane| integer_row(self.row(plane))).collect();
        match finite.as_slice() {
            [] => ExactPoint::of(DVec3::ZERO),
            [plane] => {
                let [x, y, z, d] = plane;
                ExactPoint([x * d, y * d, z * d, x * x + y * y + z * z])
            }
            [b, c, ..] => {
                let line = big_cross(b, c);
                let [x, y, z] = line.clone();
                let along = [x, y, z, IBig::ZERO];
                let (c_line, line_b) = (big_cross(c, &along), big_cross(&along, b));
                let coordinate = |k: usize| &b[3] * &c_line[k] + &c[3] * &line_b[k];
                ExactPoint([coordinate(0), coordinate(1), coordinate(2), big_dot(&along, &line)])
            }
        }
    }
}

/// A direction as a row; `None` where it is not accepted as a normal.
pub(super) fn direction_row(direction: DVec3) -> Option<Row> {
    HalfSpace::new(direction, 0.0).ok().map(|half_space| Row::new(&half_space))
}
