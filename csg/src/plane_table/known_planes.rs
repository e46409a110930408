//! Planes that are the same but for rounding, among planes that are known.

use planecut_kernel::{DVec3, HalfSpace};

use crate::tolerances::SNAP_TOLERANCE;

/// Half-spaces, by the first component of their unit normals.
pub struct KnownPlanes {
    planes: Vec<(DVec3, f64, HalfSpace)>,
    size: f64,
}

impl KnownPlanes {
    /// Keeps half-spaces, to be found again.
    pub fn new<'a>(half_spaces: impl IntoIterator<Item = &'a HalfSpace>) -> Self {
        let mut planes: Vec<(DVec3, f64, HalfSpace)> = half_spaces.into_iter().map(unit).collect();
        planes.sort_by(|a, b| a.0.x.total_cmp(&b.0.x).then_with(|| compare(&a.2, &b.2)));
        let size = planes.iter().map(|plane| plane.1.abs()).fold(0.0, f64::max);
        Self { planes, size }
    }

    /// Those that a half-space is but for rounding.
    pub fn like(&self, half_space: &HalfSpace) -> impl Iterator<Item = HalfSpace> + '_ {
        let (normal, distance, _) = unit(half_space);
        let start = self.planes.partition_point(|plane| plane.0.x < normal.x - SNAP_TOLERANCE);
        let near = self.planes[start..].iter().take_while(move |plane| plane.0.x <= normal.x + SNAP_TOLERANCE);
        let is_same = move |plane: &&(DVec3, f64, HalfSpace)| {
            (plane.0 - normal).abs().max_element() <= SNAP_TOLERANCE
                && (plane.1 - distance).abs() <= SNAP_TOLERANCE * self.size
        };
        near.filter(is_same).map(|plane| plane.2)
    }
}

/// An order of half-spaces by their coefficients.
#[must_use]
pub fn compare(a: &HalfSpace, b: &HalfSpace) -> std::cmp::Ordering {
    key(a).partial_cmp(&key(b)).unwrap_or(std::cmp::Ordering::Equal)
}

fn key(half_space: &HalfSpace) -> [f64; 4] {
    let [x, y, z] = half_space.normal().to_array();
    [x, y, z, half_space.offset()]
}

/// The unit normal, the distance of the plane from the origin, and the half-space itself.
fn unit(half_space: &HalfSpace) -> (DVec3, f64, HalfSpace) {
    // no component leaves the range of numbers
    let scale = half_space.normal().abs().max_element();
    let normal = half_space.normal() / scale;
    let length = normal.length();
    (normal / length, half_space.offset() / scale / length, *half_space)
}
