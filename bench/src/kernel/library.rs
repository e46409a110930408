//! One face for the libraries that are compared: build, remove, add, count.

use crate::inputs::Plane;

/// A dynamic polytope of one library.
///
/// Planes are numbered as in the input. Both libraries number them so, and both give the slot that was freed last to the
/// next plane: as long as one plane at a time is away, the numbers stay valid.
pub(crate) trait Library: Clone {
    /// The name in the report.
    const NAME: &'static str;

    /// A half-space in the library's own type; making it is not timed.
    type HalfSpace: Clone;

    /// The library's own half-space.
    fn half_space(plane: &Plane) -> Self::HalfSpace;

    /// The polytope of all planes, added in order.
    fn build(half_spaces: &[Self::HalfSpace]) -> Self;

    /// Takes plane `index` of the input back.
    fn remove(&mut self, index: usize);

    /// Adds the plane that was removed last again.
    fn add_again(&mut self, half_space: &Self::HalfSpace);

    /// The number of vertices that are seen from outside.
    fn vertex_count(&self) -> usize;

    /// Brings whatever is evaluated lazily up to date, so that the first timed operation does not pay for the build.
    fn settle(&mut self);
}

/// The kernel of this project.
#[derive(Clone)]
pub(crate) struct Planecut(planecut_kernel::IncrementalPolytope);

impl Library for Planecut {
    const NAME: &'static str = "planecut";

    type HalfSpace = planecut_kernel::HalfSpace;

    fn half_space(plane: &Plane) -> Self::HalfSpace {
        planecut_kernel::HalfSpace::new(plane.normal.into(), plane.offset).expect("the inputs are of moderate size")
    }

    fn build(half_spaces: &[Self::HalfSpace]) -> Self {
        let mut polytope = planecut_kernel::IncrementalPolytope::new();
        for half_space in half_spaces {
            polytope.add_plane(*half_space);
        }
        Self(polytope)
    }

    fn remove(&mut self, index: usize) {
        self.0.remove_plane(planecut_kernel::PlaneIdx(index));
    }

    fn add_again(&mut self, half_space: &Self::HalfSpace) {
        self.0.add_plane(*half_space);
    }

    fn vertex_count(&self) -> usize {
        self.0.vertex_count()
    }

    fn settle(&mut self) {}
}

/// The published crate `poly_surge`.
#[derive(Clone)]
pub(crate) struct PolySurge(poly_surge::IncrementalPolytope);

impl Library for PolySurge {
    const NAME: &'static str = "poly_surge";

    type HalfSpace = poly_surge::HalfSpace;

    fn half_space(plane: &Plane) -> Self::HalfSpace {
        poly_surge::HalfSpace::new(poly_surge::math::DVec3::from_array(plane.normal), plane.offset)
    }

    fn build(half_spaces: &[Self::HalfSpace]) -> Self {
        let mut polytope = poly_surge::IncrementalPolytope::new();
        for half_space in half_spaces {
            polytope.add_plane(half_space.clone());
        }
        Self(polytope)
    }

    fn remove(&mut self, index: usize) {
        self.0.remove_plane(poly_surge::PlaneIdx(index));
    }

    fn add_again(&mut self, half_space: &Self::HalfSpace) {
        self.0.add_plane(half_space.clone());
    }

    fn vertex_count(&self) -> usize {
        self.0.vertex_count()
    }

    fn settle(&mut self) {
        self.0.edge_count();
    }
}
