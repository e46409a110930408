//! How textures lie on the faces of a map, in texels or, on brush primitives, in whole pictures.

use glam::{DVec2, DVec3};
use planecut_csg::{TextureAxes, TextureUnit};

/// Components of a normal that are smaller count as none where editors choose the axes of a brush primitive's face.
const NO_COMPONENT: f64 = 1e-6;

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
    /// By the two rows of a matrix over two axes that follow from the normal, and 1 (brush primitives).
    Matrix { u: DVec3, v: DVec3 },
}

impl Alignment {
    /// The axes on a plane with this normal; `None` where numbers run out of range.
    pub(super) fn axes(self, normal: DVec3) -> Option<TextureAxes> {
        let axes = match self {
            Self::Plain { shift, degrees, scale } => {
                let (u, v) = turned(normal, degrees);
                let (u, v) = (u / whole(scale.x), v / whole(scale.y));
                TextureAxes { u, v, offset: shift, unit: TextureUnit::Texels, anchor: None }
            }
            Self::Axes { u, v, scale } => {
                let offset = DVec2::new(u.1, v.1);
                let (u, v) = (u.0 / whole(scale.x), v.0 / whole(scale.y));
                TextureAxes { u, v, offset, unit: TextureUnit::Texels, anchor: None }
            }
            Self::Matrix { u, v } => {
                let (right, down) = axis_base(normal);
                let offset = DVec2::new(u.z, v.z);
                let along = |row: DVec3| row.x * right + row.y * down;
                TextureAxes { u: along(u), v: along(v), offset, unit: TextureUnit::Pictures, anchor: None }
            }
        };
        (axes.u.is_finite() && axes.v.is_finite() && axes.offset.is_finite()).then_some(axes)
    }
}

/// A scale of zero counts as one, as in map compilers.
fn whole(scale: f64) -> f64 {
    if scale == 0.0 { 1.0 } else { scale }
}

/// The axes on a face of a brush primitive, to the right and down as editors of Quake 3 and Doom 3 have them (`ComputeAxisBase`): the normal is turned
/// from x, about z and then up, and y and −z go with it. Sines and cosines of both angles are shares of the normal.
fn axis_base(normal: DVec3) -> (DVec3, DVec3) {
    let normal = normal.map(|value| if value.abs() < NO_COMPONENT { 0.0 } else { value });
    let across = normal.x.hypot(normal.y);
    let (sine, cosine) = if across > 0.0 { (normal.y / across, normal.x / across) } else { (0.0, 1.0) };
    let (up, flat) = (normal.z / normal.length(), across / normal.length());
    (DVec3::new(-sine, cosine, 0.0), DVec3::new(up * cosine, up * sine, -flat))
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
    /// The axes as editors write them down, by angles.
    fn base_by_angles(normal: DVec3) -> (DVec3, DVec3) {
        let DVec3 { x, y, z } = normal.map(|value| if value.abs() < 1e-6 { 0.0 } else { value });
        let (about_z, up) = (y.atan2(x), -z.atan2((y * y + x * x).sqrt()));
        let s = DVec3::new(-about_z.sin(), about_z.cos(), 0.0);
        (s, DVec3::new(-up.sin() * about_z.cos(), -up.sin() * about_z.sin(), -up.cos()))
    }

    #[test]
    fn matrices_count_pictures_along_axes_of_the_normal() {
        let mut normals = vec![DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y, DVec3::Z, -DVec3::Z];
        for k in 0..1000 {
            // directions all around, many near an axis
            let angle = f64::from(k) * 2.399_963;
            let z = f64::from(k) / 499.5 - 1.0;
            let flat = (1.0 - z * z).max(0.0).sqrt();
            normals.push(DVec3::new(flat * angle.cos(), flat * angle.sin(), z).normalize());
            normals.push(DVec3::new(1e-7 * angle.cos(), 2e-6 * angle.sin(), z.signum()).normalize());
        }
        let (u, v) = (DVec3::new(0.015625, -0.25, 0.5), DVec3::new(0.125, 0.0078125, -3.0));
        let point = DVec3::new(24.0, -100.0, 7.0);
        for normal in normals {
            let (right, down) = base_by_angles(normal);
            let (x, y) = (point.dot(right), point.dot(down));
            let expected = DVec2::new(u.x * x + u.y * y + u.z, v.x * x + v.y * y + v.z);
            let axes = Alignment::Matrix { u, v }.axes(normal).expect("finite");
            assert_eq!(axes.unit, TextureUnit::Pictures);
            assert!(axes.at(point).abs_diff_eq(expected, 1e-11), "{normal}: {} {expected}", axes.at(point));
        }
    }

    #[test]
    fn matrices_on_walls_and_floors_are_exact() {
        // a picture of 64 texels at scale 1, moved by a quarter
        let matrix = Alignment::Matrix { u: DVec3::new(1.0 / 64.0, 0.0, 0.25), v: DVec3::new(0.0, 1.0 / 64.0, 0.0) };
        let point = DVec3::new(64.0, 32.0, 16.0);
        let at = |normal| matrix.axes(normal).expect("finite").at(point);
        // on walls to the right as seen from outside, and down
        assert_eq!(at(DVec3::X), DVec2::new(0.5 + 0.25, -0.25));
        assert_eq!(at(-DVec3::Y), DVec2::new(1.0 + 0.25, -0.25));
        // on floors to y, and to x
        assert_eq!(at(DVec3::Z), DVec2::new(0.5 + 0.25, 1.0));
        assert_eq!(at(-DVec3::Z), DVec2::new(0.5 + 0.25, -1.0));
    }
}
