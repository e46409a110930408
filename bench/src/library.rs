//! One face for the libraries that are compared.

use crate::inputs::Plane;
use std::collections::BTreeSet;

/// A dynamic polytope of one library.
///
/// Planes are numbered as in the input. Both libraries number them so, and both give the slot that was freed last to the
/// next plane: as long as planes are added again in the reverse order of their removal, the numbers stay valid.
pub trait Library: Clone + 'static {
    /// The name in the report.
    const NAME: &'static str;

    /// A half-space in the library's own type; making it is not timed.
    type HalfSpace: Clone + 'static;

    /// The library's own half-space.
    fn half_space(plane: &Plane) -> Self::HalfSpace;

    /// All of space, with the library's default tolerance.
    fn new() -> Self;

    /// All of space, with a tolerance in the units of the planes.
    fn with_epsilon(epsilon: f64) -> Self;

    /// Back to all of space.
    fn clear(&mut self);

    /// Adds a plane.
    fn add(&mut self, half_space: &Self::HalfSpace);

    /// Takes plane `index` of the input back.
    fn remove(&mut self, index: usize);

    /// The number of vertices that are seen from outside.
    fn vertex_count(&self) -> usize;

    /// Whether the set is bounded.
    fn is_bounded(&mut self) -> bool;

    /// The finite vertices, and the faces as indices into them.
    fn mesh(&mut self) -> (Vec<[f64; 3]>, Vec<Vec<usize>>);

    /// Brings whatever is evaluated lazily up to date, so that the first timed operation does not pay for the build.
    fn settle(&mut self);

    /// Adds all planes, in order.
    fn add_all(&mut self, half_spaces: &[Self::HalfSpace]) {
        for half_space in half_spaces {
            self.add(half_space);
        }
    }

    /// The polytope of all planes, added in order.
    fn build(half_spaces: &[Self::HalfSpace]) -> Self {
        let mut polytope = Self::new();
        polytope.add_all(half_spaces);
        polytope
    }

    /// `V − E + F` of the mesh, edges inferred from the faces (paper §3.7); 2 for a bounded polytope.
    fn euler_characteristic(&mut self) -> i64 {
        let (_, faces) = self.mesh();
        let vertices: BTreeSet<usize> = faces.iter().flatten().copied().collect();
        let edge = |face: &Vec<usize>, k: usize| {
            let (a, b) = (face[k], face[(k + 1) % face.len()]);
            (a.min(b), a.max(b))
        };
        let edges: BTreeSet<_> = faces.iter().flat_map(|f| (0..f.len()).map(move |k| edge(f, k))).collect();
        vertices.len() as i64 - edges.len() as i64 + faces.len() as i64
    }
}

/// The kernel of this project.
#[derive(Clone)]
pub struct Planecut(pub planecut_kernel::IncrementalPolytope);

impl Library for Planecut {
    const NAME: &'static str = "planecut";

    type HalfSpace = planecut_kernel::HalfSpace;

    fn half_space(plane: &Plane) -> Self::HalfSpace {
        planecut_kernel::HalfSpace::new(plane.normal, plane.offset).expect("the inputs are of moderate size")
    }

    fn new() -> Self {
        Self(planecut_kernel::IncrementalPolytope::new())
    }

    fn with_epsilon(epsilon: f64) -> Self {
        Self(planecut_kernel::IncrementalPolytope::with_epsilon(epsilon))
    }

    fn clear(&mut self) {
        self.0.clear();
    }

    fn add(&mut self, half_space: &Self::HalfSpace) {
        self.0.add_plane(*half_space);
    }

    fn remove(&mut self, index: usize) {
        self.0.remove_plane(planecut_kernel::PlaneIdx(index));
    }

    fn vertex_count(&self) -> usize {
        self.0.vertex_count()
    }

    fn is_bounded(&mut self) -> bool {
        self.0.is_bounded()
    }

    fn mesh(&mut self) -> (Vec<[f64; 3]>, Vec<Vec<usize>>) {
        let (vertices, faces) = self.0.to_mesh();
        (vertices.into_iter().map(Into::into).collect(), faces)
    }

    fn settle(&mut self) {}
}

/// The published crate `poly_surge`.
#[derive(Clone)]
pub struct PolySurge(pub poly_surge::IncrementalPolytope);

impl Library for PolySurge {
    const NAME: &'static str = "poly_surge";

    type HalfSpace = poly_surge::HalfSpace;

    fn half_space(plane: &Plane) -> Self::HalfSpace {
        poly_surge::HalfSpace::new(poly_surge::math::DVec3::from_array(plane.normal), plane.offset)
    }

    fn new() -> Self {
        Self(poly_surge::IncrementalPolytope::new())
    }

    fn with_epsilon(epsilon: f64) -> Self {
        Self(poly_surge::IncrementalPolytope::with_epsilon(epsilon))
    }

    fn clear(&mut self) {
        self.0.clear();
    }

    fn add(&mut self, half_space: &Self::HalfSpace) {
        self.0.add_plane(half_space.clone());
    }

    fn remove(&mut self, index: usize) {
        self.0.remove_plane(poly_surge::PlaneIdx(index));
    }

    fn vertex_count(&self) -> usize {
        self.0.vertex_count()
    }

    fn is_bounded(&mut self) -> bool {
        self.0.is_bounded()
    }

    fn mesh(&mut self) -> (Vec<[f64; 3]>, Vec<Vec<usize>>) {
        // The faces index the finite vertices in the order of their slots.
        let (vertices, faces) = self.0.to_mesh();
        (vertices.into_iter().map(Into::into).collect(), faces)
    }

    fn settle(&mut self) {
        self.0.edge_count();
    }
}
