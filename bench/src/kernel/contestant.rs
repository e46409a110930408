//! The two libraries as scripts see them: planes have names, and the answers that are compared are asked for.

use planecut_bench::inputs::Plane;
use planecut_bench::library::{Library, Planecut, PolySurge};
use planecut_kernel::PlaneIdx;
use std::collections::HashMap;

/// What one library says about the set.
#[derive(Debug)]
pub(crate) struct Answer {
    /// Whether the library says that the set is empty; `None` where it cannot say.
    pub(crate) empty: Option<bool>,
    pub(crate) bounded: bool,
    /// All finite vertices.
    pub(crate) vertices: Vec<[f64; 3]>,
}

/// A library that runs scripts.
pub(crate) trait Contestant {
    /// All of space.
    fn start() -> Self;
    /// Adds a plane under a name.
    fn add(&mut self, name: usize, plane: &Plane);
    /// Removes the plane of this name.
    fn remove(&mut self, name: usize);
    /// What the set is now.
    fn answer(&mut self) -> Answer;
}

/// The kernel of this project.
pub(crate) struct Ours {
    polytope: Planecut,
    handles: HashMap<usize, PlaneIdx>,
}

impl Contestant for Ours {
    fn start() -> Self {
        Self { polytope: Planecut::new(), handles: HashMap::new() }
    }

    fn add(&mut self, name: usize, plane: &Plane) {
        let handle = self.polytope.0.add_plane(Planecut::half_space(plane)).plane();
        self.handles.insert(name, handle);
    }

    fn remove(&mut self, name: usize) {
        if let Some(handle) = self.handles.remove(&name) {
            self.polytope.0.remove_plane(handle);
        }
    }

    fn answer(&mut self) -> Answer {
        let (empty, bounded) = (Some(self.polytope.0.is_empty()), self.polytope.is_bounded());
        Answer { empty, bounded, vertices: self.polytope.mesh().0 }
    }
}

/// `poly_surge`. It gives no handle for a plane that it calls redundant or adds to an open set, and has no `is_empty`.
pub(crate) struct Theirs {
    polytope: PolySurge,
    handles: HashMap<usize, poly_surge::PlaneIdx>,
    /// The last operation said that the set is empty.
    said_empty: bool,
}

impl Contestant for Theirs {
    fn start() -> Self {
        Self { polytope: PolySurge::new(), handles: HashMap::new(), said_empty: false }
    }

    fn add(&mut self, name: usize, plane: &Plane) {
        let result = self.polytope.0.add_plane(PolySurge::half_space(&unit_scale(plane)));
        self.said_empty = matches!(result, poly_surge::AddPlaneResult::Empty);
        if self.said_empty {
            // It forgets all planes then.
            self.handles.clear();
        }
        let known = |index: &poly_surge::PlaneIdx| self.handles.values().any(|handle| handle == index);
        let fresh = self.polytope.0.planes().map(|(index, _)| index).find(|index| !known(index));
        self.handles.extend(fresh.map(|handle| (name, handle)));
    }

    fn remove(&mut self, name: usize) {
        self.said_empty = false;
        if let Some(handle) = self.handles.remove(&name) {
            self.polytope.0.remove_plane(handle);
        }
    }

    fn answer(&mut self) -> Answer {
        let vertices = self.polytope.0.vertices().filter_map(|(_, vertex)| vertex.to_euclidean());
        let vertices = vertices.map(Into::into).collect();
        Answer { empty: self.said_empty.then_some(true), bounded: self.polytope.is_bounded(), vertices }
    }
}

/// The same plane with its largest normal component in [1, 2): it takes no normal shorter than its tolerance.
fn unit_scale(plane: &Plane) -> Plane {
    let largest = plane.normal.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    // In two steps, because 2^−exponent alone may overflow.
    let exponent = largest.log2().floor() as i32;
    let scale = |v: f64| v * 2f64.powi(-exponent / 2) * 2f64.powi(-exponent - -exponent / 2);
    Plane { normal: plane.normal.map(scale), offset: scale(plane.offset) }
}
