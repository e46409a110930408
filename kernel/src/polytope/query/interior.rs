//! Points strictly inside and the largest ball inside.

use glam::DVec3;

use super::contains::Location;
use super::linear_program::{Constraint, Program};
use crate::arithmetic::DoubleDouble;
use crate::meet::meet;
use crate::polytope::IncrementalPolytope;

/// A largest ball inside a set (its radius is the Chebyshev radius).
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct InscribedBall {
    /// The centre; one of many where several largest balls fit.
    pub center: DVec3,
    /// The radius. Infinite where balls of any size fit: the centre is then that of one of them.
    pub radius: f64,
}

/// A point strictly inside, if there is one.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum InteriorPoint {
    /// This point lies strictly inside, exactly.
    Point(DVec3),
    /// The set has an interior, but no point of three `f64` numbers was found in it: it is about as thin as the numbers
    /// there lie apart. The search tries the numbers around the centre of the largest ball.
    Thin,
    /// The set has no interior.
    Empty,
}

/// How many neighbouring numbers of each coordinate are tried.
const NEIGHBOURS: i32 = 3;

impl IncrementalPolytope {
    /// A point strictly inside the set, checked exactly.
    ///
    /// It is the centre of the largest ball wherever that is wider than the numbers there lie apart.
    ///
    /// ```
    /// use planecut_kernel::{DVec3, HalfSpace, IncrementalPolytope, InteriorPoint, Location};
    ///
    /// # fn main() -> Result<(), planecut_kernel::HalfSpaceError> {
    /// let mut octant = IncrementalPolytope::new();
    /// for axis in DVec3::AXES {
    ///     octant.add_plane(HalfSpace::new(axis, 1.0)?);
    /// }
    /// let InteriorPoint::Point(inside) = octant.interior_point() else { panic!("an octant is not thin") };
    /// assert_eq!(octant.classify(inside), Location::Inside);
    /// octant.add_plane(HalfSpace::new(-DVec3::X, -1.0)?);
    /// assert_eq!(octant.interior_point(), InteriorPoint::Empty);
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn interior_point(&self) -> InteriorPoint {
        let Some(ball) = self.chebyshev_ball() else { return InteriorPoint::Empty };
        let inside = |point: &DVec3| self.classify(*point) == Location::Inside;
        let around = std::iter::once(ball.center).chain(neighbours(ball.center));
        around.into_iter().find(inside).map_or(InteriorPoint::Thin, InteriorPoint::Point)
    }

    /// A largest ball inside the set: its centre and radius; `None` where the set is empty. The radius is infinite where balls
    /// of any size fit, and finite in a slab or a prism without ends.
    ///
    /// With `L` the distance of the planes that hold the ball from a vertex of the set, the radius is right to within
    /// `1e-14·L` (unit normals are rounded once, and the linear program over them solved exactly), and a set thinner
    /// than that can get the radius zero; the ball around the centre stays inside to the same tolerance.
    ///
    /// ```
    /// use planecut_kernel::{DVec3, HalfSpace, IncrementalPolytope};
    ///
    /// # fn main() -> Result<(), planecut_kernel::HalfSpaceError> {
    /// let mut slab = IncrementalPolytope::new();
    /// slab.add_plane(HalfSpace::new(DVec3::Z, 3.0)?);
    /// assert_eq!(slab.chebyshev_ball().map(|ball| ball.radius), Some(f64::INFINITY));
    /// slab.add_plane(HalfSpace::new(-DVec3::Z, 1.0)?);
    /// let ball = slab.chebyshev_ball().expect("it is not empty");
    /// assert!((ball.radius - 2.0).abs() < 1e-13 && (ball.center.z - 1.0).abs() < 1e-13);
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn chebyshev_ball(&self) -> Option<InscribedBall> {
        if self.is_empty() {
            return None;
        }
        let reference = self.reference_point();
        let constraints: Vec<Constraint> = self.face_slots().map(|plane| self.constraint(plane, reference)).collect();
        let size = constraints.iter().map(Constraint::distance).fold(0.0, f64::max);
        let program = Program::new(constraints);
        let optimum = program.optimum()?;
        let at = |m: f64| -> [f64; 4] { std::array::from_fn(|k| optimum.finite[k] + m * optimum.infinite[k]) };
        let [.., growth] = optimum.infinite;
        let mut m = if optimum.infinite == [0.0; 4] { 0.0 } else { 2.0 * program.enough(&optimum) };
        if growth > 0.0 {
            m = m.max((4.0 * optimum.finite[3].abs() + if size > 0.0 { size } else { 1.0 }) / growth);
        }
        let [x, y, z, _] = at(m);
        let center = DVec3::new(x, y, z);
        let radius = if growth > 0.0 { f64::INFINITY } else { program.room(center).max(0.0) };
        Some(InscribedBall { center: reference + center, radius })
    }

    /// A plane with a unit normal, its offset counted from a reference point.
    fn constraint(&self, plane: u32, reference: DVec3) -> Constraint {
        let [x, y, z, d] = *self.row(plane).coefficients();
        let normal = DVec3::new(x, y, z);
        let length = normal.length();
        let along = DoubleDouble::product(x, reference.x)
            .plus(DoubleDouble::product(y, reference.y))
            .plus(DoubleDouble::product(z, reference.z));
        let offset = DoubleDouble::sum(d, 0.0).plus(along.negated());
        Constraint::new(normal / length, offset.high / length)
    }

    /// A vertex, or without one a point of the flat on which some planes meet, rounded.
    fn reference_point(&self) -> DVec3 {
        if let Some(vertex) = self.vertices.slots().find(|vertex| !self.vertices.is_ideal(*vertex)) {
            let [a, b, c] = self.vertices.planes(vertex).map(|plane| self.row(plane));
            return meet(a, b, c).expect("the normals at a vertex are independent");
        }
        let Some(vertex) = self.vertices.slots().next() else { return DVec3::ZERO };
        self.nearest_point_of_flat(self.vertices.planes(vertex)).rounded()
    }
}

/// The points whose coordinates are few numbers away.
fn neighbours(point: DVec3) -> impl Iterator<Item = DVec3> {
    let steps = || -NEIGHBOURS..=NEIGHBOURS;
    steps()
        .flat_map(move |x| steps().flat_map(move |y| steps().map(move |z| [x, y, z])))
        .map(move |by| DVec3::from_array(std::array::from_fn(|axis| moved(point[axis], by[axis]))))
}

/// The number `steps` numbers above or below another one.
fn moved(value: f64, steps: i32) -> f64 {
    (0..steps.abs()).fold(value, |value, _| if steps > 0 { value.next_up() } else { value.next_down() })
}
