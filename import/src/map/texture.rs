//! How textures lie on the faces of a map, in texels.

use glam::{DVec2, DVec3};
use planecut_csg::TextureAxes;

/// The sides of a box, by their normals, with the axes of texture coordinates on them (`qbsp`, `TextureAxisFromPlane`): where normals are as near to several,
/// the first counts.
const SIDES: [[DVec3; 3]; 6] = [
    [DVec3::Z, DVec3::X, DVec3::NEG_Y],
    [DVec3::NEG_Z, DVec3::X, DVec3::NEG_Y],
    [DVec3::X, DVec3::Y, DVec3::NEG_Z],
    [DVec3::NEG_X, DVec3::Y, DVec3::NEG_Z],
    [DVec3::Y, DVec3::X, DVec3::NEG_Z],
    [DVec3::NEG_Y, DVec3::X, DVec3::NEG_Z],
];

/// How a face of a map says it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Alignment {
    /// By the side of a box that the face is nearest to, moved, turned and scaled.
    Plain { shift: DVec2, degrees: f64, scale: DVec2 },
    /// By two axes, each with how far it is moved, and scaled (Valve 220). Their rotation is in the axes.
    Axes { u: (DVec3, f64), v: (DVec3, f64), scale: DVec2 },
}

impl Alignment {
    /// The axes on a plane with this normal; `None` where numbers run out of range.
    pub(super) fn axes(self, normal: DVec3) -> Option<TextureAxes> {
        let axes = match self {
            Self::Plain { shift, degrees, scale } => {
                let (u, v) = turned(normal, degrees);
                TextureAxes { u: u / whole(scale.x), v: v / whole(scale.y), offset: shift }
            }
            Self::Axes { u, v, scale } => {
                TextureAxes { u: u.0 / whole(scale.x), v: v.0 / whole(scale.y), offset: DVec2::new(u.1, v.1) }
            }
        };
        (axes.u.is_finite() && axes.v.is_finite() && axes.offset.is_finite()).then_some(axes)
    }
}

/// A scale of zero counts as one, as in map compilers.
fn whole(scale: f64) -> f64 {
    if scale == 0.0 { 1.0 } else { scale }
}

/// The axes of the side that a normal is nearest to, turned within it.
fn turned(normal: DVec3, degrees: f64) -> (DVec3, DVec3) {
    let mut nearest = SIDES[0];
    for side in SIDES {
        if normal.dot(side[0]) > normal.dot(nearest[0]) {
            nearest = side;
        }
    }
    let [_, u, v] = nearest;
    let (sine, cosine) = planecut_csg::sine_and_cosine(degrees);
    // within the plane of both, from its first axis of space to its second
    let (first, second) = (u.abs(), v.abs());
    let turn = |axis: DVec3| {
        let (s, t) = (axis.dot(first), axis.dot(second));
        (cosine * s - sine * t) * first + (sine * s + cosine * t) * second
    };
    (turn(u), turn(v))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plain_faces_lie_on_the_sides_of_a_box() {
        let plain = |degrees| Alignment::Plain { shift: DVec2::new(3.0, 5.0), degrees, scale: DVec2::new(2.0, 0.0) };
        let floor = plain(0.0).axes(DVec3::new(0.1, 0.0, 1.0)).expect("finite");
        assert_eq!(floor.at(DVec3::new(8.0, 16.0, 100.0)), DVec2::new(4.0 + 3.0, -16.0 + 5.0));
        let wall = plain(0.0).axes(DVec3::NEG_X).expect("finite");
        assert_eq!(wall.at(DVec3::new(100.0, 8.0, 16.0)), DVec2::new(4.0 + 3.0, -16.0 + 5.0));
        // a quarter turn swaps the axes
        let turned = plain(90.0).axes(DVec3::Z).expect("finite");
        assert_eq!(turned.at(DVec3::new(8.0, 16.0, 100.0)), DVec2::new(16.0 / 2.0 + 3.0, 8.0 + 5.0));
    }

    #[test]
    fn axes_are_taken_as_they_are() {
        let u = (DVec3::new(0.0, 1.0, 0.5), 7.0);
        let alignment = Alignment::Axes { u, v: (DVec3::NEG_Z, -1.0), scale: DVec2::new(0.5, 2.0) };
        let axes = alignment.axes(DVec3::X).expect("finite");
        assert_eq!(axes.at(DVec3::new(9.0, 2.0, 4.0)), DVec2::new(2.0 * 4.0 + 7.0, -2.0 - 1.0));
        let lost = Alignment::Axes { u: (DVec3::splat(1e300), 0.0), v: u, scale: DVec2::splat(1e-300) };
        assert_eq!(lost.axes(DVec3::X), None);
    }
}
