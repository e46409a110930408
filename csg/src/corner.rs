//! A meeting point of three planes: exact by name, and where it is in plain numbers.

use glam::DVec3;
use planecut_kernel::sign::Homogeneous;

/// A corner of a polygon.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Corner {
    /// For asking sides.
    pub(crate) point: Homogeneous,
    /// Where it is, rounded a few times.
    pub(crate) at: DVec3,
    /// How far off each coordinate may be; infinite where nothing is known.
    pub(crate) error: f64,
    /// The number of a body that it is known to lie in, or [`NOWHERE`](Self::NOWHERE).
    pub(crate) within: u32,
    /// A number that it has in its body, whichever face it is seen in; [`NEW`](Self::NEW) for a corner that cutting made.
    pub(crate) number: u32,
}

impl Corner {
    /// No body.
    pub(crate) const NOWHERE: u32 = u32::MAX;
    /// No corner of a body.
    pub(crate) const NEW: u32 = u32::MAX;

    pub(crate) fn new(point: Homogeneous) -> Self {
        let [x, y, z, w] = point.value;
        let at = DVec3::new(x, y, z) / w;
        let permanent = DVec3::new(point.permanent[0], point.permanent[1], point.permanent[2]);
        // |x/w − X/W| ≤ ε (|X| perm + |x/w| Wperm) / |W|, with room in the factor
        let error = (permanent + at.abs() * point.permanent[3]) * (32.0 * f64::EPSILON) / w.abs();
        let is_known =
            at.is_finite() && error.is_finite() && point.permanent[3] * (16.0 * f64::EPSILON) <= 0.5 * w.abs();
        let error = if is_known { error.max_element() } else { f64::INFINITY };
        Self { point, at, error, within: Self::NOWHERE, number: Self::NEW }
    }

    /// Whether its coordinates are right but for a few roundings.
    pub(crate) fn is_well_known(&self) -> bool {
        const WELL: f64 = 64.0;
        let [x, y, z, w] = self.point.value.map(f64::abs);
        let [px, py, pz, pw] = self.point.permanent;
        pw <= WELL * w && px.max(py).max(pz) <= WELL * x.max(y).max(z)
    }
}
