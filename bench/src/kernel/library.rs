//! One face for the libraries that are compared: build, remove, add, count.

use crate::inputs::Plane;

/// A dynamic polytope of one library, with the planes of one input numbered as in the input.
pub(crate) trait Library: Clone {
    /// A half-space in the library's own type; making it is not timed.
    type HalfSpace: Clone;

    /// The library's own half-space.
    fn half_space(plane: &Plane) -> Self::HalfSpace;

    /// The polytope of all planes, added in order.
    fn build(half_spaces: &[Self::HalfSpace]) -> Self;

    /// Takes plane `index` of the input back.
    fn remove(&mut self, index: usize);

    /// Adds plane `index` again.
    fn add_again(&mut self, index: usize, half_space: &Self::HalfSpace);

    /// The number of vertices that are seen from outside.
    fn vertex_count(&self) -> usize;

    /// Brings whatever is evaluated lazily up to date, so that the first timed operation does not pay for the build.
    fn settle(&mut self);
}

/// The kernel of this project.
#[derive(Clone)]
pub(crate) struct Planecut {
    polytope: planecut_kernel::IncrementalPolytope,
    /// The handle of each plane of the input; a plane that is added again gets a new one.
    handles: Vec<planecut_kernel::PlaneIdx>,
}

impl Library for Planecut {
    type HalfSpace = planecut_kernel::HalfSpace;

    fn half_space(plane: &Plane) -> Self::HalfSpace {
        planecut_kernel::HalfSpace::new(plane.normal.into(), plane.offset).expect("the inputs are of moderate size")
    }

    fn build(half_spaces: &[Self::HalfSpace]) -> Self {
        let mut polytope = planecut_kernel::IncrementalPolytope::new();
        let handles = half_spaces.iter().map(|half_space| polytope.add_plane(*half_space).plane()).collect();
        Self { polytope, handles }
    }

    fn remove(&mut self, index: usize) {
        self.polytope.remove_plane(self.handles[index]);
    }

    fn add_again(&mut self, index: usize, half_space: &Self::HalfSpace) {
        self.handles[index] = self.polytope.add_plane(*half_space).plane();
    }

    fn vertex_count(&self) -> usize {
        self.polytope.vertex_count()
    }

    fn settle(&mut self) {}
}

/// The published crate `poly_surge`.
#[derive(Clone)]
pub(crate) struct PolySurge {
    polytope: poly_surge::IncrementalPolytope,
}

impl Library for PolySurge {
    type HalfSpace = poly_surge::HalfSpace;

    fn half_space(plane: &Plane) -> Self::HalfSpace {
        poly_surge::HalfSpace::new(poly_surge::math::DVec3::from_array(plane.normal), plane.offset)
    }

    fn build(half_spaces: &[Self::HalfSpace]) -> Self {
        let mut polytope = poly_surge::IncrementalPolytope::new();
        for half_space in half_spaces {
            polytope.add_plane(half_space.clone());
        }
        Self { polytope }
    }

    fn remove(&mut self, index: usize) {
        self.polytope.remove_plane(poly_surge::PlaneIdx(index));
    }

    /// It takes the slot that was freed last, so that the numbers of the input stay valid.
    fn add_again(&mut self, _index: usize, half_space: &Self::HalfSpace) {
        self.polytope.add_plane(half_space.clone());
    }

    fn vertex_count(&self) -> usize {
        self.polytope.vertex_count()
    }

    fn settle(&mut self) {
        self.polytope.edge_count();
    }
}
