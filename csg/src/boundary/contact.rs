//! How a body stands to a face of another, and which way boundary faces there.

use planecut_kernel::DVec3;

use crate::base::Bounds;

/// How a body stands to the plane of a face, where it reaches that plane with an area.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Contact {
    /// It crosses the plane.
    Across,
    /// It has a face on the plane, facing the same way.
    SameWay,
    /// It has a face on the plane, facing the other way.
    OtherWay,
}

impl Contact {
    /// Whether the body holds what lies just inside and just outside of the face.
    pub(super) fn sides(self) -> [bool; 2] {
        match self {
            Self::Across => [true, true],
            Self::SameWay => [true, false],
            Self::OtherWay => [false, true],
        }
    }
}

/// Which way the boundary faces on the plane of a face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Facing {
    /// The way of the face: solid lies just inside of it.
    Out,
    /// The other way.
    In,
}

impl Facing {
    pub(super) const BOTH: [Self; 2] = [Self::Out, Self::In];

    /// Which of two values, for what lies just inside and just outside of the face, is that of the solid side.
    pub(super) fn solid_of<T: Copy>(self, [inside, outside]: [T; 2]) -> T {
        match self {
            Self::Out => inside,
            Self::In => outside,
        }
    }

    /// Which of two values is that of the empty side.
    pub(super) fn empty_of<T: Copy>(self, [inside, outside]: [T; 2]) -> T {
        self.solid_of([outside, inside])
    }

    /// The boundary between what the tree is just inside and just outside of the face, where there is one.
    pub(super) fn between(inside: bool, outside: bool) -> Option<Self> {
        match (inside, outside) {
            (true, false) => Some(Self::Out),
            (false, true) => Some(Self::In),
            _ => None,
        }
    }
}

/// Whether a box surely has no point on the plane's outer side and none on the plane, or none on its inner side.
pub(crate) fn misses(bounds: &Bounds, normal: DVec3, offset: f64) -> bool {
    let (low, high) = bounds.extent_along(normal, offset);
    high < 0.0 || low > 0.0
}
